// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_PATCH_SELECTION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_PATCH_SELECTION_H

#include <CGAL/Reference_constrained_optimization/internal/selection/cone_proxy.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/disk_topology.h>

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

struct Selection_parameters
{
  double developability_threshold = 0.25; // epsilon_d
  int maximum_patch_size = 0;             // in faces; 0: chosen by the size of the mesh
  int exempt_size = 70;                   // the first faces of a patch need not fit the proxy
  // else a face may be at the boundary of the only patch that contains it
  bool requires_interior = true;
};

// Normals, areas and centroids of the faces, for growing patches.
struct Face_geometry
{
  std::vector<Vector_3> normals; // of unit length, or zero
  std::vector<double> areas;
  std::vector<Vector_3> centroids;

  void update(const Indexed_mesh& mesh, const std::vector<Vector_3>& points)
  {
    const int n = mesh.number_of_faces();
    normals.resize(n);
    areas.resize(n);
    centroids.resize(n);
    for(int f = 0; f < n; ++f)
      set(mesh, f, [&](int v) -> const Vector_3& { return points[v]; });
  }

  // those of one face, for points given by a function of the vertex
  template <typename PointAccess>
  void set(const Indexed_mesh& mesh, int f, const PointAccess& point)
  {
    const int begin = mesh.face_begin[f], end = mesh.face_begin[f + 1];
    const Vector_3& o = point(mesh.corner_vertex[begin]);
    Vector_3 sum = o, area = Vector_3::Zero();
    for(int c = begin + 1; c < end; ++c)
    {
      const Vector_3& p = point(mesh.corner_vertex[c]);
      sum += p;
      if(c + 1 < end)
        area += 0.5 * (p - o).cross(point(mesh.corner_vertex[c + 1]) - o);
    }
    areas[f] = area.norm();
    normals[f] = areas[f] > 0 ? Vector_3(area / areas[f]) : Vector_3(Vector_3::Zero());
    centroids[f] = sum / (end - begin);
  }
};

// The best fit among the 1-rings of a face's vertices.
inline Cone_proxy initial_proxy(const Indexed_mesh& mesh, const Face_geometry& geometry, int seed)
{
  Cone_proxy best;
  bool first = true;
  for(int c = mesh.face_begin[seed]; c < mesh.face_begin[seed + 1]; ++c)
  {
    const int v = mesh.corner_vertex[c];
    Cone_proxy_fit fit;
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int f = mesh.corner_face[mesh.vertex_corners[k]];
      fit.add(geometry.normals[f], geometry.areas[f]);
    }
    const Cone_proxy proxy = fit.fit();
    if(first || proxy.mean_cost < best.mean_cost)
      best = proxy;
    first = false;
  }
  return best;
}

// Grows nearly developable disks (paper 3.3). The queue is ordered by the length of the path from the seed
// rather than by the fitting cost, which is kept as a filter: that makes compact patches, with a larger
// share of faces away from the boundary.
class Patch_selection
{
public:
  Patch_selection(const Indexed_mesh& mesh, const Selection_parameters& parameters)
    : m_mesh(mesh),
      m_parameters(parameters),
      m_face_stamp(mesh.number_of_faces(), 0),
      m_vertex_stamp(mesh.number_of_vertices(), 0)
  {}

  // the faces of a patch around `seed`; faces with `is_taken(f)` are excluded
  template <typename IsTaken>
  std::vector<int> grow(int seed, const Face_geometry& geometry, const IsTaken& is_taken)
  {
    ++m_stamp;
    std::vector<int> patch;
    Cone_proxy_fit fit;
    Cone_proxy proxy = initial_proxy(m_mesh, geometry, seed);
    std::size_t next_fit = 128;

    const auto in_patch = [&](int f) { return m_face_stamp[f] == m_stamp; };
    const auto vertex_in_patch = [&](int v) { return m_vertex_stamp[v] == m_stamp; };
    typedef std::pair<double, int> Entry;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
    queue.push(Entry(0, seed));
    while(!queue.empty() && int(patch.size()) < m_parameters.maximum_patch_size)
    {
      const Entry entry = queue.top();
      queue.pop();
      const int f = entry.second;
      if(in_patch(f))
        continue;
      const bool is_exempt = int(patch.size()) < m_parameters.exempt_size;
      if(!is_exempt && !(proxy.cost(geometry.normals[f]) < m_parameters.developability_threshold))
        continue;
      if(!preserves_disk(m_mesh, f, in_patch, vertex_in_patch))
        continue; // tested again when another neighbour joins

      patch.push_back(f);
      m_face_stamp[f] = m_stamp;
      fit.add(geometry.normals[f], geometry.areas[f]);
      if(patch.size() == next_fit)
      {
        proxy = fit.fit();
        next_fit *= 2;
      }
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
      {
        m_vertex_stamp[m_mesh.corner_vertex[c]] = m_stamp;
        const int o = m_mesh.opposite[c];
        if(o < 0)
          continue;
        const int g = m_mesh.corner_face[o];
        if(in_patch(g) || is_taken(g))
          continue;
        queue.push(Entry(entry.first + (geometry.centroids[f] - geometry.centroids[g]).norm(), g));
      }
    }
    return patch;
  }

  // The faces of a patch that need no further visit. These are the faces outside the 2-ring of its
  // boundary (an edge of the mesh's own border is no boundary here), and always the seed. In regions as
  // thin as a few faces no face is ever outside: a face is also complete when all its vertices were inside
  // two patches since `clear_visits()`; and, unless `requires_interior` is set, when one of them is inside
  // this one.
  std::vector<int> touched(const std::vector<int>& patch)
  {
    ++m_stamp;
    ++m_ring_stamp;
    for(const int f : patch)
      m_face_stamp[f] = m_stamp;
    m_ring.resize(m_mesh.number_of_vertices(), 0);
    m_visits.resize(m_mesh.number_of_faces(), 0);
    const auto in_patch = [&](int f) { return m_face_stamp[f] == m_stamp; };
    for(const int f : patch)
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        if(m_mesh.opposite[c] >= 0 && !in_patch(m_mesh.corner_face[m_mesh.opposite[c]]))
          m_ring[m_mesh.source(c)] = m_ring[m_mesh.target(c)] = 2 * m_ring_stamp;
    const auto touches = [&](int f, int ring) {
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        if(m_ring[m_mesh.corner_vertex[c]] >= ring)
          return true;
      return false;
    };
    // second ring: vertices of the faces of the first
    for(const int f : patch)
      if(touches(f, 2 * m_ring_stamp))
        for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        {
          int& r = m_ring[m_mesh.corner_vertex[c]];
          r = (std::max)(r, 2 * m_ring_stamp - 1);
        }
    const auto has_vertex_inside = [&](int f) {
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        if(m_ring[m_mesh.corner_vertex[c]] < 2 * m_ring_stamp)
          return true;
      return false;
    };
    std::vector<int> result;
    for(const int f : patch)
    {
      if(!touches(f, 2 * m_ring_stamp))
        ++m_visits[f];
      if(f == patch.front() || (!m_parameters.requires_interior && has_vertex_inside(f)) ||
         !touches(f, 2 * m_ring_stamp - 1) || m_visits[f] >= 2)
        result.push_back(f);
    }
    return result;
  }

  void clear_visits() { m_visits.assign(m_mesh.number_of_faces(), 0); }

private:
  const Indexed_mesh& m_mesh;
  Selection_parameters m_parameters;
  std::vector<int> m_face_stamp, m_vertex_stamp, m_ring, m_visits;
  int m_stamp = 0, m_ring_stamp = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_PATCH_SELECTION_H
