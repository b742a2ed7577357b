// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_SAVED_STATE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_SAVED_STATE_H

#include <CGAL/Reference_constrained_optimization/internal/shape/drift_guard.h>

#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// What some faces were like before they were worked on, so that one can return to it. Only these are
// kept: a few hundred faces of a large mesh cost no more than that.
class Saved_state
{
public:
  Saved_state(Optimization_state& state, Drift_guard& drift_guard)
    : m_state(state),
      m_drift_guard(drift_guard),
      m_has_vertex(state.vertices.size(), 0),
      m_has_face(state.mesh.number_of_faces(), 0)
  {}

  // before they change; what is saved already stays as it was
  void add(const std::vector<int>& faces)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    for(const int f : faces)
    {
      if(!m_has_face[f])
        m_drift_guard.save(mesh, f, m_snapshot);
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

  void forget()
  {
    for(const std::pair<int, Placed_vertex>& v : m_vertices)
      m_has_vertex[v.first] = 0;
    m_vertices.clear();
    for(const int f : m_snapshot.faces)
      m_has_face[f] = 0;
    m_snapshot = Drift_guard::Snapshot();
  }

  void restore()
  {
    for(const std::pair<int, Placed_vertex>& v : m_vertices)
      m_state.vertices[v.first] = v.second;
    m_drift_guard.restore(m_snapshot);
    forget();
  }

private:
  Optimization_state& m_state;
  Drift_guard& m_drift_guard;
  std::vector<std::pair<int, Placed_vertex>> m_vertices;
  Drift_guard::Snapshot m_snapshot;
  std::vector<char> m_has_vertex, m_has_face;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_SAVED_STATE_H
