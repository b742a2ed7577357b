// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_BACKTRACKING_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_BACKTRACKING_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Distance_bound.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Edge_creases.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Edge_folds.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Energy_decrease.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Face_intersections.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Face_orientation.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Largest_density.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Mean_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Normal_deviation_bound.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Smallest_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Smooth_edges.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Volume.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/Vertex_step_sizes.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The invariants of a step: those of single faces, edges, elements and samples, and those of sums over a
// patch, which are tested in this order once the others hold.
typedef std::tuple<Face_orientation,
                   Edge_folds,
                   Largest_density,
                   Smallest_angle,
                   Smooth_edges,
                   Normal_deviation_bound,
                   Distance_bound>
  Local_invariants;
typedef std::tuple<Edge_creases, Volume, Mean_angle, Energy_decrease, Face_intersections>
  Sum_invariants;

// Backtracking on a mover's proposal, measured on R. If an invariant does not hold the step is reduced,
// first at the violating vertices, then everywhere; only faces that change are measured again.
template <typename Local, typename Sums>
class Backtracking_with
{
public:
  explicit Backtracking_with(Interruption* interruption = nullptr) : m_interruption(interruption) {}

  struct Decision
  {
    bool accepted = false;
    Patch_measure before, after;
  };

  // `is_first` says that it is the first proposal for the patch; else the last one was accepted
  template <typename Mover, typename Density>
  Decision decide(const Patch& patch,
                  const Patch_samples& samples,
                  const Optimization_state& state,
                  Mover& mover,
                  const Density& density,
                  const Step_limits& limits,
                  bool is_first)
  {
    Decision decision;
    Violating_vertices violating(patch);
    const Trial trial{patch,   state,      limits,    m_candidate,       samples,   m_before,
                      m_after, m_accepted, m_initial, m_outside_normals, m_changed, m_is_changed};
    m_candidate = patch.located;
    if(is_first)
    {
      start(trial);
      measure(trial, density);
      m_initial = m_accepted = sum_up(trial);
    }
    decision.before = m_accepted;
    m_before = m_after;
    for_each_invariant([](auto& invariant) { invariant.accept(); });
    m_step_sizes.start(patch);
    m_number_of_violations.assign(patch.vertices.size(), 0);

    const int maximum_attempts = 20, local_attempts = 16;
    for(int attempt = 0; attempt < maximum_attempts; ++attempt)
    {
      check(m_interruption);
      displace_vertices(patch, mover);
      measure(trial, density);
      decision.after = sum_up(trial);
      violating.clear();
      if(hold(trial, decision.after, violating))
      {
        decision.accepted = true;
        m_accepted = decision.after;
        return decision;
      }
      if(!violating.list().empty() && attempt < local_attempts)
        reduce_steps(patch, violating);
      else
        m_step_sizes.reduce_all(patch, 0.5);
      if(m_step_sizes.is_zero(patch))
        break;
    }
    decision.after = decision.before;
    return decision;
  }

  // the accepted vertices, to be moved from, and the fraction of its displacement for each
  std::vector<Located_vertex>& candidate() { return m_candidate; }
  const std::vector<double>& steps() const { return m_step_sizes.fractions(); }
  const Patch_samples& samples() const { return std::get<Distance_bound>(m_local).now(); }

private:
  template <typename Visit>
  void for_each_invariant(const Visit& visit)
  {
    const auto visit_all = [&](auto&... invariants) { (visit(invariants), ...); };
    std::apply(visit_all, m_local);
    std::apply(visit_all, m_sums);
  }

  void start(const Trial& trial)
  {
    const Patch& patch = trial.patch;
    const auto vertex = [&](int v) -> const Located_vertex& { return trial.state.vertices[v]; };
    m_outside_normals.resize(patch.outside_face.size());
    for(std::size_t c = 0; c < patch.outside_face.size(); ++c)
      if(patch.outside_face[c] >= 0)
        m_outside_normals[c] = face_normal(trial.state.mesh, vertex, patch.outside_face[c]);
    m_changed.resize(trial.mesh().number_of_faces());
    std::iota(m_changed.begin(), m_changed.end(), 0);
    m_is_changed.assign(m_changed.size(), 0);
    for_each_invariant([&](auto& invariant) { invariant.start(trial); });
  }

  // the faces that changed
  template <typename Density>
  void measure(const Trial& trial, const Density& density)
  {
    m_after.measure(trial.patch, m_changed, density, m_candidate);
    for_each_invariant([&](auto& invariant) {
      check(m_interruption);
      invariant.measure(trial);
    });
  }

  // in a fixed order, whichever faces were measured
  Patch_measure sum_up(const Trial& trial)
  {
    Patch_measure m;
    for(const double d : m_after.densities)
      m.energy += d;
    for(std::size_t s = 0; s < m_after.stencils.size(); ++s)
    {
      m.energy += m_after.stencils[s];
      m.shared_energy += trial.patch.stencils[s].is_shared ? m_after.stencils[s] : 0;
    }
    for_each_invariant([&](auto& invariant) { invariant.sum_up(trial, m); });
    return m;
  }

  // whether all invariants hold
  bool hold(const Trial& trial, Patch_measure& after, Violating_vertices& violating) const
  {
    // all are tested, to reduce the steps of all violating vertices at once
    bool hold_locally = true;
    std::apply(
      [&](const auto&... invariants) {
        ((hold_locally = invariants.holds(trial, violating) && hold_locally), ...);
      },
      m_local);
    return hold_locally && after.defects() <= trial.sums_before.defects() &&
           std::apply(
             [&](const auto&... invariants) {
               return (invariants.holds(trial, after, violating) && ...);
             },
             m_sums);
  }

  // moves the vertices whose steps have changed, and marks the faces that change
  template <typename Mover>
  void displace_vertices(const Patch& patch, Mover& mover)
  {
    const Indexed_mesh& mesh = patch.polygons;
    for(const int f : m_changed)
      m_is_changed[f] = 0;
    m_changed.clear();
    m_step_sizes.apply(patch, mover, [&](int v, double step) {
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
      {
        const int f = mesh.corner_face[mesh.vertex_corners[k]];
        if(!m_is_changed[f])
        {
          m_is_changed[f] = 1;
          m_changed.push_back(f);
        }
      }
      m_candidate[v] = patch.located[v];
      if(step == 0 || mover.displaced_vertex(patch, v, step, m_candidate[v]))
        return true;
      m_candidate[v] = patch.located[v];
      return false;
    });
  }

  // reduces the steps of the violating vertices, and after repeated violations those of their neighbours
  void reduce_steps(const Patch& patch, Violating_vertices& violating)
  {
    const Indexed_mesh& mesh = patch.polygons;
    m_rings.assign(patch.vertices.size(), 0);
    for(const int v : violating.list())
    {
      ++m_number_of_violations[v];
      m_rings[v] = m_number_of_violations[v] / 2;
    }
    for(std::size_t i = 0; i < violating.list().size(); ++i)
    {
      const int v = violating.list()[i], rings = m_rings[v];
      m_step_sizes.reduce(patch, v, m_number_of_violations[v] < 4 ? 0.4 : 0.);
      if(rings == 0)
        continue;
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
      {
        const int f = mesh.corner_face[mesh.vertex_corners[k]];
        for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        {
          const int w = mesh.corner_vertex[c];
          if(!violating.contains(w))
          {
            violating.add(w);
            m_number_of_violations[w] =
              (std::max)(m_number_of_violations[w], m_number_of_violations[v] - 1);
            m_rings[w] = rings - 1;
          }
        }
      }
    }
  }

  Interruption* m_interruption;
  Local m_local;
  Sums m_sums;
  Vertex_step_sizes m_step_sizes;
  std::vector<Located_vertex> m_candidate;
  std::vector<Vector_3> m_outside_normals; // per corner
  Patch_quantities m_before, m_after;
  Patch_measure m_initial, m_accepted;
  std::vector<int> m_changed;                       // faces to be measured
  std::vector<char> m_is_changed;                   // per face
  std::vector<int> m_number_of_violations, m_rings; // per vertex
};

typedef Backtracking_with<Local_invariants, Sum_invariants> Backtracking;

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_BACKTRACKING_H
