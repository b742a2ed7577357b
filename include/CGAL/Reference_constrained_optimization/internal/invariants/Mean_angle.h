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

// For angle energies, the mean of the faces' smallest angles does not fall below that of the input. A patch
// may use a share, by its number of faces, of the gain of the mesh; the repair of a defect may cost more.
struct Mean_angle : Invariant
{
  void start(const Trial& trial)
  {
    const Optimization_state& state = trial.state;
    const double share = double(trial.patch.faces.size()) / double(state.mesh.number_of_faces());
    m_is_bounded = state.bounds_mean_angle;
    m_allowance = share * (std::max)(0., state.angle_gain);
    m_is_first = true;
    m_angles.assign(m_is_bounded ? std::size_t(trial.mesh().number_of_faces()) : 0, 0);
  }

  void measure(const Trial& trial)
  {
    if(!m_is_bounded)
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

  // the vertices of faces whose angles decrease are violating
  bool holds(const Trial& trial, const Patch_measure& after, Violating_vertices& violating) const
  {
    const int repaired = trial.sums_before.defects() - after.defects();
    if(!m_is_bounded || m_sum >= m_least - 60. * (std::max)(0, repaired))
      return true;
    const double tolerance = 0.1; // degrees
    for(int f = 0; f < trial.mesh().number_of_faces(); ++f)
      if(m_angles.after[f] < m_angles.before[f] - tolerance)
        violating.add_face(f);
    return false;
  }

private:
  bool m_is_bounded = false, m_is_first = true;
  Compared<double> m_angles; // per face: its smallest, in degrees
  double m_sum = 0, m_least = 0, m_allowance = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_MEAN_ANGLE_H
