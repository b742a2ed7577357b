// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ISOTROPIC_DENSITY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ISOTROPIC_DENSITY_H

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds value and partial derivatives of a function of the two signed singular values.
 */
struct Singular_value_jet
{
  double value = 0;                 ///< the value.
  double d1 = 0, d2 = 0;            ///< first derivatives.
  double d11 = 0, d12 = 0, d22 = 0; ///< second derivatives.
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * turns a symmetric function of the signed singular values \f$ \sigma_1 \ge |\sigma_2| \f$ of a
 * 2x2 matrix into a model of `DistortionDensity` (a CRTP base class).
 *
 * `Derived` provides `Singular_value_jet jet(double s1, double s2) const` and
 * `double singular_value_energy(double s1, double s2) const`. Gradient, Hessian and the projection
 * of the Hessian onto the positive semi-definite matrices are then closed formulas: with
 * \f$ J = U\,\mathrm{diag}(\sigma)\,V^T \f$, two eigenvectors of the Hessian are the twist and the
 * flip \f$ U\,[0, \mp 1; 1, 0]\,V^T / \sqrt 2 \f$ with eigenvalues
 * \f$ (f_1 + f_2) / (\sigma_1 + \sigma_2) \f$ and \f$ (f_1 - f_2) / (\sigma_1 - \sigma_2) \f$; the
 * other two span the plane of \f$ U\,\mathrm{diag}(\cdot)\,V^T \f$ (Smith, De Goes and Kim,
 * \e Analytic \e Eigensystems \e for \e Isotropic \e Distortion \e Energies, 2019).
 *
 * \cgalModels{DistortionDensity}
 */
template <typename Derived>
class Isotropic_density
{
public:
  /// value at the Jacobian `J` (2x2).
  double value(const Eigen::Matrix2d& J) const
  {
    const Singular_values d(J);
    return derived().singular_value_energy(d.s1, d.s2);
  }

  /// gradient with respect to the entries of `J` (2x2).
  Eigen::Matrix2d gradient(const Eigen::Matrix2d& J) const
  {
    const Decomposition d(J);
    const Singular_value_jet f = derived().jet(d.s1, d.s2);
    return f.d1 * d.u1 * d.v1.transpose() + f.d2 * d.u2 * d.v2.transpose();
  }

  /// Hessian with respect to the entries of `J` in column-major order (4x4).
  Eigen::Matrix4d hessian(const Eigen::Matrix2d& J) const
  {
    Eigen::Vector4d g;
    Eigen::Matrix4d H;
    derivatives(J, g, H, false);
    return H;
  }

  /// value, gradient (column-major, 4) and the projection of the Hessian onto the positive
  /// semi-definite matrices (4x4), in one go.
  double projected_derivatives(const Eigen::Matrix2d& J,
                               Eigen::Vector4d& gradient,
                               Eigen::Matrix4d& hessian) const
  {
    return derivatives(J, gradient, hessian, true);
  }

private:
  // of the similarity part (e, h) and the anti-similarity part (f, g) of J the norms q and r, whose
  // sum and difference are the singular values
  struct Singular_values
  {
    double e, f, g, h, q, r;
    double s1, s2;

    explicit Singular_values(const Eigen::Matrix2d& J)
      : e(0.5 * (J(0, 0) + J(1, 1))),
        f(0.5 * (J(0, 0) - J(1, 1))),
        g(0.5 * (J(1, 0) + J(0, 1))),
        h(0.5 * (J(1, 0) - J(0, 1))),
        q(std::sqrt(e * e + h * h)),
        r(std::sqrt(f * f + g * g)),
        s1(q + r),
        s2(q - r)
    {}
  };

  struct Decomposition
  {
    double s1, s2;
    Eigen::Vector2d u1, u2, v1, v2;

    explicit Decomposition(const Eigen::Matrix2d& J)
    {
      const Singular_values s(J);
      s1 = s.s1;
      s2 = s.s2;
      // unit vectors of the sum and the difference of the rotation angles of U and V, from the two
      // parts of J; halves are taken through the half-angle formulas
      const double c1 = s.r > 0 ? s.f / s.r : 1, w1 = s.r > 0 ? s.g / s.r : 0; // alpha + beta
      const double c2 = s.q > 0 ? s.e / s.q : 1, w2 = s.q > 0 ? s.h / s.q : 0; // alpha - beta
      const Eigen::Vector2d sum = half_angle(c1, w1), difference = half_angle(c2, w2);
      const double cu = sum(0) * difference(0) - sum(1) * difference(1);
      const double su = sum(1) * difference(0) + sum(0) * difference(1);
      const double cv = sum(0) * difference(0) + sum(1) * difference(1);
      const double sv = sum(1) * difference(0) - sum(0) * difference(1);
      u1 << cu, su;
      u2 << -su, cu;
      v1 << cv, sv;
      v2 << -sv, cv;
    }

    static Eigen::Vector2d half_angle(double c, double s)
    {
      if(c >= 0)
      {
        const double ch = std::sqrt(0.5 * (1 + c));
        return Eigen::Vector2d(ch, 0.5 * s / ch);
      }
      const double sh = std::sqrt(0.5 * (1 - c)) * (s < 0 ? -1 : 1);
      return Eigen::Vector2d(0.5 * s / sh, sh);
    }
  };

  static Eigen::Vector4d outer(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
  {
    return Eigen::Vector4d(a(0) * b(0), a(1) * b(0), a(0) * b(1), a(1) * b(1));
  }

  double derivatives(const Eigen::Matrix2d& J,
                     Eigen::Vector4d& gradient,
                     Eigen::Matrix4d& hessian,
                     bool project) const
  {
    const Decomposition d(J);
    const Singular_value_jet f = derived().jet(d.s1, d.s2);
    const Eigen::Vector4d e1 = outer(d.u1, d.v1), e2 = outer(d.u2, d.v2);
    const Eigen::Vector4d a = outer(d.u1, d.v2), b = outer(d.u2, d.v1);
    gradient = f.d1 * e1 + f.d2 * e2;

    // the quotients are dominated by rounding near coinciding singular values: take the limits there
    const double scale = (std::max)(std::abs(d.s1), std::abs(d.s2));
    double twist = d.s1 + d.s2 > 1e-9 * scale ? (f.d1 + f.d2) / (d.s1 + d.s2) : f.d11 + f.d12;
    double flip = d.s1 - d.s2 > 1e-6 * scale ? (f.d1 - f.d2) / (d.s1 - d.s2) : f.d11 - f.d12;
    double h11 = f.d11, h12 = f.d12, h22 = f.d22;
    if(project)
    {
      twist = (std::max)(twist, 0.);
      flip = (std::max)(flip, 0.);
      const double mean = 0.5 * (h11 + h22), half = 0.5 * (h11 - h22);
      const double radius = std::sqrt(half * half + h12 * h12);
      const double low = mean - radius, high = mean + radius;
      if(high <= 0)
        h11 = h12 = h22 = 0;
      else if(low < 0)
      {
        // high times the projector onto its eigenvector
        const double k = high / (2 * radius);
        h22 = k * (radius - half);
        h11 = k * (radius + half);
        h12 = k * h12;
      }
    }
    const Eigen::Vector4d t = b - a, s = b + a;
    hessian.noalias() = (0.5 * twist * t) * t.transpose();
    hessian.noalias() += (0.5 * flip * s) * s.transpose();
    hessian.noalias() += (h11 * e1 + h12 * e2) * e1.transpose();
    hessian.noalias() += (h12 * e1 + h22 * e2) * e2.transpose();
    return f.value;
  }

  const Derived& derived() const { return static_cast<const Derived&>(*this); }
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ISOTROPIC_DENSITY_H
