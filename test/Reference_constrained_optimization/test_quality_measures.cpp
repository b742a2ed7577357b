// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The measures on shapes whose figures are known.

#include "test_meshes.h"
#include "test_util.h"

#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>

namespace RCO = CGAL::Reference_constrained_optimization;
using namespace rco_test;
typedef CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3> Mesh;

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

// Points of a face are on it where a needle crosses it, of which only the sides are known to all digits
// (found by fuzzing).
void test_distance_beside_needle()
{
  const Scope scope("distance beside a needle");
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
  // a reference oriented the other way is turned round
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

  // Where a surface passes through itself, the normals of the other part say nothing: here two
  // planes that are nearly turned against each other, and a mesh with vertices on the line where they
  // meet that the reference does not have.
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
  test_angles();
  test_distortion();
  test_drift();
  test_distance_beside_needle();
  test_orientation();
  test_quads();
  test_estimate_and_intersections();
  return report();
}
