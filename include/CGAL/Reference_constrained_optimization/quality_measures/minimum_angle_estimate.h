// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_MINIMUM_ANGLE_ESTIMATE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_MINIMUM_ANGLE_ESTIMATE_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/initial_state.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>

#include <algorithm>
#include <string>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * estimates the largest minimum angle that the connectivity of a mesh allows, in degrees.
 */
struct Minimum_angle_estimate
{
  /// smallest \f$ \min(S/d, 90^\circ - S/(2d)) \f$ over the vertices that may move, `S` being the
  /// sum of the angles at the vertex and `d` its number of faces; 180 if there is none.
  double at_free_vertices = 180;
  /// smallest angle of the faces whose vertices are all fixed, a strict bound; 180 if there is
  /// none.
  double of_fixed_faces = 180;

  /// the smaller of the two.
  double minimum() const { return (std::min)(at_free_vertices, of_fixed_faces); }
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * estimates which minimum angle can be reached by moving vertices, from the valences and angle sums
 * of the mesh as it is.
 *
 * If `d` triangles share an angle sum `S` evenly at a vertex, each has `S/d` there and at most half
 * of what is left to 180 degrees at its smaller other corner. On a curved surface the angle sum changes as
 * the vertex moves, so that the estimate can be exceeded. Vertices at the border are fixed.
 *
 * \param mesh a triangle mesh
 * \param np the parameter `vertex_point_map` of `mesh`, and `vertex_is_constrained_map` and
 *        `edge_is_constrained_map` as in `CGAL::reference_constrained_optimize()`
 *
 * \throws Invalid_input if a face is not a triangle.
 */
template <typename FaceGraph, typename NamedParameters = parameters::Default_named_parameters>
Minimum_angle_estimate
minimum_angle_estimate(const FaceGraph& mesh,
                       const NamedParameters& np = parameters::default_values())
{
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  const internal::Indexed_mesh& m = copy.mesh;
  const auto point = [&](int v) -> const internal::Vector_3& { return copy.points[v]; };
  const std::vector<char> is_free =
    internal::free_vertices(m, internal::read_constraints(mesh, internal::cgal_parameters(np), m));
  Minimum_angle_estimate result;
  for(int f = 0; f < m.number_of_faces(); ++f)
  {
    const int begin = m.face_begin[f], end = m.face_begin[f + 1];
    if(end - begin != 3)
      throw Invalid_input("mesh: face " + std::to_string(f) + " is not a triangle");
    const auto is_free_vertex = [&](int v) { return is_free[v] != 0; };
    if(std::none_of(m.corner_vertex.begin() + begin, m.corner_vertex.begin() + end, is_free_vertex))
      for(int c = begin; c < end; ++c)
        result.of_fixed_faces =
          (std::min)(result.of_fixed_faces, internal::corner_angle(m, point, c));
  }
  for(int v = 0; v < m.number_of_vertices(); ++v)
    if(is_free[v])
      result.at_free_vertices =
        (std::min)(result.at_free_vertices, internal::vertex_angle_bound(m, point, v));
  return result;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_MINIMUM_ANGLE_ESTIMATE_H
