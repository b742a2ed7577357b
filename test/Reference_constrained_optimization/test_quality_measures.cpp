// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The measures on shapes whose figures are known.

#include "checks.h"
#include "deformations.h"
#include "optimization.h"

#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <ctime>
#include <functional>

using namespace rco_test;

namespace {

void test_angles()
{
  const RCO::Angle_statistics regular = RCO::angle_statistics(mesh_of(equilateral_grid(6, 5, 0.3)));
  RCO_CHECK_NEAR(regular.minimum, 60, 1e-9);
  RCO_CHECK_NEAR(regular.mean, 60, 1e-9);
  RCO_CHECK_NEAR(regular.standard_deviation, 0, 1e-6);
  RCO_CHECK_EQUAL(regular.number_of_faces, 60u);
  RCO_CHECK_EQUAL(regular.number_below_40, 0u);

  // one triangle with angles of 15, 75 and 90 degrees
  const Shape one{{Vector_3(0, 0, 0), Vector_3(1, 0, 0), Vector_3(1, std::tan(15 * pi / 180), 0)},
                  {{0, 1, 2}}};
  const RCO::Angle_statistics thin = RCO::angle_statistics(mesh_of(one));
  RCO_CHECK_NEAR(thin.minimum, 15, 1e-9);
  RCO_CHECK_EQUAL(thin.number_below_10, 0u);
  RCO_CHECK_EQUAL(thin.number_below_20, 1u);
  const RCO::Corner_angle_statistics corners = RCO::corner_angle_statistics(mesh_of(one));
  RCO_CHECK_NEAR(corners.minimum, 15, 1e-9);
  RCO_CHECK_NEAR(corners.maximum, 90, 1e-9);
  RCO_CHECK_NEAR(corners.mean, 60, 1e-9);
}

void test_distortion()
{
  const Shape sphere = icosphere(2);
  const Mesh source = mesh_of(sphere);
  // sizes do not matter
  const RCO::Distortion_statistics same =
    RCO::distortion_statistics(source, mesh_of(scaled(sphere, 7)));
  RCO_CHECK_NEAR(same.mean, 2, 1e-9);
  RCO_CHECK_NEAR(same.maximum, 2, 1e-9);
  // a plane stretched to a and shrunk to 1/a: (a^2 + a^-2) for every face
  const Shape plane = plane_grid(4, 4);
  const RCO::Distortion_statistics d =
    RCO::distortion_statistics(mesh_of(plane), mesh_of(scaled(plane, 2, 0.5, 0)));
  RCO_CHECK_NEAR(d.mean, 4.25, 1e-9);
  RCO_CHECK_NEAR(d.median, 4.25, 1e-9);
  RCO_CHECK_NEAR(d.percentile_99, 4.25, 1e-9);
  RCO_CHECK_THROWS(RCO::distortion_statistics(source, mesh_of(plane)), RCO::Invalid_input, "");
}

// Which part of the reference a map covers, and how often; x tells where columns of a square are mapped to.
void test_maps()
{
  const Mesh source = mesh_of(plane_grid(8, 8)), reference = mesh_of(plane_grid(16, 16));
  const auto statistics_of = [&](const std::function<double(double)>& x) {
    const Shape mapped =
      deformed(plane_grid(8, 8), [&](const Vector_3& p) { return Vector_3(x(p.x()), p.y(), 0); });
    const RCO::Map_statistics s = RCO::map_statistics(source, mesh_of(mapped), reference);
    RCO_CHECK_EQUAL(s.number_of_samples, 4 * reference.number_of_faces());
    return s;
  };
  const RCO::Map_statistics same = statistics_of([](double x) { return x; });
  RCO_CHECK(same.is_usable());
  RCO_CHECK_EQUAL(same.number_of_samples_hit_once, same.number_of_samples);
  RCO_CHECK_NEAR(same.distortion.mean, 2, 1e-9);
  RCO_CHECK_EQUAL(same.area_hit_more_than_once + same.area_not_hit + same.collapsed_area, 0.);

  const RCO::Map_statistics folded = statistics_of([](double x) {
    return x <= 0.5 ? x : x <= 0.75 ? 1 - x : 0.25 + 3 * (x - 0.75);
  });
  RCO_CHECK(!folded.is_usable());
  RCO_CHECK_NEAR(folded.area_hit_more_than_once, 0.25, 1e-9);
  RCO_CHECK_EQUAL(folded.number_of_samples_not_hit, 0u);
  const RCO::Map_statistics reversed =
    RCO::map_statistics(source, source, mesh_of(turned_round(plane_grid(16, 16))));
  RCO_CHECK_EQUAL(reversed.number_of_samples_hit_once, reversed.number_of_samples);
  RCO_CHECK_EQUAL(reversed.area_hit_more_than_once, 0.);

  const RCO::Map_statistics half = statistics_of([](double x) { return 0.5 * x; });
  RCO_CHECK(!half.is_usable());
  RCO_CHECK_NEAR(half.area_not_hit, 0.5, 1e-9);
  RCO_CHECK_NEAR(half.largest_uncovered_region, 0.27, 0.02); // triangles from .71 on
  RCO_CHECK_EQUAL(half.area_hit_more_than_once, 0.);

  const RCO::Map_statistics collapsed = statistics_of(
    [](double x) { return x <= 0.5 ? x : 0.5 + (std::max)(1e-5, 4. / 3 * (x - 0.625)); });
  RCO_CHECK_NEAR(collapsed.collapsed_area, 0.125, 1e-9);
  RCO_CHECK(!collapsed.is_usable());
  RCO_CHECK_LESS(1000., collapsed.distortion.mean);

  // the other of two close sheets is no second cover, though a vertex is further away than it
  const Shape sheets =
    joined(plane_grid(8, 8), turned_round(plane_grid(8, 8)), Vector_3(0, 0, -0.02));
  Shape lifted = sheets;
  lifted.points[4 * 9 + 4] += Vector_3(0, 0, 0.1);
  const RCO::Map_statistics close =
    RCO::map_statistics(mesh_of(sheets), mesh_of(lifted), mesh_of(sheets));
  RCO_CHECK_EQUAL(close.number_of_samples_hit_once, close.number_of_samples);
  RCO_CHECK_THROWS(RCO::map_statistics(source, reference, reference), RCO::Invalid_input, "");
}

void test_drift()
{
  const Mesh plane = mesh_of(plane_grid(8, 8));
  const RCO::Drift d = RCO::drift(mesh_of(shifted(plane_grid(8, 8), Vector_3(0, 0, 0.01))), plane);
  RCO_CHECK_NEAR(d.mesh_to_reference.maximum, 0.01, 1e-12);
  RCO_CHECK_NEAR(d.reference_to_mesh.maximum, 0.01, 1e-12);
  RCO_CHECK_NEAR(d.root_mean_square(), 0.01, 1e-12);
  RCO_CHECK_NEAR(d.relative_maximum() * d.reference_mean_edge_length, 0.01, 1e-12);

  // A spike of the reference that the mesh lacks is seen from the reference's side, at its height;
  // the mesh's own vertex below it is as far away.
  Shape spike = plane_grid(8, 8);
  const int middle = 4 * 9 + 4;
  spike.points[middle].z() = 0.5;
  const RCO::Drift s = RCO::drift(plane, mesh_of(spike));
  RCO_CHECK_NEAR(s.reference_to_mesh.maximum, 0.5, 1e-12);
  RCO_CHECK_LESS(s.mesh_to_reference.maximum, 0.2);
  RCO_CHECK_LESS(0, s.mesh_to_reference.maximum);

  const RCO::Distance_to_reference far = RCO::distance_to_reference(mesh_of(spike), plane);
  RCO_CHECK_NEAR(far.maximum, 0.5, 1e-12);
  RCO_CHECK_EQUAL(far.vertex, std::size_t(middle));

  // vertices without faces do not make the tolerance larger
  Shape with = spike;
  with.add(0, 1e9, 0);
  const auto tolerance = [](const Shape& s) {
    const Mesh mesh = mesh_of(s);
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
    RCO::distance_to_reference(mesh_of(points), mesh_of(surface));
  RCO_CHECK_LESS_EQUAL(distance.maximum, distance.tolerance);
}

void test_orientation()
{
  const Shape flat = plane_grid(6, 6);
  const Mesh reference = mesh_of(flat);
  RCO_CHECK_EQUAL(RCO::orientation_defects(reference, reference).total(), 0u);
  // a vertex pushed over the opposite side turns faces and folds edges
  Shape turned = flat;
  const int middle = 3 * 7 + 3;
  turned.points[middle] = turned.points[middle] + Vector_3(0.3, 0, 0);
  const RCO::Orientation_defects bad = RCO::orientation_defects(mesh_of(turned), reference);
  RCO_CHECK_LESS(0u, bad.number_of_flips);
  RCO_CHECK_LESS(0u, bad.number_of_fold_edges);
  // a reference of opposite orientation is reversed
  RCO_CHECK_EQUAL(RCO::orientation_defects(reference, mesh_of(turned_round(flat))).total(), 0u);

  // A mesh of which a part was to be optimized is measured as a whole, however far away the rest is.
  const Mesh far = mesh_of(shifted(turned, Vector_3(0, 0, 10)));
  RCO_CHECK_EQUAL(RCO::orientation_defects(far, reference).number_of_flips, bad.number_of_flips);

  // Where a surface passes through itself, the normals of the other part say nothing: here two planes of
  // nearly opposite orientation, and a mesh with vertices on the line where they meet that the reference
  // does not have.
  const auto crossing = [](int n) {
    return joined(plane_grid(n, n), deformed(turned_round(plane_grid(n, n)), [](const Vector_3& p) {
                    return Vector_3(p.x(), p.y(), 0.3 * (p.x() - 0.5));
                  }));
  };
  for(const Shape& surface : {crossing(3), turned_round(crossing(3))})
    RCO_CHECK_EQUAL(RCO::orientation_defects(mesh_of(crossing(16)), mesh_of(surface)).total(), 0u);
}

// Where sheets of opposite orientation meet, a vertex is on the one that agrees with its faces, though the
// other may be more nearly parallel: waves that cross a plane, and a mesh of their chords.
void test_sheets_turned_against_each_other()
{
  const auto waves = [](int nx, int ny) {
    return deformed(plane_grid(nx, ny), [](const Vector_3& p) {
      return Vector_3(4 * p.x(), p.y(), std::sin(4 * pi * p.x()) / pi);
    });
  };
  const Shape plane = scaled(turned_round(plane_grid(5, 5)), 4, 1, 1);
  const Mesh surface = mesh_of(joined(waves(64, 7), plane));
  RCO_CHECK_EQUAL(RCO::orientation_defects(mesh_of(waves(4, 5)), surface).total(), 0u);
}

void test_normal_deviation()
{
  for(const Shape& shape :
      {icosphere(3), cube(4), cube(5, true), turned_round(cube(3)), closed_cylinder(200, 3, 1, 2)})
  {
    const Mesh mesh = mesh_of(shape);
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
  const Mesh bent = mesh_of(deformed(plane_grid(8, 4), [&](const Vector_3& p) {
    return bend(Vector_3(p.x() < 0.5 ? 0.25 + 0.5 * p.x() : p.x(), p.y(), 0));
  }));
  const Shape ground = shifted(plane_grid(3, 3, 4), Vector_3(-1.7, -1.7, 0));
  for(const Shape& shape : {ground, turned_round(ground)})
  {
    const RCO::Normal_deviation d = RCO::normal_deviation(bent, mesh_of(shape));
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
  RCO_CHECK_NEAR(RCO::normal_deviation(bent, mesh_of(with)).mean, 50. / 3 + 10, 1e-6);
  RCO_CHECK_NEAR(RCO::normal_deviation(mesh_of(with), mesh_of(with)).maximum, 0, 1e-5);
}

void test_feature_deviation()
{
  // the same edges, whatever the connectivity
  for(const Shape& shape : {cube(4), cube(10), cube(7, true)})
  {
    const RCO::Feature_deviation d = RCO::feature_deviation(mesh_of(cube(4)), mesh_of(shape));
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
    RCO::feature_deviation(mesh_of(cube(10)), mesh_of(deformed(cube(10), bevel)));
  RCO_CHECK_LESS(beveled.kept, 0.68);
  RCO_CHECK_LESS(0.5, beveled.kept); // two thirds, but for the corners
  RCO_CHECK_LESS(0.6, beveled.added);
  RCO_CHECK_LESS(beveled.added, 0.75);
  RCO_CHECK_NEAR(beveled.before_to_after, 0.05 * std::sqrt(2.), 0.04);
  // no feature before: what is added is told in diagonals
  const Mesh flat = mesh_of(plane_grid(8, 8)), smooth = mesh_of(icosphere(3));
  const Mesh folded = mesh_of(deformed(plane_grid(8, 8), [](const Vector_3& p) {
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
  const Mesh mesh = mesh_of(shape);
  RCO_CHECK_NEAR(RCO::drift(mesh, mesh).maximum(), 0, 1e-12);
  RCO_CHECK_NEAR(RCO::distance_to_reference(mesh, mesh).maximum, 0, 1e-12);
  RCO_CHECK_NEAR(RCO::drift(mesh, mesh_of(plane_grid(4, 4))).mesh_to_reference.maximum, 5, 1e-12);
}

// A cylinder whose ends are fans of thousands of faces: measuring takes less time than optimizing.
void test_large_fans()
{
  const Shape shape = closed_cylinder(3000, 1, 1, 1);
  const Mesh mesh = mesh_of(shape);
  Mesh moved = mesh_of(deformed(shape, [](const Vector_3& p) {
    return Vector_3(p.x() + (p.norm() < 0.5 ? 0.02 : 0.), p.y(), p.z());
  }));
  const std::clock_t start = std::clock();
  RCO_CHECK_NEAR(RCO::drift(moved, mesh).maximum(), 0, 1e-9);
  RCO_CHECK_EQUAL(RCO::orientation_defects(moved, mesh).total(), 0u);
  RCO_CHECK_NEAR(RCO::distance_to_reference(moved, mesh).maximum, 0, 1e-9);
  RCO_CHECK_NEAR(RCO::normal_deviation(moved, mesh).mean, 0, 1e-3);
  RCO_CHECK_NEAR(RCO::feature_deviation(mesh, moved).kept, 1, 1e-9);
  const std::clock_t middle = std::clock();
  improve_angles(moved, mesh);
  RCO_CHECK_LESS(middle - start, std::clock() - middle);
}

void test_quads()
{
  // rectangles of 1 by 3: as many edges of either length, but for the border
  const RCO::Edge_statistics e =
    RCO::edge_statistics(mesh_of(scaled(plane_grid(4, 4, 4, true), 3, 1, 1)));
  RCO_CHECK_NEAR(e.mean, 2, 1e-12);
  RCO_CHECK_NEAR(e.minimum, 0.5, 1e-12);
  RCO_CHECK_NEAR(e.maximum, 1.5, 1e-12);
  RCO_CHECK_NEAR(e.standard_deviation, 0.5, 1e-12);

  // rhombi of 60 and 120 degrees
  const Shape rhombi = deformed(plane_grid(3, 3, 3, true), [](const Vector_3& p) {
    return Vector_3(p.x() + 0.5 * p.y(), 0.5 * std::sqrt(3.) * p.y(), 0);
  });
  const RCO::Corner_angle_statistics c = RCO::corner_angle_statistics(mesh_of(rhombi));
  RCO_CHECK_NEAR(c.minimum, 60, 1e-9);
  RCO_CHECK_NEAR(c.maximum, 120, 1e-9);
  RCO_CHECK_NEAR(c.mean, 90, 1e-9);
  RCO_CHECK_NEAR(c.standard_deviation, 30, 1e-9);

  // A square whose halves are lifted by an angle t on both sides of a diagonal: the other diagonal
  // passes at a height of sin t, and is 2 cos t long where the first is 2.
  for(const double t : {0., 0.01, 0.3, 1.2})
  {
    const Shape bent{{Vector_3(1, 0, 0), Vector_3(0, std::cos(t), std::sin(t)), Vector_3(-1, 0, 0),
                      Vector_3(0, -std::cos(t), std::sin(t))},
                     {{0, 1, 2, 3}}};
    const RCO::Planarity p = RCO::planarity(mesh_of(bent));
    RCO_CHECK_NEAR(p.maximum, std::tan(0.5 * t), 1e-12);
    RCO_CHECK_NEAR(p.mean, p.maximum, 1e-15);
    RCO_CHECK_EQUAL(p.number_of_quads, 1u);
  }
  const RCO::Planarity mixed =
    RCO::planarity(mesh_of(split(plane_grid(3, 3, 1, true), [](int f) { return f % 3 == 0; })));
  RCO_CHECK_EQUAL(mixed.number_of_quads, 6u);
  RCO_CHECK_NEAR(mixed.maximum, 0, 1e-12);

  // quads that are not convex, on either orientation of the reference; triangles do not count
  Shape grid = plane_grid(9, 9, 9, true);
  for(const int v : {22, 26, 62})
    grid.points[v] += Vector_3(0.6, 0.7, 0);   // a reflex corner each
  std::swap(grid.points[65], grid.points[66]); // the two at the edge cross themselves
  const Shape floor = plane_grid(7, 7, 9);
  const auto number_broken = [](const Shape& quads, const Shape& reference) {
    return RCO::number_of_nonconvex_quads(mesh_of(quads), mesh_of(reference));
  };
  for(const Shape& r : {floor, turned_round(floor), plane_grid(5, 5, 9, true)})
    RCO_CHECK_EQUAL(number_broken(grid, r), 3u + 2);
  RCO_CHECK_EQUAL(number_broken(turned_round(grid), floor), 3u + 2);
  RCO_CHECK_EQUAL(number_broken(shifted(grid, Vector_3(0, 0, 10)), floor), 3u + 2);
  RCO_CHECK_EQUAL(number_broken(split(grid, [](int) { return true; }), floor), 0u);
  RCO_CHECK_EQUAL(number_broken(plane_grid(9, 9, 9, true), floor), 0u);
}

void test_estimate_and_intersections()
{
  // valence 6 on flat ground allows 60 degrees; a triangle whose vertices are all at the border
  // keeps its angle
  const RCO::Minimum_angle_estimate flat =
    RCO::minimum_angle_estimate(mesh_of(equilateral_grid(5, 5)));
  RCO_CHECK_NEAR(flat.at_free_vertices, 60, 1e-9);
  // valence 4 and 8 alternate: 360/8
  const RCO::Minimum_angle_estimate grid = RCO::minimum_angle_estimate(mesh_of(plane_grid(6, 6)));
  RCO_CHECK_NEAR(grid.at_free_vertices, 45, 1e-9);

  RCO_CHECK_EQUAL(RCO::number_of_self_intersecting_pairs(mesh_of(icosphere(1))), 0u);
  const Shape tilted = deformed(
    plane_grid(1, 1), [](const Vector_3& p) { return Vector_3(p.x() + 0.2, 0.5, p.y() - 0.45); });
  const Mesh crossing = mesh_of(joined(plane_grid(1, 1), tilted));
  RCO_CHECK_LESS(0u, RCO::number_of_self_intersecting_pairs(crossing));

  RCO_CHECK_LESS(0., RCO::factorization_time(mesh_of(icosphere(3))));
}

} // namespace

int main()
{
  run_test("angles", test_angles);
  run_test("distortion", test_distortion);
  run_test("maps", test_maps);
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
