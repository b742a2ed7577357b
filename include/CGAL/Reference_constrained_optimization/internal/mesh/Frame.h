// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_FRAME_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_FRAME_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>

#include <cmath>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Coordinates near the origin, in a unit of length that is about the reference's diagonal. The unit is a
// power of two, and where the reference is not near the caller's origin the frame's is in its middle, so close
// that differences are exact: nothing near the reference is rounded on the way in, nor on the way back if it
// did not move. What moved is rounded to the caller's coordinates if these have another origin.
class Frame
{
public:
  explicit Frame(const Mesh_copy& reference)
  {
    const Eigen::AlignedBox3d box = bounding_box(reference.mesh, reference.points);
    const double diagonal = box.diagonal().norm();
    if(!is_safe_diagonal(diagonal))
      return; // it is rejected later
    int exponent = 0;
    std::frexp(diagonal, &exponent);
    m_unit = std::ldexp(1., exponent);
    const double far = 8;
    for(int i = 0; i < 3; ++i)
      if(std::abs(box.center()(i)) >= far * diagonal)
        m_origin(i) = box.center()(i);
  }

  // of length, in that of the user
  double unit() const { return m_unit; }
  // distance of the user's origin, which determines the rounding of coordinates
  double distance_of_origin() const { return m_origin.cwiseAbs().maxCoeff() / m_unit; }

  Vector_3 operator()(const Vector_3& given) const { return (given - m_origin) / m_unit; }
  Vector_3 to_user(const Vector_3& p) const { return m_unit * p + m_origin; }

  // transforms the points of a mesh to the frame
  void transform(Mesh_copy& copy) const
  {
    for(Vector_3& p : copy.points)
      p = (*this)(p);
  }

private:
  double m_unit = 1;
  Vector_3 m_origin = Vector_3::Zero();
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_FRAME_H
