// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_TANGENT_STEP_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_TANGENT_STEP_H

#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Takes a vertex along a tangent and back to R by the local closest point. A tangent leaves R slowly;
// where it does not the surface ends, or turns away, and the answer is false.
inline bool step_on_surface(const Reference_surface& reference,
                            const Placed_vertex& from,
                            const Vector_3& way,
                            Placed_vertex& result)
{
  const Vector_3 target = from.position + way;
  const Surface_point foot = reference.descend(target, from.on_reference.face);
  const Vector_3 normal = reference.normal(foot);
  if((foot.position - target).squaredNorm() > 0.25 * way.squaredNorm() ||
     !(normal.dot(from.normal) > 0))
    return false;
  result.on_reference = foot;
  result.position = foot.position;
  result.normal = normal;
  return true;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_TANGENT_STEP_H
