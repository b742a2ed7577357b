// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_PATCH_ROUNDS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_PATCH_ROUNDS_H

#include <CGAL/Reference_constrained_optimization/internal/selection/patch_selection.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Rounds of face-disjoint patches. No patch of a round starts within four rings of another one, as it
// would remain small.
class Patch_rounds
{
public:
  explicit Patch_rounds(const Indexed_mesh& mesh) : m_mesh(mesh) {}

  // grows face-disjoint patches from untouched seeds until the mesh is full; drops the seeds that
  // are touched
  std::vector<std::vector<int>> select(std::vector<int>& seeds,
                                       std::vector<char>& is_untouched,
                                       Patch_selection& selection,
                                       const Face_geometry& geometry,
                                       Interruption* interruption = nullptr)
  {
    std::vector<std::vector<int>> patches;
    m_is_taken.assign(m_mesh.number_of_faces(), 0);
    m_is_near.assign(m_mesh.number_of_vertices(), 0);
    std::size_t kept = 0;
    for(const int seed : seeds)
    {
      if(!is_untouched[seed])
        continue;
      const auto is_near = [&]() {
        for(int c = m_mesh.face_begin[seed]; c < m_mesh.face_begin[seed + 1]; ++c)
          if(m_is_near[m_mesh.corner_vertex[c]])
            return true;
        return false;
      };
      if(m_is_taken[seed] || is_near())
      {
        seeds[kept++] = seed;
        continue;
      }
      check(interruption);
      std::vector<int> patch =
        selection.grow(seed, geometry, [&](int f) { return m_is_taken[f] != 0; });
      for(const int f : selection.touched(patch))
        is_untouched[f] = 0;
      for(const int f : patch)
        m_is_taken[f] = 1;
      mark_near(patch);
      patches.push_back(std::move(patch));
    }
    seeds.resize(kept);
    return patches;
  }

private:
  // the faces of the patch are taken already
  void mark_near(const std::vector<int>& patch)
  {
    std::vector<int> front;
    const auto mark = [&](int v, std::vector<int>& list) {
      if(!m_is_near[v])
      {
        m_is_near[v] = 1;
        list.push_back(v);
      }
    };
    // the rings start from the boundary
    for(const int f : patch)
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        if(m_mesh.opposite[c] >= 0 && !m_is_taken[m_mesh.corner_face[m_mesh.opposite[c]]])
        {
          mark(m_mesh.source(c), front);
          mark(m_mesh.target(c), front);
        }
    for(const int f : patch)
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        m_is_near[m_mesh.corner_vertex[c]] = 1;
    for(int ring = 0; ring < 4 && !front.empty(); ++ring)
    {
      std::vector<int> next;
      for(const int v : front)
        for(int k = m_mesh.vertex_begin[v]; k < m_mesh.vertex_begin[v + 1]; ++k)
        {
          const int c = m_mesh.vertex_corners[k];
          mark(m_mesh.target(c), next);
          mark(m_mesh.source(m_mesh.previous(c)), next);
        }
      front.swap(next);
    }
  }

  const Indexed_mesh& m_mesh;
  std::vector<char> m_is_taken, m_is_near;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_PATCH_ROUNDS_H
