// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_FACE_ORIENTATION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_FACE_ORIENTATION_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Faces that are inverted with respect to R and quads that are not convex count as defects, whose number
// does not increase.
struct Face_orientation : Invariant
{
  void start(const Trial& trial) { m_defects.assign(trial.mesh().number_of_faces(), 0); }

  void measure(const Trial& trial)
  {
    for(const int f : trial.changed)
      m_defects.after[f] = char(is_flipped(trial.mesh(), trial, f, trial.after.normals[f]) +
                                is_nonconvex(trial.mesh(), trial, f));
  }

  void accept() { m_defects.accept(); }

  void sum_up(const Trial&, Patch_measure& measure) const
  {
    for(const char n : m_defects.after)
      measure.inner_defects += n;
  }

  bool holds(const Trial& trial, Violating_vertices& violating) const
  {
    for(int f = 0; f < trial.mesh().number_of_faces(); ++f)
      if(m_defects.has_increased(f))
        violating.add_face(f);
    return true; // only their total is bounded
  }

private:
  Compared<char> m_defects; // per face
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_FACE_ORIENTATION_H
