// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Shapes as reference surfaces, and meshes that wander on them.

#pragma once

#include "checks.h"
#include "deformations.h"

#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

namespace rco_test {

inline internal::Reference_surface surface_of(const Shape& shape)
{
  return internal::Reference_surface(copy_of(shape));
}

inline void check_surface_point(const internal::Reference_surface& surface,
                                const internal::Surface_point& s)
{
  RCO_CHECK(s.face >= 0 && s.face < surface.mesh().number_of_faces());
  RCO_CHECK(s.barycentric.minCoeff() >= 0);
  RCO_CHECK_NEAR(s.barycentric.sum(), 1., 1e-14);
  RCO_CHECK_LESS_EQUAL((surface.point(s.face, s.barycentric).position - s.position).norm(), 1e-15);
}

// Vertices move on a surface in small random steps; a step that would invert a face or fold an edge is not
// made. `mean_displacement` is in edge lengths.
inline Shape wandered(const Shape& shape,
                      const internal::Reference_surface& surface,
                      int number_of_steps,
                      double step,
                      std::uint64_t seed,
                      double& mean_displacement)
{
  const Indexed_mesh mesh = indexed(shape);
  const int n = mesh.number_of_vertices();
  Shape result = shape;
  std::vector<internal::Surface_point> place;
  std::vector<Vector_3> normals;
  std::vector<double> length(n, 0);
  for(int v = 0; v < n; ++v)
  {
    place.push_back(surface.closest(shape.points[v]));
    normals.push_back(surface.normal(place.back()));
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
      length[v] += (shape.points[mesh.target(mesh.vertex_corners[k])] - shape.points[v]).norm() /
                   (mesh.vertex_begin[v + 1] - mesh.vertex_begin[v]);
  }
  const auto normal = [&](int f) { return vector_area(result, shape.faces[f]); };
  const auto is_well = [&](int v) {
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int f = mesh.corner_face[mesh.vertex_corners[k]];
      const std::vector<int>& t = shape.faces[f];
      const Vector_3 a = normal(f);
      if(!(a.dot(normals[t[0]] + normals[t[1]] + normals[t[2]]) > 0))
        return false;
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        if(mesh.opposite[c] >= 0)
        {
          const Vector_3 b = normal(mesh.corner_face[mesh.opposite[c]]);
          if(a.dot(b) < -0.5 * a.norm() * b.norm())
            return false;
        }
    }
    return true;
  };
  Random random(seed);
  for(int i = 0; i < number_of_steps; ++i)
    for(int v = 0; v < n; ++v)
    {
      const Vector_3 move = random.in_cube(step * length[v]);
      if(mesh.is_border_vertex[v])
        continue;
      const internal::Surface_point old_place = place[v];
      const Vector_3 old_point = result.points[v], old_normal = normals[v];
      place[v] = surface.local_closest(old_point + move, old_place.face);
      result.points[v] = place[v].position;
      normals[v] = surface.normal(place[v]);
      if(!is_well(v))
      {
        place[v] = old_place;
        result.points[v] = old_point;
        normals[v] = old_normal;
      }
    }
  mean_displacement = 0;
  for(int v = 0; v < n; ++v)
    mean_displacement += (result.points[v] - shape.points[v]).norm() / length[v] / n;
  return result;
}

} // namespace rco_test
