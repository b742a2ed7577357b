// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_ITERATION_STAGE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_ITERATION_STAGE_H

#include <CGAL/Reference_constrained_optimization/internal/stages/Patch_visits.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
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

  // from a state of which `before` are the figures; false if it was cut short
  bool run(Global_measure before)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const Loop_parameters& parameters = m_visits.parameters;
    auto& settings = m_visits.settings;
    for(std::size_t i = 0; i < parameters.number_of_iterations; ++i)
    {
      m_visits.visitor.on_iteration_begin(i);
      m_visits.round_solver.begin_iteration();
      m_visits.update_sums();
      ++m_visits.result.number_of_iterations;
      const bool complete = visit_active_unless_interrupted();
      const Global_measure after = m_visits.measure();
      const double energy =
        m_visits.has_target_densities() ? after.energy : m_visits.target_energy();
      m_visits.visitor.on_iteration_end(i, energy / double(m_state.elements.size()));
      if(!complete)
        return false;
      if(m_state.stencils.empty())
        settings.limits.density = (std::min)(settings.limits.density, after.worst);
      const auto& progress = m_visits.round_solver.progress();
      if(progress.could_move > 0)
        settings.strain_resistance =
          (std::min)(largest_resistance, adapted_resistance(settings.strain_resistance,
                                                            progress.taken / progress.could_move));
      m_held_up = is_held_up() ? m_held_up + 1 : 0;
      const int patience = 5; // large patches may go slowly, but they go further
      const bool divides = m_visits.judges_angles && m_held_up >= patience && divide_further();
      const bool falls = has_fallen(before.capped_energy, after.capped_energy);
      const bool repairs =
        has_fallen(before.energy, after.energy) || after.defects() < before.defects();
      std::vector<char> moved = progress.moved;
      if(!falls && repairs)
        keep_near_bad<ConcurrencyTag>(m_state, m_visits.densities(), settings.bad_density,
                                      moved); // all is well elsewhere
      const bool moves = std::find(moved.begin(), moved.end(), char(1)) != moved.end();
      // without a test the energy may rise: that is not convergence either
      const bool rises = parameters.accepts_all && has_fallen(after.energy, before.energy);
      before = after;
      if(m_visits.advance_densities(before))
        m_is_active = m_visits.free_faces();
      else if(moves && (repairs || falls || rises))
      {
        if(parameters.use_active_set)
          m_is_active = faces_around<ConcurrencyTag>(mesh, moved, 2);
      }
      else if((!has_fallen(after.capped_energy + progress.missed, after.capped_energy) ||
               !(divides || ((m_held_up > 0 || progress.has_refused) && divide_further()))) &&
              !starts_again(after.capped_energy))
      {
        m_visits.result.status = Status::converged;
        return true;
      }
    }
    return parameters.number_of_iterations > 0;
  }

private:
  bool visit_active_unless_interrupted()
  {
    try
    {
      return visit_active();
    }
    catch(const Interrupted&)
    {
      return false;
    }
  }

  // What is turned over or folded, or bad over a whole region, is flattened: steps on the surface do
  // not mend it. Then all regions are optimized on the surface, where that is allowed.
  bool visit_active()
  {
    if(!m_visits.parameters.use_on_surface_steps)
      return m_visits.flatten(m_is_active, m_visits.selection);
    std::vector<char> is_wanted;
    std::vector<std::vector<int>> patches;
    const std::size_t iteration = m_visits.result.number_of_iterations;
    // what flattened patches do not mend at once they hardly ever do: they try more and more rarely
    const bool flattens = !m_visits.judges_angles || iteration >= m_next_to_flatten;
    if(flattens)
      m_next_to_flatten = 2 * iteration + 1;
    // the second patches do not depend on what the first ones do
    call_both<ConcurrencyTag>(
      [&]() {
        if(flattens)
          is_wanted = faces_to_flatten();
      },
      [&]() { patches = m_visits.divide(m_is_active); });
    return (!flattens || m_visits.flatten(is_wanted, m_visits.selection)) &&
           !m_visits.interruption.stops() &&
           m_visits.round_solver.solve(patches, Moves::on_surface, m_visits.densities(),
                                       m_visits.settings);
  }

  // the active faces that are turned over or folded or in bad regions, and those around them
  std::vector<char> faces_to_flatten() const
  {
    const Indexed_mesh& mesh = m_state.mesh;
    // sharp triangles are a matter of their vertices, stretched ones of what is around them; in a fine
    // mesh what was one triangle is many
    const int smallest_region =
      m_visits.judges_angles ? (std::max)(20, mesh.number_of_faces() / 2500) : 1;
    std::vector<char> is_wanted = defective_faces<ConcurrencyTag>(m_state);
    m_visits.interruption.check();
    const std::vector<char> is_bad = bad_regions<ConcurrencyTag>(
      m_state, m_visits.densities(), 2 * m_visits.settings.bad_density, smallest_region);
    for(std::size_t f = 0; f < is_wanted.size(); ++f)
      is_wanted[f] = is_wanted[f] || is_bad[f];
    m_visits.interruption.check();
    is_wanted = faces_around<ConcurrencyTag>(mesh, vertices_of<ConcurrencyTag>(mesh, is_wanted), 2);
    for(std::size_t f = 0; f < is_wanted.size(); ++f)
      is_wanted[f] = is_wanted[f] && m_is_active[f];
    return is_wanted;
  }

  // What is left to gain is what the energy has above that of elements that are all at rest.
  bool has_fallen(double before, double after) const
  {
    const double floor = 0.001;
    const double excess = before - m_visits.rest_energy();
    const double scale =
      excess > 0 ? (std::max)(excess, floor * std::abs(before)) : std::abs(before);
    return before - after > m_visits.parameters.energy_tolerance * scale;
  }

  // Whether a few places hold up the large patches that they are in: the steps of the last iteration
  // were cut to small parts.
  bool is_held_up() const
  {
    const auto& progress = m_visits.round_solver.progress();
    return progress.taken < 0.8 * progress.could_move; // neither is counted for flattened patches
  }

  // From the next iteration on patches are smaller. False if they are small enough.
  bool divide_further()
  {
    const int smallest = 1000, parts = 4;
    const int size = m_visits.partition.patch_size() / parts;
    if(size < smallest)
      return false;
    m_visits.partition.set_patch_size(size);
    return true;
  }

  // Where small patches have come to rest, patches larger than those at first may go on: what spreads
  // over all of a region is a matter of theirs, once no single place in it holds them up. Everything
  // is visited again, and again as long as that pays; false if it did not.
  bool starts_again(double energy)
  {
    const Selection_parameters& selection = m_visits.parameters.selection;
    const bool pays = !m_has_rested || has_fallen(m_resting_energy, energy);
    if(!m_visits.judges_angles || !m_visits.parameters.use_on_surface_steps || !pays)
      return false;
    const int times = 4;
    m_has_rested = true;
    m_resting_energy = energy;
    const int size = on_surface_patch_size(selection, m_state.mesh),
              largest = largest_patch_size(selection);
    m_visits.partition.set_patch_size(size < largest / times ? times * size : largest);
    m_held_up = 0;
    m_is_active = m_visits.free_faces();
    return true;
  }

  Visits& m_visits;
  const Optimization_state& m_state;
  std::vector<char> m_is_active;     // per face
  std::size_t m_next_to_flatten = 0; // iteration
  int m_held_up = 0;                 // iterations in a row
  bool m_has_rested = false;
  double m_resting_energy = 0; // when iterations came to rest the last time
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_ITERATION_STAGE_H
