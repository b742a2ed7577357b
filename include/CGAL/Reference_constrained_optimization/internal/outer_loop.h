// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OUTER_LOOP_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OUTER_LOOP_H

#include <CGAL/Reference_constrained_optimization/Default_visitor.h>
#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/Flattened_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/acceptance.h>
#include <CGAL/Reference_constrained_optimization/internal/drift_guard.h>
#include <CGAL/Reference_constrained_optimization/internal/for_each_patch.h>
#include <CGAL/Reference_constrained_optimization/internal/patch_selection.h>

#include <CGAL/Random.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

struct Loop_parameters
{
  std::size_t number_of_iterations = 30;
  double drift_bound = -1; // a length; negative: 1.2 mean edge lengths of the coarser mesh
  double energy_tolerance = 1e-3;   // relative decrease of the capped energy per iteration
  double movement_tolerance = 0.02; // part of the mean edge length at a vertex
  double maximum_running_time = std::numeric_limits<double>::infinity(); // seconds
  unsigned int random_seed = 0;
  int proposals_per_patch = 2;
  int maximum_revisits = 10; // of the worst elements, at the end
  int halo = 4; // rings around the patches of a round in which no other patch of it starts
  Selection_parameters selection;
  Flattened_mover::Parameters mover;
};

// Algorithm 1 of the paper. An outer iteration visits every active face; it consists of rounds of
// face-disjoint patches. All vertices that a patch moves have all their faces in it, so that the
// patches of a round can be solved independently of one another, from the state before the round;
// they are then committed in a fixed order, where only the edges between two of them are tested
// again. The result does not depend on the number of threads.
template <typename ConcurrencyTag, typename Density, typename Visitor>
class Outer_loop
{
  // what is known of a patch after it was solved
  struct Solved_patch
  {
    Patch patch;
    Acceptance_test::Decision decision;
    std::vector<Placed_vertex> placed;
    Flattening_path path = Flattening_path::failed;
    bool was_tried = false; // has free vertices
    bool overlaps = false;
    double distortion = 0;
    double flattening_time = 0, optimization_time = 0, acceptance_time = 0;
  };

  struct Workspace
  {
    Patch_builder builder;
    Flattened_mover mover;
    Acceptance_test acceptance;
  };

public:
  Outer_loop(Optimization_state& state,
             const Density& density,
             const Loop_parameters& parameters,
             Visitor& visitor,
             Result& result,
             const std::chrono::steady_clock::time_point& start)
    : m_state(state),
      m_density(density),
      m_parameters(parameters),
      m_visitor(visitor),
      m_result(result),
      m_start(start),
      m_random(parameters.random_seed),
      m_selection(state.mesh, sized(parameters.selection, state.mesh)),
      m_small_selection(state.mesh, small(parameters.selection)),
      m_for_each([&state, &parameters]() {
        return Workspace{Patch_builder(state.mesh),
                         Flattened_mover(state.reference, parameters.mover), Acceptance_test()};
      })
  {}

  // the state holds what was accepted, also when a visitor throws
  void run()
  {
    const Indexed_mesh& mesh = m_state.mesh;
    Global_measure before = measure(m_state, m_density, std::numeric_limits<double>::infinity());
    // stuck elements own the sum: convergence is also judged on a sum to which each gives ten times
    // the mean of the better half at most
    const double typical = lower_half_mean();
    m_cap = 10 * typical;
    m_limits.worst = before.worst;
    m_limits.bad = 1.5 * typical;
    m_limits.sharpest = before.sharpest;
    before = measure(m_state, m_density, m_cap);

    std::vector<Vector_3> points(mesh.number_of_vertices());
    for(int v = 0; v < mesh.number_of_vertices(); ++v)
      points[v] = m_state.vertices[v].position;
    // a mesh that is coarser than R is further away from it by nature
    m_limits.drift =
      m_parameters.drift_bound < 0
        ? 1.2 * (std::max)(m_state.reference.mean_edge_length(), mean_edge_length(mesh, points))
        : m_parameters.drift_bound;
    if(std::isfinite(m_limits.drift))
      m_drift_guard.initialize(m_state);
    m_geometry.update(mesh, points);
    compute_edge_lengths(points);
    m_is_active.assign(mesh.number_of_faces(), 0);
    activate([&](int v) { return m_state.is_free[v] != 0; }, 0);

    m_result.status = Status::iteration_limit;
    if(iterate_to_convergence(before))
      revisit_worst();
  }

private:
  // false if cut short
  bool iterate_to_convergence(Global_measure before)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    for(std::size_t i = 0; i < m_parameters.number_of_iterations; ++i)
    {
      m_visitor.on_iteration_begin(i);
      m_moved.assign(mesh.number_of_vertices(), 0);
      ++m_result.number_of_iterations;
      const bool complete = visit(m_is_active, m_selection);
      const Global_measure after = measure(m_state, m_density, m_cap);
      m_visitor.on_iteration_end(i, after.energy / double(m_state.elements.size()));
      if(!complete)
        return false;
      m_limits.worst = (std::min)(m_limits.worst, after.worst);
      const double tolerance = m_parameters.energy_tolerance;
      const bool falls =
        before.capped_energy - after.capped_energy > tolerance * before.capped_energy;
      const bool repairs = before.energy - after.energy > tolerance * before.energy ||
                           after.flips + after.fold_edges < before.flips + before.fold_edges;
      m_is_active.assign(mesh.number_of_faces(), 0);
      if(!falls && repairs)
        keep_moved_near_bad(); // all is well elsewhere
      const bool moves = activate([&](int v) { return m_moved[v] != 0; }, 1);
      if(!moves || !(repairs || falls))
      {
        m_result.status = Status::converged;
        return true;
      }
      before = after;
    }
    return m_parameters.number_of_iterations > 0;
  }

  // forgets the vertices that moved away from bad elements
  void keep_moved_near_bad()
  {
    const Indexed_mesh& mesh = m_state.mesh;
    std::vector<char> is_near(mesh.number_of_vertices(), 0);
    for(const std::pair<double, int>& d : face_densities())
      if(d.first > m_limits.bad)
        for(int c = mesh.face_begin[d.second]; c < mesh.face_begin[d.second + 1]; ++c)
          is_near[mesh.corner_vertex[c]] = 1;
    const std::vector<char> is_bad = is_near;
    for(int c = 0; c < mesh.number_of_corners(); ++c)
      if(is_bad[mesh.source(c)] || is_bad[mesh.target(c)])
        is_near[mesh.source(c)] = is_near[mesh.target(c)] = 1;
    for(int v = 0; v < mesh.number_of_vertices(); ++v)
      m_moved[v] = m_moved[v] && is_near[v];
  }

  // The worst elements once more, by themselves, in small patches around them, as long as that
  // helps: in a large patch their gain may be lost with a step that fails elsewhere.
  void revisit_worst()
  {
    const std::size_t count = 20 + std::size_t(m_state.mesh.number_of_faces()) / 500;
    double before = std::numeric_limits<double>::infinity();
    for(int pass = 0; pass < m_parameters.maximum_revisits; ++pass)
    {
      std::vector<std::pair<double, int>> faces = face_densities();
      const std::size_t n = (std::min)(count, faces.size());
      std::partial_sort(faces.begin(), faces.begin() + n, faces.end(),
                        std::greater<std::pair<double, int>>());
      m_limits.worst = (std::min)(m_limits.worst, faces.front().first);
      std::vector<char> is_wanted(faces.size(), 0);
      double after = 0;
      for(std::size_t i = 0; i < n; ++i)
      {
        is_wanted[faces[i].second] = 1;
        after += std::log(faces[i].first);
      }
      const double least_gain = 0.002 * double(n);
      if(!(after < before - least_gain) || !visit(is_wanted, m_small_selection))
        return;
      before = after;
    }
  }

  // the largest density of the elements of every face, with the face
  std::vector<std::pair<double, int>> face_densities() const
  {
    const auto vertex = [&](int v) -> const Placed_vertex& { return m_state.vertices[v]; };
    std::vector<std::pair<double, int>> result;
    for(int f = 0; f < m_state.mesh.number_of_faces(); ++f)
    {
      double largest = 0;
      for(int e = m_state.elements.begin(f); e < m_state.elements.end(f); ++e)
        largest = (std::max)(largest, element_energy(m_density, m_state.elements[e], vertex));
      result.emplace_back(largest, f);
    }
    return result;
  }

  // Larger patches take fewer iterations, each more costly by face: their size grows with the mesh,
  // as fast as their number.
  static Selection_parameters sized(Selection_parameters selection, const Indexed_mesh& mesh)
  {
    if(selection.maximum_patch_size == 0)
      selection.maximum_patch_size =
        (std::min)(4000, (std::max)(400, int(4.5 * std::sqrt(double(mesh.number_of_faces())))));
    return selection;
  }

  static Selection_parameters small(Selection_parameters selection)
  {
    const int size = 200;
    if(selection.maximum_patch_size == 0 || selection.maximum_patch_size > size)
      selection.maximum_patch_size = size;
    return selection;
  }

  double lower_half_mean() const
  {
    const auto vertex = [&](int v) -> const Placed_vertex& { return m_state.vertices[v]; };
    std::vector<double> densities(m_state.elements.size());
    for(int e = 0; e < m_state.elements.size(); ++e)
      densities[e] = element_energy(m_density, m_state.elements[e], vertex);
    std::sort(densities.begin(), densities.end());
    const std::size_t half = densities.size() / 2 + 1;
    double sum = 0;
    for(std::size_t i = 0; i < half; ++i)
      sum += densities[i];
    return sum / double(half);
  }

  void compute_edge_lengths(const std::vector<Vector_3>& points)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    m_edge_length.assign(mesh.number_of_vertices(), 0);
    for(int v = 0; v < mesh.number_of_vertices(); ++v)
    {
      const int begin = mesh.vertex_begin[v], end = mesh.vertex_begin[v + 1];
      for(int k = begin; k < end; ++k)
        m_edge_length[v] += (points[mesh.target(mesh.vertex_corners[k])] - points[v]).norm();
      if(end > begin)
        m_edge_length[v] /= end - begin;
    }
  }

  // makes the faces at the given vertices active, and `rings` rings around them
  template <typename Predicate>
  bool activate(const Predicate& is_center, int rings)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    std::vector<char> vertex_is_active(mesh.number_of_vertices(), 0);
    bool any = false;
    for(int v = 0; v < mesh.number_of_vertices(); ++v)
      if(mesh.vertex_begin[v + 1] > mesh.vertex_begin[v] && is_center(v))
      {
        any = true;
        vertex_is_active[v] = 1;
      }
    for(int ring = 0; ring <= rings; ++ring)
    {
      for(int c = 0; c < mesh.number_of_corners(); ++c)
        if(vertex_is_active[mesh.corner_vertex[c]])
          m_is_active[mesh.corner_face[c]] = 1;
      if(ring == rings)
        break;
      for(int c = 0; c < mesh.number_of_corners(); ++c)
        if(m_is_active[mesh.corner_face[c]])
          vertex_is_active[mesh.corner_vertex[c]] = 1;
    }
    return any;
  }

  // visits the wanted faces until all are touched; false if it was cut short
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
      if(!may_go_on())
        return false;
      const auto start = std::chrono::steady_clock::now();
      std::vector<std::vector<int>> patches = select_round(seeds, selection);
      m_result.times.selection += seconds_since(start);
      if(patches.empty())
        return true;
      if(!solve_round(patches))
        return false;
    }
  }

  bool has_time() const { return seconds_since(m_start) <= m_parameters.maximum_running_time; }

  bool may_go_on()
  {
    if(!has_time())
      m_result.status = Status::time_limit;
    else if(!m_visitor.go_further())
      m_result.status = Status::interrupted;
    else
      return true;
    return false;
  }

  // grows face-disjoint patches from untouched seeds until the mesh is full; drops the seeds that
  // are touched
  std::vector<std::vector<int>> select_round(std::vector<int>& seeds, Patch_selection& selection)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    std::vector<std::vector<int>> patches;
    m_is_taken.assign(mesh.number_of_faces(), 0);
    m_is_near.assign(mesh.number_of_vertices(), 0);
    std::size_t kept = 0;
    for(const int seed : seeds)
    {
      if(!m_is_untouched[seed])
        continue;
      const auto is_near = [&]() {
        for(int c = mesh.face_begin[seed]; c < mesh.face_begin[seed + 1]; ++c)
          if(m_is_near[mesh.corner_vertex[c]])
            return true;
        return false;
      };
      if(m_is_taken[seed] || is_near())
      {
        seeds[kept++] = seed;
        continue;
      }
      std::vector<int> patch =
        selection.grow(seed, m_geometry, [&](int f) { return m_is_taken[f] != 0; });
      for(const int f : selection.touched(patch))
        m_is_untouched[f] = 0;
      for(const int f : patch)
        m_is_taken[f] = 1;
      mark_near(patch);
      patches.push_back(std::move(patch));
    }
    seeds.resize(kept);
    return patches;
  }

  void mark_near(const std::vector<int>& patch)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    std::vector<int> front;
    const auto mark = [&](int v, std::vector<int>& list) {
      if(!m_is_near[v])
      {
        m_is_near[v] = 1;
        list.push_back(v);
      }
    };
    for(const int f : patch)
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        mark(mesh.corner_vertex[c], front);
    for(int ring = 0; ring < m_parameters.halo; ++ring)
    {
      std::vector<int> next;
      for(const int v : front)
        for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
        {
          const int c = mesh.vertex_corners[k];
          mark(mesh.target(c), next);
          mark(mesh.source(mesh.previous(c)), next);
        }
      front.swap(next);
    }
  }

  // false if it was cut short; what was solved by then is committed
  bool solve_round(const std::vector<std::vector<int>>& patches)
  {
    m_visitor.on_round_begin(patches.size());
    ++m_result.number_of_rounds;
    std::vector<Solved_patch> solved(patches.size());
    const bool is_sequential = std::is_same<ConcurrencyTag, CGAL::Sequential_tag>::value;
    std::atomic<bool> stops(false);
    m_for_each(patches.size(), [&](Workspace& w, std::size_t i) {
      // only the calling thread may ask the visitor
      if(!stops && !(is_sequential ? may_go_on() : has_time()))
        stops = true;
      if(!stops)
        solve(w, patches[i], solved[i]);
    });
    for(Solved_patch& s : solved)
      if(!s.patch.faces.empty())
      {
        commit(s);
        report(s);
      }
    m_visitor.on_round_end();
    if(stops && !is_sequential)
      m_result.status = Status::time_limit;
    return !stops;
  }

  // reads the state, does not write it
  void solve(Workspace& w, const std::vector<int>& faces, Solved_patch& s) const
  {
    auto start = std::chrono::steady_clock::now();
    s.patch = w.builder.build(faces, m_state);
    s.acceptance_time = seconds_since(start);
    if(s.patch.number_of_free_vertices == 0)
      return;
    s.was_tried = true;
    m_drift_guard.invite(s.patch);
    const bool proposes = w.mover.propose(s.patch, m_density);
    s.path = w.mover.flattening().path;
    s.overlaps = w.mover.overlaps();
    s.distortion = w.mover.flattening().distortion;
    s.flattening_time = w.mover.flattening_time();
    s.optimization_time = w.mover.optimization_time();
    if(!proposes)
      return;
    // one flattening serves several proposals: it costs more than they do
    for(int pass = 0; pass < m_parameters.proposals_per_patch; ++pass)
    {
      if(pass > 0 && !w.mover.propose_again(s.patch, w.acceptance.steps(), m_density))
        break;
      start = std::chrono::steady_clock::now();
      const Acceptance_test::Decision decision =
        w.acceptance.decide(s.patch, m_state, w.mover, m_density, m_limits);
      if(pass == 0)
        s.decision = decision;
      if(decision.accepted)
      {
        s.decision.after = decision.after;
        s.patch.placed = w.acceptance.candidate();
        s.patch.guests = w.acceptance.guests();
      }
      s.acceptance_time += seconds_since(start);
      const double gain = decision.before.energy - decision.after.energy;
      if(!decision.accepted || gain < m_parameters.energy_tolerance * decision.before.energy)
        break;
    }
    s.optimization_time = w.mover.optimization_time();
    s.placed = s.patch.placed;
  }

  // folds of the edges between the patch and faces outside it, as the state is now
  int boundary_folds(const Patch& patch) const
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const auto vertex = [&](int v) -> const Placed_vertex& { return m_state.vertices[v]; };
    int count = 0;
    for(std::size_t c = 0; c < patch.outside_face.size(); ++c)
      if(patch.outside_face[c] >= 0)
        count += is_folded(face_normal(mesh, vertex, patch.faces[patch.polygons.corner_face[c]]),
                           face_normal(mesh, vertex, patch.outside_face[c]));
    return count;
  }

  // Applies an accepted patch. Another patch of the round may have moved faces across its boundary
  // since it was judged: what folds there is counted anew.
  void commit(Solved_patch& s)
  {
    if(!s.decision.accepted)
      return;
    const Patch& patch = s.patch;
    const int folds_before = boundary_folds(patch);
    exchange(patch, s.placed);
    const Patch_measure &before = s.decision.before, &after = s.decision.after;
    const int change =
      after.inner_defects - before.inner_defects + boundary_folds(patch) - folds_before;
    if(change > 0 || (change == 0 && !(after.energy < before.energy)))
    {
      exchange(patch, s.placed);
      s.decision.accepted = false;
      s.decision.after = s.decision.before;
      return;
    }
    s.decision.after.boundary_defects = before.boundary_defects + change -
                                        (after.inner_defects - before.inner_defects);
    for(std::size_t i = 0; i < patch.vertices.size(); ++i)
      if(patch.is_free[i])
      {
        const int v = patch.vertices[i];
        const double moved = (m_state.vertices[v].position - s.placed[i].position).norm();
        if(moved > m_parameters.movement_tolerance * m_edge_length[v])
          m_moved[v] = 1;
      }
    update_geometry(patch);
    m_drift_guard.take_back(patch);
  }

  void exchange(const Patch& patch, std::vector<Placed_vertex>& placed)
  {
    for(std::size_t i = 0; i < patch.vertices.size(); ++i)
      if(patch.is_free[i])
        std::swap(m_state.vertices[patch.vertices[i]], placed[i]);
  }

  void update_geometry(const Patch& patch)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    for(const int f : patch.faces)
      m_geometry.set(mesh, f, [&](int v) -> const Vector_3& {
        return m_state.vertices[v].position;
      });
  }

  void report(const Solved_patch& s)
  {
    ++m_result.number_of_patches;
    m_result.sum_of_patch_sizes += double(s.patch.faces.size());
    m_result.times.flattening += s.flattening_time;
    m_result.times.optimization += s.optimization_time;
    m_result.times.acceptance += s.acceptance_time;
    if(s.was_tried)
    {
      m_result.conformal_flattenings += s.path == Flattening_path::conformal;
      m_result.convex_border_flattenings += s.path == Flattening_path::convex_border;
      m_result.failed_flattenings += s.path == Flattening_path::failed;
      m_result.overlapping_flattenings += s.overlaps;
      m_result.sum_of_flattening_distortion += s.distortion;
    }
    m_result.number_of_accepted_patches += s.decision.accepted;
    m_result.number_of_flattened_patches += s.decision.accepted;
    Patch_report report;
    report.number_of_faces = s.patch.faces.size();
    report.energy_before = s.decision.before.energy;
    report.energy_after = s.decision.after.energy;
    report.defects_before = std::size_t(s.decision.before.defects());
    report.defects_after = std::size_t(s.decision.after.defects());
    report.accepted = s.decision.accepted;
    m_visitor.on_patch_end(report);
  }

  Optimization_state& m_state;
  const Density& m_density;
  Loop_parameters m_parameters;
  Visitor& m_visitor;
  Result& m_result;
  std::chrono::steady_clock::time_point m_start;
  CGAL::Random m_random;
  Patch_selection m_selection, m_small_selection;
  For_each_patch<ConcurrencyTag, Workspace> m_for_each;
  Face_geometry m_geometry;
  std::vector<double> m_edge_length; // per vertex, of the input
  std::vector<char> m_is_active, m_is_untouched, m_is_taken, m_is_near, m_moved;
  Drift_guard m_drift_guard;
  Acceptance_test::Limits m_limits{0, 0, 1, 0};
  double m_cap = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OUTER_LOOP_H
