// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_FLIP_FREE_STEP_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_FLIP_FREE_STEP_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <cmath>
#include <limits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The smallest positive t at which the triangle with edge matrix `edges`, moving by t times
// `motion`, has no area; infinity if there is none. The triangle must be positively oriented.
inline double time_of_collapse(const Eigen::Matrix2d& edges, const Eigen::Matrix2d& motion)
{
  // det(edges + t motion) = a t^2 + b t + c
  const double a = motion.determinant(), c = edges.determinant();
  const double b = edges(0, 0) * motion(1, 1) + motion(0, 0) * edges(1, 1) -
                   edges(0, 1) * motion(1, 0) - motion(0, 1) * edges(1, 0);
  const double infinity = std::numeric_limits<double>::infinity();
  const double discriminant = b * b - 4 * a * c;
  if(discriminant < 0)
    return infinity;
  // c > 0: written so that neither root cancels
  const double root = std::sqrt(discriminant);
  if(b >= 0)
  {
    // a positive root exists only for a < 0
    return a < 0 ? (b + root) / (-2 * a) : infinity;
  }
  return 2 * c / (root - b);
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_FLIP_FREE_STEP_H
