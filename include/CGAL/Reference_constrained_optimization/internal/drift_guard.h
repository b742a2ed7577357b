// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_DRIFT_GUARD_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_DRIFT_GUARD_H

#include <CGAL/Reference_constrained_optimization/internal/Patch.h>
#include <CGAL/Reference_constrained_optimization/internal/point_index.h>

#include <cmath>
#include <memory>
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
    const Indexed_mesh& reference = state.reference.mesh();
    m_first.assign(mesh.number_of_faces(), -1);
    m_next.assign(reference.number_of_vertices(), -1);
    m_distance.assign(reference.number_of_vertices(), 0);
    Mesh_copy copy;
    for(const Placed_vertex& v : state.vertices)
      copy.points.push_back(v.position);
    const Point_index index(copy.points,
                            [&](int v) { return mesh.vertex_begin[v] < mesh.vertex_begin[v + 1]; });
    std::unique_ptr<Reference_surface> surface; // of the mesh, where vertices are not enough
    for(int r = 0; r < reference.number_of_vertices(); ++r)
    {
      if(reference.vertex_begin[r] == reference.vertex_begin[r + 1])
        continue;
      const Vector_3& p = state.reference.points()[r];
      const int twin = index.find(p);
      if(twin >= 0)
      {
        settle(r, mesh.corner_face[mesh.vertex_corners[mesh.vertex_begin[twin]]], 0);
        continue;
      }
      if(!surface)
      {
        copy.mesh = mesh;
        surface = std::make_unique<Reference_surface>(copy);
      }
      const Surface_point foot = surface->closest(p);
      settle(r, surface->original_face(foot.face), (foot.position - p).norm());
    }
  }

  void invite(Patch& patch) const
  {
    if(m_first.empty())
      return;
    for(std::size_t f = 0; f < patch.faces.size(); ++f)
      for(int r = m_first[patch.faces[f]]; r >= 0; r = m_next[r])
        patch.guests.push_back({r, int(f), m_distance[r]});
  }

  void take_back(const Patch& patch)
  {
    if(m_first.empty())
      return;
    for(const int f : patch.faces)
      m_first[f] = -1;
    for(const Patch::Guest& g : patch.guests)
      settle(g.vertex, patch.faces[g.polygon], g.distance);
  }

private:
  void settle(int r, int face, double distance)
  {
    m_distance[r] = distance;
    m_next[r] = m_first[face];
    m_first[face] = r;
  }

  // the guests of every face are a list: the first one, and the next one after each vertex of R
  std::vector<int> m_first, m_next;
  std::vector<double> m_distance; // per vertex of R
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_DRIFT_GUARD_H
