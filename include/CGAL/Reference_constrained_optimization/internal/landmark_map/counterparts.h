// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_COUNTERPARTS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_COUNTERPARTS_H

#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/maximum_weighted_matching.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// how much the distances of two places from their landmarks differ, over their mean
inline double difference_of_distances(const std::vector<double>& a, const std::vector<double>& b)
{
  double squares = 0, sum = 0;
  for(std::size_t i = 0; i < a.size(); ++i)
  {
    squares += (a[i] - b[i]) * (a[i] - b[i]);
    sum += 0.5 * (a[i] + b[i]);
  }
  return std::sqrt(squares / double(a.size())) / (sum / double(a.size()));
}

// that of the first n vertices with the least difference; no landmark and no vertex of a border
inline int
most_similar_vertex(const Cut_surface& surface, int n, const std::vector<double>& distances)
{
  const std::vector<std::vector<double>>& from_landmarks = surface.landmark_distances();
  double least = std::numeric_limits<double>::infinity();
  int best = -1;
  std::vector<double> here(distances.size());
  for(int v = 0; v < n; ++v)
  {
    const Cut_surface::Vertex vertex{Cut_surface::Mesh::size_type(v)};
    if(surface.is_taken(vertex) || surface.mesh().is_isolated(vertex))
      continue;
    for(std::size_t i = 0; i < here.size(); ++i)
      here[i] = from_landmarks[i][v];
    const double difference = difference_of_distances(distances, here);
    if(difference < least)
    {
      least = difference;
      best = v;
    }
  }
  return best;
}

// Pairs of indices of places on two surfaces, given by their distances from corresponding landmarks, that are
// alike. Of neighbouring fingers each is like several of the other hand: all are paired at once, so that the sum
// of the differences is least.
inline std::vector<std::pair<int, int>> counterparts(const std::vector<std::vector<double>>& a,
                                                     const std::vector<std::vector<double>>& b,
                                                     double largest_difference)
{
  typedef boost::property<boost::edge_weight_t, long> Weight;
  typedef boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property,
                                Weight>
    Graph;
  const double unit = 1e-9; // of weights, which the matching wants to be whole
  Graph graph(a.size() + b.size());
  for(std::size_t i = 0; i < a.size(); ++i)
    for(std::size_t j = 0; j < b.size(); ++j)
    {
      const double gain = largest_difference - difference_of_distances(a[i], b[j]);
      if(gain > 0)
        boost::add_edge(i, a.size() + j, Weight(2 * std::lround(gain / unit)), graph);
    }
  if(boost::num_edges(graph) == 0) // its largest weight would overflow
    return {};
  std::vector<boost::graph_traits<Graph>::vertex_descriptor> mate(a.size() + b.size());
  boost::maximum_weighted_matching(graph, mate.data());
  std::vector<std::pair<int, int>> result;
  for(std::size_t i = 0; i < a.size(); ++i)
    if(mate[i] != boost::graph_traits<Graph>::null_vertex())
      result.emplace_back(int(i), int(mate[i] - a.size()));
  return result;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_COUNTERPARTS_H
