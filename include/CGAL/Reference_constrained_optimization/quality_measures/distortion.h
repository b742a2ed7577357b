// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_DISTORTION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_DISTORTION_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/surface_metric.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/face_correspondence.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds statistics of \f$ (\|J\|_F^2 + \|J^{-1}\|_F^2) / 2 \f$ over the triangles of a map between two
 * meshes: 2 at an isometry, without unit.
 */
struct Distortion_statistics
{
  double mean = 0;          ///< mean over the triangles.
  double median = 0;        ///< half of the triangles have at most this.
  double percentile_99 = 0; ///< 99 of 100 triangles have at most this.
  double maximum = 0;       ///< largest value.
  /// triangles without area in one mesh only or in both; their distortion counts as infinite.
  std::size_t number_of_degenerate_triangles = 0;
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * computes statistics of the distortion of the piecewise linear map from one mesh to another of the same
 * connectivity.
 *
 * For every triangle, \f$ J \f$ is the Jacobian of the affine map from the source's triangle to the
 * mesh's, after the source was scaled to the area of the other; its value is
 * \f$ (\|J\|_F^2 + \|J^{-1}\|_F^2) / 2 \f$. Quads are split, in both meshes along the diagonal that
 * is shorter in the source. All triangles weigh the same.
 *
 * \param source the mesh with the shapes at rest. Faces and vertices of the two meshes correspond
 *        by their positions in `faces()` and `vertices()`.
 * \param mesh the mesh
 * \param np_source the parameter `vertex_point_map` of `source`
 * \param np the parameter `vertex_point_map` of `mesh`
 * \param target_area the area to which the source is scaled; if it is 0, that of `mesh`. For a mesh
 *        on a reference give the reference's, which does not depend on where the vertices are.
 *
 * \throws Invalid_input if the meshes do not correspond or one of them has no area.
 */
template <typename SourceMesh,
          typename FaceGraph,
          typename NamedParametersSource = parameters::Default_named_parameters,
          typename NamedParameters = parameters::Default_named_parameters>
Distortion_statistics
distortion_statistics(const SourceMesh& source,
                      const FaceGraph& mesh,
                      const NamedParametersSource& np_source = parameters::default_values(),
                      const NamedParameters& np = parameters::default_values(),
                      double target_area = 0)
{
  const internal::Mesh_copy from = internal::read_measured_mesh(source, np_source, "source");
  const internal::Mesh_copy to = internal::read_measured_mesh(mesh, np, "mesh");
  if(from.points.size() != to.points.size() ||
     from.mesh.number_of_faces() != to.mesh.number_of_faces())
    throw Invalid_input("source and mesh: the numbers of vertices or faces differ");
  const double source_area = internal::surface_area(from.mesh, from.points);
  if(target_area == 0)
    target_area = internal::surface_area(to.mesh, to.points);
  if(!(source_area > 0) || !(target_area > 0))
    throw Invalid_input("source and mesh: one of them has no area");
  const double scale = std::sqrt(source_area / target_area); // of the mesh, instead of the source

  Distortion_statistics result;
  std::vector<double> values;
  double sum = 0;
  for(int f = 0; f < from.mesh.number_of_faces(); ++f)
  {
    if(internal::face_rotation(from.mesh, f, to.mesh.degree(f), [&](int i) {
         return to.mesh.corner_vertex[to.mesh.face_begin[f] + i];
       }) < 0)
      throw Invalid_input("source and mesh: face " + std::to_string(f) +
                          " does not have the same vertices in both");
    for(const std::array<int, 3>& t : internal::split_face(from.mesh, from.points, f))
    {
      std::array<int, 3> v;
      for(int i = 0; i < 3; ++i)
        v[i] = from.mesh.corner_vertex[t[i]];
      const Eigen::Matrix2d rest =
        internal::triangle_shape(from.points[v[0]], from.points[v[1]], from.points[v[2]]);
      const Eigen::Matrix2d shape =
        scale * internal::triangle_shape(to.points[v[0]], to.points[v[1]], to.points[v[2]]);
      double value = std::numeric_limits<double>::infinity();
      if(rest.determinant() > 0 && shape.determinant() > 0)
        value =
          0.5 * ((shape * rest.inverse()).squaredNorm() + (rest * shape.inverse()).squaredNorm());
      if(!std::isfinite(value))
        ++result.number_of_degenerate_triangles;
      values.push_back(value);
      sum += value;
    }
  }
  std::sort(values.begin(), values.end());
  // the smallest value that the given share of the triangles does not exceed
  const auto quantile = [&](double share) {
    return values[std::size_t(std::ceil(share * double(values.size()))) - 1];
  };
  result.mean = sum / double(values.size());
  result.median = quantile(0.5);
  result.percentile_99 = quantile(0.99);
  result.maximum = values.back();
  return result;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_DISTORTION_H
