// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_VERTEX_STEP_SIZES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_VERTEX_STEP_SIZES_H

#include <CGAL/Reference_constrained_optimization/internal/state/Patch.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The fraction of its displacement that each vertex of a patch moves. Fractions are reduced at violating
// vertices and vary smoothly around them, since the elements between a fixed vertex and a moving one would
// be sheared. The fractions of two neighbours therefore differ by no more than a fifth, and the resulting
// difference of their displacements is no more than three tenths of the edge between them.
class Vertex_step_sizes
{
public:
  // all fractions are one
  void start(const Patch& patch)
  {
    m_fraction.assign(patch.vertices.size(), 1.);
    m_is_changed.assign(patch.vertices.size(), 0);
    m_changed.clear();
    m_lowered.clear();
    for(int v = 0; v < int(patch.vertices.size()); ++v)
      if(patch.is_free[v])
        mark_changed(v);
  }

  const std::vector<double>& fractions() const { return m_fraction; }

  bool is_zero(const Patch& patch) const
  {
    for(std::size_t v = 0; v < m_fraction.size(); ++v)
      if(patch.is_free[v] && m_fraction[v] > 0)
        return false;
    return true;
  }

  void reduce(const Patch& patch, int v, double factor)
  {
    if(patch.is_free[v] && m_fraction[v] > 0)
      lower(v, factor * m_fraction[v] < 1e-3 ? 0. : factor * m_fraction[v]);
  }

  void reduce_all(const Patch& patch, double factor)
  {
    for(int v = 0; v < int(m_fraction.size()); ++v)
      reduce(patch, v, factor);
  }

  // calls try_step(v, fraction) for all vertices whose fraction has changed; where it returns false the
  // fraction is reduced, until all succeed
  template <typename Mover, typename TryStep>
  void apply(const Patch& patch, const Mover& mover, const TryStep& try_step)
  {
    limit_differences(patch, mover);
    while(!m_changed.empty())
    {
      m_batch.swap(m_changed);
      m_changed.clear();
      for(const int v : m_batch)
      {
        m_is_changed[v] = 0;
        while(!try_step(v, m_fraction[v]))
          m_fraction[v] = m_fraction[v] > 0.05 ? 0.5 * m_fraction[v] : 0;
        m_lowered.push_back(v);
      }
      limit_differences(patch, mover);
    }
  }

private:
  void mark_changed(int v)
  {
    if(!m_is_changed[v])
    {
      m_is_changed[v] = 1;
      m_changed.push_back(v);
    }
  }

  void lower(int v, double fraction)
  {
    m_fraction[v] = fraction;
    m_lowered.push_back(v);
    mark_changed(v);
  }

  template <typename Mover>
  void limit_differences(const Patch& patch, const Mover& mover)
  {
    const Indexed_mesh& mesh = patch.polygons;
    const auto limit = [&](int v, int u) {
      if(!patch.is_free[u] || !(m_fraction[u] > m_fraction[v]))
        return;
      const double edge = (patch.located[u].position - patch.located[v].position).norm();
      const double displacement =
        (std::max)(mover.displacement_length(u), mover.displacement_length(v));
      const double largest =
        m_fraction[v] + (displacement * 0.2 > 0.3 * edge ? 0.3 * edge / displacement : 0.2);
      if(m_fraction[u] > largest)
        lower(u, largest);
    };
    for(std::size_t i = 0; i < m_lowered.size(); ++i)
    {
      const int v = m_lowered[i];
      if(m_fraction[v] == 1)
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

  std::vector<double> m_fraction;
  std::vector<char> m_is_changed;
  std::vector<int> m_changed, m_batch, m_lowered;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_VERTEX_STEP_SIZES_H
