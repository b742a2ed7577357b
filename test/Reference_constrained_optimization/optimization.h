// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Calls of the package, and what holds of every result.

#pragma once

#include "checks.h"
#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/reference_constrained_optimize.h>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/global_control.h>
#endif

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace rco_test {

// raises the smallest angles
template <typename Tag = CGAL::Sequential_tag,
          typename M,
          typename R,
          typename NamedParameters = params::Default_named_parameters>
RCO::Result
improve_angles(M& mesh, const R& reference, const NamedParameters& np = params::default_values())
{
  return CGAL::reference_constrained_optimize<Tag>(mesh, reference, RCO::Minimum_angle_energy(),
                                                   np);
}

// calls function(tag) with several numbers of threads, if there may be more than one
template <typename Function>
void with_threads([[maybe_unused]] const Function& function)
{
#ifdef CGAL_LINKED_WITH_TBB
  for(const int threads : {1, 2, 8})
  {
    const Scope scope(std::to_string(threads) + " threads");
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    function(CGAL::Parallel_tag());
  }
#endif
}

inline std::size_t defects_before(const RCO::Result& r)
{
  return r.initial_number_of_flips + r.initial_number_of_fold_edges +
         r.initial_number_of_nonconvex_quads;
}
inline std::size_t defects_after(const RCO::Result& r)
{
  return r.number_of_flips + r.number_of_fold_edges + r.number_of_nonconvex_quads;
}

// which vertices may leave their places; those of the border may not
inline std::vector<char> free_vertices(const Shape& shape,
                                       const std::vector<char>& is_constrained = {})
{
  const Indexed_mesh mesh = indexed(shape);
  std::vector<char> is_free;
  for(std::size_t v = 0; v < shape.points.size(); ++v)
    is_free.push_back(!mesh.is_border_vertex[v] &&
                      mesh.vertex_begin[v] < mesh.vertex_begin[v + 1] &&
                      (is_constrained.empty() || !is_constrained[v]));
  return is_free;
}

// The faces stay, and vertices that are not free keep their bits. Returns the number of those that are.
inline std::size_t
check_vertices(const Shape& before, const Shape& after, const std::vector<char>& is_free)
{
  RCO_CHECK(before.faces == after.faces);
  std::size_t number_free = 0;
  for(std::size_t v = 0; v < is_free.size(); ++v)
  {
    RCO_CHECK(after.points[v].allFinite());
    RCO_CHECK(is_free[v] || same_bits(after.points[v], before.points[v]));
    number_free += is_free[v];
  }
  return number_free;
}

// defects, creases and self-intersections do not increase, nor does the energy unless a defect was repaired
inline void check_progress(const RCO::Result& r)
{
  RCO_CHECK(std::isfinite(r.initial_energy) && std::isfinite(r.final_energy));
  RCO_CHECK_LESS_EQUAL(defects_after(r), defects_before(r));
  RCO_CHECK_LESS_EQUAL(r.number_of_creases, r.initial_number_of_creases);
  RCO_CHECK_LESS_EQUAL(r.number_of_self_intersections, r.initial_number_of_self_intersections);
  if(defects_after(r) == defects_before(r))
    RCO_CHECK_LESS_EQUAL(r.final_energy, r.initial_energy);
}

// edges of triangles beyond a right angle
inline std::size_t number_of_creases(const Shape& shape)
{
  const Indexed_mesh mesh = indexed(shape);
  std::size_t number = 0;
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(const int o = mesh.opposite[c]; o > c)
      number += vector_area(shape, shape.faces[mesh.corner_face[c]])
                  .normalized()
                  .dot(vector_area(shape, shape.faces[mesh.corner_face[o]]).normalized()) < -1e-6;
  return number;
}

// all of it: vertices, progress, and distances and defects as others measure them
template <typename M, typename R>
void check_result(const Shape& before,
                  const M& mesh,
                  const R& reference,
                  const RCO::Result& r,
                  const std::vector<char>& is_constrained = {})
{
  const std::vector<char> is_free = free_vertices(before, is_constrained);
  const std::size_t number_free = check_vertices(before, make_shape(mesh), is_free);
  RCO_CHECK_EQUAL(r.number_of_free_vertices, number_free);
  check_progress(r);

  auto is_measured = get(CGAL::dynamic_vertex_property_t<bool>(), mesh);
  std::size_t i = 0;
  for(const auto v : vertices(mesh))
    put(is_measured, v, is_free[i++]);
  const RCO::Distance_to_reference distance =
    RCO::distance_to_reference(mesh, reference, params::default_values(), params::default_values(),
                               [&](const auto& v) { return bool(get(is_measured, v)); });
  RCO_CHECK_EQUAL(distance.number_of_vertices, number_free);
  RCO_CHECK_LESS_EQUAL(distance.maximum, distance.tolerance);
  RCO_CHECK_EQUAL(RCO::number_of_nonconvex_quads(mesh, reference), r.number_of_nonconvex_quads);
  const RCO::Orientation_defects turned = RCO::orientation_defects(mesh, reference);
  RCO_CHECK_EQUAL(turned.number_of_flips, r.number_of_flips);
  RCO_CHECK_EQUAL(turned.number_of_fold_edges, r.number_of_fold_edges);
  RCO_CHECK_EQUAL(RCO::number_of_self_intersecting_pairs(mesh), r.number_of_self_intersections);
  if(r.number_of_feature_edges == 0 && CGAL::is_triangle_mesh(mesh))
    RCO_CHECK_EQUAL(number_of_creases(make_shape(mesh)), r.number_of_creases);
}

} // namespace rco_test
