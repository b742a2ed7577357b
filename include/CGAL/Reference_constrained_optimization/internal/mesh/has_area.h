// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_HAS_AREA_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_HAS_AREA_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <algorithm>
#include <limits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Of the triangle of a corner and its two neighbours, above its longest side; 0 if it has none.
template <typename PointAccess>
double height_at_corner(const Indexed_mesh& mesh, const PointAccess& point, int c)
{
  const Vector_3& p = point(mesh.source(c));
  const Vector_3 u = point(mesh.target(c)) - p, v = point(mesh.source(mesh.previous(c))) - p;
  const double longest = (std::max)({u.norm(), v.norm(), (u - v).norm()});
  return longest > 0 ? u.cross(v).norm() / longest : 0;
}

// The rounding of coordinates, whose origin may be that far away. `point(v)` is the position of a vertex.
template <typename PointAccess>
double rounding_of(const Indexed_mesh& mesh, const PointAccess& point, double distance_of_origin)
{
  return 4 * std::numeric_limits<double>::epsilon() *
         (distance_of_origin + largest_coordinate(mesh, point));
}

// Whether some face has an area that exceeds the rounding of the coordinates.
template <typename PointAccess>
bool has_area(const Indexed_mesh& mesh, const PointAccess& point, double distance_of_origin = 0)
{
  const double rounding = rounding_of(mesh, point, distance_of_origin);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(height_at_corner(mesh, point, c) > rounding)
      return true;
  return false;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_HAS_AREA_H
