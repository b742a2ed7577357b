// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_CLUSTER_MOVER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_CLUSTER_MOVER_H

#include <CGAL/Reference_constrained_optimization/internal/on_surface/tangent_step.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/Patch_samples.h>
#include <CGAL/Reference_constrained_optimization/internal/state/sliding.h>
#include <CGAL/Reference_constrained_optimization/internal/support/seconds_since.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Vertices that nearly coincide, as marching cubes produce them where a surface passes a corner of the
// grid: connected by edges that are short compared with others at their ends, and far from all other
// vertices.
template <typename PointAccess>
std::vector<std::vector<int>> vertex_clusters(const Indexed_mesh& mesh, const PointAccess& point)
{
  const double short_fraction = 0.01, largest_fraction = 0.1;
  const auto length = [&](int c) { return (point(mesh.target(c)) - point(mesh.source(c))).norm(); };
  std::vector<double> longest(mesh.number_of_vertices(), 0);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    for(const int v : {mesh.source(c), mesh.target(c)})
      longest[v] = (std::max)(longest[v], length(c));
  const auto is_short = [&](int c) {
    return length(c) <
           short_fraction * (std::max)(longest[mesh.source(c)], longest[mesh.target(c)]);
  };
  std::vector<char> is_candidate(mesh.number_of_vertices(), 0);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(is_short(c))
      is_candidate[mesh.source(c)] = is_candidate[mesh.target(c)] = 1;

  const auto for_each_edge = [&](int v, const auto& visit) {
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int c = mesh.vertex_corners[k], before = mesh.previous(c);
      visit(c, mesh.target(c));
      visit(before, mesh.source(before));
    }
  };
  std::vector<std::vector<int>> clusters;
  std::vector<int> origin(mesh.number_of_vertices(),
                          -1); // first vertex of the cluster, for vertices in one
  for(int start = 0; start < mesh.number_of_vertices(); ++start)
  {
    if(!is_candidate[start] || origin[start] >= 0)
      continue;
    std::vector<int> cluster(1, start);
    origin[start] = start;
    for(std::size_t i = 0; i < cluster.size(); ++i)
      for_each_edge(cluster[i], [&](int c, int w) {
        if(origin[w] < 0 && is_short(c))
        {
          origin[w] = start;
          cluster.push_back(w);
        }
      });
    // excludes chains of short edges, as the rim of a fan of needles
    double size = 0, nearest_distance = std::numeric_limits<double>::infinity();
    for(const int v : cluster)
    {
      size = (std::max)(size, (point(v) - point(start)).norm());
      for_each_edge(v, [&](int c, int w) {
        if(origin[w] != start)
          nearest_distance = (std::min)(nearest_distance, length(c));
      });
    }
    if(size < largest_fraction * nearest_distance)
      clusters.push_back(std::move(cluster));
  }
  return clusters;
}

// Separates the vertices of clusters: they move to the barycenters of their neighbours, with those outside
// of the cluster at equal distances. Newton's method is inefficient there: derivatives of elements as small
// as a cluster exceed all others by orders of magnitude, and each step enlarges it by a small factor only.
class Cluster_mover
{
public:
  explicit Cluster_mover(const Reference_surface& reference) : m_reference(reference) {}

  template <typename Density>
  bool propose(const Patch& patch, const Patch_samples&, const Density&)
  {
    const auto start = std::chrono::steady_clock::now();
    m_displacement.assign(patch.vertices.size(), Vector_3::Zero());
    bool moves = false;
    for(const std::vector<int>& cluster : vertex_clusters(
          patch.polygons, [&](int v) -> const Vector_3& { return patch.located[v].position; }))
      moves = separate(patch, cluster) || moves;
    m_optimization_time = seconds_since(start);
    return moves;
  }

  template <typename Density>
  bool propose_again(const Patch&, const Patch_samples&, const std::vector<double>&, const Density&)
  {
    return false;
  }

  bool displaced_vertex(const Patch& patch, int v, double t, Located_vertex& result) const
  {
    if(patch.slides(v))
      return slide(patch, v, t * m_displacement[v].dot(tangent(patch, v)), m_reference, result);
    return step_on_surface(m_reference, patch.located[v], t * m_displacement[v], result);
  }

  double displacement_length(int v) const { return m_displacement[v].norm(); }
  double optimization_time() const { return m_optimization_time; }

private:
  // of the line on which v slides
  static Vector_3 tangent(const Patch& patch, int v)
  {
    return patch.lines->tangent(patch.located[v].on_line);
  }

  bool separate(const Patch& patch, const std::vector<int>& cluster)
  {
    const Indexed_mesh& mesh = patch.polygons;
    const Vector_3& center = patch.located[cluster.front()].position;
    const auto around = [&](int v) { // each neighbour twice, at the border once
      std::vector<int> result;
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
      {
        const int c = mesh.vertex_corners[k];
        result.push_back(mesh.target(c));
        result.push_back(mesh.source(mesh.previous(c)));
      }
      return result;
    };
    const auto is_in = [&](int v) {
      return std::find(cluster.begin(), cluster.end(), v) != cluster.end();
    };
    double radius = std::numeric_limits<double>::infinity();
    Vector_3 normal = Vector_3::Zero();
    const auto vertex = [&](int v) -> const Located_vertex& { return patch.located[v]; };
    for(const int v : cluster)
    {
      for(const int w : around(v))
        if(!is_in(w))
          radius = (std::min)(radius, (patch.located[w].position - center).norm());
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
        normal += face_normal(mesh, vertex, mesh.corner_face[mesh.vertex_corners[k]]);
    }
    if(!(normal.norm() > 0))
      return false;
    normal.normalize();

    bool found = false;
    const int sweeps = 50;
    for(int sweep = 0; sweep < sweeps; ++sweep)
      for(const int v : cluster)
      {
        if(!patch.is_free[v])
          continue;
        found = true;
        const std::vector<int> neighbours = around(v);
        Vector_3 sum = Vector_3::Zero();
        for(const int w : neighbours)
          sum += is_in(w) ? m_displacement[w]
                          : Vector_3(radius * (patch.located[w].position - center).normalized());
        m_displacement[v] = sum / double(neighbours.size());
        if(patch.slides(v))
          m_displacement[v] = m_displacement[v].dot(tangent(patch, v)) * tangent(patch, v);
        else
          m_displacement[v] -= m_displacement[v].dot(normal) * normal;
      }
    return found;
  }

  const Reference_surface& m_reference;
  std::vector<Vector_3> m_displacement; // per vertex
  double m_optimization_time = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_CLUSTER_MOVER_H
