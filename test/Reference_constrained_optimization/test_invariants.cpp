// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Accepted steps obey all invariants of a list, also additional ones.

#include "Located_shape.h"
#include "checks.h"
#include "deformations.h"

#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/self_intersections.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/tangent_step.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/near_sheets.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/backtracking.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/Shape_bound.h>
#include <CGAL/Reference_constrained_optimization/internal/writing/Defect_repair.h>

#include <tuple>

using namespace rco_test;

// A user-defined invariant: a bound on the displacement of vertices.
struct Short_steps : internal::Invariant
{
  static double limit;

  bool holds(const internal::Trial& trial, internal::Violating_vertices& violating) const
  {
    bool holds = true;
    for(int v = 0; v < int(trial.located.size()); ++v)
      if((trial.located[v].position - trial.patch.located[v].position).norm() > limit)
      {
        holds = false;
        violating.add(v);
      }
    return holds;
  }
};
double Short_steps::limit = 0;

int number_of_creases(const internal::Optimization_state& state)
{
  return int(
    internal::find_output_defects<CGAL::Sequential_tag>(state, state.vertices).number_of_creases);
}

// proposes the given positions of all vertices
struct Mover_to
{
  std::vector<Vector_3> ways;
  const internal::Reference_surface& surface;

  bool displaced_vertex(const internal::Patch& patch,
                        int v,
                        double t,
                        internal::Located_vertex& result) const
  {
    if(ways[v].isZero(0))
      return true;
    return internal::step_on_surface(surface, patch.located[v], t * ways[v], result);
  }
  double displacement_length(int v) const { return ways[v].norm(); }
};

// a scrambled mesh on its surface, all of it one patch
struct Scene : Located_shape
{
  internal::Patch patch = whole_patch();
  internal::Shape_bound shape_bound; // owns the bounds of the samples
  internal::Patch_samples samples;

  Scene(const Shape& start, const Shape& reference) : Located_shape(start, reference)
  {
    shape_bound.initialize<CGAL::Sequential_tag>(state, 0.1, true, internal::Drift_barrier(1));
    samples = shape_bound.gather(state, patch);
  }

  // steps of Newton's method that are far too long
  Mover_to mover(double length, Random& random) const
  {
    Mover_to result{{}, surface};
    for(const internal::Located_vertex& v : patch.located)
      result.ways.push_back(length * Vector_3(random(-1, 1), random(-1, 1), random(-1, 1)) -
                            0.3 * v.position);
    return result;
  }
};

// Random steps of all lengths: accepted ones obey the invariants, measured independently.
template <typename Backtracking>
void test_random_steps(bool has_short_steps)
{
  const Shape sphere = icosphere(2);
  const RCO::Exponential_MIPS_density density(1);
  int accepted = 0, cut = 0;
  for(int trial = 0; trial < 60; ++trial)
  {
    Random random(trial);
    Scene scene(scrambled(sphere, 0.35, 10 + trial, onto_sphere), sphere);
    const auto before = scene.measure(density);
    const int creases = number_of_creases(scene.state);
    scene.state.counts.creases = {creases, creases};
    internal::Step_limits limits;
    limits.density = before.largest_density;
    limits.cosine = before.largest_cosine;
    // back to the regular mesh, plus a random displacement
    Mover_to mover = scene.mover(0.02 * (trial % 5), random);
    for(std::size_t v = 0; v < mover.ways.size(); ++v)
      mover.ways[v] +=
        sphere.points[scene.patch.vertices[v]] - 0.7 * scene.patch.located[v].position;
    Backtracking backtracking;
    const typename Backtracking::Decision decision =
      backtracking.decide(scene.patch, scene.samples, scene.state, mover, density, limits, true);
    if(!decision.accepted)
      continue;
    ++accepted;
    for(const double part : backtracking.steps())
      cut += part < 1;
    for(std::size_t v = 0; v < scene.patch.vertices.size(); ++v)
    {
      const internal::Located_vertex& now = backtracking.candidate()[v];
      if(has_short_steps)
        RCO_CHECK_LESS_EQUAL((now.position - scene.patch.located[v].position).norm(),
                             Short_steps::limit);
      scene.state.vertices[scene.patch.vertices[v]] = now;
    }
    const auto after = scene.measure(density);
    RCO_CHECK_LESS_EQUAL(after.defects(), before.defects());
    RCO_CHECK_LESS_EQUAL(number_of_creases(scene.state), creases);
    RCO_CHECK(after.defects() < before.defects() || after.energy < before.energy);
    RCO_CHECK_LESS_EQUAL(after.largest_density, before.largest_density);
    RCO_CHECK_LESS_EQUAL(after.largest_cosine, before.largest_cosine);
    RCO_CHECK_NEAR(decision.after.energy, after.energy, 1e-9 * after.energy);
  }
  RCO_CHECK_LESS(20, accepted);
  RCO_CHECK_LESS(100, cut);
}

// The vertices of faces that a step inverts are violating, and the step is reduced.
void test_inversion()
{
  const Shape plane = equilateral_grid(6, 6);
  Scene scene(scrambled(plane, 0.2, 1, onto_plane), plane);
  Mover_to mover{std::vector<Vector_3>(scene.patch.vertices.size(), Vector_3::Zero()),
                 scene.surface};
  int moved = 0;
  while(!scene.patch.is_free[moved])
    ++moved;
  mover.ways[moved] = Vector_3(1.6, 0.1, 0);
  typedef internal::Backtracking_with<std::tuple<internal::Face_orientation>, std::tuple<>> Only;
  const RCO::Exponential_MIPS_density density(1);
  Only backtracking;
  const auto decision =
    backtracking.decide(scene.patch, scene.samples, scene.state, mover, density, {}, true);
  RCO_CHECK(decision.accepted);
  RCO_CHECK_EQUAL(decision.after.defects(), 0);
  RCO_CHECK(backtracking.steps()[moved] > 0 && backtracking.steps()[moved] < 1);

  // without this invariant it is accepted
  internal::Backtracking_with<std::tuple<>, std::tuple<>> none;
  RCO_CHECK(
    none.decide(scene.patch, scene.samples, scene.state, mover, density, {}, true).accepted);
  RCO_CHECK_LESS(backtracking.steps()[moved], none.steps()[moved]);
  for(std::size_t v = 0; v < scene.patch.vertices.size(); ++v)
    scene.state.vertices[scene.patch.vertices[v]] = none.candidate()[v];
  RCO_CHECK_LESS(0u, scene.measure(density).flips);
}

// Vertices beside the ridge of a roof do not reach it where that would make its edges creases.
void test_creases()
{
  const auto roof = [](const Vector_3& p) {
    return Vector_3(p.x(), p.y(), -1.3 * std::abs(p.x() - 0.5));
  };
  const auto beside = [&](const Vector_3& p) {
    return roof(p.x() == 0.5 ? Vector_3(0.56, p.y(), 0) : p);
  };
  Scene scene(deformed(plane_grid(8, 8), beside), deformed(plane_grid(8, 8), roof));
  Mover_to mover{{}, scene.surface};
  for(const internal::Located_vertex& v : scene.patch.located)
    mover.ways.push_back(std::abs(v.position.x() - 0.53) < 0.04
                           ? Vector_3(0.5, v.position.y(), 0) - v.position
                           : Vector_3(0, 0, 0));
  const RCO::Exponential_MIPS_density density(1);
  RCO_CHECK_EQUAL(number_of_creases(scene.state), 0);
  scene.state.counts.creases = {0, 0};
  const auto creases_by = [&](auto backtracking) {
    Scene moved(deformed(plane_grid(8, 8), beside), deformed(plane_grid(8, 8), roof));
    RCO_CHECK(backtracking.decide(scene.patch, scene.samples, scene.state, mover, density, {}, true)
                .accepted);
    for(std::size_t v = 0; v < scene.patch.vertices.size(); ++v)
      moved.state.vertices[scene.patch.vertices[v]] = backtracking.candidate()[v];
    return number_of_creases(moved.state);
  };
  RCO_CHECK_LESS(0, creases_by(internal::Backtracking_with<std::tuple<>, std::tuple<>>()));
  typedef std::tuple<internal::Edge_creases> Only;
  RCO_CHECK_EQUAL(creases_by(internal::Backtracking_with<std::tuple<>, Only>()), 0);
}

// Vertices of two sheets that are closer than their faces are from them do not move so that faces intersect,
// whether both sheets are in the patch or only one.
void test_intersections()
{
  const Shape sheets = double_sheet(12, 0.002, 0.08);
  const RCO::Exponential_MIPS_density density(1);
  const auto pairs_by = [&](auto backtracking, bool has_both, int seed) {
    Scene scene(sheets, sheets);
    scene.state.set_near_sheets(internal::near_sheets(scene.surface, 1));
    scene.state.counts.intersections = {0, 0};
    scene.patch = scene.patch_of_faces([&](int f) { return has_both || is_upper(sheets, f); });
    scene.samples = scene.shape_bound.gather(scene.state, scene.patch);
    Mover_to mover{{}, scene.surface};
    Random random(seed);
    for(int v = 0; v < int(scene.patch.vertices.size()); ++v)
      mover.ways.push_back(scene.patch.is_free[v]
                             ? Vector_3(random(-0.03, 0.03), random(-0.03, 0.03), 0)
                             : Vector_3::Zero());
    if(backtracking
         .decide(scene.patch, scene.samples, scene.state, mover, density, internal::Step_limits(),
                 true)
         .accepted)
      for(std::size_t v = 0; v < scene.patch.vertices.size(); ++v)
        scene.state.vertices[scene.patch.vertices[v]] = backtracking.candidate()[v];
    double moved = 0;
    for(std::size_t v = 0; v < scene.copy.points.size(); ++v)
    {
      moved += (scene.copy.points[v] - scene.state.vertices[v].position).norm();
      scene.copy.points[v] = scene.state.vertices[v].position;
    }
    RCO_CHECK_LESS(0.1, moved);
    return internal::self_intersections(scene.copy.mesh, scene.copy.points).size();
  };
  typedef std::tuple<internal::Face_intersections> Only;
  for(const bool has_both : {false, true})
    for(int seed = 0; seed < 5; ++seed)
    {
      RCO_CHECK_LESS(
        0u, pairs_by(internal::Backtracking_with<std::tuple<>, std::tuple<>>(), has_both, seed));
      RCO_CHECK_EQUAL(pairs_by(internal::Backtracking_with<std::tuple<>, Only>(), has_both, seed),
                      0u);
    }
}

int main()
{
  run_test("creases", test_creases);
  run_test("intersections", test_intersections);

  run_test("the invariants of the package",
           [] { test_random_steps<internal::Backtracking>(false); });
  Short_steps::limit = 0.02;
  typedef decltype(std::tuple_cat(internal::Local_invariants(), std::tuple<Short_steps>())) Local;
  typedef internal::Backtracking_with<Local, internal::Sum_invariants> One_more;
  run_test("one more", [] { test_random_steps<One_more>(true); });
  run_test("inversion", test_inversion);
  return report();
}
