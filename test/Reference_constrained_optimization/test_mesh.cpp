// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Meshes as arrays: frames, angles, splitting, points by place.

#include "checks.h"
#include "deformations.h"
#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/internal/mesh/Frame.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/connected_region.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/dihedral_angles.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/point_index.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/self_intersections.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/split_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/surface_metric.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/self_intersections.h>

#include <limits>

using namespace rco_test;

// Points near the reference are not rounded by the transformation to the frame and back.
void test_frame()
{
  using namespace RCO::internal;
  const Shape shape = scrambled(torus(40, 20), 0.3, 4, onto_torus(1, 0.4));
  const Frame here(copy_of(shape));
  RCO_CHECK_EQUAL(here.distance_of_origin(), 0.);
  const auto number_of_changes = [](const Frame& frame, const Mesh_copy& copy) {
    std::size_t number = 0;
    for(const Vector_3& p : copy.points)
      number += frame.to_user(frame(p)) != p;
    return number;
  };
  const double largest = (std::numeric_limits<double>::max)();
  for(const double factor : {1., 0.0254, 1e3, std::ldexp(1., -30), 1e-50, 1e50})
    for(const Vector_3& shift :
        {Vector_3(0, 0, 0), Vector_3(3, 0, -2), Vector_3(30, -20, 10), Vector_3(1e3, 5, -7e3),
         Vector_3(-1e6, 2e6, 0), Vector_3(1e12, -1e9, 30)})
    {
      Mesh_copy copy = copy_of(scaled(shifted(shape, shift), factor));
      const Frame frame(copy);
      const double diagonal = bounding_box_diagonal(copy.mesh, copy.points);
      RCO_CHECK(diagonal <= frame.unit() && frame.unit() <= 2 * diagonal);
      RCO_CHECK_EQUAL(number_of_changes(frame, copy), 0u);
      std::size_t number_of_others = 0;
      for(std::size_t v = 1; v < copy.points.size(); ++v)
      {
        const Vector_3 &p = copy.points[v - 1], &q = copy.points[v];
        number_of_others += frame.unit() * (frame(p) - frame(q)) != p - q;
      }
      RCO_CHECK_EQUAL(number_of_others, 0u);
      // the user's coordinates are measured without rounding
      const Vector_3 moved = frame(copy.points[0]) + Vector_3(0.1, -0.2, 1. / 3),
                     got = frame.to_user(moved);
      RCO_CHECK(same_bits(frame.to_user(frame(got)), got));
      const double ulp = std::numeric_limits<double>::epsilon();
      RCO_CHECK_LESS_EQUAL((frame(got) - moved).norm(), ulp * (2 + frame.distance_of_origin()));
      if(shift.isZero())
        RCO_CHECK(same_bits(frame(got), moved));
      // half as large, and an isolated vertex anywhere
      for(Vector_3& p : copy.points)
        p *= 0.5;
      copy.mesh =
        Indexed_mesh(copy.mesh.face_begin, copy.mesh.corner_vertex, int(copy.points.size()) + 1);
      copy.points.push_back(Vector_3(largest, -largest, 0));
      const Frame half(copy);
      RCO_CHECK(same_bits(half(copy.points[7]), frame(2 * copy.points[7])));
    }
  // invalid input remains unchanged
  for(const double factor : {0., 1e-170, 1e-70, 1e70, 1e160, 1e300})
  {
    const Mesh_copy copy = copy_of(scaled(shape, factor));
    const Frame frame(copy);
    RCO_CHECK_EQUAL(frame.unit(), 1.);
    RCO_CHECK_EQUAL(number_of_changes(frame, copy), 0u);
  }
}

void test_point_index()
{
  Random random(6);
  std::vector<Vector_3> points;
  for(int v = 0; v < 1000; ++v)
    points.push_back(random.in_cube(1));
  const auto all = [](int) { return true; };
  const internal::Point_index index(points, all);
  for(int v = 0; v < 1000; ++v)
  {
    RCO_CHECK_EQUAL(index.find(points[v]), v);
    Vector_3 near = points[v];
    near[v % 3] = std::nextafter(near[v % 3], 2.);
    RCO_CHECK_EQUAL(index.find(near), -1);
  }
  RCO_CHECK_EQUAL(index.find(random.in_cube(1)), -1);
  RCO_CHECK_EQUAL(internal::Point_index({}, all).find(points[0]), -1);

  const internal::Point_index even(points, [](int v) { return v % 2 == 0; });
  RCO_CHECK_EQUAL(even.find(points[4]), 4);
  RCO_CHECK_EQUAL(even.find(points[5]), -1);

  // twice and three times; once only among those that count
  points[10] = points[20];
  points[31] = points[33] = points[35];
  points[40] = points[41];
  const internal::Point_index several(points, [](int v) { return v != 41; });
  RCO_CHECK_EQUAL(several.find(points[10]), -1);
  RCO_CHECK_EQUAL(several.find(points[31]), -1);
  RCO_CHECK_EQUAL(several.find(points[41]), 40);

  for(const double zero : {0., -0.})
  {
    const internal::Point_index flat({Vector_3(zero, 1, zero), Vector_3(1, zero, -zero)}, all);
    for(const double other : {0., -0.})
    {
      RCO_CHECK_EQUAL(flat.find(Vector_3(other, 1, -other)), 0);
      RCO_CHECK_EQUAL(flat.find(Vector_3(1, other, other)), 1);
    }
    const internal::Point_index same({Vector_3(zero, 1, 2), Vector_3(-zero, 1, 2)}, all);
    RCO_CHECK_EQUAL(same.find(Vector_3(0, 1, 2)), -1);
  }
}

void test_surface_metric()
{
  Random random(9);
  for(int i = 0; i < 500; ++i)
  {
    const Vector_3 a = random.in_cube(1), b = random.in_cube(1), c = random.in_cube(1);
    const Vector_3 n = (b - a).cross(c - a);
    const Vector_3 up = random.in_cube(1);
    const Matrix_2 shape = internal::signed_shape(a, b, c, up);
    // lengths and angle are kept, and so is the area but for its sign
    RCO_CHECK_NEAR(shape.col(0).norm(), (b - a).norm(), 1e-12);
    RCO_CHECK_NEAR(shape.col(1).norm(), (c - a).norm(), 1e-12);
    RCO_CHECK_NEAR(shape.col(0).dot(shape.col(1)), (b - a).dot(c - a), 1e-12);
    RCO_CHECK_NEAR(std::abs(shape.determinant()), n.norm(), 1e-12);
    RCO_CHECK_EQUAL(shape.determinant() > 0, n.dot(up) > 0);
    const Matrix_2 turned = internal::signed_shape(a, b, c, -up);
    RCO_CHECK_NEAR(turned.determinant(), -shape.determinant(), 1e-12);

    // a flattening that distorts a little
    const Matrix_2 shape_up = internal::signed_shape(a, b, c, n);
    const Matrix_2 plane = with_singular_values(random(0.5, 2), random(0.5, 2), random) * shape_up;
    const Matrix_2 metric = internal::surface_metric(plane, shape_up, 3);
    if(shape_up.determinant() > 0.02 * shape_up.squaredNorm() &&
       plane.determinant() > 0.02 * plane.squaredNorm())
      RCO_CHECK_LESS_EQUAL((metric * plane - shape_up).norm(), 1e-9);
    // where one side is reversed there is no metric
    RCO_CHECK(internal::surface_metric(plane, -shape_up * Vector_2(1, -1).asDiagonal(), 3) ==
              3 * Matrix_2::Identity());
  }
  const Vector_3 o(0, 0, 0), x(1, 0, 0), up(0, 0, 1);
  const Matrix_2 flat = internal::signed_shape(o, x, 2 * x, up);
  RCO_CHECK(flat.allFinite() && flat.determinant() == 0);
  const Matrix_2 point = internal::signed_shape(o, o, x, up);
  RCO_CHECK(point.allFinite() && point.determinant() == 0);
  RCO_CHECK(internal::surface_metric(Matrix_2::Identity(), flat, 2) == 2 * Matrix_2::Identity());
  RCO_CHECK(internal::surface_metric(flat, Matrix_2::Identity(), 2) == 2 * Matrix_2::Identity());
}

// Half-edges and their opposites, splitting into triangles, regions, and angles, on meshes of all kinds.
void test_indexed_meshes()
{
  const Shape quads = torus(12, 6, 1, 0.4, true);
  for(const Shape& shape :
      {plane_grid(5, 4), icosphere(1), quads, split(quads, [](int f) { return f % 3 == 0; }),
       joined(annulus(9, 2), cube(3, true), Vector_3(5, 0, 0))})
  {
    const Indexed_mesh mesh = indexed(shape);
    for(int c = 0; c < mesh.number_of_corners(); ++c)
    {
      RCO_CHECK_EQUAL(mesh.previous(mesh.next(c)), c);
      const int o = mesh.opposite[c];
      if(o >= 0)
        RCO_CHECK(mesh.opposite[o] == c && mesh.source(o) == mesh.target(c) &&
                  mesh.target(o) == mesh.source(c));
      else
        RCO_CHECK(mesh.is_border_vertex[mesh.source(c)] && mesh.is_border_vertex[mesh.target(c)]);
      const int f = mesh.face_at(mesh.target(c), mesh.source(c));
      RCO_CHECK(f == mesh.corner_face[c] || (o >= 0 && f == mesh.corner_face[o]));
    }
    RCO_CHECK_EQUAL(mesh.find_nonmanifold_vertex(), -1);
    RCO_CHECK_NEAR(internal::surface_area(mesh, shape.points), area(shape), 0.05 * area(shape));

    // the same edges and their opposites, and diagonals
    std::vector<int> polygons;
    const Indexed_mesh triangles = internal::split_mesh(
      mesh, [&](int f) { return internal::split_face(mesh, shape.points, f); },
      [&](int f) { polygons.push_back(f); });
    RCO_CHECK_EQUAL(triangles.number_of_faces(),
                    mesh.number_of_corners() - 2 * mesh.number_of_faces());
    RCO_CHECK_EQUAL(triangles.has_border(), mesh.has_border());
    const auto point = [&](int v) -> const Vector_3& { return shape.points[v]; };
    int diagonals = 0;
    for(int c = 0; c < triangles.number_of_corners(); ++c)
    {
      const int o = triangles.opposite[c], f = polygons[c / 3];
      if(o >= 0)
        RCO_CHECK(triangles.opposite[o] == c && triangles.source(o) == triangles.target(c));
      diagonals += o >= 0 && polygons[o / 3] == f;
      if(c % 3 == 0)
        RCO_CHECK_NEAR(internal::corner_angle(triangles, point, c) +
                         internal::corner_angle(triangles, point, c + 1) +
                         internal::corner_angle(triangles, point, c + 2),
                       180., 1e-9);
    }
    RCO_CHECK_EQUAL(diagonals, 2 * (triangles.number_of_faces() - mesh.number_of_faces()));
  }
  const Shape two = joined(icosphere(1), plane_grid(3, 3), Vector_3(5, 0, 0));
  std::vector<char> is_unvisited(two.faces.size(), 1);
  RCO_CHECK_EQUAL(internal::extract_connected_region(indexed(two), 0, is_unvisited).size(), 80u);
  RCO_CHECK_EQUAL(std::count(is_unvisited.begin(), is_unvisited.end(), 1), 18);

  const Shape box = cube(3);
  const std::vector<double> angles = internal::dihedral_angles(indexed(box), box.points);
  const Indexed_mesh mesh = indexed(box);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
  {
    const Vector_3 middle = 0.5 * (box.points[mesh.source(c)] + box.points[mesh.target(c)]);
    RCO_CHECK_NEAR(angles[c], number_of_planes(middle) == 2 ? 90. : 0., 1e-5);
  }
}

// The same pairs as CGAL finds, also on planes whose coordinates are rounded.
void test_self_intersections()
{
  const Eigen::Matrix3d rotation =
    (Eigen::AngleAxisd(0.7, Vector_3::UnitX()) * Eigen::AngleAxisd(0.4, Vector_3::UnitZ()))
      .toRotationMatrix();
  const Deformation anywhere = [](const Vector_3& p) { return p; };
  std::size_t number = 0;
  const auto test = [&](const std::string& name, const Shape& shape) {
    const Scope scope(name);
    const std::size_t pairs = internal::self_intersections(indexed(shape), shape.points).size();
    RCO_CHECK_EQUAL(pairs, RCO::number_of_self_intersecting_pairs(mesh_of(shape)));
    number += pairs;
  };
  for(int seed = 0; seed < 4; ++seed)
    for(const double amount : {0.4, 1., 3.})
    {
      test("a sphere", scrambled(icosphere(2), amount, seed, anywhere));
      test("quads", scrambled(torus(16, 8, 1, 0.4, true), amount, seed, anywhere));
      test("a plane", scrambled(plane_grid(7, 7), amount, seed, onto_plane));
      test("a plane that is turned",
           rotated(scrambled(plane_grid(7, 7), amount, seed, onto_plane), rotation));
      test("two sheets", scrambled(double_sheet(7, 0.02), amount, seed, anywhere));
    }
  RCO_CHECK_LESS(1000u, number);
  test("fans", rotated(closed_cylinder(60, 2, 1, 1), rotation));
  test("a copy in the same place", joined(icosphere(1), icosphere(1)));
  test("faces of no area", collapsed(icosphere(1), {0, 12}));
}

int main()
{
  run_test("self-intersections", test_self_intersections);
  run_test("frame", test_frame);
  run_test("point index", test_point_index);
  run_test("surface metric", test_surface_metric);
  run_test("indexed meshes", test_indexed_meshes);
  return report();
}
