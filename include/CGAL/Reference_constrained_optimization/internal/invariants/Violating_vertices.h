// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_VIOLATING_VERTICES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_VIOLATING_VERTICES_H

#include <CGAL/Reference_constrained_optimization/internal/state/Patch.h>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The vertices of a patch whose steps violate an invariant, each once, in the order in which they were
// found.
class Violating_vertices
{
public:
  explicit Violating_vertices(const Patch& patch)
    : m_patch(&patch),
      m_is_in(patch.vertices.size(), 0)
  {}

  const std::vector<int>& list() const { return m_list; }
  bool contains(int v) const { return m_is_in[v]; }

  void add(int v)
  {
    if(!m_is_in[v])
    {
      m_is_in[v] = 1;
      m_list.push_back(v);
    }
  }
  void add_face(int f)
  {
    const Indexed_mesh& mesh = m_patch->polygons;
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      add(mesh.corner_vertex[c]);
  }
  // the faces of the patch at the edge of a corner
  void add_faces_at_edge(int c)
  {
    const Indexed_mesh& mesh = m_patch->polygons;
    add_face(mesh.corner_face[c]);
    if(mesh.opposite[c] >= 0)
      add_face(mesh.corner_face[mesh.opposite[c]]);
  }
  void add_triangle(int t)
  {
    for(int k = 0; k < 3; ++k)
      add(m_patch->triangles().corner_vertex[3 * t + k]);
  }
  void add_element(std::size_t e)
  {
    for(const int v : m_patch->elements[e].vertices)
      add(v);
  }

  void clear()
  {
    for(const int v : m_list)
      m_is_in[v] = 0;
    m_list.clear();
  }

private:
  const Patch* m_patch;
  std::vector<char> m_is_in; // per vertex
  std::vector<int> m_list;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_VIOLATING_VERTICES_H
