// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_PATCH_SOLVER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_PATCH_SOLVER_H

#include <CGAL/Reference_constrained_optimization/internal/on_surface/Cluster_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/On_surface_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/Search_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/Loop_parameters.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/backtracking.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/drift_guard.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// how a patch is moved
enum class Moves { flattened, on_surface, by_search, opening };

// What patches are solved with; it changes between iterations.
struct Solver_settings
{
  Step_limits limits;
  double bad_density = 0;                                          // of an element beyond it
  double search_density = std::numeric_limits<double>::infinity(); // elements beyond it, or with
  double search_cosine = 1;     // the cosine of an angle beyond it, are what a search is for
  double strain_resistance = 0; // where Newton steps on the surface begin
};

// What is known of a patch after it was solved. All patches of a round are kept until it ends: what
// only the solver needs is dropped.
struct Solved_patch
{
  Patch patch; // its faces and vertices
  std::vector<Patch_samples::Guest> guests;
  Drift_guard::Known_samples samples;
  std::vector<std::array<int, 2>> boundary; // per edge to a face outside: that inside, and it
  std::vector<int> shared_stencils;         // that depend on vertices which others may move
  // the free vertices, in local indices: those that other patches see, and the others
  std::vector<int> outer_vertices, inner_vertices;
  Backtracking::Decision decision;
  std::vector<Placed_vertex> placed;
  Flattening_path path = Flattening_path::failed;
  bool was_tried = false; // has free vertices
  bool is_flattened = false;
  bool overlaps = false;
  double taken = 0; // mean part of their ways that the vertices went, of the last proposal accepted
  double missed = 0; // an estimate: the gain that the last proposal promised, times 1 - `taken`
  double distortion = 0;
  double flattening_time = 0, optimization_time = 0, acceptance_time = 0;
  std::size_t number_of_faces = 0, number_of_free_vertices = 0; // of the patch; 0: was not solved

  // frees what is of no use after the commit
  void drop_vertices()
  {
    patch = Patch();
    guests = std::vector<Patch_samples::Guest>();
    samples = Drift_guard::Known_samples();
    boundary = std::vector<std::array<int, 2>>();
    shared_stencils = std::vector<int>();
    outer_vertices = std::vector<int>();
    inner_vertices = std::vector<int>();
    placed = std::vector<Placed_vertex>();
  }
};

// Takes one patch through the steps of the paper: flatten, optimize, map back, accept; or moves it
// directly on R. One solver for each thread; it keeps its workspace.
class Patch_solver
{
public:
  Patch_solver(const Optimization_state& state,
               const Loop_parameters& parameters,
               Interruption* interruption)
    : m_interruption(interruption),
      m_builder(state.mesh),
      m_flattened_mover(state.reference, parameters.mover, interruption),
      m_on_surface_mover(state.reference, 1, interruption),
      m_search_mover(state.reference, interruption),
      m_cluster_mover(state.reference),
      m_backtracking(interruption),
      m_flattened_proposals(parameters.proposals_per_patch),
      m_on_surface_proposals(parameters.on_surface_proposals),
      m_tolerance(parameters.energy_tolerance)
  {}

  // Reads the state, does not write it. Throws Interrupted if it is to end; what became of the patch
  // then is of no use.
  template <typename Density>
  void solve(const std::vector<int>& faces,
             const Optimization_state& state,
             const Density& density,
             const Solver_settings& settings,
             const Drift_guard& drift_guard,
             Moves moves,
             Solved_patch& s)
  {
    const auto start = std::chrono::steady_clock::now();
    s.patch = m_builder.build(faces, state);
    s.acceptance_time = seconds_since(start);
    if(s.patch.number_of_free_vertices == 0)
    {
      finish(state, drift_guard, Patch_samples(), s);
      return;
    }
    s.was_tried = true;
    check(m_interruption);
    Patch_samples samples = drift_guard.gather(state, s.patch);
    check(m_interruption);
    s.is_flattened = moves == Moves::flattened;
    if(s.is_flattened)
    {
      improve(m_flattened_mover, m_flattened_proposals, m_tolerance, state, density, settings,
              samples, s);
      s.path = m_flattened_mover.flattening().path;
      s.overlaps = m_flattened_mover.overlaps();
      s.distortion = m_flattened_mover.flattening().distortion;
      s.flattening_time = m_flattened_mover.flattening_time();
    }
    else if(moves == Moves::by_search)
    {
      m_search_mover.set_target(settings.search_density, settings.search_cosine);
      improve(m_search_mover, 1, m_tolerance, state, density, settings, samples, s);
    }
    else if(moves == Moves::opening)
      improve(m_cluster_mover, 1, m_tolerance, state, density, settings, samples, s);
    else
    {
      // its steps are cheap: a small gain is worth another
      m_on_surface_mover.set_strain_resistance(settings.strain_resistance);
      improve(m_on_surface_mover, m_on_surface_proposals, 0.25 * m_tolerance, state, density,
              settings, samples, s);
      s.missed = (1 - s.taken) * m_on_surface_mover.promised();
    }
    finish(state, drift_guard, samples, s);
  }

private:
  // notes what the commit needs, and drops what it does not
  static void finish(const Optimization_state& state,
                     const Drift_guard& drift_guard,
                     const Patch_samples& samples,
                     Solved_patch& s)
  {
    s.number_of_faces = s.patch.faces.size();
    s.number_of_free_vertices = std::size_t(s.patch.number_of_free_vertices);
    Patch kept;
    if(s.decision.accepted)
    {
      const Indexed_mesh& mesh = s.patch.polygons;
      std::vector<char> is_outer(s.patch.vertices.size(), 0);
      for(int c = 0; c < mesh.number_of_corners(); ++c)
        if(s.patch.outside_face[c] >= 0)
        {
          const int f = mesh.corner_face[c];
          s.boundary.push_back({{s.patch.faces[f], s.patch.outside_face[c]}});
          for(int d = mesh.face_begin[f]; d < mesh.face_begin[f + 1]; ++d)
            is_outer[mesh.corner_vertex[d]] = 1;
        }
      for(const Patch::Stencil& stencil : s.patch.stencils)
        if(stencil.is_shared)
        {
          s.shared_stencils.push_back(stencil.number);
          for(int i = 0; i < stencil.size; ++i)
            if(stencil.vertices[i] >= 0)
              is_outer[stencil.vertices[i]] = 1;
        }
      for(std::size_t v = 0; v < is_outer.size(); ++v)
        if(s.patch.is_free[v])
          (is_outer[v] ? s.outer_vertices : s.inner_vertices).push_back(int(v));
      s.samples = drift_guard.samples_of(state.mesh, s.patch, samples);
      kept.faces = std::move(s.patch.faces);
      kept.vertices = std::move(s.patch.vertices);
      s.guests = samples.guests;
      s.placed = std::move(s.patch.placed);
    }
    s.patch = std::move(kept);
  }

  // what is prepared once serves several proposals
  template <typename Mover, typename Density>
  void improve(Mover& mover,
               int maximum_proposals,
               double tolerance,
               const Optimization_state& state,
               const Density& density,
               const Solver_settings& settings,
               Patch_samples& samples,
               Solved_patch& s)
  {
    bool proposes = mover.propose(s.patch, samples, density);
    for(int pass = 0; proposes; ++pass)
    {
      const auto start = std::chrono::steady_clock::now();
      const Backtracking::Decision decision =
        m_backtracking.decide(s.patch, samples, state, mover, density, settings.limits, pass == 0);
      if(pass == 0)
        s.decision = decision;
      if(decision.accepted)
      {
        s.decision.after = decision.after;
        s.patch.placed.swap(m_backtracking.candidate());
        samples = m_backtracking.samples();
        s.taken = mean_part(s.patch, m_backtracking.steps());
      }
      s.acceptance_time += seconds_since(start);
      const double gain = decision.before.energy - decision.after.energy;
      // a few elements that nothing can open may own the sum
      const double scale = (std::min)(std::abs(decision.before.energy),
                                      settings.bad_density * double(s.patch.elements.size()));
      proposes = decision.accepted && gain >= tolerance * scale && pass + 1 < maximum_proposals &&
                 mover.propose_again(s.patch, samples, m_backtracking.steps(), density);
    }
    s.optimization_time = mover.optimization_time();
  }

  static double mean_part(const Patch& patch, const std::vector<double>& parts)
  {
    double sum = 0;
    for(std::size_t v = 0; v < parts.size(); ++v)
      sum += patch.is_free[v] ? parts[v] : 0;
    return sum / patch.number_of_free_vertices;
  }

  Interruption* m_interruption;
  Patch_builder m_builder;
  Flattened_mover m_flattened_mover;
  On_surface_mover m_on_surface_mover;
  Search_mover m_search_mover;
  Cluster_mover m_cluster_mover;
  Backtracking m_backtracking;
  int m_flattened_proposals, m_on_surface_proposals;
  double m_tolerance;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_PATCH_SOLVER_H
