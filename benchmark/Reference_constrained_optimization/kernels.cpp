// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Micro-benchmarks of single steps, on patches of a bumpy torus.

#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/internal/Flattened_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/patch_selection.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

namespace RCO = CGAL::Reference_constrained_optimization;
using namespace RCO::internal;

namespace {

Mesh_copy bumpy_torus(int columns, int rows)
{
  Mesh_copy copy;
  const double turn = 2 * 3.14159265358979323846;
  for(int j = 0; j < rows; ++j)
    for(int i = 0; i < columns; ++i)
    {
      const double a = turn * i / columns, b = turn * j / rows;
      const double r = 0.4 * (1 + 0.1 * std::sin(5 * a) * std::cos(3 * b));
      copy.points.emplace_back((1 + r * std::cos(b)) * std::cos(a),
                               (1 + r * std::cos(b)) * std::sin(a), r * std::sin(b));
    }
  std::vector<int> begins(1, 0), corners;
  const auto at = [&](int i, int j) { return (j % rows) * columns + i % columns; };
  for(int j = 0; j < rows; ++j)
    for(int i = 0; i < columns; ++i)
      for(const int v :
          {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
      {
        corners.push_back(v);
        if(corners.size() % 3 == 0)
          begins.push_back(int(corners.size()));
      }
  copy.mesh = Indexed_mesh(begins, corners, columns * rows);
  return copy;
}

struct Scene
{
  Mesh_copy copy = bumpy_torus(240, 96);
  Reference_surface surface{copy};
  Face_geometry geometry;

  Scene() { geometry.update(copy.mesh, copy.points); }

  // a patch of so many faces, in local vertices, with its points
  Mesh_copy patch(int size) const
  {
    Selection_parameters parameters;
    parameters.maximum_patch_size = size;
    parameters.developability_threshold = 1;
    Patch_selection selection(copy.mesh, parameters);
    Mesh_copy result;
    std::vector<int> begins(1, 0), corners, local(copy.points.size(), -1);
    for(const int f : selection.grow(0, geometry, [](int) { return false; }))
    {
      for(int c = copy.mesh.face_begin[f]; c < copy.mesh.face_begin[f + 1]; ++c)
      {
        const int v = copy.mesh.corner_vertex[c];
        if(local[v] < 0)
        {
          local[v] = int(result.points.size());
          result.points.push_back(copy.points[v]);
        }
        corners.push_back(local[v]);
      }
      begins.push_back(int(corners.size()));
    }
    result.mesh = Indexed_mesh(begins, corners, int(result.points.size()));
    return result;
  }
};

const Scene& scene()
{
  static const Scene s;
  return s;
}

void cone_proxy(benchmark::State& state)
{
  const int n = int(state.range(0));
  for(auto _ : state)
  {
    Cone_proxy_fit fit;
    for(int f = 0; f < n; ++f)
      fit.add(scene().geometry.normals[f], scene().geometry.areas[f]);
    benchmark::DoNotOptimize(fit.fit());
  }
}

void growing(benchmark::State& state)
{
  Selection_parameters parameters;
  parameters.maximum_patch_size = int(state.range(0));
  Patch_selection selection(scene().copy.mesh, parameters);
  int seed = 0;
  for(auto _ : state)
  {
    benchmark::DoNotOptimize(
      selection.grow(seed, scene().geometry, [](int) { return false; }).size());
    seed = (seed + 977) % scene().copy.mesh.number_of_faces();
  }
}

void flattening(benchmark::State& state, bool use_conformal)
{
  const Mesh_copy patch = scene().patch(int(state.range(0)));
  Flattening_parameters parameters;
  parameters.use_conformal = use_conformal;
  Patch_flattener flattener;
  for(auto _ : state)
    benchmark::DoNotOptimize(flattener.flatten(patch.mesh, patch.points, parameters).distortion);
}

void newton_step(benchmark::State& state)
{
  const Mesh_copy patch = scene().patch(int(state.range(0)));
  const std::vector<Vector_2> start = Patch_flattener().flatten(patch.mesh, patch.points).positions;
  Planar_problem problem;
  const Eigen::Matrix2d rest = RCO::equilateral_rest_triangle(0.02).inverse();
  for(int f = 0; f < patch.mesh.number_of_faces(); ++f)
  {
    const int* v = &patch.mesh.corner_vertex[3 * f];
    problem.triples.push_back({{v[0], v[1], v[2]}});
    problem.rest_inverse.push_back(rest);
    problem.metric.push_back(Eigen::Matrix2d::Identity());
  }
  for(const char is_border : patch.mesh.is_border_vertex)
    problem.is_free.push_back(!is_border);
  Projected_newton optimizer;
  optimizer.analyze(problem);
  for(auto _ : state)
  {
    std::vector<Vector_2> u = start;
    benchmark::DoNotOptimize(
      optimizer.minimize(problem, RCO::Exponential_MIPS_density(), u, 1, 0.).final_energy);
  }
}

// points half an edge away from where the search starts, and a little off the surface
void closest_point(benchmark::State& state, bool is_local)
{
  const Scene& s = scene();
  int f = 0;
  for(auto _ : state)
  {
    const Vector_3 p = 0.5 * (s.surface.corner_point(f, 0) + s.surface.corner_point(f, 1)) +
                       0.003 * s.geometry.normals[f];
    const int start = s.copy.mesh.corner_face[s.copy.mesh.opposite[3 * f + 1]];
    benchmark::DoNotOptimize(is_local ? s.surface.descend(p, start) : s.surface.closest(p));
    f = (f + 977) % s.copy.mesh.number_of_faces();
  }
}

BENCHMARK(cone_proxy)->Arg(1000);
BENCHMARK(growing)->Arg(400)->Arg(1000)->Arg(4000)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(flattening, conformal, true)
  ->Arg(400)
  ->Arg(1000)
  ->Arg(4000)
  ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(flattening, convex_border, false)
  ->Arg(400)
  ->Arg(1000)
  ->Arg(4000)
  ->Unit(benchmark::kMillisecond);
BENCHMARK(newton_step)->Arg(400)->Arg(1000)->Arg(4000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(closest_point, local, true);
BENCHMARK_CAPTURE(closest_point, tree, false);

} // namespace

BENCHMARK_MAIN();
