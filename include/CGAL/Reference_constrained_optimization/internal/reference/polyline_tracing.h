// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_POLYLINE_TRACING_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_POLYLINE_TRACING_H

#include <CGAL/Reference_constrained_optimization/internal/reference/Polyline_set.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Edges of a mesh, each given by its two vertices.
typedef std::vector<std::array<int, 2>> Line_edges;

// The two neighbours of every vertex in the interior of a line; {-1, -1} at ends, junctions, sharp turns,
// and where `is_fixed(v)`.
template <typename PointAccess, typename IsFixed>
std::vector<std::array<int, 2>> line_neighbours(const Line_edges& edges,
                                                int number_of_vertices,
                                                const PointAccess& position,
                                                const IsFixed& is_fixed,
                                                double cosine_of_sharp_turn)
{
  std::vector<std::array<int, 2>> neighbours(number_of_vertices, {{-1, -1}});
  std::vector<int> count(number_of_vertices, 0);
  for(const std::array<int, 2>& e : edges)
    for(int i = 0; i < 2; ++i)
      if(count[e[i]]++ < 2)
        neighbours[e[i]][count[e[i]] - 1] = e[1 - i];
  for(int v = 0; v < number_of_vertices; ++v)
  {
    std::array<int, 2>& next_to = neighbours[v];
    const bool continues =
      count[v] == 2 && !is_fixed(v) &&
      (position(v) - position(next_to[0]))
          .normalized()
          .dot((position(next_to[1]) - position(v)).normalized()) > cosine_of_sharp_turn;
    if(!continues)
      next_to = {{-1, -1}};
  }
  return neighbours;
}

// Adds a segment for each edge, connected where the lines continue. `face(v, w)` is a face of R at the
// edge, -1 if it is not known. Returns for every vertex of the edges a point of a line.
template <typename PointAccess, typename FaceAccess>
std::vector<Polyline_point> trace_polylines(const Line_edges& edges,
                                            const std::vector<std::array<int, 2>>& neighbours,
                                            const PointAccess& position,
                                            const FaceAccess& face,
                                            Polyline_set& lines)
{
  std::vector<Polyline_point> points(neighbours.size());
  std::set<std::array<int, 2>> untraced;
  const auto sorted = [](int v, int w) {
    return std::array<int, 2>{{(std::min)(v, w), (std::max)(v, w)}};
  };
  for(const std::array<int, 2>& e : edges)
    untraced.insert(sorted(e[0], e[1]));
  const auto continues = [&](int v) { return neighbours[v][0] >= 0; };
  const auto after = [&](int v, int w) { return neighbours[w][neighbours[w][0] == v]; };
  const auto add = [&](int v, int w) {
    untraced.erase(sorted(v, w));
    const int segment = lines.add(position(v), position(w), face(v, w));
    points[w] = {segment, 1};
    if(points[v].segment < 0)
      points[v] = {segment, 0};
    return segment;
  };
  for(const std::array<int, 2>& e : edges)
  {
    if(!untraced.count(sorted(e[0], e[1])))
      continue;
    // back to the start of the line, or once around a closed one
    int v = e[0], w = e[1];
    while(continues(v))
    {
      const int before = after(w, v);
      if(before == e[0] && v == e[1])
        break;
      w = v;
      v = before;
    }
    const int first = add(v, w);
    int last = first;
    while(continues(w))
    {
      const int next = after(v, w);
      if(!untraced.count(sorted(w, next)))
      {
        lines.connect(last, first);
        break;
      }
      const int segment = add(w, next);
      lines.connect(last, segment);
      last = segment;
      v = w;
      w = next;
    }
  }
  return points;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_POLYLINE_TRACING_H
