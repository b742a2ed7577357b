// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MAPPING_BACK_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MAPPING_BACK_H

#include <CGAL/Reference_constrained_optimization/internal/Patch.h>
#include <CGAL/Reference_constrained_optimization/internal/planar_location.h>

#include <algorithm>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Maps a point given by a triangle of the patch and barycentric coordinates to R (paper 3.4): onto
// the patch by interpolation, then to the closest point of R on the same sheet. Returns false if no
// such point is found.
inline bool map_to_reference(const Patch& patch,
                             const Planar_location& location,
                             const Reference_surface& reference,
                             Placed_vertex& result)
{
  const Indexed_mesh& triangles = patch.triangles();
  const Placed_vertex* corner[3];
  Vector_3 point = Vector_3::Zero(), normal = Vector_3::Zero();
  for(int i = 0; i < 3; ++i)
  {
    corner[i] = &patch.placed[triangles.corner_vertex[3 * location.triangle + i]];
    point += location.barycentric(i) * corner[i]->position;
    normal += location.barycentric(i) * corner[i]->normal;
  }
  int order[3] = {0, 1, 2};
  std::sort(order, order + 3,
            [&](int a, int b) { return location.barycentric(a) > location.barycentric(b); });

  const auto is_same_sheet = [&](const Surface_point& s) {
    return reference.normal(s).dot(normal) > 0;
  };
  // descending from the nearest corner ends no further away than that corner; a foot at a large part
  // of this distance may be a local minimum that misses a closer part of the sheet
  Surface_point best;
  double best_distance = -1;
  for(int k = 0; k < 3; ++k)
  {
    const Surface_point& from = corner[order[k]]->on_reference;
    const Surface_point foot = reference.descend(point, from.face);
    const double distance = (foot.position - point).norm();
    const double allowed = 0.25 * (from.position - point).norm();
    if(is_same_sheet(foot) && (best_distance < 0 || distance < best_distance))
    {
      best = foot;
      best_distance = distance;
    }
    if(best_distance >= 0 && best_distance <= allowed)
      break;
    if(k == 2)
    {
      const Surface_point global = reference.closest(point);
      const double reach = (corner[order[0]]->position - point).norm();
      const double global_distance = (global.position - point).norm();
      if(is_same_sheet(global) && (best_distance < 0 || global_distance < 0.9 * best_distance) &&
         reference.is_reachable(corner[order[0]]->on_reference, global, 3 * reach + global_distance))
      {
        best = global;
        best_distance = global_distance;
      }
    }
  }
  if(best_distance < 0)
    return false;
  result.on_reference = best;
  result.position = best.position;
  result.normal = reference.normal(best);
  return true;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MAPPING_BACK_H
