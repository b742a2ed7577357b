// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_SYMMETRIC_DIRICHLET_DENSITY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_SYMMETRIC_DIRICHLET_DENSITY_H

#include <CGAL/Reference_constrained_optimization/Isotropic_density.h>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is the symmetric Dirichlet density \f$ D(J) = \|J\|_F^2 + \|J^{-1}\|_F^2 \f$ of the paper's
 * equation (6), not halved: 4 at an isometry.
 *
 * It is the sum of \f$ \sigma^2 + \sigma^{-2} \f$ over the signed singular values. Below a threshold
 * of \f$ \sigma \f$ the second term is continued by its second-order Taylor polynomial: twice
 * continuously differentiable, decreasing, and finite for every Jacobian, inverted ones included.
 *
 * \cgalModels{DistortionDensity}
 */
class Symmetric_Dirichlet_density : public Isotropic_density<Symmetric_Dirichlet_density>
{
public:
  /// constructs the density. `threshold` is where the continuation starts, a positive number without
  /// unit.
  explicit Symmetric_Dirichlet_density(double threshold = 0.02) : m_threshold(threshold) {}

  /// value at the signed singular values.
  double singular_value_energy(double s1, double s2) const
  {
    return s1 * s1 + s2 * s2 + inverse_square(s1).value + inverse_square(s2).value;
  }

  /// value and derivatives at the signed singular values.
  Singular_value_jet jet(double s1, double s2) const
  {
    const Term a = inverse_square(s1), b = inverse_square(s2);
    Singular_value_jet result;
    result.value = s1 * s1 + s2 * s2 + a.value + b.value;
    result.d1 = 2 * s1 + a.first;
    result.d2 = 2 * s2 + b.first;
    result.d11 = 2 + a.second;
    result.d22 = 2 + b.second;
    return result;
  }

private:
  struct Term
  {
    double value, first, second;
  };

  Term inverse_square(double s) const
  {
    const double at = s < m_threshold ? m_threshold : s;
    const double i = 1 / at, v = i * i, slope = -2 * v * i, bend = 6 * v * v;
    if(s >= m_threshold)
      return {v, slope, bend};
    const double h = s - at;
    return {v + h * (slope + 0.5 * h * bend), slope + h * bend, bend};
  }

  double m_threshold;
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_SYMMETRIC_DIRICHLET_DENSITY_H
