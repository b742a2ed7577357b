// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_ROUND_SOLVER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_ROUND_SOLVER_H

#include <CGAL/Reference_constrained_optimization/Default_visitor.h>
#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/commit_round.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/active_set.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_selection.h>
#include <CGAL/Reference_constrained_optimization/internal/support/for_each_patch.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Solves the patches of a round, each from the state before the round, commits those that are accepted, and
// updates what depends on the state: geometry of faces and samples of drift.
template <typename ConcurrencyTag, typename Visitor>
class Round_solver
{
public:
  // sums over the rounds since the last call to `begin_iteration()`
  struct Progress
  {
    std::vector<char> moved;   // per vertex: by more than the tolerance
    bool has_rejected = false; // a patch on the surface
    // on the surface, summed over the vertices: the accepted fractions of their steps, and the number of
    // vertices
    double sum_of_fractions = 0, number_of_movable_vertices = 0;
    // on the surface: the predicted decrease that was not achieved since steps were cut
    double unrealized_decrease = 0;
  };

  Round_solver(Optimization_state& state,
               const Loop_parameters& parameters,
               Visitor& visitor,
               Result& result,
               Interruption& interruption)
    : m_state(state),
      m_visitor(visitor),
      m_result(result),
      m_interruption(interruption),
      m_for_each([&state, &parameters, &interruption]() {
        return Patch_solver(state, parameters, &interruption);
      })
  {}

  // from the state as it is, before the first round
  void initialize(Shape_bound shape_bound)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    std::vector<Vector_3> points(mesh.number_of_vertices());
    for(int v = 0; v < mesh.number_of_vertices(); ++v)
      points[v] = m_state.vertices[v].position;
    m_shape_bound = std::move(shape_bound);
    m_interruption.check();
    m_geometry.update(mesh, points);
    m_interruption.check();
    m_edge_length = vertex_edge_lengths(mesh, points);
    begin_iteration();
  }

  void begin_iteration()
  {
    m_progress = Progress();
    m_progress.moved.assign(m_state.mesh.number_of_vertices(), 0);
  }

  const Progress& progress() const { return m_progress; }
  const Face_geometry& geometry() const { return m_geometry; }
  Shape_bound& shape_bound() { return m_shape_bound; }
  void set_finishing(bool is_finishing) { m_is_finishing = is_finishing; } // for reports

  // false if it was interrupted; patches that were solved by then are committed
  template <typename Density>
  bool solve(const std::vector<std::vector<int>>& patches,
             Moves moves,
             const Density& density,
             const Solver_settings& settings)
  {
    m_visitor.on_round_begin(patches.size());
    ++m_result.number_of_rounds;
    std::vector<Solved_patch> solved(patches.size());
    m_for_each(
      patches.size(),
      [&](Patch_solver& solver, std::size_t i) {
        if(m_interruption.should_stop())
          return;
        try
        {
          solver.solve(patches[i], m_state, density, settings, m_shape_bound, moves, solved[i]);
        }
        catch(const Interrupted&)
        {
          solved[i] = Solved_patch(); // as if it had not been started
        }
      },
      [&]() { m_interruption.should_stop(); });
    commit_round(
      m_state, solved, m_for_each, [&](const Solved_patch& s) { report(s); },
      [&](const Solved_patch& s) { update(s); });
    m_visitor.on_round_end();
    return !m_interruption.has_stopped();
  }

private:
  // Fraction of the mean edge length at a vertex: vertices that move less do not keep their surroundings
  // active. Small displacements of many vertices together may add up, which is why two rings are active.
  static constexpr double movement_tolerance = 0.02;

  // updates the data of the vertices and faces of a patch that was committed; `s.located` holds the old
  // vertices
  void update(const Solved_patch& s)
  {
    const Patch& patch = s.patch;
    for(const std::vector<int>* vertices : {&s.outer_vertices, &s.inner_vertices})
      for(const int i : *vertices)
      {
        const int v = patch.vertices[i];
        const double moved = (m_state.vertices[v].position - s.located[i].position).norm();
        if(moved > movement_tolerance * m_edge_length[v])
          m_progress.moved[v] = 1;
      }
    for(const int f : patch.faces)
      m_geometry.set(m_state.mesh, f,
                     [&](int v) -> const Vector_3& { return m_state.vertices[v].position; });
    m_shape_bound.store(patch.faces, s.projected_samples, s.samples);
  }

  void report(const Solved_patch& s)
  {
    ++m_result.number_of_patches;
    m_result.sum_of_patch_sizes += double(s.number_of_faces);
    m_result.times.flattening += s.flattening_time;
    m_result.times.optimization += s.optimization_time;
    m_result.times.acceptance += s.acceptance_time;
    if(s.is_flattened)
    {
      m_result.conformal_flattenings += s.path == Flattening_path::conformal;
      m_result.convex_border_flattenings += s.path == Flattening_path::convex_border;
      m_result.failed_flattenings += s.path == Flattening_path::failed;
      m_result.overlapping_flattenings += s.overlaps;
      m_result.sum_of_flattening_distortion += s.distortion;
    }
    if(s.decision.accepted)
      m_state.angle_gain += s.decision.after.angles - s.decision.before.angles;
    m_state.volume_change += s.decision.after.volume - s.decision.before.volume;
    m_result.number_of_accepted_patches += s.decision.accepted;
    m_result.number_of_flattened_patches += s.decision.accepted && s.is_flattened;
    if(s.was_tried && !s.is_flattened)
    {
      m_progress.sum_of_fractions += s.accepted_fraction * s.number_of_free_vertices;
      m_progress.number_of_movable_vertices += s.number_of_free_vertices;
      m_progress.unrealized_decrease += s.unrealized_decrease;
    }
    m_progress.has_rejected =
      m_progress.has_rejected || (s.was_tried && !s.decision.accepted && !s.is_flattened);

    Patch_report report;
    report.number_of_faces = s.number_of_faces;
    report.energy_before = s.decision.before.energy;
    report.energy_after = s.decision.after.energy;
    report.defects_before = std::size_t(s.decision.before.defects());
    report.defects_after = std::size_t(s.decision.after.defects());
    report.accepted = s.decision.accepted;
    report.is_finishing = m_is_finishing;
    m_visitor.on_patch_end(report);
  }

  Optimization_state& m_state;
  Visitor& m_visitor;
  Result& m_result;
  Interruption& m_interruption;
  For_each_patch<ConcurrencyTag, Patch_solver> m_for_each;
  Face_geometry m_geometry;
  std::vector<double> m_edge_length; // per vertex, of the input
  Shape_bound m_shape_bound;
  Progress m_progress;
  bool m_is_finishing = false;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_ROUND_SOLVER_H
