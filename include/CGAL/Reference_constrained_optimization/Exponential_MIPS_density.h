// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_EXPONENTIAL_MIPS_DENSITY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_EXPONENTIAL_MIPS_DENSITY_H

#include <CGAL/Reference_constrained_optimization/Isotropic_density.h>

#include <cmath>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is the density \f$ D(J) = \exp(k\,\|J\|_F^2 / \det J) \f$ of the paper's equation (8), where
 * `k` is the exponent factor. It does not depend on scale; its minimum is \f$ e^{2k} \f$, at
 * similarities.
 *
 * With \f$ r = \det J / \|J\|_F^2 \in [-1/2, 1/2] \f$ the density is \f$ \exp(k / r) \f$. Where the
 * exponent \f$ k / r \f$ exceeds the cap \f$ 2k + 18 \f$ it is continued by its second-order Taylor
 * polynomial in `r`: twice continuously differentiable, decreasing in `r`, and finite for every
 * Jacobian, inverted ones included.
 *
 * \cgalModels{DistortionDensity}
 */
class Exponential_MIPS_density : public Isotropic_density<Exponential_MIPS_density>
{
public:
  /// constructs the density. `exponent_factor` must be positive.
  explicit Exponential_MIPS_density(double exponent_factor = 1)
    : Exponential_MIPS_density(exponent_factor, 2 * exponent_factor + 18)
  {}

  /// constructs the density with another cap of the exponent, which must exceed `2 * exponent_factor`.
  Exponential_MIPS_density(double exponent_factor, double cap)
    : m_factor(exponent_factor),
      m_cap(cap),
      m_threshold(m_factor / m_cap)
  {}

  /// the factor `k`.
  double exponent_factor() const { return m_factor; }

  /// the density of `J`, without its singular values.
  double value(const Eigen::Matrix2d& J) const
  {
    const double a = J(0, 0), b = J(1, 0), c = J(0, 1), d = J(1, 1);
    return at(a * d - b * c, a * a + b * b + c * c + d * d);
  }

  /// value at the signed singular values.
  double singular_value_energy(double s1, double s2) const
  {
    return at(s1 * s2, s1 * s1 + s2 * s2);
  }

  /// value and derivatives at the signed singular values.
  Singular_value_jet jet(double s1, double s2) const
  {
    Singular_value_jet result;
    const double n = s1 * s1 + s2 * s2;
    if(!(n > 0))
    {
      result.value = of_ratio(0).value;
      return result;
    }
    const double i = 1 / n;
    const double product = s1 * s2, a = s1 * s1, b = s2 * s2;
    const double r = product / n; // also where the inverse is infinite
    const Ratio_jet f = of_ratio(r);
    // derivatives of r = s1 s2 / (s1^2 + s2^2)
    const double w = (b - a) * i * i;
    const double r1 = s2 * w, r2 = -s1 * w;
    const double i3 = i * i * i;
    const double r11 = 2 * product * (a - 3 * b) * i3;
    const double r22 = 2 * product * (b - 3 * a) * i3;
    const double r12 = (6 * a * b - a * a - b * b) * i3;
    result.value = f.value;
    result.d1 = f.first * r1;
    result.d2 = f.first * r2;
    result.d11 = f.second * r1 * r1 + f.first * r11;
    result.d12 = f.second * r1 * r2 + f.first * r12;
    result.d22 = f.second * r2 * r2 + f.first * r22;
    return result;
  }

private:
  double at(double determinant, double squared_norm) const
  {
    const double r = squared_norm > 0 ? determinant / squared_norm : 0;
    return r < m_threshold ? of_ratio(r).value : std::exp(m_factor * (1 / r));
  }

  struct Ratio_jet
  {
    double value, first, second;
  };

  Ratio_jet of_ratio(double r) const
  {
    const double at = r < m_threshold ? m_threshold : r;
    const double i = 1 / at, e = std::exp(m_factor * i);
    const double slope = -m_factor * i * i * e;
    const double bend = (m_factor * i + 2) * m_factor * i * i * i * e;
    if(r >= m_threshold)
      return {e, slope, bend};
    const double h = r - at;
    return {e + h * (slope + 0.5 * h * bend), slope + h * bend, bend};
  }

  double m_factor;
  double m_cap;
  double m_threshold;
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_EXPONENTIAL_MIPS_DENSITY_H
