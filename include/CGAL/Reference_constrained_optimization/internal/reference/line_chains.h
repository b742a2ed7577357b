// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_LINE_CHAINS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_LINE_CHAINS_H

#include <CGAL/Reference_constrained_optimization/internal/reference/Slide_lines.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Edges of a mesh, each given by its two vertices, as lines.
typedef std::vector<std::array<int, 2>> Line_edges;

// The two neighbours of every vertex where a line goes on; {-1, -1} at ends, junctions, sharp turns,
// and where `stays(v)`.
template <typename PointAccess, typename Stays>
std::vector<std::array<int, 2>> line_neighbours(const Line_edges& edges,
                                                int number_of_vertices,
                                                const PointAccess& position,
                                                const Stays& stays,
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
    const bool goes_on =
      count[v] == 2 && !stays(v) &&
      (position(v) - position(next_to[0]))
          .normalized()
          .dot((position(next_to[1]) - position(v)).normalized()) > cosine_of_sharp_turn;
    if(!goes_on)
      next_to = {{-1, -1}};
  }
  return neighbours;
}

// Adds a segment for each edge, connected where the lines go on. `face(v, w)` is a face of R at the
// edge, -1 if it is not known. Returns for every vertex of the edges a point of a line.
template <typename PointAccess, typename FaceAccess>
std::vector<Line_point> add_lines(const Line_edges& edges,
                                  const std::vector<std::array<int, 2>>& neighbours,
                                  const PointAccess& position,
                                  const FaceAccess& face,
                                  Slide_lines& lines)
{
  std::vector<Line_point> points(neighbours.size());
  std::set<std::array<int, 2>> left;
  const auto sorted = [](int v, int w) {
    return std::array<int, 2>{{(std::min)(v, w), (std::max)(v, w)}};
  };
  for(const std::array<int, 2>& e : edges)
    left.insert(sorted(e[0], e[1]));
  const auto goes_on = [&](int v) { return neighbours[v][0] >= 0; };
  const auto after = [&](int v, int w) { return neighbours[w][neighbours[w][0] == v]; };
  const auto add = [&](int v, int w) {
    left.erase(sorted(v, w));
    const int segment = lines.add(position(v), position(w), face(v, w));
    points[w] = {segment, 1};
    if(points[v].segment < 0)
      points[v] = {segment, 0};
    return segment;
  };
  for(const std::array<int, 2>& e : edges)
  {
    if(!left.count(sorted(e[0], e[1])))
      continue;
    // back to where the line starts, or once round
    int v = e[0], w = e[1];
    while(goes_on(v))
    {
      const int before = after(w, v);
      if(before == e[0] && v == e[1])
        break;
      w = v;
      v = before;
    }
    const int first = add(v, w);
    int last = first;
    while(goes_on(w))
    {
      const int next = after(v, w);
      if(!left.count(sorted(w, next)))
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

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_LINE_CHAINS_H
