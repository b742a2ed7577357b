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

// A mesh with the point of a reference and the normal there for every vertex: the state in which an
// optimization starts.
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
  // without free vertices
  Located_mesh(const Mesh_copy& copy, const Mesh_copy& reference)
    : Located_mesh(copy, reference, One_element_per_face(), std::vector<char>(copy.points.size()))
  {}

  template <typename Energy>
  Located_mesh(const Mesh_copy& copy,
               const Mesh_copy& reference,
               const Energy& energy,
               const std::vector<char>& is_free)
    : m_surface(reference),
      m_elements(energy,
                 Energy_context(copy.mesh.face_begin,
                                copy.mesh.corner_vertex,
                                copy.points.size(),
                                mean_edge_length(copy.mesh, copy.points),
                                surface_area(copy.mesh, copy.points),
                                m_surface.area())),
      m_state{copy.mesh, m_surface, m_elements, {}, is_free}
  {
    Result unused;
    locate_on_reference<CGAL::Sequential_tag>(copy.points, m_surface, m_state, unused);
  }

  const Located_vertex& operator()(int v) const { return m_state.vertices[v]; }

  // reversed where it is oriented against the mesh
  const Reference_surface& reference() const { return m_surface; }

  Optimization_state& state() { return m_state; }

private:
  Reference_surface m_surface;
  Element_set m_elements;
  Optimization_state m_state;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_LOCATED_MESH_H
