// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_SAVED_STATE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_SAVED_STATE_H

#include <CGAL/Reference_constrained_optimization/internal/shape/Shape_bound.h>

#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The state of some faces before they change, to be restored. Only these are stored, so that the cost does
// not depend on the size of the mesh.
class Saved_state
{
public:
  Saved_state(Optimization_state& state, Shape_bound& shape_bound)
    : m_state(state),
      m_shape_bound(shape_bound),
      m_has_vertex(state.vertices.size(), 0),
      m_has_face(state.mesh.number_of_faces(), 0)
  {}

  // called before they change; faces that are saved already are skipped
  void add(const std::vector<int>& faces)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    if(m_vertices.empty())
      m_counts = m_state.counts;
    for(const int f : faces)
    {
      if(!m_has_face[f])
      {
        m_shape_bound.save(mesh, f, m_snapshot);
        m_faces.push_back(f);
      }
      m_has_face[f] = 1;
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      {
        const int v = mesh.corner_vertex[c];
        if(!m_has_vertex[v])
          m_vertices.emplace_back(v, m_state.vertices[v]);
        m_has_vertex[v] = 1;
      }
    }
  }

  void clear()
  {
    for(const std::pair<int, Located_vertex>& v : m_vertices)
      m_has_vertex[v.first] = 0;
    m_vertices.clear();
    for(const int f : m_faces)
      m_has_face[f] = 0;
    m_faces.clear();
    m_snapshot = Shape_bound::Snapshot();
  }

  void restore()
  {
    if(!m_vertices.empty())
      m_state.counts = m_counts;
    for(const std::pair<int, Located_vertex>& v : m_vertices)
      m_state.vertices[v.first] = v.second;
    m_state.update_near_sheets(m_faces);
    m_shape_bound.restore(m_snapshot);
    clear();
  }

private:
  Optimization_state& m_state;
  Shape_bound& m_shape_bound;
  Optimization_state::Counts m_counts;
  std::vector<std::pair<int, Located_vertex>> m_vertices;
  std::vector<int> m_faces;
  Shape_bound::Snapshot m_snapshot;
  std::vector<char> m_has_vertex, m_has_face;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_SAVED_STATE_H
