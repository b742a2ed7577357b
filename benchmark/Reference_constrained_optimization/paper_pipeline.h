#pragma once

// Algorithm 1 of the paper as it stands, made of the package's parts. From the paper it differs in these: a
// face also counts as touched if it was the seed or inside two patches, without which an iteration need not
// end; borders of the mesh are no boundaries of patches; densities are finite everywhere; and the run ends
// when an iteration changes the energy by less than the tolerance.

#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/internal/flattening/mapping_back.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/patch_flattening.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Element_densities.h>
#include <CGAL/Reference_constrained_optimization/internal/read_parameters.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/Located_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/active_set.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <random>
#include <utility>
#include <vector>

namespace paper {

using namespace RCO::internal;
using namespace CGAL::Reference_constrained_optimization;

// the face of least cost comes next, and the first that costs too much ends the patch
inline std::vector<int>
select_patch(const Indexed_mesh& mesh, const Face_geometry& geometry, double threshold, int seed)
{
  const Cone_proxy proxy = initial_proxy(mesh, geometry, seed);
  std::vector<int> patch;
  std::vector<char> is_in(mesh.number_of_faces(), 0), has_vertex(mesh.number_of_vertices(), 0);
  const auto in_patch = [&](int f) { return is_in[f] != 0; };
  const auto vertex_in_patch = [&](int v) { return has_vertex[v] != 0; };
  typedef std::pair<double, int> Entry;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  for(queue.push(Entry(0, seed)); !queue.empty() && queue.top().first < threshold;)
  {
    const int f = queue.top().second;
    queue.pop();
    if(in_patch(f) || !preserves_disk(mesh, f, in_patch, vertex_in_patch))
      continue;
    patch.push_back(f);
    is_in[f] = 1;
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
    {
      has_vertex[mesh.corner_vertex[c]] = 1;
      if(mesh.opposite[c] >= 0)
      {
        const int g = mesh.corner_face[mesh.opposite[c]];
        queue.push(Entry(proxy.cost(geometry.normals[g]), g));
      }
    }
  }
  return patch;
}

// Flattens a patch, minimizes in the plane, and keeps what comes back from there to the reference.
template <typename Density>
Flattening optimize_patch(const Patch& patch, const Density& density, Optimization_state& state)
{
  // From Tutte's embedding. Patches are ragged, and unrolled slowly: without the metric of the surface what
  // is left of the distortion spoils the result.
  Flattening_parameters parameters;
  parameters.use_conformal = parameters.use_mean_value = false;
  parameters.target_distortion = 4;
  parameters.maximum_descent_steps = 500;
  parameters.descent_tolerance = 1e-6;
  const Indexed_mesh& triangles = patch.triangles();
  const Flattening flattening = Patch_flattener().flatten(triangles, patch.positions(), parameters);
  if(flattening.path == Flattening_path::failed)
    return flattening;

  Planar_problem problem;
  problem.set_elements(patch,
                       [](const Element_set::Element&) { return Eigen::Matrix2d::Identity(); });
  std::vector<Vector_2> u = flattening.positions;
  Projected_newton optimizer;
  optimizer.analyze(problem);
  optimizer.minimize(problem, Patch_elements<Density>{density, patch.elements}, u, 200, 1e-8);

  for(std::size_t v = 0; v < u.size(); ++v)
  {
    const int start = triangles.corner_face[triangles.vertex_corners[triangles.vertex_begin[v]]];
    const Planar_location location = walk(triangles, flattening.positions, u[v], start);
    if(patch.is_free[v] && location.triangle >= 0)
      map_to_reference(patch, location, state.reference, state.vertices[patch.vertices[v]]);
  }
  return flattening;
}

// The border, and what is constrained, is fixed; the drift is not bounded.
template <typename Energy, typename Named_parameters>
Result optimize(Mesh& mesh, const Mesh& reference, const Energy& energy, const Named_parameters& np)
{
  const auto start = std::chrono::steady_clock::now();
  const Loop_parameters parameters = read_loop_parameters(np);
  auto& visitor = CGAL::parameters::get_parameter(np, CGAL::internal_np::visitor).get();
  Interruption interruption(visitor, start, parameters.maximum_running_time);
  const Mesh_copy copy = read_face_graph(mesh, mesh.points(), "mesh");
  Located_mesh located(copy, read_face_graph(reference, reference.points(), "reference"), energy,
                       free_vertices(copy.mesh, read_constraints(mesh, np, copy.mesh)));
  Optimization_state& state = located.state();
  Face_geometry geometry;
  geometry.update(copy.mesh, copy.points);
  const auto density = element_densities(energy);
  const auto mean_energy = [&]() {
    return measure<CGAL::Sequential_tag>(state, density, 1e300).energy / state.elements.size();
  };
  const double rest = rest_energy(state, density) / state.elements.size();
  Result r;
  r.initial_energy = r.final_energy = mean_energy();
  r.status = Status::iteration_limit;
  Patch_selection selection(copy.mesh, parameters.selection);
  Patch_builder builder(copy.mesh);
  std::vector<int> seeds(copy.mesh.number_of_faces());
  std::iota(seeds.begin(), seeds.end(), 0);
  std::mt19937 random(parameters.random_seed);
  while(r.status == Status::iteration_limit &&
        r.number_of_iterations < parameters.number_of_iterations)
  {
    visitor.on_iteration_begin(r.number_of_iterations);
    std::vector<char> is_untouched = faces_around(copy.mesh, state.is_free, 0);
    selection.clear_visits();
    std::shuffle(seeds.begin(), seeds.end(), random);
    for(const int seed : seeds)
    {
      if(!is_untouched[seed] || interruption.should_stop())
        continue;
      const std::vector<int> faces =
        select_patch(copy.mesh, geometry, parameters.selection.developability_threshold, seed);
      for(const int f : selection.touched(faces))
        is_untouched[f] = 0;
      const Flattening flattening = optimize_patch(builder.build(faces, state), density, state);
      for(const int f : faces)
        geometry.set(copy.mesh, f, [&](int v) { return state.vertices[v].position; });
      ++r.number_of_patches;
      r.sum_of_patch_sizes += double(faces.size());
      r.failed_flattenings += flattening.path == Flattening_path::failed;
      r.convex_border_flattenings += flattening.path == Flattening_path::convex_border;
      r.sum_of_flattening_distortion += flattening.distortion;
    }
    const double before = r.final_energy;
    r.final_energy = mean_energy();
    visitor.on_iteration_end(r.number_of_iterations++, r.final_energy);
    if(interruption.has_stopped())
      r.status = interruption.status();
    else if(std::abs(before - r.final_energy) <= parameters.energy_tolerance * (before - rest))
      r.status = Status::converged;
  }
  for(const Mesh::Vertex_index v : mesh.vertices())
  {
    const Vector_3& p = state.vertices[v].position;
    mesh.point(v) = Kernel::Point_3(p.x(), p.y(), p.z());
  }
  r.number_of_accepted_patches = r.number_of_flattened_patches = r.convex_border_flattenings;
  r.running_time = seconds_since(start);
  return r;
}

} // namespace paper
