// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_SHAPE_BOUND_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_SHAPE_BOUND_H

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

// Bounds the distance between mesh and reference in both directions: at the midpoints of the mesh's edges
// and the centroids of its triangles, and at the vertices and crease midpoints of R. Even if all vertices
// of the mesh are on R, its faces may leave R or cut off features of R. A patch gathers its samples and
// those of R that are projected onto it (Patch_samples); those of accepted patches are stored again.
//
// Distances that exceed the bound on input may not increase.
class Shape_bound
{
public:
  bool is_enabled() const { return !m_first.empty(); }

  // The bound must be finite. With `may_increase` it is increased to allow the distances of the input, up to three
  // mean edges of R: what is closer than that is covered, and stays so.
  template <typename ConcurrencyTag>
  void initialize(const Optimization_state& state,
                  double bound,
                  bool may_increase,
                  const Drift_barrier& barrier,
                  Interruption* interruption = nullptr)
  {
    m_barrier = barrier;
    locate_reference_samples<ConcurrencyTag>(state, interruption);
    const std::vector<double> distances = measure_samples<ConcurrencyTag>(state, interruption);
    const double from_reference = *std::max_element(m_distance.begin(), m_distance.end());
    const double from_mesh = *std::max_element(distances.begin(), distances.end());
    m_initial_drift = (std::max)(from_reference, from_mesh);
    m_bound = bound;
    if(may_increase)
    {
      const double largest_number_of_edges = 3;
      m_bound =
        (std::max)(bound, (std::min)(m_initial_drift / Drift_barrier::limit_factor,
                                     largest_number_of_edges * state.reference.mean_edge_length()));
      compute_local_bounds(state);
    }
    const auto allowed = [](double bound, double distance) {
      return (std::max)(bound, distance / Drift_barrier::limit_factor);
    };
    if(m_reference_sample_bounds.empty() && from_reference > m_bound)
      m_reference_sample_bounds.assign(m_distance.size(), m_bound);
    for(std::size_t r = 0; r < m_reference_sample_bounds.size(); ++r)
      m_reference_sample_bounds[r] = allowed(m_reference_sample_bounds[r], m_distance[r]);
    if(from_mesh > (may_increase ? 0 : m_bound))
      for(const double d : distances)
        m_minimum_bounds.push_back(d / Drift_barrier::limit_factor);
  }

  double bound() const { return m_bound; }
  void set_barrier(const Drift_barrier& barrier) { m_barrier = barrier; }

  // the largest distance of a sample at initialization, and now
  double initial_drift() const { return m_initial_drift; }
  template <typename ConcurrencyTag>
  double drift(const Optimization_state& state)
  {
    double largest = *std::max_element(m_distance.begin(), m_distance.end());
    for(const Stored_sample& known : m_stored_samples)
      largest = (std::max)(largest, known.distance);
    if(m_stored_samples.empty()) // quads
      for(const double d : measure_samples<ConcurrencyTag>(state))
        largest = (std::max)(largest, d);
    return largest;
  }

  // the samples of a patch, and the reference samples that are projected onto it
  Patch_samples gather(const Optimization_state& state, const Patch& patch) const
  {
    Patch_samples result;
    if(!is_enabled())
      return result;
    result.barrier = m_barrier;
    result.bound = m_bound;
    if(!m_local_bounds.empty())
      result.local_bounds = &m_local_bounds;
    if(!m_minimum_bounds.empty())
      for(const int f : patch.faces)
        result.minimum_bounds.push_back(m_minimum_bounds[f]);
    const auto vertex = [&](int v) -> const Located_vertex& { return patch.located[v]; };

    const int n = patch.triangles().number_of_faces();
    result.samples.resize(4 * n);
    for(int t = 0; t < n; ++t)
      for(int i = 0; i < 4; ++i)
      {
        const int s = sample_of(patch, t, i);
        if(s != 4 * t + i)
          continue;
        Patch_samples::Sample& sample = result.samples[s];
        if(!m_stored_samples.empty())
        {
          const Stored_sample& known = m_stored_samples[sample_index(state.mesh, patch, s)];
          sample.face = known.face;
          sample.distance = known.distance;
          sample.bound = known.face >= 0 ? result.bound_at(patch.polygon_of(t), known.face) : 0;
        }
        if(sample.face < 0 || Drift_barrier::is_active(sample.distance, sample.bound))
          locate_sample(patch, result, state.reference, vertex, s, sample);
      }

    for(std::size_t f = 0; f < patch.faces.size(); ++f)
      for(int r = m_first[patch.faces[f]]; r >= 0; r = m_next[r])
      {
        result.projected_samples.push_back(
          {r, int(f), m_distance[r],
           m_reference_sample_bounds.empty() ? m_bound : m_reference_sample_bounds[r]});
        Patch_samples::Projected_sample& projected_sample = result.projected_samples.back();
        if(Drift_barrier::is_active(projected_sample.distance, projected_sample.bound))
          locate_projected_sample(patch, state.reference, vertex, projected_sample);
      }
    return result;
  }

  // the closest face and distance of a sample
  struct Stored_sample
  {
    int face = -1; // of R
    double distance = 0;
  };
  typedef std::vector<std::pair<std::size_t, Stored_sample>> Stored_samples;

  Stored_samples
  stored_samples(const Indexed_mesh& mesh, const Patch& patch, const Patch_samples& samples) const
  {
    Stored_samples result;
    if(!is_enabled() || m_stored_samples.empty())
      return result;
    for(int s = 0; s < int(samples.samples.size()); ++s)
      if(sample_of(patch, s / 4, s % 4) == s)
        result.push_back(
          {sample_index(mesh, patch, s), {samples.samples[s].face, samples.samples[s].distance}});
    return result;
  }

  // patches without a common face may be stored at the same time
  void store(const std::vector<int>& faces,
             const std::vector<Patch_samples::Projected_sample>& projected_samples,
             const Stored_samples& samples)
  {
    if(!is_enabled())
      return;
    for(const int f : faces)
      m_first[f] = -1;
    for(const Patch_samples::Projected_sample& g : projected_samples)
      assign(g.reference_sample, faces[g.polygon], g.distance);
    for(const auto& s : samples)
      m_stored_samples[s.first] = s.second;
  }

  // the samples of some faces, to be restored together
  struct Snapshot
  {
    std::vector<int> faces;
    // each with the index of its face in the list
    std::vector<Patch_samples::Projected_sample> projected_samples;
    Stored_samples samples;
  };

  void save(const Indexed_mesh& mesh, int f, Snapshot& snapshot) const
  {
    if(!is_enabled())
      return;
    for(int r = m_first[f]; r >= 0; r = m_next[r])
      snapshot.projected_samples.push_back({r, int(snapshot.faces.size()), m_distance[r], 0});
    snapshot.faces.push_back(f);
    if(!m_stored_samples.empty())
      for(int i = 0; i < 4; ++i)
      {
        const std::size_t s = sample_index(mesh, f, i);
        snapshot.samples.push_back({s, m_stored_samples[s]});
      }
  }
  void restore(const Snapshot& snapshot)
  {
    store(snapshot.faces, snapshot.projected_samples, snapshot.samples);
  }

private:
  void assign(int r, int face, double distance)
  {
    m_distance[r] = distance;
    m_next[r] = m_first[face];
    m_first[face] = r;
  }

  static std::size_t sample_index(const Indexed_mesh& mesh, int f, int i)
  {
    return std::size_t(i < 3 ? edge_sample(mesh, 3 * f + i) : 4 * f + i);
  }
  static std::size_t sample_index(const Indexed_mesh& mesh, const Patch& patch, int s)
  {
    return sample_index(mesh, patch.faces[s / 4], s % 4);
  }

  template <typename ConcurrencyTag>
  void locate_reference_samples(const Optimization_state& state, Interruption* interruption)
  {
    const Indexed_mesh& mesh = state.mesh;
    const Indexed_mesh& reference = state.reference.mesh();
    const int n = state.reference.number_of_reference_samples(),
              vertices = reference.number_of_vertices();
    m_first.assign(mesh.number_of_faces(), -1);
    m_next.assign(n, -1);
    m_distance.assign(n, 0);
    Mesh_copy copy;
    for(const Located_vertex& v : state.vertices)
      copy.points.push_back(v.position);
    const Point_index index(copy.points, [&](int v) { return !mesh.is_isolated(v); });
    std::vector<int> coincident_vertex(vertices, -1), face(n, -1);
    const auto is_used = [&](int r) { return r >= vertices || !reference.is_isolated(r); };
    bool all_are_known = true;
    for(int r = 0; r < n; ++r)
    {
      if(r < vertices && is_used(r))
        coincident_vertex[r] = index.find(state.reference.points()[r]);
      if(r < vertices)
        face[r] = coincident_vertex[r] < 0 ? -1 : mesh.face_at(coincident_vertex[r]);
      else
      {
        const int c = state.reference.crease(r);
        const int a = coincident_vertex[reference.source(c)],
                  b = coincident_vertex[reference.target(c)];
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
          check_periodically(interruption, r);
          if(face[r] < 0 && is_used(r))
          {
            const Vector_3 p = state.reference.reference_sample(r);
            const Surface_point projection = surface.closest(p);
            face[r] = surface.original_face(projection.face);
            if(state.is_optimized(face[r]))
              m_distance[r] = (projection.position - p).norm();
          }
        }
      });
    }
    for(int r = 0; r < n; ++r)
      if(face[r] >= 0)
        assign(r, face[r], m_distance[r]);
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
      m_stored_samples.assign(4 * std::size_t(n), Stored_sample());
    std::vector<double> largest(n, 0);
    for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
      for(int f = begin; f < end; ++f)
      {
        check_periodically(interruption, f);
        if(!state.is_optimized(f))
          continue;
        if(is_face_of_reference(state, f))
        {
          if(!is_split)
            for(int i = 0; i < 4; ++i)
              m_stored_samples[4 * std::size_t(f) + i].face = f;
          continue;
        }
        // as a fan, since a quad may be split along either diagonal
        const int first = mesh.face_begin[f];
        for(int c = first + 1; c + 1 < mesh.face_begin[f + 1]; ++c)
          for(int i = 0; i < 4; ++i)
          {
            const int corners[3] = {first, c, c + 1};
            Vector_3 p = Vector_3::Zero();
            for(int k = 0; k < 3; ++k)
              p +=
                sample_barycentric(i)(k) * state.vertices[mesh.corner_vertex[corners[k]]].position;
            // the local search ends at a local minimum, which depends on the start
            Stored_sample best;
            for(int k = 0; k < 3; ++k)
            {
              const int face = state.vertices[mesh.corner_vertex[corners[k]]].on_reference.face;
              const Surface_point projection = state.reference.local_closest(p, face);
              const double distance = (projection.position - p).norm();
              if(k == 0 || distance < best.distance)
                best = {projection.face, distance};
            }
            largest[f] = (std::max)(largest[f], best.distance);
            if(!is_split && sample_index(mesh, f, i) == 4 * std::size_t(f) + i)
              m_stored_samples[4 * std::size_t(f) + i] = best;
          }
      }
    });
    return largest;
  }

  // if a mesh is its own reference no search is needed
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

  // by the local feature size
  void compute_local_bounds(const Optimization_state& state)
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
    m_reference_sample_bounds = bounds;
    for(int r = mesh.number_of_vertices(); r < reference.number_of_reference_samples(); ++r)
    {
      const int c = reference.crease(r);
      m_reference_sample_bounds.push_back(
        (std::min)(bounds[mesh.source(c)], bounds[mesh.target(c)]));
    }
  }

  Drift_barrier m_barrier;
  double m_bound = 0, m_initial_drift = 0;
  std::vector<double> m_local_bounds; // per triangle of R; empty if all are the bound
  std::vector<double>
    // per face of the mesh: the bound that its initial distance requires; may be empty
    m_minimum_bounds;
  std::vector<double> m_reference_sample_bounds; // per reference sample; empty if all are the bound
  // four per face if all are triangles; distances are upper bounds
  std::vector<Stored_sample> m_stored_samples;
  // the reference samples of every face form a list: the first one, and the next one after each sample
  std::vector<int> m_first, m_next;
  std::vector<double> m_distance; // per reference sample
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_SHAPE_BOUND_H
