// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// From the user's meshes to the state: constraints, ranges of faces, locations, lines, and moments.

#include "Located_shape.h"
#include "checks.h"
#include "deformations.h"
#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/internal/reading/face_range.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/feature_constraints.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/sliding_vertices.h>
#include <CGAL/Reference_constrained_optimization/internal/state/sliding.h>

using namespace rco_test;

// Every vertex is where R is closest; what is there already, or may not move, keeps its bits.
void test_locations()
{
  const Shape sphere = icosphere(3);
  Shape start = scrambled(icosphere(2), 0.2, 1, [](const Vector_3& p) { return p; });
  const int on_reference = nearest(start, Vector_3::UnitX());
  start.points[on_reference] = sphere.points[17];
  for(const bool is_reversed : {false, true})
  {
    const Located_shape scene(start, is_reversed ? turned_round(sphere) : sphere);
    for(std::size_t v = 0; v < start.points.size(); ++v)
    {
      const internal::Located_vertex& located = scene.state.vertices[v];
      const Vector_3 closest = scene.surface.closest(start.points[v]).position;
      RCO_CHECK_LESS((located.position - closest).norm(), 1e-14);
      RCO_CHECK(same_bits(located.position, located.on_reference.position));
      RCO_CHECK_LESS(0.9, located.normal.dot(located.position)); // as the mesh is oriented
    }
    RCO_CHECK(same_bits(scene.state.vertices[on_reference].position, sphere.points[17]));
  }
  const Located_shape open(deformed(square(6, 6), hilly), square(12, 12));
  for(std::size_t v = 0; v < open.copy.points.size(); ++v)
    RCO_CHECK_EQUAL(same_bits(open.state.vertices[v].position, open.copy.points[v]),
                    !open.state.is_free[v]);
  internal::check_distances({open.copy.points[0]}, open.state, 1);
  RCO_CHECK_THROWS(internal::check_distances({Vector_3(0, 0, 0.2)}, open.state, 10),
                   RCO::Invalid_input, "vertex 0 is 2 away");
}

// Vertices and edges that are constrained, and those outside a range of faces, are not free.
void test_constraints()
{
  const int n = 6;
  Mesh mesh = mesh_of(plane_grid(n, n));
  auto vertex_map = mesh.add_property_map<Mesh::Vertex_index, bool>("v:fixed", false).first;
  auto edge_map = mesh.add_property_map<Mesh::Edge_index, bool>("e:fixed", false).first;
  const auto id = [](int i, int j) { return unsigned(j * (n + 1) + i); };
  vertex_map[Mesh::Vertex_index(id(2, 2))] = true;
  edge_map[mesh.edge(mesh.halfedge(Mesh::Vertex_index(id(4, 4)), Mesh::Vertex_index(id(4, 3))))] =
    true;
  const internal::Mesh_copy copy = internal::read_face_graph(mesh, mesh.points(), "mesh");
  internal::Constraints constraints = internal::read_constraints(
    mesh, params::vertex_is_constrained_map(vertex_map).edge_is_constrained_map(edge_map),
    copy.mesh);
  std::vector<Mesh::Face_index> range;
  for(const Mesh::Face_index f : mesh.faces())
    if(unsigned(f) >= 2 * n) // all but the lowest row
      range.push_back(f);
  const std::vector<char> is_in = internal::mark_faces(mesh, range);
  RCO_CHECK(internal::mark_faces(mesh, internal::All_faces()).empty());
  for(std::size_t f = 0; f < is_in.size(); ++f)
    RCO_CHECK_EQUAL(bool(is_in[f]), f >= 2 * n);
  internal::constrain_outside(copy.mesh, is_in, constraints);
  const std::vector<char> is_free = internal::free_vertices(copy.mesh, constraints);
  for(int j = 0; j <= n; ++j)
    for(int i = 0; i <= n; ++i)
      RCO_CHECK_EQUAL(bool(is_free[id(i, j)]), i > 0 && i < n && j > 1 && j < n &&
                                                 !(i == 2 && j == 2) &&
                                                 !(i == 4 && (j == 3 || j == 4)));
  static_assert(internal::Is_face_range<std::vector<Mesh::Face_index>, Mesh>::value, "");
  static_assert(!internal::Is_face_range<Mesh, Mesh>::value, "");
}

// Lines of R are found in a mesh that has other vertices.
void test_traced_features()
{
  const Shape shape = cube(4), reference = cube(6);
  const internal::Reference_surface surface(copy_of(reference));
  const auto is_on_edge = [](const Shape& s, const Indexed_mesh& mesh, int c) {
    return number_of_planes(0.5 * (s.points[mesh.source(c)] + s.points[mesh.target(c)])) == 2;
  };
  std::vector<char> is_feature;
  for(int c = 0; c < surface.mesh().number_of_corners(); ++c)
    is_feature.push_back(is_on_edge(reference, surface.mesh(), c));
  RCO_CHECK_EQUAL(internal::feature_edges(surface.mesh(), is_feature).size(), std::size_t(12 * 6));
  const Indexed_mesh mesh = indexed(shape);
  const std::vector<char> traced =
    internal::traced_features(mesh, shape.points, surface, is_feature);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    RCO_CHECK_EQUAL(bool(traced[c]), is_on_edge(shape, mesh, c));
}

// Vertices of the border slide along R's border, but for its corners.
void test_sliding()
{
  const int n = 8;
  Located_shape scene(plane_grid(n, n), plane_grid(5, 5));
  const RCO::Result result = scene.relax_border();
  RCO_CHECK_EQUAL(result.number_of_free_vertices, std::size_t(4 * (n - 1)));
  const internal::Patch patch = scene.whole_patch();
  for(int v = 0; v < int(patch.vertices.size()); ++v)
  {
    const Vector_3& p = patch.located[v].position;
    RCO_CHECK(same_bits(p, scene.copy.points[patch.vertices[v]]));
    const int sides = int((p.head<2>().array() == 0 || p.head<2>().array() == 1).count());
    RCO_CHECK_EQUAL(patch.slides(v), sides == 1);
    RCO_CHECK_EQUAL(bool(patch.is_free[v]), sides < 2);
    internal::Located_vertex moved;
    for(const double length : {-0.07, 0.07})
      if(patch.slides(v) && RCO_CHECK(internal::slide(patch, v, length, scene.surface, moved)))
      {
        RCO_CHECK_NEAR((moved.position - p).norm(), 0.07, 1e-12);
        RCO_CHECK_EQUAL(number_of_planes(moved.position), 2); // of the cube over the square
      }
  }
}

void test_moments()
{
  internal::Moments none, some;
  RCO_CHECK(none.mean() == 0 && none.standard_deviation() == 0);
  for(const double x : {2., 4., 4., 4., 5., 5., 7., 9.})
    some.add(1e6 + x);
  RCO_CHECK(some.minimum() == 1e6 + 2 && some.maximum() == 1e6 + 9);
  RCO_CHECK_NEAR(some.mean(), 1e6 + 5, 1e-9);
  RCO_CHECK_NEAR(some.standard_deviation(), 2, 1e-9);
}

int main()
{
  run_test("locations", test_locations);
  run_test("constraints", test_constraints);
  run_test("traced features", test_traced_features);
  run_test("sliding", test_sliding);
  run_test("moments", test_moments);
  return report();
}
