// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_NORMAL_DEVIATION_BOUND_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_NORMAL_DEVIATION_BOUND_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/face_normal_deviation.h>

#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// On mechanical parts the normal deviation of faces from R is bounded; deviations beyond the bound do not
// increase.
struct Normal_deviation_bound : Invariant
{
  void start(const Trial& trial)
  {
    m_deviations.assign(trial.patch.bounds_normal_deviation.size(), 0);
  }

  void measure(const Trial& trial)
  {
    if(m_deviations.after.empty())
      return;
    for(const int f : trial.changed)
      if(trial.patch.bounds_normal_deviation[f])
        m_deviations.after[f] = face_normal_deviation(trial.mesh(), trial.state.reference, trial, f,
                                                      trial.after.normals[f]);
  }

  void accept() { m_deviations.accept(); }

  bool holds(const Trial&, Violating_vertices& violating) const
  {
    const double largest_deviation = 20;
    bool holds = true;
    for(std::size_t f = 0; f < m_deviations.after.size(); ++f)
      if(m_deviations.after[f] > largest_deviation && m_deviations.has_increased(f))
      {
        holds = false;
        violating.add_face(int(f));
      }
    return holds;
  }

private:
  Compared<double> m_deviations; // per face, in degrees
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_NORMAL_DEVIATION_BOUND_H
