// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FACE_IN_DIRECTION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FACE_IN_DIRECTION_H

#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

#include <algorithm>
#include <cmath>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// length of the projection of the unit vector `direction` onto the wedge between `a` and `b`, which a
// triangle covers at a point of its boundary
inline double
projected_length_in_wedge(const Vector_3& a, const Vector_3& b, const Vector_3& direction)
{
  const double aa = a.squaredNorm(), ab = a.dot(b), bb = b.squaredNorm();
  const double da = a.dot(direction), db = b.dot(direction);
  const double det = aa * bb - ab * ab;
  if(!(det > 1e-12 * aa * bb))
    return 0;
  // the projection of the direction is s a + t b
  const double s = (bb * da - ab * db) / det, t = (aa * db - ab * da) / det;
  if(s > 0 && t > 0)
    return std::sqrt((std::max)(0., s * da + t * db));
  return (std::max)({0., da / std::sqrt(aa), db / std::sqrt(bb)});
}

// the vertex of R where a point is; -1 if it is at none
inline int vertex_at(const Reference_surface& reference, const Surface_point& point)
{
  int zeros = 0, corner = -1;
  for(int i = 0; i < 3; ++i)
    if(point.barycentric(i) == 0)
      ++zeros;
    else
      corner = i;
  const Indexed_mesh& mesh = reference.mesh();
  return zeros == 2 ? mesh.corner_vertex[mesh.face_begin[point.face] + corner] : -1;
}

// The face of R at a point in which `direction` has the longest projection; the point's own face where it
// is inside one, and where no face contains a descent in that direction.
inline int face_in_direction(const Reference_surface& reference,
                             const Surface_point& point,
                             const Vector_3& direction)
{
  const Indexed_mesh& mesh = reference.mesh();
  int zero = 2;
  while(zero >= 0 && point.barycentric(zero) != 0)
    --zero;
  if(zero < 0)
    return point.face;
  int best = point.face;
  double largest = 0;
  const auto consider = [&](int face, double length) {
    if(length > largest)
    {
      largest = length;
      best = face;
    }
  };
  const int v = vertex_at(reference, point);
  if(v >= 0)
  {
    const Vector_3& p = reference.points()[v];
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int c = mesh.vertex_corners[k];
      consider(mesh.corner_face[c],
               projected_length_in_wedge(reference.points()[mesh.target(c)] - p,
                                         reference.points()[mesh.source(mesh.previous(c))] - p,
                                         direction));
    }
    return best;
  }
  // on an edge: half-planes on both sides
  const int c = mesh.next(mesh.face_begin[point.face] + zero);
  const Vector_3& p = reference.points()[mesh.source(c)];
  const Vector_3 edge = (reference.points()[mesh.target(c)] - p).normalized();
  const auto half_plane = [&](int side) {
    const Vector_3 across = reference.points()[mesh.source(mesh.previous(side))] - p;
    const Vector_3 inward = (across - across.dot(edge) * edge).normalized();
    const double along = edge.dot(direction), in = (std::max)(0., inward.dot(direction));
    return std::sqrt(along * along + in * in);
  };
  consider(point.face, half_plane(c));
  if(mesh.opposite[c] >= 0)
    consider(mesh.corner_face[mesh.opposite[c]], half_plane(mesh.opposite[c]));
  return best;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FACE_IN_DIRECTION_H
