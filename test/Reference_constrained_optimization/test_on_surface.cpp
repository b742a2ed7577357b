// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Steps on the surface: patches that are not flattened, step sizes, faces in a direction, the barrier on
// angles, the finishing stage as a whole, restarts, and clusters of vertices.

#include "checks.h"
#include "deformations.h"
#include "meshes.h"

#include <CGAL/reference_constrained_optimize.h>

#include <CGAL/Random.h>
#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/Symmetric_Dirichlet_density.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/point_index.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Angle_barrier_density.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/face_in_direction.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/Vertex_step_sizes.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_partition.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <Eigen/Cholesky>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/global_control.h>
#endif

using namespace rco_test;

typedef std::vector<std::vector<int>> Patches;

bool is_connected(const Indexed_mesh& mesh, const std::vector<int>& faces)
{
  std::set<int> missing(faces.begin(), faces.end());
  std::vector<int> stack(1, faces.front());
  missing.erase(faces.front());
  while(!stack.empty())
  {
    const int f = stack.back();
    stack.pop_back();
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      if(mesh.opposite[c] >= 0 && missing.erase(mesh.corner_face[mesh.opposite[c]]))
        stack.push_back(mesh.corner_face[mesh.opposite[c]]);
  }
  return missing.empty();
}

Patches
divided(const Indexed_mesh& mesh, const std::vector<char>& is_selected, int size, unsigned int seed)
{
  internal::Patch_partition partition(mesh, size);
  RCO_CHECK_EQUAL(partition.patch_size(), size);
  CGAL::Random random(seed);
  const Patches patches = partition.divide(is_selected, random);

  std::vector<int> times(mesh.number_of_faces(), 0);
  std::size_t previous = times.size();
  for(const std::vector<int>& patch : patches)
  {
    if(!RCO_CHECK(!patch.empty()))
      continue;
    RCO_CHECK_LESS_EQUAL(patch.size(), previous);
    previous = patch.size();
    for(const int f : patch)
      ++times[f];
    RCO_CHECK(is_connected(mesh, patch));
  }
  for(int f = 0; f < mesh.number_of_faces(); ++f)
    RCO_CHECK_EQUAL(times[f], int(is_selected[f] != 0));

  // an object that has divided something else before gives the same
  internal::Patch_partition used(mesh, 7 * size);
  CGAL::Random other(seed + 1), again(seed);
  used.divide(is_selected, other);
  used.set_patch_size(size);
  RCO_CHECK(used.divide(is_selected, again) == patches);

  // whole regions: again all wanted faces once, and none that touches another unless it was too large
  CGAL::Random third(seed);
  std::vector<int> patch_of(mesh.number_of_faces(), -1);
  int number = 0;
  for(const std::vector<int>& patch : used.divide_regions(is_selected, third))
  {
    RCO_CHECK(is_connected(mesh, patch));
    for(const int f : patch)
    {
      RCO_CHECK_EQUAL(patch_of[f], -1);
      patch_of[f] = number;
    }
    ++number;
  }
  int touching = 0;
  for(int f = 0; f < mesh.number_of_faces(); ++f)
  {
    RCO_CHECK_EQUAL(patch_of[f] >= 0, is_selected[f] != 0);
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      if(mesh.opposite[c] >= 0 && patch_of[f] >= 0)
      {
        const int other = patch_of[mesh.corner_face[mesh.opposite[c]]];
        touching += other >= 0 && other != patch_of[f];
      }
  }
  const bool any_large = std::count(is_selected.begin(), is_selected.end(), char(1)) > 3 * size;
  RCO_CHECK(any_large || touching == 0);
  return patches;
}

void test_partition()
{
  const Scope scope("partition");
  {
    const Scope s("regular torus");
    const Indexed_mesh mesh = indexed(torus(80, 40));
    const std::vector<char> all(mesh.number_of_faces(), 1);
    for(const int size : {50, 200, 1000})
      for(unsigned int seed = 0; seed < 5; ++seed)
      {
        const Patches patches = divided(mesh, all, size, seed);
        RCO_CHECK_EQUAL(int(patches.size()), (mesh.number_of_faces() + size - 1) / size);
        RCO_CHECK_LESS_EQUAL(double(patches.front().size()), 3.2 * size);
        // cells of seeds that happen to be close stay small, but few of them
        const auto large =
          std::count_if(patches.begin(), patches.end(), [&](const std::vector<int>& patch) {
            return 3.2 * double(patch.size()) >= size;
          });
        RCO_CHECK_LESS_EQUAL(0.9 * double(patches.size()), double(large));
      }
    RCO_CHECK(divided(mesh, all, 200, 0) != divided(mesh, all, 200, 1));
    RCO_CHECK(divided(mesh, std::vector<char>(all.size(), 0), 200, 0).empty());
    RCO_CHECK_EQUAL(divided(mesh, all, 1000000, 0).size(), std::size_t(1));
    RCO_CHECK_EQUAL(divided(mesh, all, 1, 0).size(), all.size());
  }
  {
    const Scope s("several components");
    // the small ones mostly get no seed, or one only and are a cell without end
    const Shape shape = joined(joined(joined(torus(30, 12), tetrahedron(), Vector_3(5, 0, 0)),
                                      icosphere(1), Vector_3(0, 5, 0)),
                               plane_grid(9, 5, 1, true), Vector_3(0, 0, 5));
    const Indexed_mesh mesh = indexed(shape);
    const std::vector<char> all(mesh.number_of_faces(), 1);
    for(unsigned int seed = 0; seed < 10; ++seed)
      for(const int size : {3, 40, 400, 100000})
        RCO_CHECK_LESS_EQUAL(std::size_t(4), divided(mesh, all, size, seed).size());
    RCO_CHECK_EQUAL(divided(mesh, all, 100000, 0).size(), std::size_t(4));
  }
  {
    const Scope s("some faces");
    const Indexed_mesh mesh = indexed(torus(30, 12));
    Random random(1);
    for(const double share : {0.002, 0.1, 0.5, 0.9})
      for(unsigned int seed = 0; seed < 5; ++seed)
      {
        std::vector<char> is_selected(mesh.number_of_faces());
        for(char& w : is_selected)
          w = random() < share;
        divided(mesh, is_selected, 30, seed);
      }
    std::vector<char> one(mesh.number_of_faces(), 0);
    one[17] = 1;
    RCO_CHECK(divided(mesh, one, 30, 0) == Patches(1, {17}));
  }
}

struct Fake_mover
{
  std::vector<double> length;
  double displacement_length(int v) const { return length[v]; }
};

// the data of a patch that step sizes depend on; vertices that slide are free at the border, too
internal::Patch patch_of(const Shape& shape, bool slides)
{
  internal::Patch patch;
  patch.polygons = indexed(shape);
  for(int v = 0; v < int(shape.points.size()); ++v)
  {
    patch.vertices.push_back(v);
    patch.is_free.push_back(patch.polygons.is_border_vertex[v] ? slides && v % 7 > 0 : v % 50 > 0);
    patch.located.emplace_back();
    patch.located.back().position = shape.points[v];
  }
  return patch;
}

double largest_difference(const internal::Patch& patch, const Fake_mover& mover, int a, int b)
{
  const double edge = (patch.located[a].position - patch.located[b].position).norm();
  const double displacement = (std::max)(mover.length[a], mover.length[b]);
  return displacement > 0 ? (std::min)(0.2, 0.3 * edge / displacement) : 0.2;
}

// Records every trial; it succeeds up to a given fraction of each vertex.
struct Tries
{
  std::vector<double> most, last;
  std::vector<int> number;
  explicit Tries(std::size_t n) : most(n, 1), last(n, -1), number(n, 0) {}
  auto function()
  {
    return [this](int v, double fraction) {
      RCO_CHECK(fraction >= 0 && fraction <= 1);
      last[v] = fraction;
      ++number[v];
      return fraction <= most[v];
    };
  }
};

// `may_be` is the fraction of a vertex without its neighbours
void check_fractions(const internal::Patch& patch,
                     const Fake_mover& mover,
                     const internal::Vertex_step_sizes& field,
                     const Tries& tries,
                     const std::vector<double>* may_be = nullptr)
{
  const std::vector<double>& fraction = field.fractions();
  std::vector<char> is_limited(fraction.size(), 0);
  const Indexed_mesh& mesh = patch.polygons;
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    for(const bool forwards : {true, false})
    {
      const int a = forwards ? mesh.source(c) : mesh.target(c);
      const int b = forwards ? mesh.target(c) : mesh.source(c);
      if(!patch.is_free[a] || !patch.is_free[b])
        continue;
      const double most = fraction[b] + largest_difference(patch, mover, a, b);
      RCO_CHECK_LESS_EQUAL(fraction[a], most + 1e-14);
      is_limited[a] = is_limited[a] || fraction[a] > most - 1e-14;
    }
  for(std::size_t v = 0; v < fraction.size(); ++v)
  {
    if(!patch.is_free[v])
    {
      RCO_CHECK_EQUAL(tries.number[v], 0);
      continue;
    }
    // the last trial is the result, and it succeeded
    RCO_CHECK_EQUAL(tries.last[v], fraction[v]);
    RCO_CHECK_LESS_EQUAL(fraction[v], tries.most[v]);
    // no fraction is lower than necessary
    if(may_be)
      RCO_CHECK(fraction[v] == (*may_be)[v] || (is_limited[v] && fraction[v] < (*may_be)[v]));
  }
}

void test_vertex_step_sizes()
{
  const Scope scope("vertex step sizes");
  const Shape shape = scrambled(plane_grid(24, 20), 0.3, 2, onto_plane);
  const int n = int(shape.points.size());
  Random random(3);
  for(int trial = 0; trial < 30; ++trial)
  {
    const internal::Patch patch = patch_of(shape, trial % 2 == 1);
    // from zero to several edges
    Fake_mover mover;
    const double longest = std::pow(10., random(-3, 0.)) * 0.5;
    for(int v = 0; v < n; ++v)
      mover.length.push_back(random() < 0.1 ? 0 : longest * random());
    internal::Vertex_step_sizes field;
    field.start(patch);
    RCO_CHECK(field.fractions() == std::vector<double>(n, 1));
    Tries tries(n);
    field.apply(patch, mover, tries.function());
    RCO_CHECK(field.fractions() == std::vector<double>(n, 1));
    for(int v = 0; v < n; ++v)
      RCO_CHECK_EQUAL(tries.number[v], int(patch.is_free[v]));

    // cuts, of fixed vertices in vain
    std::vector<double> may_be(n, 1);
    for(int i = 0; i < 5; ++i)
    {
      const int v = random.index(n);
      const double factor = random(0.01, 0.9);
      field.reduce(patch, v, factor);
      if(patch.is_free[v])
        may_be[v] *= factor;
    }
    const std::vector<int> number = tries.number;
    field.apply(patch, mover, tries.function());
    check_fractions(patch, mover, field, tries, &may_be);
    for(int v = 0; v < n; ++v) // unchanged fractions are not tried again
      RCO_CHECK_EQUAL(tries.number[v] > number[v], patch.is_free[v] && field.fractions()[v] < 1);

    // failures, some of them at any fraction above 0
    const std::vector<double> before = field.fractions();
    for(int v = 0; v < n; ++v)
      if(random() < 0.02)
        tries.most[v] = random() < 0.3 ? 0 : random();
    for(int v = 0; v < n; ++v)
      field.reduce(patch, v, 0.999);
    field.apply(patch, mover, tries.function());
    check_fractions(patch, mover, field, tries);
    for(int v = 0; v < n; ++v)
      if(patch.is_free[v])
        RCO_CHECK(field.fractions()[v] < before[v] || before[v] == 0);

    // all at once, down to nothing
    const std::vector<double> failed = field.fractions();
    field.reduce_all(patch, 0.5);
    field.apply(patch, mover, tries.function());
    check_fractions(patch, mover, field, tries);
    for(int v = 0; v < n; ++v)
      RCO_CHECK_LESS_EQUAL(field.fractions()[v], patch.is_free[v] ? 0.5 * failed[v] : 1);
    for(int i = 0; i < 10; ++i)
      field.reduce_all(patch, 0.5);
    field.apply(patch, mover, tries.function());
    for(int v = 0; v < n; ++v)
      RCO_CHECK_EQUAL(field.fractions()[v], patch.is_free[v] ? 0. : 1.);
    check_fractions(patch, mover, field, tries);
  }
}

// the best of many ways from the point to the boundary of a triangle
double sampled_progress(const Vector_3& from, const Vector_3 (&corners)[3], const Vector_3& along)
{
  double most = 0;
  const int steps = 400;
  for(int i = 0; i < 3; ++i)
    for(int k = 0; k <= steps; ++k)
    {
      const double t = double(k) / steps;
      const Vector_3 displacement = (1 - t) * corners[i] + t * corners[(i + 1) % 3] - from;
      if(displacement.norm() > 1e-12)
        most = (std::max)(most, displacement.normalized().dot(along));
    }
  return most;
}

void test_progress()
{
  const Scope scope("progress in a wedge");
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
  const internal::Reference_surface reference(copy_of(shape));
  const Indexed_mesh& mesh = reference.mesh();
  Random random(5);
  const auto check_from = [&](const internal::Surface_point& from, const std::set<int>& around) {
    const Vector_3 d = random.in_cube(1);
    const int face = internal::face_in_direction(reference, from, d);
    RCO_CHECK(around.count(face) > 0);
    double most = 0, own = 0;
    for(const int f : around)
    {
      const Vector_3 corners[3] = {reference.corner_point(f, 0), reference.corner_point(f, 1),
                                   reference.corner_point(f, 2)};
      const double progress = sampled_progress(from.position, corners, d);
      most = (std::max)(most, progress);
      if(f == face)
        own = progress;
    }
    RCO_CHECK_NEAR(own, most, 1e-4 * d.norm());
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

void test_point_index()
{
  const Scope scope("point index");
  Random random(6);
  std::vector<Vector_3> points;
  for(int v = 0; v < 1000; ++v)
    points.push_back(random.in_cube(1));
  const auto all = [](int) { return true; };
  const internal::Point_index index(points, all);
  for(int v = 0; v < 1000; ++v)
  {
    RCO_CHECK_EQUAL(index.find(points[v]), v);
    Vector_3 near = points[v];
    near[v % 3] = std::nextafter(near[v % 3], 2.);
    RCO_CHECK_EQUAL(index.find(near), -1);
  }
  RCO_CHECK_EQUAL(index.find(random.in_cube(1)), -1);
  RCO_CHECK_EQUAL(internal::Point_index({}, all).find(points[0]), -1);

  const internal::Point_index even(points, [](int v) { return v % 2 == 0; });
  RCO_CHECK_EQUAL(even.find(points[4]), 4);
  RCO_CHECK_EQUAL(even.find(points[5]), -1);

  // twice and three times; once only among those that count
  points[10] = points[20];
  points[31] = points[33] = points[35];
  points[40] = points[41];
  const internal::Point_index several(points, [](int v) { return v != 41; });
  RCO_CHECK_EQUAL(several.find(points[10]), -1);
  RCO_CHECK_EQUAL(several.find(points[31]), -1);
  RCO_CHECK_EQUAL(several.find(points[41]), 40);

  for(const double zero : {0., -0.})
  {
    const internal::Point_index flat({Vector_3(zero, 1, zero), Vector_3(1, zero, -zero)}, all);
    for(const double other : {0., -0.})
    {
      RCO_CHECK_EQUAL(flat.find(Vector_3(other, 1, -other)), 0);
      RCO_CHECK_EQUAL(flat.find(Vector_3(1, other, other)), 1);
    }
    const internal::Point_index same({Vector_3(zero, 1, 2), Vector_3(-zero, 1, 2)}, all);
    RCO_CHECK_EQUAL(same.find(Vector_3(0, 1, 2)), -1);
  }
}

template <typename Density>
void test_barrier(const std::string& name, const Density& density, double steepness)
{
  const Scope scope("angle barrier, " + name + ", " + std::to_string(steepness) + " per degree");
  const double unit = 6 / steepness; // degrees
  const auto densities = internal::make_element_densities(std::make_tuple(density));
  typedef internal::Angle_barrier_density<std::decay_t<decltype(densities)>> Barrier;
  internal::Element_set::Element element;
  element.has_criterion = true;
  Eigen::Matrix2d equilateral;
  equilateral << 1, 0.5, 0, std::sqrt(0.75);
  Random random(7);
  int near = 0, capped = 0, plain_again = 0;
  for(int i = 0; i < 3000; ++i)
  {
    Eigen::Matrix2d J;
    do
      J << random(-2, 2), random(-2, 2), random(-2, 2), random(-2, 2);
    while(!(J.determinant() > 0.05 * J.squaredNorm()));
    const Eigen::Matrix2d shape = J * equilateral;
    const Vector_3 corners[3] = {Vector_3::Zero(), Vector_3(shape(0, 0), shape(1, 0), 0),
                                 Vector_3(shape(0, 1), shape(1, 1), 0)};
    const double angle = smallest_angle(corners[0], corners[1], corners[2]);
    const double target = (std::max)(1., angle + unit * random(-6, 4));
    const Barrier barrier(densities, target, steepness);
    RCO_CHECK_EQUAL(barrier.target(), target);

    Eigen::Vector4d gradient, plain_gradient;
    Eigen::Matrix4d hessian, plain_hessian;
    const double value = barrier.projected_derivatives(element, J, gradient, hessian);
    const double plain_value =
      internal::projected_derivatives(density, J, plain_gradient, plain_hessian, 0);
    RCO_CHECK_NEAR(barrier.value(element, J), value, 1e-12 * value);
    RCO_CHECK_LESS_EQUAL(plain_value, value);
    element.has_criterion = false;
    RCO_CHECK_EQUAL(barrier.value(element, J), density.value(J));
    element.has_criterion = true;
    if(angle > target + 20 / steepness + 0.01)
    {
      RCO_CHECK_EQUAL(value, plain_value);
      RCO_CHECK_EQUAL(barrier.value(element, J), density.value(J));
      RCO_CHECK(gradient == plain_gradient && hessian == plain_hessian);
      ++plain_again;
      continue;
    }
    // what an angle adds, anew
    double added = 0;
    bool near_the_end = false; // where it stops and differences see the jump
    for(int k = 0; k < 3; ++k)
    {
      const Vector_3 u = corners[(k + 1) % 3] - corners[k], w = corners[(k + 2) % 3] - corners[k];
      const double x = steepness * (target - std::atan2(u.cross(w).norm(), u.dot(w)) * 180 / pi);
      const double h = x - 6;
      if(x > -20)
        added += x < 6 ? std::exp(x) : std::exp(6.) * (1 + h + 0.5 * h * h);
      near_the_end = near_the_end || std::abs(x + 20) < 0.1;
    }
    RCO_CHECK_NEAR(value - plain_value, added * density.value(Eigen::Matrix2d::Identity()),
                   1e-9 * value);
    capped += angle < target - unit;
    near += std::abs(angle - target) < unit;

    const Eigen::Matrix4d lifted = hessian + 1e-10 * hessian.norm() * Eigen::Matrix4d::Identity();
    RCO_CHECK(Eigen::LLT<Eigen::Matrix4d>(lifted).info() == Eigen::Success);
    RCO_CHECK_LESS_EQUAL((hessian - hessian.transpose()).norm(), 1e-12 * hessian.norm());
    if(near_the_end)
      continue;
    const double h = 1e-6 * unit * J.norm();
    for(int k = 0; k < 4; ++k)
    {
      const auto at = [&](double t) {
        Eigen::Matrix2d K = J;
        K.data()[k] += t;
        return barrier.value(element, K);
      };
      const double slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
      RCO_CHECK_NEAR(gradient(k), slope, 1e-5 * gradient.norm() + 1e-14 * value / h);
    }
  }
  RCO_CHECK_LESS(100, near);
  RCO_CHECK_LESS(100, capped);
  RCO_CHECK_LESS(100, plain_again);

  // inverted, or without extent
  const Barrier barrier(densities, 30, steepness);
  for(const double s : {-1., -1e-9, 0., 1e-9, 1e9})
    for(const double t : {0., 1e-40, 1.})
    {
      const Eigen::Matrix2d J = Vector_2(t, s * t).asDiagonal();
      Eigen::Vector4d gradient;
      Eigen::Matrix4d hessian;
      RCO_CHECK(std::isfinite(barrier.value(element, J)));
      RCO_CHECK(std::isfinite(barrier.projected_derivatives(element, J, gradient, hessian)));
    }
  RCO_CHECK_LESS(barrier.value(element, Vector_2(1, 0.3).asDiagonal()),
                 barrier.value(element, Vector_2(1, -0.3).asDiagonal()));
}

template <typename Tag>
std::pair<Shape, RCO::Result>
optimized(const Shape& start, const Shape& regular, bool finishes, unsigned int seed = 0)
{
  Mesh mesh = make_mesh<Mesh>(start);
  const Mesh reference = make_mesh<Mesh>(regular);
  const RCO::Result r = CGAL::reference_constrained_optimize<Tag>(
    mesh, reference, RCO::Minimum_angle_energy(),
    params::use_finishing_stage(finishes).random_seed(seed));
  RCO_CHECK_EQUAL(r.number_of_flips + r.number_of_fold_edges, std::size_t(0));
  RCO_CHECK(RCO::distance_to_reference(mesh, reference).is_on_reference());
  RCO_CHECK_LESS(r.final_energy, r.initial_energy);
  return {make_shape(mesh), r};
}

// `gain` is what the finishing stage must add to the smallest angle, in degrees
void test_finishing(const std::string& name, const Shape& start, const Shape& regular, double gain)
{
  const Scope scope("finishing stage, " + name);
  const auto without = optimized<CGAL::Sequential_tag>(start, regular, false);
  const auto with = optimized<CGAL::Sequential_tag>(start, regular, true);
  const double before = smallest_angle(without.first), after = smallest_angle(with.first);
  RCO_CHECK_LESS_EQUAL(before + gain, after);
  // the others do not pay for it
  RCO_CHECK_LESS(mean_smallest_angle(without.first) - 0.25, mean_smallest_angle(with.first));
  std::cout << name << ": smallest angle " << smallest_angle(start) << " -> " << before << " -> "
            << after << std::endl;

  const Indexed_mesh mesh = indexed(start);
  for(std::size_t v = 0; v < start.points.size(); ++v)
    if(mesh.is_border_vertex[v])
      RCO_CHECK(same_bits(start.points[v], with.first.points[v]));

  RCO_CHECK(same_bits(with.first, optimized<CGAL::Sequential_tag>(start, regular, true).first));
  const auto other = optimized<CGAL::Sequential_tag>(start, regular, true, 1);
  RCO_CHECK_LESS_EQUAL(before, smallest_angle(other.first) + 2);
#ifdef CGAL_LINKED_WITH_TBB
  for(const int threads : {1, 2, 8})
  {
    const Scope s(std::to_string(threads) + " threads");
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const auto parallel = optimized<CGAL::Parallel_tag>(start, regular, true);
    RCO_CHECK(same_bits(with.first, parallel.first));
    RCO_CHECK_EQUAL(with.second.final_energy, parallel.second.final_energy);
    RCO_CHECK_EQUAL(with.second.number_of_patches, parallel.second.number_of_patches);
  }
#endif
}

// the largest patch and the energy of each iteration
struct Largest_patches : RCO::Default_visitor
{
  std::vector<std::size_t> sizes;
  std::vector<double> energies;
  bool iterates = false;
  void on_iteration_begin(std::size_t)
  {
    iterates = true;
    sizes.push_back(0);
  }
  void on_iteration_end(std::size_t, double energy)
  {
    iterates = false;
    energies.push_back(energy);
  }
  void on_patch_end(const RCO::Patch_report& report)
  {
    if(iterates)
      sizes.back() = (std::max)(sizes.back(), report.number_of_faces);
  }
};

// After convergence, all of a mesh that was divided into several patches is visited in a single one; but
// not if the caller bounds their size.
void test_restarts()
{
  const Scope scope("restarting");
  const Shape ring = torus(80, 40), start = scrambled(ring, 0.3, 13, onto_torus(1, 0.4));
  const Mesh reference = make_mesh<Mesh>(ring);
  for(const unsigned int maximum : {0u, 2000u, 2000000000u})
  {
    Largest_patches visitor;
    Mesh mesh = make_mesh<Mesh>(start);
    const RCO::Result r = CGAL::reference_constrained_optimize(
      mesh, reference, RCO::Minimum_angle_energy(),
      params::maximum_patch_size(maximum).use_finishing_stage(false).visitor(std::ref(visitor)));
    RCO_CHECK(r.status == RCO::Status::converged);
    if(maximum <= 2000)
      RCO_CHECK_LESS(visitor.sizes.front(), ring.faces.size());
    const std::size_t largest = *std::max_element(visitor.sizes.begin(), visitor.sizes.end());
    if(maximum == 0)
      RCO_CHECK_EQUAL(largest, ring.faces.size());
    else
      RCO_CHECK_LESS_EQUAL(largest, std::size_t(maximum));
    for(std::size_t i = 1; i < visitor.energies.size(); ++i)
      RCO_CHECK_LESS_EQUAL(visitor.energies[i], visitor.energies[i - 1] * (1 + 1e-12));
  }
}

// A saddle with a border where vertices nearly coincide with their neighbours, inside and at the border, as
// marching cubes produce them. Faces at fixed vertices of the border stay sharp: the faces at these short
// edges, and no others.
void test_clusters(double size)
{
  const Scope scope("clusters of " + std::to_string(-std::log10(size)) + " digits");
  const int n = 16;
  Shape start = plane_grid(n, n);
  const Indexed_mesh grid = indexed(start);
  std::vector<char> is_in(start.points.size(), 0);
  for(const int center : {2 * (n + 1) + 7, 7 * (n + 1) + 4, 8 * (n + 1) + 11, 13 * (n + 1) + 13, 6,
                          9 * (n + 1), 12 * (n + 1) - 1, n * (n + 1) + 5})
  {
    const Vector_3 p = start.points[center];
    for(int k = grid.vertex_begin[center]; k < grid.vertex_begin[center + 1]; ++k)
    {
      const int c = grid.vertex_corners[k];
      for(const int v : {center, grid.target(c), grid.source(grid.previous(c))})
        if(!is_in[v])
        {
          is_in[v] = 1;
          start.points[v] = p + size * (start.points[v] - p);
        }
    }
  }
  for(Vector_3& p : start.points)
    p.z() = 0.5 * (p.x() - 0.4) * (p.y() - 0.6);
  std::size_t held = 0;
  for(int c = 0; c < grid.number_of_corners(); ++c)
    held += grid.opposite[c] < 0 && is_in[grid.source(c)] && is_in[grid.target(c)];
  const auto sharp = [](const Shape& shape) {
    std::size_t count = 0;
    for(const std::vector<int>& f : shape.faces)
      count += smallest_angle(Shape{shape.points, {f}}) < 10;
    return count;
  };
  RCO_CHECK_LESS(2 * held, sharp(start));
  for(const unsigned int seed : {0, 1, 2, 3})
  {
    const auto result = optimized<CGAL::Sequential_tag>(start, start, true, seed);
    RCO_CHECK_LESS_EQUAL(sharp(result.first), held);
    RCO_CHECK_LESS(mean_smallest_angle(start), mean_smallest_angle(result.first));
    RCO_CHECK_LESS_EQUAL(smallest_angle(start), smallest_angle(result.first));
    for(std::size_t v = 0; v < start.points.size(); ++v)
      if(grid.is_border_vertex[v])
        RCO_CHECK(same_bits(start.points[v], result.first.points[v]));
    std::cout << "clusters of " << size << ": faces below 10 degrees " << sharp(start) << " -> "
              << sharp(result.first) << ", of which stay " << held << "; mean "
              << mean_smallest_angle(start) << " -> " << mean_smallest_angle(result.first)
              << std::endl;
  }
}

int main()
{
  test_partition();
  test_vertex_step_sizes();
  test_progress();
  Shape bumps = plane_grid(9, 7);
  Random random(8);
  for(Vector_3& p : bumps.points)
    p += random.in_cube(0.03) + random(-0.1, 0.1) * Vector_3::UnitZ();
  test_face_in_direction("bumps with a border", bumps);
  test_face_in_direction("torus",
                         scrambled(torus(14, 7), 0.3, 9, [](const Vector_3& p) { return p; }));
  test_face_in_direction("tetrahedron", tetrahedron());
  test_point_index();
  for(const double steepness : {6, 12, 30})
  {
    test_barrier("exponential MIPS", RCO::Exponential_MIPS_density(1), steepness);
    test_barrier("symmetric Dirichlet", RCO::Symmetric_Dirichlet_density(), steepness);
  }

  test_restarts();
  for(const double size : {1e-4, 1e-11, 1e-13})
    test_clusters(size);
  const Shape ring = torus(50, 20), ball = icosphere(3), square = plane_grid(24, 24);
  test_finishing("torus", scrambled(ring, 0.3, 10, onto_torus(1, 0.4)), ring, 0.5);
  test_finishing("sphere", scrambled(ball, 0.3, 11, onto_sphere), ball, 0);
  test_finishing("square", scrambled(square, 0.3, 12, onto_plane), square, 0);
#ifdef RCO_DATA_DIR
  const Shape blobby = read_off(std::string(RCO_DATA_DIR) + "/blobby.off");
  if(!blobby.faces.empty())
    test_finishing("blobby", blobby, blobby, 2);
#endif
  return report();
}
