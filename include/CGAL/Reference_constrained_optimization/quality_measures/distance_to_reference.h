// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_DISTANCE_TO_REFERENCE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_DISTANCE_TO_REFERENCE_H

#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

#include <CGAL/number_utils.h>

#include <boost/graph/graph_traits.hpp>
#include <boost/property_map/property_map.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds the distances of vertices from a reference, in units of length of the points.
 */
struct Distance_to_reference
{
  double maximum = 0;                 ///< largest distance of a vertex.
  std::size_t vertex = 0;             ///< position of that vertex in `vertices(mesh)`.
  std::size_t number_of_vertices = 0; ///< vertices measured.
  /// the effect of rounding: \f$ 10^{-12} \f$ of the diagonal of the reference's bounding box plus
  /// four units in the last place of the largest coordinate, in the points' number type.
  double tolerance = 0;

  /// whether all measured vertices are on the reference, up to the tolerance.
  bool is_on_reference() const { return maximum <= tolerance; }
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is the vertex filter that accepts every vertex.
 */
struct Every_vertex
{
  /// returns `true`.
  template <typename Vertex>
  bool operator()(const Vertex&) const
  {
    return true;
  }
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * computes the largest distance of a vertex of a mesh to the reference.
 *
 * Isolated vertices are skipped. The reference must have a face with a positive area.
 *
 * \param mesh the mesh
 * \param reference the reference
 * \param np the parameter `vertex_point_map` of `mesh`
 * \param np_reference the parameter `vertex_point_map` of `reference`
 * \param filter is called with a vertex descriptor of `mesh` and tells whether that vertex is
 *        measured; for example only vertices that were free to move.
 */
template <typename FaceGraph,
          typename ReferenceMesh,
          typename NamedParameters = parameters::Default_named_parameters,
          typename NamedParametersReference = parameters::Default_named_parameters,
          typename VertexFilter = Every_vertex>
Distance_to_reference
distance_to_reference(const FaceGraph& mesh,
                      const ReferenceMesh& reference,
                      const NamedParameters& np = parameters::default_values(),
                      const NamedParametersReference& np_reference = parameters::default_values(),
                      const VertexFilter& filter = VertexFilter())
{
  typedef decltype(internal::measured_vertex_point_map(mesh, np)) Vertex_point_map;
  typedef typename boost::property_traits<Vertex_point_map>::value_type Point;
  typedef typename std::decay<decltype(std::declval<Point>().x())>::type Number;
  const double unit = std::is_floating_point<Number>::value
                        ? double(std::numeric_limits<Number>::epsilon())
                        : std::numeric_limits<double>::epsilon();

  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  const internal::Reference_surface surface(
    internal::read_measured_mesh(reference, np_reference, "reference"));
  Distance_to_reference result;
  const double largest = internal::largest_coordinate(
    copy.mesh, [&](int v) -> const internal::Vector_3& { return copy.points[v]; });
  result.tolerance = 1e-12 * surface.diagonal() + 4 * unit * largest;
  int i = -1;
  for(const auto v : vertices(mesh))
  {
    ++i;
    if(copy.mesh.is_isolated(i) || !filter(v))
      continue;
    ++result.number_of_vertices;
    const internal::Vector_3& p = copy.points[i];
    double distance = (surface.closest_from_vertex(p, i).position - p).norm();
    // closest points in a needle are accurate on its edges only: another face may be closer
    if(distance > result.tolerance && distance < 1e-8 * surface.diagonal())
      for(const internal::Surface_point& s : surface.all_within(p, distance))
        distance = (std::min)(distance, (s.position - p).norm());
    if(distance > result.maximum)
    {
      result.maximum = distance;
      result.vertex = std::size_t(i);
    }
  }
  return result;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_DISTANCE_TO_REFERENCE_H
