// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_EDGE_TURN_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_EDGE_TURN_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/has_area.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Per corner, by how many degrees the surface turns at its edge: the angle between the normals of the
// faces on both sides. 0 at borders, and where one of the two faces is a line but for rounding.
inline std::vector<double> edge_turns(const Indexed_mesh& mesh, const std::vector<Vector_3>& points)
{
  const auto point = [&](int v) -> const Vector_3& { return points[v]; };
  const double rounding =
    4 * std::numeric_limits<double>::epsilon() * largest_coordinate(mesh, point);
  std::vector<Vector_3> normals(mesh.number_of_faces(), Vector_3::Zero());
  for(int f = 0; f < mesh.number_of_faces(); ++f)
  {
    double height = 0;
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      height = (std::max)(height, height_at_corner(mesh, point, c));
    if(height > rounding)
      normals[f] = face_vector_area(mesh, points, f).stableNormalized(); // of tiny faces, too
  }
  std::vector<double> turns(mesh.number_of_corners(), 0);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(mesh.opposite[c] > c)
      turns[c] = turns[mesh.opposite[c]] =
        angle_between(normals[mesh.corner_face[c]], normals[mesh.corner_face[mesh.opposite[c]]]);
  return turns;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_EDGE_TURN_H
