// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Patches of a mesh on its reference, the terms of their stencils, and measures of the whole mesh.

#include "Located_shape.h"
#include "Straight_rows.h"
#include "checks.h"
#include "deformations.h"

#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/Quad_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/self_intersections.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/near_sheets.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Stencil_terms.h>

#include <algorithm>

using namespace rco_test;

// A patch is the given part of the mesh, in indices of its own.
template <typename Energy>
void test_patches(const Shape& start, const Shape& reference, const Energy& energy)
{
  const Located_shape scene(start, reference, energy);
  const Indexed_mesh& mesh = scene.copy.mesh;
  Random random(1);
  for(int trial = 0; trial < 20; ++trial)
  {
    const Vector_3 center = start.points[random.index(int(start.points.size()))];
    const double radius = random(0.1, 1.5);
    const internal::Patch patch =
      scene.patch([&](const Vector_3& p) { return (p - center).norm() < radius; });
    if(patch.faces.empty())
      continue;
    std::vector<char> is_in(mesh.number_of_faces(), 0);
    for(const int f : patch.faces)
      is_in[f] = 1;
    int number_of_elements = 0, free = 0;
    for(int i = 0; i < int(patch.faces.size()); ++i)
    {
      const int f = patch.faces[i], first = patch.polygons.face_begin[i];
      RCO_CHECK_EQUAL(patch.polygons.degree(i), mesh.degree(f));
      for(int k = 0; k < mesh.degree(f); ++k)
      {
        const int c = first + k, o = mesh.opposite[mesh.face_begin[f] + k];
        RCO_CHECK_EQUAL(patch.vertices[patch.polygons.corner_vertex[c]],
                        mesh.corner_vertex[mesh.face_begin[f] + k]);
        const int neighbour = o < 0 ? -1 : mesh.corner_face[o];
        const bool is_inside = neighbour >= 0 && is_in[neighbour];
        RCO_CHECK_EQUAL(patch.outside_face[c], is_inside ? -1 : neighbour);
        RCO_CHECK_EQUAL(patch.polygons.opposite[c] >= 0, is_inside);
        if(is_inside)
          RCO_CHECK_EQUAL(patch.faces[patch.polygons.corner_face[patch.polygons.opposite[c]]],
                          neighbour);
      }
      for(int e = scene.elements.begin(f); e < scene.elements.end(f); ++e, ++number_of_elements)
        for(int k = 0; k < 3; ++k)
          RCO_CHECK_EQUAL(patch.vertices[patch.elements[number_of_elements].vertices[k]],
                          scene.elements[e].vertices[k]);
    }
    RCO_CHECK_EQUAL(number_of_elements, int(patch.elements.size()));
    for(int v = 0; v < int(patch.vertices.size()); ++v)
    {
      const int w = patch.vertices[v];
      bool is_inside = scene.state.is_free[w];
      for(int k = mesh.vertex_begin[w]; k < mesh.vertex_begin[w + 1]; ++k)
        is_inside = is_inside && is_in[mesh.corner_face[mesh.vertex_corners[k]]];
      RCO_CHECK_EQUAL(bool(patch.is_free[v]), is_inside);
      RCO_CHECK(same_bits(patch.located[v].position, scene.state.vertices[w].position));
      free += is_inside;
    }
    RCO_CHECK_EQUAL(patch.number_of_free_vertices, free);
    for(int t = 0; t < patch.triangles().number_of_faces(); ++t)
    {
      const int f = patch.polygon_of(t);
      RCO_CHECK(patch.triangle_of(f) == t || patch.triangle_of(f) == t - 1);
    }
  }
}

// Defects and the smallest angle are those that are made.
void test_measures()
{
  const Shape plane = plane_grid(90, 90);
  Located_shape scene(plane, plane);
  const RCO::Exponential_MIPS_density density(1);
  const auto measured = [&]() {
    const internal::Global_measure m =
      internal::measure<CGAL::Sequential_tag>(scene.state, density, 100);
#ifdef CGAL_LINKED_WITH_TBB
    const internal::Global_measure parallel =
      internal::measure<CGAL::Parallel_tag>(scene.state, density, 100);
    RCO_CHECK(m.energy == parallel.energy && m.defects() == parallel.defects());
#endif
    return m;
  };
  const internal::Global_measure regular = measured();
  RCO_CHECK_EQUAL(regular.defects(), 0u);
  RCO_CHECK_EQUAL(regular.energy, regular.capped_energy);
  RCO_CHECK_NEAR(std::acos(regular.largest_cosine) * 180 / pi, smallest_angle(plane), 1e-9);
  internal::Located_vertex& v = scene.state.vertices[91 * 40 + 40];
  v.position += Vector_3(1.1 / 90, 0.1 / 90, 0);
  const internal::Global_measure inverted = measured();
  RCO_CHECK(inverted.flips > 0 && inverted.fold_edges > 0);
  RCO_CHECK_LESS(inverted.capped_energy, inverted.energy);
}

// Faces of a single sheet that lie on one another are counted, and are tested from then on.
void test_watched_intersections()
{
  Located_shape scene(scrambled(icosphere(3), 0.7, 1, onto_sphere), icosphere(3));
  internal::Optimization_state& state = scene.state;
  const auto is_tested = [&](int f) {
    return std::any_of(state.faces_near_sheets.begin(), state.faces_near_sheets.end(),
                       [&](const auto& near) { return near.face == f; });
  };
  state.set_near_sheets(internal::near_sheets(scene.surface, 1));
  state.counts.intersections = {0, 0};
  std::vector<Vector_3> points;
  for(const internal::Located_vertex& v : state.vertices)
    points.push_back(v.position);
  const auto pairs = internal::self_intersections(scene.copy.mesh, points);
  RCO_CHECK_LESS(20, int(pairs.size()));
  RCO_CHECK(!is_tested(pairs.front().first));
  state.watch_intersections();
  RCO_CHECK_EQUAL(state.counts.intersections.now, int(pairs.size()));
  for(const std::pair<int, int>& pair : pairs)
    RCO_CHECK(is_tested(pair.first) && is_tested(pair.second));
  RCO_CHECK_LESS(state.faces_near_sheets.size(), std::size_t(scene.copy.mesh.number_of_faces()));
}

// Coordinates of vertices in their frames move them in space; vertices outside the patch stay.
void test_stencil_terms()
{
  const int n = 12;
  const Straight_rows rows{n + 1, n + 1};
  Located_shape scene(scrambled(plane_grid(n, n), 0.2, 1, onto_plane), plane_grid(n, n));
  const internal::Mesh_copy& copy = scene.copy;
  scene.state.stencils = internal::Stencil_set(
    rows,
    RCO::Energy_context(copy.mesh.face_begin, copy.mesh.corner_vertex, copy.points.size(), 1, 1, 1),
    internal::Frame(copy));
  const internal::Patch patch = scene.patch([](const Vector_3& p) { return p.x() < 0.6; });
  Random random(2);
  std::vector<internal::Tangent_frame> frames(patch.vertices.size());
  std::vector<Vector_2> u(patch.vertices.size());
  for(std::size_t v = 0; v < frames.size(); ++v)
  {
    frames[v] << random.in_cube(1), random.in_cube(1);
    u[v] = Vector_2(random(-0.1, 0.1), random(-0.1, 0.1));
  }
  internal::Stencil_terms terms;
  terms.collect(patch, [&](int v) { return frames[v]; });
  RCO_CHECK_EQUAL(terms.terms().size(), patch.stencils.size());
  RCO_CHECK_LESS(20, int(terms.terms().size()));
  const auto displacement = [&](int v) { return u[v]; };
  int outside = 0;
  for(const internal::Stencil_terms::Term& term : terms.terms())
  {
    internal::Stencil_gradient gradient;
    internal::Stencil_hessian hessian;
    const double value = terms.derivatives(term, displacement, gradient, hessian), h = 1e-5;
    RCO_CHECK_NEAR(terms.value(term, displacement), value, 1e-12 * value);
    for(int i = 0; i < term.size; ++i)
    {
      outside += term.vertices[i] < 0;
      for(int d = 0; d < 2 && term.vertices[i] >= 0; ++d)
      {
        double& x = u[term.vertices[i]](d);
        const double here = x;
        x = here + h;
        const double high = terms.value(term, displacement);
        x = here - h;
        RCO_CHECK_NEAR(gradient(2 * i + d), (high - terms.value(term, displacement)) / (2 * h),
                       1e-6 * gradient.norm());
        x = here;
      }
    }
  }
  RCO_CHECK_LESS(0, outside);
}

int main()
{
  test_patches(scrambled(torus(24, 12), 0.2, 1, onto_torus(1, 0.4)), torus(24, 12),
               RCO::Minimum_angle_energy());
  test_patches(plane_grid(12, 10, 1, true), plane_grid(12, 10), RCO::Quad_angle_energy());
  run_test("measures", test_measures);
  run_test("watched intersections", test_watched_intersections);
  run_test("stencil terms", test_stencil_terms);
  return report();
}
