// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FACE_TURN_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FACE_TURN_H

#include <CGAL/Reference_constrained_optimization/internal/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/internal/face_towards.h>

#include <algorithm>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The smallest cosine of the angle between a face and R, at the closest points of R to the middle of
// the face and to points on the way to its corners; 1 for a face without area, and for one that lies in
// one triangle of R.
template <typename VertexAccess>
double face_turn_cosine(const Indexed_mesh& mesh,
                        const Reference_surface& reference,
                        const VertexAccess& vertex,
                        int f,
                        const Vector_3& normal)
{
  const int begin = mesh.face_begin[f], end = mesh.face_begin[f + 1];
  const auto corner = [&](int c) -> const Placed_vertex& { return vertex(mesh.corner_vertex[c]); };
  const double length = normal.norm();
  bool is_inside = true;
  Vector_3 middle = Vector_3::Zero();
  for(int c = begin; c < end; ++c)
  {
    is_inside = is_inside && corner(c).on_reference.face == corner(begin).on_reference.face;
    middle += corner(c).position / (end - begin);
  }
  if(is_inside || !(length > 0))
    return 1;
  // closest of what the corners lead to: a descent may end at a crease
  const auto cosine_at = [&](const Vector_3& p, int first) {
    Surface_point best;
    double closest = 0;
    for(int i = 0; i < end - begin; ++i)
    {
      const Placed_vertex& v = corner(begin + (first - begin + i) % (end - begin));
      const Surface_point foot =
        reference.descend(p, face_towards(reference, v.on_reference, p - v.position));
      const double distance = (foot.position - p).squaredNorm();
      if(best.face < 0 || distance < closest)
      {
        best = foot;
        closest = distance;
      }
    }
    const Vector_3 n = reference.face_normal(best.face);
    const double lengths = n.norm() * length;
    const double side = n.dot(reference.normal(best)) < 0 ? -1 : 1; // R may have been reversed
    return lengths > 0 ? side * n.dot(normal) / lengths : 1.;
  };
  double least = cosine_at(middle, begin);
  for(int c = begin; c < end; ++c)
    least = (std::min)(least, cosine_at(0.4 * corner(c).position + 0.6 * middle, c));
  return least;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FACE_TURN_H
