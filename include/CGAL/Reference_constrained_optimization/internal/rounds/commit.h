// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_COMMIT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_COMMIT_H

#include <CGAL/Reference_constrained_optimization/internal/rounds/patch_solver.h>

#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// numbers of folds and creases at the edges between the patch and faces outside it
struct Boundary_edges
{
  int folds = 0, creases = 0;
};

// as the state is now
inline Boundary_edges boundary_edges(const Optimization_state& state, const Solved_patch& s)
{
  const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
  Boundary_edges result;
  for(const Solved_patch::Boundary_edge& edge : s.boundary)
  {
    const Vector_3 inside = face_normal(state.mesh, vertex, edge.inside),
                   outside = face_normal(state.mesh, vertex, edge.outside);
    result.folds += is_folded(inside, outside);
    result.creases += !edge.is_on_line && is_crease(inside, outside);
  }
  return result;
}

// the energy of the stencils that other patches may have changed, for the current state
inline double shared_energy(const Optimization_state& state, const Solved_patch& s)
{
  double sum = 0;
  for(const int stencil : s.shared_stencils)
    sum += state.stencils.value_at(
      stencil, [&](int v) -> const Vector_3& { return state.vertices[v].position; });
  return sum;
}

// swaps some vertices of a patch, given by their local indices, with those of the state
inline void
exchange(Optimization_state& state, Solved_patch& s, const std::vector<int>& local_vertices)
{
  for(const int i : local_vertices)
    std::swap(state.vertices[s.patch.vertices[i]], s.located[i]);
}

// Decides whether an accepted patch is committed. Another patch of the round may have moved faces across
// its boundary since the acceptance test: folds and creases there are counted again, and shared stencils are
// evaluated again. Only the vertices of boundary faces and shared stencils are exchanged; `commit_inside()`
// has to follow.
inline void commit_boundary(Optimization_state& state, Solved_patch& s)
{
  if(!s.decision.accepted)
    return;
  const Boundary_edges edges_before = boundary_edges(state, s);
  const double shared_before = shared_energy(state, s);
  exchange(state, s, s.outer_vertices);
  const Patch_measure &before = s.decision.before, &after = s.decision.after;
  const Boundary_edges edges_after = boundary_edges(state, s);
  const int change =
    after.inner_defects - before.inner_defects + edges_after.folds - edges_before.folds;
  const int crease_change =
    after.inner_creases - before.inner_creases + edges_after.creases - edges_before.creases;
  // energies that are not shared have changed as in the acceptance test
  const double rise = s.shared_stencils.empty() ? 0
                                                : shared_energy(state, s) - shared_before -
                                                    (after.shared_energy - before.shared_energy);
  const bool is_better = crease_change <= state.crease_allowance() &&
                         (change < 0 || (change == 0 && after.energy + rise < before.energy));
  if(!is_better)
  {
    exchange(state, s, s.outer_vertices);
    s.decision.accepted = false;
    s.decision.after = s.decision.before;
    return;
  }
  state.number_of_creases += crease_change;
  s.decision.after.boundary_defects =
    before.boundary_defects + change - (after.inner_defects - before.inner_defects);
}

// Exchanges all other vertices of a committed patch; its `located` then holds the old ones. Patches of a
// round may be committed at the same time.
inline void commit_inside(Optimization_state& state, Solved_patch& s)
{
  exchange(state, s, s.inner_vertices);
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_COMMIT_H
