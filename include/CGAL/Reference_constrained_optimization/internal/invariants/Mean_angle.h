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
    m_angles.assign(m_is_bounded ? std::size_t(trial.mesh().number_of_faces()) : 0, 0);
  }

  void measure(const Trial& trial)
  {
    if(!m_is_bounded)
      return;
    for(const int f : trial.changed)
      m_angles.after[f] = degrees_per_radian * std::acos((std::min)(1., trial.after.cosines[f]));
  }

  void accept() { m_angles.accept(); }

  void sum_up(const Trial&, Patch_measure& measure) const
  {
    for(const double angle : m_angles.after)
      measure.angles += angle;
  }

  // the vertices of faces whose angles decrease are violating
  bool holds(const Trial& trial, const Patch_measure& after, Violating_vertices& violating) const
  {
    const int repaired = (std::max)(0, trial.sums_before.defects() - after.defects());
    if(!m_is_bounded || after.angles >= trial.initial_sums.angles - m_allowance - 60. * repaired)
      return true;
    const double tolerance = 0.1; // degrees
    for(int f = 0; f < trial.mesh().number_of_faces(); ++f)
      if(m_angles.after[f] < m_angles.before[f] - tolerance)
        violating.add_face(f);
    return false;
  }

private:
  bool m_is_bounded = false;
  Compared<double> m_angles; // per face: its smallest, in degrees
  double m_allowance = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_MEAN_ANGLE_H
