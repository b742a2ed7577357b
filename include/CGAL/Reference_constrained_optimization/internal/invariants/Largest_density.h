// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_LARGEST_DENSITY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_LARGEST_DENSITY_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>

#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// No density exceeds the largest one of the mesh before; densities beyond it do not increase.
struct Largest_density : Invariant
{
  bool holds(const Trial& trial, Violating_vertices& violating) const
  {
    bool holds = true;
    for(std::size_t e = 0; e < trial.patch.elements.size(); ++e)
    {
      const double density = trial.after.densities[e];
      if(density > trial.limits.density && density > trial.before.densities[e])
      {
        holds = false;
        violating.add_element(e);
      }
    }
    return holds;
  }
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_LARGEST_DENSITY_H
