// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Energies are sums of terms: elements with weights, stencils of vertices anywhere, sums of energies.

#include "Straight_rows.h"
#include "deformations.h"
#include "optimization.h"

using namespace rco_test;

// optimizes a mesh on itself as reference, and checks properties that hold for every energy
template <typename Energy, typename NamedParameters>
Shape optimized(const Shape& start,
                const Shape& surface,
                const Energy& energy,
                const NamedParameters& np,
                RCO::Result* result = nullptr)
{
  Mesh mesh = mesh_of(start), reference = mesh_of(surface);
  const Shape before = make_shape(mesh);
  const RCO::Result r = CGAL::reference_constrained_optimize(mesh, reference, energy, np);
  check_result(before, mesh, reference, r);
  RCO_CHECK_LESS_EQUAL(r.final_energy, r.initial_energy);
  if(result)
    *result = r;
  return make_shape(mesh);
}

// A vertex with a large weight moves to the point of R that is closest to its target; with a smaller one it
// ends in between. Weight 0 has no effect.
void test_attraction()
{
  const int n = 12;
  const Shape s = plane_grid(n, n);
  const int v = nearest(s, Vector_3(0.5, 0.5, 0));
  const Vector_3 target = s.points[v] + Vector_3(0.6 / n, -0.3 / n, 0.5);
  const auto pulled = [&](double weight) {
    const RCO::Attraction_energy attraction({{std::size_t(v), target}});
    return optimized(s, s, RCO::sum(1, RCO::Minimum_angle_energy(), weight, attraction),
                     params::energy_tolerance(1e-6).use_finishing_stage(false));
  };
  const Shape still = pulled(0);
  RCO_CHECK(same_bits(still, optimized(s, s, RCO::Minimum_angle_energy(),
                                       params::energy_tolerance(1e-6).use_finishing_stage(false))));
  const auto distance = [&](const Shape& shape) {
    return (shape.points[v] - onto_plane(target)).norm() * n;
  };
  double last = distance(still);
  RCO_CHECK_LESS(0.3, last);
  for(const double weight : {10., 300., 1e5})
  {
    const Shape shape = pulled(weight);
    for(const Vector_3& p : shape.points)
      RCO_CHECK_EQUAL(p.z(), 0.);
    RCO_CHECK_LESS(distance(shape), last);
    last = distance(shape);
  }
  RCO_CHECK_LESS(last, 0.01);

  const Shape sphere = icosphere(3);
  const int pole = nearest(sphere, Vector_3(0, 0, 1));
  const Vector_3 off = Vector_3(0.05, 0.03, 1).normalized();
  const RCO::Attraction_energy attraction({{std::size_t(pole), 1.5 * off}});
  RCO::Result result;
  const Shape moved =
    optimized(sphere, sphere, RCO::sum(1, RCO::Minimum_angle_energy(), 1e5, attraction),
              params::energy_tolerance(1e-6), &result);
  const internal::Reference_surface surface(copy_of(sphere));
  const Vector_3 closest = surface.closest(1.5 * off).position;
  RCO_CHECK_LESS(0.04, (sphere.points[pole] - closest).norm());
  RCO_CHECK_LESS((moved.points[pole] - closest).norm(), 0.006);
}

// Rows of a scrambled grid become straight; the sum decreases although stencils reach across patches.
void test_wide_stencils()
{
  const int n = 24;
  const Shape regular = plane_grid(n, n);
  const Shape start = scrambled(regular, 0.25, 3, onto_plane);
  const Straight_rows rows{n + 1, n + 1};
  const auto bend = [&](const Shape& s) {
    std::vector<RCO::Energy_stencil<6>> stencils;
    rows.append_stencils(0, stencils);
    double sum = 0;
    for(const RCO::Energy_stencil<6>& stencil : stencils)
    {
      std::array<Eigen::Vector3d, 6> p;
      for(int k = 0; k < 6; ++k)
        p[k] = s.points[stencil.vertices[k]];
      sum += rows.value(0, p);
    }
    return sum;
  };
  // the first summand has its minimum at the input
  const RCO::Compatible_remeshing_energy stay(mesh_of(start));
  for(const int size : {0, 60}) // many small patches, too
  {
    const Shape straight = optimized(start, regular, RCO::sum(1, stay, 10, rows),
                                     params::maximum_patch_size(size).random_seed(1));
    RCO_CHECK_LESS(bend(straight), 0.5 * bend(start));
  }
}

// a summand adds its energy; its weight is equivalent to the weight of elements
struct Weighted_angle_energy : RCO::Minimum_angle_energy
{
  double weight;
  explicit Weighted_angle_energy(double w) : weight(w) {}
  template <typename Context>
  void append_elements(const Context& context,
                       std::size_t f,
                       std::vector<RCO::Energy_element>& elements) const
  {
    RCO_CHECK(context.point_map()[context.vertex_descriptor_of(0)] ==
              context.mesh().point(*context.mesh().vertices_begin()));
    RCO_CHECK(context.face_descriptor_of(f) == typename Mesh::Face_index(unsigned(f)));
    RCO::Minimum_angle_energy::append_elements(context, f, elements);
    elements.back().weight = weight;
  }
};

void test_sums()
{
  const Shape s = scrambled(icosphere(3), 0.3, 2, onto_sphere), sphere = icosphere(3);
  const auto np = params::random_seed(2);
  RCO::Result once, weighted, summed, nested;
  const Shape a = optimized(s, sphere, RCO::Minimum_angle_energy(), np, &once);
  // powers of two change nothing but the energy's unit
  const Shape b = optimized(s, sphere, Weighted_angle_energy(4), np, &weighted);
  const Shape c = optimized(s, sphere, RCO::sum(4, RCO::Minimum_angle_energy()), np, &summed);
  RCO_CHECK(same_bits(a, b) && same_bits(a, c));
  RCO_CHECK_EQUAL(weighted.final_energy, 4 * once.final_energy);
  RCO_CHECK_EQUAL(summed.final_energy, 4 * once.final_energy);

  // a second term with elements, of another density
  const RCO::Compatible_remeshing_energy isometry(mesh_of(sphere));
  const auto sum = RCO::sum(2, RCO::Minimum_angle_energy(), 0.5, RCO::sum(2, isometry));
  optimized(s, sphere, sum, np, &nested);
  RCO::Result angle, map;
  optimized(s, sphere, RCO::Minimum_angle_energy(), params::number_of_iterations(0), &angle);
  optimized(s, sphere, isometry, params::number_of_iterations(0), &map);
  // the mean is over the elements of both
  RCO_CHECK_NEAR(nested.initial_energy, 0.5 * (2 * angle.initial_energy + map.initial_energy),
                 1e-9 * nested.initial_energy);
  RCO_CHECK_LESS(nested.final_energy, nested.initial_energy);
}

void test_errors()
{
  const Shape s = icosphere(1);
  const auto run = [&](const auto& energy) {
    Mesh mesh = mesh_of(s);
    try
    {
      CGAL::reference_constrained_optimize(mesh, mesh, energy);
    }
    catch(...)
    {
      RCO_CHECK(same_bits(make_shape(mesh), s));
      throw;
    }
  };
  const RCO::Minimum_angle_energy angle;
  typedef RCO::Attraction_energy Attraction;
  RCO_CHECK_THROWS(RCO::sum(-1, angle), RCO::Invalid_input, "weight");
  RCO_CHECK_THROWS(Attraction({{0, Vector_3(0, NAN, 0)}}), RCO::Invalid_input, "target 0");
  RCO_CHECK_THROWS(run(RCO::sum(1, angle, 1, Attraction({{1000, Vector_3(0, 0, 0)}}))),
                   RCO::Invalid_input, "vertex 1000");
  RCO_CHECK_THROWS(run(Attraction({{0, Vector_3(0, 0, 0)}})), RCO::Invalid_input, "no element");
  RCO_CHECK_THROWS(run(Weighted_angle_energy(0)), RCO::Invalid_input, "weight");
}

int main()
{
  run_test("sums", test_sums);
  run_test("attraction", test_attraction);
  run_test("stencils of six vertices", test_wide_stencils);
  run_test("errors", test_errors);
  return report();
}
