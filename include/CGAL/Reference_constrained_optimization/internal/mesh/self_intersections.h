// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_SELF_INTERSECTIONS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_SELF_INTERSECTIONS_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_triangle.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The pairs of faces of which triangles intersect other than in a common vertex or edge, the smaller index
// first, sorted; one for each pair of triangles.
inline std::vector<std::pair<int, int>>
self_intersections(const std::vector<Indexed_triangle>& triangles)
{
  std::vector<std::pair<int, int>> pairs;
  for_each_close_pair(triangles, [&](const Indexed_triangle& s, const Indexed_triangle& t) {
    if(intersect(s, t))
      pairs.push_back(std::minmax(s.face, t.face));
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

inline std::vector<std::pair<int, int>> self_intersections(const Indexed_mesh& mesh,
                                                           const std::vector<Vector_3>& points)
{
  std::vector<int> faces(mesh.number_of_faces());
  std::iota(faces.begin(), faces.end(), 0);
  return self_intersections(triangles_of(
    mesh, [&](int v) -> const Vector_3& { return points[v]; }, faces));
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_SELF_INTERSECTIONS_H
