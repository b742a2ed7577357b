// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_COMMIT_ROUND_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_COMMIT_ROUND_H

#include <CGAL/Reference_constrained_optimization/internal/rounds/commit.h>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Commits the patches of a round, in their order, and calls report(patch) for each that was solved,
// and update(patch) for each that is committed, possibly for several at the same time; `located` then holds
// the old vertices. Those that were reported are committed also when `report` throws.
template <typename ForEachPatch, typename Report, typename Update>
void commit_round(Optimization_state& state,
                  std::vector<Solved_patch>& solved,
                  ForEachPatch& for_each,
                  const Report& report,
                  const Update& update)
{
  std::size_t number = 0;
  std::vector<int> moved;
  const auto commit_insides = [&]() {
    for_each(
      number,
      [&](Patch_solver&, std::size_t i) {
        if(solved[i].decision.accepted)
        {
          commit_inside(state, solved[i]);
          update(solved[i]);
        }
        solved[i].drop_vertices();
      },
      []() {}); // short enough
  };
  try
  {
    while(number < solved.size())
    {
      Solved_patch& s = solved[number++];
      if(s.number_of_faces == 0)
        continue;
      commit_boundary(state, s, moved);
      report(s);
    }
  }
  catch(...)
  {
    commit_insides();
    throw;
  }
  commit_insides();
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_COMMIT_ROUND_H
