// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_CREASE_DIRECTION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_CREASE_DIRECTION_H

#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The unit direction of the crease of R at a point: of the two at a vertex, the one that agrees better with
// `preferred`. Zero if the point is not on a crease, or where creases end or meet.
inline Vector_3 crease_direction(const Reference_surface& reference,
                                 const Surface_point& p,
                                 const Vector_3& preferred)
{
  const Indexed_mesh& mesh = reference.mesh();
  const double on = 1e-6; // of a height
  const auto along = [&](int c) {
    return Vector_3(
      (reference.points()[mesh.target(c)] - reference.points()[mesh.source(c)]).normalized());
  };
  const int begin = mesh.face_begin[p.face];
  int largest = 0;
  p.barycentric.maxCoeff(&largest);
  if(p.barycentric(largest) < 1 - on)
  {
    for(int i = 0; i < 3; ++i) // the corner's edge is opposite to the corner before it
      if(p.barycentric((i + 2) % 3) < on && reference.is_crease(begin + i))
        return along(begin + i);
    return Vector_3::Zero();
  }
  Vector_3 best = Vector_3::Zero();
  int count = 0;
  const int v = mesh.corner_vertex[begin + largest];
  for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
  {
    const int c = mesh.vertex_corners[k];
    if(!reference.is_crease(c))
      continue;
    ++count;
    const Vector_3 d = along(c);
    if(count == 1 || d.dot(preferred) > best.dot(preferred))
      best = d;
  }
  return count == 2 ? best : Vector_3(Vector_3::Zero());
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_CREASE_DIRECTION_H
