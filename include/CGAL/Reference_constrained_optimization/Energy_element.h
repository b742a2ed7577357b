// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ENERGY_ELEMENT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ENERGY_ELEMENT_H

#include <Eigen/Core>

#include <boost/graph/graph_traits.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is the criterion for the worst elements of an energy.
 */
enum class Element_criterion {
  none, ///< only the sum matters.
  /// the smallest angle of a triangle: flattened patches are small, a last stage raises the smallest angle
  /// of the mesh (`use_finishing_stage`), and, unless the energy has stencils, too, the mean of the faces'
  /// smallest angles does not fall below that of the input.
  smallest_angle
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is one term of an energy: a triangle of three vertices of the mesh and its rest shape.
 *
 * The density is evaluated at the Jacobian of the affine map from the rest triangle to the
 * triangle as it lies on the reference.
 */
struct Energy_element
{
  /// the three vertices, as positions within the face's cyclic list of vertices, oriented with it.
  std::array<int, 3> corners{{0, 1, 2}};
  /// the rest triangle: columns are the edge vectors from its first to its second and third vertex
  /// (2x2, units of length of the mesh); the determinant must be positive.
  Eigen::Matrix2d rest = Eigen::Matrix2d::Identity();
  /// factor of the density; positive.
  double weight = 1;
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * provides an energy with the mesh it is used on. Vertices and faces are named by their positions in
 * `vertices(mesh)` and `faces(mesh)`.
 */
class Energy_context
{
public:
  /// \cond SKIP_IN_MANUAL
  Energy_context(const std::vector<int>& face_begin,
                 const std::vector<int>& corner_vertex,
                 std::size_t number_of_vertices,
                 double mean_edge_length,
                 double mesh_area,
                 double reference_area)
    : m_face_begin(face_begin),
      m_corner_vertex(corner_vertex),
      m_number_of_vertices(number_of_vertices),
      m_mean_edge_length(mean_edge_length),
      m_mesh_area(mesh_area),
      m_reference_area(reference_area)
  {}
  /// \endcond

  /// number of vertices of the mesh.
  std::size_t number_of_vertices() const { return m_number_of_vertices; }
  /// number of faces of the mesh.
  std::size_t number_of_faces() const { return m_face_begin.size() - 1; }
  /// number of vertices of face `f`.
  int degree(std::size_t f) const { return m_face_begin[f + 1] - m_face_begin[f]; }
  /// the `i`-th vertex of face `f`, with `i` in `[0, degree(f))`.
  int vertex(std::size_t f, int i) const { return m_corner_vertex[m_face_begin[f] + i]; }
  /// mean edge length of the input mesh.
  double mean_edge_length() const { return m_mean_edge_length; }
  /// area of the input mesh.
  double mesh_area() const { return m_mesh_area; }
  /// area of the reference.
  double reference_area() const { return m_reference_area; }

private:
  const std::vector<int>& m_face_begin;
  const std::vector<int>& m_corner_vertex;
  std::size_t m_number_of_vertices;
  double m_mean_edge_length;
  double m_mesh_area;
  double m_reference_area;
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is an `Energy_context` that also provides the mesh itself, so that an energy can use property maps.
 *
 * \tparam PolygonMesh the mesh that is optimized
 * \tparam VertexPointMap its point map
 */
template <typename PolygonMesh, typename VertexPointMap>
class Mesh_energy_context : public Energy_context
{
public:
  /// descriptors of the mesh.
  typedef typename boost::graph_traits<PolygonMesh>::face_descriptor face_descriptor;
  /// descriptors of the mesh.
  typedef typename boost::graph_traits<PolygonMesh>::vertex_descriptor vertex_descriptor;

  /// \cond SKIP_IN_MANUAL
  Mesh_energy_context(const PolygonMesh& mesh,
                      const VertexPointMap& point_map,
                      const Energy_context& context)
    : Energy_context(context),
      m_mesh(mesh),
      m_point_map(point_map)
  {
    for(const face_descriptor f : faces(mesh))
      m_faces.push_back(f);
    for(const vertex_descriptor v : vertices(mesh))
      m_vertices.push_back(v);
  }
  /// \endcond

  /// the mesh, as it is on input.
  const PolygonMesh& mesh() const { return m_mesh; }
  /// the map from its vertices to points, as they are on input.
  const VertexPointMap& point_map() const { return m_point_map; }
  /// the face at position `f` in `faces(mesh)`.
  face_descriptor face_descriptor_of(std::size_t f) const { return m_faces[f]; }
  /// the vertex at position `v` in `vertices(mesh)`.
  vertex_descriptor vertex_descriptor_of(std::size_t v) const { return m_vertices[v]; }

private:
  const PolygonMesh& m_mesh;
  VertexPointMap m_point_map;
  std::vector<face_descriptor> m_faces;
  std::vector<vertex_descriptor> m_vertices;
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * returns the rest matrix of an equilateral triangle with the given edge length.
 */
inline Eigen::Matrix2d equilateral_rest_triangle(double edge_length)
{
  Eigen::Matrix2d rest;
  rest << edge_length, 0.5 * edge_length, 0, 0.5 * std::sqrt(3.) * edge_length;
  return rest;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ENERGY_ELEMENT_H
