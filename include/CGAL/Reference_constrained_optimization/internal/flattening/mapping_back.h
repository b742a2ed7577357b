// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_MAPPING_BACK_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_MAPPING_BACK_H

#include <CGAL/Reference_constrained_optimization/internal/flattening/planar_location.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Patch.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Maps a point given by a triangle of the patch and barycentric coordinates to R (paper 3.4): onto
// the patch by interpolation, then to the closest point of R on the same sheet. Returns false if no
// such point is found.
inline bool map_to_reference(const Patch& patch,
                             const Planar_location& location,
                             const Reference_surface& reference,
                             Located_vertex& result)
{
  const Indexed_mesh& triangles = patch.triangles();
  const Located_vertex* corner[3];
  Vector_3 point = Vector_3::Zero(), normal = Vector_3::Zero();
  for(int i = 0; i < 3; ++i)
  {
    corner[i] = &patch.located[triangles.corner_vertex[3 * location.triangle + i]];
    point += location.barycentric(i) * corner[i]->position;
    normal += location.barycentric(i) * corner[i]->normal;
  }
  int order[3] = {0, 1, 2};
  std::sort(order, order + 3,
            [&](int a, int b) { return location.barycentric(a) > location.barycentric(b); });
  const Surface_point& nearest = corner[order[0]]->on_reference;

  double best_distance = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Surface_point& projection) {
    const double distance = (projection.position - point).norm();
    if(distance < best_distance && reference.normal(projection).dot(normal) > 0)
    {
      result.on_reference = projection;
      best_distance = distance;
    }
  };
  // The local search from a corner ends no further away than the corner is. A distance that is not much
  // smaller may be a local minimum that misses a closer part of the sheet.
  const auto is_close = [&](const Surface_point& from) {
    return best_distance <= 0.25 * (from.position - point).norm();
  };
  for(int k = 0; k < 3; ++k)
  {
    const Surface_point& from = corner[order[k]]->on_reference;
    consider(reference.local_closest(point, from.face));
    if(is_close(from))
      break;
  }
  if(!is_close(nearest))
  {
    const Surface_point global = std::isfinite(best_distance)
                                   ? reference.closest(point, result.on_reference)
                                   : reference.closest(point);
    const double path_length =
      3 * (nearest.position - point).norm() + (global.position - point).norm();
    if((global.position - point).norm() < 0.9 * best_distance &&
       reference.is_reachable(nearest, global, path_length))
      consider(global);
  }
  if(!std::isfinite(best_distance))
    return false;
  result.position = result.on_reference.position;
  result.normal = reference.normal(result.on_reference);
  return true;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_MAPPING_BACK_H
