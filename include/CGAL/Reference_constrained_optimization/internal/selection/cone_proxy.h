// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_CONE_PROXY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_CONE_PROXY_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <Eigen/Eigenvalues>

#include <cmath>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Planes, cylinders and cones as a proxy (n, theta): every normal makes the angle theta with the
// axis n (paper, eq. 3 and 4).
struct Cone_proxy
{
  Vector_3 axis = Vector_3::UnitZ();
  double cosine = 1;
  double mean_cost = 0;

  // eq. (3); `normal` is of unit length
  double cost(const Vector_3& normal) const
  {
    const double d = axis.dot(normal) - cosine;
    return d * d;
  }
};

// Running sums from which the best proxy of a set of faces follows in closed form: for a fixed axis
// the best cosine is the area-weighted mean of the dot products, which makes eq. (4) a quadratic
// form in the axis, with the weighted covariance of the normals as its matrix.
class Cone_proxy_fit
{
public:
  void add(const Vector_3& normal, double area)
  {
    m_area += area;
    m_sum += area * normal;
    m_outer.noalias() += area * normal * normal.transpose();
  }

  Cone_proxy fit() const
  {
    Cone_proxy proxy;
    if(!(m_area > 0))
      return proxy;
    const Vector_3 mean = m_sum / m_area;
    const Eigen::Matrix3d covariance = m_outer / m_area - mean * mean.transpose();
    // On a plane any axis fits: a small weight makes it the mean normal there.
    const double length = mean.norm();
    const double tie = 1e-6;
    Eigen::Matrix3d quadric = covariance;
    if(length > 0)
      quadric += tie * (Eigen::Matrix3d::Identity() - mean * mean.transpose() / (length * length));
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(quadric);
    proxy.axis = solver.eigenvectors().col(0).normalized();
    if(!proxy.axis.allFinite())
    {
      solver.compute(quadric);
      proxy.axis = solver.eigenvectors().col(0).normalized();
    }
    proxy.cosine = proxy.axis.dot(mean);
    if(proxy.cosine < 0)
    {
      proxy.axis = -proxy.axis;
      proxy.cosine = -proxy.cosine;
    }
    proxy.mean_cost = (std::max)(0., proxy.axis.dot(covariance * proxy.axis));
    return proxy;
  }

private:
  double m_area = 0;
  Vector_3 m_sum = Vector_3::Zero();
  Eigen::Matrix3d m_outer = Eigen::Matrix3d::Zero();
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_CONE_PROXY_H
