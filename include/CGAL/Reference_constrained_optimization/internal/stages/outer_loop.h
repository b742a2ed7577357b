// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_OUTER_LOOP_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_OUTER_LOOP_H

#include <CGAL/Reference_constrained_optimization/Default_visitor.h>
#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Angle_barrier_density.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/Cluster_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/Round_solver.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/active_set.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_partition.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_rounds.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/exponent_continuation.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/finishing_stage.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/saved_state.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/worst_faces.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <CGAL/Random.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Algorithm 1 of the paper. An outer iteration visits every active face; it consists of rounds of
// face-disjoint patches. All vertices that a patch moves have all their faces in it, so that the
// patches of a round can be solved independently of one another, from the state before the round;
// they are then committed in a fixed order, where only the edges between two of them are tested
// again. The result does not depend on the number of threads.
template <typename ConcurrencyTag, typename Densities, typename Visitor>
class Outer_loop
{
public:
  Outer_loop(Optimization_state& state,
             const Densities& densities,
             const Loop_parameters& parameters,
             Visitor& visitor,
             Result& result,
             Interruption& interruption)
    : m_state(state),
      m_target_densities(densities),
      m_exponent(densities),
      m_densities(m_exponent.densities()),
      m_parameters(parameters),
      m_visitor(visitor),
      m_result(result),
      m_interruption(interruption),
      m_random(parameters.random_seed),
      m_prizes_angles(state.elements.criterion() == Element_criterion::smallest_angle),
      m_selection(state.mesh, sized(parameters, state.mesh, m_prizes_angles)),
      m_small_selection(state.mesh, small(parameters.selection, state.mesh)),
      m_partition(state.mesh,
                  on_surface_patch_size(parameters.selection, state.mesh),
                  largest_patch_size(parameters.selection)),
      m_small_partition(state.mesh,
                        small_patch_size(parameters.selection, state.mesh),
                        largest_patch_size(parameters.selection)),
      m_rounds(state.mesh, parameters.halo),
      m_round_solver(state, m_parameters, visitor, result, interruption)
  {}

  // the state holds what was accepted, also when it is cut short or a visitor throws
  void run()
  {
    try
    {
      optimize();
    }
    catch(const Interrupted&)
    {}
    catch(...)
    {
      note_end();
      throw;
    }
    note_end();
  }

private:
  void note_end()
  {
    if(m_interruption.has_stopped())
      m_result.status = m_interruption.status();
    if(m_round_solver.drift_guard().is_on())
      m_result.drift = m_round_solver.drift_guard().template drift<ConcurrencyTag>(m_state);
  }

  void optimize()
  {
    const Indexed_mesh& mesh = m_state.mesh;
    m_settings.limits.accepts_all = m_parameters.accepts_all;
    m_settings.strain_resistance = largest_resistance;
    m_exponent.template advance<ConcurrencyTag>(m_state);
    Global_measure before = scale_to_density();
    m_settings.limits.cosine = before.sharpest;
    m_initial_energy = energy_of_caller();

    m_state.guards_angles = m_prizes_angles;
    m_initial_angles = sum_of_angles();
    m_initial_volume = volume_of_parts(m_state);
    m_interruption.check();
    m_round_solver.initialize(make_drift_guard());
    m_is_active = faces_around<ConcurrencyTag>(mesh, m_state.is_free, 0);

    m_interruption.check();
    m_result.status = Status::iteration_limit;
    if(m_prizes_angles && m_parameters.use_on_surface_steps &&
       m_parameters.number_of_iterations > 0)
    {
      if(!open_clusters())
        return;
      m_exponent.template advance<ConcurrencyTag>(m_state);
      before = scale_to_density();
      m_round_solver.drift_guard().set_barrier(make_barrier());
    }
    const bool revisits = m_parameters.use_on_surface_steps || m_parameters.use_finishing_stage;
    if(iterate_to_convergence(before) && revisits && revisit_worst() && finishes_angles())
      finish_angles();
  }

  // measures what hangs on the density, and returns how the state stands by it
  Global_measure scale_to_density()
  {
    // stuck elements own the sum: convergence is also judged on a sum to which each gives ten times
    // the mean of the better half at most
    const double typical = lower_half_mean<ConcurrencyTag>(m_state, m_densities);
    m_interruption.check();
    m_cap = 10 * typical;
    m_rest_energy = rest_energy(m_state, m_densities);
    const Global_measure now = measure<ConcurrencyTag>(m_state, m_densities, m_cap);
    m_settings.limits.density = now.worst;
    m_settings.bad_density = 1.5 * typical;
    return now;
  }

  // of the faces' smallest, in degrees
  double sum_of_angles() const
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const auto vertex = [&](int v) -> const Placed_vertex& { return m_state.vertices[v]; };
    const int n = m_state.guards_angles ? mesh.number_of_faces() : 0;
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
  // what steps may not lower, or change much, in sum
  void update_sums()
  {
    m_state.angle_surplus = sum_of_angles() - m_initial_angles;
    if(m_state.guards_volume())
      m_state.volume_change = volume_of_parts(m_state) - m_initial_volume;
  }

  Drift_barrier make_barrier() const
  {
    const Indexed_mesh& mesh = m_state.mesh;
    double triangles = 0;
    for(int f = 0; f < mesh.number_of_faces(); ++f)
      triangles += m_state.counts(f) ? mesh.degree(f) - 2 : 0;
    return Drift_barrier(0.1 * m_rest_energy / triangles);
  }

  // By default the bound is a quarter of R's mean edge, or what keeps steps from taking the mesh further
  // away than it is: a mesh that is coarser than R, or the image of a map, is further away by nature.
  // Flattened patches alone see the barrier only where it is felt already, and stall in front of it: for
  // them it has to be asked for.
  Drift_guard make_drift_guard()
  {
    Drift_guard guard;
    const double bound = m_parameters.drift_bound;
    if(bound > (std::numeric_limits<double>::max)() ||
       (bound < 0 && !m_parameters.use_on_surface_steps))
      return guard;
    const double edge = m_state.reference.mean_edge_length(), smallest = 1e-6 * edge;
    guard.initialize<ConcurrencyTag>(m_state, bound < 0 ? 0.25 * edge : (std::max)(bound, smallest),
                                     bound < 0, make_barrier(), &m_interruption);
    m_result.drift_bound = guard.bound();
    m_result.initial_drift = guard.initial_drift();
    return guard;
  }

  // calls a visit; false if that was cut short
  template <typename Visit>
  static bool completes(const Visit& visit)
  {
    try
    {
      return visit();
    }
    catch(const Interrupted&)
    {
      return false;
    }
  }

  // Clusters are opened as long as they get fewer. False if cut short.
  bool open_clusters()
  {
    const auto point = [&](int v) -> const Vector_3& { return m_state.vertices[v].position; };
    std::size_t before = (std::numeric_limits<std::size_t>::max)();
    while(true)
    {
      std::vector<char> is_in(m_state.mesh.number_of_vertices(), 0);
      std::size_t number = 0;
      for(const std::vector<int>& cluster : vertex_clusters(m_state.mesh, point))
        for(const int v : cluster)
        {
          is_in[v] = 1;
          number += m_state.is_free[v];
        }
      if(number == 0 || number >= before)
        return true;
      before = number;
      const std::vector<char> faces = faces_around<ConcurrencyTag>(m_state.mesh, is_in, 1);
      if(!completes([&]() { return visit_regions(faces, Moves::opening, m_densities); }))
        return false;
    }
  }

  // false if cut short
  bool iterate_to_convergence(Global_measure before)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    for(std::size_t i = 0; i < m_parameters.number_of_iterations; ++i)
    {
      m_visitor.on_iteration_begin(i);
      m_round_solver.begin_iteration();
      update_sums();
      ++m_result.number_of_iterations;
      const bool complete = completes([&]() { return visit_active(); });
      const Global_measure after = measure<ConcurrencyTag>(m_state, m_densities, m_cap);
      const double energy = m_exponent.is_complete() ? after.energy : energy_of_caller();
      m_visitor.on_iteration_end(i, energy / double(m_state.elements.size()));
      if(!complete)
        return false;
      m_settings.limits.density = (std::min)(m_settings.limits.density, after.worst);
      const auto& progress = m_round_solver.progress();
      if(progress.could_move > 0)
        m_settings.strain_resistance =
          (std::min)(largest_resistance, adapted_resistance(m_settings.strain_resistance,
                                                            progress.taken / progress.could_move));
      m_held_up = is_held_up() ? m_held_up + 1 : 0;
      const int patience = 5; // large patches may go slowly, but they go further
      const bool divides = m_prizes_angles && m_held_up >= patience && divide_further();
      const bool falls = has_fallen(before.capped_energy, after.capped_energy);
      const bool repairs =
        has_fallen(before.energy, after.energy) || after.defects() < before.defects();
      std::vector<char> moved = progress.moved;
      if(!falls && repairs)
        keep_near_bad<ConcurrencyTag>(m_state, m_densities, m_settings.bad_density,
                                      moved); // all is well elsewhere
      const bool moves = std::find(moved.begin(), moved.end(), char(1)) != moved.end();
      // without a test the energy may rise: that is not convergence either
      const bool rises = m_parameters.accepts_all && has_fallen(after.energy, before.energy);
      before = after;
      if(m_exponent.template advance<ConcurrencyTag>(m_state))
      {
        before = scale_to_density();
        m_round_solver.drift_guard().set_barrier(make_barrier());
        m_is_active = faces_around<ConcurrencyTag>(mesh, m_state.is_free, 0);
      }
      else if(moves && (repairs || falls || rises))
      {
        if(m_parameters.use_active_set)
          m_is_active = faces_around<ConcurrencyTag>(mesh, moved, 2);
      }
      else if((!has_fallen(after.capped_energy + progress.missed, after.capped_energy) ||
               !(divides || ((m_held_up > 0 || progress.has_refused) && divide_further()))) &&
              !starts_again(after.capped_energy))
      {
        m_result.status = Status::converged;
        return true;
      }
    }
    return m_parameters.number_of_iterations > 0;
  }

  double energy_of_caller() const
  {
    return measure<ConcurrencyTag>(m_state, m_target_densities,
                                   std::numeric_limits<double>::infinity())
      .energy;
  }

  // Whether a few places hold up the large patches that they are in: the steps of the last iteration
  // were cut to small parts.
  bool is_held_up() const
  {
    const auto& progress = m_round_solver.progress();
    return progress.taken < 0.8 * progress.could_move; // neither is counted for flattened patches
  }

  // From the next iteration on patches are smaller. False if they are small enough.
  bool divide_further()
  {
    const int smallest = 1000, parts = 4;
    const int size = m_partition.patch_size() / parts;
    if(size < smallest)
      return false;
    m_partition.set_patch_size(size);
    return true;
  }

  // Where small patches have come to rest, patches larger than those at first may go on: what spreads
  // over all of a region is a matter of theirs, once no single place in it holds them up. Everything
  // is visited again, and again as long as that pays; false if it did not.
  bool starts_again(double energy)
  {
    const bool pays = !m_has_rested || has_fallen(m_resting_energy, energy);
    if(!m_prizes_angles || !m_parameters.use_on_surface_steps || !pays)
      return false;
    const int times = 4;
    m_has_rested = true;
    m_resting_energy = energy;
    const int size = on_surface_patch_size(m_parameters.selection, m_state.mesh),
              largest = largest_patch_size(m_parameters.selection);
    m_partition.set_patch_size(size < largest / times ? times * size : largest);
    m_held_up = 0;
    m_is_active = faces_around<ConcurrencyTag>(m_state.mesh, m_state.is_free, 0);
    return true;
  }

  // What is turned over or folded, or bad over a whole region, is flattened: steps on the surface do
  // not mend it. Then all regions are optimized on the surface, where that is allowed.
  bool visit_active()
  {
    if(!m_parameters.use_on_surface_steps)
      return visit(m_is_active, m_selection);
    std::vector<char> is_wanted;
    std::vector<std::vector<int>> patches;
    // what flattened patches do not mend at once they hardly ever do: they try more and more rarely
    const bool flattens = !m_prizes_angles || m_result.number_of_iterations >= m_next_to_flatten;
    if(flattens)
      m_next_to_flatten = 2 * m_result.number_of_iterations + 1;
    // the second patches do not hang on what the first ones do
    call_both<ConcurrencyTag>(
      [&]() {
        if(flattens)
          is_wanted = faces_to_flatten();
      },
      [&]() { patches = divide(m_is_active, m_partition); });
    return (!flattens || visit(is_wanted, m_selection)) && !m_interruption.stops() &&
           m_round_solver.solve(patches, Moves::on_surface, m_densities, m_settings);
  }

  // the active faces that are turned over or folded or in bad regions, and those around them
  std::vector<char> faces_to_flatten() const
  {
    const Indexed_mesh& mesh = m_state.mesh;
    // sharp triangles are a matter of their vertices, stretched ones of what is around them; in a fine
    // mesh what was one triangle is many
    const int smallest_region = m_prizes_angles ? (std::max)(20, mesh.number_of_faces() / 2500) : 1;
    std::vector<char> is_wanted = defective_faces<ConcurrencyTag>(m_state);
    m_interruption.check();
    const std::vector<char> is_bad =
      bad_regions<ConcurrencyTag>(m_state, m_densities, 2 * m_settings.bad_density, smallest_region);
    for(std::size_t f = 0; f < is_wanted.size(); ++f)
      is_wanted[f] = is_wanted[f] || is_bad[f];
    m_interruption.check();
    is_wanted = faces_around<ConcurrencyTag>(mesh, vertices_of<ConcurrencyTag>(mesh, is_wanted), 2);
    for(std::size_t f = 0; f < is_wanted.size(); ++f)
      is_wanted[f] = is_wanted[f] && m_is_active[f];
    return is_wanted;
  }

  // What is left to gain is what the energy has above that of elements that are all at rest.
  bool has_fallen(double before, double after) const
  {
    const double floor = 0.001;
    const double excess = before - m_rest_energy;
    const double scale =
      excess > 0 ? (std::max)(excess, floor * std::abs(before)) : std::abs(before);
    return before - after > m_parameters.energy_tolerance * scale;
  }

  // false if it was cut short
  bool revisit_worst()
  {
    // where the angles are finished, that searches, too
    const double bad_for_search = (finishes_angles() ? 4 : 1) * m_settings.bad_density;
    using Stage = Worst_faces_stage<ConcurrencyTag, Densities>;
    Stage stage(m_state, m_densities, m_settings.bad_density, bad_for_search, &m_interruption);
    return stage.run(
      m_parameters.use_on_surface_steps,
      [&](const std::vector<char>& faces, Moves moves, const typename Stage::Goal& goal) {
        m_settings.limits.density = (std::min)(m_settings.limits.density, goal.worst);
        m_settings.search_density = goal.searched;
        return moves == Moves::flattened ? visit(faces, m_small_selection)
                                         : visit_regions(faces, moves, m_densities);
      });
  }

  bool finishes_angles() const
  {
    return m_parameters.use_finishing_stage && m_parameters.use_on_surface_steps && m_prizes_angles;
  }

  void finish_angles()
  {
    const Solver_settings settings = m_settings;
    m_round_solver.set_finishing(true);
    m_interruption.check();
    m_settings.limits.density = m_settings.search_density = std::numeric_limits<double>::infinity();
    Saved_state saved(m_state, m_round_solver.drift_guard());
    using Stage = Finishing_stage<ConcurrencyTag>;
    const auto vertex = [&](int v) -> const Placed_vertex& { return m_state.vertices[v]; };
    const auto energy = [&](int f) {
      double sum = 0;
      for(int e = m_state.elements.begin(f); e < m_state.elements.end(f); ++e)
        sum += element_energy(m_target_densities, m_state.elements[e], vertex);
      return sum;
    };
    Stage stage(m_state, energy, m_initial_energy, &m_interruption);
    try
    {
      stage.run(
        [&](const typename Stage::Faces& faces, const typename Stage::Goal& goal, bool searches) {
          saved.add(faces.list);
          update_sums();
          m_settings.limits.cosine = goal.sharpest;
          m_settings.search_cosine = goal.searched;
          return visit_regions(
            faces.is_in, searches ? Moves::by_search : Moves::on_surface,
            Angle_barrier_density<Densities>(m_densities, goal.target, goal.steepness));
        },
        [&]() { saved.forget(); }, [&]() { saved.restore(); });
    }
    catch(...)
    {
      saved.restore();
      throw;
    }
    m_settings = settings;
    m_round_solver.set_finishing(false);
  }

  // visits the wanted faces, in patches that are flattened or not, until all are touched; false if it
  // was cut short
  bool visit(const std::vector<char>& is_wanted, Patch_selection& selection)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    std::vector<int> seeds;
    for(int f = 0; f < mesh.number_of_faces(); ++f)
      if(is_wanted[f])
        seeds.push_back(f);
    for(std::size_t i = seeds.size(); i > 1; --i)
      std::swap(seeds[i - 1], seeds[m_random.get_int(0, int(i))]);
    m_is_untouched = is_wanted;
    selection.forget_visits();

    while(true)
    {
      if(m_interruption.stops())
        return false;
      const auto start = std::chrono::steady_clock::now();
      const std::vector<std::vector<int>> patches = m_rounds.select(
        seeds, m_is_untouched, selection, m_round_solver.geometry(), &m_interruption);
      m_result.times.selection += seconds_since(start);
      if(patches.empty())
        return true;
      if(!m_round_solver.solve(patches, Moves::flattened, m_densities, m_settings))
        return false;
    }
  }

  std::vector<std::vector<int>> divide(const std::vector<char>& is_wanted,
                                       Patch_partition& partition)
  {
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::vector<int>> patches = partition.divide(is_wanted, m_random, &m_interruption);
    m_result.times.selection += seconds_since(start);
    return patches;
  }

  // visits the wanted faces in one round of small patches that are not flattened, of which each is a
  // region of wanted faces if that is not too large
  template <typename AnyDensity>
  bool visit_regions(const std::vector<char>& is_wanted, Moves moves, const AnyDensity& density)
  {
    if(m_interruption.stops())
      return false;
    const auto start = std::chrono::steady_clock::now();
    const std::vector<std::vector<int>> patches =
      m_small_partition.divide_regions(is_wanted, m_random);
    m_result.times.selection += seconds_since(start);
    return m_round_solver.solve(patches, moves, density, m_settings);
  }

  Optimization_state& m_state;
  const Densities& m_target_densities; // what the caller asked for
  Exponent_continuation<Densities> m_exponent;
  const Densities& m_densities; // what is optimized now
  Loop_parameters m_parameters;
  Visitor& m_visitor;
  Result& m_result;
  Interruption& m_interruption;
  CGAL::Random m_random;
  bool m_prizes_angles; // whether worst elements are judged by their angles
  Patch_selection m_selection, m_small_selection;
  Patch_partition m_partition, m_small_partition;
  Patch_rounds m_rounds;
  Round_solver<ConcurrencyTag, Visitor> m_round_solver;
  std::vector<char> m_is_active, m_is_untouched; // per face
  Solver_settings m_settings;
  std::size_t m_next_to_flatten = 0; // iteration
  int m_held_up = 0;                 // iterations in a row
  bool m_has_rested = false;
  double m_resting_energy = 0; // when iterations came to rest the last time
  double m_cap = 0;
  double m_rest_energy = 0;
  double m_initial_energy = 0;
  double m_initial_angles = 0; // their sum
  double m_initial_volume = 0; // six times that
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_OUTER_LOOP_H
