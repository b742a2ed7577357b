// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The measures on shapes whose figures are known.

#include "checks.h"
#include "deformations.h"
#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>

using namespace rco_test;

namespace {

Shape scaled(Shape shape, double factor)
{
  for(Vector_3& p : shape.points)
    p *= factor;
  return shape;
}

void test_angles()
{
  const RCO::Angle_statistics regular =
    RCO::angle_statistics(make_mesh<Mesh>(equilateral_grid(6, 5, 0.3)));
  RCO_CHECK_NEAR(regular.minimum, 60, 1e-9);
  RCO_CHECK_NEAR(regular.mean, 60, 1e-9);
  RCO_CHECK_NEAR(regular.standard_deviation, 0, 1e-6);
  RCO_CHECK_EQUAL(regular.number_of_faces, 60u);
  RCO_CHECK_EQUAL(regular.number_below_40, 0u);

  // one triangle with angles of 15, 75 and 90 degrees
  Shape one;
  one.add(0, 0, 0);
  one.add(1, 0, 0);
  one.add(1, std::tan(15 * pi / 180), 0);
  one.triangle(0, 1, 2);
  const RCO::Angle_statistics thin = RCO::angle_statistics(make_mesh<Mesh>(one));
  RCO_CHECK_NEAR(thin.minimum, 15, 1e-9);
  RCO_CHECK_EQUAL(thin.number_below_10, 0u);
  RCO_CHECK_EQUAL(thin.number_below_20, 1u);
  const RCO::Corner_angle_statistics corners = RCO::corner_angle_statistics(make_mesh<Mesh>(one));
  RCO_CHECK_NEAR(corners.minimum, 15, 1e-9);
  RCO_CHECK_NEAR(corners.maximum, 90, 1e-9);
  RCO_CHECK_NEAR(corners.mean, 60, 1e-9);
}

void test_distortion()
{
  const Shape sphere = icosphere(2);
  const Mesh source = make_mesh<Mesh>(sphere);
  // sizes do not matter
  const RCO::Distortion_statistics same =
    RCO::distortion_statistics(source, make_mesh<Mesh>(scaled(sphere, 7)));
  RCO_CHECK_NEAR(same.mean, 2, 1e-9);
  RCO_CHECK_NEAR(same.maximum, 2, 1e-9);
  // a plane stretched to a and shrunk to 1/a: (a^2 + a^-2) for every face
  const Shape plane = plane_grid(4, 4);
  Shape stretched = plane;
  for(Vector_3& p : stretched.points)
    p = Vector_3(2 * p.x(), 0.5 * p.y(), 0);
  const RCO::Distortion_statistics d =
    RCO::distortion_statistics(make_mesh<Mesh>(plane), make_mesh<Mesh>(stretched));
  RCO_CHECK_NEAR(d.mean, 4.25, 1e-9);
  RCO_CHECK_NEAR(d.median, 4.25, 1e-9);
  RCO_CHECK_NEAR(d.percentile_99, 4.25, 1e-9);
  RCO_CHECK_THROWS(RCO::distortion_statistics(source, make_mesh<Mesh>(plane)), RCO::Invalid_input,
                   "");
}

void test_drift()
{
  const Mesh plane = make_mesh<Mesh>(plane_grid(8, 8));
  Shape lifted = plane_grid(8, 8);
  for(Vector_3& p : lifted.points)
    p.z() = 0.01;
  const RCO::Drift d = RCO::drift(make_mesh<Mesh>(lifted), plane);
  RCO_CHECK_NEAR(d.mesh_to_reference.maximum, 0.01, 1e-12);
  RCO_CHECK_NEAR(d.reference_to_mesh.maximum, 0.01, 1e-12);
  RCO_CHECK_NEAR(d.root_mean_square(), 0.01, 1e-12);
  RCO_CHECK_NEAR(d.relative_maximum() * d.reference_mean_edge_length, 0.01, 1e-12);

  // A spike of the reference that the mesh lacks is seen from the reference's side, at its height;
  // the mesh's own vertex below it is as far away.
  Shape spike = plane_grid(8, 8);
  const int middle = 4 * 9 + 4;
  spike.points[middle].z() = 0.5;
  const RCO::Drift s = RCO::drift(plane, make_mesh<Mesh>(spike));
  RCO_CHECK_NEAR(s.reference_to_mesh.maximum, 0.5, 1e-12);
  RCO_CHECK_LESS(s.mesh_to_reference.maximum, 0.2);
  RCO_CHECK_LESS(0, s.mesh_to_reference.maximum);

  const RCO::Distance_to_reference far = RCO::distance_to_reference(make_mesh<Mesh>(spike), plane);
  RCO_CHECK_NEAR(far.maximum, 0.5, 1e-12);
  RCO_CHECK_EQUAL(far.vertex, std::size_t(middle));

  // vertices without faces do not make the tolerance larger
  Shape with = spike;
  with.add(0, 1e9, 0);
  const auto tolerance = [](const Shape& s) {
    const Mesh mesh = make_mesh<Mesh>(s);
    return RCO::distance_to_reference(mesh, mesh).tolerance;
  };
  RCO_CHECK_EQUAL(tolerance(with), tolerance(spike));
}

// Points of a face are on it where a needle crosses it, of which only the sides are accurate (found
// by fuzzing).
void test_distance_beside_needle()
{
  const double h = std::sqrt(0.5), z = -1e-9 * h;
  Shape surface;
  surface.points = {Vector_3(0, -h, z), Vector_3(-h, 0, z),    Vector_3(h, h, 0),
                    Vector_3(0, -1, 0), Vector_3(0, 0, -1e-9), Vector_3(0, -h, z)};
  surface.faces = {{0, 1, 2}, {5, 3, 4}};
  Shape points;
  for(int i = 0; i < 30; ++i)
  {
    const double part = 0.001 * i;
    points.points.push_back((1 - 2 * part) * surface.points[0] +
                            part * (surface.points[1] + surface.points[2]));
  }
  for(int v = 0; v < 30; v += 3)
    points.faces.push_back({v, v + 1, v + 2});
  const RCO::Distance_to_reference distance =
    RCO::distance_to_reference(make_mesh<Mesh>(points), make_mesh<Mesh>(surface));
  RCO_CHECK_LESS_EQUAL(distance.maximum, distance.tolerance);
}

void test_orientation()
{
  const Shape flat = plane_grid(6, 6);
  const Mesh reference = make_mesh<Mesh>(flat);
  RCO_CHECK_EQUAL(RCO::orientation_defects(reference, reference).total(), 0u);
  // a vertex pushed over the opposite side turns faces and folds edges
  Shape turned = flat;
  const int middle = 3 * 7 + 3;
  turned.points[middle] = turned.points[middle] + Vector_3(0.3, 0, 0);
  const RCO::Orientation_defects bad = RCO::orientation_defects(make_mesh<Mesh>(turned), reference);
  RCO_CHECK_LESS(0u, bad.number_of_flips);
  RCO_CHECK_LESS(0u, bad.number_of_fold_edges);
  // a reference of opposite orientation is reversed
  Shape back = flat;
  for(auto& f : back.faces)
    std::reverse(f.begin(), f.end());
  RCO_CHECK_EQUAL(RCO::orientation_defects(reference, make_mesh<Mesh>(back)).total(), 0u);

  // A mesh of which a part was to be optimized is measured as a whole, however far away the rest is.
  Shape far = turned;
  for(Vector_3& p : far.points)
    p.z() += 10;
  RCO_CHECK_EQUAL(RCO::orientation_defects(make_mesh<Mesh>(far), reference).number_of_flips,
                  bad.number_of_flips);

  // Where a surface passes through itself, the normals of the other part say nothing: here two planes of
  // nearly opposite orientation, and a mesh with vertices on the line where they meet that the reference
  // does not have.
  const auto crossing = [](int n) {
    Shape tilted = turned_round(plane_grid(n, n));
    for(Vector_3& p : tilted.points)
      p.z() = 0.3 * (p.x() - 0.5);
    return joined(plane_grid(n, n), tilted, Vector_3::Zero());
  };
  for(const Shape& surface : {crossing(3), turned_round(crossing(3))})
    RCO_CHECK_EQUAL(
      RCO::orientation_defects(make_mesh<Mesh>(crossing(16)), make_mesh<Mesh>(surface)).total(),
      0u);
}

// Where sheets of opposite orientation meet, a vertex is on the one that agrees with its faces, though the
// other may be more nearly parallel: waves that cross a plane, and a mesh of their chords.
void test_sheets_turned_against_each_other()
{
  const auto waves = [](int nx, int ny) {
    Shape shape = plane_grid(nx, ny);
    for(Vector_3& p : shape.points)
      p = Vector_3(4 * p.x(), p.y(), std::sin(4 * pi * p.x()) / pi);
    return shape;
  };
  Shape plane = turned_round(plane_grid(5, 5));
  for(Vector_3& p : plane.points)
    p.x() *= 4;
  const Mesh surface = make_mesh<Mesh>(joined(waves(64, 7), plane, Vector_3::Zero()));
  RCO_CHECK_EQUAL(RCO::orientation_defects(make_mesh<Mesh>(waves(4, 5)), surface).total(), 0u);
}

void test_normal_deviation()
{
  for(const Shape& shape :
      {icosphere(3), cube(4), cube(5, true), turned_round(cube(3)), closed_cylinder(200, 3, 1, 2)})
  {
    const Mesh mesh = make_mesh<Mesh>(shape);
    RCO_CHECK_NEAR(RCO::normal_deviation(mesh, mesh).maximum, 0, 1e-5);
    RCO_CHECK_EQUAL(RCO::normal_deviation(mesh, mesh).share_above_10, 0.);
  }
  // a plane, and another of which a third is turned by 50 degrees and two thirds by 15
  const auto bend = [](const Vector_3& p) {
    const auto direction = [](double degrees) {
      return Vector_3(std::cos(degrees * pi / 180), 0, std::sin(degrees * pi / 180));
    };
    return Vector_3(Vector_3(0.5, p.y(), 0) + (std::min)(p.x() - 0.5, 0.) * direction(-50) +
                    (std::max)(p.x() - 0.5, 0.) * direction(15));
  };
  Shape halves = plane_grid(8, 4);
  for(Vector_3& p : halves.points)
    p.x() = p.x() < 0.5 ? 0.25 + 0.5 * p.x() : p.x();
  const Mesh bent = make_mesh<Mesh>(deformed(halves, bend));
  Shape ground = plane_grid(3, 3, 4);
  for(Vector_3& p : ground.points)
    p -= Vector_3(1.7, 1.7, 0);
  for(const Shape& shape : {ground, turned_round(ground)})
  {
    const RCO::Normal_deviation d = RCO::normal_deviation(bent, make_mesh<Mesh>(shape));
    RCO_CHECK_NEAR(d.maximum, 50, 1e-6);
    RCO_CHECK_NEAR(d.mean, 50. / 3 + 15. * 2 / 3, 1e-6);
    RCO_CHECK_NEAR(d.share_above_10, 1, 1e-12);
    RCO_CHECK_NEAR(d.share_above_20, 1. / 3, 1e-12);
    RCO_CHECK_NEAR(d.share_above_45, 1. / 3, 1e-12);
  }
  // a face without area has no normal
  Shape with = ground;
  const int a = with.add(0.1, 0.2, 0), b = with.add(0.4, 0.2, 0), c = with.add(0.9, 0.2, 0);
  with.triangle(a, b, c);
  RCO_CHECK_NEAR(RCO::normal_deviation(bent, make_mesh<Mesh>(with)).mean, 50. / 3 + 10, 1e-6);
  RCO_CHECK_NEAR(RCO::normal_deviation(make_mesh<Mesh>(with), make_mesh<Mesh>(with)).maximum, 0,
                 1e-5);
}

void test_feature_deviation()
{
  // the same edges, whatever the connectivity
  for(const Shape& shape : {cube(4), cube(10), cube(7, true)})
  {
    const RCO::Feature_deviation d =
      RCO::feature_deviation(make_mesh<Mesh>(cube(4)), make_mesh<Mesh>(shape));
    RCO_CHECK_NEAR(d.kept, 1, 1e-12);
    RCO_CHECK_NEAR(d.added, 0, 1e-12);
    RCO_CHECK_NEAR(d.length_before, 12, 1e-9);
    RCO_CHECK_NEAR(d.length_after, 12, 1e-9);
    RCO_CHECK_NEAR(d.before_to_after, 0, 1e-12);
    RCO_CHECK_NEAR(d.after_to_before, 0, 1e-12);
  }
  // Without the edges parallel to the z-axis, whose vertices go inside: two of 45 degrees each instead
  // of each of them, a tenth away, from top to bottom.
  const auto bevel = [](const Vector_3& p) {
    const auto is_end = [](double x) { return x == 0 || x == 1; };
    if(!is_end(p.x()) || !is_end(p.y()))
      return p;
    return Vector_3(p.x() + 0.05 * (1 - 2 * p.x()), p.y() + 0.05 * (1 - 2 * p.y()), p.z());
  };
  const RCO::Feature_deviation beveled =
    RCO::feature_deviation(make_mesh<Mesh>(cube(10)), make_mesh<Mesh>(deformed(cube(10), bevel)));
  RCO_CHECK_LESS(beveled.kept, 0.68);
  RCO_CHECK_LESS(0.5, beveled.kept); // two thirds, but for the corners
  RCO_CHECK_LESS(0.6, beveled.added);
  RCO_CHECK_LESS(beveled.added, 0.75);
  RCO_CHECK_NEAR(beveled.before_to_after, 0.05 * std::sqrt(2.), 0.04);
  // no feature before: what is added is told in diagonals
  const Mesh flat = make_mesh<Mesh>(plane_grid(8, 8)), smooth = make_mesh<Mesh>(icosphere(3));
  const Mesh folded = make_mesh<Mesh>(deformed(plane_grid(8, 8), [](const Vector_3& p) {
    return Vector_3(p.x(), p.y(), (std::max)(0., p.x() - 0.5));
  }));
  const RCO::Feature_deviation ridge = RCO::feature_deviation(flat, folded);
  RCO_CHECK_EQUAL(ridge.kept, 1.);
  RCO_CHECK_NEAR(ridge.added, std::sqrt(0.5), 1e-12);
  RCO_CHECK(std::isinf(ridge.after_to_before));
  const RCO::Feature_deviation lost = RCO::feature_deviation(folded, flat);
  RCO_CHECK_EQUAL(lost.kept, 0.);
  RCO_CHECK_EQUAL(lost.added, 0.);
  RCO_CHECK(std::isinf(lost.before_to_after));
  const RCO::Feature_deviation none = RCO::feature_deviation(smooth, smooth);
  RCO_CHECK_EQUAL(none.kept, 1.);
  RCO_CHECK_EQUAL(none.added, 0.);
}

// a component whose vertices are all in one place is a point of the surface
void test_collapsed_component()
{
  Shape shape = plane_grid(4, 4);
  for(int i = 0; i < 4; ++i)
    shape.add(0.3, 0.3, 5);
  const int first = int(shape.points.size()) - 4;
  shape.triangle(first, first + 1, first + 2);
  shape.triangle(first, first + 2, first + 3);
  const Mesh mesh = make_mesh<Mesh>(shape);
  RCO_CHECK_NEAR(RCO::drift(mesh, mesh).maximum(), 0, 1e-12);
  RCO_CHECK_NEAR(RCO::distance_to_reference(mesh, mesh).maximum, 0, 1e-12);
  RCO_CHECK_NEAR(RCO::drift(mesh, make_mesh<Mesh>(plane_grid(4, 4))).mesh_to_reference.maximum, 5,
                 1e-12);
}

// A cylinder whose ends are fans of thousands of faces: time in proportion to the size, where that in
// proportion to its square would be 25 times as long.
void test_large_fans()
{
  const auto time = [](int columns) {
    const Mesh mesh = make_mesh<Mesh>(closed_cylinder(columns, 1, 1, 1));
    const Mesh moved =
      make_mesh<Mesh>(deformed(closed_cylinder(columns, 1, 1, 1), [](const Vector_3& p) {
        return Vector_3(p.x() + (p.norm() < 0.5 ? 0.02 : 0.), p.y(), p.z());
      }));
    const std::clock_t start = std::clock();
    RCO_CHECK_NEAR(RCO::drift(moved, mesh).maximum(), 0, 1e-9);
    RCO_CHECK_EQUAL(RCO::orientation_defects(moved, mesh).total(), 0u);
    RCO_CHECK_NEAR(RCO::distance_to_reference(moved, mesh).maximum, 0, 1e-9);
    RCO_CHECK_NEAR(RCO::normal_deviation(moved, mesh).mean, 0, 1e-3);
    RCO_CHECK_NEAR(RCO::feature_deviation(mesh, moved).kept, 1, 1e-9);
    return double(std::clock() - start) / CLOCKS_PER_SEC;
  };
  // the least of three: other processes may slow it down
  const double small = (std::min)({time(1000), time(1000), time(1000)}),
               large = (std::min)({time(5000), time(5000), time(5000)});
  RCO_CHECK_LESS(large, 18 * small);
}

void test_quads()
{
  const Shape squares = plane_grid(5, 5, 2, true);
  const Mesh mesh = make_mesh<Mesh>(squares);
  const RCO::Edge_statistics e = RCO::edge_statistics(mesh);
  RCO_CHECK_NEAR(e.mean, 0.4, 1e-12);
  RCO_CHECK_NEAR(e.minimum, 1, 1e-9);
  RCO_CHECK_NEAR(e.maximum, 1, 1e-9);
  RCO_CHECK_NEAR(e.standard_deviation, 0, 1e-6);
  const RCO::Corner_angle_statistics c = RCO::corner_angle_statistics(mesh);
  RCO_CHECK_NEAR(c.minimum, 90, 1e-9);
  RCO_CHECK_NEAR(c.maximum, 90, 1e-9);
  RCO_CHECK_NEAR(RCO::planarity(mesh).maximum, 0, 1e-12);
  RCO_CHECK_EQUAL(RCO::number_of_nonconvex_quads(mesh, make_mesh<Mesh>(plane_grid(5, 5, 2))), 0u);

  // a unit square with one corner lifted by h: the diagonals pass each other at a known distance
  Shape one = plane_grid(1, 1, 1, true);
  const double h = 0.1;
  one.points[3].z() = h;
  const Vector_3 &a = one.points[0], &b = one.points[1], &f = one.points[3], &g = one.points[2];
  const Vector_3 n = (f - a).cross(g - b).normalized();
  const double expected = std::abs(n.dot(b - a)) / (0.5 * ((f - a).norm() + (g - b).norm()));
  RCO_CHECK_NEAR(RCO::planarity(make_mesh<Mesh>(one)).maximum, expected, 1e-12);

  // a corner pushed over the diagonal
  Shape dart = squares;
  const int corner = 2 * 6 + 2;
  dart.points[corner] += Vector_3(0.3, 0.3, 0);
  RCO_CHECK_EQUAL(
    RCO::number_of_nonconvex_quads(make_mesh<Mesh>(dart), make_mesh<Mesh>(plane_grid(5, 5, 2))),
    1u);
  // however far away the mesh is
  for(Vector_3& p : dart.points)
    p.z() += 10;
  RCO_CHECK_EQUAL(
    RCO::number_of_nonconvex_quads(make_mesh<Mesh>(dart), make_mesh<Mesh>(plane_grid(5, 5, 2))),
    1u);
}

void test_estimate_and_intersections()
{
  // valence 6 on flat ground allows 60 degrees; a triangle whose vertices are all at the border
  // keeps its angle
  const RCO::Minimum_angle_estimate flat =
    RCO::minimum_angle_estimate(make_mesh<Mesh>(equilateral_grid(5, 5)));
  RCO_CHECK_NEAR(flat.at_free_vertices, 60, 1e-9);
  // valence 4 and 8 alternate: 360/8
  const RCO::Minimum_angle_estimate grid =
    RCO::minimum_angle_estimate(make_mesh<Mesh>(plane_grid(6, 6)));
  RCO_CHECK_NEAR(grid.at_free_vertices, 45, 1e-9);

  RCO_CHECK_EQUAL(RCO::number_of_self_intersecting_pairs(make_mesh<Mesh>(icosphere(1))), 0u);
  Shape tilted = plane_grid(1, 1);
  for(Vector_3& p : tilted.points)
    p = Vector_3(p.x() + 0.2, 0.5, p.y() - 0.45);
  const Mesh crossing = make_mesh<Mesh>(joined(plane_grid(1, 1), tilted, Vector_3(0, 0, 0)));
  RCO_CHECK_LESS(0u, RCO::number_of_self_intersecting_pairs(crossing));

  RCO_CHECK_LESS(0., RCO::factorization_time(make_mesh<Mesh>(icosphere(3))));
}

} // namespace

int main()
{
  run_test("angles", test_angles);
  run_test("distortion", test_distortion);
  run_test("drift", test_drift);
  run_test("distance beside a needle", test_distance_beside_needle);
  run_test("orientation", test_orientation);
  run_test("sheets turned against each other", test_sheets_turned_against_each_other);
  run_test("normal deviation", test_normal_deviation);
  run_test("feature deviation", test_feature_deviation);
  run_test("collapsed component", test_collapsed_component);
  run_test("large fans", test_large_fans);
  run_test("quads", test_quads);
  run_test("estimate and intersections", test_estimate_and_intersections);
  return report();
}
