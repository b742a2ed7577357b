// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_COMMIT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_COMMIT_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_triangle.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/patch_solver.h>

#include <algorithm>
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

// the number of pairs of a face of the patch and another of these that intersect, as the state is now
inline int number_of_intersections(const Optimization_state& state,
                                   const Solved_patch& s,
                                   const std::vector<int>& others)
{
  if(s.faces_near_sheets.empty() || others.empty())
    return 0;
  const auto point = [&](int v) -> const Vector_3& { return state.vertices[v].position; };
  int number = 0;
  for_each_close_pair(
    triangles_of(state.mesh, point, s.faces_near_sheets), triangles_of(state.mesh, point, others),
    [&](const Indexed_triangle& a, const Indexed_triangle& b) { number += intersect(a, b); });
  return number;
}

// swaps some vertices of a patch, given by their local indices, with those of the state
inline void
exchange(Optimization_state& state, Solved_patch& s, const std::vector<int>& local_vertices)
{
  for(const int i : local_vertices)
    std::swap(state.vertices[s.patch.vertices[i]], s.located[i]);
}

// how many more the patch has since its outer vertices were exchanged
inline int
added_intersections(Optimization_state& state, Solved_patch& s, const std::vector<int>& others)
{
  const int after = number_of_intersections(state, s, others);
  if(after == 0)
    return 0;
  exchange(state, s, s.outer_vertices);
  const int before = number_of_intersections(state, s, others);
  exchange(state, s, s.outer_vertices);
  return (std::max)(0, after - before);
}

// Decides whether an accepted patch is committed. Another patch of the round may have moved faces across
// its boundary since the acceptance test: folds and creases there are counted again, shared stencils are
// evaluated again, and faces are tested for intersections with `moved`, those of the patches of this round
// that are committed already, near which R has another sheet. Only the outer vertices are exchanged;
// `commit_inside()` has to follow.
inline void commit_boundary(Optimization_state& state, Solved_patch& s, std::vector<int>& moved)
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
  const int intersection_change =
    after.added_intersections - before.added_intersections + added_intersections(state, s, moved);
  // energies that are not shared have changed as in the acceptance test
  const double rise = s.shared_stencils.empty() ? 0
                                                : shared_energy(state, s) - shared_before -
                                                    (after.shared_energy - before.shared_energy);
  const bool is_better = crease_change <= state.counts.creases.allowance() &&
                         intersection_change <= state.counts.intersections.allowance() &&
                         (change < 0 || (change == 0 && after.energy + rise < before.energy));
  if(!is_better)
  {
    exchange(state, s, s.outer_vertices);
    s.decision.accepted = false;
    s.decision.after = s.decision.before;
    return;
  }
  state.counts.creases.now += crease_change;
  state.counts.intersections.now += intersection_change;
  moved.insert(moved.end(), s.faces_near_sheets.begin(), s.faces_near_sheets.end());
  state.update_near_sheets(s.faces_near_sheets);
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
