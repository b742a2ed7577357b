// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_ANGLES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_ANGLES_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>

#include <algorithm>
#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds statistics of the smallest angles of faces, in degrees. Every face counts once.
 */
struct Angle_statistics
{
  double minimum = 0;              ///< smallest angle of all.
  double mean = 0;                 ///< mean over the faces of their smallest angle.
  double standard_deviation = 0;   ///< of the same, as a population.
  std::size_t number_of_faces = 0; ///< all faces.
  std::size_t number_below_10 = 0; ///< faces whose smallest angle is below 10 degrees.
  std::size_t number_below_20 = 0; ///< the same for 20 degrees.
  std::size_t number_below_30 = 0; ///< the same for 30 degrees.
  std::size_t number_below_40 = 0; ///< the same for 40 degrees.
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds statistics of the angles at all corners of all faces, in degrees.
 */
struct Corner_angle_statistics
{
  double minimum = 0;            ///< smallest angle.
  double maximum = 0;            ///< largest angle.
  double mean = 0;               ///< mean over all corners.
  double standard_deviation = 0; ///< of all corners, as a population.
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * computes statistics of the smallest angle of every face.
 *
 * An angle is measured between the two sides at a corner and lies between 0 and 180 degrees. A
 * degenerate triangle counts as 0 degrees.
 *
 * \tparam FaceGraph a model of `FaceListGraph` and `HalfedgeListGraph`, with triangles or quads
 * \tparam NamedParameters a sequence of \ref bgl_namedparameters "Named Parameters"
 *
 * \param mesh the mesh
 * \param np optional named parameters:
 *
 * \cgalNamedParamsBegin
 *   \cgalParamNBegin{vertex_point_map}
 *     \cgalParamDescription{a property map from the vertices of `mesh` to points}
 *     \cgalParamType{a model of `ReadablePropertyMap`}
 *     \cgalParamDefault{`boost::get(CGAL::vertex_point, mesh)`}
 *   \cgalParamNEnd
 * \cgalNamedParamsEnd
 *
 * \throws Invalid_input if the mesh is empty, not manifold, has a coordinate that is not finite or
 *         a face of more than four vertices. This holds for all quality measures.
 */
template <typename FaceGraph, typename NamedParameters = parameters::Default_named_parameters>
Angle_statistics angle_statistics(const FaceGraph& mesh,
                                  const NamedParameters& np = parameters::default_values())
{
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  const auto point = [&](int v) -> const internal::Vector_3& { return copy.points[v]; };
  internal::Moments moments;
  Angle_statistics result;
  for(int f = 0; f < copy.mesh.number_of_faces(); ++f)
  {
    double smallest = 180;
    for(int c = copy.mesh.face_begin[f]; c < copy.mesh.face_begin[f + 1]; ++c)
      smallest = (std::min)(smallest, internal::corner_angle(copy.mesh, point, c));
    moments.add(smallest);
    result.number_below_10 += smallest < 10;
    result.number_below_20 += smallest < 20;
    result.number_below_30 += smallest < 30;
    result.number_below_40 += smallest < 40;
  }
  result.number_of_faces = moments.count();
  result.minimum = moments.minimum();
  result.mean = moments.mean();
  result.standard_deviation = moments.standard_deviation();
  return result;
}

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * computes statistics of the angles at all corners of all faces.
 *
 * An angle is measured between the two sides at a corner and lies between 0 and 180 degrees, at
 * corners that are not convex, too (`number_of_nonconvex_quads()` counts those).
 *
 * Parameters are those of `angle_statistics()`.
 */
template <typename FaceGraph, typename NamedParameters = parameters::Default_named_parameters>
Corner_angle_statistics
corner_angle_statistics(const FaceGraph& mesh,
                        const NamedParameters& np = parameters::default_values())
{
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  const auto point = [&](int v) -> const internal::Vector_3& { return copy.points[v]; };
  internal::Moments moments;
  for(int c = 0; c < copy.mesh.number_of_corners(); ++c)
    moments.add(internal::corner_angle(copy.mesh, point, c));
  Corner_angle_statistics result;
  result.minimum = moments.minimum();
  result.maximum = moments.maximum();
  result.mean = moments.mean();
  result.standard_deviation = moments.standard_deviation();
  return result;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_ANGLES_H
