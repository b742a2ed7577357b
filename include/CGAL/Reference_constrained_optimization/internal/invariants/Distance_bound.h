// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_DISTANCE_BOUND_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_DISTANCE_BOUND_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/update_samples.h>

#include <cmath>
#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The distances between mesh and R at the samples do not exceed their bounds; those that do on input do not
// increase.
struct Distance_bound : Invariant
{
  void start(const Trial& trial)
  {
    m_now = trial.samples;
    m_is_known = true;
  }

  void measure(const Trial& trial)
  {
    const bool is_known = m_is_known;
    m_is_known = false;
    if(is_known)
      return;
    update_samples(trial.patch, trial.samples, trial.state.reference, trial.located, trial.changed,
                   trial.is_changed, m_now);
    update_projected_samples(trial.patch, trial.samples, trial.state.reference, trial.located,
                             trial.changed, m_now);
  }

  void sum_up(const Trial&, Patch_measure& measure) const { measure.drift_energy = m_now.energy(); }

  bool holds(const Trial& trial, Violating_vertices& violating) const
  {
    const Patch_samples& before = trial.samples;
    // a barrier energy that exceeds that of an element by much counts as a violation
    const double tolerance =
      0.5 * std::abs(trial.sums_before.energy) / double(trial.patch.elements.size());
    bool holds = true;
    const auto visit = [&](double distance, double bound, double old, double old_bound) {
      if(!(distance * old_bound > old * bound) || !Drift_barrier::is_active(distance, bound))
        return false;
      const bool is_beyond = distance > Drift_barrier::limit_factor * bound;
      holds = holds && !is_beyond;
      return is_beyond || before.barrier.value(distance, bound) >
                            before.barrier.value(old, old_bound) + tolerance;
    };
    for(std::size_t s = 0; s < m_now.samples.size(); ++s)
      if(visit(m_now.samples[s].distance, m_now.samples[s].bound, before.samples[s].distance,
               before.samples[s].bound))
        violating.add_triangle(int(s / 4));
    for(std::size_t i = 0; i < m_now.projected_samples.size(); ++i)
      if(visit(m_now.projected_samples[i].distance, m_now.projected_samples[i].bound,
               before.projected_samples[i].distance, before.projected_samples[i].bound))
        violating.add_face(m_now.projected_samples[i].polygon);
    return holds;
  }

  const Patch_samples& now() const { return m_now; }

private:
  Patch_samples m_now;
  bool m_is_known = false; // the gathered samples are those of the first measurement
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_DISTANCE_BOUND_H
