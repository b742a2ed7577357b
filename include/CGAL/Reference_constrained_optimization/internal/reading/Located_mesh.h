// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_LOCATED_MESH_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_LOCATED_MESH_H

#include <CGAL/Reference_constrained_optimization/internal/reading/initial_state.h>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A mesh with the point of a reference and the normal there for every vertex: the initial state of an
// optimization without free vertices.
class Located_mesh
{
  // a state has elements, but the measures do not depend on them
  struct One_element_per_face
  {
    void
    append_elements(const Energy_context&, std::size_t, std::vector<Energy_element>& elements) const
    {
      elements.push_back(Energy_element());
    }
  };

public:
  Located_mesh(const Mesh_copy& copy, const Mesh_copy& reference) : Located_mesh(copy, reference, 0)
  {
    m_state.is_free.assign(copy.points.size(), 0); // no vertex is moved
    Result unused;
    locate_on_reference<CGAL::Sequential_tag>(copy.points, m_surface, m_state, unused);
  }

  const Located_vertex& operator()(int v) const { return m_state.vertices[v]; }

  // reversed where it is oriented against the mesh
  const Reference_surface& reference() const { return m_surface; }

private:
  Located_mesh(const Mesh_copy& copy, const Mesh_copy& reference, int)
    : m_surface(reference),
      m_elements(
        One_element_per_face(),
        Energy_context(copy.mesh.face_begin, copy.mesh.corner_vertex, copy.points.size(), 1, 1, 1)),
      m_state{copy.mesh, m_surface, m_elements, {}, {}, {}, {}}
  {}

  Reference_surface m_surface;
  Element_set m_elements;
  Optimization_state m_state;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_LOCATED_MESH_H
