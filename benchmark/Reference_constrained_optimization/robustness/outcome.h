#pragma once

// How a call of the package can end, and what was expected.

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

enum class Outcome {
  improved,
  nothing_to_do,
  refused,
  no_mesh, // the data do not make a half-edge mesh: the package is not reached
  violated_guarantee,
  exception, // of another type than Invalid_input
  out_of_memory
};

inline std::string name(Outcome outcome)
{
  const std::array<const char*, 7> names = {{"improved", "nothing to do", "refused", "no mesh",
                                             "violated guarantee", "exception", "memory"}};
  return names[std::size_t(outcome)];
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
      all += (all.empty() ? "" : " or ") + name(o) +
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
