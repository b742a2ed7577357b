// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_ACCEPTANCE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_ACCEPTANCE_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/step_field.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/Drift_tracker.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/face_turn.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

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
  double drift_energy = 0;  // what the drift barrier adds
  double angles = 0;        // sum of the faces' smallest, in degrees, where their mean may not fall
  double volume = 0;        // six times that of the cones over its faces, where that is bounded
  int inner_defects = 0;    // flips, quads that are not convex, and folds of edges inside
  int boundary_defects = 0; // folds of edges to faces outside
  int defects() const { return inner_defects + boundary_defects; }
  bool has_fallen_from(const Patch_measure& before) const
  {
    return energy < before.energy && energy + drift_energy < before.energy + before.drift_energy;
  }
};

// Decides on what a mover proposes: first flips, fold edges and non-convex quads, then energy, all
// measured on R. Where the proposal fails the step is cut back, first where it does harm, then
// everywhere; only what a cut changes is measured again.
class Acceptance_test
{
public:
  explicit Acceptance_test(Interruption* interruption = nullptr) : m_interruption(interruption) {}

  // bounds on single elements and on single vertices of R, and what else changes between iterations
  struct Limits
  {
    double worst = 0;    // no step may take an element beyond it, or further beyond
    double sharpest = 1; // no step may take the cosine of an angle beyond it, or further beyond
    double bad = 0;      // elements beyond it are bad
    // elements with a density or a cosine of an angle beyond these are what a search is for
    double searched = 0, sharp = 1;
    double strain_resistance = 0; // where Newton steps on the surface begin
    bool accepts_all = false;     // what the mover proposes is kept without a test
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
    m_limits = limits;
    m_reference = &state.reference;
    if(is_first)
    {
      prepare(patch, state);
      measure(patch, density, patch.placed, m_before);
      decision.before = sum_up(patch, m_before);
    }
    else // what was accepted last is what there is now
    {
      decision.before = m_accepted;
      std::swap(m_before, m_after);
    }
    if(is_first)
    {
      m_least_angles = decision.before.angles - patch.angle_allowance;
      m_initial_volume = decision.before.volume;
    }
    m_after = m_before;
    forget_offenders();
    m_steps.start(patch);
    m_offences.assign(patch.vertices.size(), 0);
    m_candidate = patch.placed;
    m_tracker.start(patch);
    decision.before.drift_energy = m_tracker.energy(patch);

    const int maximum_attempts = 20, local_attempts = 16;
    for(int attempt = 0; attempt < maximum_attempts; ++attempt)
    {
      check(m_interruption);
      place(patch, mover);
      measure(patch, density, m_candidate, m_after);
      decision.after = sum_up(patch, m_after);
      check(m_interruption);
      m_tracker.visit(patch, state.reference, m_candidate, m_changed, m_is_changed);
      decision.after.drift_energy = m_tracker.energy(patch);
      const bool exceeds = find_offenders(patch, decision.before);
      const int defects = decision.after.defects() - decision.before.defects();
      const bool falls = decision.after.has_fallen_from(decision.before);
      // a defect that is mended may cost
      const double price = 60. * (std::max)(0, -defects);
      const bool keeps_angles = decision.after.angles >= m_least_angles - price;
      const double gain = decision.after.volume - m_initial_volume;
      const bool grows = gain > patch.largest_volume_gain,
                 shrinks = -gain > patch.largest_volume_loss;
      const bool keeps_sums = keeps_angles && !grows && !shrinks;
      if(m_limits.accepts_all ||
         (!exceeds && keeps_sums && (defects < 0 || (defects == 0 && falls))))
      {
        decision.accepted = true;
        decision.is_final = m_limits.accepts_all;
        m_accepted = decision.after;
        return decision;
      }
      if(defects <= 0 && !exceeds)
      {
        if(grows || shrinks)
          find_sweeping(patch, grows ? 1 : -1);
        else if(keeps_angles)
          find_risen(patch, decision);
        else
          find_sharper(patch);
      }
      if(!m_offenders.empty() && attempt < local_attempts)
        cut_offenders(patch);
      else
        m_steps.cut_all(patch, 0.5);
      if(m_steps.has_stopped(patch))
        break;
      forget_offenders();
    }
    decision.after = decision.before;
    return decision;
  }

  // what was accepted, to be taken, and the part of its way that each vertex went
  std::vector<Placed_vertex>& candidate() { return m_candidate; }
  const std::vector<double>& steps() const { return m_steps.parts(); }
  const std::vector<Patch::Sample>& samples() const { return m_tracker.samples(); }
  const std::vector<Patch::Guest>& guests() const { return m_tracker.guests(); }

private:
  // what a measure is made of; a cut changes it piece by piece
  struct Details
  {
    std::vector<Vector_3> normals; // per face
    std::vector<char> flipped;     // per face: turned over, or a quad that is not convex
    std::vector<char> folded;      // per corner, at the first of the two of an edge
    std::vector<double> densities; // per element
    std::vector<double> cosines;   // per face: cosine of its smallest angle
    std::vector<double> volumes;   // per face, if they are bounded
    // where the turn of faces is bounded: per face, in degrees, and per corner the cosine of that of its
    // edge, at the first of the two
    std::vector<double> turns, edge_turns;
  };

  void prepare(const Patch& patch, const Optimization_state& state)
  {
    const auto vertex = [&](int v) -> const Placed_vertex& { return state.vertices[v]; };
    m_outside_normal.resize(patch.outside_face.size());
    for(std::size_t c = 0; c < patch.outside_face.size(); ++c)
      if(patch.outside_face[c] >= 0)
        m_outside_normal[c] = face_normal(state.mesh, vertex, patch.outside_face[c]);
    const int n = patch.polygons.number_of_faces();
    m_before.normals.resize(n);
    m_before.flipped.resize(n);
    m_before.folded.assign(patch.polygons.number_of_corners(), 0);
    m_before.densities.resize(patch.elements.size());
    m_before.cosines.resize(n);
    m_before.volumes.assign(patch.guards_volume() ? n : 0, 0);
    m_before.turns.assign(patch.bounds_turn.size(), 0);
    m_before.edge_turns.assign(patch.bounds_turn.empty() ? 0 : patch.outside_face.size(), 1);
    m_is_changed.assign(n, 0);
    m_changed.resize(n);
    for(int f = 0; f < n; ++f)
      m_changed[f] = f;
    m_offenders.clear();
    m_is_offender.assign(patch.vertices.size(), 0);
  }

  // evaluates the faces in m_changed
  template <typename Density>
  void measure(const Patch& patch,
               const Density& density,
               const std::vector<Placed_vertex>& placed,
               Details& details)
  {
    const Indexed_mesh& mesh = patch.polygons;
    const auto vertex = [&](int v) -> const Placed_vertex& { return placed[v]; };
    for(const int f : m_changed)
    {
      details.normals[f] = face_normal(mesh, vertex, f);
      details.flipped[f] =
        char(is_flipped(mesh, vertex, f, details.normals[f]) + is_nonconvex(mesh, vertex, f));
      if(!patch.bounds_turn.empty() && patch.bounds_turn[f])
        details.turns[f] = face_turn(mesh, *m_reference, vertex, f, details.normals[f]);
      for(int e = patch.element_begin[f]; e < patch.element_begin[f + 1]; ++e)
        details.densities[e] = element_energy(density, patch.elements[e], vertex);
      details.cosines[f] = smallest_angle_cosine(mesh, vertex, f);
      if(patch.guards_volume() && patch.bounds_turn[f])
        details.volumes[f] =
          face_volume(mesh, vertex, f, details.normals[f], patch.placed[0].position);
    }
    for(const int f : m_changed)
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      {
        const int o = mesh.opposite[c];
        if(!patch.bounds_turn.empty() && patch.bounds_turn[f] &&
           (o >= 0 || patch.outside_face[c] >= 0))
          details.edge_turns[o >= 0 ? (std::min)(c, o) : c] =
            cosine(details.normals[f],
                   o >= 0 ? details.normals[mesh.corner_face[o]] : m_outside_normal[c]);
        if(o >= 0)
          details.folded[(std::min)(c, o)] =
            is_folded(details.normals[f], details.normals[mesh.corner_face[o]]);
        else if(patch.outside_face[c] >= 0)
          details.folded[c] = is_folded(details.normals[f], m_outside_normal[c]);
      }
  }

  static double cosine(const Vector_3& a, const Vector_3& b)
  {
    const double lengths = a.norm() * b.norm();
    return lengths > 0 ? a.dot(b) / lengths : 1.;
  }

  // in a fixed order, whatever was measured when
  static Patch_measure sum_up(const Patch& patch, const Details& details)
  {
    Patch_measure m;
    for(const double d : details.densities)
      m.energy += d;
    if(std::isfinite(patch.angle_allowance))
      for(const double c : details.cosines)
        m.angles += degrees(c);
    for(const double v : details.volumes)
      m.volume += v;
    for(const char flipped : details.flipped)
      m.inner_defects += flipped;
    for(std::size_t c = 0; c < details.folded.size(); ++c)
      if(details.folded[c])
        ++(patch.outside_face[c] >= 0 ? m.boundary_defects : m.inner_defects);
    return m;
  }

  // takes the vertices whose steps are new to where they lead, and notes the faces that change
  template <typename Mover>
  void place(const Patch& patch, Mover& mover)
  {
    const Indexed_mesh& mesh = patch.polygons;
    for(const int f : m_changed)
      m_is_changed[f] = 0;
    m_changed.clear();
    m_steps.settle(patch, mover, [&](int v, double step) {
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
      {
        const int f = mesh.corner_face[mesh.vertex_corners[k]];
        if(!m_is_changed[f])
        {
          m_is_changed[f] = 1;
          m_changed.push_back(f);
        }
      }
      m_candidate[v] = patch.placed[v];
      if(step == 0 || mover.place(patch, v, step, m_candidate[v]))
        return true;
      m_candidate[v] = patch.placed[v];
      return false;
    });
  }

  // finds what is worse than it may be; returns whether a limit is exceeded
  bool find_offenders(const Patch& patch, const Patch_measure& before)
  {
    const Indexed_mesh& mesh = patch.polygons;
    bool exceeds = false;
    for(int f = 0; f < mesh.number_of_faces(); ++f)
      if(m_after.flipped[f] > m_before.flipped[f])
        add_face(mesh, f);
    for(int c = 0; c < mesh.number_of_corners(); ++c)
      if(m_after.folded[c] && !m_before.folded[c])
      {
        add_face(mesh, mesh.corner_face[c]);
        if(mesh.opposite[c] >= 0)
          add_face(mesh, mesh.corner_face[mesh.opposite[c]]);
      }
    for(std::size_t e = 0; e < patch.elements.size(); ++e)
    {
      const double d = m_after.densities[e];
      if(d > m_limits.worst && d > m_before.densities[e])
      {
        exceeds = true;
        add_element(patch, e);
      }
    }
    for(int f = 0; f < mesh.number_of_faces(); ++f)
    {
      const double cosine = m_after.cosines[f];
      if(cosine > m_limits.sharpest && cosine > m_before.cosines[f])
      {
        exceeds = true;
        add_face(mesh, f);
      }
    }
    const double largest_turn = 20, cosine_of_edge_turn = 0.788; // 38 degrees
    for(std::size_t c = 0; c < m_after.edge_turns.size(); ++c)
      if(patch.is_smooth[c] && m_after.edge_turns[c] < cosine_of_edge_turn &&
         m_after.edge_turns[c] < m_before.edge_turns[c])
      {
        exceeds = true;
        add_face(mesh, mesh.corner_face[c]);
        if(mesh.opposite[c] >= 0)
          add_face(mesh, mesh.corner_face[mesh.opposite[c]]);
      }
    for(std::size_t f = 0; f < m_after.turns.size(); ++f)
      if(m_after.turns[f] > largest_turn && m_after.turns[f] > m_before.turns[f])
      {
        exceeds = true;
        add_face(mesh, int(f));
      }
    // what the barrier is felt by more than what an element holds is as good as beyond the bound
    const double much = 0.5 * std::abs(before.energy) / double(patch.elements.size());
    const auto visit = [&](double distance, double bound, double old, double old_bound) {
      if(!(distance * old_bound > old * bound) || !Drift_barrier::is_felt(distance, bound))
        return false;
      const bool is_beyond = distance > Drift_barrier::last_part * bound;
      exceeds = exceeds || is_beyond;
      return is_beyond ||
             patch.barrier.value(distance, bound) > patch.barrier.value(old, old_bound) + much;
    };
    for(std::size_t s = 0; s < samples().size(); ++s)
      if(visit(samples()[s].distance, samples()[s].bound, patch.samples[s].distance,
               patch.samples[s].bound))
        add_triangle(patch, int(s / 4));
    for(std::size_t i = 0; i < guests().size(); ++i)
      if(visit(guests()[i].distance, guests()[i].bound, patch.guests[i].distance,
               patch.guests[i].bound))
        add_face(mesh, guests()[i].polygon);
    return exceeds;
  }

  // where nothing is wrong and yet the energy does not fall: what rose most
  void find_risen(const Patch& patch, const Decision& decision)
  {
    const double much = 4 * (std::abs(decision.before.energy) / double(patch.elements.size()));
    for(std::size_t e = 0; e < patch.elements.size(); ++e)
    {
      const double before = m_before.densities[e], after = m_after.densities[e];
      if(after > 1.5 * before || after > before + much)
        add_element(patch, e);
    }
  }

  // where the mean of angles falls below the input's: the faces whose angles fall
  void find_sharper(const Patch& patch)
  {
    const double little = 0.1; // degrees
    for(int f = 0; f < patch.polygons.number_of_faces(); ++f)
      if(degrees(m_after.cosines[f]) < degrees(m_before.cosines[f]) - little)
        add_face(patch.polygons, f);
  }

  // where the volume grows (sign 1) or shrinks (-1) too much: the vertices that contribute most
  void find_sweeping(const Patch& patch, double sign)
  {
    const Indexed_mesh& mesh = patch.polygons;
    m_swept.assign(patch.vertices.size(), 0);
    double sum = 0;
    int number = 0;
    for(std::size_t v = 0; v < m_swept.size(); ++v)
    {
      if(!patch.is_free[v])
        continue;
      Vector_3 normal = Vector_3::Zero();
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
        normal += m_before.normals[mesh.corner_face[mesh.vertex_corners[k]]];
      m_swept[v] = sign * normal.dot(m_candidate[v].position - patch.placed[v].position);
      if(m_swept[v] > 0)
      {
        sum += m_swept[v];
        ++number;
      }
    }
    for(std::size_t v = 0; v < m_swept.size(); ++v)
      if(m_swept[v] > 0 && m_swept[v] * number >= sum)
        add(int(v));
  }

  static double degrees(double cosine)
  {
    return degrees_per_radian * std::acos((std::min)(1., cosine));
  }

  void add(int v)
  {
    if(!m_is_offender[v])
    {
      m_is_offender[v] = 1;
      m_offenders.push_back(v);
    }
  }
  void add_face(const Indexed_mesh& mesh, int f)
  {
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      add(mesh.corner_vertex[c]);
  }
  void add_triangle(const Patch& patch, int t)
  {
    for(int k = 0; k < 3; ++k)
      add(patch.triangles().corner_vertex[3 * t + k]);
  }
  void add_element(const Patch& patch, std::size_t e)
  {
    for(const int v : patch.elements[e].vertices)
      add(v);
  }

  // the offending vertices go back, and after a while their neighbours, too
  void cut_offenders(const Patch& patch)
  {
    const Indexed_mesh& mesh = patch.polygons;
    m_rings.assign(patch.vertices.size(), 0);
    for(const int v : m_offenders)
    {
      ++m_offences[v];
      m_rings[v] = m_offences[v] / 2;
    }
    for(std::size_t i = 0; i < m_offenders.size(); ++i)
    {
      const int v = m_offenders[i], rings = m_rings[v];
      m_steps.cut(patch, v, m_offences[v] < 4 ? 0.4 : 0.);
      if(rings == 0)
        continue;
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
      {
        const int f = mesh.corner_face[mesh.vertex_corners[k]];
        for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        {
          const int w = mesh.corner_vertex[c];
          if(!m_is_offender[w])
          {
            add(w);
            m_offences[w] = (std::max)(m_offences[w], m_offences[v] - 1);
            m_rings[w] = rings - 1;
          }
        }
      }
    }
  }

  void forget_offenders()
  {
    for(const int v : m_offenders)
      m_is_offender[v] = 0;
    m_offenders.clear();
  }

  Interruption* m_interruption;
  const Reference_surface* m_reference = nullptr;
  Limits m_limits;
  Step_field m_steps;
  std::vector<Placed_vertex> m_candidate;
  Drift_tracker m_tracker;
  std::vector<Vector_3> m_outside_normal;
  Details m_before, m_after;
  Patch_measure m_accepted;
  // sums for all proposals for a patch: the least of its angles, and the volume before the first
  double m_least_angles = 0, m_initial_volume = 0;
  std::vector<double> m_swept; // per vertex
  std::vector<int> m_changed;  // faces to be measured
  std::vector<char> m_is_changed, m_is_offender;
  std::vector<int> m_offenders; // vertices
  std::vector<int> m_offences, m_rings;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_ACCEPTANCE_H
