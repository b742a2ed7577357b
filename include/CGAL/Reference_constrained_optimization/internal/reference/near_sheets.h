// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_NEAR_SHEETS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_NEAR_SHEETS_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_triangle.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Per triangle of R, whether another sheet of R is near: triangles that are turned by more than 120 degrees, or
// belong to another component. Near is a quarter of the mean edge of R, the bound of the drift, and less between
// small triangles, or `scale` times that. Empty if there are none.
inline std::vector<char> near_sheets(const Reference_surface& reference, double scale)
{
  typedef CGAL::Box_intersection_d::Box_with_info_d<double, 3, int> Box;
  const Indexed_mesh& mesh = reference.mesh();
  const int n = mesh.number_of_faces();
  std::vector<Box> boxes;
  std::vector<Vector_3> normals;
  std::vector<double> margins;
  boxes.reserve(n);
  normals.reserve(n);
  for(int f = 0; f < n; ++f)
  {
    Vector_3 low = reference.corner_point(f, 0), high = low;
    double longest = 0;
    for(int i = 0; i < 3; ++i)
    {
      const Vector_3& p = reference.corner_point(f, i);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
      longest = (std::max)(longest, (p - reference.corner_point(f, (i + 1) % 3)).norm());
    }
    margins.push_back(scale * (std::min)(0.125 * reference.mean_edge_length(), 0.25 * longest));
    low.array() -= margins[f];
    high.array() += margins[f];
    boxes.emplace_back(low.data(), high.data(), f);
    normals.push_back(reference.face_normal(f).stableNormalized());
  }
  std::vector<int> component(n, -1);
  std::vector<char> is_unvisited(n, 1);
  for(int first = 0; first < n; ++first)
    if(is_unvisited[first])
      for(const int f : extract_connected_region(mesh, first, is_unvisited))
        component[f] = first;
  const auto distance = [&](int f, int g) { // of corners
    double shortest = std::numeric_limits<double>::infinity();
    for(int i = 0; i < 3; ++i)
      for(const std::pair<int, int>& p : {std::make_pair(f, g), std::make_pair(g, f)})
      {
        const Vector_3& corner = reference.corner_point(p.first, i);
        shortest = (std::min)(
          shortest, (reference.closest_in_face(corner, p.second).position - corner).norm());
      }
    return shortest;
  };
  std::vector<char> result(n, 0);
  const auto visit = [&](const Box& a, const Box& b) {
    const int f = a.info(), g = b.info();
    const double smallest_cosine = -0.5;
    if((!result[f] || !result[g]) &&
       (component[f] != component[g] || normals[f].dot(normals[g]) < smallest_cosine) &&
       distance(f, g) <= margins[f] + margins[g])
      result[f] = result[g] = 1;
  };
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), visit, box_intersection_cutoff);
  if(std::find(result.begin(), result.end(), 1) == result.end())
    result.clear();
  return result;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_NEAR_SHEETS_H
