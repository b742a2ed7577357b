// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_FACE_NORMAL_DEVIATION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_FACE_NORMAL_DEVIATION_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/face_in_direction.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>

#include <algorithm>
#include <array>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Barycentric coordinates of the points of a triangle at which its normal deviation from R is sampled: the
// centroid, points towards the corners, and points close to the midpoints of the edges.
inline const std::array<Vector_3, 7>& normal_deviation_samples()
{
  static const std::array<Vector_3, 7> samples = {
    {Vector_3::Constant(1. / 3), Vector_3(.6, .2, .2), Vector_3(.2, .6, .2), Vector_3(.2, .2, .6),
     Vector_3(.495, .495, .01), Vector_3(.01, .495, .495), Vector_3(.495, .01, .495)}};
  return samples;
}

// The normal deviation of a face from R in degrees: the mean over those points; 0 for a face without area,
// and for one that lies in one triangle of R.
template <typename VertexAccess>
double face_normal_deviation(const Indexed_mesh& mesh,
                             const Reference_surface& reference,
                             const VertexAccess& vertex,
                             int f,
                             const Vector_3& normal)
{
  const int begin = mesh.face_begin[f], end = mesh.face_begin[f + 1];
  const auto corner = [&](int c) -> const Located_vertex& { return vertex(mesh.corner_vertex[c]); };
  const double length = normal.norm();
  bool is_inside = true;
  for(int c = begin; c < end; ++c)
    is_inside = is_inside && corner(c).on_reference.face == corner(begin).on_reference.face;
  if(is_inside || !(length > 0))
    return 0;
  // the closest of the results from all corners, since a local search may end at a crease
  const auto normal_deviation_at = [&](const Vector_3& p, int first) { // first: a corner
    Surface_point best;
    double closest = 0;
    for(int i = 0; i < end - begin; ++i)
    {
      const Located_vertex& v = corner(begin + (first - begin + i) % (end - begin));
      const Surface_point projection =
        reference.local_closest(p, face_in_direction(reference, v.on_reference, p - v.position));
      const double distance = (projection.position - p).squaredNorm();
      if(best.face < 0 || distance < closest)
      {
        best = projection;
        closest = distance;
      }
    }
    const Vector_3 n = reference.face_normal(best.face);
    const double side = n.dot(reference.normal(best)) < 0 ? -1 : 1; // R may have been reversed
    return angle_between(side * n, normal);
  };
  double sum = 0;
  for(int t = begin + 1; t + 1 < end; ++t)
    for(const Vector_3& b : normal_deviation_samples())
      sum += normal_deviation_at(b(0) * corner(begin).position + b(1) * corner(t).position +
                                   b(2) * corner(t + 1).position,
                                 b(1) > b(0) ? t : begin);
  return sum / double((end - begin - 2) * normal_deviation_samples().size());
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_FACE_NORMAL_DEVIATION_H
