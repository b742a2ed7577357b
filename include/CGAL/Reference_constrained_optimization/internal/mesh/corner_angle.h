// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CORNER_ANGLE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CORNER_ANGLE_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <algorithm>
#include <cmath>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

constexpr double degrees_per_radian = 57.295779513082320877;

// angle in degrees between two vectors, from 0 to 180; 0 if one of them has length 0
inline double angle_between(const Vector_3& a, const Vector_3& b)
{
  return degrees_per_radian * std::atan2(a.cross(b).norm(), a.dot(b));
}

// Angle in degrees between the sides of a face at corner c, from 0 to 180; 0 if a side has length 0.
// `point(v)` is the position of a vertex.
template <typename PointAccess>
double corner_angle(const Indexed_mesh& mesh, const PointAccess& point, int c)
{
  const Vector_3& p = point(mesh.source(c));
  const Vector_3 a = point(mesh.target(c)) - p, b = point(mesh.source(mesh.previous(c))) - p;
  return angle_between(a, b);
}

// An upper bound on the smallest angle of the faces at a vertex for its angle sum: all corners at the
// vertex are equal, and the triangles isosceles.
template <typename PointAccess>
double vertex_angle_bound(const Indexed_mesh& mesh, const PointAccess& point, int v)
{
  const int begin = mesh.vertex_begin[v], end = mesh.vertex_begin[v + 1];
  double sum = 0;
  for(int k = begin; k < end; ++k)
    sum += corner_angle(mesh, point, mesh.vertex_corners[k]);
  const double share = sum / (end - begin);
  return (std::min)(share, 90 - 0.5 * share);
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CORNER_ANGLE_H
