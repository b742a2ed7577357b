// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_BUILD_INDEXED_MESH_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_BUILD_INDEXED_MESH_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>
#include <CGAL/number_utils.h>
#include <CGAL/property_map.h>

#include <boost/graph/graph_traits.hpp>

#include <string>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A validated copy of a face graph: connectivity and points, in the order of the graph's ranges.
struct Mesh_copy
{
  Indexed_mesh mesh;
  std::vector<Vector_3> points;
};

// Reads a face graph. Throws Invalid_input, naming the element, for: no face, a coordinate that is
// not finite, a face of more than four (or, if so wanted, three) vertices, an edge or a vertex that
// is not manifold. `name` is what the message calls the mesh.
template <typename ConcurrencyTag = CGAL::Sequential_tag,
          typename FaceGraph,
          typename VertexPointMap>
Mesh_copy read_face_graph(const FaceGraph& g, const VertexPointMap& vpm, const std::string& name)
{
  typedef typename boost::graph_traits<FaceGraph>::vertex_descriptor vertex_descriptor;
  typedef typename boost::graph_traits<FaceGraph>::face_descriptor face_descriptor;

  Mesh_copy copy;
  auto index = get(CGAL::dynamic_vertex_property_t<int>(), g);
  int n = 0;
  for(const vertex_descriptor v : vertices(g))
  {
    const auto& p = get(vpm, v);
    const Vector_3 q(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
    if(!q.allFinite())
      throw Invalid_input(name + ": vertex " + std::to_string(n) +
                          " has a coordinate that is not finite");
    copy.points.push_back(q);
    put(index, v, n++);
  }

  std::vector<int> begins(1, 0), corners;
  for(const face_descriptor f : faces(g))
  {
    for(const vertex_descriptor v : CGAL::vertices_around_face(halfedge(f, g), g))
      corners.push_back(get(index, v));
    const int degree = int(corners.size()) - begins.back();
    if(degree < 3 || degree > 4)
      throw Invalid_input(name + ": face " + std::to_string(begins.size() - 1) + " has " +
                          std::to_string(degree) +
                          " vertices, but only triangles and quads are supported");
    begins.push_back(int(corners.size()));
  }
  if(begins.size() == 1)
    throw Invalid_input(name + ": the mesh has no face");
  try
  {
    copy.mesh = Indexed_mesh(std::move(begins), std::move(corners), n, ConcurrencyTag());
  }
  catch(const Invalid_input& e)
  {
    throw Invalid_input(name + ": " + e.what());
  }
  const int v = copy.mesh.find_nonmanifold_vertex<ConcurrencyTag>();
  if(v >= 0)
    throw Invalid_input(name + ": vertex " + std::to_string(v) + " is not manifold");
  return copy;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_BUILD_INDEXED_MESH_H
