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

// What all stages have in common: the mesh on its reference, the energy as it is optimized now, and the ways
// to visit faces in patches. A visit returns false if it was cut short; the state then holds what was
// accepted.
template <typename ConcurrencyTag_, typename Densities_, typename Visitor>
class Patch_visits
{
public:
  typedef ConcurrencyTag_ ConcurrencyTag;
  typedef Densities_ Densities;

  Patch_visits(Optimization_state& state_,
               const Densities& target,
               double energy, // by these, at the start
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
      judges_angles(state_.elements.criterion() == Element_criterion::smallest_angle),
      selection(state_.mesh, sized(parameters_, state_.mesh, judges_angles)),
      small_selection(state_.mesh, small(parameters_.selection, state_.mesh)),
      partition(state_.mesh,
                on_surface_patch_size(parameters_.selection, state_.mesh),
                largest_patch_size(parameters_.selection)),
      round_solver(state_, parameters_, visitor_, result_, interruption_),
      m_exponent(target),
      m_random(parameters_.random_seed),
      m_small_partition(state_.mesh,
                        small_patch_size(parameters_.selection, state_.mesh),
                        largest_patch_size(parameters_.selection)),
      m_rounds(state_.mesh, parameters_.halo)
  {
    settings.limits.accepts_all = parameters.accepts_all;
    settings.strain_resistance = largest_resistance;
  }

  // Measures the state, and sets up the bounds that stages start from. Throws Interrupted.
  Global_measure initialize()
  {
    m_exponent.template advance<ConcurrencyTag>(state);
    const Global_measure before = rescale();
    if(state.stencils.empty())
      settings.limits.cosine = before.sharpest;
    state.guards_angles = judges_angles && state.stencils.empty();
    m_initial_angles = sum_of_angles();
    m_initial_volume = volume_of_parts(state);
    interruption.check();
    round_solver.initialize(make_drift_guard());
    interruption.check();
    return before;
  }

  // the densities that are optimized now
  const Densities& densities() const { return m_exponent.densities(); }
  bool has_target_densities() const { return m_exponent.is_complete(); }

  // To steeper densities, if they are due; then all that depends on them is measured anew, and `now` is how
  // the state stands by them.
  bool advance_densities(Global_measure& now)
  {
    if(!m_exponent.template advance<ConcurrencyTag>(state))
      return false;
    now = remeasure();
    return true;
  }

  // measures what bounds and barriers depend on, and returns how the state stands
  Global_measure remeasure()
  {
    const Global_measure now = rescale();
    round_solver.drift_guard().set_barrier(make_barrier());
    return now;
  }

  Global_measure measure() const
  {
    return internal::measure<ConcurrencyTag>(state, densities(), m_cap);
  }
  // by the densities that the caller asked for
  double target_energy() const
  {
    return internal::measure<ConcurrencyTag>(state, target_densities,
                                             std::numeric_limits<double>::infinity())
      .energy;
  }
  // what the elements would have at rest
  double rest_energy() const { return m_rest_energy; }

  // what steps may not lower, or change much, in sum
  void update_sums()
  {
    state.angle_surplus = sum_of_angles() - m_initial_angles;
    if(state.guards_volume())
      state.volume_change = volume_of_parts(state) - m_initial_volume;
  }

  std::vector<char> free_faces() const
  {
    return faces_around<ConcurrencyTag>(state.mesh, state.is_free, 0);
  }

  // visits the wanted faces in flattened patches, until all are touched
  bool flatten(const std::vector<char>& is_wanted, Patch_selection& chosen)
  {
    const Indexed_mesh& mesh = state.mesh;
    std::vector<int> seeds;
    for(int f = 0; f < mesh.number_of_faces(); ++f)
      if(is_wanted[f])
        seeds.push_back(f);
    for(std::size_t i = seeds.size(); i > 1; --i)
      std::swap(seeds[i - 1], seeds[m_random.get_int(0, int(i))]);
    m_is_untouched = is_wanted;
    chosen.forget_visits();

    while(true)
    {
      if(interruption.stops())
        return false;
      const auto start = std::chrono::steady_clock::now();
      const std::vector<std::vector<int>> patches =
        m_rounds.select(seeds, m_is_untouched, chosen, round_solver.geometry(), &interruption);
      result.times.selection += seconds_since(start);
      if(patches.empty())
        return true;
      if(!round_solver.solve(patches, Moves::flattened, densities(), settings))
        return false;
    }
  }

  // divides the wanted faces into large patches
  std::vector<std::vector<int>> divide(const std::vector<char>& is_wanted)
  {
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::vector<int>> patches = partition.divide(is_wanted, m_random, &interruption);
    result.times.selection += seconds_since(start);
    return patches;
  }

  // visits the wanted faces in one round of small patches that are not flattened, of which each is a
  // region of wanted faces if that is not too large
  template <typename AnyDensities>
  bool visit_regions(const std::vector<char>& is_wanted, Moves moves, const AnyDensities& densities)
  {
    if(interruption.stops())
      return false;
    const auto start = std::chrono::steady_clock::now();
    const std::vector<std::vector<int>> patches =
      m_small_partition.divide_regions(is_wanted, m_random);
    result.times.selection += seconds_since(start);
    return round_solver.solve(patches, moves, densities, settings);
  }

  Optimization_state& state;
  const Densities& target_densities; // what the caller asked for
  const double initial_energy;       // by these
  const Loop_parameters& parameters;
  Visitor& visitor;
  Result& result;
  Interruption& interruption;
  const bool judges_angles; // whether worst elements are judged by their angles
  Patch_selection selection, small_selection;
  Patch_partition partition;
  Round_solver<ConcurrencyTag, Visitor> round_solver;
  Solver_settings settings;

private:
  // measures what depends on the densities, and returns how the state stands by them
  Global_measure rescale()
  {
    // stuck elements own the sum: convergence is also judged on a sum to which each gives ten times
    // the mean of the better half at most
    const double typical = lower_half_mean<ConcurrencyTag>(state, densities());
    interruption.check();
    m_cap = 10 * typical;
    m_rest_energy = internal::rest_energy(state, densities());
    const Global_measure now = measure();
    // what stencils ask for is paid with the shape of elements
    settings.limits.density =
      state.stencils.empty() ? now.worst : std::numeric_limits<double>::infinity();
    settings.bad_density = 1.5 * typical;
    return now;
  }

  // of the faces' smallest, in degrees
  double sum_of_angles() const
  {
    const Indexed_mesh& mesh = state.mesh;
    const auto vertex = [&](int v) -> const Placed_vertex& { return state.vertices[v]; };
    const int n = state.guards_angles ? mesh.number_of_faces() : 0;
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
      triangles += state.counts(f) ? mesh.degree(f) - 2 : 0;
    return Drift_barrier(0.1 * m_rest_energy / triangles);
  }

  // By default the bound is a quarter of R's mean edge, or what keeps steps from taking the mesh further
  // away than it is: a mesh that is coarser than R, or the image of a map, is further away by nature.
  // Flattened patches alone see the barrier only where it is felt already, and stall in front of it: for
  // them it has to be asked for.
  Drift_guard make_drift_guard()
  {
    Drift_guard guard;
    const double bound = parameters.drift_bound;
    if(bound > (std::numeric_limits<double>::max)() ||
       (bound < 0 && !parameters.use_on_surface_steps))
      return guard;
    const double edge = state.reference.mean_edge_length(), smallest = 1e-6 * edge;
    guard.initialize<ConcurrencyTag>(state, bound < 0 ? 0.25 * edge : (std::max)(bound, smallest),
                                     bound < 0, make_barrier(), &interruption);
    result.drift_bound = guard.bound();
    result.initial_drift = guard.initial_drift();
    return guard;
  }

  Exponent_continuation<Densities> m_exponent;
  CGAL::Random m_random;
  Patch_partition m_small_partition;
  Patch_rounds m_rounds;
  std::vector<char> m_is_untouched; // per face
  double m_cap = 0;                 // of the density of an element, where convergence is judged
  double m_rest_energy = 0;
  double m_initial_angles = 0; // their sum
  double m_initial_volume = 0; // six times that
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_PATCH_VISITS_H
