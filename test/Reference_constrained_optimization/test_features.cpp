// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Feature edges of mechanical parts are kept by default, also where slivers cannot be opened. With
// relax_constraints, vertices of borders and of constrained lines slide, and stay on their lines.

#include "deformations.h"
#include "optimization.h"

#include <CGAL/Polyhedron_3.h>

#include <set>

using namespace rco_test;

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

// a square in which one vertex was pulled across an edge: folded, not sharp
void test_folds()
{
  Shape plane = plane_grid(8, 8);
  plane.points[4 * 9 + 4] += Vector_3(0.2, 0.01, 0);
  Mesh mesh = mesh_of(plane);
  const auto before = RCO::orientation_defects(mesh, mesh_of(plane_grid(8, 8)));
  RCO_CHECK_LESS(0u, before.total());
  const RCO::Result r = improve_angles(mesh, mesh);
  RCO_CHECK_EQUAL(r.number_of_feature_edges, 0u);
  RCO_CHECK_EQUAL(r.number_of_flips + r.number_of_fold_edges, 0u);
}

// The same lines are features if every triangle is split: those of parts, and none of rough surfaces, whose
// edges are as sharp.
void test_split_triangles()
{
  const auto report_of = [](const Shape& shape) {
    const Mesh mesh = mesh_of(shape);
    std::set<Mesh::Edge_index> features;
    RCO::Feature_report report =
      RCO::detect_features(mesh, CGAL::Boolean_property_map<std::set<Mesh::Edge_index>>(features));
    RCO_CHECK_EQUAL(report.number_of_feature_edges, features.size());
    return report;
  };
  Shape rough = icosphere(3);
  Random random(7);
  for(Vector_3& p : rough.points)
    p *= 1 + random(-0.1, 0.1);
  for(Shape shape : {rough, octahedron(), cube(3), jittered_cube(3, 0.2)})
  {
    const RCO::Feature_report before = report_of(shape);
    RCO_CHECK_LESS(1., before.amount_of_sharp_edges);
    std::size_t pieces = 1;
    for(int level = 0; level < 2; ++level)
    {
      shape = split_in_four(std::move(shape));
      pieces *= 2;
      const RCO::Feature_report after = report_of(shape);
      RCO_CHECK_EQUAL(after.number_of_feature_edges, pieces * before.number_of_feature_edges);
      RCO_CHECK_NEAR(after.amount_of_sharp_edges, before.amount_of_sharp_edges, 1e-9);
      RCO_CHECK_NEAR(after.sharp_share, before.sharp_share, 1e-9);
      RCO_CHECK_NEAR(after.flat_share, before.flat_share, 1e-9);
    }
  }
  RCO_CHECK(!report_of(rough).has_features);
}

struct Outcome
{
  Shape shape;
  RCO::Result result;
};

template <typename Energy, typename NamedParameters>
Outcome run(const Shape& start, const Energy& energy, const NamedParameters& np)
{
  Mesh mesh = mesh_of(start);
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
  RCO_CHECK_LESS(5u, slid);
  RCO_CHECK_LESS(after.result.final_energy, after.result.initial_energy);
  const Mesh before = mesh_of(start), mesh = mesh_of(after.shape);
  RCO_CHECK_LESS(RCO::normal_deviation(mesh, before).maximum, 1e-6);
  RCO_CHECK_NEAR(RCO::feature_deviation(before, mesh).kept, 1, 1e-9);

  // a copy of the mesh counts as the mesh itself
  Mesh same = before;
  CGAL::reference_constrained_optimize(same, before, energy, params::random_seed(1));
  RCO_CHECK(same_bits(make_shape(same), after.shape));
}

void test_keeping()
{
  const int n = 8;
  const Shape start = jittered_cube(n, 0.3);
  check_cube(start, RCO::Minimum_angle_energy());
  check_cube(jittered_cube(n, 0.3, true), RCO::Quad_angle_energy());

  const RCO::Minimum_angle_energy energy;
  RCO_CHECK_EQUAL(run(start, energy, params::random_seed(0)).result.number_of_feature_edges,
                  std::size_t(12 * n));
  const Outcome free = run(start, energy, params::detect_features(false));
  RCO_CHECK_EQUAL(free.result.number_of_feature_edges, 0u);
  std::size_t left = 0;
  for(std::size_t v = 0; v < start.points.size(); ++v)
    left += number_of_planes(start.points[v]) > number_of_planes(free.shape.points[v]);
  RCO_CHECK_LESS(0u, left); // the test can fail

  // the caller's own lines
  Mesh mesh = mesh_of(start);
  const auto none = mesh.add_property_map<Mesh::Edge_index, bool>("e:none", false).first;
  const RCO::Result r =
    CGAL::reference_constrained_optimize(mesh, mesh, energy, params::edge_is_constrained_map(none));
  RCO_CHECK_EQUAL(r.number_of_feature_edges, 0u);

  // of another reference
  Mesh other = mesh_of(start);
  const RCO::Result traced =
    CGAL::reference_constrained_optimize(other, mesh_of(jittered_cube(11, 0.2)), energy);
  RCO_CHECK_EQUAL(traced.number_of_feature_edges, std::size_t(12 * n));
  for(std::size_t v = 0; v < start.points.size(); ++v)
    RCO_CHECK_EQUAL(number_of_planes(start.points[v]),
                    number_of_planes(make_shape(other).points[v]));
}

// Strips that nothing can open: the mean of the angles does not fall, the shape stays.
void test_strips()
{
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
      const Mesh before = mesh_of(start), mesh = mesh_of(after.shape);
      RCO_CHECK_EQUAL(RCO::normal_deviation(mesh, before).share_above_45, 0.);
      RCO_CHECK_LESS(0.99, RCO::feature_deviation(before, mesh).kept);
    }
}

// Rounds of few edges, and sheets that are thin against their edges.
void test_coarse_parts()
{
  // edges of 36 and 40 degrees are no noise, and one of nine turns by 40 but for rounding
  for(const int columns : {9, 10, 12})
    for(const int rows : {1, 5})
    {
      const Shape start = closed_cylinder(columns, rows, 1, 3);
      const Mesh before = mesh_of(start);
      const Outcome after = run(start, RCO::Minimum_angle_energy(), params::random_seed(0));
      RCO_CHECK_LESS_EQUAL(std::size_t(2 * columns), after.result.number_of_feature_edges);
      const Mesh mesh = mesh_of(after.shape);
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
      RCO_CHECK_EQUAL(RCO::number_of_self_intersecting_pairs(mesh_of(after.shape)), 0u);
      RCO_CHECK_LESS_EQUAL(mean_smallest_angle(start), mean_smallest_angle(after.shape) + 1e-9);
    }
}

// a plane of squares bent along lines of constant x, so that none of its faces changes its shape
Vector_3 fold_at(const Vector_3& p, double x, double angle)
{
  const double d = (std::max)(0., p.x() - x);
  return Vector_3(p.x() - d + d * std::cos(angle), p.y(), d * std::sin(angle));
}

struct Case
{
  std::string name;
  Shape start, reference;
  std::vector<char> is_line_vertex; // slides
  std::function<double(const Vector_3&)> distance_to_line;
  std::set<std::pair<int, int>> lines; // constrained edges, smaller vertex first
};

template <typename M, typename Energy>
void check_case(const Case& test, const Energy& energy, bool on_surface, double largest_deviation)
{
  Scope scope(test.name + (on_surface ? ", on the surface" : ", flattened"));
  const auto run = [&](bool relax) {
    M mesh = make_mesh<M>(test.start);
    const Mesh reference = mesh_of(test.reference);
    auto is_constrained = get(CGAL::dynamic_edge_property_t<bool>(), mesh);
    auto index = get(CGAL::dynamic_vertex_property_t<int>(), mesh);
    int i = 0;
    for(const auto v : vertices(mesh))
      put(index, v, i++);
    for(const auto e : edges(mesh))
    {
      const int a = get(index, source(e, mesh)), b = get(index, target(e, mesh));
      put(is_constrained, e, test.lines.count({(std::min)(a, b), (std::max)(a, b)}) > 0);
    }
    const RCO::Result r =
      CGAL::reference_constrained_optimize(mesh, reference, energy,
                                           params::use_on_surface_steps(on_surface)
                                             .energy_tolerance(1e-6)
                                             .edge_is_constrained_map(is_constrained)
                                             .relax_constraints(relax));
    RCO_CHECK(r.final_energy < r.initial_energy);
    RCO_CHECK_EQUAL(r.number_of_flips + r.number_of_fold_edges + r.number_of_nonconvex_quads, 0u);
    RCO_CHECK(RCO::distance_to_reference(mesh, reference).is_on_reference());
    return std::make_pair(make_shape(mesh), RCO::corner_angle_statistics(mesh).standard_deviation);
  };
  const auto relaxed = run(true), fixed = run(false);

  const Indexed_mesh indices = indexed(test.start);
  std::size_t moved = 0;
  for(std::size_t v = 0; v < test.start.points.size(); ++v)
  {
    const Vector_3 &before = test.start.points[v], &after = relaxed.first.points[v];
    bool is_on_line = indices.is_border_vertex[v];
    for(const auto& edge : test.lines)
      is_on_line = is_on_line || edge.first == int(v) || edge.second == int(v);
    if(!is_on_line)
      continue;
    RCO_CHECK(same_bits(before, fixed.first.points[v]));
    if(test.is_line_vertex[v])
    {
      RCO_CHECK_LESS(test.distance_to_line(after), 1e-12);
      moved += (after - before).norm() > 1e-3;
    }
    else
      RCO_CHECK(same_bits(before, after));
  }
  RCO_CHECK_LESS(5u, moved);
  // what is regular but for the places of the vertices on the lines becomes regular
  RCO_CHECK_LESS(relaxed.second, largest_deviation);
  RCO_CHECK_LESS(2 * relaxed.second, fixed.second);
}

// a square whose border vertices are displaced along the border
Case square_case(int n)
{
  Case test;
  test.name = "square";
  test.start = plane_grid(n, n, 1, true);
  test.reference = plane_grid(7, 7, 1);
  Random random(3);
  for(Vector_3& p : test.start.points)
  {
    const auto is_end = [](double x) { return x == 0 || x == 1; };
    const double dx = random(-0.3, 0.3) / n, dy = random(-0.3, 0.3) / n;
    test.is_line_vertex.push_back(is_end(p.x()) != is_end(p.y()));
    if(!is_end(p.x()))
      p.x() += dx;
    if(!is_end(p.y()))
      p.y() += dy;
  }
  test.distance_to_line = [](const Vector_3& p) {
    return (std::min)({std::abs(p.x()), std::abs(1 - p.x()), std::abs(p.y()), std::abs(1 - p.y())});
  };
  return test;
}

// the same with a constrained line in the middle, whose ends are on the border
Case divided_square_case(int n)
{
  Case test = square_case(2 * n);
  const int row = 2 * n + 1;
  for(int j = 0; j < row; ++j)
  {
    test.start.points[j * row + n].x() = 0.5;
    if(j > 0)
      test.lines.insert({(j - 1) * row + n, j * row + n});
    test.is_line_vertex[j * row + n] = j > 0 && j < 2 * n;
  }
  return test;
}

// two squares that meet at a right angle in a constrained crease
Case crease_case(int n)
{
  Case test = divided_square_case(n);
  test.name = "crease";
  const auto fold = [](const Vector_3& p) { return fold_at(p, 0.5, 0.5 * pi); };
  test.start = deformed(test.start, fold);
  test.reference = deformed(plane_grid(8, 8, 1), fold);
  test.distance_to_line = [](const Vector_3& p) {
    const double u = p.x() + p.z(); // along the folded square
    return (std::min)(
      {u, std::abs(1 - u), std::abs(u - 0.5), std::abs(p.y()), std::abs(1 - p.y())});
  };
  return test;
}

// A half disk and the wall below its rim, of facets that the mesh is coarser than: the line that the
// mesh forms along the rim is not the reference's.
Case rim_case(int n)
{
  Case test = divided_square_case(n);
  test.name = "rim";
  const int facets = 5 * n + 3, columns = 4;
  const auto on_rim = [facets](double k) {
    return Vector_3(std::cos(pi * k / facets), std::sin(pi * k / facets), 0);
  };
  const auto bend = [&](const Vector_3& p) {
    const double k = (std::min)(std::floor(p.y() * facets + 1e-9), facets - 1.);
    const double part = p.y() * facets - k, r = p.x() + 0.5;
    const Vector_3 rim = (1 - part) * on_rim(k) + part * on_rim(k + 1);
    return Vector_3((std::min)(r, 1.) * rim - (std::max)(r - 1, 0.) * Vector_3::UnitZ());
  };
  test.start = deformed(test.start, bend);
  test.reference =
    deformed(scaled(plane_grid(columns, facets, 1), 1, double(columns) / facets, 1), bend);
  test.distance_to_line = [=](const Vector_3& p) {
    // to the straight sides, and to the polygons at three radii and heights
    double least = p.z() < 0 ? std::hypot(std::abs(p.x()) - 1, p.y()) : std::abs(p.y());
    for(int k = 0; k < facets; ++k)
      for(const auto& ring :
          {std::make_pair(0.5, 0.), std::make_pair(1., 0.), std::make_pair(1., -0.5)})
      {
        const Vector_3 a = ring.first * on_rim(k) + ring.second * Vector_3::UnitZ(),
                       d = ring.first * (on_rim(k + 1) - on_rim(k));
        const double t = (std::min)(1., (std::max)(0., d.dot(p - a) / d.squaredNorm()));
        least = (std::min)(least, (a + t * d - p).norm());
      }
    return least;
  };
  return test;
}

// a coin whose rim is a fillet of a few steps: there is no sharp edge
Shape coin(int columns, int steps)
{
  return deformed(closed_cylinder(columns, steps, 1, 1), [](const Vector_3& p) {
    const double r = std::hypot(p.x(), p.y()), angle = (p.z() - 0.5) * pi, fillet = 0.1;
    const double factor = r > 0 ? 1 + fillet * std::cos(angle) : 1;
    return Vector_3(factor * p.x(), factor * p.y(), fillet * std::sin(angle));
  });
}

void test_rounded_parts()
{
  double least_volume = 1; // without the limits of parts
  for(const int steps : {5, 7, 12})
  {
    const Shape start = coin(24, steps);
    const Outcome after = run(start, RCO::Minimum_angle_energy(), params::random_seed(0));
    RCO_CHECK_EQUAL(after.result.number_of_feature_edges, 0u);
    const Outcome free = run(start, RCO::Minimum_angle_energy(), params::detect_features(false));
    const Mesh before = mesh_of(start);
    RCO_CHECK_NEAR(volume(after.shape) / volume(start), 1., 0.01);
    RCO_CHECK_LESS(RCO::normal_deviation(mesh_of(after.shape), before).share_above_20, 0.005);
    least_volume = (std::min)(least_volume, volume(free.shape) / volume(start));
  }
  RCO_CHECK_LESS(least_volume, 0.97); // the test can fail
}

int main()
{
  run_test("folds", test_folds);
  run_test("split triangles", test_split_triangles);
  run_test("keeping", test_keeping);
  run_test("strips", test_strips);
  run_test("coarse parts", test_coarse_parts);
  run_test("rounded parts", test_rounded_parts);
  const RCO::Quad_regularity_energy regularity(1);
  const RCO::Quad_angle_energy angle;
  for(const bool on_surface : {true, false})
  {
    check_case<Mesh>(square_case(12), regularity, on_surface, 0.3);
    check_case<CGAL::Polyhedron_3<Kernel>>(square_case(12), angle, on_surface, 1);
    check_case<Mesh>(crease_case(7), regularity, on_surface, 0.3);
    check_case<Mesh>(rim_case(6), angle, on_surface, 6);
  }
  return report();
}
