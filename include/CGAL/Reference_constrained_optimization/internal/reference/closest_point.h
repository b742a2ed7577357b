// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_CLOSEST_POINT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_CLOSEST_POINT_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <limits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Barycentric coordinates of the point of triangle abc that is closest to p; entries are exactly
// zero where the point is on the boundary. Works for degenerate triangles, too.
inline Vector_3
closest_barycentric(const Vector_3& p, const Vector_3& a, const Vector_3& b, const Vector_3& c)
{
  // minimal distance to those of the sides ab, bc, ca that are faced
  const auto on_sides = [&](bool faces_ab, bool faces_bc, bool faces_ca) {
    const Vector_3* t[3] = {&a, &b, &c};
    const bool is_faced[3] = {faces_ab, faces_bc, faces_ca};
    Vector_3 best(1, 0, 0);
    double best_distance = -1;
    for(int i = 0; i < 3; ++i)
    {
      if(!is_faced[i])
        continue;
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
  const double det = n.squaredNorm(), uu = u.squaredNorm(), vv = v.squaredNorm();
  if(!(det > 1e-8 * uu * vv))
  {
    // at the tip of a needle the result is inaccurate, too; at the vertex opposite to the longest side it
    // is not
    const double opposite = (c - b).squaredNorm();
    if(uu > opposite && uu >= vv)
    {
      const Vector_3 k = closest_barycentric(p, c, a, b);
      return Vector_3(k(1), k(2), k(0));
    }
    if(vv > opposite)
    {
      const Vector_3 k = closest_barycentric(p, b, c, a);
      return Vector_3(k(2), k(0), k(1));
    }
    if(!(det > 1e-16 * uu * vv))
      return on_sides(true, true, true);
  }
  const double y = w.cross(v).dot(n) / det, z = u.cross(w).dot(n) / det;
  if(y > 0 && z > 0 && y + z < 1)
    return Vector_3(1 - y - z, y, z);
  return on_sides(!(z > 0), !(y + z < 1), !(y > 0));
}

// a point of a triangle mesh that is a local minimum of the distance to another one
struct Projection
{
  int face = -1;
  Vector_3 barycentric = Vector_3::Zero();
  Vector_3 position = Vector_3::Zero();
  double squared_distance = 0;
};

// Local closest point: starts at `face` and moves to ever closer neighbouring faces. Never leaves the sheet
// it starts on. `point(v)` is the position of a vertex. At a vertex of more faces than `largest_valence` it
// ends.
template <typename PointAccess>
Projection local_closest_point(const Indexed_mesh& mesh,
                               const PointAccess& point,
                               const Vector_3& p,
                               int face,
                               int largest_valence = (std::numeric_limits<int>::max)())
{
  const auto closest_in_face = [&](int f) {
    const int* v = &mesh.corner_vertex[mesh.face_begin[f]];
    const Vector_3 &a = point(v[0]), &b = point(v[1]), &c = point(v[2]);
    Projection projection;
    projection.face = f;
    projection.barycentric = closest_barycentric(p, a, b, c);
    projection.position =
      projection.barycentric(0) * a + projection.barycentric(1) * b + projection.barycentric(2) * c;
    projection.squared_distance = (projection.position - p).squaredNorm();
    return projection;
  };

  Projection best = closest_in_face(face);
  while(true)
  {
    const int begin = mesh.face_begin[best.face];
    int zero = 0, one = 0;
    best.barycentric.minCoeff(&zero);
    best.barycentric.maxCoeff(&one);
    if(best.barycentric(zero) > 0)
      return best;

    Projection candidate = best;
    const auto consider = [&](int f) {
      const Projection projection = closest_in_face(f);
      if(projection.squared_distance < candidate.squared_distance)
        candidate = projection;
    };
    // close to a vertex any face at it may be closer
    const double at_vertex = 1 - 1e-9;
    if(best.barycentric(one) < at_vertex)
    {
      const int o = mesh.opposite[mesh.next(begin + zero)];
      if(o >= 0)
        consider(mesh.corner_face[o]);
    }
    else
    {
      const int v = mesh.corner_vertex[begin + one];
      if(mesh.valence(v) > largest_valence)
        return best;
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
        consider(mesh.corner_face[mesh.vertex_corners[k]]);
    }
    if(!(candidate.squared_distance < best.squared_distance * (1 - 1e-12)))
      return best;
    best = candidate;
  }
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_CLOSEST_POINT_H
