// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_SMOOTH_EDGES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_SMOOTH_EDGES_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>

#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// On mechanical parts no edge that is smooth on input becomes sharp.
struct Smooth_edges : Invariant
{
  void start(const Trial& trial)
  {
    m_cosines.assign(trial.patch.bounds_normal_deviation.empty()
                       ? 0
                       : std::size_t(trial.mesh().number_of_corners()),
                     1);
  }

  void measure(const Trial& trial)
  {
    if(m_cosines.after.empty())
      return;
    trial.for_each_changed_edge([&](int e, const Vector_3& a, const Vector_3& b) {
      if(trial.patch.is_smooth[e])
        m_cosines.after[e] = cosine(a, b);
    });
  }

  void accept() { m_cosines.accept(); }

  bool holds(const Trial& trial, Violating_vertices& violating) const
  {
    const double smallest_cosine = 0.788; // 38 degrees
    bool holds = true;
    for(std::size_t c = 0; c < m_cosines.after.size(); ++c)
      if(trial.patch.is_smooth[c] && m_cosines.after[c] < smallest_cosine &&
         m_cosines.after[c] < m_cosines.before[c])
      {
        holds = false;
        violating.add_faces_at_edge(int(c));
      }
    return holds;
  }

private:
  static double cosine(const Vector_3& a, const Vector_3& b)
  {
    const double lengths = a.norm() * b.norm();
    return lengths > 0 ? a.dot(b) / lengths : 1.;
  }

  // per corner, at the first of the two of an edge: of its dihedral angle
  Compared<double> m_cosines;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_SMOOTH_EDGES_H
