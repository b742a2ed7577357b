// Whether a run made the mesh better, and what got worse.

#ifndef RCO_PROGRAM_VERDICT_H
#define RCO_PROGRAM_VERDICT_H

#include "measures.h"
#include "outcome.h"

#include <CGAL/Reference_constrained_optimization/Result.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

struct Verdict
{
  Outcome outcome = Outcome::nothing_to_do;
  std::vector<std::string> worse_keys;
  std::string worse; // for people: "flipped faces 0 -> 2, mean minimum angle 23.8 -> 14.6"
};

// "mean minimum angle 23.8 -> 14.6", with as many digits as it takes to see a difference
inline std::string text_of_change(const Measure& before, const Measure& after)
{
  std::string name = after.key;
  std::replace(name.begin(), name.end(), '_', ' ');
  const auto text = [](double x, int digits) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.*g", digits, x);
    return std::string(buffer);
  };
  int digits = 4;
  while(digits < 17 && text(before.value, digits) == text(after.value, digits))
    ++digits;
  return name + ' ' + text(before.value, digits) + " -> " + text(after.value, digits);
}

// The mesh is improved if some measure that the energy is about is better. What is worse is no secret.
inline Verdict verdict_on(const RCO::Result& result,
                          const std::vector<Measure>& before,
                          const std::vector<Measure>& after)
{
  Verdict verdict;
  bool is_better = false;
  for(std::size_t i = 0; i < after.size(); ++i)
  {
    const Measure &a = before[i], &b = after[i];
    if(b.role == Role::figure)
      continue;
    const double size = std::isfinite(a.value) ? std::abs(a.value) : 0;
    const double rounding = 1e-9 * (std::max)(1., size);
    const double gain = b.gain(a), tolerance = (std::max)(b.tolerance, rounding);
    is_better = is_better || (b.role == Role::aim && gain > tolerance);
    if(gain >= -tolerance)
      continue;
    verdict.worse_keys.push_back(b.key);
    verdict.worse += (verdict.worse.empty() ? "" : ", ") + text_of_change(a, b);
  }
  if(result.status == RCO::Status::interrupted)
    verdict.outcome = Outcome::interrupted;
  else if(is_better)
    verdict.outcome = Outcome::improved;
  else if(!verdict.worse_keys.empty())
    verdict.outcome = Outcome::not_better;
  else if(result.status == RCO::Status::time_limit)
    verdict.outcome = Outcome::out_of_time;
  return verdict;
}

#endif // RCO_PROGRAM_VERDICT_H
