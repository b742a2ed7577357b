// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ACCEPTANCE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ACCEPTANCE_H

#include <CGAL/Reference_constrained_optimization/internal/Patch.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// What a patch looks like on R: energy, and how much is wrong in it and across its boundary.
struct Patch_measure
{
  double energy = 0;
  int inner_defects = 0;    // flips, quads that are not convex, and folds of edges inside
  int boundary_defects = 0; // folds of edges to faces outside
  int defects() const { return inner_defects + boundary_defects; }
};

// Decides on what a mover proposes: first flips, fold edges and non-convex quads, then energy, all
// measured on R.
// Where the proposal fails the step is cut back, first where it does harm, then everywhere.
class Acceptance_test
{
public:
  // bounds on single elements and on single vertices of R
  struct Limits
  {
    double worst;    // no step may take an element beyond it, or further beyond
    double bad;      // elements beyond it are allowed more drift
    double troubled; // patches with an element beyond it are flattened
    double sharpest; // no step may take the cosine of an angle beyond it, or further beyond
    double drift; // no step may take a vertex of R further than this from the mesh, or further yet
    bool accepts_all = false; // what the mover proposes is kept without a test
  };

  struct Decision
  {
    bool accepted = false;
    bool is_final = false; // accepted without a test, and not to be tested later
    Patch_measure before, after;
  };

  // `is_first` says that it is the first proposal for the patch; else the last one was accepted
  template <typename Mover, typename Density>
  Decision decide(const Patch& patch,
                  const Optimization_state& state,
                  Mover& mover,
                  const Density& density,
                  const Limits& limits,
                  bool is_first)
  {
    Decision decision;
    const int n = int(patch.vertices.size());
    m_limits = limits;
    prepare(patch, state);
    if(is_first)
      decision.before = measure(patch, density, patch.placed, m_before, nullptr);
    else // what was accepted last is what there is now
    {
      decision.before = m_accepted;
      std::swap(m_before, m_after);
    }
    m_is_bad.assign(n, 0);
    for(std::size_t e = 0; e < patch.elements.size(); ++e)
      if(m_before.densities[e] > limits.bad)
        for(const int v : patch.elements[e].vertices)
          m_is_bad[v] = 1;
    m_step.assign(n, 1.);
    m_candidate = patch.placed;
    m_needs_placing.assign(n, 1);

    const int maximum_attempts = 14, local_attempts = 10;
    for(int attempt = 0; attempt < maximum_attempts; ++attempt)
    {
      place(patch, mover);
      m_is_offender.assign(n, 0);
      decision.after = measure(patch, density, m_candidate, m_after, &m_before);
      visit_guests(patch, state.reference);
      const int defects = decision.after.defects() - decision.before.defects();
      const bool falls = decision.after.energy < decision.before.energy;
      if(m_limits.accepts_all || (!m_exceeds && (defects < 0 || (defects == 0 && falls))))
      {
        decision.accepted = true;
        decision.is_final = m_limits.accepts_all;
        m_accepted = decision.after;
        return decision;
      }
      if(defects == 0 && !m_exceeds)
        mark_risen(patch);
      const bool has_offenders =
        std::find(m_is_offender.begin(), m_is_offender.end(), char(1)) != m_is_offender.end();
      if(has_offenders && attempt < local_attempts)
        cut_offenders(patch, attempt);
      else
        for(int v = 0; v < n; ++v)
          cut(patch, v, 0.5);
    }
    decision.after = decision.before;
    return decision;
  }

  // what was accepted, and the part of its way that each vertex went
  const std::vector<Placed_vertex>& candidate() const { return m_candidate; }
  const std::vector<double>& steps() const { return m_step; }
  const std::vector<Patch::Guest>& guests() const { return m_guests; }

private:
  // per face and corner figures of a measure, to tell what is new
  struct Details
  {
    std::vector<Vector_3> normals;
    std::vector<char> flipped;     // per face: turned over, or a quad that is not convex
    std::vector<char> folded;      // per corner
    std::vector<double> densities; // per element
    std::vector<double> cosines;   // per element: cosine of its smallest angle
  };

  void prepare(const Patch& patch, const Optimization_state& state)
  {
    const auto vertex = [&](int v) -> const Placed_vertex& { return state.vertices[v]; };
    m_outside_normal.resize(patch.outside_face.size());
    for(std::size_t c = 0; c < patch.outside_face.size(); ++c)
      if(patch.outside_face[c] >= 0)
        m_outside_normal[c] = face_normal(state.mesh, vertex, patch.outside_face[c]);
  }

  template <typename Density>
  Patch_measure measure(const Patch& patch,
                        const Density& density,
                        const std::vector<Placed_vertex>& placed,
                        Details& details,
                        const Details* before)
  {
    const Indexed_mesh& mesh = patch.polygons;
    const auto vertex = [&](int v) -> const Placed_vertex& { return placed[v]; };
    Patch_measure m;
    m_exceeds = false;
    details.normals.resize(mesh.number_of_faces());
    details.flipped.resize(mesh.number_of_faces());
    details.folded.assign(mesh.number_of_corners(), 0);
    details.densities.resize(patch.elements.size());
    details.cosines.resize(patch.elements.size());
    for(int f = 0; f < mesh.number_of_faces(); ++f)
    {
      details.normals[f] = face_normal(mesh, vertex, f);
      details.flipped[f] =
        char(is_flipped(mesh, vertex, f, details.normals[f]) + is_nonconvex(mesh, vertex, f));
      m.inner_defects += details.flipped[f];
      if(before && details.flipped[f] > before->flipped[f])
        mark_face(mesh, f);
    }
    for(int c = 0; c < mesh.number_of_corners(); ++c)
    {
      const int o = mesh.opposite[c], f = mesh.corner_face[c];
      if(o > c)
      {
        details.folded[c] = is_folded(details.normals[f], details.normals[mesh.corner_face[o]]);
        m.inner_defects += details.folded[c];
      }
      else if(o < 0 && patch.outside_face[c] >= 0)
      {
        details.folded[c] = is_folded(details.normals[f], m_outside_normal[c]);
        m.boundary_defects += details.folded[c];
      }
      if(before && details.folded[c] && !before->folded[c])
      {
        mark_face(mesh, f);
        if(o >= 0)
          mark_face(mesh, mesh.corner_face[o]);
      }
    }
    for(std::size_t e = 0; e < patch.elements.size(); ++e)
    {
      const double d = element_energy(density, patch.elements[e], vertex);
      details.densities[e] = d;
      details.cosines[e] = smallest_angle_cosine(patch.elements[e], vertex);
      m.energy += d;
      if(before &&
         ((d > m_limits.worst && d > before->densities[e]) ||
          (details.cosines[e] > m_limits.sharpest && details.cosines[e] > before->cosines[e])))
      {
        m_exceeds = true;
        for(const int v : patch.elements[e].vertices)
          m_is_offender[v] = 1;
      }
    }
    return m;
  }

  // Looks where the vertices of R that are guests of the patch find it now; faces of the mesh that
  // are all on R may still have cut off what is between them.
  void visit_guests(const Patch& patch, const Reference_surface& reference)
  {
    const auto point = [&](int v) -> const Vector_3& { return m_candidate[v].position; };
    const auto is_bad = [&](int polygon) {
      const int begin = patch.polygons.face_begin[polygon];
      for(int c = begin; c < patch.polygons.face_begin[polygon + 1]; ++c)
        if(m_is_bad[patch.polygons.corner_vertex[c]])
          return true;
      return false;
    };
    m_guests = patch.guests;
    for(Patch::Guest& guest : m_guests)
    {
      const Foot foot = descend_to(patch.triangles(), point, reference.points()[guest.vertex],
                                   patch.triangle_of(guest.polygon));
      const double before = guest.distance;
      guest.polygon = patch.polygon_of(foot.face);
      guest.distance = std::sqrt(foot.squared_distance);
      // held at the bound, bad elements would stay bad: a fifth of it is reserved for them
      const double bound = (is_bad(guest.polygon) ? 1. : 0.8) * m_limits.drift;
      if(guest.distance > bound && guest.distance > before)
      {
        m_exceeds = true;
        mark_face(patch.polygons, guest.polygon);
      }
    }
  }

  // where nothing is wrong and yet the energy does not fall: what rose most
  void mark_risen(const Patch& patch)
  {
    for(std::size_t e = 0; e < patch.elements.size(); ++e)
      if(m_after.densities[e] > 1.5 * m_before.densities[e])
        for(const int v : patch.elements[e].vertices)
          m_is_offender[v] = 1;
  }

  void mark_face(const Indexed_mesh& mesh, int f)
  {
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      m_is_offender[mesh.corner_vertex[c]] = 1;
  }

  template <typename Mover>
  void place(const Patch& patch, Mover& mover)
  {
    for(std::size_t v = 0; v < patch.vertices.size(); ++v)
    {
      if(!m_needs_placing[v])
        continue;
      m_needs_placing[v] = 0;
      m_candidate[v] = patch.placed[v];
      if(!patch.is_free[v])
        continue;
      while(m_step[v] > 0 && !mover.place(patch, int(v), m_step[v], m_candidate[v]))
      {
        m_step[v] = m_step[v] > 0.05 ? 0.5 * m_step[v] : 0;
        m_candidate[v] = patch.placed[v];
      }
    }
  }

  void cut(const Patch& patch, int v, double factor)
  {
    if(!patch.is_free[v] || m_step[v] == 0)
      return;
    m_step[v] *= factor;
    m_needs_placing[v] = 1;
    if(m_step[v] < 1e-3)
    {
      m_step[v] = 0;
      m_candidate[v] = patch.placed[v];
    }
  }

  // the offending vertices go back, and after a while their neighbours, too
  void cut_offenders(const Patch& patch, int attempt)
  {
    const Indexed_mesh& mesh = patch.polygons;
    for(int ring = 0; ring < attempt / 2; ++ring)
    {
      const std::vector<char> inner = m_is_offender;
      for(int c = 0; c < mesh.number_of_corners(); ++c)
        if(inner[mesh.source(c)] || inner[mesh.target(c)])
          m_is_offender[mesh.source(c)] = m_is_offender[mesh.target(c)] = 1;
    }
    for(int v = 0; v < int(m_is_offender.size()); ++v)
      if(m_is_offender[v])
        cut(patch, v, attempt < 3 ? 0.4 : 0.);
    even_out(patch);
  }

  // Neighbours must not go very different parts of their ways: that shears what is between them.
  void even_out(const Patch& patch)
  {
    const double largest_difference = 0.2;
    const Indexed_mesh& mesh = patch.polygons;
    for(bool changes = true; changes;)
    {
      changes = false;
      const auto limit = [&](int v, int neighbour) {
        const double most = m_step[neighbour] + largest_difference;
        if(patch.is_free[v] && patch.is_free[neighbour] && m_step[v] > most)
        {
          m_step[v] = most;
          m_needs_placing[v] = 1;
          changes = true;
        }
      };
      for(int c = 0; c < mesh.number_of_corners(); ++c)
      {
        limit(mesh.source(c), mesh.target(c));
        limit(mesh.target(c), mesh.source(c));
      }
    }
  }

  Limits m_limits{0, 0, 0, 1, 0};
  std::vector<Patch::Guest> m_guests;
  bool m_exceeds = false;
  std::vector<double> m_step;
  std::vector<char> m_needs_placing, m_is_offender, m_is_bad;
  std::vector<Placed_vertex> m_candidate;
  std::vector<Vector_3> m_outside_normal;
  Details m_before, m_after;
  Patch_measure m_accepted;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ACCEPTANCE_H
