// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Densities and stencils, their derivatives, and the barriers.

#include "Straight_rows.h"
#include "checks.h"
#include "deformations.h"

#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/Symmetric_Dirichlet_density.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Angle_barrier_density.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Stencil_set.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/drift_barrier.h>

#include <Eigen/Dense>

using namespace rco_test;

typedef Eigen::Matrix4d Matrix_4;
typedef Eigen::Vector4d Vector_4;

Vector_4 as_vector(const Matrix_2& m) { return Eigen::Map<const Vector_4>(m.data()); }

// derivatives in the four entries, in column-major order, by central differences of fourth order
template <typename Function>
auto differences(const Matrix_2& J, double h, const Function& f)
{
  typedef decltype(f(J)) Value;
  std::array<Value, 4> d;
  for(int i = 0; i < 4; ++i)
  {
    const auto at = [&](double t) {
      Matrix_2 K = J;
      K.data()[i] += t;
      return f(K);
    };
    d[i] = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
  }
  return d;
}

Matrix_4 eigen_projection(const Matrix_4& h)
{
  const Eigen::SelfAdjointEigenSolver<Matrix_4> solver(h);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.).asDiagonal() *
         solver.eigenvectors().transpose();
}

// the part of a density that the concept asks for, to reach the general projection
template <typename Density>
struct Plain_density
{
  const Density& density;
  double value(const Matrix_2& J) const { return density.value(J); }
  Matrix_2 gradient(const Matrix_2& J) const { return density.gradient(J); }
  Matrix_4 hessian(const Matrix_2& J) const { return density.hessian(J); }
};

template <typename Density>
void test_derivatives_at(const Density& density, const Matrix_2& J, double h)
{
  const Vector_4 gradient = as_vector(density.gradient(J));
  const Matrix_4 hessian = density.hessian(J);
  const double scale = J.norm();

  const auto slope = differences(J, h, [&](const Matrix_2& K) { return density.value(K); });
  const auto bend =
    differences(J, h, [&](const Matrix_2& K) { return as_vector(density.gradient(K)); });
  // rounding of the differences: values are known to about 1e-15 of themselves
  const double value_noise = 1e-14 * std::abs(density.value(J)) / h;
  const double gradient_noise = 1e-14 * gradient.norm() / h;
  const double first = 2e-6 * (gradient.norm() + 1e-3 * hessian.norm() * scale) + value_noise;
  const double second = 2e-5 * (hessian.norm() + gradient.norm() / scale) + gradient_noise;
  for(int i = 0; i < 4; ++i)
  {
    RCO_CHECK_NEAR(gradient(i), slope[i], first);
    for(int j = 0; j < 4; ++j)
      RCO_CHECK_NEAR(hessian(j, i), bend[i](j), second);
  }
  RCO_CHECK_LESS_EQUAL((hessian - hessian.transpose()).norm(), 1e-12 * hessian.norm());

  Vector_4 g, g_plain;
  Matrix_4 projected, projected_plain;
  const double value = density.projected_derivatives(J, g, projected);
  RCO_CHECK_NEAR(value, density.value(J), 1e-12 * std::abs(value));
  RCO_CHECK_LESS_EQUAL((g - gradient).norm(), 1e-12 * gradient.norm());
  const Matrix_4 expected = eigen_projection(hessian);
  RCO_CHECK_LESS_EQUAL((projected - expected).norm(), 1e-10 * hessian.norm());
  const Eigen::SelfAdjointEigenSolver<Matrix_4> solver(projected);
  RCO_CHECK_LESS_EQUAL(-1e-12 * hessian.norm(), solver.eigenvalues().minCoeff());

  const Plain_density<Density> plain{density};
  const double plain_value = internal::projected_derivatives(plain, J, g_plain, projected_plain, 0);
  RCO_CHECK_NEAR(plain_value, value, 1e-12 * std::abs(value));
  RCO_CHECK_LESS_EQUAL((g_plain - gradient).norm(), 1e-12 * gradient.norm());
  RCO_CHECK_LESS_EQUAL((projected_plain - expected).norm(), 1e-10 * hessian.norm());
}

template <typename Density>
void test_general(const Density& density)
{
  Random random(1);
  for(int i = 0; i < 300; ++i)
  {
    Matrix_2 J;
    J << random(-2, 2), random(-2, 2), random(-2, 2), random(-2, 2);
    const double value = density.value(J);
    RCO_CHECK(std::isfinite(value));
    const Matrix_2 turned = rotation(random(0, 7)) * J * rotation(random(0, 7));
    RCO_CHECK_NEAR(density.value(turned), value, 1e-9 * std::abs(value));
  }
  // nothing becomes infinite: no area, no extent, inverted, large and small
  const double sizes[] = {0, 1e-40, 1e-9, 1, 1e9};
  for(const double a : sizes)
    for(const double b : {-1., -1e-9, 0., 1e-9, 1.})
    {
      const Matrix_2 J = with_singular_values(a, a * b, random);
      Vector_4 g;
      Matrix_4 h;
      RCO_CHECK(std::isfinite(density.value(J)));
      RCO_CHECK(density.gradient(J).allFinite());
      RCO_CHECK(density.hessian(J).allFinite());
      RCO_CHECK(std::isfinite(density.projected_derivatives(J, g, h)));
      RCO_CHECK(g.allFinite() && h.allFinite());
    }
  // inversion costs more than any valid shape
  for(const double s : {0.5, 0.2, 0.01})
    RCO_CHECK_LESS(density.value(with_singular_values(1, s, random)),
                   density.value(with_singular_values(1, -s, random)));
}

// value, gradient and Hessian do not jump where J crosses `at`
template <typename Density>
void test_smooth_at(const Density& density, const Matrix_2& at, const Matrix_2& direction)
{
  const double h = 1e-9;
  const Matrix_2 below = at - h * direction, above = at + h * direction;
  const Matrix_2 g = density.gradient(at);
  RCO_CHECK_NEAR(density.value(below), density.value(above), 4 * h * g.norm());
  RCO_CHECK_LESS_EQUAL((density.gradient(below) - density.gradient(above)).norm(), 1e-5 * g.norm());
  const Matrix_4 H = density.hessian(at);
  RCO_CHECK_LESS_EQUAL((density.hessian(below) - density.hessian(above)).norm(), 1e-5 * H.norm());
}

void test_exponential_mips(double k)
{
  const Scope scope("Exponential_MIPS_density, k = " + std::to_string(k));
  const RCO::Exponential_MIPS_density density(k);
  RCO_CHECK_EQUAL(density.exponent_factor(), k);
  Random random(2);
  for(const double t : {1., 1 - 1e-7, 0.9, 0.5, 0.3, 0.2, 0.1, 0.04, 0.02, 0.01, 1e-4, 0., -0.01,
                        -0.1, -0.5, -0.9, -1.})
    for(int i = 0; i < 4; ++i)
    {
      const double size = random(0.2, 3);
      const Scope at("singular values " + std::to_string(size) + ", " + std::to_string(t * size));
      test_derivatives_at(density, with_singular_values(size, t * size, random), 1e-4 * size);
    }
  for(int i = 0; i < 20; ++i)
  {
    const double size = random(1e-3, 1e3);
    const Matrix_2 similarity = with_singular_values(size, size, random);
    RCO_CHECK_NEAR(density.value(similarity), std::exp(2 * k), 1e-12 * std::exp(2 * k));
    RCO_CHECK_LESS_EQUAL(size * density.gradient(similarity).norm(), 1e-7 * std::exp(2 * k));
    const double t = random(-1, 1);
    const Matrix_2 J = with_singular_values(1, t, random);
    RCO_CHECK_LESS_EQUAL(std::exp(2 * k) * (1 - 1e-12), density.value(J));
    RCO_CHECK_NEAR(density.value(size * J), density.value(J), 1e-9 * density.value(J));
    if(J.squaredNorm() / J.determinant() * k < 2 * k + 18 && J.determinant() > 0)
      RCO_CHECK_NEAR(density.value(J), std::exp(k * J.squaredNorm() / J.determinant()),
                     1e-9 * density.value(J));
  }
  // the cap: t + 1/t = (2k + 18) / k
  const double ratio = (2 * k + 18) / k;
  const double t = 2 / (ratio + std::sqrt(ratio * ratio - 4));
  const Matrix_2 at = Vector_2(1, t).asDiagonal();
  RCO_CHECK_NEAR(density.value(at), std::exp(2 * k + 18), 1e-9 * std::exp(2 * k + 18));
  test_smooth_at(density, at, Vector_2(0, 1).asDiagonal());
  // beyond the cap it grows, but slower than the exponential
  const Matrix_2 beyond = Vector_2(1, 0.25 * t).asDiagonal();
  RCO_CHECK_LESS(density.value(at), density.value(beyond));
  RCO_CHECK_LESS(std::log(density.value(beyond)), k * (0.25 * t + 4 / t));
  test_general(density);
}

void test_symmetric_dirichlet()
{
  const RCO::Symmetric_Dirichlet_density density;
  Random random(3);
  for(const double s : {1., 1 - 1e-7, 0.8, 0.3, 0.1, 0.03, 0.015, 0.001, 0., -0.01, -0.1, -0.9})
    for(const double size : {0.01, 0.5, 1., 2.})
    {
      // a mirror image is a ridge of this density, and the threshold a jump of third derivatives
      const Scope at("singular values " + std::to_string(size) + ", " + std::to_string(s * size));
      const double gap = (std::min)(std::abs(size - 0.02), std::abs(s * size - 0.02));
      const double h =
        1e-3 * (std::min)((std::max)(gap, 1e-4), (std::max)(std::abs(s * size), 0.02));
      test_derivatives_at(density, with_singular_values(size, s * size, random), h);
    }
  for(int i = 0; i < 20; ++i)
  {
    RCO_CHECK_NEAR(density.value(rotation(i)), 4., 1e-12);
    RCO_CHECK_LESS_EQUAL(density.gradient(rotation(i)).norm(), 1e-12);
    Matrix_2 J = with_singular_values(random(0.1, 3), random(0.1, 3), random);
    RCO_CHECK_NEAR(density.value(J), J.squaredNorm() + J.inverse().squaredNorm(),
                   1e-9 * density.value(J));
    RCO_CHECK_NEAR(density.value(J), density.value(J.inverse()), 1e-9 * density.value(J));
  }
  for(const double other : {0.5, 1., 3.})
    test_smooth_at(density, Vector_2(other, 0.02).asDiagonal(), Vector_2(0, 1).asDiagonal());
  test_general(density);
}

void test_drift_barrier()
{
  const internal::Drift_barrier barrier(3);
  for(const double bound : {0.01, 1., 7.})
  {
    double last = 0;
    for(double part = 0.01; part < 4; part += 0.0371)
    {
      const double r = part * bound, h = 1e-5 * bound;
      const internal::Drift_barrier::Derivatives d = barrier.derivatives(r, bound),
                                                 low = barrier.derivatives(r - h, bound),
                                                 high = barrier.derivatives(r + h, bound);
      RCO_CHECK_NEAR(d.value, barrier.value(r, bound), 1e-12 * d.value);
      RCO_CHECK_EQUAL(d.value > 0, internal::Drift_barrier::is_active(r, bound));
      RCO_CHECK_NEAR(d.first, (high.value - low.value) / (2 * h), 1e-4 * (d.first + 1 / bound));
      RCO_CHECK_NEAR(d.second, (high.first - low.first) / (2 * h),
                     1e-2 * (d.second + 1 / (bound * bound)));
      RCO_CHECK(d.value >= last && d.second >= 0);
      last = d.value;
    }
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
    const auto slope =
      differences(J, h, [&](const Matrix_2& K) { return barrier.value(element, K); });
    for(int k = 0; k < 4; ++k)
      RCO_CHECK_NEAR(gradient(k), slope[k], 1e-5 * gradient.norm() + 1e-14 * value / h);
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

// The derivatives of a stencil are compared with differences of its value, along the frames.
void test_stencil_derivatives()
{
  Random random(4);
  const Shape s = scrambled(plane_grid(8, 8, 0.125), 0.2, 5, onto_plane);
  const internal::Mesh_copy copy = copy_of(s);
  const Straight_rows rows{9, 9};
  const RCO::Energy_context context(copy.mesh.face_begin, copy.mesh.corner_vertex,
                                    copy.points.size(), 0.125, 1, 1);
  const internal::Frame frame(copy);
  const internal::Stencil_set stencils(rows, context, frame);
  RCO_CHECK_EQUAL(stencils.size(), 9 * 4);
  const double h = 1e-5;
  for(int i = 0; i < stencils.size(); ++i)
  {
    internal::Stencil_points points;
    for(int k = 0; k < 6; ++k)
      points[k] = frame(copy.points[stencils[i].vertices[k]]) + random.in_cube(0.01);
    internal::Stencil_gradient gradient;
    internal::Stencil_hessian hessian;
    const double value = stencils.projected_derivatives(i, points, gradient, hessian);
    RCO_CHECK_NEAR(value, stencils.value(i, points), 1e-12 * value);
    for(int c = 0; c < 18; ++c)
    {
      internal::Stencil_points low = points, high = points;
      low[c / 3](c % 3) -= h;
      high[c / 3](c % 3) += h;
      RCO_CHECK_NEAR(gradient(c), (stencils.value(i, high) - stencils.value(i, low)) / (2 * h),
                     1e-6 * gradient.norm());
      internal::Stencil_gradient g_low, g_high;
      internal::Stencil_hessian unused;
      stencils.projected_derivatives(i, low, g_low, unused);
      stencils.projected_derivatives(i, high, g_high, unused);
      // it is quadratic and convex: nothing is projected
      RCO_CHECK_LESS((hessian.col(c) - (g_high - g_low) / (2 * h)).norm(), 1e-3 * hessian.norm());
    }
  }
}

int main()
{
  for(const double k : {0.5, 1., 4.})
    test_exponential_mips(k);
  run_test("Symmetric_Dirichlet_density", test_symmetric_dirichlet);
  run_test("drift barrier", test_drift_barrier);
  for(const double steepness : {6, 12, 30})
  {
    test_barrier("exponential MIPS", RCO::Exponential_MIPS_density(1), steepness);
    test_barrier("symmetric Dirichlet", RCO::Symmetric_Dirichlet_density(), steepness);
  }
  run_test("stencil derivatives", test_stencil_derivatives);
  return report();
}
