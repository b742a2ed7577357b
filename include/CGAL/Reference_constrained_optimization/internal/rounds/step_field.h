// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_STEP_FIELD_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_STEP_FIELD_H

#include <CGAL/Reference_constrained_optimization/internal/state/Patch.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Which part of its way each vertex of a patch goes. A step is cut where it does harm; it must not
// end there abruptly, for that would shear what is between a vertex that stays and one that goes.
// The parts of two neighbours therefore differ by no more than a fifth, and what they are apart more
// than by the edge between them is no more than three tenths of that edge.
class Step_field
{
public:
  // all vertices go all of their way
  void start(const Patch& patch)
  {
    m_part.assign(patch.vertices.size(), 1.);
    m_is_new.assign(patch.vertices.size(), 0);
    m_new.clear();
    m_lowered.clear();
    for(int v = 0; v < int(patch.vertices.size()); ++v)
      if(patch.is_free[v])
        renew(v);
  }

  const std::vector<double>& parts() const { return m_part; }

  bool has_stopped(const Patch& patch) const
  {
    for(std::size_t v = 0; v < m_part.size(); ++v)
      if(patch.is_free[v] && m_part[v] > 0)
        return false;
    return true;
  }

  void cut(const Patch& patch, int v, double factor)
  {
    if(patch.is_free[v] && m_part[v] > 0)
      lower(v, factor * m_part[v] < 1e-3 ? 0. : factor * m_part[v]);
  }

  void cut_all(const Patch& patch, double factor)
  {
    for(int v = 0; v < int(m_part.size()); ++v)
      cut(patch, v, factor);
  }

  // calls try_step(v, part) for all vertices whose part is new; where it returns false the part is
  // cut, until all succeed
  template <typename Mover, typename TryStep>
  void settle(const Patch& patch, const Mover& mover, const TryStep& try_step)
  {
    even_out(patch, mover);
    while(!m_new.empty())
    {
      m_batch.swap(m_new);
      m_new.clear();
      for(const int v : m_batch)
      {
        m_is_new[v] = 0;
        while(!try_step(v, m_part[v]))
          m_part[v] = m_part[v] > 0.05 ? 0.5 * m_part[v] : 0;
        m_lowered.push_back(v);
      }
      even_out(patch, mover);
    }
  }

private:
  void renew(int v)
  {
    if(!m_is_new[v])
    {
      m_is_new[v] = 1;
      m_new.push_back(v);
    }
  }

  void lower(int v, double part)
  {
    m_part[v] = part;
    m_lowered.push_back(v);
    renew(v);
  }

  template <typename Mover>
  void even_out(const Patch& patch, const Mover& mover)
  {
    const Indexed_mesh& mesh = patch.polygons;
    const auto limit = [&](int v, int u) {
      if(!patch.is_free[u] || !(m_part[u] > m_part[v]))
        return;
      const double edge = (patch.placed[u].position - patch.placed[v].position).norm();
      const double way = (std::max)(mover.motion_length(u), mover.motion_length(v));
      const double most = m_part[v] + (way * 0.2 > 0.3 * edge ? 0.3 * edge / way : 0.2);
      if(m_part[u] > most)
        lower(u, most);
    };
    for(std::size_t i = 0; i < m_lowered.size(); ++i)
    {
      const int v = m_lowered[i];
      if(m_part[v] == 1)
        continue;
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
      {
        const int c = mesh.vertex_corners[k];
        limit(v, mesh.target(c));
        limit(v, mesh.source(mesh.previous(c)));
      }
    }
    m_lowered.clear();
  }

  std::vector<double> m_part;
  std::vector<char> m_is_new;
  std::vector<int> m_new, m_batch, m_lowered;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_STEP_FIELD_H
