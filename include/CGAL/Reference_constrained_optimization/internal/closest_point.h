// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_CLOSEST_POINT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_CLOSEST_POINT_H

#include <CGAL/Reference_constrained_optimization/internal/Indexed_mesh.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Barycentric coordinates of the point of triangle abc that is closest to p; entries are exactly
// zero where the point is on the boundary. Works for degenerate triangles, too.
inline Vector_3 closest_barycentric(const Vector_3& p,
                                    const Vector_3& a,
                                    const Vector_3& b,
                                    const Vector_3& c)
{
  // minimal distance to the three sides: needed at the boundary only
  const auto on_sides = [&]() {
    const Vector_3* t[3] = {&a, &b, &c};
    Vector_3 best(1, 0, 0);
    double best_distance = -1;
    for(int i = 0; i < 3; ++i)
    {
      const Vector_3 &s = *t[i], &e = *t[(i + 1) % 3];
      const Vector_3 d = e - s;
      const double length = d.squaredNorm();
      double k = length > 0 ? d.dot(p - s) / length : 0;
      k = k < 0 ? 0 : (k > 1 ? 1 : k);
      const double distance = (s + k * d - p).squaredNorm();
      if(best_distance < 0 || distance < best_distance)
      {
        best_distance = distance;
        best.setZero();
        best(i) = 1 - k;
        best((i + 1) % 3) = k;
      }
    }
    return best;
  };

  // With cross products, as the determinant of dot products would lose all digits of a thin
  // triangle; one thinner still is no more than its sides.
  const Vector_3 u = b - a, v = c - a, w = p - a;
  const Vector_3 n = u.cross(v);
  const double det = n.squaredNorm();
  if(!(det > 1e-16 * u.squaredNorm() * v.squaredNorm()))
    return on_sides();
  const double y = w.cross(v).dot(n) / det, z = u.cross(w).dot(n) / det;
  if(y > 0 && z > 0 && y + z < 1)
    return Vector_3(1 - y - z, y, z);
  return on_sides();
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_CLOSEST_POINT_H
