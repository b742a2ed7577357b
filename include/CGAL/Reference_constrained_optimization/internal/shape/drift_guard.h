// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_GUARD_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_GUARD_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/point_index.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/local_bounds.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/drift_samples.h>
#include <CGAL/Reference_constrained_optimization/internal/support/for_each_block.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// How far mesh and reference are apart, both ways: at the middles of the mesh's edges and triangles,
// and at the vertices and the middles of the creases of R. Vertices of the mesh on R do not keep its
// faces from leaving R, nor from cutting R's features off. A patch travels
// with its samples and the points of R that are projected onto it (Patch_samples); they return with it once
// it is accepted.
//
// What is beyond the bound on input may not go further than it is.
class Drift_guard
{
public:
  bool is_on() const { return !m_first.empty(); }

  // The bound must be finite. If it is `at_least` that, it is wide enough for steps to be allowed as
  // far as the input is away.
  template <typename ConcurrencyTag>
  void initialize(const Optimization_state& state,
                  double bound,
                  bool at_least,
                  const Drift_barrier& barrier,
                  Interruption* interruption = nullptr)
  {
    m_barrier = barrier;
    welcome_guests<ConcurrencyTag>(state, interruption);
    const std::vector<double> distances = measure_samples<ConcurrencyTag>(state, interruption);
    const double guests = *std::max_element(m_distance.begin(), m_distance.end());
    const double samples = *std::max_element(distances.begin(), distances.end());
    m_initial_drift = (std::max)(guests, samples);
    m_bound = at_least ? (std::max)(bound, m_initial_drift / Drift_barrier::last_part) : bound;
    if(at_least)
      bound_locally(state);
    const auto allowed = [](double bound, double distance) {
      return (std::max)(bound, distance / Drift_barrier::last_part);
    };
    if(!at_least && guests > m_bound)
      m_witness_bounds.assign(m_distance.size(), m_bound);
    for(std::size_t r = 0; r < m_witness_bounds.size(); ++r)
      m_witness_bounds[r] = allowed(m_witness_bounds[r], m_distance[r]);
    if(samples > (at_least ? 0 : m_bound))
      for(const double d : distances)
        m_least_bounds.push_back(d / Drift_barrier::last_part);
  }

  double bound() const { return m_bound; }
  void set_barrier(const Drift_barrier& barrier) { m_barrier = barrier; }

  // the largest distance of a sample when the guard was initialized, and now
  double initial_drift() const { return m_initial_drift; }
  template <typename ConcurrencyTag>
  double drift(const Optimization_state& state)
  {
    double largest = *std::max_element(m_distance.begin(), m_distance.end());
    for(const Known& known : m_known)
      largest = (std::max)(largest, known.distance);
    if(m_known.empty()) // quads
      for(const double d : measure_samples<ConcurrencyTag>(state))
        largest = (std::max)(largest, d);
    return largest;
  }

  // the samples of a patch, and the points of R that are projected onto it
  Patch_samples gather(const Optimization_state& state, const Patch& patch) const
  {
    Patch_samples result;
    if(!is_on())
      return result;
    result.barrier = m_barrier;
    result.bound = m_bound;
    if(!m_local_bounds.empty())
      result.local_bounds = &m_local_bounds;
    if(!m_least_bounds.empty())
      for(const int f : patch.faces)
        result.least_bounds.push_back(m_least_bounds[f]);
    const auto vertex = [&](int v) -> const Placed_vertex& { return patch.placed[v]; };

    const int n = patch.triangles().number_of_faces();
    result.samples.resize(4 * n);
    for(int t = 0; t < n; ++t)
      for(int i = 0; i < 4; ++i)
      {
        const int s = sample_of(patch, t, i);
        if(s != 4 * t + i)
          continue;
        Patch_samples::Sample& sample = result.samples[s];
        if(!m_known.empty())
        {
          const Known& known = m_known[known_sample(state.mesh, patch, s)];
          sample.face = known.face;
          sample.distance = known.distance;
          sample.bound = known.face >= 0 ? result.bound_at(patch.polygon_of(t), known.face) : 0;
        }
        if(sample.face < 0 || Drift_barrier::is_felt(sample.distance, sample.bound))
          locate_sample(patch, result, state.reference, vertex, s, sample);
      }

    for(std::size_t f = 0; f < patch.faces.size(); ++f)
      for(int r = m_first[patch.faces[f]]; r >= 0; r = m_next[r])
      {
        result.guests.push_back(
          {r, int(f), m_distance[r], m_witness_bounds.empty() ? m_bound : m_witness_bounds[r]});
        Patch_samples::Guest& guest = result.guests.back();
        if(Drift_barrier::is_felt(guest.distance, guest.bound))
          locate_guest(patch, state.reference, vertex, guest);
      }
    return result;
  }

  // what a solved patch knows of its samples
  struct Known
  {
    int face = -1; // of R
    double distance = 0;
  };
  typedef std::vector<std::pair<std::size_t, Known>> Known_samples;

  Known_samples
  samples_of(const Indexed_mesh& mesh, const Patch& patch, const Patch_samples& samples) const
  {
    Known_samples result;
    if(!is_on() || m_known.empty())
      return result;
    for(int s = 0; s < int(samples.samples.size()); ++s)
      if(sample_of(patch, s / 4, s % 4) == s)
        result.push_back(
          {known_sample(mesh, patch, s), {samples.samples[s].face, samples.samples[s].distance}});
    return result;
  }

  // patches without a common face may return at the same time
  void take_back(const std::vector<int>& faces,
                 const std::vector<Patch_samples::Guest>& guests,
                 const Known_samples& samples)
  {
    if(!is_on())
      return;
    for(const int f : faces)
      m_first[f] = -1;
    for(const Patch_samples::Guest& g : guests)
      settle(g.witness, faces[g.polygon], g.distance);
    for(const auto& s : samples)
      m_known[s.first] = s.second;
  }

  // what is known of some faces, to be restored together
  struct Snapshot
  {
    std::vector<int> faces;
    std::vector<Patch_samples::Guest> guests; // each with the position of its face in the list
    Known_samples samples;
  };

  void save(const Indexed_mesh& mesh, int f, Snapshot& snapshot) const
  {
    if(!is_on())
      return;
    for(int r = m_first[f]; r >= 0; r = m_next[r])
      snapshot.guests.push_back({r, int(snapshot.faces.size()), m_distance[r], 0});
    snapshot.faces.push_back(f);
    if(!m_known.empty())
      for(int i = 0; i < 4; ++i)
      {
        const std::size_t s = known_sample(mesh, f, i);
        snapshot.samples.push_back({s, m_known[s]});
      }
  }
  void restore(const Snapshot& snapshot)
  {
    take_back(snapshot.faces, snapshot.guests, snapshot.samples);
  }

private:
  void settle(int r, int face, double distance)
  {
    m_distance[r] = distance;
    m_next[r] = m_first[face];
    m_first[face] = r;
  }

  static std::size_t known_sample(const Indexed_mesh& mesh, int f, int i)
  {
    return std::size_t(i < 3 ? edge_sample(mesh, 3 * f + i) : 4 * f + i);
  }
  static std::size_t known_sample(const Indexed_mesh& mesh, const Patch& patch, int s)
  {
    return known_sample(mesh, patch.faces[s / 4], s % 4);
  }

  template <typename ConcurrencyTag>
  void welcome_guests(const Optimization_state& state, Interruption* interruption)
  {
    const Indexed_mesh& mesh = state.mesh;
    const Indexed_mesh& reference = state.reference.mesh();
    const int n = state.reference.number_of_witnesses(), vertices = reference.number_of_vertices();
    m_first.assign(mesh.number_of_faces(), -1);
    m_next.assign(n, -1);
    m_distance.assign(n, 0);
    Mesh_copy copy;
    for(const Placed_vertex& v : state.vertices)
      copy.points.push_back(v.position);
    const Point_index index(copy.points, [&](int v) { return !mesh.is_isolated(v); });
    std::vector<int> twin(vertices, -1), face(n, -1);
    const auto is_used = [&](int r) { return r >= vertices || !reference.is_isolated(r); };
    bool all_are_known = true;
    for(int r = 0; r < n; ++r)
    {
      if(r < vertices && is_used(r))
        twin[r] = index.find(state.reference.points()[r]);
      if(r < vertices)
        face[r] = twin[r] < 0 ? -1 : mesh.face_at(twin[r]);
      else
      {
        const int c = state.reference.crease(r);
        const int a = twin[reference.source(c)], b = twin[reference.target(c)];
        face[r] = a < 0 || b < 0 ? -1 : mesh.face_at(a, b);
      }
      all_are_known = all_are_known && (face[r] >= 0 || !is_used(r));
    }
    check(interruption);
    if(!all_are_known)
    {
      copy.mesh = mesh;
      const Reference_surface surface(copy);
      check(interruption);
      for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
        for(int r = begin; r < end; ++r)
        {
          check_now_and_then(interruption, r);
          if(face[r] < 0 && is_used(r))
          {
            const Vector_3 p = state.reference.witness(r);
            const Surface_point foot = surface.closest(p);
            face[r] = surface.original_face(foot.face);
            if(state.counts(face[r]))
              m_distance[r] = (foot.position - p).norm();
          }
        }
      });
    }
    for(int r = 0; r < n; ++r)
      if(face[r] >= 0)
        settle(r, face[r], m_distance[r]);
  }

  // the largest distance of the samples of each face
  template <typename ConcurrencyTag>
  std::vector<double> measure_samples(const Optimization_state& state,
                                      Interruption* interruption = nullptr)
  {
    const Indexed_mesh& mesh = state.mesh;
    const int n = mesh.number_of_faces();
    const bool is_split = mesh.number_of_corners() != 3 * n;
    if(!is_split)
      m_known.assign(4 * std::size_t(n), Known());
    std::vector<double> largest(n, 0);
    for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
      for(int f = begin; f < end; ++f)
      {
        check_now_and_then(interruption, f);
        if(!state.counts(f))
          continue;
        if(is_face_of_reference(state, f))
        {
          if(!is_split)
            for(int i = 0; i < 4; ++i)
              m_known[4 * std::size_t(f) + i].face = f;
          continue;
        }
        // as a fan: a quad is split this way or that
        const int first = mesh.face_begin[f];
        for(int c = first + 1; c + 1 < mesh.face_begin[f + 1]; ++c)
          for(int i = 0; i < 4; ++i)
          {
            const int corners[3] = {first, c, c + 1};
            Vector_3 p = Vector_3::Zero();
            for(int k = 0; k < 3; ++k)
              p +=
                sample_barycentric(i)(k) * state.vertices[mesh.corner_vertex[corners[k]]].position;
            // a descent ends at a local minimum: what the corners lead to may differ
            Known best;
            for(int k = 0; k < 3; ++k)
            {
              const int face = state.vertices[mesh.corner_vertex[corners[k]]].on_reference.face;
              const Surface_point foot = state.reference.descend(p, face);
              const double distance = (foot.position - p).norm();
              if(k == 0 || distance < best.distance)
                best = {foot.face, distance};
            }
            largest[f] = (std::max)(largest[f], best.distance);
            if(!is_split && known_sample(mesh, f, i) == 4 * std::size_t(f) + i)
              m_known[4 * std::size_t(f) + i] = best;
          }
      }
    });
    return largest;
  }

  // where a mesh is its own reference there is nothing to look for
  static bool is_face_of_reference(const Optimization_state& state, int f)
  {
    const Indexed_mesh& reference = state.reference.mesh();
    if(state.mesh.degree(f) != 3 || f >= reference.number_of_faces())
      return false;
    for(int i = 0; i < 3; ++i)
      if(state.reference.corner_point(f, i) !=
         state.vertices[state.mesh.corner_vertex[state.mesh.face_begin[f] + i]].position)
        return false;
    return true;
  }

  // by the size of what is there
  void bound_locally(const Optimization_state& state)
  {
    const Reference_surface& reference = state.reference;
    const Indexed_mesh& mesh = reference.mesh();
    const std::vector<double> bounds = local_bounds(reference, state.is_mechanical, m_bound);
    m_local_bounds.resize(mesh.number_of_faces());
    for(int f = 0; f < mesh.number_of_faces(); ++f)
    {
      const int* v = &mesh.corner_vertex[mesh.face_begin[f]];
      m_local_bounds[f] = (std::min)({bounds[v[0]], bounds[v[1]], bounds[v[2]]});
    }
    m_witness_bounds = bounds;
    for(int r = mesh.number_of_vertices(); r < reference.number_of_witnesses(); ++r)
    {
      const int c = reference.crease(r);
      m_witness_bounds.push_back((std::min)(bounds[mesh.source(c)], bounds[mesh.target(c)]));
    }
  }

  Drift_barrier m_barrier;
  double m_bound = 0, m_initial_drift = 0;
  std::vector<double> m_local_bounds; // per triangle of R; empty if all are the bound
  std::vector<double>
    m_least_bounds; // per face of the mesh: what it has from the start; may be empty
  std::vector<double> m_witness_bounds; // per witness; empty if all are the bound
  std::vector<Known> m_known; // four per face if all are triangles; no less than the true distance
  // the guests of every face are a list: the first one, and the next one after each witness
  std::vector<int> m_first, m_next;
  std::vector<double> m_distance; // per witness
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_GUARD_H
