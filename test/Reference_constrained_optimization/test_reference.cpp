// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The reference: closest points in a triangle, globally, and locally on the same sheet; faces in a direction,
// lines, features, and local bounds.

#include "meshes.h"
#include "surfaces.h"

#include <CGAL/Reference_constrained_optimization/detect_features.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Polyline_set.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/face_in_direction.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/local_bounds.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/near_sheets.h>

#include <limits>
#include <set>

using namespace rco_test;
using internal::Polyline_point;
using internal::Polyline_set;

// q is the closest point of a convex body to p if no corner w of the body is on p's side of the
// plane through q that is normal to p - q
void check_closest(const Vector_3& p, const Vector_3& q, const std::array<Vector_3, 3>& t)
{
  double size = (p - q).norm();
  for(const Vector_3& w : t)
    size = (std::max)(size, (w - q).norm());
  for(const Vector_3& w : t)
    RCO_CHECK_LESS_EQUAL((p - q).dot(w - q), 1e-11 * size * size);
}

Vector_3 at(const std::array<Vector_3, 3>& t, const Vector_3& b)
{
  return b(0) * t[0] + b(1) * t[1] + b(2) * t[2];
}

void test_closest_barycentric()
{
  Random random(1);
  int inside = 0, on_side = 0, at_corner = 0;
  for(int i = 0; i < 20000; ++i)
  {
    std::array<Vector_3, 3> t = {{random.in_cube(1), random.in_cube(1), random.in_cube(1)}};
    switch(i % 10)
    {
    case 1: // a needle
      t[2] = t[1] + 1e-7 * random.in_cube(1);
      break;
    case 2: // a cap
      t[2] = 0.4 * t[0] + 0.6 * t[1] + 1e-8 * random.in_cube(1);
      break;
    case 3: // on a line
      t[2] = 0.5 * (t[0] + t[1]);
      break;
    case 4:
      t[2] = t[1];
      break;
    case 5:
      t[0] = t[1];
      break;
    case 6: // a point
      t[2] = t[1] = t[0];
      break;
    case 7: // far from the origin
      for(Vector_3& w : t)
        w += Vector_3(100, 50, 20);
      break;
    default:
      break;
    }
    Vector_3 p = t[0] + random.in_cube(2);
    if(i % 7 == 0) // above the inside
    {
      const Vector_3 b = random.barycentric();
      p = at(t, b) + 0.3 * random() * (t[1] - t[0]).cross(t[2] - t[0]);
    }
    const Vector_3 b = internal::closest_barycentric(p, t[0], t[1], t[2]);
    RCO_CHECK(b.allFinite() && b.minCoeff() >= 0);
    RCO_CHECK_NEAR(b.sum(), 1., 1e-14);
    const Vector_3 q = at(t, b);
    const double distance = (q - p).norm();
    for(int k = 0; k < 40; ++k)
      RCO_CHECK_LESS_EQUAL(distance, (at(t, random.barycentric()) - p).norm() + 1e-7);
    for(int k = 0; k < 3; ++k)
      RCO_CHECK_LESS_EQUAL(distance, (t[k] - p).norm() + 1e-12);
    if(i % 10 == 0 || i % 10 > 6)
    {
      check_closest(p, q, t);
      const int zeros = int((b.array() == 0).count());
      inside += zeros == 0;
      on_side += zeros == 1;
      at_corner += zeros == 2;
    }
  }
  RCO_CHECK(inside > 100 && on_side > 100 && at_corner > 100);
}

// a point of a long needle is found there, whichever vertex comes first
void test_closest_in_needles()
{
  Random random(11);
  for(int i = 0; i < 3000; ++i)
  {
    const double length = std::pow(10., random(3, 9));
    std::array<Vector_3, 3> t = {{random.in_cube(1), random.in_cube(1), random.in_cube(1)}};
    t[i % 3] = length * random.in_cube(1);
    const Vector_3 s = random.barycentric();
    const Vector_3 p = at(t, s);
    const Vector_3 b = internal::closest_barycentric(p, t[0], t[1], t[2]);
    RCO_CHECK_LESS_EQUAL((at(t, b) - p).norm(), 1e-11 * length);
  }
}

internal::Surface_point random_point(const internal::Reference_surface& surface, Random& random)
{
  const int f = random.index(surface.mesh().number_of_faces());
  return surface.point(f, random.barycentric());
}

double distance(const internal::Surface_point& s, const Vector_3& p)
{
  return (s.position - p).norm();
}

// the smallest distance to any face
double brute_force_distance(const internal::Reference_surface& surface, const Vector_3& p)
{
  double best = std::numeric_limits<double>::infinity();
  for(int f = 0; f < surface.mesh().number_of_faces(); ++f)
    best = (std::min)(best, distance(surface.closest_in_face(p, f), p));
  return best;
}

void test_closest(const Shape& shape, const std::string& name)
{
  const Scope scope("closest on " + name);
  const internal::Reference_surface surface = surface_of(shape);
  Random random(2);
  for(int i = 0; i < 400; ++i)
  {
    const Vector_3 p = random.in_cube(1.5);
    const internal::Surface_point s = surface.closest(p);
    // what is known already is kept if nothing is closer
    const internal::Surface_point corner =
      surface.point(random.index(surface.mesh().number_of_faces()), Vector_3::UnitX());
    RCO_CHECK_NEAR(distance(surface.closest(p, corner), p), distance(s, p), 1e-12);
    RCO_CHECK_LESS_EQUAL(distance(surface.closest(p, s), p), distance(s, p) + 1e-12);
    check_surface_point(surface, s);
    RCO_CHECK_NEAR(distance(s, p), brute_force_distance(surface, p), 1e-12);
  }
  for(std::size_t v = 0; v < shape.points.size(); v += 7)
    RCO_CHECK_LESS_EQUAL(distance(surface.closest(shape.points[v]), shape.points[v]), 1e-15);
}

// quads with opposite vertices in one place: split between these, they would have no area
void test_folded_quads()
{
  for(const int pinched : {0, 1})
  {
    Shape shape;
    for(int i = 0; i < 4; ++i)
      shape.add(i + 1, 0.3 * i * i, i % 2);
    shape.points[pinched] = shape.points[pinched + 2];
    shape.faces.push_back({0, 1, 2, 3});
    RCO_CHECK_LESS(0.1, surface_of(shape).area());
    test_closest(joined(shape, tetrahedron(), Vector_3(5, 0, 0)), "quads folded flat");
  }
}

// Faces without area, or with so little that it underflows, hold points that no other face has: here
// lines of several faces, one of them on top of another, beside a body.
void test_degenerate_edges()
{
  for(const double width : {0., 1e-317, 1e-160, 1e-16})
  {
    Shape degenerate_edges;
    for(const double x : {0., 1., 3., 0.5, 2., 1.})
      degenerate_edges.add(x, 2 * x, 0);
    degenerate_edges.points[1].z() = degenerate_edges.points[3].z() = width;
    degenerate_edges.triangle(0, 1, 3);
    degenerate_edges.triangle(1, 2, 4);
    degenerate_edges.triangle(2, 1, 5);
    test_closest(joined(tetrahedron(), degenerate_edges, Vector_3(0.5, 0, 0)), "degenerate edges");
    test_closest(joined(degenerate_edges, icosphere(1), Vector_3(0.5, 0, 0)),
                 "degenerate edges through a sphere");
  }
}

// on a convex surface there is one local minimum for a point outside
void test_descend_on_convex_surfaces()
{
  Random random(3);
  for(const Shape& shape : {icosphere(3), closed_cylinder(24, 10, 0.5, 1), cube(6)})
  {
    const internal::Reference_surface surface = surface_of(shape);
    const int n = surface.mesh().number_of_faces();
    for(int i = 0; i < 500; ++i)
    {
      // from somewhere near: the point of a face, pushed outwards and aside
      const internal::Surface_point from = random_point(surface, random);
      const Vector_3 normal =
        internal::face_vector_area(surface.mesh(), surface.points(), from.face).normalized();
      const Vector_3 p = from.position + random(0.2, 0.5) * normal + random.in_cube(0.2);
      const internal::Surface_point s = surface.local_closest(p, from.face);
      check_surface_point(surface, s);
      RCO_CHECK_NEAR(distance(s, p), brute_force_distance(surface, p), 1e-10);
    }
    // the result is no further away than the start, wherever that is
    for(int i = 0; i < 500; ++i)
    {
      const Vector_3 p = random.in_cube(1.5);
      const int f = random.index(n);
      RCO_CHECK_LESS_EQUAL(distance(surface.local_closest(p, f), p),
                           distance(surface.closest_in_face(p, f), p) + 1e-15);
    }
  }
  // all around a sphere
  const Shape sphere = icosphere(3);
  const internal::Reference_surface surface = surface_of(sphere);
  for(int i = 0; i < 500; ++i)
  {
    const Vector_3 p = random(1.01, 2) * random.in_cube(1).normalized();
    const int f = random.index(surface.mesh().number_of_faces());
    RCO_CHECK_NEAR(distance(surface.local_closest(p, f), p), brute_force_distance(surface, p),
                   1e-10);
  }
}

bool is_at_rim(const Vector_3& p)
{
  return p.head<2>().minCoeff() < 0.06 || p.head<2>().maxCoeff() > 0.94;
}

void test_descend_on_double_sheet()
{
  const int n = 40;
  const double gap = 1e-4;
  for(const double wave : {0., 0.05})
  {
    const Shape sheet = double_sheet(n, gap, wave);
    const internal::Reference_surface surface = surface_of(sheet);
    Random random(4);
    int wrong_by_tree = 0;
    for(int i = 0; i < 3000; ++i)
    {
      // a point near one side, often beyond the other
      const int f = random.index(2 * n * n);
      const internal::Surface_point from = surface.point(f, random.barycentric());
      if(is_at_rim(from.position))
        continue;
      const Vector_3 p = from.position + Vector_3(random(-0.03, 0.03), random(-0.03, 0.03),
                                                  random(-20 * gap, 5 * gap));
      wrong_by_tree += !is_upper(sheet, surface.closest(p).face);
      for(const bool from_above : {true, false})
      {
        const int start = from_above ? f : 2 * n * n + f;
        RCO_CHECK_EQUAL(is_upper(sheet, start), from_above);
        const internal::Surface_point s = surface.local_closest(p, start);
        RCO_CHECK_EQUAL(is_upper(sheet, s.face), from_above);
        RCO_CHECK_LESS(0., (from_above ? 1 : -1) * surface.normal(s).z());
      }
    }
    RCO_CHECK(wrong_by_tree > 500); // what a global query does here
  }
}

void test_normals()
{
  internal::Reference_surface sphere = surface_of(icosphere(3));
  Random random(7);
  for(int i = 0; i < 500; ++i)
  {
    const internal::Surface_point s = random_point(sphere, random);
    const Vector_3 n = sphere.normal(s);
    RCO_CHECK_LESS(0.999, n.normalized().dot(s.position.normalized()));
    RCO_CHECK(n.norm() > 0.95 && n.norm() < 1 + 1e-12);
  }
  const internal::Surface_point s = sphere.point(5, Vector_3(0.2, 0.3, 0.5));
  const Vector_3 n = sphere.normal(s);
  sphere.reverse(std::vector<char>(sphere.mesh().number_of_faces(), 1));
  RCO_CHECK(sphere.normal(s) == -n);

  // area-weighted at a corner of a cube: n * n times as many triangles do not matter
  const internal::Reference_surface plane = surface_of(plane_grid(3, 3));
  for(int f = 0; f < plane.mesh().number_of_faces(); ++f)
    RCO_CHECK_LESS_EQUAL(
      (plane.normal(plane.point(f, Vector_3(0.1, 0.2, 0.7))) - Vector_3::UnitZ()).norm(), 1e-12);
  // two sides that cancel out leave rounding: no side of it is outside
  for(int i = 0; i < 100; ++i)
  {
    const Vector_3 u = random.in_cube(1).normalized();
    const Vector_3 v = u.cross(random.in_cube(1)).normalized();
    Shape folded;
    folded.points = {u, v, Vector_3(random(-0.1, 0.1) * u - random(1, 2) * v)};
    folded.faces = {{0, 1, 2}, {2, 1, 0}};
    const internal::Reference_surface two_sided = surface_of(folded);
    RCO_CHECK_EQUAL(two_sided.normal(two_sided.point(0, random.barycentric())).norm(), 0.);
  }
  // by the definition, at one vertex of an irregular mesh
  const Shape rough = scrambled(icosphere(1), 0.3, 8, onto_sphere);
  const internal::Reference_surface surface = surface_of(rough);
  Vector_3 sum = Vector_3::Zero();
  int face = -1, corner = -1;
  for(int f = 0; f < int(rough.faces.size()); ++f)
    for(int i = 0; i < 3; ++i)
      if(rough.faces[f][i] == 7)
      {
        sum += vector_area(rough, rough.faces[f]);
        face = f;
        corner = i;
      }
  RCO_CHECK_LESS_EQUAL(
    (surface.normal(surface.point(face, Vector_3::Unit(corner))) - sum.normalized()).norm(), 1e-12);
}

void test_is_reachable()
{
  const Shape shape = joined(icosphere(2), tetrahedron(), Vector_3(5, 0, 0));
  const internal::Reference_surface surface = surface_of(shape);
  const Indexed_mesh& mesh = surface.mesh();
  Random random(9);
  for(int i = 0; i < 300; ++i)
  {
    const internal::Surface_point from = random_point(surface, random);
    const internal::Surface_point to = random_point(surface, random);
    // shortest path over vertices, by relaxation
    std::vector<double> length(shape.points.size(), std::numeric_limits<double>::infinity());
    for(int k = 0; k < 3; ++k)
      length[mesh.corner_vertex[3 * from.face + k]] =
        distance(from, surface.corner_point(from.face, k));
    for(bool changes = true; changes;)
    {
      changes = false;
      for(int c = 0; c < mesh.number_of_corners(); ++c) // closed: each edge in both directions
      {
        const int v = mesh.source(c), w = mesh.target(c);
        const double l = length[v] + (shape.points[v] - shape.points[w]).norm();
        if(l < length[w] - 1e-15)
        {
          length[w] = l;
          changes = true;
        }
      }
    }
    double shortest = std::numeric_limits<double>::infinity();
    for(int k = 0; k < 3; ++k)
      shortest = (std::min)(shortest, length[mesh.corner_vertex[3 * to.face + k]] +
                                        distance(to, surface.corner_point(to.face, k)));
    const bool same_face = from.face == to.face;
    RCO_CHECK_EQUAL(surface.is_reachable(from, to, 0.99 * shortest), same_face || shortest == 0);
    RCO_CHECK_EQUAL(surface.is_reachable(from, to, 1.01 * shortest),
                    same_face || shortest < std::numeric_limits<double>::infinity());
  }
  // two sides of a thin sheet are near in space, and far apart on the surface
  const Shape sheet = double_sheet(20, 1e-5);
  const internal::Reference_surface thin = surface_of(sheet);
  const internal::Surface_point up = thin.closest(Vector_3(0.51, 0.52, 0.1)),
                                down = thin.closest(Vector_3(0.51, 0.52, -0.1));
  RCO_CHECK_LESS((up.position - down.position).norm(), 1e-4);
  RCO_CHECK(!thin.is_reachable(up, down, 0.5));
  RCO_CHECK(thin.is_reachable(up, down, 3));
}

void test_bad_references()
{
  const Shape flat{{Vector_3(0, 0, 0), Vector_3(1, 0, 0), Vector_3(2, 0, 0)}, {{0, 1, 2}}};
  RCO_CHECK_THROWS(surface_of(flat), RCO::Invalid_input, "zero area");
  // neither where rounding makes one
  Random random(12);
  for(int i = 0; i < 100; ++i)
  {
    const Vector_3 origin = random.in_cube(100), direction = random.in_cube(1);
    const Shape line = deformed(
      icosphere(1), [&](const Vector_3& p) -> Vector_3 { return origin + p.x() * direction; });
    RCO_CHECK_THROWS(surface_of(line), RCO::Invalid_input, "zero area");
  }
  // squares of areas would leave the range of double
  for(const double scale : {1e-200, 1e-100, 1e100, 1e200})
    RCO_CHECK_THROWS(surface_of(scaled(icosphere(1), scale)), RCO::Invalid_input, "reference: ");
  // some faces without area do no harm
  const Shape shape = collapsed(icosphere(2), {20});
  test_closest(shape, "a sphere with faces of no area");
  const internal::Reference_surface surface = surface_of(shape);
  for(int f = 0; f < surface.mesh().number_of_faces(); ++f)
    RCO_CHECK(surface.normal(surface.point(f, Vector_3(1. / 3, 1. / 3, 1. / 3))).allFinite());

  // quads are split, and remember where they come from
  const Shape quads = plane_grid(4, 3, 1, true);
  const internal::Reference_surface split = surface_of(quads);
  RCO_CHECK_EQUAL(split.mesh().number_of_faces(), 24);
  RCO_CHECK_NEAR(split.area(), 0.75, 1e-12);
  for(int f = 0; f < 24; ++f)
  {
    const std::vector<int>& quad = quads.faces[split.original_face(f)];
    for(int c = 3 * f; c < 3 * f + 3; ++c)
      RCO_CHECK(std::find(quad.begin(), quad.end(), split.mesh().corner_vertex[c]) != quad.end());
  }
}

// the best of many ways from the point to the boundary of a triangle
double sampled_progress(const internal::Reference_surface& surface,
                        const Vector_3& from,
                        int face,
                        const Vector_3& along)
{
  double most = 0;
  const int steps = 400;
  for(int i = 0; i < 3; ++i)
    for(int k = 0; k <= steps; ++k)
    {
      const double t = double(k) / steps;
      const Vector_3 displacement = (1 - t) * surface.corner_point(face, i) +
                                    t * surface.corner_point(face, (i + 1) % 3) - from;
      if(displacement.norm() > 1e-12)
        most = (std::max)(most, displacement.normalized().dot(along));
    }
  return most;
}

void test_progress()
{
  Random random(4);
  for(int i = 0; i < 1000; ++i)
  {
    const Vector_3 a = random.in_cube(1), b = random.in_cube(1), d = random.in_cube(1);
    if(a.cross(b).norm() < 0.05 * a.norm() * b.norm())
      continue;
    const double progress = internal::projected_length_in_wedge(a, b, d);
    double most = 0;
    const Vector_3 u = a.normalized(), w = (b - b.dot(u) * u).normalized();
    const double angle = std::atan2(b.dot(w), b.dot(u));
    for(int k = 0; k <= 1000; ++k)
      most =
        (std::max)(most, (std::cos(angle * k / 1000) * u + std::sin(angle * k / 1000) * w).dot(d));
    RCO_CHECK_NEAR(progress, most, 1e-5 * d.norm());
    RCO_CHECK_LESS_EQUAL(most, progress + 1e-12);
    RCO_CHECK_NEAR(internal::projected_length_in_wedge(3 * b, 0.1 * a, d), progress, 1e-12);
  }
  // without an inside
  const Vector_3 x = Vector_3::UnitX();
  RCO_CHECK_EQUAL(internal::projected_length_in_wedge(x, 2 * x, x), 0.);
  RCO_CHECK_EQUAL(internal::projected_length_in_wedge(x, Vector_3::Zero(), x), 0.);
}

void test_face_in_direction(const std::string& name, const Shape& shape)
{
  const Scope scope("face towards, " + name);
  const internal::Reference_surface reference = surface_of(shape);
  const Indexed_mesh& mesh = reference.mesh();
  Random random(5);
  const auto check_from = [&](const internal::Surface_point& from, const std::set<int>& around) {
    const Vector_3 d = random.in_cube(1);
    const int face = internal::face_in_direction(reference, from, d);
    RCO_CHECK(around.count(face) > 0);
    double most = 0;
    for(const int f : around)
      most = (std::max)(most, sampled_progress(reference, from.position, f, d));
    RCO_CHECK_NEAR(sampled_progress(reference, from.position, face, d), most, 1e-4 * d.norm());
    if(most == 0)
      RCO_CHECK_EQUAL(face, from.face);
  };
  for(int c = 0; c < mesh.number_of_corners(); ++c)
  {
    const int f = mesh.corner_face[c], i = c - mesh.face_begin[f], v = mesh.source(c);
    Vector_3 inside = random.barycentric();
    RCO_CHECK_EQUAL(internal::face_in_direction(reference, reference.point(f, inside), inside), f);

    Vector_3 on_edge = Vector_3::Zero();
    on_edge[i] = random(0.2, 0.8);
    on_edge[(i + 1) % 3] = 1 - on_edge[i];
    std::set<int> sides = {f};
    if(mesh.opposite[c] >= 0)
      sides.insert(mesh.corner_face[mesh.opposite[c]]);
    check_from(reference.point(f, on_edge), sides);

    std::set<int> fan;
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
      fan.insert(mesh.corner_face[mesh.vertex_corners[k]]);
    check_from(reference.point(f, Vector_3::Unit(i)), fan);
  }
}

void test_lines()
{
  Polyline_set lines;
  const Vector_3 a(0, 0, 0), b(1, 0, 0), c(1, 2, 0);
  const int first = lines.add(a, b, -1), second = lines.add(b, c, -1), third = lines.add(c, a, -1);
  lines.connect(first, second);
  Polyline_point p{first, 0.25};
  RCO_CHECK(lines.advance(p, 1.25));
  RCO_CHECK_EQUAL(p.segment, second);
  RCO_CHECK_NEAR((lines.position(p) - Vector_3(1, 0.5, 0)).norm(), 0, 1e-15);
  RCO_CHECK(lines.advance(p, -1.5));
  RCO_CHECK_NEAR((lines.position(p) - a).norm(), 0, 1e-15);
  RCO_CHECK(!lines.advance(p, -1e-3)); // the line starts here
  p = {second, 0.5};
  RCO_CHECK(!lines.advance(p, 1.5)); // and ends at c
  RCO_CHECK_NEAR((lines.tangent({second, 0}) - Vector_3(1, 1, 0).normalized()).norm(), 0, 1e-15);
  RCO_CHECK_NEAR((lines.tangent({second, 0.5}) - Vector_3(0, 1, 0)).norm(), 0, 1e-15);

  // once round
  lines.connect(second, third);
  lines.connect(third, first);
  p = {first, 0.25};
  RCO_CHECK(lines.advance(p, 3 + std::sqrt(5.)));
  RCO_CHECK_NEAR((lines.position(p) - Vector_3(0.25, 0, 0)).norm(), 0, 1e-14);
}

Shape noisy(const Shape& s, double amount)
{
  Random random(6);
  return deformed(s, [&](const Vector_3& p) -> Vector_3 { return p + random.in_cube(amount); });
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
  Mesh mesh = mesh_of(shape);
  return detected(mesh).first.number_of_feature_edges;
}

void test_detection()
{
  const int n = 6;
  for(const bool quads : {false, true})
  {
    Mesh mesh = mesh_of(cube(n, quads));
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
  RCO_CHECK_EQUAL(number_of_features(closed_cylinder(24, 4, 1, 2)), 48u);
  RCO_CHECK_EQUAL(number_of_features(tetrahedron()), 6u); // all there is is sharp

  const Shape ball = icosphere(3);
  for(const double noise : {0., 0.01, 0.03, 0.06})
    RCO_CHECK_EQUAL(number_of_features(noisy(ball, noise)), 0u);
  RCO_CHECK_EQUAL(number_of_features(torus(30, 12)), 0u);
  // each component is judged by itself
  RCO_CHECK_EQUAL(number_of_features(joined(cube(n), noisy(ball, 0.06), Vector_3(5, 0, 0))),
                  std::size_t(12 * n));
}

// a roof whose ridge turns by 100 degrees at one end and not at all at the other
Shape fading_roof(int columns, int rows)
{
  return deformed(plane_grid(columns, 2 * rows), [](const Vector_3& p) {
    return Vector_3(6 * p.x(), 2 * p.y() - 1,
                    -std::abs(2 * p.y() - 1) * std::tan(50 * (1 - p.x()) * pi / 180));
  });
}

// A line that is sharp where it begins is followed to where it is hardly bent, and nothing else is taken.
void test_fading_lines()
{
  const int columns = 60;
  Mesh mesh = mesh_of(fading_roof(columns, 6));
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
  for(const int columns : {10, 12, 24})
  {
    const Shape part = closed_cylinder(columns, 1, 1, 4);
    const double edge = 2 * std::sin(pi / columns); // the shortest ones
    for(const double noise : {0.01, 0.03})
      RCO_CHECK_LESS_EQUAL(std::size_t(2 * columns), number_of_features(noisy(part, noise * edge)));
  }
}

// Nowhere more than the default, nor than a part of what is there, and no jumps.
void test_local_bounds()
{
  // finer and finer towards a corner
  const Shape shape = deformed(plane_grid(30, 30), [](const Vector_3& p) {
    return Vector_3(std::pow(p.x(), 3), std::pow(p.y(), 3), 0);
  });
  const internal::Reference_surface surface = surface_of(shape);
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

// Triangles near which R has another sheet: on both sides of a thin sheet, towards the edge of a blade, between
// components that nearly touch, and nowhere on a sphere.
void test_near_sheets()
{
  const auto part = [](const Shape& shape, double scale, const auto& is_in) {
    const internal::Reference_surface surface(copy_of(shape));
    const std::vector<char> near = internal::near_sheets(surface, scale);
    double number = 0, sum = 0;
    for(int f = 0; f < int(shape.faces.size()); ++f)
      if(is_in(Vector_3((shape.points[shape.faces[f][0]] + shape.points[shape.faces[f][1]] +
                         shape.points[shape.faces[f][2]]) /
                        3)))
      {
        ++number;
        sum += near.empty() ? 0 : near[f];
      }
    return sum / number;
  };
  const auto everywhere = [](const Vector_3&) { return true; };
  const auto left = [](const Vector_3& p) { return p.x() < 0.4; };
  const auto right = [](const Vector_3& p) { return p.x() > 0.6; };
  const double edge = 1. / 10;
  RCO_CHECK_EQUAL(part(icosphere(2), 1, everywhere), 0.);
  RCO_CHECK_EQUAL(part(double_sheet(10, 2 * edge), 1, everywhere), 0.);
  RCO_CHECK_LESS(0.8, part(double_sheet(10, 0.2 * edge), 1, everywhere)); // not at the rim
  RCO_CHECK_EQUAL(part(double_sheet(10, 0.5 * edge, 0, 0.9), 1, left), 0.);
  RCO_CHECK_LESS(0.8, part(double_sheet(10, 0.5 * edge, 0, 0.9), 1, right));
  const Shape balls = joined(icosphere(3), icosphere(3), Vector_3(2.01, 0, 0));
  RCO_CHECK_LESS(0., part(balls, 1, right));
  RCO_CHECK_LESS(part(balls, 1, right), 0.1);
  RCO_CHECK_LESS(part(balls, 1, right), part(balls, 4, right));
  RCO_CHECK_EQUAL(part(balls, 1, [](const Vector_3& p) { return std::abs(p.x() - 1) > 0.5; }), 0.);
}

int main()
{
  run_test("closest_barycentric", test_closest_barycentric);
  run_test("closest_barycentric in needles", test_closest_in_needles);
  test_closest(icosphere(2), "a sphere");
  test_closest(double_sheet(8, 1e-3, 0.05), "a double sheet");
  test_closest(joined(torus(16, 8), tetrahedron(), Vector_3(1, 0, 0)), "two components");
  test_closest(plane_grid(6, 5, 1, true), "quads");
  run_test("quads folded flat", test_folded_quads);
  run_test("degenerate edges", test_degenerate_edges);
  run_test("descend on convex surfaces", test_descend_on_convex_surfaces);
  run_test("descend on a double sheet", test_descend_on_double_sheet);
  run_test("normals", test_normals);
  run_test("is_reachable", test_is_reachable);
  run_test("bad references", test_bad_references);
  run_test("progress in a wedge", test_progress);
  Random random(8);
  const Shape bumps = deformed(plane_grid(9, 7), [&](const Vector_3& p) -> Vector_3 {
    return p + random.in_cube(0.03) + random(-0.1, 0.1) * Vector_3::UnitZ();
  });
  test_face_in_direction("bumps with a border", bumps);
  test_face_in_direction("torus",
                         scrambled(torus(14, 7), 0.3, 9, [](const Vector_3& p) { return p; }));
  test_face_in_direction("tetrahedron", tetrahedron());
  run_test("lines", test_lines);
  run_test("detection", test_detection);
  run_test("fading lines", test_fading_lines);
  run_test("noisy parts", test_noisy_parts);
  run_test("local bounds", test_local_bounds);
  run_test("near sheets", test_near_sheets);
  return report();
}
