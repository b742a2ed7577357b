// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_SAMPLES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_SAMPLES_H

#include <CGAL/Reference_constrained_optimization/internal/reference/face_in_direction.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/Patch_samples.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The distance between mesh and R is sampled at the midpoints of edges and the centroids of triangles, and
// at R's vertices and creases. Triangle t has the samples 4 t + i: the midpoint of its edge i for i < 3
// (dominated by one of the two triangles of an edge), its centroid for i = 3.

inline Vector_3 sample_barycentric(int i)
{
  if(i == 3)
    return Vector_3::Constant(1. / 3);
  Vector_3 b = Vector_3::Constant(0.5);
  b((i + 2) % 3) = 0;
  return b;
}

// the sample of the edge at a corner: its two triangles share it
inline int edge_sample(const Indexed_mesh& mesh, int c)
{
  const int o = mesh.opposite[c], owner = o >= 0 && o < c ? o : c;
  return 4 * (owner / 3) + owner % 3;
}

// the sample of an edge or a triangle of the patch; -1 if none of its vertices may move
inline int sample_of(const Patch& patch, int t, int i)
{
  const Indexed_mesh& mesh = patch.triangles();
  const int begin = mesh.face_begin[t];
  const auto is_free = [&](int k) { return patch.is_free[mesh.corner_vertex[begin + k % 3]]; };
  if(i == 3)
    return is_free(0) || is_free(1) || is_free(2) ? 4 * t + 3 : -1;
  if(!is_free(i) && !is_free(i + 1))
    return -1;
  return edge_sample(mesh, begin + i);
}

template <typename VertexAccess>
Vector_3 triangle_point(const Indexed_mesh& mesh,
                        const VertexAccess& vertex,
                        int t,
                        const Vector_3& barycentric)
{
  Vector_3 p = Vector_3::Zero();
  for(int k = 0; k < 3; ++k)
    p += barycentric(k) * vertex(mesh.corner_vertex[mesh.face_begin[t] + k]).position;
  return p;
}

// Searches for the closest point of R, from the last one and from the corners. At a crease with an acute
// angle the result depends on the side on which the local search starts.
template <typename VertexAccess>
void locate_sample(const Patch& patch,
                   const Patch_samples& samples,
                   const Reference_surface& reference,
                   const VertexAccess& vertex,
                   int s,
                   Patch_samples::Sample& sample)
{
  const Indexed_mesh& mesh = patch.triangles();
  const int i = s % 4, number_of_corners = i == 3 ? 3 : 2;
  const int* corners = &mesh.corner_vertex[mesh.face_begin[s / 4]];
  const auto corner = [&](int k) -> const Located_vertex& { return vertex(corners[(i + k) % 3]); };
  const int f = corner(0).on_reference.face;
  bool is_inside = true; // of a face of R; constrained vertices may be off R
  for(int k = 0; k < number_of_corners && is_inside; ++k)
    is_inside =
      corner(k).on_reference.face == f && corner(k).position == corner(k).on_reference.position;
  if(is_inside)
  {
    sample.face = f;
    sample.distance = 0;
    sample.bound = samples.bound_at(patch.polygon_of(s / 4), f);
    return;
  }
  const Vector_3 p = triangle_point(mesh, vertex, s / 4, sample_barycentric(i));
  const double activation_distance = Drift_barrier::activation_factor * sample.bound;
  sample.distance = std::numeric_limits<double>::infinity();
  std::array<int, 4> start_faces;
  int number_of_start_faces = 0;
  const auto search_from = [&](int face) {
    const auto end = start_faces.begin() + number_of_start_faces;
    if(sample.distance <= activation_distance || std::find(start_faces.begin(), end, face) != end)
      return;
    start_faces[number_of_start_faces++] = face;
    const Surface_point projection = reference.local_closest(p, face);
    const Vector_3 displacement = p - projection.position;
    const double distance = displacement.norm();
    if(!(distance < sample.distance))
      return;
    sample.face = projection.face;
    sample.distance = distance;
    sample.direction = distance > 0 ? Vector_3(displacement / distance) : displacement;
  };
  if(sample.face >= 0)
    search_from(sample.face);
  // Searching a large fan of R takes long, for each of the samples around it: only done if there is no
  // other start.
  const auto is_in_large_fan = [&](const Surface_point& point) {
    const int v = vertex_at(reference, point);
    return v >= 0 && reference.mesh().valence(v) > largest_small_valence;
  };
  const auto search_from_corner = [&](int k) {
    if(sample.distance > activation_distance)
      search_from(face_in_direction(reference, corner(k).on_reference, p - corner(k).position));
  };
  for(int k = 0; k < number_of_corners; ++k)
    if(!is_in_large_fan(corner(k).on_reference))
      search_from_corner(k);
  for(int k = 0; k < number_of_corners && number_of_start_faces == 0; ++k)
    search_from_corner(k);
  sample.bound = samples.bound_at(patch.polygon_of(s / 4), sample.face);
}

// Searches for the closest point of the patch to a sample of R, from the last one.
template <typename VertexAccess>
void locate_projected_sample(const Patch& patch,
                             const Reference_surface& reference,
                             const VertexAccess& vertex,
                             Patch_samples::Projected_sample& projected_sample)
{
  const Vector_3 p = reference.reference_sample(projected_sample.reference_sample);
  const Projection projection = local_closest_point(
    patch.triangles(), [&](int v) -> const Vector_3& { return vertex(v).position; }, p,
    patch.triangle_of(projected_sample.polygon));
  projected_sample.triangle = projection.face;
  projected_sample.barycentric = projection.barycentric;
  projected_sample.polygon = patch.polygon_of(projection.face);
  projected_sample.direction = projection.position - p;
  projected_sample.distance = projected_sample.direction.norm();
  if(projected_sample.distance > 0)
    projected_sample.direction /= projected_sample.distance;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_SAMPLES_H
