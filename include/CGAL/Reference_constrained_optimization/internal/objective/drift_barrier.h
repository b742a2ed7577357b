// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_DRIFT_BARRIER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_DRIFT_BARRIER_H

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The energy of a sample of one surface at a distance r from the other one: with u = ((r - a) / (b - a))^2
// for a bound b it is w u^2 / (1 - u), and zero below a, a fraction of b. It is continued quadratically in
// u beyond u = 0.6: it is soft, since a stiffer one would slow down Newton's method, and finite for inputs
// beyond the bound. No step may move a sample beyond `limit_factor` b.
class Drift_barrier
{
public:
  // `weight` is an energy
  explicit Drift_barrier(double weight = 0) : m_weight(weight) {}

  static constexpr double activation_factor = 0.6, limit_factor = 1.1;

  static bool is_active(double distance, double bound)
  {
    return distance > activation_factor * bound;
  }

  double value(double distance, double bound) const
  {
    const double x = (distance - activation_factor * bound) / ((1 - activation_factor) * bound);
    return x > 0 ? m_weight * jet(x * x).value : 0;
  }

  struct Derivatives
  {
    double value = 0, first = 0, second = 0;
  };

  // by the distance
  Derivatives derivatives(double distance, double bound) const
  {
    Derivatives d;
    const double k = 1 / ((1 - activation_factor) * bound);
    const double x = k * (distance - activation_factor * bound);
    if(!(x > 0))
      return d;
    const Derivatives f = jet(x * x);
    d.value = m_weight * f.value;
    d.first = m_weight * f.first * 2 * x * k;
    d.second = m_weight * (f.second * 4 * x * x + 2 * f.first) * k * k;
    return d;
  }

private:
  static Derivatives jet(double u)
  {
    const double last = 0.6;
    const double v = u < last ? u : last, rest = 1 - v;
    Derivatives d;
    d.value = v * v / rest;
    d.first = v * (2 - v) / (rest * rest);
    d.second = 2 / (rest * rest * rest);
    if(u > last)
    {
      d.value += (u - last) * (d.first + 0.5 * d.second * (u - last));
      d.first += d.second * (u - last);
    }
    return d;
  }

  double m_weight;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_DRIFT_BARRIER_H
