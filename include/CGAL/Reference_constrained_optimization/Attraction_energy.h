// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ATTRACTION_ENERGY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ATTRACTION_ENERGY_H

#include <CGAL/Reference_constrained_optimization/Energy_stencil.h>
#include <CGAL/Reference_constrained_optimization/Invalid_input.h>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * pulls vertices towards points in space, as soft landmarks or data points do:
 * \f$ \sum_i w_i\,\|p_i - q_i\|^2 / h^2 \f$, where \f$ p_i \f$ is the position of a vertex,
 * \f$ q_i \f$ its target and \f$ h \f$ the mean edge length of the mesh.
 *
 * It is to be used as a summand: it does not depend on the shape of elements. At a distance of a mean edge
 * a target of weight 1 contributes 1; the density of an undistorted element is 4 for
 * `Symmetric_Dirichlet_density` and \f$ e^{2k} \f$ for `Exponential_MIPS_density`.
 *
 * \cgalModels{ReferenceConstrainedEnergy}
 */
class Attraction_energy
{
public:
  /// a vertex that is attracted.
  struct Target
  {
    std::size_t vertex;    ///< by its position in `vertices(mesh)`.
    Eigen::Vector3d point; ///< the point that attracts it, in units of length of the mesh.
    double weight = 1;     ///< without unit, finite and not negative.
  };

  /// number of vertices of a stencil.
  static constexpr int stencil_size = 1;

  /// constructs the energy. \throws Invalid_input if a coordinate or a weight is not finite, or a
  /// weight negative; the message names the target.
  explicit Attraction_energy(std::vector<Target> targets) : m_targets(std::move(targets))
  {
    for(std::size_t i = 0; i < m_targets.size(); ++i)
      if(!m_targets[i].point.allFinite() || !(m_targets[i].weight >= 0) ||
         !std::isfinite(m_targets[i].weight))
        throw Invalid_input("Attraction_energy: the point and the weight of target " +
                            std::to_string(i) + " must be finite, and the weight not negative");
  }

  /// appends one stencil for each target.
  template <typename Context>
  void append_stencils(const Context& context, std::vector<Energy_stencil<1>>& stencils) const
  {
    const double h = context.mean_edge_length();
    for(const Target& target : m_targets)
      stencils.push_back({{{target.vertex}}, target.weight / (h * h)});
  }

  /// the squared distance of `points[0]` from target `i`.
  double value(std::size_t i, const std::array<Eigen::Vector3d, 1>& points) const
  {
    return (points[0] - m_targets[i].point).squaredNorm();
  }

  /// value, gradient and Hessian.
  double projected_derivatives(std::size_t i,
                               const std::array<Eigen::Vector3d, 1>& points,
                               Eigen::Matrix<double, 3, 1>& gradient,
                               Eigen::Matrix<double, 3, 3>& hessian) const
  {
    gradient = 2 * (points[0] - m_targets[i].point);
    hessian = 2 * Eigen::Matrix3d::Identity();
    return value(i, points);
  }

private:
  std::vector<Target> m_targets;
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ATTRACTION_ENERGY_H
