// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_CORNER_ELEMENTS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_CORNER_ELEMENTS_H

#include <CGAL/Reference_constrained_optimization/Energy_element.h>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Appends the elements of a face of an energy for quads. A quad has one for each corner: the
// triangle of the corner and its two neighbours, at rest an isosceles right triangle. The four
// overlap; each of the two diagonals is the hypotenuse of two of them (paper 4.2). A triangle of a
// mixed mesh has one element, at rest equilateral with the same length of its sides.
inline void append_corner_elements(const Energy_context& context,
                                   std::size_t f,
                                   double leg_length,
                                   std::vector<Energy_element>& elements)
{
  Energy_element element;
  if(context.degree(f) == 3)
  {
    element.rest = equilateral_rest_triangle(leg_length);
    elements.push_back(element);
    return;
  }
  element.rest = leg_length * Eigen::Matrix2d::Identity();
  for(int i = 0; i < 4; ++i)
  {
    element.corners = {{i, (i + 1) % 4, (i + 3) % 4}};
    elements.push_back(element);
  }
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_CORNER_ELEMENTS_H
