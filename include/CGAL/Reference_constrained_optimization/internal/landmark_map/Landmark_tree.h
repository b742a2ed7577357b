// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_LANDMARK_TREE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_LANDMARK_TREE_H

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The combinatorics of a tree of paths between landmarks (and of the border of a disk), embedded in
// a surface: arcs, and their counterclockwise order around each landmark. Two surfaces that are cut
// along trees of the same combinatorics become disks whose boundaries run through the same sequence
// of arcs.
class Landmark_tree
{
public:
  struct Arc
  {
    int from, to;
    bool is_border; // such an arc is passed in one direction only, with the hole on its left
  };
  // one piece of the disk's boundary
  struct Side
  {
    int arc;
    bool is_forward;
  };

  explicit Landmark_tree(int number_of_landmarks) : m_stubs(number_of_landmarks) {}

  const std::vector<Arc>& arcs() const { return m_arcs; }
  // gaps between the arcs at a landmark, in which a further arc can start
  int number_of_sectors(int landmark) const { return (std::max)(1, int(m_stubs[landmark].size())); }

  // border landmarks in the order in which the border's half-edges pass them
  void add_border(const std::vector<int>& landmarks)
  {
    for(std::size_t i = 0; i < landmarks.size(); ++i)
    {
      m_stubs[landmarks[i]] = {{int(m_arcs.size()), true}};
      m_arcs.push_back({landmarks[i], landmarks[(i + 1) % landmarks.size()], true});
    }
  }

  // an arc that leaves its first landmark within one sector and arrives within another; sector s
  // lies counterclockwise of the s-th stub
  void add_path(int from, int from_sector, int to, int to_sector)
  {
    const int arc = int(m_arcs.size());
    m_arcs.push_back({from, to, false});
    insert(from, from_sector, {arc, true});
    insert(to, to_sector, {arc, false});
  }

  // an arc's end at a landmark; `is_start` is true where the arc starts
  struct Stub
  {
    int arc;
    bool is_start;
  };
  const std::vector<Stub>& stubs(int landmark) const { return m_stubs[landmark]; }

  // the boundary of the disk, as its border half-edges run: the disk on their right
  std::vector<Side> boundary() const
  {
    std::vector<Side> sides;
    Side side{0, true};
    do
    {
      sides.push_back(side);
      const Arc& arc = m_arcs[side.arc];
      const std::vector<Stub>& around = m_stubs[side.is_forward ? arc.to : arc.from];
      // a border arc arrives at the hole, from which the next border arc starts
      const auto arrival = std::find_if(around.begin(), around.end(), [&](const Stub& s) {
        return arc.is_border ? m_arcs[s.arc].is_border
                             : s.arc == side.arc && s.is_start != side.is_forward;
      });
      const auto next = std::next(arrival) == around.end() ? around.begin() : std::next(arrival);
      side = {next->arc, next->is_start};
    } while(side.arc != 0 || !side.is_forward);
    return sides;
  }

private:
  void insert(int landmark, int sector, const Stub& stub)
  {
    std::vector<Stub>& around = m_stubs[landmark];
    around.insert(around.empty() ? around.end() : around.begin() + sector + 1, stub);
  }

  std::vector<Arc> m_arcs;
  std::vector<std::vector<Stub>> m_stubs; // per landmark, counterclockwise
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_LANDMARK_TREE_H
