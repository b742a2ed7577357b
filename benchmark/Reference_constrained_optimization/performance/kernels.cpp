// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Micro-benchmarks of single steps, on patches of a bumpy torus.

#include "../../../test/Reference_constrained_optimization/shapes.h"

#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/Flattened_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/numerics/Block_LDLT.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/On_surface_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/Located_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_selection.h>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>
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
  const auto point = [=](int i, int j) {
    const double a = 2 * rco_test::pi * i / columns, b = 2 * rco_test::pi * j / rows;
    const double r = 0.4 * (1 + 0.1 * std::sin(5 * a) * std::cos(3 * b));
    return Vector_3((1 + r * std::cos(b)) * std::cos(a), (1 + r * std::cos(b)) * std::sin(a),
                    r * std::sin(b));
  };
  return copy_of(rco_test::grid(columns, rows, rco_test::Diagonals::first, point, true, true));
}

// the torus as mesh and reference, at the start of an optimization
struct Scene
{
  Mesh_copy copy = bumpy_torus(240, 96);
  RCO::Minimum_angle_energy energy;
  Located_mesh located{copy, copy, energy, std::vector<char>(copy.points.size(), 1)};
  const Reference_surface& surface = located.reference();
  const Optimization_state& state = located.state();
  Face_geometry geometry;

  Scene() { geometry.update(copy.mesh, copy.points); }

  Patch patch(int size) const
  {
    Selection_parameters parameters;
    parameters.maximum_patch_size = size;
    parameters.developability_threshold = 1;
    Patch_selection selection(copy.mesh, parameters);
    return Patch_builder(copy.mesh).build(selection.grow(0, geometry, [](int) { return false; }),
                                          state);
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
  const Face_geometry& geometry = scene().geometry;
  for(auto _ : state)
  {
    Cone_proxy_fit fit;
    for(int f = 0; f < n; ++f)
      fit.add(geometry.normals[f], geometry.areas[f]);
    benchmark::DoNotOptimize(fit.fit());
  }
}

enum class Method { conformal, mean_value, tutte };

// what a map to a convex border distorts is repaired by descent
void flattening(benchmark::State& state, Method method)
{
  const Patch patch = scene().patch(int(state.range(0)));
  const std::vector<Vector_3> points = patch.positions();
  Flattening_parameters parameters;
  parameters.use_conformal = method == Method::conformal;
  parameters.use_mean_value = method != Method::tutte;
  Patch_flattener flattener;
  for(auto _ : state)
    state.counters["distortion"] =
      flattener.flatten(patch.triangles(), points, parameters).distortion;
}

// CGAL's, for comparison; it finds its own start
void flattening_as_rigid_as_possible(benchmark::State& state)
{
  typedef CGAL::Simple_cartesian<double> Kernel;
  typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;
  namespace SMP = CGAL::Surface_mesh_parameterization;
  const Patch patch = scene().patch(int(state.range(0)));
  Mesh mesh;
  for(const Located_vertex& p : patch.located)
    mesh.add_vertex(Kernel::Point_3(p.position.x(), p.position.y(), p.position.z()));
  for(int f = 0; f < patch.triangles().number_of_faces(); ++f)
  {
    const int* v = &patch.triangles().corner_vertex[3 * f];
    mesh.add_face(Mesh::Vertex_index(v[0]), Mesh::Vertex_index(v[1]), Mesh::Vertex_index(v[2]));
  }
  Mesh::Halfedge_index border;
  for(const Mesh::Halfedge_index h : mesh.halfedges())
    if(mesh.is_border(h))
      border = h;
  const auto uv = mesh.add_property_map<Mesh::Vertex_index, Kernel::Point_2>("v:uv").first;
  for(auto _ : state)
    if(SMP::parameterize(mesh, SMP::ARAP_parameterizer_3<Mesh>(), border, uv) != SMP::OK)
      state.SkipWithError("no parameterization");
}

std::vector<Vector_2> flat(const Patch& patch)
{
  return Patch_flattener().flatten(patch.triangles(), patch.positions()).positions;
}

// one step from the start, its pattern being analyzed
void newton_step_in_plane(benchmark::State& state)
{
  const Patch patch = scene().patch(int(state.range(0)));
  const std::vector<Vector_2> start = flat(patch);
  Planar_problem problem;
  problem.set_elements(patch,
                       [](const Element_set::Element&) { return Eigen::Matrix2d::Identity(); });
  Projected_newton optimizer;
  optimizer.analyze(problem);
  for(auto _ : state)
  {
    std::vector<Vector_2> u = start;
    benchmark::DoNotOptimize(
      optimizer.minimize(problem, scene().energy.density(), u, 1, 0.).final_energy);
  }
}

// the same in the tangent planes of the vertices, which are set up anew for every step
void newton_step_on_surface(benchmark::State& state)
{
  const Patch patch = scene().patch(int(state.range(0)));
  On_surface_mover mover(scene().surface, 1);
  mover.propose(patch, Patch_samples(), scene().energy.density());
  for(auto _ : state)
    benchmark::DoNotOptimize(
      mover.propose_again(patch, Patch_samples(), {}, scene().energy.density()));
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
      const Patch patch = scene().patch(number_of_faces);
      const Indexed_mesh& mesh = patch.triangles();
      std::vector<int> variable;
      for(const char is_free : patch.is_free)
        variable.push_back(is_free ? size++ : -1);
      for(int c = 0; c < mesh.number_of_corners(); ++c)
        pairs.push_back({{variable[mesh.source(c)], variable[mesh.target(c)]}});
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

// points half an edge away from a vertex, from a triangle at that vertex on
void location(benchmark::State& state)
{
  const Patch patch = scene().patch(1000);
  const Indexed_mesh& mesh = patch.triangles();
  const std::vector<Vector_2> u = flat(patch);
  std::vector<int> start(u.size(), -1);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    start[mesh.corner_vertex[c]] = c / 3;
  int c = 0;
  for(auto _ : state)
  {
    const Vector_2 p = 0.5 * (u[mesh.source(c)] + u[mesh.target(c)]);
    benchmark::DoNotOptimize(walk(mesh, u, p, start[mesh.source(c)]).triangle);
    c = (c + 977) % mesh.number_of_corners();
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
    benchmark::DoNotOptimize(is_local ? s.surface.local_closest(p, start) : s.surface.closest(p));
    f = (f + 977) % s.copy.mesh.number_of_faces();
  }
}

void patch_sizes(benchmark::internal::Benchmark* benchmark)
{
  benchmark->Arg(400)->Arg(1000)->Arg(4000)->Unit(benchmark::kMicrosecond);
}

BENCHMARK(cone_proxy)->Arg(1000);
BENCHMARK_CAPTURE(flattening, conformal, Method::conformal)->Apply(patch_sizes);
BENCHMARK_CAPTURE(flattening, mean_value, Method::mean_value)->Apply(patch_sizes);
BENCHMARK_CAPTURE(flattening, tutte, Method::tutte)->Apply(patch_sizes);
BENCHMARK(flattening_as_rigid_as_possible)->Apply(patch_sizes);
BENCHMARK(newton_step_in_plane)->Apply(patch_sizes);
BENCHMARK(newton_step_on_surface)->Apply(patch_sizes);
BENCHMARK_CAPTURE(factorization, block, true, false)->Apply(patch_sizes);
BENCHMARK_CAPTURE(factorization, eigen, false, false)->Apply(patch_sizes);
BENCHMARK_CAPTURE(factorization, block_quads, true, true)->Apply(patch_sizes);
BENCHMARK_CAPTURE(factorization, eigen_quads, false, true)->Apply(patch_sizes);
BENCHMARK_CAPTURE(symbolic_factorization, block, true, false)->Apply(patch_sizes);
BENCHMARK_CAPTURE(symbolic_factorization, eigen, false, false)->Apply(patch_sizes);
BENCHMARK_CAPTURE(symbolic_factorization, block_quads, true, true)->Apply(patch_sizes);
BENCHMARK_CAPTURE(symbolic_factorization, eigen_quads, false, true)->Apply(patch_sizes);
BENCHMARK(location);
BENCHMARK_CAPTURE(closest_point, local, true);
BENCHMARK_CAPTURE(closest_point, tree, false);

} // namespace

BENCHMARK_MAIN();
