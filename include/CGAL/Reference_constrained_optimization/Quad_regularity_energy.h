// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUAD_REGULARITY_ENERGY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUAD_REGULARITY_ENERGY_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/Symmetric_Dirichlet_density.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/corner_elements.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * drives the four corner triangles of every quad towards one and the same isosceles right triangle:
 * equation (7) of the paper, \f$ \sum_f \sum_{i=1}^4 \|J_{f,i}\|_F^2 + \|J_{f,i}^{-1}\|_F^2 \f$,
 * with \f$ J_{f,i} \f$ the Jacobian of the map from an isosceles right triangle with legs
 * \f$ l\,\bar e \f$ to the triangle of corner `i` of face `f` and the corner's two neighbours;
 * \f$ \bar e \f$ is the mean edge length of the input mesh.
 *
 * Angles and edge lengths are made uniform together. With \f$ l = 1 \f$ stretched and shrunk edges cost the
 * same; with a large \f$ l \f$ short edges and flat corners cost most. Where irregular vertices do not
 * allow right angles and equal lengths at the same time, `Quad_angle_energy` optimizes the angles alone.
 * Triangles of a mixed mesh are driven towards equilateral ones with sides \f$ l\,\bar e \f$.
 *
 * \cgalModels{ReferenceConstrainedEnergy}
 */
class Quad_regularity_energy
{
public:
  /// model of `DistortionDensity`.
  typedef Symmetric_Dirichlet_density Density;

  /// constructs the energy. \param leg_length_factor the factor \f$ l \f$, in mean edge lengths of
  /// the input mesh, a positive number; 5 is the paper's. \throws Invalid_input if it is not
  /// positive and finite.
  explicit Quad_regularity_energy(double leg_length_factor = 5)
    : m_leg_length_factor(checked(leg_length_factor)),
      // at the same shape of the mesh's triangles, whatever the legs of the rest triangle
      m_density(0.02 / leg_length_factor)
  {}

  /// the factor \f$ l \f$.
  double leg_length_factor() const { return m_leg_length_factor; }

  /// the density.
  const Density& density() const { return m_density; }

  /// appends the four elements of quad `f`, or the one of a triangle.
  void append_elements(const Energy_context& context,
                       std::size_t f,
                       std::vector<Energy_element>& elements) const
  {
    internal::append_corner_elements(context, f, m_leg_length_factor * context.mean_edge_length(),
                                     elements);
  }

private:
  static double checked(double factor)
  {
    if(!(factor > 0) || !std::isfinite(factor))
      throw Invalid_input(
        "Quad_regularity_energy: the leg length factor must be positive and finite");
    return factor;
  }

  double m_leg_length_factor;
  Density m_density;
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUAD_REGULARITY_ENERGY_H
