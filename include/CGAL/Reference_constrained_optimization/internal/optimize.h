// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OPTIMIZE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OPTIMIZE_H

#include <CGAL/Reference_constrained_optimization/Default_visitor.h>
#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/Frame.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/has_area.h>
#include <CGAL/Reference_constrained_optimization/internal/read_parameters.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/face_range.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/feature_constraints.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/initial_state.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/reference_lines.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/sliding_vertices.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/feature_detection.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/near_sheets.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/Shape_bound.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/optimize_state.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>
#include <CGAL/Reference_constrained_optimization/internal/writing/Defect_repair.h>
#include <CGAL/Reference_constrained_optimization/internal/writing/write_back.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/tags.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <type_traits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Whether the reference is the mesh itself, with the points that it has; other point maps are not
// compared.
template <typename PolygonMesh,
          typename ReferenceMesh,
          typename NamedParameters,
          typename NamedParametersReference>
bool are_same_object([[maybe_unused]] const PolygonMesh& mesh,
                     [[maybe_unused]] const ReferenceMesh& reference,
                     const NamedParameters&,
                     const NamedParametersReference&)
{
  if constexpr(std::is_same<PolygonMesh, ReferenceMesh>::value &&
               parameters::is_default_parameter<NamedParameters,
                                                CGAL::internal_np::vertex_point_t>::value &&
               parameters::is_default_parameter<NamedParametersReference,
                                                CGAL::internal_np::vertex_point_t>::value)
    return &mesh == &reference;
  else
    return false;
}

// Rounds the positions of free vertices to the user's coordinates.
inline void round_to_user_coordinates(const Frame& frame, Optimization_state& state)
{
  for(std::size_t v = 0; v < state.vertices.size(); ++v)
    if(state.is_free[v])
      state.vertices[v].position = frame(frame.to_user(state.vertices[v].position));
}

// the distance between mesh and reference at the samples of the shape bound
template <typename ConcurrencyTag>
double drift_of(const Optimization_state& state, double bound)
{
  Shape_bound shape_bound;
  shape_bound.initialize<ConcurrencyTag>(state, bound, true, Drift_barrier(1));
  return shape_bound.initial_drift();
}

// Implementation of `optimize()`; throws Interrupted, and leaves the mesh unchanged, if it is interrupted
// before the mesh is on the reference.
template <typename ConcurrencyTag,
          typename PolygonMesh,
          typename ReferenceMesh,
          typename Energy,
          typename FaceRange,
          typename Visitor,
          typename NamedParameters,
          typename NamedParametersReference>
void optimize(const FaceRange& range,
              PolygonMesh& mesh,
              const ReferenceMesh& reference,
              const Energy& energy,
              const Loop_parameters& loop_parameters,
              Visitor& visitor,
              Interruption& interruption,
              const NamedParameters& np,
              const NamedParametersReference& np_reference,
              Result& result)
{
  const auto start = std::chrono::steady_clock::now();
  auto vpm =
    parameters::choose_parameter(parameters::get_parameter(np, CGAL::internal_np::vertex_point),
                                 CGAL::get_property_map(CGAL::vertex_point, mesh));
  auto reference_vpm = parameters::choose_parameter(
    parameters::get_parameter(np_reference, CGAL::internal_np::vertex_point),
    CGAL::get_const_property_map(CGAL::vertex_point, reference));

  interruption.check();
  Mesh_copy copy = read_face_graph<ConcurrencyTag>(mesh, vpm, "mesh");
  interruption.check();
  const bool is_self_reference = are_same_object(mesh, reference, np, np_reference);
  Mesh_copy other = is_self_reference
                      ? Mesh_copy()
                      : read_face_graph<ConcurrencyTag>(reference, reference_vpm, "reference");
  const Mesh_copy& reference_copy = is_self_reference ? copy : other;
  const Frame frame(reference_copy);
  const double unit = frame.unit(), distance_of_origin = frame.distance_of_origin();
  frame.transform(copy);
  frame.transform(other);
  Reference_surface surface(reference_copy, distance_of_origin);
  const auto point = [&](int v) -> const Vector_3& { return copy.points[v]; };
  if(!has_area(copy.mesh, point, distance_of_origin))
    throw Invalid_input("mesh: every face has zero area");
  check_location_map(surface, np);
  interruption.check();
  // energies get lengths in the user's units
  const Mesh_energy_context context(
    mesh, vpm,
    Energy_context(copy.mesh.face_begin, copy.mesh.corner_vertex, copy.points.size(),
                   unit * mean_edge_length(copy.mesh, copy.points),
                   unit * unit * surface_area(copy.mesh, copy.points),
                   unit * unit * surface.area()));
  const std::vector<char> is_in_range = mark_faces(mesh, range);
  const Element_set elements(energy, context, is_in_range, unit);
  interruption.check();
  Optimization_state state{copy.mesh, surface, elements, {}, {}};
  state.is_in_range = is_in_range;
  state.stencils = Stencil_set(energy, context, frame);
  Constraints constraints = read_constraints(mesh, np, copy.mesh);
  constrain_outside(copy.mesh, is_in_range, constraints);
  // a copy of the mesh counts as the mesh itself
  const bool is_same = is_self_reference || (copy.points == other.points &&
                                             copy.mesh.face_begin == other.mesh.face_begin &&
                                             copy.mesh.corner_vertex == other.mesh.corner_vertex);
  constexpr bool has_reference_lines =
    !parameters::is_default_parameter<NamedParametersReference,
                                      CGAL::internal_np::edge_is_constrained_t>::value;
  Detected_features features;
  if(loop_parameters.detect_features && !has_reference_lines)
    features = Feature_detection(surface, elements.criterion() == Element_criterion::smallest_angle)
                 .result();
  interruption.check();
  if(features.number_of_edges > 0)
    constrain(is_same ? features_of_polygons(copy.mesh, surface, features.is_feature)
                      : traced_features(copy.mesh, copy.points, surface, features.is_feature),
              copy.mesh, constraints, result);
  if(!features.is_mechanical.empty() && is_same)
    constrain_tips(copy.mesh, surface, features.is_mechanical, constraints);
  state.is_free = free_vertices(copy.mesh, constraints);
  state.is_line = constraints.is_line;
  locate_on_reference<ConcurrencyTag>(copy.points, surface, state, result, &interruption,
                                      distance_of_origin);
  check_distances(copy.points, state, unit);
  state.is_mechanical = std::move(features.is_mechanical);
  state.bounds_normal_deviation = faces_on(state, state.is_mechanical);
  if(!state.bounds_normal_deviation.empty())
  {
    state.is_smooth = smooth_edges(state);
    const double largest_part = 0.008; // of the volume
    if(!copy.mesh.has_border())
      state.largest_volume_change = largest_part * std::abs(volume_of_mechanical_parts(state));
  }
  // closest points of such a mesh are undefined
  const auto located = [&](int v) -> const Vector_3& { return state.vertices[v].position; };
  if(!has_area(copy.mesh, located, distance_of_origin))
    throw Invalid_input("mesh: every face has zero area when its vertices lie on the reference");
  if(loop_parameters.relax_constraints || result.number_of_feature_edges > 0)
  {
    Reference_lines lines =
      read_reference_lines(reference, np_reference, reference_copy.mesh, surface);
    if(!is_same && result.number_of_feature_edges > 0)
      lines.set_features(feature_edges(surface.mesh(), features.is_feature));
    Sliding_vertices(state, constraints, lines, loop_parameters.relax_constraints,
                     rounding_of(copy.mesh, point, distance_of_origin), result);
  }
  for(int v = 0; v < copy.mesh.number_of_vertices(); ++v)
    if(state.has_optimized_face(v))
      result.largest_initial_distance =
        (std::max)(result.largest_initial_distance,
                   unit * (state.vertices[v].on_reference.position - copy.points[v]).norm());
  round_to_user_coordinates(frame, state);
  // faces of a coarse mesh bridge a longer distance
  if(!loop_parameters.allow_self_intersections)
    state.set_near_sheets(near_sheets(
      surface,
      (std::max)(1., mean_edge_length(copy.mesh, copy.points) / surface.mean_edge_length())));
  const std::vector<Located_vertex> start_vertices = state.vertices;
  result.times.setup = seconds_since(start);

  const auto densities = element_densities(energy);
  const auto measure_all = [&]() {
    return measure<ConcurrencyTag>(state, densities, std::numeric_limits<double>::infinity());
  };
  const Global_measure initial = measure_all();
  const double number_of_elements = (std::max)(1, elements.size());
  result.initial_energy = initial.energy / number_of_elements;
  result.initial_number_of_flips = initial.flips;
  result.initial_number_of_fold_edges = initial.fold_edges;
  result.initial_number_of_nonconvex_quads = initial.nonconvex_quads;
  const Output_defects initial_defects = find_output_defects<ConcurrencyTag>(state, start_vertices);
  result.initial_number_of_creases = initial_defects.number_of_creases;
  result.initial_number_of_self_intersections = initial_defects.intersections.size();
  const auto bounded_number = [](std::size_t n, bool allows_more) {
    return Bounded_number{allows_more ? Bounded_number::unbounded : int(n), int(n)};
  };
  state.counts.creases =
    bounded_number(result.initial_number_of_creases, loop_parameters.allow_creases);
  state.counts.intersections = bounded_number(result.initial_number_of_self_intersections,
                                              loop_parameters.allow_self_intersections);

  Loop_parameters framed_parameters = loop_parameters;
  framed_parameters.drift_bound /= unit;
  const auto finish = [&]() {
    round_to_user_coordinates(frame, state);
    Global_measure final = measure_all();
    Defect_repair<ConcurrencyTag> defect_repair(state, start_vertices, initial_defects);
    // where clusters were opened and the mean did not rise again; a repair of defects may lower it
    const bool has_lost_angles = final.defects() == initial.defects() &&
                                 state.angle_gain < -1e-9 * state.mesh.number_of_faces();
    const auto is_worse = [&]() {
      return final.defects() > initial.defects() ||
             (final.defects() == initial.defects() && final.energy > initial.energy) ||
             ((defect_repair.has_restored_vertices() || has_lost_angles) &&
              defect_repair.has_lowered_angles()) ||
             (defect_repair.has_restored_vertices() &&
              result.drift >
                (std::max)(Drift_barrier::limit_factor * result.drift_bound, result.initial_drift));
    };
    const auto run_repair = [&]() {
      defect_repair.run();
      if(!defect_repair.has_restored_vertices())
        return;
      final = measure_all();
      if(std::isfinite(result.drift_bound))
        result.drift = drift_of<ConcurrencyTag>(state, result.drift_bound);
    };
    run_repair();
    // faces next to restored vertices may be stretched
    while(is_worse() && defect_repair.enlarge(densities))
      run_repair();
    write_points(mesh, vpm, copy.points, state, frame);
    write_locations(mesh, reference, np, state);
    result.final_energy = final.energy / number_of_elements;
    result.number_of_flips = final.flips;
    result.number_of_fold_edges = final.fold_edges;
    result.number_of_nonconvex_quads = final.nonconvex_quads;
    result.number_of_creases = defect_repair.defects().number_of_creases;
    result.number_of_self_intersections = defect_repair.defects().intersections.size();
    result.drift_bound *= unit;
    result.initial_drift *= unit;
    result.drift *= unit;
  };
  if(result.number_of_free_vertices > 0)
  {
    try
    {
      optimize_state<ConcurrencyTag>(state, densities, initial.energy, framed_parameters, visitor,
                                     result, interruption);
    }
    catch(...)
    {
      finish();
      throw;
    }
  }
  finish();
}

// Implementation of `CGAL::reference_constrained_optimize()`.
template <typename ConcurrencyTag,
          typename PolygonMesh,
          typename ReferenceMesh,
          typename Energy,
          typename NamedParameters,
          typename NamedParametersReference,
          typename FaceRange = All_faces>
Result optimize(PolygonMesh& mesh,
                const ReferenceMesh& reference,
                const Energy& energy,
                const NamedParameters& np,
                const NamedParametersReference& np_reference,
                const FaceRange& range = FaceRange())
{
#ifndef CGAL_LINKED_WITH_TBB
  static_assert(!std::is_convertible<ConcurrencyTag, CGAL::Parallel_tag>::value,
                "Parallel_tag is enabled but TBB is unavailable.");
#endif
  const auto start = std::chrono::steady_clock::now();
  const auto& own_np = cgal_parameters(np);
  const Loop_parameters loop_parameters = read_loop_parameters(own_np);
  auto visitor_parameter = parameters::choose_parameter(
    parameters::get_parameter(own_np, CGAL::internal_np::visitor), Default_visitor());
  auto& visitor = unwrap(visitor_parameter);
  Interruption interruption(visitor, start, loop_parameters.maximum_running_time);
  Result result;
  try
  {
    optimize<ConcurrencyTag>(range, mesh, reference, energy, loop_parameters, visitor, interruption,
                             own_np, cgal_parameters(np_reference), result);
  }
  catch(const Interrupted&)
  {
    result.status = interruption.status();
  }
  result.running_time = seconds_since(start);
  return result;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OPTIMIZE_H
