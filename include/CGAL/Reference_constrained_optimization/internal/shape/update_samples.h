// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_UPDATE_SAMPLES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_UPDATE_SAMPLES_H

#include <CGAL/Reference_constrained_optimization/internal/shape/drift_samples.h>

#include <algorithm>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Looks how far the samples of changed faces are from R once vertices have gone from where the patch has
// them to `placed`. None is further away than before by more than its displacement: as long as the barrier
// is not felt there, that is good enough.
inline void update_samples(const Patch& patch,
                           const Patch_samples& before,
                           const Reference_surface& reference,
                           const std::vector<Placed_vertex>& placed,
                           const std::vector<int>& changed,
                           const std::vector<char>& is_changed,
                           Patch_samples& now)
{
  if(!before.are_bounded())
    return;
  const Indexed_mesh& triangles = patch.triangles();
  const auto old_vertex = [&](int v) -> const Placed_vertex& { return patch.placed[v]; };
  const auto vertex = [&](int v) -> const Placed_vertex& { return placed[v]; };
  for(const int f : changed)
    for(int t = patch.triangle_of(f); t < triangles.number_of_faces() && patch.polygon_of(t) == f;
        ++t)
      for(int i = 0; i < 4; ++i)
      {
        const int s = sample_of(patch, t, i);
        if(s < 0 || (s != 4 * t + i && is_changed[patch.polygon_of(s / 4)]))
          continue; // it is the other triangle's
        Patch_samples::Sample& sample = now.samples[s];
        const Vector_3 barycentric = sample_barycentric(s % 4);
        const double displacement = (triangle_point(triangles, vertex, s / 4, barycentric) -
                                     triangle_point(triangles, old_vertex, s / 4, barycentric))
                                      .norm();
        sample.distance = before.samples[s].distance + displacement;
        sample.bound = before.samples[s].bound;
        if(Drift_barrier::is_felt(sample.distance, sample.bound))
          locate_sample(patch, before, reference, vertex, s, sample);
      }
}

// The same for the points of R that are projected onto the patch.
inline void update_guests(const Patch& patch,
                          const Patch_samples& before,
                          const Reference_surface& reference,
                          const std::vector<Placed_vertex>& placed,
                          const std::vector<int>& changed,
                          Patch_samples& now)
{
  if(before.guests.empty())
    return;
  const Indexed_mesh& mesh = patch.polygons;
  const auto vertex = [&](int v) -> const Placed_vertex& { return placed[v]; };
  // a descent looks at the faces around the one where it begins, too
  std::vector<char> is_near(patch.vertices.size(), 0);
  for(const int f : changed)
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      is_near[mesh.corner_vertex[c]] = 1;
  const auto is_near_face = [&](int f) {
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      if(is_near[mesh.corner_vertex[c]])
        return true;
    return false;
  };
  for(std::size_t i = 0; i < now.guests.size(); ++i)
  {
    if(!is_near_face(now.guests[i].polygon))
      continue;
    const Patch_samples::Guest& guest = before.guests[i];
    double displacement = 0;
    for(int c = mesh.face_begin[guest.polygon]; c < mesh.face_begin[guest.polygon + 1]; ++c)
    {
      const int v = mesh.corner_vertex[c];
      displacement =
        (std::max)(displacement, (placed[v].position - patch.placed[v].position).norm());
    }
    if(Drift_barrier::is_felt(guest.distance + displacement, guest.bound))
      locate_guest(patch, reference, vertex, now.guests[i]);
    else
    {
      now.guests[i] = guest;
      now.guests[i].distance += displacement;
    }
  }
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_UPDATE_SAMPLES_H
