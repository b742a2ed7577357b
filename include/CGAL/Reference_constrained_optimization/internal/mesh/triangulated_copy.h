// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_TRIANGULATED_COPY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_TRIANGULATED_COPY_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

typedef CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>
  Triangulated_copy;

// A mesh as CGAL's functions for triangle meshes want it: quads split by their shorter diagonal,
// without isolated vertices and without triangles that have no area.
inline Triangulated_copy triangulated_copy(const Mesh_copy& copy)
{
  typedef Triangulated_copy::Vertex_index Vertex;
  Triangulated_copy result;
  std::vector<Vertex> vertex(copy.points.size());
  for(int f = 0; f < copy.mesh.number_of_faces(); ++f)
    for(const auto& t : split_face(copy.mesh, copy.points, f))
    {
      Triangulated_copy::Point p[3];
      for(int i = 0; i < 3; ++i)
      {
        const Vector_3& q = copy.points[copy.mesh.corner_vertex[t[i]]];
        p[i] = Triangulated_copy::Point(q.x(), q.y(), q.z());
      }
      if(CGAL::collinear(p[0], p[1], p[2]))
        continue;
      Vertex v[3];
      for(int i = 0; i < 3; ++i)
      {
        Vertex& known = vertex[copy.mesh.corner_vertex[t[i]]];
        if(known == Triangulated_copy::null_vertex())
          known = result.add_vertex(p[i]);
        v[i] = known;
      }
      result.add_face(v[0], v[1], v[2]);
    }
  return result;
}

} // namespace internal

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_TRIANGULATED_COPY_H
