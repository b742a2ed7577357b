// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_COMMIT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_COMMIT_H

#include <CGAL/Reference_constrained_optimization/internal/patch_solver.h>

#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// folds of the edges between the patch and faces outside it, as the state is now
inline int boundary_folds(const Optimization_state& state, const Patch& patch)
{
  const Indexed_mesh& mesh = state.mesh;
  const auto vertex = [&](int v) -> const Placed_vertex& { return state.vertices[v]; };
  int count = 0;
  for(std::size_t c = 0; c < patch.outside_face.size(); ++c)
    if(patch.outside_face[c] >= 0)
      count += is_folded(face_normal(mesh, vertex, patch.faces[patch.polygons.corner_face[c]]),
                         face_normal(mesh, vertex, patch.outside_face[c]));
  return count;
}

// swaps the free vertices of a patch with those of the state
inline void
exchange(Optimization_state& state, const Patch& patch, std::vector<Placed_vertex>& placed)
{
  for(std::size_t i = 0; i < patch.vertices.size(); ++i)
    if(patch.is_free[i])
      std::swap(state.vertices[patch.vertices[i]], placed[i]);
}

// Applies an accepted patch. Another patch of the round may have moved faces across its boundary
// since it was judged: what folds there is counted anew. Returns whether the patch stays; its
// `placed` then holds the old vertices.
inline bool commit(Optimization_state& state, Solved_patch& s)
{
  if(!s.decision.accepted)
    return false;
  const Patch& patch = s.patch;
  const int folds_before = boundary_folds(state, patch);
  exchange(state, patch, s.placed);
  const Patch_measure &before = s.decision.before, &after = s.decision.after;
  const int change =
    after.inner_defects - before.inner_defects + boundary_folds(state, patch) - folds_before;
  const bool is_better = change < 0 || (change == 0 && after.energy < before.energy);
  if(!is_better && !s.decision.is_final)
  {
    exchange(state, patch, s.placed);
    s.decision.accepted = false;
    s.decision.after = s.decision.before;
    return false;
  }
  s.decision.after.boundary_defects =
    before.boundary_defects + change - (after.inner_defects - before.inner_defects);
  return true;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_COMMIT_H
