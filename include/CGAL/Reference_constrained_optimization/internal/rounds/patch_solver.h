// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_PATCH_SOLVER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_PATCH_SOLVER_H

#include <CGAL/Reference_constrained_optimization/internal/flattening/Flattened_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/Cluster_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/On_surface_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/Pattern_search_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/Loop_parameters.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/backtracking.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/Shape_bound.h>

#include <algorithm>
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
enum class Moves { flattened, on_surface, pattern_search, cluster_separation };

// Parameters of the solver that change between iterations.
struct Solver_settings
{
  Step_limits limits;
  double bad_density = 0;                                          // elements above it are bad
  double search_density = std::numeric_limits<double>::infinity(); // elements above it, or with
  double search_cosine = 1;         // the cosine of an angle above it, are searched
  double strain_regularization = 0; // where Newton steps on the surface begin
};

// The result of solving a patch. All patches of a round are kept until it ends: data that only the solver
// needs is dropped.
struct Solved_patch
{
  Patch patch; // its faces and vertices
  std::vector<Patch_samples::Projected_sample> projected_samples;
  Shape_bound::Stored_samples samples;
  // edges to faces outside
  struct Boundary_edge
  {
    int inside, outside; // faces
    bool is_on_line;
  };
  std::vector<Boundary_edge> boundary;
  std::vector<int> shared_stencils;   // with vertices that other patches may move
  std::vector<int> faces_near_sheets; // that other patches may intersect
  // the free vertices, in local indices: those of these faces, boundary faces and shared stencils, and the
  // others
  std::vector<int> outer_vertices, inner_vertices;
  Backtracking::Decision decision;
  std::vector<Located_vertex> located;
  Flattening_path path = Flattening_path::failed;
  bool was_tried = false; // has free vertices
  bool is_flattened = false;
  bool overlaps = false;
  // mean fraction of their displacements that the vertices moved, of the last accepted proposal
  double accepted_fraction = 0;
  // an estimate: the predicted decrease of the last proposal times 1 - `accepted_fraction`
  double unrealized_decrease = 0;
  double distortion = 0;
  double flattening_time = 0, optimization_time = 0, acceptance_time = 0;
  std::size_t number_of_faces = 0, number_of_free_vertices = 0; // of the patch; 0: was not solved

  // frees the data that is not needed after the commit
  void drop_vertices()
  {
    patch = Patch();
    projected_samples = std::vector<Patch_samples::Projected_sample>();
    samples = Shape_bound::Stored_samples();
    boundary = std::vector<Boundary_edge>();
    shared_stencils = std::vector<int>();
    faces_near_sheets = std::vector<int>();
    outer_vertices = std::vector<int>();
    inner_vertices = std::vector<int>();
    located = std::vector<Located_vertex>();
  }
};

// Solves one patch by the steps of the paper: flatten, optimize, map back, accept; or moves it directly on
// R. One solver per thread, with its workspace.
class Patch_solver
{
public:
  // the largest number for a patch; each after the first requires a decrease by the last
  static constexpr int flattened_proposals = 2, on_surface_proposals = 3;

  Patch_solver(const Optimization_state& state,
               const Loop_parameters& parameters,
               Interruption* interruption)
    : m_interruption(interruption),
      m_builder(state.mesh),
      m_flattened_mover(state.reference, interruption),
      m_on_surface_mover(state.reference, 1, interruption),
      m_pattern_search_mover(state.reference, interruption),
      m_cluster_mover(state.reference),
      m_backtracking(interruption),
      m_tolerance(parameters.energy_tolerance)
  {}

  // Reads the state, does not write it. Throws Interrupted if it has to stop; the result is then not valid.
  template <typename Density>
  void solve(const std::vector<int>& faces,
             const Optimization_state& state,
             const Density& density,
             const Solver_settings& settings,
             const Shape_bound& shape_bound,
             Moves moves,
             Solved_patch& s)
  {
    const auto start = std::chrono::steady_clock::now();
    s.patch = m_builder.build(faces, state);
    s.acceptance_time = seconds_since(start);
    if(s.patch.number_of_free_vertices == 0)
    {
      finish(state, shape_bound, Patch_samples(), s);
      return;
    }
    s.was_tried = true;
    check(m_interruption);
    Patch_samples samples = shape_bound.gather(state, s.patch);
    check(m_interruption);
    s.is_flattened = moves == Moves::flattened;
    if(s.is_flattened)
    {
      improve(m_flattened_mover, flattened_proposals, m_tolerance, state, density, settings,
              samples, s);
      s.path = m_flattened_mover.flattening().path;
      s.overlaps = m_flattened_mover.overlaps();
      s.distortion = m_flattened_mover.flattening().distortion;
      s.flattening_time = m_flattened_mover.flattening_time();
    }
    else if(moves == Moves::pattern_search)
    {
      m_pattern_search_mover.set_thresholds(settings.search_density, settings.search_cosine);
      improve(m_pattern_search_mover, 1, m_tolerance, state, density, settings, samples, s);
    }
    else if(moves == Moves::cluster_separation)
      improve(m_cluster_mover, 1, m_tolerance, state, density, settings, samples, s);
    else
    {
      // its steps are cheap: a small decrease justifies another
      m_on_surface_mover.set_strain_regularization(settings.strain_regularization);
      improve(m_on_surface_mover, on_surface_proposals, 0.25 * m_tolerance, state, density,
              settings, samples, s);
      s.unrealized_decrease = (1 - s.accepted_fraction) * m_on_surface_mover.predicted_decrease();
    }
    finish(state, shape_bound, samples, s);
  }

private:
  // stores what the commit needs, and drops the rest
  static void finish(const Optimization_state& state,
                     const Shape_bound& shape_bound,
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
          s.boundary.push_back({s.patch.faces[f], s.patch.outside_face[c], s.patch.is_on_line(c)});
          for(int d = mesh.face_begin[f]; d < mesh.face_begin[f + 1]; ++d)
            is_outer[mesh.corner_vertex[d]] = 1;
        }
      const auto before = [&](int v) -> const Located_vertex& {
        return state.vertices[s.patch.vertices[v]];
      };
      const auto after = [&](int v) -> const Located_vertex& { return s.patch.located[v]; };
      for(const int f : state.faces_near_sheets_of(mesh, before, after))
      {
        s.faces_near_sheets.push_back(s.patch.faces[f]);
        for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
          is_outer[mesh.corner_vertex[c]] = 1;
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
      s.samples = shape_bound.stored_samples(state.mesh, s.patch, samples);
      kept.faces = std::move(s.patch.faces);
      kept.vertices = std::move(s.patch.vertices);
      s.projected_samples = samples.projected_samples;
      s.located = std::move(s.patch.located);
    }
    s.patch = std::move(kept);
  }

  // the flattening or the factorization pattern serves several proposals
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
        s.patch.located.swap(m_backtracking.candidate());
        samples = m_backtracking.samples();
        s.accepted_fraction = mean_fraction(s.patch, m_backtracking.steps());
      }
      s.acceptance_time += seconds_since(start);
      const double gain = decision.before.energy - decision.after.energy;
      // a few elements that cannot be improved may dominate the sum
      const double scale = (std::min)(std::abs(decision.before.energy),
                                      settings.bad_density * double(s.patch.elements.size()));
      proposes = decision.accepted && gain >= tolerance * scale && pass + 1 < maximum_proposals &&
                 mover.propose_again(s.patch, samples, m_backtracking.steps(), density);
    }
    s.optimization_time = mover.optimization_time();
  }

  static double mean_fraction(const Patch& patch, const std::vector<double>& parts)
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
  Pattern_search_mover m_pattern_search_mover;
  Cluster_mover m_cluster_mover;
  Backtracking m_backtracking;
  double m_tolerance;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_PATCH_SOLVER_H
