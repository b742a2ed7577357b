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

// The number of creases, edges beyond 90 degrees that are on no line, does not increase in a patch. For the
// repair of a defect, and where that is allowed, a patch may add as many as the mesh has lost since the
// input; the commit, which is sequential, sees to it that the patches of a round do not add more together.
struct Edge_creases : Invariant
{
  void set(const Step_limits& limits) { m_adds_creases = limits.adds_creases; }

  void start(const Trial& trial)
  {
    m_is_crease.assign(trial.mesh().number_of_corners(), 0);
    m_surplus = trial.state.crease_allowance();
    m_number = 0;
    m_is_first = true;
  }

  void measure(const Trial& trial)
  {
    const Indexed_mesh& mesh = trial.mesh();
    for(const int f : trial.changed)
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        if(trial.has_opposite(c))
          m_is_crease.after[trial.edge(c)] =
            !trial.patch.is_on_line(c) &&
            is_crease(trial.after.normals[f], trial.opposite_normal(c));
  }

  void accept()
  {
    m_is_crease.accept();
    if(m_is_first)
      for(const char crease : m_is_crease.before)
        m_number += crease;
    m_is_first = false;
  }

  void sum_up(const Trial& trial, Patch_measure& measure) const
  {
    for(std::size_t c = 0; c < m_is_crease.after.size(); ++c)
      if(m_is_crease.after[c])
        ++(trial.patch.outside_face[c] >= 0 ? measure.boundary_creases : measure.inner_creases);
  }

  // the faces at new creases are violating
  bool holds(const Trial& trial, const Patch_measure& after, Violating_vertices& violating) const
  {
    const bool adds = m_adds_creases || after.defects() < trial.sums_before.defects();
    if(after.inner_creases + after.boundary_creases <= m_number + (adds ? m_surplus : 0))
      return true;
    for(int c = 0; c < trial.mesh().number_of_corners(); ++c)
      if(m_is_crease.has_increased(c))
        violating.add_faces_at_edge(c);
    return false;
  }

private:
  Compared<char> m_is_crease; // per corner, at the first of the two of an edge
  bool m_adds_creases = false, m_is_first = true;
  int m_number = 0, m_surplus = 0; // before the first proposal, and what may be added
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_EDGE_CREASES_H
