// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_PROJECTED_DERIVATIVES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_PROJECTED_DERIVATIVES_H

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <cstddef>
#include <type_traits>
#include <utility>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Value, gradient (column-major) and positive semi-definite Hessian of a density: the density's own
// closed form if it has one, else the eigen-decomposition of its Hessian.
template <typename Density>
auto projected_derivatives(const Density& density,
                           const Eigen::Matrix2d& J,
                           Eigen::Vector4d& gradient,
                           Eigen::Matrix4d& hessian,
                           int) -> decltype(density.projected_derivatives(J, gradient, hessian))
{
  return density.projected_derivatives(J, gradient, hessian);
}

template <typename Density>
double projected_derivatives(const Density& density,
                             const Eigen::Matrix2d& J,
                             Eigen::Vector4d& gradient,
                             Eigen::Matrix4d& hessian,
                             long)
{
  const Eigen::Matrix2d g = density.gradient(J);
  gradient = Eigen::Map<const Eigen::Vector4d>(g.data());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(density.hessian(J));
  const Eigen::Matrix4d& vectors = solver.eigenvectors();
  hessian = vectors * solver.eigenvalues().cwiseMax(0.).asDiagonal() * vectors.transpose();
  return density.value(J);
}

// The same, and the value, of an element by its index, or of a density.
template <typename Elements>
auto value_of(const Elements& elements, std::size_t e, const Eigen::Matrix2d& J, int)
  -> decltype(elements.value(e, J))
{
  return elements.value(e, J);
}
template <typename Density>
double value_of(const Density& density, std::size_t, const Eigen::Matrix2d& J, long)
{
  return density.value(J);
}
template <typename Elements>
auto derivatives_of(const Elements& elements,
                    std::size_t e,
                    const Eigen::Matrix2d& J,
                    Eigen::Vector4d& gradient,
                    Eigen::Matrix4d& hessian,
                    int) -> decltype(elements.value(e, J))
{
  return elements.projected_derivatives(e, J, gradient, hessian);
}
template <typename Density>
double derivatives_of(const Density& density,
                      std::size_t,
                      const Eigen::Matrix2d& J,
                      Eigen::Vector4d& gradient,
                      Eigen::Matrix4d& hessian,
                      long)
{
  return projected_derivatives(density, J, gradient, hessian, 0);
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_PROJECTED_DERIVATIVES_H
