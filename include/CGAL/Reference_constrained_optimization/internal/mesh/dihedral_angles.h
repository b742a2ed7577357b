// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_DIHEDRAL_ANGLES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_DIHEDRAL_ANGLES_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/has_area.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Per corner, the dihedral angle at its edge in degrees: the angle between the normals of the two faces. 0
// at borders, and where one of the two faces is degenerate up to rounding.
inline std::vector<double> dihedral_angles(const Indexed_mesh& mesh,
                                           const std::vector<Vector_3>& points)
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
      normals[f] = face_vector_area(mesh, points, f).stableNormalized(); // also for tiny faces
  }
  std::vector<double> angles(mesh.number_of_corners(), 0);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(mesh.opposite[c] > c)
      angles[c] = angles[mesh.opposite[c]] =
        angle_between(normals[mesh.corner_face[c]], normals[mesh.corner_face[mesh.opposite[c]]]);
  return angles;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_DIHEDRAL_ANGLES_H
