// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_PATCH_PARTITION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_PATCH_PARTITION_H

#include <CGAL/Reference_constrained_optimization/internal/Indexed_mesh.h>

#include <CGAL/Random.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Divides faces among patches for steps on the surface, which need neither disks nor cones: every
// face goes to the seed that is the fewest faces away. A face is in one patch only, so that all
// patches are one round; the vertices between two of them rest, and are inside of another patch
// after the next draw of seeds.
class Patch_partition
{
public:
  Patch_partition(const Indexed_mesh& mesh, int size) : m_mesh(mesh), m_size(size) {}

  // patches of about the given number of faces, the largest first
  std::vector<std::vector<int>> divide(const std::vector<char>& is_wanted, CGAL::Random& random)
  {
    std::vector<int> wanted;
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
      if(is_wanted[f])
        wanted.push_back(f);
    const std::size_t number = (wanted.size() + m_size - 1) / m_size;
    m_cell.assign(m_mesh.number_of_faces(), -1);
    m_queue.clear();
    const auto take = [&](int f, int cell) {
      m_cell[f] = cell;
      m_queue.push_back(f);
    };
    std::vector<int> draw = wanted;
    for(std::size_t i = 0; i < number; ++i)
    {
      std::swap(draw[i], draw[std::size_t(random.get_int(int(i), int(draw.size())))]);
      take(draw[i], int(i));
    }

    int cells = int(number);
    std::size_t next = 0;
    for(std::size_t i = 0; i < wanted.size(); ++i)
    {
      for(; next < m_queue.size(); ++next)
      {
        const int f = m_queue[next];
        for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        {
          const int o = m_mesh.opposite[c];
          if(o >= 0 && is_wanted[m_mesh.corner_face[o]] && m_cell[m_mesh.corner_face[o]] < 0)
            take(m_mesh.corner_face[o], m_cell[f]);
        }
      }
      if(m_cell[wanted[i]] < 0) // no way leads from a seed to here
        take(wanted[i], cells++);
    }

    std::vector<std::vector<int>> patches(cells);
    for(const int f : m_queue)
      patches[m_cell[f]].push_back(f);
    std::stable_sort(
      patches.begin(), patches.end(),
      [](const std::vector<int>& a, const std::vector<int>& b) { return a.size() > b.size(); });
    return patches;
  }

private:
  const Indexed_mesh& m_mesh;
  int m_size;
  std::vector<int> m_cell, m_queue;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_PATCH_PARTITION_H
