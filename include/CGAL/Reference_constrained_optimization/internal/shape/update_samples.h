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

// Updates the distances of the samples of changed faces from R when the vertices of the patch move to
// `located`. The old distance plus the displacement is an upper bound, which suffices as long as the
// barrier is not active there.
inline void update_samples(const Patch& patch,
                           const Patch_samples& before,
                           const Reference_surface& reference,
                           const std::vector<Located_vertex>& located,
                           const std::vector<int>& changed,
                           const std::vector<char>& is_changed,
                           Patch_samples& now)
{
  if(!before.are_bounded())
    return;
  const Indexed_mesh& triangles = patch.triangles();
  const auto old_vertex = [&](int v) -> const Located_vertex& { return patch.located[v]; };
  const auto vertex = [&](int v) -> const Located_vertex& { return located[v]; };
  for(const int f : changed)
    for(int t = patch.triangle_of(f); t < triangles.number_of_faces() && patch.polygon_of(t) == f;
        ++t)
      for(int i = 0; i < 4; ++i)
      {
        const int s = sample_of(patch, t, i);
        if(s < 0 || (s != 4 * t + i && is_changed[patch.polygon_of(s / 4)]))
          continue; // it belongs to the other triangle
        Patch_samples::Sample& sample = now.samples[s];
        const Vector_3 barycentric = sample_barycentric(s % 4);
        const double displacement = (triangle_point(triangles, vertex, s / 4, barycentric) -
                                     triangle_point(triangles, old_vertex, s / 4, barycentric))
                                      .norm();
        sample.distance = before.samples[s].distance + displacement;
        sample.bound = before.samples[s].bound;
        if(Drift_barrier::is_active(sample.distance, sample.bound))
          locate_sample(patch, before, reference, vertex, s, sample);
      }
}

// The same for the reference samples that are projected onto the patch.
inline void update_projected_samples(const Patch& patch,
                                     const Patch_samples& before,
                                     const Reference_surface& reference,
                                     const std::vector<Located_vertex>& located,
                                     const std::vector<int>& changed,
                                     Patch_samples& now)
{
  if(before.projected_samples.empty())
    return;
  const Indexed_mesh& mesh = patch.polygons;
  const auto vertex = [&](int v) -> const Located_vertex& { return located[v]; };
  // the local search also visits the faces around the one where it starts
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
  for(std::size_t i = 0; i < now.projected_samples.size(); ++i)
  {
    if(!is_near_face(now.projected_samples[i].polygon))
      continue;
    const Patch_samples::Projected_sample& projected_sample = before.projected_samples[i];
    double displacement = 0;
    for(int c = mesh.face_begin[projected_sample.polygon];
        c < mesh.face_begin[projected_sample.polygon + 1]; ++c)
    {
      const int v = mesh.corner_vertex[c];
      displacement =
        (std::max)(displacement, (located[v].position - patch.located[v].position).norm());
    }
    if(Drift_barrier::is_active(projected_sample.distance + displacement, projected_sample.bound))
      locate_projected_sample(patch, reference, vertex, now.projected_samples[i]);
    else
    {
      now.projected_samples[i] = projected_sample;
      now.projected_samples[i].distance += displacement;
    }
  }
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_UPDATE_SAMPLES_H
