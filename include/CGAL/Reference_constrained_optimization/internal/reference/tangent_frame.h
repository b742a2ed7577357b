// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_TANGENT_FRAME_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_TANGENT_FRAME_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <Eigen/Core>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

typedef Eigen::Matrix<double, 3, 2> Tangent_frame;

// an orthonormal frame of the plane with the given normal, of any length; positively oriented seen
// from where the normal points
inline Tangent_frame tangent_frame(const Vector_3& normal)
{
  int axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  Tangent_frame frame;
  frame.col(0) = normal.cross(Vector_3::Unit(axis)).normalized();
  frame.col(1) = normal.cross(frame.col(0)).normalized();
  return frame;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_TANGENT_FRAME_H
