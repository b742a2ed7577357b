#ifndef RCO_BENCHMARK_BOUNDED_PROCESSES_H
#define RCO_BENCHMARK_BOUNDED_PROCESSES_H

// Runs functions in processes of their own, several at once, with bounds on time and memory.

#include "result_apart.h"

#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RCO_HAS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RCO_HAS_SANITIZER
#endif
#endif

struct Process_bounds
{
  double seconds = 120; // of the processor's time, which other programs do not lengthen
  double megabytes = 4096;
};

// how a process ended, and what it left
template <typename T>
struct Ended_process
{
  int exit_code = -1; // if no signal ended it
  int signal = 0;
  T value{};
  std::string text;
};

#ifdef RCO_HAS_POSIX

inline bool is_time_out(int signal) { return signal == SIGXCPU || signal == SIGALRM; }

inline void set_bounds(const Process_bounds& bounds)
{
  // at the first limit of time there is a signal that tells what happened
  const auto set = [](int resource, rlim_t value, rlim_t margin = 0) {
    const struct rlimit limit = {value, value + margin};
    setrlimit(resource, &limit);
  };
  set(RLIMIT_CORE, 0);
  set(RLIMIT_CPU, rlim_t(std::ceil(bounds.seconds)), 5);
#ifndef RCO_HAS_SANITIZER // they reserve more address space than there is memory
  set(RLIMIT_AS, rlim_t(bounds.megabytes * 1024 * 1024));
#endif
  set_alarm(5 * bounds.seconds); // a process that waits for ever uses no processor
}

// `function(i, value, text)` runs for i = 0, ..., n - 1 in processes of their own, at most `at_once`
// at a time; what it returns is the exit code. `on_end(i, ended)` is called in this process, in the
// order in which they end. Texts are cut off at what a pipe holds for sure.
template <typename T, typename Function, typename On_end>
void run_bounded(
  int n, int at_once, const Process_bounds& bounds, const Function& function, const On_end& on_end)
{
  static_assert(std::is_trivially_copyable<T>::value, "a result goes from process to process");
  struct Running
  {
    int index, file;
  };
  std::map<pid_t, Running> running;
  const std::size_t longest_text = 2000;

  const auto start = [&](int i) {
    int ends[2] = {-1, -1};
    const pid_t child = pipe(ends) == 0 ? fork() : -1;
    if(child < 0)
      throw std::runtime_error("a process cannot be started");
    if(child == 0)
    {
      close(ends[0]);
      set_bounds(bounds);
      T value{};
      std::string text;
      const int code = function(i, value, text);
      text.resize((std::min)(text.size(), longest_text));
      write_all(ends[1], &value, sizeof value);
      write_all(ends[1], text.data(), text.size());
      std::_Exit(code);
    }
    close(ends[1]);
    running[child] = {i, ends[0]};
  };
  const auto wait_for_one = [&]() {
    int state = 0;
    const pid_t child = waitpid(-1, &state, 0);
    const auto found = running.find(child);
    if(found == running.end())
      throw std::runtime_error("a process got lost");
    Ended_process<T> ended;
    const std::string all = read_all(found->second.file);
    close(found->second.file);
    if(all.size() >= sizeof ended.value)
    {
      all.copy(reinterpret_cast<char*>(&ended.value), sizeof ended.value);
      ended.text = all.substr(sizeof ended.value);
    }
    if(WIFEXITED(state))
      ended.exit_code = WEXITSTATUS(state);
    else
      ended.signal = WTERMSIG(state);
    const int i = found->second.index;
    running.erase(found);
    on_end(i, ended);
  };

  for(int i = 0; i < n; ++i)
  {
    if(int(running.size()) >= at_once)
      wait_for_one();
    start(i);
  }
  while(!running.empty())
    wait_for_one();
}

#endif // RCO_HAS_POSIX

#endif // RCO_BENCHMARK_BOUNDED_PROCESSES_H
