// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_MEAN_ANGLE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_MEAN_ANGLE_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Where the energy is about angles, the mean of the faces' smallest does not fall below that on input. A
// patch has a share, by its faces, of what the mesh has gained; a defect that is repaired may cost.
struct Mean_angle : Invariant
{
  void start(const Trial& trial)
  {
    const Optimization_state& state = trial.state;
    const double share = double(trial.patch.faces.size()) / double(state.mesh.number_of_faces());
    m_is_guarded = state.guards_angles;
    m_allowance = share * (std::max)(0., state.angle_surplus);
    m_is_first = true;
    m_angles.assign(m_is_guarded ? std::size_t(trial.mesh().number_of_faces()) : 0, 0);
  }

  void measure(const Trial& trial)
  {
    if(!m_is_guarded)
      return;
    for(const int f : trial.changed)
      m_angles.after[f] = degrees_per_radian * std::acos((std::min)(1., trial.after.cosines[f]));
    m_sum = 0;
    for(const double angle : m_angles.after)
      m_sum += angle;
  }

  void accept()
  {
    m_angles.accept();
    if(m_is_first)
      m_least = m_sum - m_allowance;
    m_is_first = false;
  }

  void sum_up(const Trial&, Patch_measure& measure) const { measure.angles = m_sum; }

  // the faces whose angles fall are to blame
  bool holds(const Trial& trial, const Patch_measure& after, Violating_vertices& violating) const
  {
    const int repaired = trial.sums_before.defects() - after.defects();
    if(!m_is_guarded || m_sum >= m_least - 60. * (std::max)(0, repaired))
      return true;
    const double little = 0.1; // degrees
    for(int f = 0; f < trial.mesh().number_of_faces(); ++f)
      if(m_angles.after[f] < m_angles.before[f] - little)
        violating.add_face(f);
    return false;
  }

private:
  bool m_is_guarded = false, m_is_first = true;
  Compared<double> m_angles; // per face: its smallest, in degrees
  double m_sum = 0, m_least = 0, m_allowance = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_MEAN_ANGLE_H
