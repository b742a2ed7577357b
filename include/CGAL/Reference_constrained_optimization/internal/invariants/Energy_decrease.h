// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_ENERGY_DECREASE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_ENERGY_DECREASE_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>

#include <cmath>
#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The energy falls, with and without the drift barrier, unless a defect is repaired. The vertices of
// elements whose density increases by much are violating.
struct Energy_decrease : Invariant
{
  bool holds(const Trial& trial, const Patch_measure& after, Violating_vertices& violating) const
  {
    const Patch_measure& before = trial.sums_before;
    if(after.defects() < before.defects() || after.is_lower_than(before))
      return true;
    const double tolerance = 4 * (std::abs(before.energy) / double(trial.patch.elements.size()));
    for(std::size_t e = 0; e < trial.patch.elements.size(); ++e)
    {
      const double old = trial.before.densities[e], now = trial.after.densities[e];
      if(now > 1.5 * old || now > old + tolerance)
        violating.add_element(e);
    }
    return false;
  }
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_ENERGY_DECREASE_H
