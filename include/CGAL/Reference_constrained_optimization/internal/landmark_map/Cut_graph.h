// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CUT_GRAPH_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CUT_GRAPH_H

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The combinatorics of a graph of paths between landmarks, and of borders, embedded in a surface: arcs, and
// their counterclockwise order around each landmark. Two surfaces that are cut along graphs of the same
// combinatorics to disks have disks whose boundaries run through the same sequence of arcs.
class Cut_graph
{
public:
  struct Arc
  {
    int from, to;
    bool is_border; // such an arc is passed in one direction only, with the hole on its left
  };
  // one piece of the boundary of the cut surface
  struct Side
  {
    int arc;
    bool is_forward;
  };

  explicit Cut_graph(int number_of_landmarks) : m_stubs(number_of_landmarks) {}

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

  // the boundary of the surface when it is cut, as its border half-edges run: the surface on their right
  struct Boundary
  {
    std::vector<std::vector<Side>> cycles;
    std::vector<std::vector<int>> cycle_of_sector; // per landmark and sector
  };
  Boundary boundary() const
  {
    Boundary result;
    for(std::size_t i = 0; i < m_stubs.size(); ++i)
      result.cycle_of_sector.emplace_back(number_of_sectors(int(i)), 0);
    std::vector<char> is_passed[2]; // backward, forward
    for(std::vector<char>& passed : is_passed)
      passed.assign(m_arcs.size(), 0);
    for(int arc = 0; arc < int(m_arcs.size()); ++arc)
      for(const bool is_forward : {true, false})
        if(!is_passed[is_forward][arc] && (is_forward || !m_arcs[arc].is_border))
        {
          std::vector<Side> cycle;
          for(Side side{arc, is_forward}; !is_passed[side.is_forward][side.arc];)
          {
            is_passed[side.is_forward][side.arc] = 1;
            cycle.push_back(side);
            const int landmark = end_of(side), sector = sector_at_end(side);
            result.cycle_of_sector[landmark][sector] = int(result.cycles.size());
            const std::vector<Stub>& around = m_stubs[landmark];
            const Stub& next = around[std::size_t(sector + 1) % around.size()];
            side = {next.arc, next.is_start};
          }
          result.cycles.push_back(std::move(cycle));
        }
    return result;
  }

private:
  int end_of(const Side& side) const
  {
    return side.is_forward ? m_arcs[side.arc].to : m_arcs[side.arc].from;
  }

  // the sector that follows a side of the boundary; a border arc arrives at the hole, from which the next
  // border arc starts
  int sector_at_end(const Side& side) const
  {
    const std::vector<Stub>& around = m_stubs[end_of(side)];
    const auto arrival = std::find_if(around.begin(), around.end(), [&](const Stub& s) {
      return m_arcs[side.arc].is_border ? m_arcs[s.arc].is_border
                                        : s.arc == side.arc && s.is_start != side.is_forward;
    });
    return int(arrival - around.begin());
  }

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

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CUT_GRAPH_H
