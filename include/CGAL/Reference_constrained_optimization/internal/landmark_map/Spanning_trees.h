// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_SPANNING_TREES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_SPANNING_TREES_H

#include <CGAL/Random.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

typedef std::vector<std::pair<int, int>> Landmark_pairs;

// Trees that connect landmarks, the most promising first. Which one gives the map of least distortion is
// not known in advance: short trees cut little, stars have short paths. `distance[i][j]` may be perturbed
// by the random generator.
class Spanning_trees
{
public:
  // nodes of a group of `connected` need no connection among one another
  Spanning_trees(std::vector<std::vector<double>> distance,
                 const std::vector<std::vector<int>>& connected,
                 unsigned int seed)
    : m_distance(std::move(distance)),
      m_random(seed)
  {
    const std::size_t n = m_distance.size();
    for(std::size_t i = 0; i < n; ++i)
      m_group.push_back({int(i)});
    for(const std::vector<int>& group : connected)
      for(const int i : group)
        m_group[i] = group;
    double least = std::numeric_limits<double>::infinity();
    for(std::size_t i = 0; i < n; ++i)
    {
      double sum = 0;
      for(std::size_t j = 0; j < n; ++j)
        sum += m_distance[i][j] * m_distance[i][j];
      if(sum < least)
      {
        least = sum;
        m_root = int(i);
      }
    }
    if(!connected.empty())
      m_root = connected.front().front();
  }

  // the k-th tree: the shortest, one halfway to a star around the central landmark, then random ones
  Landmark_pairs tree(int k)
  {
    const double weights[3] = {0, 0.5, 0.2};
    std::vector<std::vector<double>> d = m_distance;
    if(k >= 3)
      for(std::size_t i = 0; i < d.size(); ++i)
        for(std::size_t j = 0; j < i; ++j)
          d[i][j] = d[j][i] = d[i][j] * std::exp(0.5 * (2 * m_random.get_double() - 1));
    return grow(d, k < 3 ? weights[k] : 0.4 * m_random.get_double());
  }

private:
  // Prim's tree for path_weight = 0, Dijkstra's for 1; edges from short to long
  Landmark_pairs grow(const std::vector<std::vector<double>>& d, double path_weight) const
  {
    const std::size_t n = d.size();
    const double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> from_root(n, infinity);
    std::vector<char> is_in(n, 0);
    const auto add = [&](int i, double length) {
      for(const int j : m_group[i])
      {
        is_in[j] = 1;
        from_root[j] = length;
      }
    };
    add(m_root, 0);
    Landmark_pairs tree;
    while(true)
    {
      double least = infinity;
      std::pair<int, int> best(-1, -1);
      for(std::size_t i = 0; i < n; ++i)
        for(std::size_t j = 0; j < n; ++j)
          if(is_in[i] && !is_in[j] && path_weight * from_root[i] + d[i][j] < least)
          {
            least = path_weight * from_root[i] + d[i][j];
            best = {int(i), int(j)};
          }
      if(best.first < 0)
        break;
      add(best.second, from_root[best.first] + d[best.first][best.second]);
      tree.push_back(best);
    }
    std::stable_sort(tree.begin(), tree.end(),
                     [&](const std::pair<int, int>& a, const std::pair<int, int>& b) {
                       return d[a.first][a.second] < d[b.first][b.second];
                     });
    return tree;
  }

  std::vector<std::vector<double>> m_distance;
  std::vector<std::vector<int>> m_group; // per node
  CGAL::Random m_random;
  int m_root = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_SPANNING_TREES_H
