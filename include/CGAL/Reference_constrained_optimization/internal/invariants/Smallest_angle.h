// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_SMALLEST_ANGLE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_SMALLEST_ANGLE_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// No angle of a triangle falls below the smallest one of the mesh before; angles below it do not decrease.
struct Smallest_angle : Invariant
{
  bool holds(const Trial& trial, Violating_vertices& violating) const
  {
    bool holds = true;
    for(int f = 0; f < trial.mesh().number_of_faces(); ++f)
    {
      const double cosine = trial.after.cosines[f];
      if(cosine > trial.limits.cosine && cosine > trial.before.cosines[f])
      {
        holds = false;
        violating.add_face(f);
      }
    }
    return holds;
  }
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_SMALLEST_ANGLE_H
