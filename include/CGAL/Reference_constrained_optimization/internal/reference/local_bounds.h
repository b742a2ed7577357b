// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_LOCAL_BOUNDS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_LOCAL_BOUNDS_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/connected_region.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Per triangle of R, twice the volume over the area of the connected component that it is part of: for a
// sheet, its thickness. Infinite where a component has a border.
inline std::vector<double> mean_thickness(const Reference_surface& reference)
{
  const Indexed_mesh& mesh = reference.mesh();
  std::vector<double> thickness(mesh.number_of_faces(), std::numeric_limits<double>::infinity());
  std::vector<char> is_left(mesh.number_of_faces(), 1);
  for(int f = 0; f < mesh.number_of_faces(); ++f)
  {
    if(!is_left[f])
      continue;
    const std::vector<int> component = take_connected_region(mesh, f, is_left);
    const Vector_3 origin = reference.corner_point(f, 0);
    double area = 0, volume = 0;
    bool is_closed = true;
    for(const int g : component)
    {
      const Vector_3 normal = reference.face_normal(g);
      area += 0.5 * normal.norm();
      volume += normal.dot(reference.corner_point(g, 0) - origin) / 6;
      for(int c = mesh.face_begin[g]; c < mesh.face_begin[g + 1]; ++c)
        is_closed = is_closed && mesh.opposite[c] >= 0;
    }
    if(is_closed && area > 0)
      for(const int g : component)
        thickness[g] = 2 * std::abs(volume) / area;
  }
  return thickness;
}

// How far a mesh may be from R at each vertex of R: the default bound, but no more than a part of the size
// of what is there. On mechanical parts, where small holes lie among large faces and sheets are thin, that
// is the shortest edge and the thickness, and the default is a fifth of that for scans; on scans, where
// single short edges mean nothing, the longest edge within two rings. Between vertices bounds grow no faster than a part of the distance.
// Lengths are meant for a default bound of a quarter of the mean edge.
inline std::vector<double> local_bounds(const Reference_surface& reference,
                                        const std::vector<char>& is_mechanical,
                                        double default_bound)
{
  const double scale = default_bound / (0.25 * reference.mean_edge_length());
  const double shortest_part = 0.5 * scale, longest_part = 0.35 * scale, grading = 0.5 * scale;
  const double thin_part = 0.1 * scale;
  const double mechanical_bound = 0.2 * default_bound;
  const double least = (is_mechanical.empty() ? 0.02 : 0.002) * default_bound;
  const Indexed_mesh& mesh = reference.mesh();
  const std::vector<Vector_3>& points = reference.points();
  const int n = mesh.number_of_vertices();
  std::vector<double> bounds(n, default_bound);
  typedef std::pair<double, int> Entry;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  const auto for_each_neighbour = [&](int v, const auto& visit) {
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int c = mesh.vertex_corners[k];
      for(const int w : {mesh.target(c), mesh.source(mesh.previous(c))})
        visit(w, (points[w] - points[v]).norm());
    }
  };
  const std::vector<double> thickness =
    is_mechanical.empty() ? std::vector<double>() : mean_thickness(reference);
  std::vector<double> longest(n, 0);
  for(int v = 0; v < n; ++v)
    for_each_neighbour(v, [&](int, double length) { longest[v] = (std::max)(longest[v], length); });
  // vertices that all but coincide are no detail
  for(int ring = 0; ring < 2; ++ring)
  {
    const std::vector<double> before = longest;
    for(int v = 0; v < n; ++v)
      for_each_neighbour(v, [&](int w, double) { longest[v] = (std::max)(longest[v], before[w]); });
  }
  for(int v = 0; v < n; ++v)
  {
    if(mesh.is_isolated(v))
      continue;
    double bound = (std::min)(default_bound, longest_part * longest[v]);
    if(!is_mechanical.empty() && is_mechanical[mesh.face_at(v)])
    {
      double shortest = longest[v];
      for_each_neighbour(v, [&](int, double length) {
        shortest = length > 0 ? (std::min)(shortest, length) : shortest;
      });
      bound = (std::min)(
        {mechanical_bound, shortest_part * shortest, thin_part * thickness[mesh.face_at(v)]});
    }
    bounds[v] = (std::max)(least, bound);
    if(bounds[v] < default_bound)
      queue.push(Entry(bounds[v], v));
  }
  while(!queue.empty())
  {
    const Entry e = queue.top();
    queue.pop();
    if(e.first > bounds[e.second])
      continue;
    for_each_neighbour(e.second, [&](int w, double length) {
      const double bound = e.first + grading * length;
      if(bound < bounds[w])
      {
        bounds[w] = bound;
        queue.push(Entry(bound, w));
      }
    });
  }
  return bounds;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_LOCAL_BOUNDS_H
