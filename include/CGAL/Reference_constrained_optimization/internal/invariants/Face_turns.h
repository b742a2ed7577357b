// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_FACE_TURNS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_FACE_TURNS_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/face_turn.h>

#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// On mechanical parts no face is turned against R by more than an angle, or further.
struct Face_turns : Invariant
{
  void start(const Trial& trial) { m_turns.assign(trial.patch.bounds_turn.size(), 0); }

  void measure(const Trial& trial)
  {
    if(m_turns.after.empty())
      return;
    for(const int f : trial.changed)
      if(trial.patch.bounds_turn[f])
        m_turns.after[f] =
          face_turn(trial.mesh(), trial.state.reference, trial, f, trial.after.normals[f]);
  }

  void accept() { m_turns.accept(); }

  bool holds(const Trial&, Violating_vertices& violating) const
  {
    const double largest_turn = 20;
    bool holds = true;
    for(std::size_t f = 0; f < m_turns.after.size(); ++f)
      if(m_turns.after[f] > largest_turn && m_turns.has_risen(f))
      {
        holds = false;
        violating.add_face(int(f));
      }
    return holds;
  }

private:
  Compared<double> m_turns; // per face, in degrees
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_FACE_TURNS_H
