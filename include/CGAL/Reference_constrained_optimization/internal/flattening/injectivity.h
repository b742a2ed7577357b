// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_INJECTIVITY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_INJECTIVITY_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Whether the piecewise linear map of a triangulated disk to the plane is locally injective, exactly:
// every triangle is positively oriented, and the winding number of those at an inner vertex is one.
inline bool is_locally_injective(const Indexed_mesh& triangles, const std::vector<Vector_2>& u)
{
  typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
  for(const Vector_2& p : u)
    if(!p.allFinite())
      return false;
  // how many triangles at a vertex contain the direction of the x-axis: from below the axis to above it by
  // less than half a turn
  std::vector<int> winding_numbers(u.size(), 0);
  for(int t = 0; t < triangles.number_of_faces(); ++t)
  {
    const int* v = &triangles.corner_vertex[3 * t];
    const auto point = [&](int i) { return Kernel::Point_2(u[v[i]](0), u[v[i]](1)); };
    if(CGAL::orientation(point(0), point(1), point(2)) != CGAL::POSITIVE)
      return false;
    for(int i = 0; i < 3; ++i)
    {
      const Vector_2 &o = u[v[i]], &a = u[v[(i + 1) % 3]], &b = u[v[(i + 2) % 3]];
      winding_numbers[v[i]] += (a(1) < o(1) && b(1) > o(1)) || (a(1) == o(1) && a(0) > o(0));
    }
  }
  for(std::size_t i = 0; i < u.size(); ++i)
    if(!triangles.is_border_vertex[i] && winding_numbers[i] > 1)
      return false;
  return true;
}

// Whether the border of the disk does not cross itself in the plane; together with local
// injectivity this makes the map a bijection.
inline bool has_simple_border(const Indexed_mesh& triangles, const std::vector<Vector_2>& u)
{
  typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
  int start = -1;
  for(int c = 0; c < triangles.number_of_corners() && start < 0; ++c)
    if(triangles.opposite[c] < 0)
      start = c;
  if(start < 0)
    return false;
  CGAL::Polygon_2<Kernel> border;
  int c = start;
  do
  {
    const Vector_2& p = u[triangles.corner_vertex[c]];
    border.push_back(Kernel::Point_2(p(0), p(1)));
    // the next border edge around its target
    c = triangles.next(c);
    while(triangles.opposite[c] >= 0)
      c = triangles.next(triangles.opposite[c]);
  } while(c != start);
  return border.is_simple();
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_INJECTIVITY_H
