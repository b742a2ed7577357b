// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LOCAL_BOUNDS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LOCAL_BOUNDS_H

#include <CGAL/Reference_constrained_optimization/internal/Reference_surface.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

inline double knob(const char* name, double value)
{
  const char* text = std::getenv(name);
  return text ? std::atof(text) : value;
}

// How far a mesh may be from R at each vertex of it: the default bound, but no more than a part of what is
// there. On mechanical parts, where small holes lie among large faces, that is the shortest edge, on
// scans, where single short edges mean nothing, the mean of the edges. Between vertices bounds grow no
// faster than the distance times a grading.
inline std::vector<double> local_bounds(const Reference_surface& reference,
                                        const std::vector<char>& is_mechanical,
                                        double default_bound)
{
  const double scale = default_bound / (0.25 * reference.mean_edge_length());
  const double mechanical_bound = knob("RCO_MB", 0.2) * default_bound, shortest_part = scale * knob("RCO_MS", 0.5), mean_part = scale * knob("RCO_LB", 0.5);
  const double grading = knob("RCO_GR", 0.5);
  const double floor = knob("RCO_FL", 0.02) * default_bound;
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
  for(int v = 0; v < n; ++v)
  {
    if(mesh.is_isolated(v))
      continue;
    double shortest = std::numeric_limits<double>::infinity(), sum = 0;
    int count = 0;
    for_each_neighbour(v, [&](int, double length) {
      shortest = length > 0 ? (std::min)(shortest, length) : shortest;
      sum += length;
      ++count;
    });
    const double bound = !is_mechanical.empty() && is_mechanical[mesh.face_at(v)]
                           ? (std::min)(mechanical_bound, shortest_part * shortest)
                           : (std::min)(default_bound, mean_part * sum / count);
    bounds[v] = (std::max)(floor, bound);
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

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LOCAL_BOUNDS_H
