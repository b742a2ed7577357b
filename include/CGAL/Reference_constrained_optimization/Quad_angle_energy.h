// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUAD_ANGLE_ENERGY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUAD_ANGLE_ENERGY_H

#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/corner_elements.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * drives the four corner triangles of every quad towards isosceles right triangles of any size:
 * \f$ \sum_f \sum_{i=1}^4 \exp(k\,\|J_{f,i}\|_F^2 / \det J_{f,i}) \f$, the density of the paper's
 * equation (8) on the corner triangles of its equation (7).
 *
 * Every quad is driven towards a square, but squares may be of different sizes: angles come out
 * better than with `Quad_regularity_energy`, edge lengths less even. A larger exponent factor `k`
 * weighs the worst corners more. Triangles of a mixed mesh are driven towards equilateral ones.
 *
 * \cgalModels{ReferenceConstrainedEnergy}
 */
class Quad_angle_energy
{
public:
  /// model of `DistortionDensity`.
  typedef Exponential_MIPS_density Density;

  /// constructs the energy. \param exponent_factor the factor `k`, a positive number without unit.
  /// \throws Invalid_input if it is not positive and finite.
  explicit Quad_angle_energy(double exponent_factor = 1) : m_density(checked(exponent_factor)) {}

  /// the density.
  const Density& density() const { return m_density; }

  /// appends the four elements of quad `f`, or the one of a triangle.
  void append_elements(const Energy_context& context,
                       std::size_t f,
                       std::vector<Energy_element>& elements) const
  {
    // the density is invariant to scale; the mean edge length keeps numbers near one
    internal::append_corner_elements(context, f, context.mean_edge_length(), elements);
  }

private:
  static double checked(double factor)
  {
    if(!(factor > 0) || !std::isfinite(factor))
      throw Invalid_input("Quad_angle_energy: the exponent factor must be positive and finite");
    return factor;
  }

  Density m_density;
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUAD_ANGLE_ENERGY_H
