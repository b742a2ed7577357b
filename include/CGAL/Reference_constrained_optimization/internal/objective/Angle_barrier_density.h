// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ANGLE_BARRIER_DENSITY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ANGLE_BARRIER_DENSITY_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Element_densities.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Densities (Element_densities) with a barrier on the angles of the elements that have this criterion: each
// angle a adds W exp(k (t - a)), t being the target, in degrees, k the steepness and W the element's
// density at rest. The rest triangle is treated as equilateral: angles are computed from the Jacobian.
// Beyond an exponent of 6 the exponential is continued by its second-order Taylor polynomial, so that a
// single sharp triangle does not dominate the sum; angles far above the target add nothing.
template <typename Density>
class Angle_barrier_density
{
public:
  Angle_barrier_density(const Density& density, double target, double steepness)
    : m_density(density),
      m_target(target),
      m_steepness(steepness)
  {
    for(int term = 0; term < density.number_of_terms(); ++term)
      density.visit(
        term, [&](const auto& d) { m_weights.push_back(d.value(Eigen::Matrix2d::Identity())); });
    m_equilateral << 1, 0.5, 0, std::sqrt(0.75);
    const double negligible = 20; // exponent
    m_negligible_cosine =
      std::cos((std::min)(180., target + negligible / steepness) / degrees_per_radian);
  }

  double target() const { return m_target; }

  double value(const Element_set::Element& element, const Eigen::Matrix2d& J) const
  {
    double sum = m_density.value(element, J);
    if(!element.has_criterion)
      return sum;
    const Angles angles(J * m_equilateral);
    const double weight = element.weight * m_weights[element.term];
    for(int i = 0; i < 3; ++i)
      if(angles.cosine(i) > m_negligible_cosine)
        sum += barrier(angles.value(i), weight).value;
    return sum;
  }

  double projected_derivatives(const Element_set::Element& element,
                               const Eigen::Matrix2d& J,
                               Eigen::Vector4d& gradient,
                               Eigen::Matrix4d& hessian) const
  {
    double sum = m_density.projected_derivatives(element, J, gradient, hessian);
    if(!element.has_criterion)
      return sum;
    const Angles angles(J * m_equilateral);
    const double weight = element.weight * m_weights[element.term];
    for(int i = 0; i < 3; ++i)
    {
      if(!(angles.cosine(i) > m_negligible_cosine))
        continue;
      const Jet b = barrier(angles.value(i), weight);
      const Eigen::Matrix2d by_jacobian = angles.derivative(i) * m_equilateral.transpose();
      const Eigen::Map<const Eigen::Vector4d> d(by_jacobian.data());
      sum += b.value;
      gradient += b.first * d;
      // the other part of the second derivative is dropped
      hessian += (b.second * d) * d.transpose();
    }
    return sum;
  }

private:
  // the three angles of a triangle with the given edge matrix, in degrees; negative if it is inverted
  struct Angles
  {
    Vector_2 a, b, c; // from vertex 0 to 1, 0 to 2 and 1 to 2
    double lengths[3];

    explicit Angles(const Eigen::Matrix2d& shape)
      : a(shape.col(0)),
        b(shape.col(1)),
        c(b - a),
        lengths{a.norm(), b.norm(), c.norm()}
    {}

    // cheaper than the angle; 1 for a side without length
    double cosine(int i) const
    {
      const double product = i == 0 ? a.dot(b) : (i == 1 ? -a.dot(c) : b.dot(c));
      const double length = lengths[i == 2] * lengths[i == 0 ? 1 : 2];
      return length > 0 ? product / length : 1;
    }

    double value(int i) const
    {
      return i == 0 ? between(a, b) : (i == 1 ? between(c, -a) : between(-b, -c));
    }

    // by the entries of the edge matrix
    Eigen::Matrix2d derivative(int i) const
    {
      Eigen::Matrix2d d;
      if(i == 0)
        d << -direction_derivative(a), direction_derivative(b);
      else if(i == 1)
        d << direction_derivative(a) + direction_derivative(c), -direction_derivative(c);
      else
        d << -direction_derivative(c), direction_derivative(c) - direction_derivative(b);
      return degrees_per_radian * d;
    }

  private:
    static double between(const Vector_2& p, const Vector_2& q)
    {
      return degrees_per_radian * std::atan2(p(0) * q(1) - p(1) * q(0), p.dot(q));
    }
    // the derivative of a vector's direction by the vector
    static Vector_2 direction_derivative(const Vector_2& p)
    {
      const double square = p.squaredNorm();
      return square > 0 ? Vector_2(-p(1) / square, p(0) / square) : Vector_2(0, 0);
    }
  };

  struct Jet
  {
    double value, first, second; // by the angle
  };

  Jet barrier(double angle, double weight) const
  {
    const double cap = 6, x = m_steepness * (m_target - angle);
    const double e = weight * std::exp(x < cap ? x : cap);
    const double h = x < cap ? 0 : x - cap;
    return {e * (1 + h * (1 + 0.5 * h)), -m_steepness * e * (1 + h), m_steepness * m_steepness * e};
  }

  const Density& m_density;
  double m_target, m_steepness, m_negligible_cosine = 1;
  std::vector<double> m_weights; // per term: the density at rest
  Eigen::Matrix2d m_equilateral;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ANGLE_BARRIER_DENSITY_H
