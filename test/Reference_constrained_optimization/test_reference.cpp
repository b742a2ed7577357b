// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Closest points of the reference: in a triangle, globally, and locally on the same sheet.

#include "checks.h"
#include "deformations.h"

#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/mapping_back.h>

#include <limits>

using namespace rco_test;

internal::Reference_surface surface_of(const Shape& shape)
{
  return internal::Reference_surface(copy_of(shape));
}

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

void test_closest_barycentric()
{
  const Scope scope("closest_barycentric");
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
      p =
        b(0) * t[0] + b(1) * t[1] + b(2) * t[2] + 0.3 * random() * (t[1] - t[0]).cross(t[2] - t[0]);
    }
    const Vector_3 b = internal::closest_barycentric(p, t[0], t[1], t[2]);
    RCO_CHECK(b.allFinite() && b.minCoeff() >= 0);
    RCO_CHECK_NEAR(b.sum(), 1., 1e-14);
    const Vector_3 q = b(0) * t[0] + b(1) * t[1] + b(2) * t[2];
    const double distance = (q - p).norm();
    for(int k = 0; k < 40; ++k)
    {
      const Vector_3 s = random.barycentric();
      RCO_CHECK_LESS_EQUAL(distance, (s(0) * t[0] + s(1) * t[1] + s(2) * t[2] - p).norm() + 1e-7);
    }
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
  const Scope scope("closest_barycentric in needles");
  Random random(11);
  for(int i = 0; i < 3000; ++i)
  {
    const double length = std::pow(10., random(3, 9));
    std::array<Vector_3, 3> t = {{random.in_cube(1), random.in_cube(1), random.in_cube(1)}};
    t[i % 3] = length * random.in_cube(1);
    const Vector_3 s = random.barycentric();
    const Vector_3 p = s(0) * t[0] + s(1) * t[1] + s(2) * t[2];
    const Vector_3 b = internal::closest_barycentric(p, t[0], t[1], t[2]);
    RCO_CHECK_LESS_EQUAL((b(0) * t[0] + b(1) * t[1] + b(2) * t[2] - p).norm(), 1e-11 * length);
  }
}

// the smallest distance to any face
double brute_force_distance(const internal::Reference_surface& surface, const Vector_3& p)
{
  double best = std::numeric_limits<double>::infinity();
  for(int f = 0; f < surface.mesh().number_of_faces(); ++f)
    best = (std::min)(best, (surface.closest_in_face(p, f).position - p).norm());
  return best;
}

void check_surface_point(const internal::Reference_surface& surface,
                         const internal::Surface_point& s)
{
  RCO_CHECK(s.face >= 0 && s.face < surface.mesh().number_of_faces());
  RCO_CHECK(s.barycentric.minCoeff() >= 0);
  RCO_CHECK_NEAR(s.barycentric.sum(), 1., 1e-14);
  RCO_CHECK_LESS_EQUAL((surface.point(s.face, s.barycentric).position - s.position).norm(), 1e-15);
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
    RCO_CHECK_NEAR((surface.closest(p, corner).position - p).norm(), (s.position - p).norm(),
                   1e-12);
    RCO_CHECK_LESS_EQUAL((surface.closest(p, s).position - p).norm(),
                         (s.position - p).norm() + 1e-12);
    check_surface_point(surface, s);
    RCO_CHECK_NEAR((s.position - p).norm(), brute_force_distance(surface, p), 1e-12);
  }
  for(std::size_t v = 0; v < shape.points.size(); v += 7)
    RCO_CHECK_LESS_EQUAL((surface.closest(shape.points[v]).position - shape.points[v]).norm(),
                         1e-15);
}

// quads with opposite vertices in one place: split between these, they would have no area
void test_folded_quads()
{
  const Scope scope("quads folded flat");
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
  const Scope scope("descend on convex surfaces");
  Random random(3);
  for(const Shape& shape : {icosphere(3), closed_cylinder(24, 10, 0.5, 1), cube(6)})
  {
    const internal::Reference_surface surface = surface_of(shape);
    const int n = surface.mesh().number_of_faces();
    for(int i = 0; i < 500; ++i)
    {
      // from somewhere near: the point of a face, pushed outwards and aside
      const int f = random.index(n);
      const internal::Surface_point from = surface.point(f, random.barycentric());
      const Vector_3 normal =
        internal::face_vector_area(surface.mesh(), surface.points(), f).normalized();
      const Vector_3 p = from.position + random(0.2, 0.5) * normal + random.in_cube(0.2);
      const internal::Surface_point s = surface.local_closest(p, f);
      check_surface_point(surface, s);
      RCO_CHECK_NEAR((s.position - p).norm(), brute_force_distance(surface, p), 1e-10);
    }
    // the result is no further away than the start, wherever that is
    for(int i = 0; i < 500; ++i)
    {
      const Vector_3 p = random.in_cube(1.5);
      const int f = random.index(n);
      RCO_CHECK_LESS_EQUAL((surface.local_closest(p, f).position - p).norm(),
                           (surface.closest_in_face(p, f).position - p).norm() + 1e-15);
    }
  }
  // all around a sphere
  const Shape sphere = icosphere(3);
  const internal::Reference_surface surface = surface_of(sphere);
  for(int i = 0; i < 500; ++i)
  {
    const Vector_3 p = random(1.01, 2) * random.in_cube(1).normalized();
    const internal::Surface_point s =
      surface.local_closest(p, random.index(surface.mesh().number_of_faces()));
    RCO_CHECK_NEAR((s.position - p).norm(), brute_force_distance(surface, p), 1e-10);
  }
}

bool is_upper(const Shape& sheet, int f)
{
  const int half = int(sheet.points.size()) / 2;
  for(const int v : sheet.faces[f])
    if(v >= half)
      return false;
  return true;
}

bool is_at_rim(const Vector_3& p)
{
  return p.head<2>().minCoeff() < 0.06 || p.head<2>().maxCoeff() > 0.94;
}

void test_descend_on_double_sheet()
{
  const Scope scope("descend on a double sheet");
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
      const internal::Surface_point s = surface.local_closest(p, f);
      RCO_CHECK(is_upper(sheet, s.face));
      RCO_CHECK_LESS(0., surface.normal(s).z());
      wrong_by_tree += !is_upper(sheet, surface.closest(p).face);
      // and from below
      const int g = 2 * n * n + f;
      RCO_CHECK(!is_upper(sheet, g));
      const internal::Surface_point t = surface.local_closest(p, g);
      RCO_CHECK(!is_upper(sheet, t.face));
      RCO_CHECK_LESS(surface.normal(t).z(), 0.);
    }
    RCO_CHECK(wrong_by_tree > 500); // what a global query does here
  }
}

struct Mesh_on_surface
{
  Indexed_mesh mesh;
  internal::Element_set elements;
  internal::Optimization_state state;

  Mesh_on_surface(const Shape& shape,
                  const internal::Reference_surface& surface,
                  const std::function<bool(int)>& face_is_allowed)
    : mesh(indexed(shape)),
      elements(
        RCO::Minimum_angle_energy(),
        RCO::Energy_context(mesh.face_begin, mesh.corner_vertex, shape.points.size(), 1, 1, 1)),
      state{mesh, surface, elements, {}, {}}
  {
    for(std::size_t v = 0; v < shape.points.size(); ++v)
    {
      internal::Located_vertex placed;
      double best = std::numeric_limits<double>::infinity();
      for(int f = 0; f < surface.mesh().number_of_faces(); ++f)
      {
        const internal::Surface_point s = surface.closest_in_face(shape.points[v], f);
        if(face_is_allowed(f) && (s.position - shape.points[v]).norm() < best)
        {
          best = (s.position - shape.points[v]).norm();
          placed.on_reference = s;
        }
      }
      placed.position = placed.on_reference.position;
      placed.normal = surface.normal(placed.on_reference);
      state.vertices.push_back(placed);
      state.is_free.push_back(!mesh.is_border_vertex[v]);
    }
  }
};

internal::Patch whole_patch(const Mesh_on_surface& placed)
{
  std::vector<int> faces;
  for(int f = 0; f < placed.mesh.number_of_faces(); ++f)
    faces.push_back(f);
  return internal::Patch_builder(placed.mesh).build(faces, placed.state);
}

// M is a coarse sheet on the upper one of two wavy sheets: its chords run beyond the lower one,
// where every point of M's faces must still be mapped to the upper one.
void test_map_to_upper_sheet(const Shape& sheets,
                             const std::function<bool(int)>& is_on_upper,
                             int coarseness,
                             int expected_wrong_by_tree)
{
  const internal::Reference_surface surface = surface_of(sheets);
  Shape coarse = plane_grid(coarseness, coarseness, 0.8);
  for(Vector_3& p : coarse.points)
    p += Vector_3(0.1, 0.1, 0.05 * std::sin(4 * pi * (p.x() + 0.1)));
  const Mesh_on_surface placed(coarse, surface, is_on_upper);
  const internal::Patch patch = whole_patch(placed);
  Random random(5);
  int mapped = 0, tried = 0, wrong_by_tree = 0;
  for(int i = 0; i < 4000; ++i)
  {
    internal::Planar_location location;
    location.triangle = random.index(patch.polygons.number_of_faces());
    location.barycentric = random.barycentric();
    if(i % 5 == 0)
      location.barycentric = Vector_3::Unit(i % 3);
    if(i % 5 == 1)
      location.barycentric = Vector_3(0.5, 0.5, 0);
    Vector_3 point = Vector_3::Zero();
    for(int k = 0; k < 3; ++k)
      point += location.barycentric(k) *
               patch.located[patch.polygons.corner_vertex[3 * location.triangle + k]].position;
    ++tried;
    wrong_by_tree += !is_on_upper(surface.closest(point).face);
    internal::Located_vertex result;
    if(!internal::map_to_reference(patch, location, surface, result))
      continue;
    ++mapped;
    RCO_CHECK(is_on_upper(result.on_reference.face));
    RCO_CHECK_LESS(0., result.normal.z());
    RCO_CHECK(result.position == result.on_reference.position);
    check_surface_point(surface, result.on_reference);
    // it is near: not further than the chords are from the wave
    RCO_CHECK_LESS((result.position - point).norm(), 0.06);
    if(i % 5 == 0)
      RCO_CHECK_LESS_EQUAL((result.position - point).norm(), 1e-12);
  }
  RCO_CHECK_LESS(0.99 * tried, double(mapped));
  RCO_CHECK_LESS(expected_wrong_by_tree, wrong_by_tree);
}

void test_map_to_reference_on_sheets()
{
  for(const double gap : {1e-2, 1e-4, 1e-7})
    for(const int coarseness : {10, 5})
    {
      const Scope scope("map_to_reference on a double sheet of gap " + std::to_string(gap));
      const Shape sheet = double_sheet(48, gap, 0.05);
      test_map_to_upper_sheet(
        sheet, [&](int f) { return is_upper(sheet, f); }, coarseness,
        coarseness == 5 || gap < 1e-3 ? 500 : -1);
    }
  // two shelves of the same normal, which only the path along R distinguishes
  const Scope scope("map_to_reference on two shelves");
  Shape shelf = plane_grid(48, 48);
  for(Vector_3& p : shelf.points)
    p.z() = 0.05 * std::sin(4 * pi * p.x());
  const int faces = int(shelf.faces.size());
  const Shape shelves = joined(shelf, shelf, Vector_3(0, 0, -0.015));
  test_map_to_upper_sheet(
    shelves, [=](int f) { return f < faces; }, 5, 500);
}

// A flat M on a flat R is mapped to itself. Next to faces of R that have no area it may be off by
// their edges' length.
void test_map_to_reference_on_plane()
{
  const Scope scope("map_to_reference on a plane");
  Shape fine = plane_grid(24, 24);
  Random random(6);
  Shape damaged = fine;
  // collapsed edges: vertices that lie on their neighbours
  for(const int v : {130, 205, 333, 410})
    damaged.points[v] = damaged.points[v + 1];
  for(const bool is_damaged : {false, true})
  {
    const Shape& shape = is_damaged ? damaged : fine;
    int exact = 0;
    const internal::Reference_surface surface = surface_of(shape);
    const Mesh_on_surface placed(plane_grid(5, 5), surface, [](int) { return true; });
    const internal::Patch patch = whole_patch(placed);
    for(int i = 0; i < 2000; ++i)
    {
      internal::Planar_location location;
      location.triangle = random.index(patch.polygons.number_of_faces());
      location.barycentric = random.barycentric();
      Vector_3 point = Vector_3::Zero();
      for(int k = 0; k < 3; ++k)
        point += location.barycentric(k) *
                 patch.located[patch.polygons.corner_vertex[3 * location.triangle + k]].position;
      internal::Located_vertex result;
      if(RCO_CHECK(internal::map_to_reference(patch, location, surface, result)))
      {
        const double off = (result.position - point).norm();
        exact += off <= 1e-9;
        RCO_CHECK_LESS_EQUAL(off, is_damaged ? 0.06 : 1e-9);
      }
    }
    RCO_CHECK_LESS_EQUAL(is_damaged ? 1980 : 2000, exact);
  }
}

void test_normals()
{
  const Scope scope("normals");
  internal::Reference_surface sphere = surface_of(icosphere(3));
  Random random(7);
  for(int i = 0; i < 500; ++i)
  {
    const internal::Surface_point s =
      sphere.point(random.index(sphere.mesh().number_of_faces()), random.barycentric());
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
        const auto& t = rough.faces[f];
        sum +=
          (rough.points[t[1]] - rough.points[t[0]]).cross(rough.points[t[2]] - rough.points[t[0]]);
        face = f;
        corner = i;
      }
  RCO_CHECK_LESS_EQUAL(
    (surface.normal(surface.point(face, Vector_3::Unit(corner))) - sum.normalized()).norm(), 1e-12);
}

void test_is_reachable()
{
  const Scope scope("is_reachable");
  const Shape shape = joined(icosphere(2), tetrahedron(), Vector_3(5, 0, 0));
  const internal::Reference_surface surface = surface_of(shape);
  const Indexed_mesh& mesh = surface.mesh();
  Random random(9);
  for(int i = 0; i < 300; ++i)
  {
    const internal::Surface_point from =
      surface.point(random.index(mesh.number_of_faces()), random.barycentric());
    const internal::Surface_point to =
      surface.point(random.index(mesh.number_of_faces()), random.barycentric());
    // shortest path over vertices, by relaxation
    std::vector<double> length(shape.points.size(), std::numeric_limits<double>::infinity());
    for(int k = 0; k < 3; ++k)
      length[mesh.corner_vertex[3 * from.face + k]] =
        (surface.corner_point(from.face, k) - from.position).norm();
    for(bool changes = true; changes;)
    {
      changes = false;
      for(int c = 0; c < mesh.number_of_corners(); ++c)
        for(const auto& e : {std::make_pair(mesh.source(c), mesh.target(c)),
                             std::make_pair(mesh.target(c), mesh.source(c))})
        {
          const double l =
            length[e.first] + (shape.points[e.first] - shape.points[e.second]).norm();
          if(l < length[e.second] - 1e-15)
          {
            length[e.second] = l;
            changes = true;
          }
        }
    }
    double shortest = std::numeric_limits<double>::infinity();
    for(int k = 0; k < 3; ++k)
      shortest = (std::min)(shortest, length[mesh.corner_vertex[3 * to.face + k]] +
                                        (surface.corner_point(to.face, k) - to.position).norm());
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
  const Scope scope("bad references");
  Shape flat;
  flat.add(0, 0, 0);
  flat.add(1, 0, 0);
  flat.add(2, 0, 0);
  flat.triangle(0, 1, 2);
  RCO_CHECK_THROWS(surface_of(flat), RCO::Invalid_input, "zero area");
  // neither where rounding makes one
  Random random(12);
  for(int i = 0; i < 100; ++i)
  {
    Shape line = icosphere(1);
    const Vector_3 origin = random.in_cube(100), direction = random.in_cube(1);
    for(Vector_3& p : line.points)
      p = origin + p.x() * direction;
    RCO_CHECK_THROWS(surface_of(line), RCO::Invalid_input, "zero area");
  }
  // squares of areas would leave the range of double
  for(const double scale : {1e-200, 1e-100, 1e100, 1e200})
  {
    Shape shape = icosphere(1);
    for(Vector_3& p : shape.points)
      p *= scale;
    RCO_CHECK_THROWS(surface_of(shape), RCO::Invalid_input, "reference: ");
  }
  // some faces without area do no harm
  Shape shape = icosphere(2);
  shape.points[20] = shape.points[indexed(shape).target(
    indexed(shape).vertex_corners[indexed(shape).vertex_begin[20]])];
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

int main()
{
  test_closest_barycentric();
  test_closest_in_needles();
  test_closest(icosphere(2), "a sphere");
  test_closest(double_sheet(8, 1e-3, 0.05), "a double sheet");
  test_closest(joined(torus(16, 8), tetrahedron(), Vector_3(1, 0, 0)), "two components");
  test_closest(plane_grid(6, 5, 1, true), "quads");
  test_folded_quads();
  test_degenerate_edges();
  test_descend_on_convex_surfaces();
  test_descend_on_double_sheet();
  test_map_to_reference_on_sheets();
  test_map_to_reference_on_plane();
  test_normals();
  test_is_reachable();
  test_bad_references();
  return report();
}
