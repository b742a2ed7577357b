// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_TRACKER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_TRACKER_H

#include <CGAL/Reference_constrained_optimization/internal/shape/drift_samples.h>

#include <algorithm>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Follows the samples of a patch and its guests while its vertices are tried elsewhere. What the
// barrier would not feel anyway is not looked for.
class Drift_tracker
{
public:
  // as they are in the patch
  void start(const Patch& patch)
  {
    m_samples = patch.samples;
    m_guests = patch.guests;
  }

  // The vertices of the changed faces are at `placed` now.
  void visit(const Patch& patch,
             const Reference_surface& reference,
             const std::vector<Placed_vertex>& placed,
             const std::vector<int>& changed,
             const std::vector<char>& is_changed)
  {
    visit_samples(patch, reference, placed, changed, is_changed);
    visit_guests(patch, reference, placed, changed);
  }

  // what the barrier adds
  double energy(const Patch& patch) const
  {
    double sum = 0;
    for(int s = 0; s < int(m_samples.size()); ++s)
      sum += patch.barrier.value(m_samples[s].distance, m_samples[s].bound);
    for(const Patch::Guest& guest : m_guests)
      sum += patch.barrier.value(guest.distance, guest.bound);
    return sum;
  }

  const std::vector<Patch::Sample>& samples() const { return m_samples; }
  const std::vector<Patch::Guest>& guests() const { return m_guests; }

private:
  // Looks how far the samples of changed faces are from R. None is further away than before by more
  // than its way: as long as that is no matter it is good enough.
  void visit_samples(const Patch& patch,
                     const Reference_surface& reference,
                     const std::vector<Placed_vertex>& placed,
                     const std::vector<int>& changed,
                     const std::vector<char>& is_changed)
  {
    if(m_samples.empty())
      return;
    const Indexed_mesh& triangles = patch.triangles();
    const auto before = [&](int v) -> const Placed_vertex& { return patch.placed[v]; };
    const auto now = [&](int v) -> const Placed_vertex& { return placed[v]; };
    for(const int f : changed)
      for(int t = patch.triangle_of(f); t < triangles.number_of_faces() && patch.polygon_of(t) == f;
          ++t)
        for(int i = 0; i < 4; ++i)
        {
          const int s = sample_of(patch, t, i);
          if(s < 0 || (s != 4 * t + i && is_changed[patch.polygon_of(s / 4)]))
            continue; // it is the other triangle's
          Patch::Sample& sample = m_samples[s];
          const Vector_3 barycentric = sample_barycentric(s % 4);
          const double way = (triangle_point(triangles, now, s / 4, barycentric) -
                              triangle_point(triangles, before, s / 4, barycentric))
                               .norm();
          sample.distance = patch.samples[s].distance + way;
          sample.bound = patch.samples[s].bound;
          if(Drift_barrier::is_felt(sample.distance, sample.bound))
            locate_sample(patch, reference, now, s, sample);
        }
  }

  // looks where the points of R that are guests of the patch find it now
  void visit_guests(const Patch& patch,
                    const Reference_surface& reference,
                    const std::vector<Placed_vertex>& placed,
                    const std::vector<int>& changed)
  {
    if(m_guests.empty())
      return;
    const Indexed_mesh& mesh = patch.polygons;
    const auto now = [&](int v) -> const Placed_vertex& { return placed[v]; };
    // a descent looks at the faces around the one where it begins, too
    m_is_near.assign(patch.vertices.size(), 0);
    for(const int f : changed)
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        m_is_near[mesh.corner_vertex[c]] = 1;
    for(std::size_t i = 0; i < m_guests.size(); ++i)
    {
      if(!has_marked(mesh, m_guests[i].polygon, m_is_near))
        continue;
      const Patch::Guest& guest = patch.guests[i];
      double way = 0;
      for(int c = mesh.face_begin[guest.polygon]; c < mesh.face_begin[guest.polygon + 1]; ++c)
      {
        const int v = mesh.corner_vertex[c];
        way = (std::max)(way, (placed[v].position - patch.placed[v].position).norm());
      }
      if(Drift_barrier::is_felt(guest.distance + way, guest.bound))
        locate_guest(patch, reference, now, m_guests[i]);
      else
      {
        m_guests[i] = guest;
        m_guests[i].distance += way;
      }
    }
  }

  static bool has_marked(const Indexed_mesh& mesh, int f, const std::vector<char>& is_marked)
  {
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      if(is_marked[mesh.corner_vertex[c]])
        return true;
    return false;
  }

  std::vector<Patch::Sample> m_samples;
  std::vector<Patch::Guest> m_guests;
  std::vector<char> m_is_near; // per vertex, in a visit
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_TRACKER_H
