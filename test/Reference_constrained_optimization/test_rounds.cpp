// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Step sizes per vertex, patches that are solved, and their commit.

#include "Located_shape.h"
#include "Recorder.h"
#include "deformations.h"

#include <CGAL/Random.h>
#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/near_sheets.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/Round_solver.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/Vertex_step_sizes.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_partition.h>

#include <algorithm>
#include <chrono>

using namespace rco_test;

struct Fake_mover
{
  std::vector<double> length;
  double displacement_length(int v) const { return length[v]; }
};

// the data of a patch that step sizes depend on; vertices that slide are free at the border, too
internal::Patch patch_of(const Shape& shape, bool slides)
{
  internal::Patch patch;
  patch.polygons = indexed(shape);
  for(int v = 0; v < int(shape.points.size()); ++v)
  {
    patch.vertices.push_back(v);
    patch.is_free.push_back(patch.polygons.is_border_vertex[v] ? slides && v % 7 > 0 : v % 50 > 0);
    patch.located.emplace_back();
    patch.located.back().position = shape.points[v];
  }
  return patch;
}

double largest_difference(const internal::Patch& patch, const Fake_mover& mover, int a, int b)
{
  const double edge = (patch.located[a].position - patch.located[b].position).norm();
  const double displacement = (std::max)(mover.length[a], mover.length[b]);
  return displacement > 0 ? (std::min)(0.2, 0.3 * edge / displacement) : 0.2;
}

// Records every trial; it succeeds up to a given fraction of each vertex.
struct Tries
{
  std::vector<double> most, last;
  std::vector<int> number;
  explicit Tries(std::size_t n) : most(n, 1), last(n, -1), number(n, 0) {}
  auto function()
  {
    return [this](int v, double fraction) {
      RCO_CHECK(fraction >= 0 && fraction <= 1);
      last[v] = fraction;
      ++number[v];
      return fraction <= most[v];
    };
  }
};

// `may_be` is the fraction of a vertex without its neighbours
void check_fractions(const internal::Patch& patch,
                     const Fake_mover& mover,
                     const internal::Vertex_step_sizes& field,
                     const Tries& tries,
                     const std::vector<double>* may_be = nullptr)
{
  const std::vector<double>& fraction = field.fractions();
  std::vector<char> is_limited(fraction.size(), 0);
  const Indexed_mesh& mesh = patch.polygons;
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    for(const bool forwards : {true, false})
    {
      const int a = forwards ? mesh.source(c) : mesh.target(c);
      const int b = forwards ? mesh.target(c) : mesh.source(c);
      if(!patch.is_free[a] || !patch.is_free[b])
        continue;
      const double most = fraction[b] + largest_difference(patch, mover, a, b);
      RCO_CHECK_LESS_EQUAL(fraction[a], most + 1e-14);
      is_limited[a] = is_limited[a] || fraction[a] > most - 1e-14;
    }
  for(std::size_t v = 0; v < fraction.size(); ++v)
  {
    if(!patch.is_free[v])
    {
      RCO_CHECK_EQUAL(tries.number[v], 0);
      continue;
    }
    // the last trial is the result, and it succeeded
    RCO_CHECK_EQUAL(tries.last[v], fraction[v]);
    RCO_CHECK_LESS_EQUAL(fraction[v], tries.most[v]);
    // no fraction is lower than necessary
    if(may_be)
      RCO_CHECK(fraction[v] == (*may_be)[v] || (is_limited[v] && fraction[v] < (*may_be)[v]));
  }
}

void test_vertex_step_sizes()
{
  const Shape shape = scrambled(plane_grid(24, 20), 0.3, 2, onto_plane);
  const int n = int(shape.points.size());
  Random random(3);
  for(int trial = 0; trial < 30; ++trial)
  {
    const internal::Patch patch = patch_of(shape, trial % 2 == 1);
    // from zero to several edges
    Fake_mover mover;
    const double longest = std::pow(10., random(-3, 0.)) * 0.5;
    for(int v = 0; v < n; ++v)
      mover.length.push_back(random() < 0.1 ? 0 : longest * random());
    internal::Vertex_step_sizes field;
    field.start(patch);
    RCO_CHECK(field.fractions() == std::vector<double>(n, 1));
    Tries tries(n);
    field.apply(patch, mover, tries.function());
    RCO_CHECK(field.fractions() == std::vector<double>(n, 1));
    for(int v = 0; v < n; ++v)
      RCO_CHECK_EQUAL(tries.number[v], int(patch.is_free[v]));

    // cuts, of fixed vertices in vain
    std::vector<double> may_be(n, 1);
    for(int i = 0; i < 5; ++i)
    {
      const int v = random.index(n);
      const double factor = random(0.01, 0.9);
      field.reduce(patch, v, factor);
      if(patch.is_free[v])
        may_be[v] *= factor;
    }
    const std::vector<int> number = tries.number;
    field.apply(patch, mover, tries.function());
    check_fractions(patch, mover, field, tries, &may_be);
    for(int v = 0; v < n; ++v) // unchanged fractions are not tried again
      RCO_CHECK_EQUAL(tries.number[v] > number[v], patch.is_free[v] && field.fractions()[v] < 1);

    // failures, some of them at any fraction above 0
    const std::vector<double> before = field.fractions();
    for(int v = 0; v < n; ++v)
      if(random() < 0.02)
        tries.most[v] = random() < 0.3 ? 0 : random();
    for(int v = 0; v < n; ++v)
      field.reduce(patch, v, 0.999);
    field.apply(patch, mover, tries.function());
    check_fractions(patch, mover, field, tries);
    for(int v = 0; v < n; ++v)
      if(patch.is_free[v])
        RCO_CHECK(field.fractions()[v] < before[v] || before[v] == 0);

    // all at once, down to nothing
    const std::vector<double> failed = field.fractions();
    field.reduce_all(patch, 0.5);
    field.apply(patch, mover, tries.function());
    check_fractions(patch, mover, field, tries);
    for(int v = 0; v < n; ++v)
      RCO_CHECK_LESS_EQUAL(field.fractions()[v], patch.is_free[v] ? 0.5 * failed[v] : 1);
    for(int i = 0; i < 10; ++i)
      field.reduce_all(patch, 0.5);
    field.apply(patch, mover, tries.function());
    for(int v = 0; v < n; ++v)
      RCO_CHECK_EQUAL(field.fractions()[v], patch.is_free[v] ? 0. : 1.);
    check_fractions(patch, mover, field, tries);
  }
}

// Patches of a round are solved independently; what is reported of those that are committed adds up to the
// change of the whole mesh.
void test_round(internal::Moves moves, const Shape& start, const Shape& regular)
{
  const Scope scope("round, " + std::to_string(int(moves)));
  Located_shape scene(start, regular);
  const RCO::Exponential_MIPS_density density(1);
  const internal::Global_measure before = scene.measure(density);
  Recorder recorder;
  RCO::Result result;
  internal::Interruption interruption(recorder, std::chrono::steady_clock::now(), 1e9);
  const internal::Loop_parameters parameters;
  internal::Round_solver<CGAL::Sequential_tag, Recorder> solver(scene.state, parameters, recorder,
                                                                result, interruption);
  solver.initialize(internal::Shape_bound());
  internal::Solver_settings settings;
  settings.limits.density = before.largest_density;
  settings.limits.cosine = before.largest_cosine;
  settings.bad_density = 1e300;
  settings.search_cosine = 0.9;
  settings.strain_regularization = internal::largest_regularization;
  CGAL::Random random(1);
  const Indexed_mesh& mesh = scene.copy.mesh;
  const std::vector<internal::Located_vertex> old = scene.state.vertices;
  RCO_CHECK(solver.solve(internal::Patch_partition(mesh, 90).divide(
                           std::vector<char>(mesh.number_of_faces(), 1), random),
                         moves, density, settings));
  const internal::Global_measure after = scene.measure(density);
  RCO_CHECK_LESS(3u, recorder.accepted);
  RCO_CHECK_LESS(recorder.energy_change, 0.);
  RCO_CHECK_NEAR(after.energy - before.energy, recorder.energy_change, 1e-9 * before.energy);
  RCO_CHECK_EQUAL(long(after.defects()) - long(before.defects()), recorder.defect_change);
  RCO_CHECK_LESS_EQUAL(recorder.defect_change, 0);
  for(std::size_t v = 0; v < old.size(); ++v)
    RCO_CHECK(!solver.progress().moved[v] ||
              !same_bits(old[v].position, scene.state.vertices[v].position));
}

// Two patches of a round, each on one of two close sheets, that intersect although neither does alone: the later
// one is not committed.
void test_facing_patches()
{
  const Shape sheets = double_sheet(6, 0.01);
  const int half = int(sheets.points.size()) / 2, upper = half / 2, lower = upper + half;
  Located_shape scene(sheets, sheets);
  internal::Optimization_state& state = scene.state;
  state.set_near_sheets(internal::near_sheets(scene.surface, 1));
  const auto moved_up = [&](int v, double height) {
    internal::Solved_patch s;
    s.patch = scene.patch_of_faces(
      [&](int f) { return std::count(sheets.faces[f].begin(), sheets.faces[f].end(), v) > 0; });
    s.located = s.patch.located;
    const auto found = std::find(s.patch.vertices.begin(), s.patch.vertices.end(), v);
    s.outer_vertices = {int(found - s.patch.vertices.begin())};
    s.located[s.outer_vertices[0]].position.z() += height;
    s.faces_near_sheets = s.patch.faces;
    s.decision.accepted = true;
    s.decision.before.energy = 2;
    s.decision.after.energy = 1;
    return s;
  };
  const std::vector<internal::Located_vertex> start = state.vertices;
  for(const bool is_allowed : {false, true})
  {
    state.vertices = start;
    state.counts.intersections = {is_allowed ? 100 : 0, 0};
    internal::Solved_patch down = moved_up(upper, -0.006), up = moved_up(lower, 0.006);
    std::vector<int> moved;
    internal::commit_boundary(state, down, moved);
    RCO_CHECK(down.decision.accepted);
    RCO_CHECK_EQUAL(state.counts.intersections.now, 0);
    internal::commit_boundary(state, up, moved);
    RCO_CHECK_EQUAL(up.decision.accepted, is_allowed);
    RCO_CHECK_EQUAL(same_bits(state.vertices[lower].position, start[lower].position), !is_allowed);
    RCO_CHECK_EQUAL(state.counts.intersections.now > 0, is_allowed);
  }
}

int main()
{
  run_test("facing patches", test_facing_patches);
  run_test("vertex step sizes", test_vertex_step_sizes);
  const Shape ring = torus(32, 16);
  for(const internal::Moves moves :
      {internal::Moves::on_surface, internal::Moves::flattened, internal::Moves::pattern_search})
    for(const double amount : {0.3, 0.6})
      test_round(moves, scrambled(ring, amount, 2, onto_torus(1, 0.4)), ring);
  return report();
}
