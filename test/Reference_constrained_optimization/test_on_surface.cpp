// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Movers on the surface: Newton's method in tangent planes, the pattern search, and clusters of vertices.

#include "Located_shape.h"
#include "meshes.h"
#include "surfaces.h"

#include <CGAL/Reference_constrained_optimization/Compatible_remeshing_energy.h>
#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/Cluster_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/On_surface_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/Pattern_search_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/Shape_bound.h>

using namespace rco_test;

typedef RCO::Compatible_remeshing_energy Energy;

// The language allows private members to be named where a template is instantiated explicitly.
template <typename Tag, typename Tag::type Member>
struct Access
{
  friend typename Tag::type member(Tag) { return Member; }
};

struct Problem_tag
{
  typedef internal::Tangent_problem internal::On_surface_mover::*type;
  friend type member(Problem_tag);
};

template struct Access<Problem_tag, &internal::On_surface_mover::m_problem>;

struct Frames_tag
{
  typedef std::vector<internal::Tangent_frame> internal::On_surface_mover::*type;
  friend type member(Frames_tag);
};

template struct Access<Frames_tag, &internal::On_surface_mover::m_frames>;

struct Right_tag
{
  typedef Eigen::VectorXd internal::Projected_newton::*type;
  friend type member(Right_tag);
};

template struct Access<Right_tag, &internal::Projected_newton::m_rhs>;

struct Assemble_tag
{
  typedef double (internal::Projected_newton::*type)(const internal::Tangent_problem&,
                                                     const Energy::Density&,
                                                     const std::vector<Vector_2>&);
  friend type member(Assemble_tag);
};

template struct Access<
  Assemble_tag,
  &internal::Projected_newton::assemble<internal::Tangent_problem, Energy::Density>>;

void test_on_surface_steps(const std::string& name, const Shape& shape, const Vector_3& center)
{
  const Scope scope("on-surface steps, " + name);
  double displacement = 0;
  const Shape start =
    wandered(shape, internal::Reference_surface(copy_of(shape)), 4, 0.2, 3, displacement);
  const Energy energy(mesh_of(shape));
  const Located_shape scene(start, shape, energy);
  const internal::Reference_surface& surface = scene.surface;
  const internal::Patch patch =
    scene.patch([&](const Vector_3& p) { return (p - center).norm() < 0.4; });
  RCO_CHECK(patch.number_of_free_vertices >= 10);
  const int n = int(patch.vertices.size());
  const Energy::Density& density = energy.density();

  // without steps the mover only sets up its problem
  internal::On_surface_mover still(surface, 0);
  RCO_CHECK(!still.propose(patch, internal::Patch_samples(), density));
  const internal::Tangent_problem& problem = still.*member(Problem_tag());
  const auto& frames = still.*member(Frames_tag());
  const auto value = [&](const std::vector<Vector_2>& u) {
    double sum = 0;
    for(std::size_t e = 0; e < problem.triples.size(); ++e)
      sum += density.value(problem.shape(e, u) * problem.rest_inverse[e]);
    return sum;
  };
  // the energy in space, of which the problem is the first order
  const auto value_in_space = [&](const std::vector<Vector_2>& u) {
    std::vector<internal::Located_vertex> placed = patch.located;
    for(int v = 0; v < n; ++v)
      placed[v].position += frames[v] * u[v];
    double sum = 0;
    for(const internal::Element_set::Element& e : patch.elements)
      sum += internal::element_energy(
        density, e, [&](int v) -> const internal::Located_vertex& { return placed[v]; });
    return sum;
  };
  std::vector<Vector_2> u(n, Vector_2::Zero());
  internal::Projected_newton newton;
  newton.analyze(problem);
  const double energy_at_start = (newton.*member(Assemble_tag()))(problem, density, u);
  const Eigen::VectorXd gradient = -(newton.*member(Right_tag()));
  RCO_CHECK_EQUAL(gradient.size(), 2 * patch.number_of_free_vertices);
  RCO_CHECK_NEAR(energy_at_start, value(u), 1e-10 * energy_at_start);
  RCO_CHECK_NEAR(energy_at_start, value_in_space(u), 1e-10 * energy_at_start);
  const double size = gradient.cwiseAbs().maxCoeff(), h = 1e-6;
  RCO_CHECK_LESS(1., size);
  int variable = 0;
  for(int v = 0; v < n; ++v)
  {
    RCO_CHECK_NEAR((frames[v].transpose() * frames[v] - Eigen::Matrix2d::Identity()).norm(), 0.,
                   1e-14);
    const internal::Surface_point& at = patch.located[v].on_reference;
    // the plane is that of a face of R on which the vertex lies
    double angle = 1;
    for(int f = 0; f < surface.mesh().number_of_faces(); ++f)
      if((surface.closest_in_face(at.position, f).position - at.position).norm() < 1e-13)
        angle =
          (std::min)(angle, (frames[v].transpose() * surface.face_normal(f).normalized()).norm());
    RCO_CHECK_LESS(angle, 1e-13);
    if(!patch.is_free[v])
      continue;
    for(int i = 0; i < 2; ++i, ++variable)
    {
      double difference[2] = {0, 0};
      for(const double sign : {1., -1.})
      {
        u[v](i) = sign * h;
        difference[0] += sign * value(u) / (2 * h);
        difference[1] += sign * value_in_space(u) / (2 * h);
        u[v](i) = 0;
      }
      RCO_CHECK_NEAR(difference[0], gradient(variable), 1e-5 * size);
      RCO_CHECK_NEAR(difference[1], gradient(variable), 1e-5 * size);
    }
  }

  // descent to a place where the gradient vanishes
  const internal::Projected_newton::Outcome outcome =
    newton.minimize(problem, density, u, 200, 1e-14);
  RCO_CHECK_LESS(outcome.final_energy, outcome.initial_energy);
  RCO_CHECK_NEAR(outcome.initial_energy, energy_at_start, 1e-10 * energy_at_start);
  RCO_CHECK_NEAR(outcome.final_energy, value(u), 1e-10 * energy_at_start);
  (newton.*member(Assemble_tag()))(problem, density, u);
  RCO_CHECK_LESS((newton.*member(Right_tag())).norm(), 1e-3 * gradient.norm());
  for(int v = 0; v < n; ++v)
    if(!patch.is_free[v])
      RCO_CHECK(u[v] == Vector_2::Zero());

  // steps end on the surface
  internal::On_surface_mover mover(surface, 2);
  RCO_CHECK(mover.propose(patch, internal::Patch_samples(), density));
  int placed = 0;
  for(int v = 0; v < n; ++v)
    for(const double t : {1., 0.4, 1e-3})
    {
      internal::Located_vertex p;
      if(!patch.is_free[v] || !mover.displaced_vertex(patch, v, t, p))
        continue;
      ++placed;
      RCO_CHECK_LESS((surface.closest(p.position).position - p.position).norm(), 1e-13);
      RCO_CHECK_NEAR(p.on_reference.barycentric.sum(), 1., 1e-13);
      RCO_CHECK(p.on_reference.barycentric.minCoeff() >= 0);
      const internal::Surface_point again =
        surface.point(p.on_reference.face, p.on_reference.barycentric);
      RCO_CHECK_LESS((again.position - p.position).norm(), 1e-13);
      RCO_CHECK_LESS((surface.normal(again) - p.normal).norm(), 1e-12);
      RCO_CHECK_LESS(0., p.normal.dot(patch.located[v].normal));
    }
  // almost none is refused
  RCO_CHECK_LESS_EQUAL(0.9 * 3 * patch.number_of_free_vertices, double(placed));
}

// Steps end on the surface, as long as it goes on there.
void test_tangent_steps()
{
  const internal::Reference_surface plane(copy_of(plane_grid(5, 5)));
  Random random(1);
  for(int i = 0; i < 200; ++i)
  {
    internal::Located_vertex from, to;
    from.on_reference = plane.point(random.index(50), random.barycentric());
    from.position = from.on_reference.position;
    from.normal = Vector_3::UnitZ();
    const Vector_3 step = onto_plane(random.in_cube(0.3)), goal = from.position + step;
    const Vector_3 outside = goal.cwiseMax(Vector_3::Zero()).cwiseMin(Vector_3::Ones()) - goal;
    if(std::abs(outside.norm() - 0.5 * step.norm()) < 1e-9)
      continue;
    const bool has_moved = internal::step_on_surface(plane, from, step, to);
    RCO_CHECK_EQUAL(has_moved, outside.norm() < 0.5 * step.norm());
    if(has_moved)
      RCO_CHECK_LESS((to.position - goal - outside).norm(), 1e-12);
  }
}

// A search lowers the energy and adds no defect; whatever is not searched stays.
void test_pattern_search()
{
  const Shape regular = torus(24, 12);
  const RCO::Exponential_MIPS_density density(1);
  for(const bool is_bounded : {false, true})
  {
    Located_shape scene(scrambled(regular, 0.4, 2, onto_torus(1, 0.4)), regular);
    const internal::Patch patch = scene.whole_patch();
    internal::Shape_bound shape_bound;
    if(is_bounded)
      shape_bound.initialize<CGAL::Sequential_tag>(scene.state, 0.02, true,
                                                   internal::Drift_barrier(1));
    const internal::Patch_samples samples = shape_bound.gather(scene.state, patch);
    const internal::Global_measure before = scene.measure(density);
    internal::Pattern_search_mover mover(scene.surface);
    // without thresholds nothing is bad
    RCO_CHECK(!mover.propose(patch, samples, density));
    mover.set_thresholds(1e300, std::cos(10 / 57.3));
    RCO_CHECK(mover.propose(patch, samples, density));
    std::size_t moved = 0;
    for(int v = 0; v < int(patch.vertices.size()); ++v)
      moved += mover.displacement_length(v) > 0;
    RCO_CHECK_LESS(10u, moved);
    RCO_CHECK_LESS(moved, patch.vertices.size());
    RCO_CHECK(scene.move(patch, mover));
    const internal::Global_measure after = scene.measure(density);
    RCO_CHECK_LESS(after.energy, 0.8 * before.energy);
    RCO_CHECK_LESS_EQUAL(after.defects(), before.defects());
    RCO_CHECK_LESS(after.largest_cosine, before.largest_cosine);
    for(const internal::Located_vertex& v : scene.state.vertices)
      RCO_CHECK_LESS((scene.surface.closest(v.position).position - v.position).norm(), 1e-13);
    if(!is_bounded)
      continue;
    internal::Shape_bound now;
    now.initialize<CGAL::Sequential_tag>(scene.state, 0.02, true, internal::Drift_barrier(1));
    RCO_CHECK_LESS_EQUAL(now.initial_drift(),
                         shape_bound.bound() * internal::Drift_barrier::limit_factor * (1 + 1e-9));
  }
}

// Clusters are found, and nothing else, and their vertices are separated, on the surface and on its border.
void test_clusters()
{
  const int n = 8;
  for(const int center : {4 * (n + 1) + 4, 4})
    for(const double size : {1e-3, 1e-12})
    {
      Shape shape = plane_grid(n, n);
      const Indexed_mesh mesh = indexed(shape);
      const Vector_3 middle = shape.points[center];
      std::set<int> expected = {center};
      for(int k = mesh.vertex_begin[center]; k < mesh.vertex_begin[center + 1]; ++k)
        for(const int c : {mesh.vertex_corners[k], mesh.next(mesh.vertex_corners[k])})
          expected.insert(mesh.target(c));
      for(const int v : expected)
        shape.points[v] = middle + size * (shape.points[v] - middle);
      const auto found =
        internal::vertex_clusters(mesh, [&](int v) -> const Vector_3& { return shape.points[v]; });
      RCO_CHECK_EQUAL(found.size(), 1u);
      RCO_CHECK(std::set<int>(found[0].begin(), found[0].end()) == expected);
      Located_shape scene(shape, plane_grid(n, n));
      scene.relax_border();
      const internal::Patch patch = scene.whole_patch();
      internal::Cluster_mover mover(scene.surface);
      RCO_CHECK(mover.propose(patch, internal::Patch_samples(), RCO::Exponential_MIPS_density(1)));
      RCO_CHECK(scene.move(patch, mover));
      for(std::size_t v = 0; v < shape.points.size(); ++v)
      {
        shape.points[v] = scene.state.vertices[v].position;
        RCO_CHECK(expected.count(int(v)) || same_bits(shape.points[v], scene.copy.points[v]));
        RCO_CHECK(center > n || v > n || shape.points[v].y() == 0); // the lower side
      }
      RCO_CHECK_LESS(5., smallest_angle(shape));
    }
  Shape regular = icosphere(2);
  RCO_CHECK(internal::vertex_clusters(indexed(regular), [&](int v) -> const Vector_3& {
              return regular.points[v];
            }).empty());
}

int main()
{
  test_on_surface_steps("a blob", deformed(icosphere(3), bumpy), bumpy(Vector_3(1, 0, 0)));
  test_on_surface_steps("a hill", deformed(square(20, 20), hilly), hilly(Vector_3(0.6, 0.4, 0)));
  test_on_surface_steps("a border", deformed(square(20, 20), hilly), Vector_3(0.1, 0.1, 0));
  run_test("tangent steps", test_tangent_steps);
  run_test("pattern search", test_pattern_search);
  run_test("clusters", test_clusters);
  return report();
}
