// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_TANGENT_STEP_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_TANGENT_STEP_H

#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Moves a vertex along a tangent and back to R by the local closest point. False where the distance to R is
// not small compared with the step: the surface ends or bends there.
inline bool step_on_surface(const Reference_surface& reference,
                            const Located_vertex& from,
                            const Vector_3& displacement,
                            Located_vertex& result)
{
  const Vector_3 target = from.position + displacement;
  const Surface_point projection = reference.local_closest(target, from.on_reference.face);
  const Vector_3 normal = reference.normal(projection);
  if((projection.position - target).squaredNorm() > 0.25 * displacement.squaredNorm() ||
     !(normal.dot(from.normal) > 0))
    return false;
  result.on_reference = projection;
  result.position = projection.position;
  result.normal = normal;
  return true;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_TANGENT_STEP_H
