#ifndef RCO_BENCHMARK_RUN_APART_H
#define RCO_BENCHMARK_RUN_APART_H

// Runs of a driver, each in a process of its own.

#include "report.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#if defined(__unix__) || defined(__APPLE__)
#define RCO_HAS_POSIX
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

enum Exit_code { ok = 0, violation = 1, failure = 2 };

// One row of the output. `holds` is set to false if a check fails.
struct Task
{
  std::string name;
  std::function<Row(bool& holds)> run;
};

// Numbers that runs leave for one another and for the driver. They are NaN until then.
class Shared_numbers
{
public:
  explicit Shared_numbers(std::size_t size) : m_size(size)
  {
#ifdef RCO_HAS_POSIX
    void* const memory =
      mmap(nullptr, bytes(), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if(memory == MAP_FAILED)
      throw std::runtime_error("there is no memory to share");
    m_begin = static_cast<double*>(memory);
#else
    m_begin = new double[size];
#endif
    std::fill(m_begin, m_begin + size, std::numeric_limits<double>::quiet_NaN());
  }
  Shared_numbers(const Shared_numbers&) = delete;
  Shared_numbers& operator=(const Shared_numbers&) = delete;
  ~Shared_numbers()
  {
#ifdef RCO_HAS_POSIX
    munmap(m_begin, bytes());
#else
    delete[] m_begin;
#endif
  }

  double& operator[](std::size_t i) { return m_begin[i]; }

private:
  std::size_t bytes() const { return (std::max)(m_size, std::size_t(1)) * sizeof(double); }

  std::size_t m_size;
  double* m_begin;
};

inline double peak_memory() // in megabytes, of this process so far
{
#ifdef RCO_HAS_POSIX
  struct rusage r;
  getrusage(RUSAGE_SELF, &r);
#ifdef __APPLE__
  return double(r.ru_maxrss) / (1024 * 1024);
#else
  return double(r.ru_maxrss) / 1024;
#endif
#else
  return std::numeric_limits<double>::quiet_NaN();
#endif
}

// runs, prints and says how it went
inline Exit_code run_and_print(const Task& task, const std::string& format, bool is_first)
{
  try
  {
    bool holds = true;
    const Row row = task.run(holds);
    if(format == "json")
    {
      std::cout << (is_first ? "" : ",\n");
      row.print_json(std::cout);
    }
    else if(format == "csv")
      row.print_csv(std::cout, is_first);
    else
      row.print_table(std::cout, is_first);
    return holds ? ok : violation;
  }
  catch(const std::exception& e)
  {
    std::cerr << task.name << ": " << e.what() << std::endl;
    return failure;
  }
}

// in a process of its own where that is possible: memory is that of the run, and a crash costs no
// more than its row
inline Exit_code run_apart(const Task& task, const std::string& format, bool is_first)
{
#ifdef RCO_HAS_POSIX
  std::cout << std::flush;
  const pid_t child = fork();
  if(child == 0)
    std::_Exit(run_and_print(task, format, is_first));
  int state = 0;
  if(child > 0 && waitpid(child, &state, 0) == child)
  {
    if(WIFEXITED(state))
      return Exit_code(WEXITSTATUS(state));
    std::cerr << task.name << ": ended by signal " << WTERMSIG(state) << std::endl;
    return failure;
  }
#endif
  return run_and_print(task, format, is_first);
}

// runs all in turn and returns the driver's exit code, the worst of theirs
inline int run_all(const std::vector<Task>& tasks, const std::string& format)
{
  int worst = ok;
  bool is_first = true;
  if(format == "json")
    std::cout << "[\n";
  for(const Task& task : tasks)
  {
    const Exit_code code = run_apart(task, format, is_first);
    is_first = is_first && code == failure;
    worst = (std::max)(worst, int(code));
  }
  if(format == "json")
    std::cout << "\n]" << std::endl;
  return worst;
}

#endif // RCO_BENCHMARK_RUN_APART_H
