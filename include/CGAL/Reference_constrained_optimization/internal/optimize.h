// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OPTIMIZE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OPTIMIZE_H

#include <CGAL/Reference_constrained_optimization/Default_visitor.h>
#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/has_area.h>
#include <CGAL/Reference_constrained_optimization/internal/initial_state.h>
#include <CGAL/Reference_constrained_optimization/internal/outer_loop.h>
#include <CGAL/Reference_constrained_optimization/internal/read_parameters.h>
#include <CGAL/Reference_constrained_optimization/internal/sliding_vertices.h>
#include <CGAL/Reference_constrained_optimization/internal/write_back.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

#include <CGAL/boost/graph/named_params_helper.h>

#include <chrono>
#include <limits>
#include <type_traits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Whether the reference is the mesh itself, with the points that it has; other point maps are not
// compared.
template <typename PolygonMesh,
          typename ReferenceMesh,
          typename NamedParameters,
          typename NamedParametersReference>
bool is_own_reference([[maybe_unused]] const PolygonMesh& mesh,
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

// What `CGAL::reference_constrained_optimize()` does once its numbers are read: `loop_parameters`
// also has switches that the public function does not offer. Of the named parameters the maps and
// the visitor are used.
template <typename ConcurrencyTag,
          typename PolygonMesh,
          typename ReferenceMesh,
          typename Energy,
          typename NamedParameters,
          typename NamedParametersReference>
Result optimize(PolygonMesh& mesh,
                const ReferenceMesh& reference,
                const Energy& energy,
                const Loop_parameters& loop_parameters,
                const NamedParameters& np,
                const NamedParametersReference& np_reference)
{
  const auto start = std::chrono::steady_clock::now();
  const auto& own_np = cgal_parameters(np);
  const auto& own_np_reference = cgal_parameters(np_reference);

  auto vpm =
    parameters::choose_parameter(parameters::get_parameter(own_np, CGAL::internal_np::vertex_point),
                                 CGAL::get_property_map(CGAL::vertex_point, mesh));
  auto reference_vpm = parameters::choose_parameter(
    parameters::get_parameter(own_np_reference, CGAL::internal_np::vertex_point),
    CGAL::get_const_property_map(CGAL::vertex_point, reference));

  const Mesh_copy copy = read_face_graph<ConcurrencyTag>(mesh, vpm, "mesh");
  Reference_surface surface(
    is_own_reference(mesh, reference, own_np, own_np_reference)
      ? copy
      : read_face_graph<ConcurrencyTag>(reference, reference_vpm, "reference"));
  if(!has_area(copy.mesh, [&](int v) -> const Vector_3& { return copy.points[v]; }))
    throw Invalid_input("mesh: every face has zero area");
  const Energy_context context(copy.mesh.face_begin, copy.mesh.corner_vertex, copy.points.size(),
                               mean_edge_length(copy.mesh, copy.points),
                               surface_area(copy.mesh, copy.points), surface.area());
  const Element_set elements(energy, context);
  Result result;
  Optimization_state state{copy.mesh, surface, elements, {}, {}, {}, {}};
  const Constraints constraints = read_constraints(mesh, own_np, copy.mesh);
  state.is_free = free_vertices(copy.mesh, constraints);
  place_on_reference<ConcurrencyTag>(copy.points, surface, state, result);
  // nothing of R would be closest to such a mesh
  if(!has_area(copy.mesh, [&](int v) -> const Vector_3& { return state.vertices[v].position; }))
    throw Invalid_input("mesh: every face has zero area when its vertices lie on the reference");
  if(loop_parameters.relax_constraints)
    Sliding_vertices(state, constraints, result);
  result.times.setup = seconds_since(start);

  const auto& density = energy.density();
  typedef typename std::decay<decltype(density)>::type Density;
  const double infinity = std::numeric_limits<double>::infinity();
  const Global_measure initial = measure<ConcurrencyTag>(state, density, infinity);
  result.initial_energy = initial.energy / elements.size();
  result.initial_number_of_flips = initial.flips;
  result.initial_number_of_fold_edges = initial.fold_edges;
  result.initial_number_of_nonconvex_quads = initial.nonconvex_quads;

  const auto finish = [&]() {
    write_points(mesh, vpm, copy.points, state);
    write_locations(mesh, reference, own_np, state);
    const Global_measure final = measure<ConcurrencyTag>(state, density, infinity);
    result.final_energy = final.energy / elements.size();
    result.number_of_flips = final.flips;
    result.number_of_fold_edges = final.fold_edges;
    result.number_of_nonconvex_quads = final.nonconvex_quads;
    result.running_time = seconds_since(start);
  };
  auto visitor_parameter = parameters::choose_parameter(
    parameters::get_parameter(own_np, CGAL::internal_np::visitor), Default_visitor());
  auto& visitor = unwrap(visitor_parameter);
  typedef typename std::decay<decltype(visitor)>::type Visitor;
  if(result.number_of_free_vertices > 0)
  {
    Outer_loop<ConcurrencyTag, Density, Visitor> loop(state, density, loop_parameters, visitor,
                                                      result, start);
    try
    {
      loop.run();
    }
    catch(...)
    {
      finish();
      throw;
    }
  }
  finish();
  return result;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OPTIMIZE_H
