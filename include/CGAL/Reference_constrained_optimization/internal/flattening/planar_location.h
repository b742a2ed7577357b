// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_PLANAR_LOCATION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_PLANAR_LOCATION_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A triangle of a planar triangulation and barycentric coordinates in it; triangle -1: not found.
struct Planar_location
{
  int triangle = -1;
  Vector_3 barycentric = Vector_3::Zero();
};

// Walks from triangle `start` to the one that holds p. In a triangulation that is only locally
// injective the walk stays on the sheet it starts on.
inline Planar_location
walk(const Indexed_mesh& triangles, const std::vector<Vector_2>& u, const Vector_2& p, int start)
{
  const auto cross = [](const Vector_2& a, const Vector_2& b) { return a(0) * b(1) - a(1) * b(0); };
  Planar_location location;
  int t = start, from = -1;
  for(int step = 0; step <= triangles.number_of_faces(); ++step)
  {
    const int c = 3 * t;
    Vector_2 d[3];
    for(int i = 0; i < 3; ++i)
      d[i] = u[triangles.corner_vertex[c + i]] - p;
    const double area = cross(d[1] - d[0], d[2] - d[0]);
    // coordinate i belongs to the side opposite to vertex i, which starts at corner i + 1
    Vector_3 b(cross(d[1], d[2]), cross(d[2], d[0]), cross(d[0], d[1]));
    const double slack = -1e-12 * area;
    int exit = -1;
    for(int i = 0; i < 3; ++i)
    {
      const int o = triangles.opposite[c + (i + 1) % 3];
      if(b(i) < slack && o >= 0 && triangles.corner_face[o] != from && (exit < 0 || b(i) < b(exit)))
        exit = i;
    }
    if(exit < 0)
    {
      if(b.minCoeff() < slack || !(area > 0))
        return location; // beyond the boundary
      b = b.cwiseMax(0.);
      location.triangle = t;
      location.barycentric = b / b.sum();
      return location;
    }
    from = t;
    t = triangles.corner_face[triangles.opposite[c + (exit + 1) % 3]];
  }
  return location;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_PLANAR_LOCATION_H
