// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Feature edges of mechanical parts are detected, and kept by default; bounds by the size of what is there;
// the mean of angles where slivers cannot be opened.

#include "checks.h"
#include "deformations.h"
#include "meshes.h"

#include <CGAL/reference_constrained_optimize.h>

#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/feature_deviation.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/normal_deviation.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

using namespace rco_test;

// in how many coordinates a point is at the surface of the unit cube
int number_of_planes(const Vector_3& p)
{
  int count = 0;
  for(int i = 0; i < 3; ++i)
    count += std::abs(p(i)) < 1e-12 || std::abs(p(i) - 1) < 1e-12;
  return count;
}

// the cube's vertices moved at random within its faces and along its edges
Shape jittered_cube(int n, double amount, bool quads = false)
{
  Shape s = cube(n, quads);
  Random random(5);
  for(Vector_3& p : s.points)
  {
    const Vector_3 move = random.in_cube(amount / n);
    for(int i = 0; i < 3; ++i)
      if(p(i) > 0 && p(i) < 1)
        p(i) += move(i);
  }
  return s;
}

Shape noisy(Shape s, double amount)
{
  Random random(6);
  for(Vector_3& p : s.points)
    p += random.in_cube(amount);
  return s;
}

std::pair<RCO::Feature_report, Mesh::Property_map<Mesh::Edge_index, bool>> detected(Mesh& mesh)
{
  auto map = mesh.add_property_map<Mesh::Edge_index, bool>("e:is_feature", false).first;
  const RCO::Feature_report report = RCO::detect_features(mesh, map);
  std::size_t count = 0;
  for(const Mesh::Edge_index e : mesh.edges())
    count += map[e];
  RCO_CHECK_EQUAL(count, report.number_of_feature_edges);
  RCO_CHECK_EQUAL(count > 0, report.has_features);
  return {report, map};
}

std::size_t number_of_features(const Shape& shape)
{
  Mesh mesh = make_mesh<Mesh>(shape);
  return detected(mesh).first.number_of_feature_edges;
}

void test_detection()
{
  const Scope scope("detection");
  const int n = 6;
  for(const bool quads : {false, true})
  {
    Mesh mesh = make_mesh<Mesh>(cube(n, quads));
    const auto map = detected(mesh).second;
    for(const Mesh::Edge_index e : mesh.edges())
    {
      const auto p = mesh.point(mesh.vertex(e, 0)), q = mesh.point(mesh.vertex(e, 1));
      const Vector_3 middle(0.5 * (p.x() + q.x()), 0.5 * (p.y() + q.y()), 0.5 * (p.z() + q.z()));
      RCO_CHECK_EQUAL(bool(map[e]), number_of_planes(middle) == 2);
    }
  }
  RCO_CHECK_EQUAL(number_of_features(noisy(cube(n), 0.03 / n)), std::size_t(12 * n));
  RCO_CHECK_EQUAL(number_of_features(turned_round(cube(n))), std::size_t(12 * n));
  RCO_CHECK_EQUAL(number_of_features(closed_cylinder(24, 4, 1, 2)), std::size_t(48));
  RCO_CHECK_EQUAL(number_of_features(tetrahedron()), std::size_t(6)); // all there is is sharp

  const Shape ball = icosphere(3);
  for(const double noise : {0., 0.01, 0.03, 0.06})
    RCO_CHECK_EQUAL(number_of_features(noisy(ball, noise)), std::size_t(0));
  RCO_CHECK_EQUAL(number_of_features(torus(30, 12)), std::size_t(0));
  // each component is judged by itself
  RCO_CHECK_EQUAL(number_of_features(joined(cube(n), noisy(ball, 0.06), Vector_3(5, 0, 0))),
                  std::size_t(12 * n));
}

// a roof whose ridge turns by 100 degrees at one end and not at all at the other
Shape fading_roof(int columns, int rows)
{
  Shape roof = plane_grid(columns, 2 * rows);
  for(Vector_3& p : roof.points)
    p = Vector_3(6 * p.x(), 2 * p.y() - 1,
                 -std::abs(2 * p.y() - 1) * std::tan(50 * (1 - p.x()) * CGAL_PI / 180));
  return roof;
}

// A line that is sharp where it begins is followed to where it is hardly bent, and nothing else is taken.
void test_fading_lines()
{
  const Scope scope("fading lines");
  const int columns = 60;
  Mesh mesh = make_mesh<Mesh>(fading_roof(columns, 6));
  const auto map = detected(mesh).second;
  for(const Mesh::Edge_index e : mesh.edges())
  {
    const auto p = mesh.point(mesh.vertex(e, 0)), q = mesh.point(mesh.vertex(e, 1));
    const bool is_ridge = std::abs(p.y()) + std::abs(q.y()) < 1e-12;
    const double angle = 100 * (1 - 0.5 * (p.x() + q.x()) / 6); // up to a degree
    if(map[e])
      RCO_CHECK(is_ridge && angle > 4);
    else
      RCO_CHECK(!is_ridge || angle < 10);
  }
}

// Normal noise turns slivers, not the planes and lines of a part.
void test_noisy_parts()
{
  const Scope scope("noisy parts");
  for(const int columns : {10, 12, 24})
  {
    const Shape part = closed_cylinder(columns, 1, 1, 4);
    const double edge = 2 * std::sin(CGAL_PI / columns); // the shortest ones
    for(const double noise : {0.01, 0.03})
      RCO_CHECK_LESS_EQUAL(std::size_t(2 * columns), number_of_features(noisy(part, noise * edge)));
  }
}

// a square in which one vertex was pulled across an edge: folded, not sharp
void test_folds()
{
  const Scope scope("folds");
  Shape plane = plane_grid(8, 8);
  plane.points[4 * 9 + 4] += Vector_3(0.2, 0.01, 0);
  Mesh mesh = make_mesh<Mesh>(plane);
  const auto before = RCO::orientation_defects(mesh, make_mesh<Mesh>(plane_grid(8, 8)));
  RCO_CHECK_LESS(std::size_t(0), before.total());
  RCO_CHECK_EQUAL(detected(mesh).first.number_of_feature_edges, std::size_t(0));
  const RCO::Result r =
    CGAL::reference_constrained_optimize(mesh, mesh, RCO::Minimum_angle_energy());
  RCO_CHECK_EQUAL(r.number_of_flips + r.number_of_fold_edges, std::size_t(0));
}

struct Outcome
{
  Shape shape;
  RCO::Result result;
};

template <typename Energy, typename NamedParameters>
Outcome run(const Shape& start, const Energy& energy, const NamedParameters& np)
{
  Mesh mesh = make_mesh<Mesh>(start);
  const RCO::Result r = CGAL::reference_constrained_optimize(mesh, mesh, energy, np);
  return {make_shape(mesh), r};
}

template <typename Energy>
void check_cube(const Shape& start, const Energy& energy)
{
  const Outcome after = run(start, energy, params::random_seed(1));
  std::size_t slid = 0;
  for(std::size_t v = 0; v < start.points.size(); ++v)
  {
    const Vector_3 &p = start.points[v], &q = after.shape.points[v];
    RCO_CHECK_EQUAL(number_of_planes(p), number_of_planes(q));
    if(number_of_planes(p) == 3)
      RCO_CHECK(same_bits(p, q));
    slid += number_of_planes(p) == 2 && (p - q).norm() > 1e-3;
  }
  RCO_CHECK_LESS(std::size_t(5), slid);
  RCO_CHECK_LESS(after.result.final_energy, after.result.initial_energy);
  const Mesh before = make_mesh<Mesh>(start), mesh = make_mesh<Mesh>(after.shape);
  RCO_CHECK_LESS(RCO::normal_deviation(mesh, before).maximum, 1e-6);
  RCO_CHECK_NEAR(RCO::feature_deviation(before, mesh).kept, 1, 1e-9);

  // a copy of the mesh counts as the mesh itself
  Mesh same = before;
  CGAL::reference_constrained_optimize(same, before, energy, params::random_seed(1));
  RCO_CHECK(same_bits(make_shape(same), after.shape));
}

void test_keeping()
{
  const Scope scope("keeping");
  const int n = 8;
  const Shape start = jittered_cube(n, 0.3);
  check_cube(start, RCO::Minimum_angle_energy());
  check_cube(jittered_cube(n, 0.3, true), RCO::Quad_angle_energy());

  const RCO::Minimum_angle_energy energy;
  RCO_CHECK_EQUAL(run(start, energy, params::random_seed(0)).result.number_of_feature_edges,
                  std::size_t(12 * n));
  const Outcome free = run(start, energy, params::detect_features(false));
  RCO_CHECK_EQUAL(free.result.number_of_feature_edges, std::size_t(0));
  std::size_t left = 0;
  for(std::size_t v = 0; v < start.points.size(); ++v)
    left += number_of_planes(start.points[v]) > number_of_planes(free.shape.points[v]);
  RCO_CHECK_LESS(std::size_t(0), left); // the test can fail

  // the caller's own lines
  Mesh mesh = make_mesh<Mesh>(start);
  const auto none = mesh.add_property_map<Mesh::Edge_index, bool>("e:none", false).first;
  const RCO::Result r =
    CGAL::reference_constrained_optimize(mesh, mesh, energy, params::edge_is_constrained_map(none));
  RCO_CHECK_EQUAL(r.number_of_feature_edges, std::size_t(0));

  // of another reference
  Mesh other = make_mesh<Mesh>(start);
  const RCO::Result traced =
    CGAL::reference_constrained_optimize(other, make_mesh<Mesh>(jittered_cube(11, 0.2)), energy);
  RCO_CHECK_EQUAL(traced.number_of_feature_edges, std::size_t(12 * n));
  for(std::size_t v = 0; v < start.points.size(); ++v)
    RCO_CHECK_EQUAL(number_of_planes(start.points[v]),
                    number_of_planes(make_shape(other).points[v]));
}

// Strips that nothing can open: the mean of the angles does not fall, the shape stays.
void test_strips()
{
  const Scope scope("strips");
  for(const int columns : {24, 60})
    for(const unsigned int seed : {0, 1, 2, 3})
    {
      Shape start = closed_cylinder(columns, 1, 1, 3);
      for(int i = 0; i < columns; ++i) // a little uneven, so that there is something to do
        start.points[i] =
          Eigen::AngleAxisd(0.3 * std::sin(7. * i) / columns, Vector_3::UnitZ()) * start.points[i];
      const Outcome after = run(start, RCO::Minimum_angle_energy(), params::random_seed(seed));
      RCO_CHECK_LESS_EQUAL(mean_smallest_angle(start), mean_smallest_angle(after.shape) + 1e-9);
      RCO_CHECK_LESS_EQUAL(smallest_angle(start), smallest_angle(after.shape));
      const Mesh before = make_mesh<Mesh>(start), mesh = make_mesh<Mesh>(after.shape);
      RCO_CHECK_EQUAL(RCO::normal_deviation(mesh, before).share_above_45, 0.);
      RCO_CHECK_LESS(0.99, RCO::feature_deviation(before, mesh).kept);
    }
}

// Rounds of few edges, and sheets that are thin against their edges.
void test_coarse_parts()
{
  const Scope scope("coarse parts");
  // edges of 36 and 40 degrees are no noise, and one of nine turns by 40 but for rounding
  for(const int columns : {9, 10, 12})
    for(const int rows : {1, 5})
    {
      const Shape start = closed_cylinder(columns, rows, 1, 3);
      const Mesh before = make_mesh<Mesh>(start);
      RCO_CHECK_LESS_EQUAL(std::size_t(2 * columns), number_of_features(start));
      const Outcome after = run(start, RCO::Minimum_angle_energy(), params::random_seed(0));
      const Mesh mesh = make_mesh<Mesh>(after.shape);
      RCO_CHECK_NEAR(volume(after.shape) / volume(start), 1., 0.01);
      RCO_CHECK_LESS(0.95, RCO::feature_deviation(before, mesh).kept);
      RCO_CHECK_LESS(RCO::normal_deviation(mesh, before).share_above_20, 0.005);
    }
  // sleeves: neither do the walls meet, nor does the volume change
  for(const double wall : {0.02, 0.2})
    for(const unsigned int seed : {0, 1, 2, 3})
    {
      const Shape start = sleeve(24, 4, 3, wall, 6);
      const Outcome after = run(start, RCO::Minimum_angle_energy(), params::random_seed(seed));
      RCO_CHECK_NEAR(volume(after.shape) / volume(start), 1., 0.01);
      RCO_CHECK_EQUAL(RCO::number_of_self_intersecting_pairs(make_mesh<Mesh>(after.shape)),
                      std::size_t(0));
      RCO_CHECK_LESS_EQUAL(mean_smallest_angle(start), mean_smallest_angle(after.shape) + 1e-9);
    }
}

// a coin whose rim is a fillet of a few steps: there is no sharp edge
Shape coin(int columns, int steps)
{
  Shape s = closed_cylinder(columns, steps, 1, 1);
  for(Vector_3& p : s.points)
  {
    const double r = std::hypot(p.x(), p.y()), angle = (p.z() - 0.5) * CGAL_PI, fillet = 0.1;
    const double factor = r > 0 ? 1 + fillet * std::cos(angle) : 1;
    p = Vector_3(factor * p.x(), factor * p.y(), fillet * std::sin(angle));
  }
  return s;
}

void test_rounded_parts()
{
  const Scope scope("rounded parts");
  double least_volume = 1; // without the limits of parts
  for(const int steps : {5, 7, 12})
  {
    const Shape start = coin(24, steps);
    RCO_CHECK_EQUAL(number_of_features(start), std::size_t(0));
    const Outcome after = run(start, RCO::Minimum_angle_energy(), params::random_seed(0));
    const Outcome free = run(start, RCO::Minimum_angle_energy(), params::detect_features(false));
    const Mesh before = make_mesh<Mesh>(start);
    RCO_CHECK_NEAR(volume(after.shape) / volume(start), 1., 0.01);
    RCO_CHECK_LESS(RCO::normal_deviation(make_mesh<Mesh>(after.shape), before).share_above_20,
                   0.005);
    least_volume = (std::min)(least_volume, volume(free.shape) / volume(start));
  }
  RCO_CHECK_LESS(least_volume, 0.97); // the test can fail
}

// Nowhere more than the default, nor than a part of what is there, and no jumps.
void test_local_bounds()
{
  const Scope scope("local bounds");
  Shape shape = plane_grid(30, 30);
  for(Vector_3& p : shape.points) // finer and finer towards a corner
    p = Vector_3(std::pow(p.x(), 3), std::pow(p.y(), 3), 0);
  const RCO::internal::Reference_surface surface(copy_of(shape));
  const double bound = 0.25 * surface.mean_edge_length();
  const Indexed_mesh& mesh = surface.mesh();
  for(const bool mechanical : {false, true})
  {
    const std::vector<char> is_mechanical(mesh.number_of_faces(), mechanical);
    const std::vector<double> bounds = RCO::internal::local_bounds(surface, is_mechanical, bound);
    RCO_CHECK_EQUAL(bounds.size(), shape.points.size());
    RCO_CHECK_LESS_EQUAL(*std::max_element(bounds.begin(), bounds.end()),
                         mechanical ? 0.2 * bound : bound);
    RCO_CHECK_LESS(*std::min_element(bounds.begin(), bounds.end()), 0.1 * bound);
    for(int c = 0; c < mesh.number_of_corners(); ++c)
    {
      const int v = mesh.source(c), w = mesh.target(c);
      RCO_CHECK_LESS_EQUAL(bounds[v],
                           bounds[w] + 0.51 * (shape.points[v] - shape.points[w]).norm());
    }
  }
}

int main()
{
  test_detection();
  test_fading_lines();
  test_noisy_parts();
  test_folds();
  test_keeping();
  test_strips();
  test_coarse_parts();
  test_rounded_parts();
  test_local_bounds();
  return report();
}
