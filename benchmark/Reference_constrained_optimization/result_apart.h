#ifndef RCO_BENCHMARK_RESULT_APART_H
#define RCO_BENCHMARK_RESULT_APART_H

// Calls a function in a process of its own and takes its result back: a crash, or a run that does
// not end, costs no more than that result.

#include "run_apart.h"

#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <string>
#include <type_traits>

template <typename T>
struct Result_apart
{
  bool has_value = false;
  T value{};
  std::string text; // that the function gave beside its value, or why there is none
};

#ifdef RCO_HAS_POSIX

// ends this process with SIGALRM after some seconds; infinity: never
inline void set_alarm(double seconds)
{
  alarm(seconds < 1e6 ? (unsigned int)(std::ceil(seconds)) : 0);
}

inline void write_all(int file, const void* data, std::size_t size)
{
  const char* p = static_cast<const char*>(data);
  while(size > 0)
  {
    const ssize_t n = ::write(file, p, size);
    if(n <= 0)
      std::_Exit(failure);
    p += n;
    size -= std::size_t(n);
  }
}

inline std::string read_all(int file)
{
  std::string all;
  char buffer[4096];
  for(ssize_t n = 0; (n = ::read(file, buffer, sizeof buffer)) > 0;)
    all.append(buffer, std::size_t(n));
  return all;
}

#else

inline void set_alarm(double) {} // there is nothing that would end a run

#endif

// `function(text)` returns a T and may set a text of at most a few thousand characters
template <typename T, typename Function>
void call_here(const Function& function, Result_apart<T>& result)
{
  try
  {
    result.value = function(result.text);
    result.has_value = true;
  }
  catch(const std::exception& e)
  {
    result.text = e.what();
  }
}

template <typename T, typename Function>
Result_apart<T> call_apart(const Function& function)
{
  static_assert(std::is_trivially_copyable<T>::value, "a result goes from process to process");
  Result_apart<T> result;
#ifdef RCO_HAS_POSIX
  int ends[2] = {-1, -1};
  const pid_t child = pipe(ends) == 0 ? fork() : -1;
  if(child == 0)
  {
    call_here(function, result);
    write_all(ends[1], &result.has_value, sizeof result.has_value);
    write_all(ends[1], &result.value, sizeof result.value);
    write_all(ends[1], result.text.data(), result.text.size());
    std::_Exit(ok);
  }
  if(child > 0)
  {
    close(ends[1]);
    const std::string all = read_all(ends[0]);
    close(ends[0]);
    int state = 0;
    waitpid(child, &state, 0);
    const std::size_t head = sizeof result.has_value + sizeof result.value;
    if(WIFEXITED(state) && WEXITSTATUS(state) == ok && all.size() >= head)
    {
      all.copy(reinterpret_cast<char*>(&result.has_value), sizeof result.has_value);
      all.copy(reinterpret_cast<char*>(&result.value), sizeof result.value,
               sizeof result.has_value);
      result.text = all.substr(head);
    }
    else if(WIFSIGNALED(state) && WTERMSIG(state) == SIGALRM)
      result.text = "time limit";
    else if(WIFSIGNALED(state))
      result.text = "ended by signal " + std::to_string(WTERMSIG(state));
    else
      result.text = "ended without a result";
    return result;
  }
#endif
  call_here(function, result);
  return result;
}

#endif // RCO_BENCHMARK_RESULT_APART_H
