// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_ITERATION_STAGE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_ITERATION_STAGE_H

#include <CGAL/Reference_constrained_optimization/internal/stages/Patch_visits.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/saved_state.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The outer iterations of Algorithm 1 in the paper, until the energy falls by less than the tolerance and no
// vertex moves. An iteration visits every active face in rounds of face-disjoint patches. All vertices that a
// patch moves have all their faces in it, so that the patches of a round can be solved independently of one
// another, from the state before the round; they are then committed in a fixed order, where only what two of
// them share is tested again. The result does not depend on the number of threads.
template <typename Visits>
class Iteration_stage
{
  typedef typename Visits::ConcurrencyTag ConcurrencyTag;

public:
  explicit Iteration_stage(Visits& visits)
    : m_visits(visits),
      m_state(visits.state),
      m_is_active(visits.free_faces())
  {}

  // `before` is the measure of the initial state; false if it was interrupted
  bool run(Global_measure before)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const Loop_parameters& parameters = m_visits.parameters;
    auto& settings = m_visits.settings;
    for(std::size_t i = 0; i < parameters.number_of_iterations; ++i)
    {
      m_visits.visitor.on_iteration_begin(i);
      // where angles are bounded, later stages need the allowances more
      settings.limits.uses_allowances = !m_visits.has_angle_criterion && before.defects() > 0;
      ++m_visits.result.number_of_iterations;
      const bool complete =
        settings.limits.uses_allowances ? visit_folded() : visit_active_unless_interrupted();
      const Global_measure after = m_visits.measure();
      const double energy =
        m_visits.has_target_densities() ? after.energy : m_visits.target_energy();
      m_visits.visitor.on_iteration_end(i, energy / double(m_state.elements.size()));
      if(!complete)
        return false;
      if(m_state.stencils.empty())
        settings.limits.density = (std::min)(settings.limits.density, after.largest_density);
      const auto& progress = m_visits.round_solver.progress();
      if(progress.number_of_movable_vertices > 0)
        settings.strain_regularization = (std::min)(
          largest_regularization,
          adapted_regularization(settings.strain_regularization,
                                 progress.sum_of_fractions / progress.number_of_movable_vertices));
      m_stalled_iterations = is_stalled() ? m_stalled_iterations + 1 : 0;
      const int stall_limit = 5; // large patches may be slow, but they allow larger displacements
      const bool has_smaller_patches =
        m_visits.has_angle_criterion && m_stalled_iterations >= stall_limit && reduce_patch_size();
      const bool falls = has_decreased(before.capped_energy, after.capped_energy);
      const bool repairs =
        has_decreased(before.energy, after.energy) || after.defects() < before.defects();
      std::vector<char> moved = progress.moved;
      if(!falls && repairs)
        keep_near_bad<ConcurrencyTag>(m_state, m_visits.densities(), settings.bad_density,
                                      moved); // everything else has converged
      const bool moves = std::find(moved.begin(), moved.end(), char(1)) != moved.end();
      before = after;
      if(m_visits.advance_densities(before))
        m_is_active = m_visits.free_faces();
      else if(moves && (repairs || falls))
        m_is_active = faces_around<ConcurrencyTag>(mesh, moved, 2);
      else if((!has_decreased(after.capped_energy + progress.unrealized_decrease,
                              after.capped_energy) ||
               !(has_smaller_patches ||
                 ((m_stalled_iterations > 0 || progress.has_rejected) && reduce_patch_size()))) &&
              !restarts(after.capped_energy))
      {
        m_visits.result.status = Status::converged;
        return true;
      }
    }
    return parameters.number_of_iterations > 0;
  }

private:
  // Faces that lie on one another where R has no other sheet are not tested for intersections. After the first
  // iteration in which such pairs become more than on input, which is repeated, they are.
  bool visit_folded()
  {
    const Bounded_number& number = m_state.counts.intersections;
    if(m_watches_intersections)
      m_state.watch_intersections();
    if(m_watches_intersections || !number.is_bounded())
      return visit_active_unless_interrupted();
    std::vector<int> all(m_state.mesh.number_of_faces());
    std::iota(all.begin(), all.end(), 0);
    Saved_state start(m_state, m_visits.round_solver.shape_bound());
    start.add(all);
    const bool complete = visit_active_unless_interrupted();
    if(int(intersecting_faces(m_state.mesh, m_state.vertices).size()) <= number.largest)
      return complete;
    start.restore();
    m_watches_intersections = true;
    return visit_folded();
  }

  bool visit_active_unless_interrupted()
  {
    m_visits.round_solver.begin_iteration();
    m_visits.update_sums();
    try
    {
      return visit_active();
    }
    catch(const Interrupted&)
    {
      return false;
    }
  }

  // Inverted or folded faces and bad regions are flattened, since steps on the surface do not repair them.
  // Then all regions are optimized on the surface, where that is enabled.
  bool visit_active()
  {
    if(!m_visits.parameters.use_on_surface_steps)
      return m_visits.flatten(m_is_active);
    std::vector<char> is_selected;
    std::vector<std::vector<int>> patches;
    const std::size_t iteration = m_visits.result.number_of_iterations;
    // flattened patches repair most defects at once or never: they are visited more and more rarely
    const bool flattens = !m_visits.has_angle_criterion || iteration >= m_next_flattening_iteration;
    if(flattens)
      m_next_flattening_iteration = 2 * iteration + 1;
    // the second patches do not depend on the first ones
    call_both<ConcurrencyTag>(
      [&]() {
        if(flattens)
          is_selected = faces_to_flatten();
      },
      [&]() { patches = m_visits.divide(m_is_active); });
    return (!flattens || m_visits.flatten(is_selected)) && !m_visits.interruption.should_stop() &&
           m_visits.round_solver.solve(patches, Moves::on_surface, m_visits.densities(),
                                       m_visits.settings);
  }

  // the active faces that are inverted or folded or in bad regions, and those around them
  std::vector<char> faces_to_flatten() const
  {
    const Indexed_mesh& mesh = m_state.mesh;
    // sharp triangles depend on their vertices, stretched ones on their surroundings; in a fine mesh
    // regions have more faces
    const int smallest_region =
      m_visits.has_angle_criterion ? (std::max)(20, mesh.number_of_faces() / 2500) : 1;
    std::vector<char> is_selected = defective_faces<ConcurrencyTag>(m_state);
    m_visits.interruption.check();
    const std::vector<char> is_bad = bad_regions<ConcurrencyTag>(
      m_state, m_visits.densities(), 2 * m_visits.settings.bad_density, smallest_region);
    for(std::size_t f = 0; f < is_selected.size(); ++f)
      is_selected[f] = is_selected[f] || is_bad[f];
    m_visits.interruption.check();
    is_selected =
      faces_around<ConcurrencyTag>(mesh, vertices_of<ConcurrencyTag>(mesh, is_selected), 2);
    for(std::size_t f = 0; f < is_selected.size(); ++f)
      is_selected[f] = is_selected[f] && m_is_active[f];
    return is_selected;
  }

  // The decrease is relative to the excess of the energy over that of elements that are all at rest.
  bool has_decreased(double before, double after) const
  {
    const double floor = 0.001;
    const double excess = before - m_visits.rest_energy();
    const double scale =
      excess > 0 ? (std::max)(excess, floor * std::abs(before)) : std::abs(before);
    return before - after > m_visits.parameters.energy_tolerance * scale;
  }

  // Whether the steps of the last iteration were cut to small fractions: a few vertices limit the large
  // patches that contain them.
  bool is_stalled() const
  {
    const auto& progress = m_visits.round_solver.progress();
    // both count patches on the surface only
    return progress.sum_of_fractions < 0.8 * progress.number_of_movable_vertices;
  }

  // Makes the patches smaller from the next iteration on. False if they are small enough.
  bool reduce_patch_size()
  {
    const int smallest = 1000, parts = 4;
    const int size = m_visits.partition.patch_size() / parts;
    if(size < smallest)
      return false;
    m_visits.partition.set_patch_size(size);
    return true;
  }

  // Restarts with patches larger than the initial ones where small patches have converged: changes that
  // involve a whole region need large patches, once no single vertex limits their steps. Everything becomes
  // active again, as long as the energy has decreased since the last time; false if it has not.
  bool restarts(double energy)
  {
    const Selection_parameters& selection = m_visits.parameters.selection;
    const bool has_improved = !m_has_converged || has_decreased(m_converged_energy, energy);
    if(!m_visits.has_angle_criterion || !m_visits.parameters.use_on_surface_steps || !has_improved)
      return false;
    const int times = 4;
    m_has_converged = true;
    m_converged_energy = energy;
    const int size = on_surface_patch_size(selection, m_state.mesh),
              largest = largest_patch_size(selection);
    m_visits.partition.set_patch_size(size < largest / times ? times * size : largest);
    m_stalled_iterations = 0;
    m_is_active = m_visits.free_faces();
    return true;
  }

  Visits& m_visits;
  Optimization_state& m_state;
  std::vector<char> m_is_active; // per face
  std::size_t m_next_flattening_iteration = 0;
  int m_stalled_iterations = 0; // successive ones
  bool m_watches_intersections = false;
  bool m_has_converged = false;
  double m_converged_energy = 0; // at the last convergence
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_ITERATION_STAGE_H
