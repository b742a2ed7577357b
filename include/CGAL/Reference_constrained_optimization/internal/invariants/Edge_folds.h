// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_EDGE_FOLDS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_EDGE_FOLDS_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Folded edges, beyond 120 degrees, count as defects, whose number does not increase. Faces outside the
// patch are fixed.
struct Edge_folds : Invariant
{
  void start(const Trial& trial) { m_is_folded.assign(trial.mesh().number_of_corners(), 0); }

  void measure(const Trial& trial)
  {
    trial.for_each_changed_edge(
      [&](int e, const Vector_3& a, const Vector_3& b) { m_is_folded.after[e] = is_folded(a, b); });
  }

  void accept() { m_is_folded.accept(); }

  void sum_up(const Trial& trial, Patch_measure& measure) const
  {
    for(std::size_t c = 0; c < m_is_folded.after.size(); ++c)
      if(m_is_folded.after[c])
        ++(trial.patch.outside_face[c] >= 0 ? measure.boundary_defects : measure.inner_defects);
  }

  bool holds(const Trial& trial, Violating_vertices& violating) const
  {
    for(int c = 0; c < trial.mesh().number_of_corners(); ++c)
      if(m_is_folded.has_increased(c))
        violating.add_faces_at_edge(c);
    return true; // only their total is bounded
  }

private:
  Compared<char> m_is_folded; // per corner, at the first of the two of an edge
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_EDGE_FOLDS_H
