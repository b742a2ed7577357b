// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_SAMPLES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_SAMPLES_H

#include <CGAL/Reference_constrained_optimization/internal/reference/face_towards.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/Patch_samples.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Where a mesh leaves R is seen at the middles of its edges and triangles, and from R's vertices and creases.
// Triangle t has the samples 4 t + i: the middle of its edge i for i < 3 (held by one of the two
// triangles of an edge), its own for i = 3.

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
  const int o = mesh.opposite[c], holder = o >= 0 && o < c ? o : c;
  return 4 * (holder / 3) + holder % 3;
}

// the sample that an edge or a triangle of the patch has; -1 if none of its vertices may move
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

// Looks for the closest point of R, from where it was last and from the corners. At a crease that is a
// matter of the side: the descent ends where it begins if the faces make an acute angle.
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
  const auto corner = [&](int k) -> const Placed_vertex& { return vertex(corners[(i + k) % 3]); };
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
  const double unfelt = Drift_barrier::free_part * sample.bound;
  sample.distance = std::numeric_limits<double>::infinity();
  std::array<int, 4> starts;
  int number_of_starts = 0;
  const auto start = [&](int face) {
    const auto end = starts.begin() + number_of_starts;
    if(sample.distance <= unfelt || std::find(starts.begin(), end, face) != end)
      return;
    starts[number_of_starts++] = face;
    const Surface_point foot = reference.descend(p, face);
    const Vector_3 way = p - foot.position;
    const double distance = way.norm();
    if(!(distance < sample.distance))
      return;
    sample.face = foot.face;
    sample.distance = distance;
    sample.direction = distance > 0 ? Vector_3(way / distance) : way;
  };
  if(sample.face >= 0)
    start(sample.face);
  // The way out of a large fan of R takes long to find, for each of the samples around it: it is looked for
  // where nothing else is known.
  const auto is_in_large_fan = [&](const Surface_point& point) {
    const int v = vertex_at(reference, point);
    return v >= 0 && reference.mesh().valence(v) > largest_small_valence;
  };
  const auto start_at = [&](int k) {
    if(sample.distance > unfelt)
      start(face_towards(reference, corner(k).on_reference, p - corner(k).position));
  };
  for(int k = 0; k < number_of_corners; ++k)
    if(!is_in_large_fan(corner(k).on_reference))
      start_at(k);
  for(int k = 0; k < number_of_corners && number_of_starts == 0; ++k)
    start_at(k);
  sample.bound = samples.bound_at(patch.polygon_of(s / 4), sample.face);
}

// Looks for the closest point of the patch to a point of R, from where it was last.
template <typename VertexAccess>
void locate_guest(const Patch& patch,
                  const Reference_surface& reference,
                  const VertexAccess& vertex,
                  Patch_samples::Guest& guest)
{
  const Vector_3 p = reference.witness(guest.witness);
  const Foot foot = descend_to(
    patch.triangles(), [&](int v) -> const Vector_3& { return vertex(v).position; }, p,
    patch.triangle_of(guest.polygon));
  guest.triangle = foot.face;
  guest.barycentric = foot.barycentric;
  guest.polygon = patch.polygon_of(foot.face);
  guest.direction = foot.position - p;
  guest.distance = guest.direction.norm();
  if(guest.distance > 0)
    guest.direction /= guest.distance;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_SAMPLES_H
