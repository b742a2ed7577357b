// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_MINIMUM_ANGLE_ENERGY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_MINIMUM_ANGLE_ENERGY_H

#include <CGAL/Reference_constrained_optimization/Energy_element.h>
#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/Invalid_input.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * drives every triangle towards an equilateral one, with the largest cost for the worst: equation (8) of
 * the paper, \f$ \sum_f \exp(k\,\|J_f\|_F^2 / \det J_f) \f$, with \f$ J_f \f$ the Jacobian of the map from
 * an equilateral triangle to face `f`.
 *
 * A larger exponent factor `k` raises the minimum angle further, at the cost of the mean. On mechanical
 * parts whose features are detected a tenth of it is used.
 * Every face must be a triangle.
 *
 * \cgalModels{ReferenceConstrainedEnergy}
 */
class Minimum_angle_energy
{
public:
  /// model of `DistortionDensity`.
  typedef Exponential_MIPS_density Density;
  /// the criterion for the worst elements is the smallest angle.
  static constexpr Element_criterion element_criterion = Element_criterion::smallest_angle;

  /// constructs the energy. \param exponent_factor the factor `k`, a positive number; 1 is the
  /// paper's. \throws Invalid_input if it is not positive and finite.
  explicit Minimum_angle_energy(double exponent_factor = 1) : m_density(checked(exponent_factor)) {}

  /// the density.
  const Density& density() const { return m_density; }

  /// appends the one element of face `f`. \throws Invalid_input if `f` is not a triangle.
  void append_elements(const Energy_context& context,
                       std::size_t f,
                       std::vector<Energy_element>& elements) const
  {
    if(context.degree(f) != 3)
      throw Invalid_input("Minimum_angle_energy: face " + std::to_string(f) + " has " +
                          std::to_string(context.degree(f)) + " vertices, but must be a triangle");
    Energy_element element;
    // the density is invariant to scale; the mean edge length keeps numbers near one
    element.rest = equilateral_rest_triangle(context.mean_edge_length());
    elements.push_back(element);
  }

private:
  static double checked(double factor)
  {
    if(!(factor > 0) || !std::isfinite(factor))
      throw Invalid_input("Minimum_angle_energy: the exponent factor must be positive and finite");
    return factor;
  }

  Density m_density;
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_MINIMUM_ANGLE_ENERGY_H
