// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_LOCAL_BOUNDS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_LOCAL_BOUNDS_H

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

// The largest distance of a mesh from R at each vertex of R: the default bound, but no more than a fraction
// of the local feature size. On mechanical parts, which have small holes among large faces, thin walls and
// narrow gaps, that is the shortest edge and the distance to the opposite surface, and the default bound is
// a fifth of that for scans; on scans, where single short edges are not significant, it is the longest edge
// within two rings. Between vertices bounds grow no faster than a fraction of the distance. The constants
// hold for a default bound of a quarter of the mean edge.
inline std::vector<double> local_bounds(const Reference_surface& reference,
                                        const std::vector<char>& is_mechanical,
                                        double default_bound)
{
  const double scale = default_bound / (0.25 * reference.mean_edge_length());
  const double shortest_fraction = 0.5 * scale, longest_fraction = 0.35 * scale,
               grading = 0.5 * scale;
  const double thickness_fraction = 0.25 * scale;
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
  // per vertex, of the faces around it
  std::vector<double> clearance(is_mechanical.empty() ? 0 : n,
                                std::numeric_limits<double>::infinity());
  for(int f = 0; f < int(is_mechanical.size()); ++f)
    if(is_mechanical[f] && !reference.is_degenerate(f))
    {
      const double distance = reference.clearance(f, mechanical_bound / thickness_fraction);
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        clearance[mesh.corner_vertex[c]] = (std::min)(clearance[mesh.corner_vertex[c]], distance);
    }
  std::vector<double> longest(n, 0);
  for(int v = 0; v < n; ++v)
    for_each_neighbour(v, [&](int, double length) { longest[v] = (std::max)(longest[v], length); });
  // vertices that nearly coincide are no detail
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
    double bound = (std::min)(default_bound, longest_fraction * longest[v]);
    if(!is_mechanical.empty() && is_mechanical[mesh.face_at(v)])
    {
      double shortest = longest[v];
      for_each_neighbour(v, [&](int, double length) {
        shortest = length > 0 ? (std::min)(shortest, length) : shortest;
      });
      bound = (std::min)(
        {mechanical_bound, shortest_fraction * shortest, thickness_fraction * clearance[v]});
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
