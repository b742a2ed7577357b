// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_SPLIT_EDGE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_SPLIT_EDGE_H

#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/iterator.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The border's half-edge that begins at a vertex of a Surface_mesh; null if there is none.
template <typename Mesh>
typename Mesh::Halfedge_index border_halfedge_from(const Mesh& mesh, typename Mesh::Vertex_index v)
{
  for(const typename Mesh::Halfedge_index h : CGAL::halfedges_around_source(v, mesh))
    if(mesh.is_border(h))
      return h;
  return Mesh::null_halfedge();
}

// Splits an edge of a triangulated Surface_mesh at the fraction t of its length, and the faces at it;
// returns the new vertex.
template <typename Mesh>
typename Mesh::Vertex_index
split_edge_and_faces(Mesh& mesh, typename Mesh::Halfedge_index h, double t)
{
  const auto p = mesh.point(mesh.source(h)), q = mesh.point(mesh.target(h));
  const auto n = CGAL::Euler::split_edge(h, mesh); // from the source to the new vertex
  const auto v = mesh.target(n);
  mesh.point(v) = p + t * (q - p);
  const auto o = mesh.opposite(mesh.next(n)); // the incoming one on the other side
  for(const auto incoming : {n, o})
    if(!mesh.is_border(incoming))
      CGAL::Euler::split_face(incoming, mesh.next(mesh.next(incoming)), mesh);
  return v;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_SPLIT_EDGE_H
