#pragma once

#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

// The shape of a mesh: closest points and normals.
class Shape
{
public:
  explicit Shape(const Mesh& mesh)
    : m_surface(
        RCO::internal::read_measured_mesh(mesh, CGAL::parameters::default_values(), "shape"))
  {}
  Kernel::Point_3 project(const Kernel::Point_3& p) const
  {
    const Eigen::Vector3d q = closest(p).position;
    return Kernel::Point_3(q.x(), q.y(), q.z());
  }
  Kernel::Vector_3 normal(const Kernel::Point_3& p) const
  {
    const Eigen::Vector3d n = m_surface.normal(closest(p)).normalized();
    return Kernel::Vector_3(n.x(), n.y(), n.z());
  }

private:
  RCO::internal::Surface_point closest(const Kernel::Point_3& p) const
  {
    return m_surface.closest(Eigen::Vector3d(p.x(), p.y(), p.z()));
  }
  RCO::internal::Reference_surface m_surface;
};
