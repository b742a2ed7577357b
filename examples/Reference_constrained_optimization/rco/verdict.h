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
  std::vector<std::string> worse_keys, flaw_keys;
  std::string flaws; // beyond the limits, for people: "mean distortion 4.9e+17 (at most 100)"
  std::string left;  // defects, for people: "flipped faces 2"
  std::string worse; // for people: "flipped faces 0 -> 2, mean minimum angle 23.8 -> 14.6"
};

inline std::string text_of(double x, int digits = 4)
{
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.*g", digits, x);
  return buffer;
}

inline std::string name_of(const Measure& measure)
{
  std::string name = measure.key;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

// "mean minimum angle 23.8 -> 14.6", with as many digits as it takes to see a difference
inline std::string text_of_change(const Measure& before, const Measure& after)
{
  int digits = 4;
  while(digits < 17 && text_of(before.value, digits) == text_of(after.value, digits))
    ++digits;
  return name_of(after) + ' ' + text_of(before.value, digits) + " -> " +
         text_of(after.value, digits);
}

// The mesh is improved if some objective of the energy is better, unless it cannot be used. What is worse is
// reported.
inline Verdict verdict_on(const RCO::Result& result,
                          const std::vector<Measure>& before,
                          const std::vector<Measure>& after)
{
  const double scan_tolerance = 0.1; // on scans, which have short sharp edges everywhere
  Verdict verdict;
  bool is_better = false, has_lost_edges = false;
  for(std::size_t i = 0; i < after.size(); ++i)
  {
    const Measure &a = before[i], &b = after[i];
    if(!(b.value <= b.limit))
    {
      verdict.flaw_keys.push_back(b.key);
      verdict.flaws += (verdict.flaws.empty() ? "" : ", ") + name_of(b) + ' ' + text_of(b.value) +
                       " (at most " + text_of(b.limit) + ')';
    }
    if(b.is_of_defects && b.value > 0)
      verdict.left += (verdict.left.empty() ? "" : ", ") + name_of(b) + ' ' + text_of(b.value);
    if(b.role == Role::figure)
      continue;
    const double size = std::isfinite(a.value) ? std::abs(a.value) : 0;
    const double rounding = 1e-9 * (std::max)(1., size);
    const bool is_of_scan =
      result.number_of_feature_edges == 0 && b.key.compare(0, 11, "sharp_edges") == 0;
    const double gain = b.gain(a),
                 tolerance = (std::max)(is_of_scan ? scan_tolerance : b.tolerance, rounding);
    is_better = is_better || (b.role == Role::aim && gain > tolerance);
    if(gain >= -tolerance)
      continue;
    has_lost_edges = has_lost_edges || is_of_scan;
    verdict.worse_keys.push_back(b.key);
    verdict.worse += (verdict.worse.empty() ? "" : ", ") + text_of_change(a, b);
  }
  const auto add_count = [&](const char* key, std::size_t from, std::size_t to) {
    if(to <= from)
      return;
    const Measure a{key, "", 0, double(from)}, b{key, "", 0, double(to)};
    verdict.worse_keys.push_back(b.key);
    verdict.worse += (verdict.worse.empty() ? "" : ", ") + text_of_change(a, b);
  };
  add_count("creases", result.initial_number_of_creases, result.number_of_creases);
  add_count("self_intersections", result.initial_number_of_self_intersections,
            result.number_of_self_intersections);
  if(has_lost_edges)
    verdict.worse += " (none was taken for a feature)";
  if(result.status == RCO::Status::interrupted)
    verdict.outcome = Outcome::interrupted;
  else if(!verdict.flaws.empty())
    verdict.outcome = Outcome::not_usable;
  else if(is_better)
    verdict.outcome = Outcome::improved;
  else if(!verdict.worse_keys.empty())
    verdict.outcome = Outcome::not_better;
  else if(result.status == RCO::Status::time_limit)
    verdict.outcome = Outcome::out_of_time;
  return verdict;
}

#endif // RCO_PROGRAM_VERDICT_H
