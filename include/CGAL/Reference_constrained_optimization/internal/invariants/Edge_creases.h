// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_EDGE_CREASES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_EDGE_CREASES_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>

#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The number of creases, edges beyond 90 degrees that are on no line, does not increase in a patch, but for its
// allowance; the commit, which is sequential, sees to it that the patches of a round do not add more together.
struct Edge_creases : Invariant
{
  void start(const Trial& trial) { m_is_crease.assign(trial.mesh().number_of_corners(), 0); }

  void measure(const Trial& trial)
  {
    trial.for_each_changed_edge([&](int e, const Vector_3& a, const Vector_3& b) {
      m_is_crease.after[e] = !trial.patch.is_on_line(e) && is_crease(a, b);
    });
  }

  void accept() { m_is_crease.accept(); }

  void sum_up(const Trial& trial, Patch_measure& measure) const
  {
    for(std::size_t c = 0; c < m_is_crease.after.size(); ++c)
      if(m_is_crease.after[c])
        ++(trial.patch.outside_face[c] >= 0 ? measure.boundary_creases : measure.inner_creases);
  }

  // the faces at new creases are violating
  bool holds(const Trial& trial, const Patch_measure& after, Violating_vertices& violating) const
  {
    if(after.creases() <=
       trial.initial_sums.creases() + trial.allowance(trial.state.counts.creases, after))
      return true;
    for(int c = 0; c < trial.mesh().number_of_corners(); ++c)
      if(m_is_crease.has_increased(c))
        violating.add_faces_at_edge(c);
    return false;
  }

private:
  Compared<char> m_is_crease; // per corner, at the first of the two of an edge
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_EDGE_CREASES_H
