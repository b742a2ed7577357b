// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_DRIFT_GUARD_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_DRIFT_GUARD_H

#include <CGAL/Reference_constrained_optimization/internal/Patch.h>

#include <cmath>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Which face of the mesh every vertex of R is closest to. Vertices of the mesh on R do not keep its
// faces from cutting R's features off; that is seen from R's side only. A patch takes the guests of
// its faces along, the acceptance test looks after them, and they return with the accepted patch.
class Drift_guard
{
public:
  void initialize(const Optimization_state& state)
  {
    const Indexed_mesh& mesh = state.mesh;
    Mesh_copy copy;
    copy.mesh = mesh;
    for(const Placed_vertex& v : state.vertices)
      copy.points.push_back(v.position);
    const Reference_surface surface(copy);
    const Indexed_mesh& reference = state.reference.mesh();
    m_of_face.assign(mesh.number_of_faces(), {});
    for(int r = 0; r < reference.number_of_vertices(); ++r)
    {
      if(reference.vertex_begin[r] == reference.vertex_begin[r + 1])
        continue;
      const Vector_3& p = state.reference.points()[r];
      const Surface_point foot = surface.closest(p);
      m_of_face[surface.original_face(foot.face)].push_back({r, (foot.position - p).norm()});
    }
  }

  void invite(Patch& patch) const
  {
    if(m_of_face.empty())
      return;
    for(std::size_t f = 0; f < patch.faces.size(); ++f)
      for(const Host& h : m_of_face[patch.faces[f]])
        patch.guests.push_back({h.vertex, int(f), h.distance});
  }

  void take_back(const Patch& patch)
  {
    if(m_of_face.empty())
      return;
    for(const int f : patch.faces)
      m_of_face[f].clear();
    for(const Patch::Guest& g : patch.guests)
      m_of_face[patch.faces[g.polygon]].push_back({g.vertex, g.distance});
  }

private:
  struct Host
  {
    int vertex; // of R
    double distance;
  };
  std::vector<std::vector<Host>> m_of_face;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_DRIFT_GUARD_H
