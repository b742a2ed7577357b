// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_PATCH_VISITS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_PATCH_VISITS_H

#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/Round_solver.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/active_set.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_partition.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_rounds.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/exponent_continuation.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <CGAL/Random.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The common data of all stages: the mesh on its reference, the current energy, and functions that visit
// faces in patches. A visit returns false if it was interrupted; the state then holds the accepted patches.
template <typename ConcurrencyTag_, typename Densities_, typename Visitor>
class Patch_visits
{
public:
  typedef ConcurrencyTag_ ConcurrencyTag;
  typedef Densities_ Densities;

  Patch_visits(Optimization_state& state_,
               const Densities& target,
               double energy, // of `target`, at the start
               const Loop_parameters& parameters_,
               Visitor& visitor_,
               Result& result_,
               Interruption& interruption_)
    : state(state_),
      target_densities(target),
      initial_energy(energy),
      parameters(parameters_),
      visitor(visitor_),
      result(result_),
      interruption(interruption_),
      has_angle_criterion(state_.elements.criterion() == Element_criterion::smallest_angle),
      selection(state_.mesh, with_patch_size(parameters_, state_.mesh, has_angle_criterion)),
      partition(state_.mesh,
                on_surface_patch_size(parameters_.selection, state_.mesh),
                largest_patch_size(parameters_.selection)),
      round_solver(state_, parameters_, visitor_, result_, interruption_),
      m_exponent(target),
      m_random(parameters_.random_seed),
      m_small_partition(state_.mesh,
                        small_patch_size(parameters_.selection, state_.mesh),
                        largest_patch_size(parameters_.selection)),
      m_rounds(state_.mesh)
  {
    settings.strain_regularization = largest_regularization;
  }

  // Measures the state, and initializes the bounds of the stages. Throws Interrupted.
  Global_measure initialize()
  {
    m_exponent.template advance<ConcurrencyTag>(state);
    const Global_measure before = rescale();
    if(state.stencils.empty())
      settings.limits.cosine = before.largest_cosine;
    state.bounds_mean_angle = has_angle_criterion && state.stencils.empty();
    m_initial_angles = sum_of_angles();
    m_initial_volume = volume_of_mechanical_parts(state);
    interruption.check();
    round_solver.initialize(make_shape_bound());
    interruption.check();
    return before;
  }

  // the current densities
  const Densities& densities() const { return m_exponent.densities(); }
  bool has_target_densities() const { return m_exponent.is_complete(); }

  // Continues with a larger exponent if possible; then everything that depends on it is computed again, and
  // `now` is the measure of the state with it.
  bool advance_densities(Global_measure& now)
  {
    if(!m_exponent.template advance<ConcurrencyTag>(state))
      return false;
    now = remeasure();
    return true;
  }

  // computes the values that bounds and barriers depend on, and measures the state
  Global_measure remeasure()
  {
    const Global_measure now = rescale();
    round_solver.shape_bound().set_barrier(make_barrier());
    return now;
  }

  Global_measure measure() const
  {
    return internal::measure<ConcurrencyTag>(state, densities(), m_cap);
  }
  // with the requested densities
  double target_energy() const
  {
    return internal::measure<ConcurrencyTag>(state, target_densities,
                                             std::numeric_limits<double>::infinity())
      .energy;
  }
  // the energy of the elements at rest
  double rest_energy() const { return m_rest_energy; }

  // the sums that steps may not lower, or not change by much
  void update_sums()
  {
    state.angle_gain = sum_of_angles() - m_initial_angles;
    if(state.bounds_volume())
      state.volume_change = volume_of_mechanical_parts(state) - m_initial_volume;
  }

  std::vector<char> free_faces() const
  {
    return faces_around<ConcurrencyTag>(state.mesh, state.is_free, 0);
  }

  // visits the selected faces in flattened patches, until all are touched
  bool flatten(const std::vector<char>& is_selected)
  {
    const Indexed_mesh& mesh = state.mesh;
    std::vector<int> seeds;
    for(int f = 0; f < mesh.number_of_faces(); ++f)
      if(is_selected[f])
        seeds.push_back(f);
    for(std::size_t i = seeds.size(); i > 1; --i)
      std::swap(seeds[i - 1], seeds[m_random.get_int(0, int(i))]);
    m_is_untouched = is_selected;
    selection.clear_visits();

    while(true)
    {
      if(interruption.should_stop())
        return false;
      const auto start = std::chrono::steady_clock::now();
      const std::vector<std::vector<int>> patches =
        m_rounds.select(seeds, m_is_untouched, selection, round_solver.geometry(), &interruption);
      result.times.selection += seconds_since(start);
      if(patches.empty())
        return true;
      if(!round_solver.solve(patches, Moves::flattened, densities(), settings))
        return false;
    }
  }

  // divides the selected faces into large patches
  std::vector<std::vector<int>> divide(const std::vector<char>& is_selected)
  {
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::vector<int>> patches = partition.divide(is_selected, m_random, &interruption);
    result.times.selection += seconds_since(start);
    return patches;
  }

  // visits the selected faces in one round of small patches that are not flattened, each a connected region
  // of selected faces if that is not too large
  template <typename AnyDensities>
  bool
  visit_regions(const std::vector<char>& is_selected, Moves moves, const AnyDensities& densities)
  {
    if(interruption.should_stop())
      return false;
    const auto start = std::chrono::steady_clock::now();
    const std::vector<std::vector<int>> patches =
      m_small_partition.divide_regions(is_selected, m_random);
    result.times.selection += seconds_since(start);
    return round_solver.solve(patches, moves, densities, settings);
  }

  Optimization_state& state;
  const Densities& target_densities; // requested by the caller
  const double initial_energy;       // of these
  const Loop_parameters& parameters;
  Visitor& visitor;
  Result& result;
  Interruption& interruption;
  // whether the criterion for the worst elements is the smallest angle
  const bool has_angle_criterion;
  Patch_selection selection;
  Patch_partition partition;
  Round_solver<ConcurrencyTag, Visitor> round_solver;
  Solver_settings settings;

private:
  // computes the values that depend on the densities, and measures the state with them
  Global_measure rescale()
  {
    // bad elements dominate the sum: convergence is also tested on a sum in which each is capped at ten
    // times the mean of the better half
    const double typical = lower_half_mean<ConcurrencyTag>(state, densities());
    interruption.check();
    m_cap = 10 * typical;
    m_rest_energy = internal::rest_energy(state, densities());
    const Global_measure now = measure();
    // stencils may increase the density of elements
    settings.limits.density =
      state.stencils.empty() ? now.largest_density : std::numeric_limits<double>::infinity();
    settings.bad_density = 1.5 * typical;
    return now;
  }

  // sum of the faces' smallest angles, in degrees
  double sum_of_angles() const
  {
    const Indexed_mesh& mesh = state.mesh;
    const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
    const int n = state.bounds_mean_angle ? mesh.number_of_faces() : 0;
    std::vector<double> sums(number_of_blocks(n), 0);
    for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int block) {
      for(int f = begin; f < end; ++f)
        sums[block] +=
          degrees_per_radian * std::acos((std::min)(1., smallest_angle_cosine(mesh, vertex, f)));
    });
    double sum = 0;
    for(const double s : sums)
      sum += s;
    return sum;
  }

  Drift_barrier make_barrier() const
  {
    const Indexed_mesh& mesh = state.mesh;
    double triangles = 0;
    for(int f = 0; f < mesh.number_of_faces(); ++f)
      triangles += state.is_optimized(f) ? mesh.degree(f) - 2 : 0;
    return Drift_barrier(0.1 * m_rest_energy / triangles);
  }

  // By default the bound is a quarter of R's mean edge, or the distance of the input if that is larger: a
  // mesh that is coarser than R, or the image of a map, is necessarily further away. Flattened patches
  // alone consider the barrier only where it is active, and stall there: for them a bound has to be given.
  Shape_bound make_shape_bound()
  {
    Shape_bound shape_bound;
    const double bound = parameters.drift_bound;
    if(bound > (std::numeric_limits<double>::max)() ||
       (bound < 0 && !parameters.use_on_surface_steps))
      return shape_bound;
    const double edge = state.reference.mean_edge_length(), smallest = 1e-6 * edge;
    shape_bound.initialize<ConcurrencyTag>(state,
                                           bound < 0 ? 0.25 * edge : (std::max)(bound, smallest),
                                           bound < 0, make_barrier(), &interruption);
    result.drift_bound = shape_bound.bound();
    result.initial_drift = shape_bound.initial_drift();
    return shape_bound;
  }

  Exponent_continuation<Densities> m_exponent;
  CGAL::Random m_random;
  Patch_partition m_small_partition;
  Patch_rounds m_rounds;
  std::vector<char> m_is_untouched; // per face
  double m_cap = 0;                 // of the density of an element, in the test of convergence
  double m_rest_energy = 0;
  double m_initial_angles = 0; // their sum
  double m_initial_volume = 0; // six times that
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_PATCH_VISITS_H
