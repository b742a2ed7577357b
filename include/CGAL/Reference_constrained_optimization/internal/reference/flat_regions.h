// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FLAT_REGIONS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FLAT_REGIONS_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Calls visit(region) with the faces of each maximal region of the given faces that are connected by flat
// edges; `region_of_face` tells regions apart then.
template <typename IsFlat, typename Visit>
void for_each_flat_region(
  const Indexed_mesh& mesh,
  const std::vector<int>& faces,
  IsFlat is_flat, // (corner): whether its edge, which is not of the border, is flat
  std::vector<int>& region_of_face,
  Visit visit)
{
  for(const int f : faces)
    region_of_face[f] = -1;
  std::vector<int> region;
  for(const int first : faces)
  {
    if(region_of_face[first] >= 0)
      continue;
    region.assign(1, first);
    region_of_face[first] = first;
    for(std::size_t i = 0; i < region.size(); ++i)
      for(int c = mesh.face_begin[region[i]]; c < mesh.face_begin[region[i] + 1]; ++c)
      {
        const int f = mesh.opposite[c] < 0 ? -1 : mesh.corner_face[mesh.opposite[c]];
        if(f >= 0 && region_of_face[f] < 0 && is_flat(c))
        {
          region_of_face[f] = first;
          region.push_back(f);
        }
      }
    visit(region);
  }
}

// The number of vertices at which the outline of a region turns by more than an angle, in degrees: three if
// it is a triangle that was split.
inline int number_of_outline_corners(const Indexed_mesh& mesh,
                                     const std::vector<Vector_3>& points,
                                     const std::vector<int>& region,
                                     const std::vector<int>& region_of_face,
                                     double smallest_turn)
{
  const auto is_outline = [&](int c) {
    const int o = mesh.opposite[c];
    return o < 0 || region_of_face[mesh.corner_face[o]] != region_of_face[mesh.corner_face[c]];
  };
  const auto direction = [&](int c) { return points[mesh.target(c)] - points[mesh.source(c)]; };
  int result = 0;
  for(const int f : region)
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
    {
      if(!is_outline(c))
        continue;
      int d = mesh.next(c);
      while(!is_outline(d))
        d = mesh.next(mesh.opposite[d]);
      const Vector_3 before = direction(c), after = direction(d);
      result += degrees_per_radian * std::atan2(before.cross(after).norm(), before.dot(after)) >
                smallest_turn;
    }
  return result;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FLAT_REGIONS_H
