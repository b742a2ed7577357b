// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CORRESPONDING_PATHS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CORRESPONDING_PATHS_H

#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_graph.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/closed_curves.h>

#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <set>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A path between two landmarks within a sector of each.
struct Sector_path
{
  double length = std::numeric_limits<double>::infinity();
  std::vector<Cut_surface::Vertex> vertices;
};

typedef std::vector<std::vector<Sector_path>> Sector_paths; // per landmark and sector

// Replaces paths from a sector of a landmark to those of others by shorter ones. With `crossed`, only paths
// that cross the curve an odd number of times are considered: shortest paths in the double cover of the surface.
inline void shorten_paths(const Cut_surface& surface,
                          const Cut_graph& graph,
                          int from,
                          int sector,
                          const std::vector<int>& to,
                          const Crossed_edges* crossed,
                          double limit,
                          Sector_paths& paths)
{
  typedef Cut_surface::Mesh Mesh;
  typedef std::pair<double, std::size_t>
    Reached; // a vertex of the cover: twice the vertex, and its sheet
  const Mesh& mesh = surface.mesh();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto crosses = [&](Mesh::Halfedge_index h) {
    return crossed != nullptr && (*crossed)[mesh.edge(h)] != 0;
  };
  const auto last_state = [&](Mesh::Halfedge_index h) { // of a path that arrives opposite to h
    return 2 * std::size_t(mesh.target(h)) + (crossed != nullptr && !crosses(h) ? 1 : 0);
  };
  std::vector<std::vector<std::vector<Mesh::Halfedge_index>>> arrivals;
  std::vector<char> is_goal(2 * mesh.number_of_vertices(), 0);
  std::size_t missing = 0;
  for(const int landmark : to)
  {
    arrivals.push_back(surface.halfedges_of_sectors(landmark, graph));
    for(const auto& halfedges : arrivals.back())
      for(const Mesh::Halfedge_index h : halfedges)
        if(!surface.is_taken(mesh.target(h)) && is_goal[last_state(h)] == 0)
        {
          is_goal[last_state(h)] = 1;
          ++missing;
        }
  }
  std::vector<double> least(is_goal.size(), infinity);
  std::vector<std::size_t> predecessor(is_goal.size());
  std::priority_queue<Reached, std::vector<Reached>, std::greater<Reached>> queue;
  const auto reach = [&](Mesh::Halfedge_index h, std::size_t before, double sum) {
    const Mesh::Vertex_index w = mesh.target(h);
    if(surface.is_taken(w))
      return;
    const std::size_t after = 2 * std::size_t(w) + ((before % 2 != 0) != crosses(h) ? 1 : 0);
    sum += surface.length(h);
    if(!(sum < least[after]))
      return;
    least[after] = sum;
    predecessor[after] = before;
    queue.push({sum, after});
  };
  const std::size_t start = 2 * std::size_t(surface.landmarks()[from]);
  const auto first = surface.halfedges_of_sectors(from, graph);
  for(const Mesh::Halfedge_index h : first[sector])
    reach(h, start, 0);
  while(!queue.empty() && missing > 0 && queue.top().first < limit)
  {
    const double sum = queue.top().first;
    const std::size_t at = queue.top().second;
    queue.pop();
    if(sum > least[at])
      continue;
    missing -= std::size_t(is_goal[at]);
    is_goal[at] = 0;
    for(const Mesh::Halfedge_index h :
        CGAL::halfedges_around_source(Mesh::Vertex_index(Mesh::size_type(at / 2)), mesh))
      reach(h, at, sum);
  }
  for(std::size_t i = 0; i < to.size(); ++i)
    for(std::size_t t = 0; t < arrivals[i].size(); ++t)
      for(const Mesh::Halfedge_index h : arrivals[i][t])
      {
        Sector_path& shortest = paths[to[i]][t];
        const double sum = least[last_state(h)] + surface.length(h);
        if(!(sum < shortest.length))
          continue;
        Sector_path path{sum, {surface.landmarks()[to[i]]}};
        for(std::size_t at = last_state(h); at != start; at = predecessor[at])
          path.vertices.emplace_back(Mesh::size_type(at / 2));
        path.vertices.push_back(surface.landmarks()[from]);
        std::reverse(path.vertices.begin(), path.vertices.end());
        // a path of the cover may pass a vertex on both sheets
        if(std::set<Mesh::Vertex_index>(path.vertices.begin(), path.vertices.end()).size() ==
           path.vertices.size())
          shortest = std::move(path);
      }
}

// Corresponding paths on two surfaces.
struct Path_pair
{
  int from = -1, from_sector = 0, to = -1, to_sector = 0;
  Sector_path source, reference;
  double length() const { return source.length + reference.length; }
};

// The pair of corresponding paths of least length between some pairs of landmarks; infinite if there is none. If
// there are closed curves, paths cross one of them an odd number of times; `is_allowed` tells whether a path may
// connect two sectors.
template <typename IsAllowed>
Path_pair corresponding_paths(const Cut_surface& source,
                              const Cut_surface& reference,
                              const Cut_graph& graph,
                              const std::vector<std::pair<int, int>>& ends,
                              const std::vector<Crossed_edges> (&curves)[2],
                              const IsAllowed& is_allowed)
{
  Path_pair best;
  const int n = int(source.landmarks().size());
  for(int from = 0; from < n; ++from)
  {
    std::vector<int> to;
    for(const std::pair<int, int>& e : ends)
      if(e.first == from)
        to.push_back(e.second);
    for(int s = 0; s < graph.number_of_sectors(from) && !to.empty(); ++s)
    {
      const auto paths = [&](const Cut_surface& surface, const std::vector<Crossed_edges>& crossed,
                             double limit) {
        Sector_paths result;
        for(int landmark = 0; landmark < n; ++landmark)
          result.emplace_back(graph.number_of_sectors(landmark));
        if(crossed.empty())
          shorten_paths(surface, graph, from, s, to, nullptr, limit, result);
        for(const Crossed_edges& c : crossed)
          shorten_paths(surface, graph, from, s, to, &c, limit, result);
        return result;
      };
      Sector_paths a = paths(source, curves[0], best.length()),
                   b = paths(reference, curves[1], best.length());
      for(const int landmark : to)
        for(int t = 0; t < graph.number_of_sectors(landmark); ++t)
          if(a[landmark][t].length + b[landmark][t].length < best.length() &&
             is_allowed(from, s, landmark, t))
            best = {from, s, landmark, t, std::move(a[landmark][t]), std::move(b[landmark][t])};
    }
  }
  return best;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CORRESPONDING_PATHS_H
