// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_VOLUME_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_VOLUME_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The volume of mechanical parts is bounded. Patches are solved at the same time: each may use a share, by
// its number of faces, of the remaining change, for all proposals together.
struct Volume : Invariant
{
  void start(const Trial& trial)
  {
    const Optimization_state& state = trial.state;
    m_volumes.assign(state.bounds_volume() ? std::size_t(trial.mesh().number_of_faces()) : 0, 0);
    const double share = double(trial.patch.faces.size()) / double(state.mesh.number_of_faces());
    m_largest_gain = share * (std::max)(0., state.largest_volume_change - state.volume_change);
    m_largest_loss = share * (std::max)(0., state.largest_volume_change + state.volume_change);
    m_apex = trial.located[0].position;
  }

  void measure(const Trial& trial)
  {
    if(m_volumes.after.empty())
      return;
    for(const int f : trial.changed)
      if(trial.patch.bounds_normal_deviation[f])
        m_volumes.after[f] = face_volume(trial.mesh(), trial, f, trial.after.normals[f], m_apex);
  }

  void sum_up(const Trial&, Patch_measure& measure) const
  {
    for(const double v : m_volumes.after)
      measure.volume += v;
  }

  // the vertices that contribute most are violating
  bool holds(const Trial& trial, const Patch_measure& after, Violating_vertices& violating) const
  {
    const double gain = after.volume - trial.initial_sums.volume;
    const bool grows = gain > m_largest_gain, shrinks = -gain > m_largest_loss;
    if(!grows && !shrinks)
      return true;
    const Indexed_mesh& mesh = trial.mesh();
    std::vector<double> swept(trial.located.size(), 0);
    double sum = 0;
    int number = 0;
    for(std::size_t v = 0; v < swept.size(); ++v)
    {
      if(!trial.patch.is_free[v])
        continue;
      Vector_3 normal = Vector_3::Zero();
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
        normal += trial.before.normals[mesh.corner_face[mesh.vertex_corners[k]]];
      swept[v] =
        (grows ? 1 : -1) * normal.dot(trial.located[v].position - trial.patch.located[v].position);
      if(swept[v] > 0)
      {
        sum += swept[v];
        ++number;
      }
    }
    for(std::size_t v = 0; v < swept.size(); ++v)
      if(swept[v] > 0 && swept[v] * number >= sum)
        violating.add(int(v));
    return false;
  }

private:
  Compared<double> m_volumes; // per face, six times that; none if they are not bounded
  Vector_3 m_apex = Vector_3::Zero();
  double m_largest_gain = 0, m_largest_loss = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_VOLUME_H
