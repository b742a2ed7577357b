#ifndef RCO_BENCHMARK_OUTCOME_H
#define RCO_BENCHMARK_OUTCOME_H

// How a call of the package can end, and what was expected.

#include <algorithm>
#include <array>
#include <string>
#include <vector>

// The values are exit codes of processes; small ones belong to whatever else ends a process.
enum class Outcome {
  improved = 20,
  nothing_to_do,
  refused,
  no_mesh, // the data do not make a half-edge mesh: the package is not reached
  broken_promise,
  exception, // of another type than Invalid_input
  out_of_memory,
  time_out,
  crash
};

struct Named_outcome
{
  Outcome outcome;
  const char* name;
};

const std::array<Named_outcome, 9> all_outcomes = {{{Outcome::improved, "improved"},
                                                    {Outcome::nothing_to_do, "nothing to do"},
                                                    {Outcome::refused, "refused"},
                                                    {Outcome::no_mesh, "no mesh"},
                                                    {Outcome::broken_promise, "broken promise"},
                                                    {Outcome::exception, "exception"},
                                                    {Outcome::out_of_memory, "memory"},
                                                    {Outcome::time_out, "time-out"},
                                                    {Outcome::crash, "crash"}}};

inline bool is_outcome(int exit_code)
{
  return exit_code >= int(Outcome::improved) && exit_code <= int(Outcome::crash);
}

inline const char* name(Outcome outcome)
{
  return all_outcomes[int(outcome) - int(Outcome::improved)].name;
}

// outcomes that are right for an input; a refusal has to start with the given words
struct Expectation
{
  std::vector<Outcome> outcomes;
  std::string refusal;

  bool is_met(Outcome outcome, const std::string& text) const
  {
    return std::find(outcomes.begin(), outcomes.end(), outcome) != outcomes.end() &&
           (outcome != Outcome::refused || text.compare(0, refusal.size(), refusal) == 0);
  }
  std::string text() const
  {
    std::string all;
    for(const Outcome o : outcomes)
      all += (all.empty() ? "" : " or ") + std::string(name(o)) +
             (o == Outcome::refused && !refusal.empty() ? " (" + refusal + "...)" : "");
    return all;
  }
};

inline Expectation is(Outcome outcome) { return {{outcome}, ""}; }
inline Expectation is_refused(const std::string& first_words)
{
  return {{Outcome::refused}, first_words};
}
inline Expectation is_optimized() { return {{Outcome::improved, Outcome::nothing_to_do}, ""}; }

#endif // RCO_BENCHMARK_OUTCOME_H
