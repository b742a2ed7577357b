// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_PLANAR_OPTIMIZATION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_PLANAR_OPTIMIZATION_H

#include <CGAL/Reference_constrained_optimization/internal/numerics/projected_newton.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/drift_terms.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Patch.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Stencil_terms.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The minimization of a patch's energy in the plane (paper 3.4), in the metric of the surface: a sum
// of densities over triangles, with the Jacobian metric * (edge matrix in the plane) * rest_inverse.
// Projected_newton minimizes it.
struct Planar_problem
{
  std::vector<std::array<int, 3>> triples;
  std::vector<Eigen::Matrix2d> rest_inverse;
  std::vector<Eigen::Matrix2d> metric;
  std::vector<char> is_free;                      // per vertex
  std::vector<std::array<int, 3>> term_triangles; // of the drift barrier's terms
  Drift_terms drift;
  Stencil_terms stencils;
  std::vector<Vector_2> start; // per vertex: its position when the terms were collected
  const Vector_2& origin(int v) const { return start[v]; }
  // per vertex: the unit vector along which it slides, zero if it does not; empty if none does
  std::vector<Vector_2> sliding_direction;

  // elements and free vertices are those of a patch; the metric is a function of the element
  template <typename Metric>
  void set_elements(const Patch& patch, const Metric& metric_of)
  {
    triples.clear();
    rest_inverse.clear();
    metric.clear();
    is_free = patch.is_free;
    for(const Element_set::Element& e : patch.elements)
    {
      triples.push_back(e.vertices);
      rest_inverse.push_back(e.rest_inverse);
      metric.push_back(metric_of(e));
    }
  }

  // the shape of an element, and its derivative by a vertex
  Eigen::Matrix2d shape(std::size_t e, const std::vector<Vector_2>& u) const
  {
    return metric[e] * edges(u, triples[e]);
  }
  Eigen::Matrix2d corner_map(std::size_t e, int i) const
  {
    if(sliding_direction.empty())
      return metric[e];
    const Vector_2& d = sliding_direction[triples[e][i]];
    return d.isZero(0) ? metric[e] : Eigen::Matrix2d((metric[e] * d) * d.transpose());
  }

  static Eigen::Matrix2d edges(const std::vector<Vector_2>& u, const std::array<int, 3>& t)
  {
    Eigen::Matrix2d m;
    m.col(0) = u[t[1]] - u[t[0]];
    m.col(1) = u[t[2]] - u[t[0]];
    return m;
  }
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_PLANAR_OPTIMIZATION_H
