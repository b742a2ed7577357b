// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_PATCH_PARTITION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_PATCH_PARTITION_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/connected_region.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <CGAL/Random.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Partitions faces into patches for steps on the surface, which need neither disks nor cones: every face is
// assigned to the seed that is the fewest faces away. A face is in one patch only, so that all patches form
// one round; the vertices between two of them are fixed, and are inside another patch with the next random
// seeds.
class Patch_partition
{
public:
  // patches of about `size` faces, and none of more than `largest`
  Patch_partition(const Indexed_mesh& mesh,
                  int size,
                  int largest = (std::numeric_limits<int>::max)())
    : m_mesh(mesh),
      m_size(size),
      m_largest(largest)
  {}

  int patch_size() const { return m_size; }
  void set_patch_size(int size) { m_size = size; }

  // the connected regions of the selected faces are patches; those that are much too large are divided. The
  // largest first.
  std::vector<std::vector<int>> divide_regions(const std::vector<char>& is_selected,
                                               CGAL::Random& random)
  {
    std::vector<std::vector<int>> patches;
    std::vector<char> is_unvisited = is_selected, is_large;
    for(int start = 0; start < m_mesh.number_of_faces(); ++start)
    {
      if(!is_unvisited[start])
        continue;
      std::vector<int> region = extract_connected_region(m_mesh, start, is_unvisited);
      if(region.size() <= std::size_t((std::min)(3 * m_size, m_largest)))
      {
        patches.push_back(std::move(region));
        continue;
      }
      is_large.resize(is_selected.size(), 0);
      for(const int f : region)
        is_large[f] = 1;
    }
    if(!is_large.empty())
      for(std::vector<int>& patch : divide(is_large, random))
        patches.push_back(std::move(patch));
    sort(patches);
    return patches;
  }

  // patches of about the given number of faces, the largest first
  std::vector<std::vector<int>> divide(const std::vector<char>& is_selected,
                                       CGAL::Random& random,
                                       Interruption* interruption = nullptr)
  {
    std::vector<int> selected;
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
      if(is_selected[f])
        selected.push_back(f);
    const std::size_t number = (selected.size() + m_size - 1) / m_size;
    std::vector<int> seeds = selected;
    for(std::size_t i = 0; i < number; ++i)
      std::swap(seeds[i], seeds[std::size_t(random.get_int(int(i), int(seeds.size())))]);
    seeds.resize(number);
    check(interruption);
    int cells = grow(selected, is_selected, seeds);
    check(interruption);
    if(number > 1) // a second pass from the centers makes sizes more even
      cells = grow(selected, is_selected, centers(selected, cells));
    check(interruption);

    std::vector<std::vector<int>> patches(cells);
    for(const int f : m_queue)
      patches[m_cell[f]].push_back(f);
    sort(patches);
    return patches;
  }

private:
  static void sort(std::vector<std::vector<int>>& patches)
  {
    std::stable_sort(
      patches.begin(), patches.end(),
      [](const std::vector<int>& a, const std::vector<int>& b) { return a.size() > b.size(); });
  }

  // assigns all selected faces to cells that grow from the seeds, and from further ones where faces are not
  // reached from these; m_queue holds them in the order in which they were reached. Returns the number of
  // cells.
  int grow(const std::vector<int>& selected,
           const std::vector<char>& is_selected,
           const std::vector<int>& seeds)
  {
    m_cell.assign(m_mesh.number_of_faces(), -1);
    m_queue.clear();
    int cells = 0;
    m_count.assign(seeds.size(), 0);
    const auto assign = [&](int f, int cell) {
      m_cell[f] = cell;
      ++m_count[cell];
      m_queue.push_back(f);
    };
    for(const int f : seeds)
      assign(f, cells++);
    std::size_t next = 0;
    for(const int start : selected)
    {
      for(; next < m_queue.size(); ++next)
      {
        const int f = m_queue[next];
        for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        {
          const int o = m_mesh.opposite[c];
          if(o >= 0 && is_selected[m_mesh.corner_face[o]] && m_cell[m_mesh.corner_face[o]] < 0 &&
             m_count[m_cell[f]] < m_largest)
            assign(m_mesh.corner_face[o], m_cell[f]);
        }
      }
      if(m_cell[start] < 0)
      {
        m_count.push_back(0);
        assign(start, cells++);
      }
    }
    return cells;
  }

  // of each cell a face that is furthest from its boundary
  std::vector<int> centers(const std::vector<int>& selected, int cells)
  {
    std::vector<char> is_reached(m_mesh.number_of_faces(), 0);
    m_queue.clear();
    const auto is_boundary_face = [&](int f) {
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        if(m_mesh.opposite[c] < 0 || m_cell[m_mesh.corner_face[m_mesh.opposite[c]]] != m_cell[f])
          return true;
      return false;
    };
    for(const int f : selected)
      if(is_boundary_face(f))
      {
        is_reached[f] = 1;
        m_queue.push_back(f);
      }
    std::vector<int> centers(cells, -1);
    for(std::size_t next = 0; next < m_queue.size(); ++next)
    {
      const int f = m_queue[next];
      centers[m_cell[f]] = f;
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
      {
        const int o = m_mesh.opposite[c], g = o < 0 ? -1 : m_mesh.corner_face[o];
        if(g >= 0 && m_cell[g] == m_cell[f] && !is_reached[g])
        {
          is_reached[g] = 1;
          m_queue.push_back(g);
        }
      }
    }
    // a closed component that is one cell has no boundary
    for(const int f : selected)
      if(centers[m_cell[f]] < 0)
        centers[m_cell[f]] = f;
    return centers;
  }

  const Indexed_mesh& m_mesh;
  int m_size, m_largest;
  std::vector<int> m_cell, m_queue;
  std::vector<int> m_count; // per cell: its faces
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_PATCH_PARTITION_H
