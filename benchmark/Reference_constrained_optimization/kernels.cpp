// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Micro-benchmarks of single steps, on patches of a bumpy torus.

#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/internal/Block_LDLT.h>
#include <CGAL/Reference_constrained_optimization/internal/Flattened_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/patch_selection.h>

#include <Eigen/SparseCholesky>
#include <benchmark/benchmark.h>

#include <array>
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

// The system of a patch of triangles (with its free vertices), or of a square of quads in which
// opposite corners are neighbours, too; both ways to factorize it are ready for a numeric run.
struct Factorization_scene
{
  typedef Eigen::SparseMatrix<double> Matrix;

  int size = 0;
  std::vector<std::array<int, 2>> pairs;
  Block_LDLT block;
  Matrix matrix; // its lower triangle
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> eigen;

  Factorization_scene(int number_of_faces, bool is_quad_grid)
  {
    if(is_quad_grid)
    {
      const int side = int(std::sqrt(double(number_of_faces)));
      const auto at = [&](int i, int j) { return j * (side + 1) + i; };
      size = (side + 1) * (side + 1);
      for(int j = 0; j < side; ++j)
        for(int i = 0; i < side; ++i)
        {
          const int v[4] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
          for(int a = 0; a < 4; ++a)
            for(int b = 0; b < a; ++b)
              pairs.push_back({{v[a], v[b]}});
        }
    }
    else
    {
      const Mesh_copy patch = scene().patch(number_of_faces);
      std::vector<int> variable;
      for(const char is_border : patch.mesh.is_border_vertex)
        variable.push_back(is_border ? -1 : size++);
      for(int c = 0; c < patch.mesh.number_of_corners(); ++c)
        pairs.push_back({{variable[patch.mesh.source(c)], variable[patch.mesh.target(c)]}});
    }
    block.analyze(size, pairs);
    block.set_zero();

    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int i, int j, const Eigen::Matrix2d& values) {
      for(int a = 0; a < 2; ++a)
        for(int b = 0; b < 2; ++b)
          if(2 * i + a >= 2 * j + b)
            entries.emplace_back(2 * i + a, 2 * j + b, values(a, b));
    };
    Eigen::Matrix2d weight;
    weight << 1, 0.5, 0.5, 1;
    const auto add_diagonal = [&](int i, const Eigen::Matrix2d& values) {
      block.add_diagonal(i, values);
      add(i, i, values);
    };
    for(int i = 0; i < size; ++i)
      add_diagonal(i, 1e-3 * weight);
    for(std::size_t k = 0; k < pairs.size(); ++k)
    {
      const int a = pairs[k][0], b = pairs[k][1];
      if(a < 0 || b < 0)
        continue;
      add_diagonal(a, weight);
      add_diagonal(b, weight);
      block.add(int(k), a, b, -weight);
      add(a, b, -weight);
      add(b, a, -weight);
    }
    matrix.resize(2 * size, 2 * size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    eigen.analyzePattern(matrix);
  }
};

void factorization(benchmark::State& state, bool is_block, bool is_quad_grid)
{
  Factorization_scene s(int(state.range(0)), is_quad_grid);
  for(auto _ : state)
    if(is_block)
      benchmark::DoNotOptimize(s.block.factorize(0));
    else
    {
      s.eigen.factorize(s.matrix);
      benchmark::DoNotOptimize(s.eigen.info());
    }
}

void symbolic_factorization(benchmark::State& state, bool is_block, bool is_quad_grid)
{
  Factorization_scene s(int(state.range(0)), is_quad_grid);
  for(auto _ : state)
    if(is_block)
      s.block.analyze(s.size, s.pairs);
    else
      s.eigen.analyzePattern(s.matrix);
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
BENCHMARK_CAPTURE(factorization, block, true, false)
  ->Arg(400)
  ->Arg(1000)
  ->Arg(4000)
  ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(factorization, eigen, false, false)
  ->Arg(400)
  ->Arg(1000)
  ->Arg(4000)
  ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(factorization, block_quads, true, true)
  ->Arg(400)
  ->Arg(1000)
  ->Arg(4000)
  ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(factorization, eigen_quads, false, true)
  ->Arg(400)
  ->Arg(1000)
  ->Arg(4000)
  ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(symbolic_factorization, block, true, false)
  ->Arg(400)
  ->Arg(1000)
  ->Arg(4000)
  ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(symbolic_factorization, eigen, false, false)
  ->Arg(400)
  ->Arg(1000)
  ->Arg(4000)
  ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(symbolic_factorization, block_quads, true, true)
  ->Arg(400)
  ->Arg(1000)
  ->Arg(4000)
  ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(symbolic_factorization, eigen_quads, false, true)
  ->Arg(400)
  ->Arg(1000)
  ->Arg(4000)
  ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(closest_point, local, true);
BENCHMARK_CAPTURE(closest_point, tree, false);

} // namespace

BENCHMARK_MAIN();
