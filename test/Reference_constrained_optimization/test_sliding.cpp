// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// relax_constraints: vertices of borders and of constrained lines slide, and stay on their lines.

#include "Random.h"
#include "checks.h"
#include "meshes.h"

#include <CGAL/reference_constrained_optimize.h>

#include <CGAL/Polyhedron_3.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

using namespace rco_test;
using RCO::internal::Polyline_point;
using RCO::internal::Polyline_set;

void test_lines()
{
  Scope scope("lines");
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
    const Mesh reference = make_mesh<Mesh>(test.reference);
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
    RCO_CHECK_EQUAL(r.number_of_flips + r.number_of_fold_edges + r.number_of_nonconvex_quads,
                    std::size_t(0));
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
  RCO_CHECK_LESS(std::size_t(5), moved);
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

// two squares that meet at a right angle in a constrained crease, whose ends are on the border
Case crease_case(int n)
{
  Case test = square_case(2 * n);
  test.name = "crease";
  const int row = 2 * n + 1;
  for(int j = 0; j < row; ++j)
  {
    Vector_3& p = test.start.points[j * row + n];
    p.x() = 0.5;
    if(j > 0)
      test.lines.insert({(j - 1) * row + n, j * row + n});
    test.is_line_vertex[j * row + n] = j > 0 && j < 2 * n;
  }
  const double angle = 0.5 * pi;
  test.reference = plane_grid(8, 8, 1);
  for(Vector_3& p : test.start.points)
    p = fold_at(p, 0.5, angle);
  for(Vector_3& p : test.reference.points)
    p = fold_at(p, 0.5, angle);
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
  Case test = square_case(2 * n);
  test.name = "rim";
  const int row = 2 * n + 1, facets = 5 * n + 3;
  for(int j = 0; j < row; ++j)
  {
    test.start.points[j * row + n].x() = 0.5;
    if(j > 0)
      test.lines.insert({(j - 1) * row + n, j * row + n});
    test.is_line_vertex[j * row + n] = j > 0 && j < 2 * n;
  }
  const auto on_rim = [facets](double k) {
    return Vector_3(std::cos(pi * k / facets), std::sin(pi * k / facets), 0);
  };
  const auto bend = [&](const Vector_3& p) {
    const double k = (std::min)(std::floor(p.y() * facets + 1e-9), facets - 1.);
    const double part = p.y() * facets - k, r = p.x() + 0.5;
    const Vector_3 rim = (1 - part) * on_rim(k) + part * on_rim(k + 1);
    return Vector_3((std::min)(r, 1.) * rim - (std::max)(r - 1, 0.) * Vector_3::UnitZ());
  };
  const int columns = 4;
  test.reference = plane_grid(columns, facets, 1);
  for(Vector_3& p : test.reference.points)
    p.y() *= double(columns) / facets;
  for(Shape* shape : {&test.start, &test.reference})
    for(Vector_3& p : shape->points)
      p = bend(p);
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

int main()
{
  test_lines();
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
