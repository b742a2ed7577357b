// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Results are written, and defects at the end are repaired locally.

#include "Located_shape.h"
#include "checks.h"
#include "deformations.h"
#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/Quad_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/Frame.h>
#include <CGAL/Reference_constrained_optimization/internal/writing/Defect_repair.h>
#include <CGAL/Reference_constrained_optimization/internal/writing/write_back.h>

using namespace rco_test;

typedef std::vector<internal::Located_vertex> Vertices;
typedef internal::Defect_repair<CGAL::Sequential_tag> Sequential_defect_repair;

const int n = 12;
int id(int i, int j) { return j * (n + 1) + i; }

// a mesh on a plane, all of whose vertices may be moved anywhere
struct Movable_mesh : Located_shape
{
  Vertices start;

  template <typename Energy = RCO::Minimum_angle_energy>
  explicit Movable_mesh(const Shape& shape, const Energy& energy = Energy())
    : Located_shape(shape, plane_grid(n, n, n), energy),
      start(state.vertices)
  {
    state.is_free.assign(start.size(), 1);
  }
  void move(int v, double dx, double dy, double dz = 0)
  {
    const Vector_3 p = state.vertices[v].position + Vector_3(dx, dy, dz);
    state.vertices[v].on_reference = surface.closest(p);
    state.vertices[v].position = p;
  }
  auto defects() const { return defects_of(state.vertices); }
  internal::Output_defects defects_of(const Vertices& vertices) const
  {
    return internal::find_output_defects<CGAL::Sequential_tag>(state, vertices);
  }
  bool is_at(int v, const Vertices& vertices) const
  {
    return same_bits(state.vertices[v].position, vertices[v].position) &&
           same_bits(state.vertices[v].on_reference.barycentric,
                     vertices[v].on_reference.barycentric);
  }
  // defects are repaired at one vertex, and another keeps its place
  void check_repair(int restored, int kept)
  {
    const Vertices gained = state.vertices;
    const internal::Output_defects initial = defects_of(start);
    state.counts.creases.largest = int(initial.number_of_creases);
    state.counts.intersections.largest = int(initial.intersections.size());
    Sequential_defect_repair repair(state, start, initial);
    repair.run();
    RCO_CHECK(repair.has_restored_vertices());
    RCO_CHECK_EQUAL(defects().number, 0u);
    RCO_CHECK_EQUAL(defects().intersections.size(), 0u);
    RCO_CHECK(is_at(restored, start) && is_at(kept, gained));
  }
};

// Defects at the end are repaired locally.
void test_defect_repair()
{
  const Shape triangles = plane_grid(n, n, n);
  {
    const Scope s("faces that are inverted");
    Movable_mesh mesh(triangles);
    mesh.move(id(3, 3), 1.6, 0.1);
    RCO_CHECK_LESS(0u, mesh.defects().number);
    mesh.check_repair(id(3, 3), id(9, 9));
  }
  // a face of the input with an angle far below that of the others leaves them free to move
  Shape thin = triangles;
  thin.points[id(1, 1)].x() += 0.95;
  {
    // three columns have moved, one vertex too far: others would be inverted if it returned alone
    const Scope s("what is around");
    Movable_mesh mesh(thin);
    for(int j = 4; j < 9; ++j)
      for(int i = 3; i < 6; ++i)
        mesh.move(id(i, j), i == 3 ? 1.7 : i == 4 ? 1.3 : 0.4, 0);
    RCO_CHECK_EQUAL(mesh.defects().number, 0u);
    mesh.move(id(4, 6), 0.2, 0);
    mesh.move(id(10, 10), 0.2, 0.1);
    RCO_CHECK_LESS(0u, mesh.defects().number);
    mesh.check_repair(id(3, 6), id(10, 10));
  }
  {
    const Scope s("faces that intersect");
    const int half = int(thin.points.size());
    Movable_mesh mesh(joined(thin, thin));
    for(int v = 0; v < half; ++v)
      mesh.move(half + v, 0, 0, 0.05);
    mesh.start = mesh.state.vertices;
    mesh.move(half + id(3, 3), 0, 0, -0.1);
    mesh.move(half + id(9, 9), 0.2, 0.1);
    RCO_CHECK_EQUAL(mesh.defects().number, 0u);
    RCO_CHECK_LESS(0u, mesh.defects().intersections.size());
    mesh.check_repair(half + id(3, 3), half + id(9, 9));
  }
  {
    const Scope s("an angle that is slightly smaller");
    Movable_mesh mesh(thin);
    mesh.move(id(8, 8), 0.2, 0.1);
    const double smallest = mesh.defects().smallest_angle;
    mesh.move(id(1, 1), 1e-9, 0);
    RCO_CHECK_LESS(mesh.defects().smallest_angle, smallest);
    mesh.check_repair(id(1, 1), id(8, 8));
    RCO_CHECK_EQUAL(mesh.defects().smallest_angle, smallest);
  }
  {
    const Scope s("a quad that is slightly non-convex");
    Movable_mesh mesh(plane_grid(n, n, n, true), RCO::Quad_angle_energy());
    mesh.move(id(3, 3), 0.5 + 1e-12, 0.5 + 1e-12);
    mesh.move(id(9, 9), 0.2, 0.1);
    RCO_CHECK_EQUAL(mesh.defects().number, 1u);
    mesh.check_repair(id(3, 3), id(9, 9));
  }
  {
    const Scope s("an energy that has risen");
    Movable_mesh mesh(thin);
    mesh.move(id(9, 9), 0.1, 0);
    mesh.move(id(5, 4), 0.2, 0.1);
    const Vertices moved = mesh.state.vertices;
    const internal::Output_defects initial = mesh.defects_of(mesh.start);
    Sequential_defect_repair repair(mesh.state, mesh.start, initial);
    repair.run();
    RCO_CHECK(!repair.has_restored_vertices());
    const auto density = RCO::Minimum_angle_energy().density();
    RCO_CHECK(repair.enlarge(density));
    RCO_CHECK(mesh.is_at(id(5, 4), mesh.start) && mesh.is_at(id(9, 9), moved));
    while(repair.enlarge(density))
    {}
    RCO_CHECK(mesh.is_at(id(9, 9), mesh.start));
  }
}

// Points that did not move keep their bits, others are those of the state in the user's coordinates.
void test_points()
{
  const auto placed = [](const Shape& s) { return shifted(scaled(s, 0.7), {1e5, 0.1, -3e4}); };
  const Shape sphere = placed(icosphere(2)),
              start = placed(scrambled(icosphere(2), 0.2, 1, onto_sphere));
  Mesh mesh = mesh_of(start);
  const internal::Frame frame(copy_of(sphere));
  Located_shape scene(start, sphere);
  std::vector<Vector_3> before;
  for(std::size_t v = 0; v < start.points.size(); ++v)
  {
    before.push_back(frame(start.points[v]));
    scene.state.vertices[v].position = v % 3 == 0 ? frame(sphere.points[v]) : before[v];
  }
  internal::write_points(mesh, get(CGAL::vertex_point, mesh), before, scene.state, frame);
  const Shape after = make_shape(mesh);
  for(std::size_t v = 0; v < start.points.size(); ++v)
    RCO_CHECK(same_bits(after.points[v], v % 3 == 0 ? sphere.points[v] : start.points[v]));
}

int main()
{
  run_test("repair", test_defect_repair);
  run_test("points", test_points);
  return report();
}
