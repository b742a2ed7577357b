// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_SURFACE_METRIC_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_SURFACE_METRIC_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <cmath>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The shape of a triangle in space as a 2x2 matrix whose columns are its two edge vectors in an
// orthonormal frame of its plane. The frame is oriented by `normal`, so that the determinant is
// negative where the triangle is inverted with respect to the surface.
inline Eigen::Matrix2d
signed_shape(const Vector_3& p0, const Vector_3& p1, const Vector_3& p2, const Vector_3& normal)
{
  const Vector_3 a = p1 - p0, b = p2 - p0;
  const double length = a.norm();
  Eigen::Matrix2d shape;
  if(!(length > 0))
  {
    shape << 0, b.norm(), 0, 0;
    return shape;
  }
  const Vector_3 n = a.cross(b);
  const double height = n.norm() / length;
  shape << length, a.dot(b) / length, 0, n.dot(normal) < 0 ? -height : height;
  return shape;
}

// the same with the triangle's own normal; the determinant is not negative
inline Eigen::Matrix2d triangle_shape(const Vector_3& p0, const Vector_3& p1, const Vector_3& p2)
{
  return signed_shape(p0, p1, p2, (p1 - p0).cross(p2 - p0));
}

// The metric that turns a planar triangle (edge matrix `plane`) into its shape on the surface.
// Where one of the two is inverted or nearly degenerate a linear map is no approximation of the surface:
// then it is the uniform scaling `fallback_scale`.
inline Eigen::Matrix2d
surface_metric(const Eigen::Matrix2d& plane, const Eigen::Matrix2d& shape, double fallback_scale)
{
  const double det_plane = plane.determinant(), det_shape = shape.determinant();
  const double flat = 1e-3;
  if(det_plane > flat * plane.squaredNorm() && det_shape > flat * shape.squaredNorm())
  {
    const Eigen::Matrix2d metric = shape * plane.inverse();
    // a bound on the condition number of the map
    if(metric.squaredNorm() < 100 * metric.determinant())
      return metric;
  }
  return fallback_scale * Eigen::Matrix2d::Identity();
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_SURFACE_METRIC_H
