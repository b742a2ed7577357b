// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Flattening of patches, the checks on it, location in the plane, and mapping back.

#include "Located_shape.h"
#include "surfaces.h"

#include <CGAL/Reference_constrained_optimization/internal/flattening/mapping_back.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/patch_flattening.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/planar_location.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/split_mesh.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

using namespace rco_test;

typedef CGAL::Exact_predicates_inexact_constructions_kernel Exact;

Exact::Point_2 exact(const Vector_2& p) { return Exact::Point_2(p(0), p(1)); }

bool is_positive(const Vector_2& a, const Vector_2& b, const Vector_2& c)
{
  return CGAL::orientation(exact(a), exact(b), exact(c)) == CGAL::LEFT_TURN;
}

// Local injectivity without rounding: all triangles are positive, and of the triangles at an inner
// vertex exactly one holds the direction of the x-axis. (Counter-clockwise from a side below the
// axis to one above it less than half a turn leads through the axis.)
bool is_locally_injective_exactly(const Indexed_mesh& mesh, const std::vector<Vector_2>& u)
{
  std::vector<int> hits(u.size(), 0);
  for(int t = 0; t < mesh.number_of_faces(); ++t)
  {
    const int* v = &mesh.corner_vertex[3 * t];
    if(!is_positive(u[v[0]], u[v[1]], u[v[2]]))
      return false;
    for(int i = 0; i < 3; ++i)
    {
      const Vector_2 &o = u[v[i]], &a = u[v[(i + 1) % 3]], &b = u[v[(i + 2) % 3]];
      hits[v[i]] += (a(1) < o(1) && b(1) > o(1)) || (a(1) == o(1) && a(0) > o(0));
    }
  }
  for(std::size_t i = 0; i < u.size(); ++i)
    if(!mesh.is_border_vertex[i] && hits[i] != 1)
      return false;
  return true;
}

double planar_area(const Indexed_mesh& mesh, const std::vector<Vector_2>& u)
{
  double sum = 0;
  for(int c = 0; c < mesh.number_of_corners(); ++c)
  {
    const Vector_2 &a = u[mesh.source(c)], &b = u[mesh.target(c)];
    sum += 0.5 * (a(0) * b(1) - a(1) * b(0));
  }
  return sum;
}

// the point with barycentric coordinates w in the triangle t
template <typename Point>
Point point_in(const Indexed_mesh& mesh, const std::vector<Point>& points, int t, const Vector_3& w)
{
  const int* v = &mesh.corner_vertex[3 * t];
  return w(0) * points[v[0]] + w(1) * points[v[1]] + w(2) * points[v[2]];
}

// triangles that hold p, borders included, exactly
std::vector<int>
holding(const Indexed_mesh& mesh, const std::vector<Vector_2>& u, const Vector_2& p)
{
  std::vector<int> result;
  for(int t = 0; t < mesh.number_of_faces(); ++t)
  {
    bool inside = true;
    for(int c = 3 * t; c < 3 * t + 3; ++c)
      inside = inside && !is_positive(u[mesh.target(c)], u[mesh.source(c)], p);
    if(inside)
      result.push_back(t);
  }
  return result;
}

struct Expected
{
  double distortion = 1e6;          // with both parameterizations
  double fallback_distortion = 1e6; // with the convex border alone
  bool keeps_area = true;
};

// all guarantees of a flattening, by each method
void test_flattening(const Shape& shape, const std::string& name, const Expected& expected)
{
  const Indexed_mesh mesh = indexed(shape);
  internal::Patch_flattener flattener;
  for(const std::string method : {"conformal", "mean-value coordinates", "equal weights"})
  {
    const bool use_conformal = method == "conformal";
    const Scope scope("flattening of " + name + ", " + method);
    internal::Flattening_parameters parameters;
    parameters.use_conformal = use_conformal;
    parameters.use_mean_value = method != "equal weights";
    if(!parameters.use_mean_value) // from afar
    {
      parameters.maximum_descent_steps = 500;
      parameters.descent_tolerance = 1e-6;
    }
    const internal::Flattening result = flattener.flatten(mesh, shape.points, parameters);
    if(!RCO_CHECK(result.path != internal::Flattening_path::failed))
      continue;
    if(!use_conformal)
      RCO_CHECK(result.path == internal::Flattening_path::convex_border);
    if(!RCO_CHECK_EQUAL(result.positions.size(), shape.points.size()))
      continue;
    RCO_CHECK(is_locally_injective_exactly(mesh, result.positions));
    RCO_CHECK(internal::is_locally_injective(mesh, result.positions));
    // a free border moves during the descent, but no part of the patch shrinks to nothing
    const double flat_area = planar_area(mesh, result.positions);
    const double bound = use_conformal ? expected.distortion : expected.fallback_distortion;
    if(expected.keeps_area)
      RCO_CHECK_NEAR(flat_area / area(shape), 1., bound < 4.5 ? 0.12 : 0.3);
    RCO_CHECK_LESS_EQUAL(4 - 1e-9, result.distortion);
    RCO_CHECK_LESS_EQUAL(result.distortion, bound);
    // the object keeps nothing of what it did before
    internal::Patch_flattener fresh;
    RCO_CHECK(fresh.flatten(mesh, shape.points, parameters).positions == result.positions);
  }
}

Shape sphere_minus(int levels, const std::function<bool(const Vector_3&)>& drop)
{
  const Shape sphere = icosphere(levels);
  return compacted(without_faces(sphere, [&](int f) {
    const std::vector<int>& t = sphere.faces[f];
    return drop((sphere.points[t[0]] + sphere.points[t[1]] + sphere.points[t[2]]) / 3);
  }));
}

void test_flattenings()
{
  const Expected isometric{4 + 1e-9, 4.1}, nearly{4.06, 4.1}; // the latter is where descent ends
  const Expected any;

  const Shape single{{Vector_3(0, 0, 0), Vector_3(3, 0, 1), Vector_3(1, 2, 0)}, {{0, 1, 2}}};
  test_flattening(single, "one triangle", isometric);
  test_flattening(plane_grid(1, 1), "two triangles", isometric);
  test_flattening(plane_grid(12, 1), "a strip", isometric);
  const Shape rough = scrambled(plane_grid(12, 9), 0.35, 1, onto_plane);
  test_flattening(rough, "a plane", isometric);
  test_flattening(shifted(scaled(rough, 1e-3), Vector_3(20, 30, 40)), "a small plane far away",
                  isometric);
  test_flattening(scaled(rough, 1e4), "a large plane", isometric);

  // developable: a tube slit open, covering nearly all round, and a cone
  test_flattening(cylinder(40, 12, 0.5, 1, 2 * pi * 0.975), "most of a cylinder", isometric);
  test_flattening(scrambled(cylinder(40, 12, 0.5, 1, 2 * pi * 0.975), 0.3, 2, onto_cylinder(0.5)),
                  "most of a rough cylinder", nearly);
  test_flattening(cone(40, 12, 0.6, 0.3, 1, 2 * pi * 0.97), "most of a cone", isometric);
  test_flattening(compacted(without_faces(tetrahedron(), [](int f) { return f == 1; })),
                  "three faces of a tetrahedron", any);

  // nearly closed
  test_flattening(sphere_minus(3, [](const Vector_3& c) { return c.z() < 0; }), "half a sphere",
                  {5, 5});
  for(const double height : {-0.8, -0.97, -0.99})
    test_flattening(sphere_minus(3, [=](const Vector_3& c) { return c.z() < height; }),
                    "a sphere open below " + std::to_string(height), any);
  test_flattening(compacted(without_faces(icosphere(2), [](int f) { return f == 0; })),
                  "a sphere without one face", any);
  test_flattening(compacted(without_faces(cube(6), [](int f) { return f < 3; })), "a cube", any);
  // a tower on a plane
  test_flattening(deformed(plane_grid(16, 16),
                           [](const Vector_3& p) {
                             const Vector_3 d = p - Vector_3(0.5, 0.5, 0);
                             return Vector_3(p.x(), p.y(), 1.5 * std::exp(-60 * d.squaredNorm()));
                           }),
                  "a tower", any);
  // a saddle has too much border for the plane
  test_flattening(deformed(plane_grid(16, 16, 2),
                           [](const Vector_3& p) {
                             return Vector_3(p.x(), p.y(), 2 * (p.x() - 1) * (p.y() - 1));
                           }),
                  "a saddle", any);

  // triangles of little or no area
  Expected wider; // slivers may be given some width
  wider.keeps_area = false;
  test_flattening(scaled(plane_grid(10, 10), 1, 1e-3, 1), "slivers", wider);
  Shape degenerate = plane_grid(12, 12);
  degenerate.points[13 * 5 + 5] = degenerate.points[13 * 5 + 6];
  degenerate.points[13 * 9 + 3] =
    0.5 * (degenerate.points[13 * 9 + 4] + degenerate.points[13 * 8 + 4]);
  degenerate.points[13 * 3 + 9] = degenerate.points[13 * 3 + 10] = degenerate.points[13 * 4 + 9];
  test_flattening(degenerate, "faces of no area", any);
  // folded over in space: an inner vertex far out of its ring
  Shape folded = plane_grid(10, 10);
  folded.points[11 * 5 + 5] += Vector_3(0.25, 0.02, 0.001);
  test_flattening(folded, "a fold", any);

  const Scope scope("what cannot be flattened");
  internal::Patch_flattener flattener;
  const Shape closed = icosphere(1);
  RCO_CHECK(flattener.flatten(indexed(closed), closed.points).path ==
            internal::Flattening_path::failed);
}

void test_conformal_maps()
{
  const auto without_first_faces = [](const Shape& shape, int number) {
    return compacted(without_faces(shape, [=](int f) { return f < number; }));
  };
  struct Named_shape
  {
    std::string name;
    Shape shape;
    bool is_developable;
  };
  const std::vector<Named_shape> shapes = {
    {"a rough plane", scrambled(plane_grid(12, 9), 0.35, 1, onto_plane), true},
    {"half a cylinder", cylinder(20, 12, 0.5, 1, pi), true},
    {"half a cone", cone(20, 12, 0.6, 0.3, 1, pi), true},
    {"a tetrahedron without a face", without_first_faces(tetrahedron(), 1), false},
    {"three quarters of an icosahedron", without_first_faces(icosphere(0), 5), false},
    {"half an icosahedron", without_first_faces(icosphere(0), 10), false}};
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.7, Vector_3(1, 2, 4).normalized()).toRotationMatrix();
  internal::Flattening_parameters without_descent;
  without_descent.target_distortion = without_descent.largest_conformal_distortion = 1e6;
  for(const Named_shape& s : shapes)
  {
    const Scope scope("conformal map of " + s.name);
    // the ends of a patch, which are fixed, shall be unique
    const Shape shape = rotated(s.shape, turn);
    const Indexed_mesh mesh = indexed(shape);
    internal::Patch_flattener flattener;
    const internal::Flattening result = flattener.flatten(mesh, shape.points, without_descent);
    RCO_CHECK(result.path == internal::Flattening_path::conformal);
    RCO_CHECK(is_locally_injective_exactly(mesh, result.positions));
    if(s.is_developable)
      RCO_CHECK_NEAR(result.distortion, 4., 1e-9);
  }

  // a triangle of no area remains one in a conformal map
  const Scope scope("no conformal map");
  Shape flat = scrambled(plane_grid(12, 12), 0.2, 1, onto_plane);
  const std::vector<int>& t = flat.faces[150];
  flat.points[t[0]] = 0.5 * (flat.points[t[1]] + flat.points[t[2]]);
  internal::Patch_flattener flattener;
  const internal::Flattening result = flattener.flatten(indexed(flat), flat.points);
  RCO_CHECK(result.path == internal::Flattening_path::convex_border);
  RCO_CHECK(is_locally_injective_exactly(indexed(flat), result.positions));
}

// a ring that turns more often than once lies on itself in the plane: locally injective all the
// same, and the walk stays where it is
void test_overlap()
{
  for(const double turns : {1.5, 2.3})
  {
    const Scope scope("a ramp of " + std::to_string(turns) + " turns");
    const int columns = int(24 * turns), rows = 3;
    const Shape shape = ramp(columns, rows, turns);
    const Indexed_mesh mesh = indexed(shape);
    internal::Patch_flattener flattener;
    const internal::Flattening flat = flattener.flatten(mesh, shape.points);
    if(!RCO_CHECK(flat.path != internal::Flattening_path::failed))
      continue;
    const std::vector<Vector_2>& u = flat.positions;
    RCO_CHECK(is_locally_injective_exactly(mesh, u));
    RCO_CHECK(internal::is_locally_injective(mesh, u));
    RCO_CHECK(!internal::has_simple_border(mesh, u));
    RCO_CHECK_LESS(flat.distortion, 4.01);

    // position along the ramp, in columns
    const auto column = [&](int t) { return (t / 2) % columns; };
    Random random(3);
    int ambiguous = 0;
    for(int i = 0; i < 3000; ++i)
    {
      const int goal = random.index(mesh.number_of_faces());
      const Vector_2 p = point_in(mesh, u, goal, random.barycentric());
      ambiguous += holding(mesh, u, p).size() > 1;
      // from a triangle near by
      int start = goal;
      for(int step = 0; step < 4; ++step)
      {
        const int o = mesh.opposite[3 * start + random.index(3)];
        if(o >= 0)
          start = mesh.corner_face[o];
      }
      const internal::Planar_location location = internal::walk(mesh, u, p, start);
      RCO_CHECK(location.triangle < 0 || std::abs(column(location.triangle) - column(goal)) <= 1);
      if(start == goal)
        RCO_CHECK_EQUAL(location.triangle, goal);
    }
    RCO_CHECK_LESS(500, ambiguous);
  }
}

void test_injectivity_checks()
{
  const Shape plane = plane_grid(4, 4);
  const Indexed_mesh mesh = indexed(plane);
  const std::vector<Vector_2> u = planar_points(plane);
  RCO_CHECK(internal::is_locally_injective(mesh, u));
  RCO_CHECK(internal::has_simple_border(mesh, u));
  const auto with_middle_at = [&](double x, double y) {
    std::vector<Vector_2> w = u;
    w[12] = Vector_2(x, y);
    return w;
  };
  const std::vector<Vector_2> flipped = with_middle_at(0.8, 0.52); // beyond its neighbour
  RCO_CHECK(internal::has_simple_border(mesh, flipped));
  std::vector<Vector_2> mirrored = u;
  for(Vector_2& p : mirrored)
    p(0) = -p(0);
  for(const std::vector<Vector_2>& w :
      {flipped, mirrored, with_middle_at(0.75, 0.5) /* no area */,
       with_middle_at(std::numeric_limits<double>::quiet_NaN(), 0.5),
       with_middle_at(std::numeric_limits<double>::infinity(), 0.5)})
    RCO_CHECK(!internal::is_locally_injective(mesh, w));
  // barely positive, and barely not
  const Indexed_mesh one = indexed(Shape{std::vector<Vector_3>(3), {{0, 1, 2}}});
  const auto is_injective = [&](double y) {
    return internal::is_locally_injective(one, {Vector_2(0, 0), Vector_2(1, 1), Vector_2(3, y)});
  };
  RCO_CHECK(is_injective(std::nextafter(3., 4.)));
  RCO_CHECK(!is_injective(3));
  RCO_CHECK(!is_injective(std::nextafter(3., 2.)));

  // fans whose triangles, all positive, go round their middle once, twice and three times
  for(const int n : {3, 5, 7, 8, 13, 20})
    for(const int turns : {1, 2, 3})
    {
      if(n <= 2 * turns)
        continue;
      Shape fan;
      fan.add(0, 0, 0);
      std::vector<Vector_2> flat(1, Vector_2(0.1, 0.2));
      for(int i = 0; i < n; ++i)
      {
        const double a = 2 * pi * turns * i / n + 0.1;
        fan.add(std::cos(a), std::sin(a), i);
        flat.push_back(flat[0] + Vector_2(std::cos(a), std::sin(a)));
        fan.triangle(0, 1 + i, 1 + (i + 1) % n);
      }
      const Indexed_mesh m = indexed(fan);
      RCO_CHECK_EQUAL(internal::is_locally_injective(m, flat), turns == 1);
      RCO_CHECK_EQUAL(is_locally_injective_exactly(m, flat), turns == 1);
      RCO_CHECK_EQUAL(internal::has_simple_border(m, flat), turns == 1);
    }

  // a strip bent until its ends cross
  for(const double turns : {0.9, 1.1})
  {
    const Shape bent = ramp(30, 2, turns);
    const std::vector<Vector_2> flat = planar_points(bent);
    RCO_CHECK(internal::is_locally_injective(indexed(bent), flat));
    RCO_CHECK_EQUAL(internal::has_simple_border(indexed(bent), flat), turns < 1);
  }
}

struct Walk_counts
{
  int found = 0, lost = 0, outside = 0;
};

// `known` says that p is at a known place of the mesh, perhaps but for rounding
void check_walk(const Indexed_mesh& mesh,
                const std::vector<Vector_2>& u,
                const Vector_2& p,
                int start,
                bool known,
                Walk_counts& counts)
{
  const internal::Planar_location location = internal::walk(mesh, u, p, start);
  const std::vector<int> truth = holding(mesh, u, p);
  if(location.triangle < 0)
  {
    ++(truth.empty() && !known ? counts.outside : counts.lost);
    return;
  }
  ++counts.found;
  RCO_CHECK(!truth.empty() || known);
  RCO_CHECK(location.barycentric.minCoeff() >= 0);
  RCO_CHECK_NEAR(location.barycentric.sum(), 1., 1e-14);
  const Vector_2 q = point_in(mesh, u, location.triangle, location.barycentric);
  RCO_CHECK_LESS_EQUAL((q - p).norm(), 1e-11);
  // strictly inside one triangle it is that triangle
  if(truth.size() == 1 && !known)
    RCO_CHECK_EQUAL(location.triangle, truth.front());
}

void test_walk_on(const Shape& shape, const std::string& name, bool is_convex)
{
  const Scope scope("walk on " + name);
  const Indexed_mesh mesh = indexed(shape);
  const std::vector<Vector_2> u = planar_points(shape);
  if(!RCO_CHECK(is_locally_injective_exactly(mesh, u)))
    return;
  Eigen::AlignedBox2d box;
  for(const Vector_2& p : u)
    box.extend(p);
  const Vector_2 low = box.min() - Vector_2(0.1, 0.1), high = box.max() + Vector_2(0.1, 0.1);
  const int n = mesh.number_of_faces();
  Random random(4);
  Walk_counts anywhere, at_vertices, on_edges, near_by;
  for(int i = 0; i < 3000; ++i)
  {
    const Vector_2 p(random(low(0), high(0)), random(low(1), high(1)));
    check_walk(mesh, u, p, random.index(n), false, anywhere);
  }
  for(int i = 0; i < 1000; ++i)
  {
    const int c = random.index(mesh.number_of_corners());
    const int a = mesh.source(c), b = mesh.target(c);
    check_walk(mesh, u, u[a], is_convex ? random.index(n) : mesh.corner_face[c], true, at_vertices);
    check_walk(mesh, u, 0.5 * (u[a] + u[b]), is_convex ? random.index(n) : mesh.corner_face[c],
               true, on_edges);
    // as it is used: to a point of the vertex' star, from one of the star's triangles
    if(mesh.is_border_vertex[a])
      continue;
    const int begin = mesh.vertex_begin[a], degree = mesh.vertex_begin[a + 1] - begin;
    const int t = mesh.corner_face[mesh.vertex_corners[begin + random.index(degree)]];
    const int s = mesh.corner_face[mesh.vertex_corners[begin + random.index(degree)]];
    check_walk(mesh, u, point_in(mesh, u, t, random.barycentric()), s, false, near_by);
  }
  RCO_CHECK_LESS(300, anywhere.found);
  RCO_CHECK_LESS(100, anywhere.outside);
  RCO_CHECK_LESS(100, near_by.found);
  RCO_CHECK_EQUAL(at_vertices.lost, 0);
  RCO_CHECK_EQUAL(on_edges.lost, 0);
  // otherwise the border may be in between, also in a star that is not convex
  RCO_CHECK_LESS_EQUAL(near_by.lost, is_convex ? 0 : near_by.found / 20);
  if(is_convex)
    RCO_CHECK_LESS_EQUAL(anywhere.lost, anywhere.found / 500);
}

void test_walk()
{
  test_walk_on(plane_grid(10, 10), "a plane", true);
  test_walk_on(scrambled(plane_grid(10, 10), 0.2, 5, onto_plane), "a rough plane", true);
  test_walk_on(scrambled(equilateral_grid(10, 9, 0.1), 0.3, 6, onto_plane), "a rough rhombus",
               true);
  test_walk_on(deformed(ramp(40, 4, 0.9), onto_plane), "a ring", false);
  const Shape square = plane_grid(10, 10);
  test_walk_on(compacted(without_faces(square,
                                       [&](int f) {
                                         const Vector_3& p = square.points[square.faces[f][0]];
                                         return p.x() > 0.35 && p.y() > 0.35;
                                       })),
               "a corner", false);
  // a start from which nothing can be reached
  const Shape two = plane_grid(1, 1);
  RCO_CHECK_EQUAL(internal::walk(indexed(two), planar_points(two), Vector_2(5, 5), 0).triangle, -1);
}

// A quad whose diagonal is an edge already, around a vertex of two faces: no flattening is injective.
void test_double_edge()
{
  const std::vector<Vector_3> points = {Vector_3(0.5, 0.1, 0), Vector_3(0, 0, 0), Vector_3(1, 0, 0),
                                        Vector_3(0.5, 1, 0), Vector_3(0.5, -1, 0)};
  const internal::Indexed_mesh polygons({0, 3, 6, 10}, {1, 0, 2, 1, 2, 3, 0, 1, 4, 2}, 5);
  const internal::Indexed_mesh triangles = internal::split_mesh(
    polygons,
    [](int f) {
      return f < 2 ? std::vector<std::array<int, 3>>{{{3 * f, 3 * f + 1, 3 * f + 2}}}
                   : std::vector<std::array<int, 3>>{{{6, 7, 9}}, {{7, 8, 9}}};
    },
    [](int) {});
  RCO_CHECK_EQUAL(triangles.number_of_faces(), 4);
  for(const bool use_conformal : {true, false})
  {
    internal::Flattening_parameters parameters;
    parameters.use_conformal = use_conformal;
    internal::Patch_flattener flattener;
    RCO_CHECK(flattener.flatten(triangles, points, parameters).path ==
              internal::Flattening_path::failed);
  }
}

// a shape with its vertices at their closest points on the faces of the reference that are allowed
struct Placed_shape : Located_shape
{
  Placed_shape(const Shape& shape,
               const Shape& reference,
               const std::function<bool(int)>& face_is_allowed)
    : Located_shape(shape, reference)
  {
    // the reference keeps its own orientation
    if(surface.normal(surface.point(0, Vector_3::Constant(1. / 3))).dot(surface.face_normal(0)) < 0)
      surface.reverse(std::vector<char>(surface.mesh().number_of_faces(), 1));
    for(std::size_t v = 0; v < shape.points.size(); ++v)
    {
      double best = std::numeric_limits<double>::infinity();
      for(int f = 0; f < surface.mesh().number_of_faces(); ++f)
      {
        const internal::Surface_point s = surface.closest_in_face(shape.points[v], f);
        const double distance = (s.position - shape.points[v]).norm();
        if(face_is_allowed(f) && distance < best)
        {
          best = distance;
          state.vertices[v] = {s, s.position, surface.normal(s), {}};
        }
      }
    }
  }
};

Vector_3 point_of(const internal::Patch& patch, const internal::Planar_location& location)
{
  return point_in(patch.polygons, patch.positions(), location.triangle, location.barycentric);
}

// M is a coarse sheet on the upper one of two wavy sheets: its chords run beyond the lower one,
// where every point of M's faces must still be mapped to the upper one.
void test_map_to_upper_sheet(const Shape& sheets,
                             const std::function<bool(int)>& is_on_upper,
                             int coarseness,
                             int expected_wrong_by_tree)
{
  const Shape coarse = deformed(plane_grid(coarseness, coarseness, 0.8), [](const Vector_3& p) {
    return Vector_3(p.x() + 0.1, p.y() + 0.1, 0.05 * std::sin(4 * pi * (p.x() + 0.1)));
  });
  const Placed_shape placed(coarse, sheets, is_on_upper);
  const internal::Reference_surface& surface = placed.surface;
  const internal::Patch patch = placed.whole_patch();
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
    const Vector_3 point = point_of(patch, location);
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
  const Shape shelf = deformed(plane_grid(48, 48), [](const Vector_3& p) {
    return Vector_3(p.x(), p.y(), 0.05 * std::sin(4 * pi * p.x()));
  });
  const int faces = int(shelf.faces.size());
  const Shape shelves = joined(shelf, shelf, Vector_3(0, 0, -0.015));
  test_map_to_upper_sheet(
    shelves, [=](int f) { return f < faces; }, 5, 500);
}

// A flat M on a flat R is mapped to itself. Next to faces of R that have no area it may be off by
// their edges' length.
void test_map_to_reference_on_plane()
{
  const Shape fine = plane_grid(24, 24);
  Random random(6);
  Shape damaged = fine;
  // collapsed edges: vertices that lie on their neighbours
  for(const int v : {130, 205, 333, 410})
    damaged.points[v] = damaged.points[v + 1];
  for(const bool is_damaged : {false, true})
  {
    const Shape& shape = is_damaged ? damaged : fine;
    int exact = 0;
    const Placed_shape placed(plane_grid(5, 5), shape, [](int) { return true; });
    const internal::Patch patch = placed.whole_patch();
    for(int i = 0; i < 2000; ++i)
    {
      internal::Planar_location location;
      location.triangle = random.index(patch.polygons.number_of_faces());
      location.barycentric = random.barycentric();
      const Vector_3 point = point_of(patch, location);
      internal::Located_vertex result;
      if(RCO_CHECK(internal::map_to_reference(patch, location, placed.surface, result)))
      {
        const double off = (result.position - point).norm();
        exact += off <= 1e-9;
        RCO_CHECK_LESS_EQUAL(off, is_damaged ? 0.06 : 1e-9);
      }
    }
    RCO_CHECK_LESS_EQUAL(is_damaged ? 1980 : 2000, exact);
  }
}

int main()
{
  run_test("injectivity", test_injectivity_checks);
  run_test("walk", test_walk);
  run_test("flattenings", test_flattenings);
  run_test("conformal maps", test_conformal_maps);
  run_test("overlap", test_overlap);
  run_test("an edge twice", test_double_edge);
  run_test("map to reference on sheets", test_map_to_reference_on_sheets);
  run_test("map_to_reference on a plane", test_map_to_reference_on_plane);
  return report();
}
