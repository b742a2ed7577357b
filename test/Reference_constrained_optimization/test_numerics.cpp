// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The factorization, the Newton system, the flip-free step, and Newton's method on problems in the plane.

#include "checks.h"
#include "deformations.h"

#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/Symmetric_Dirichlet_density.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/planar_optimization.h>
#include <CGAL/Reference_constrained_optimization/internal/numerics/Block_LDLT.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/tangent_frame.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <limits>

using namespace rco_test;

typedef Eigen::Matrix4d Matrix_4;
typedef Eigen::Vector4d Vector_4;

template <typename Matrix>
Matrix filled(int rows, int columns, Random& random)
{
  Matrix m(rows, columns);
  for(int i = 0; i < rows * columns; ++i)
    m.data()[i] = random(-1, 1);
  return m;
}

Vector_4 as_vector(const Matrix_2& m) { return Eigen::Map<const Vector_4>(m.data()); }

void test_time_of_collapse()
{
  Random random(4);
  const double infinity = std::numeric_limits<double>::infinity();
  int finite = 0, infinite = 0;
  for(int i = 0; i < 4000; ++i)
  {
    Matrix_2 edges;
    do
      edges = filled<Matrix_2>(2, 2, random);
    while(!(edges.determinant() > 1e-3));
    Matrix_2 motion = filled<Matrix_2>(2, 2, random);
    switch(i % 8)
    {
    case 1: // one corner moves
      motion.col(0).setZero();
      break;
    case 2: // all motions parallel
      motion.row(1) = 0.5 * motion.row(0);
      break;
    case 3: // shrinking to a point
      motion = -random(0.1, 2) * edges;
      break;
    case 4: // growing
      motion = random(0.1, 2) * edges;
      break;
    case 5: // turning about the first corner
      motion = rotation(pi / 2) * edges;
      break;
    case 6:
      motion *= 1e-6;
      break;
    case 7:
      motion *= 1e6;
      break;
    default:
      break;
    }
    const double t = internal::time_of_collapse(edges, motion);
    RCO_CHECK(t > 0);
    const auto det = [&](double s) { return (edges + s * motion).determinant(); };
    if(t < infinity)
    {
      ++finite;
      const double size = (edges + t * motion).squaredNorm() + edges.squaredNorm();
      // a double root is found to half the digits
      RCO_CHECK_LESS_EQUAL(std::abs(det(t)), 1e-9 * size);
    }
    else
      ++infinite;
    const double end = t < infinity ? t * (1 - 1e-6) : 1e4 * edges.norm() / motion.norm();
    for(int s = 0; s < 200; ++s)
    {
      const double part = (s + 1) / 200.;
      const double at = t < infinity ? end * part : end * std::pow(part, 6);
      RCO_CHECK_LESS(0., det(at));
    }
  }
  RCO_CHECK(finite > 500 && infinite > 500);
  const Matrix_2 unit = Matrix_2::Identity(), none = Matrix_2::Zero();
  RCO_CHECK_EQUAL(internal::time_of_collapse(unit, none), infinity);
  Matrix_2 down = none;
  down(1, 1) = -2;
  RCO_CHECK_NEAR(internal::time_of_collapse(unit, down), 0.5, 1e-15);
}

typedef std::vector<std::array<int, 2>> Pairs;

// Adds a random positive definite matrix of the given graph to `factorization`, and returns it. No
// eigenvalue is below `smallest`.
Eigen::SparseMatrix<double>
random_matrix(int n, const Pairs& pairs, double smallest, Random& random, internal::Block_LDLT& f)
{
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int i, int j, const Matrix_2& block) {
    for(int k = 0; k < 4; ++k)
      entries.emplace_back(2 * i + k % 2, 2 * j + k / 2, block.data()[k]);
  };
  const auto add_diagonal = [&](int i, const Matrix_2& block) {
    f.add_diagonal(i, block);
    add(i, i, block);
  };
  f.set_zero();
  for(int i = 0; i < n; ++i)
    add_diagonal(i, smallest * Matrix_2::Identity());
  for(std::size_t k = 0; k < pairs.size(); ++k)
  {
    const int a = pairs[k][0], b = pairs[k][1];
    if(a < 0 || b < 0)
      continue;
    const Eigen::Matrix4d root = filled<Eigen::Matrix4d>(4, 4, random);
    const Eigen::Matrix4d h = root * root.transpose();
    const Matrix_2 side = h.topRightCorner<2, 2>(), turned = side.transpose();
    add_diagonal(a, h.topLeftCorner<2, 2>());
    add_diagonal(b, h.bottomRightCorner<2, 2>());
    if(random() < 0.5)
      f.add(int(k), a, b, side);
    else
      f.add(int(k), b, a, turned);
    add(a, b, side);
    add(b, a, turned);
  }
  Eigen::SparseMatrix<double> matrix(2 * n, 2 * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void test_factorization_of(const std::string& name,
                           int n,
                           const Pairs& pairs,
                           Random& random,
                           internal::Block_LDLT& factorization)
{
  const Scope scope(name + ", " + std::to_string(n) + " vertices");
  factorization.analyze(n, pairs);
  RCO_CHECK_EQUAL(factorization.size(), n);
  Eigen::SparseMatrix<double> identity(2 * n, 2 * n);
  identity.setIdentity();
  for(int repeat = 0; repeat < 2; ++repeat)
  {
    const Eigen::SparseMatrix<double> matrix = random_matrix(n, pairs, 0.1, random, factorization);
    RCO_CHECK_NEAR(factorization.trace(), matrix.diagonal().sum(), 1e-12 * factorization.trace());
    const Eigen::VectorXd right = filled<Eigen::VectorXd>(2 * n, 1, random);
    Eigen::VectorXd solution, again;
    for(const double shift : {0., 2.})
    {
      const Eigen::SparseMatrix<double> shifted = matrix + shift * identity;
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> reference(shifted);
      const Eigen::VectorXd expected = reference.solve(right);
      RCO_CHECK(factorization.factorize(shift));
      factorization.solve(right, solution);
      RCO_CHECK_LESS_EQUAL((shifted * solution - right).norm(), 1e-12 * right.norm());
      RCO_CHECK_LESS_EQUAL((solution - expected).norm(), 1e-10 * expected.norm());
      RCO_CHECK(factorization.factorize(shift));
      again = right;
      factorization.solve(again, again);
      RCO_CHECK(again == solution);
    }
    // just one eigenvalue is negative, or none
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(matrix),
                                                               Eigen::EigenvaluesOnly);
    RCO_CHECK(!factorization.factorize(-1.001 * eigen.eigenvalues()(0)));
    RCO_CHECK(factorization.factorize(-0.999 * eigen.eigenvalues()(0)));
    Matrix_2 block;
    const int v = int(random() * n);
    block << 0, 1e3, 1e3, 0; // positive diagonal entries, negative determinant
    factorization.add_diagonal(v, block);
    RCO_CHECK(!factorization.factorize(0));
    factorization.add_diagonal(v, -block);
    RCO_CHECK(factorization.factorize(0)); // a failure leaves nothing behind
    factorization.solve(right, solution);
    RCO_CHECK_LESS_EQUAL((matrix * solution - right).norm(), 1e-12 * right.norm());
    for(const double bad :
        {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e3})
    {
      Matrix_2 spoilt = Matrix_2::Zero();
      spoilt(repeat, repeat) = bad;
      factorization.add_diagonal(v, spoilt);
      RCO_CHECK(!factorization.factorize(0));
      random_matrix(n, pairs, 0.1, random, factorization);
    }
  }
}

void test_factorization()
{
  Random random(4);
  internal::Block_LDLT factorization; // one for all: nothing of a graph stays for the next
  const auto test = [&](const std::string& name, int n, const Pairs& pairs) {
    test_factorization_of(name, n, pairs, random, factorization);
  };
  test("a vertex", 1, {});
  test("no edge", 5, {{{-1, 2}}, {{3, -1}}});
  test("an edge, thrice", 2, {{{0, 1}}, {{1, 0}}, {{0, 1}}});
  Pairs chain, star, clique, grid;
  for(int i = 0; i < 40; ++i)
  {
    chain.push_back({{(7 * i) % 41, (7 * i + 7) % 41}});
    star.push_back({{i < 20 ? i : i + 1, 20}});
    for(int j = 0; j < i; ++j)
      clique.push_back({{i, j}});
  }
  for(int i = 0; i < 144; ++i)
    for(const int d : {1, 11, 12, 13})
      if(i + d < 144)
        grid.push_back({{i, i + d}});
  test("a chain", 41, chain);
  test("a star", 41, star);
  test("a clique", 40, clique);
  test("a grid", 144, grid);
  for(int trial = 0; trial < 60; ++trial)
  {
    const int n = 2 + int(random() * 60), m = int(random() * random() * 4 * n);
    Pairs pairs;
    for(int i = 0; i < m; ++i)
    {
      const int a = int(random() * n), b = int(random() * n);
      pairs.push_back({{a, a == b ? -1 : b}});
    }
    test("a random graph", n, pairs);
  }
}

void test_newton_system()
{
  Random random(5);
  const Shape grid = plane_grid(5, 4);
  const Indexed_mesh mesh = indexed(grid);
  const int number_of_vertices = int(grid.points.size());
  std::vector<std::array<int, 3>> triples;
  for(const auto& f : grid.faces)
    triples.push_back({{f[0], f[1], f[2]}});
  triples.push_back(triples.front()); // elements may overlap, as those of quads do

  internal::Newton_system system;
  for(int trial = 0; trial < 3; ++trial) // an object is used for patch after patch
  {
    std::vector<int> variable(number_of_vertices, -1);
    int n = 0;
    for(int v = 0; v < number_of_vertices; ++v)
      if(trial == 0 || random() < 0.6)
        variable[v] = n++;
    // numbers in another order than the vertices'
    if(trial == 2)
      for(int& v : variable)
        v = v < 0 ? v : n - 1 - v;
    system.analyze(variable, n, triples);
    for(int repeat = 0; repeat < 2; ++repeat)
    {
      system.set_zero();
      Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(2 * n, 2 * n);
      for(std::size_t e = 0; e < triples.size(); ++e)
      {
        const Eigen::MatrixXd root = filled<Eigen::MatrixXd>(6, 6, random);
        const Eigen::MatrixXd h = root * root.transpose();
        for(int i = 0; i < 3; ++i)
        {
          const int j = (i + 1) % 3, a = variable[triples[e][i]], b = variable[triples[e][j]];
          const Matrix_2 diagonal = h.block<2, 2>(2 * i, 2 * i), side = h.block<2, 2>(2 * i, 2 * j);
          if(a < 0)
            continue;
          system.add_diagonal(a, diagonal);
          dense.block<2, 2>(2 * a, 2 * a) += diagonal;
          if(b < 0)
            continue;
          system.add_side(int(e), i, a, b, side);
          dense.block<2, 2>(2 * a, 2 * b) += side;
          dense.block<2, 2>(2 * b, 2 * a) += side.transpose();
        }
      }
      const Eigen::VectorXd right = filled<Eigen::VectorXd>(2 * n, 1, random);
      Eigen::VectorXd solution;
      RCO_CHECK(system.solve(right, solution));
      const Eigen::VectorXd expected = dense.fullPivLu().solve(right);
      RCO_CHECK_LESS_EQUAL((solution - expected).norm(), 1e-5 * expected.norm());
      RCO_CHECK_LESS_EQUAL((dense * solution - right).norm(), 1e-5 * right.norm());
    }
  }
  // a free vertex that nothing holds does not spoil the others
  system.analyze({0, 1, 2, 3}, 4, {{{0, 1, 2}}});
  system.set_zero();
  for(int i = 0; i < 3; ++i)
    system.add_diagonal(i, 2 * Matrix_2::Identity());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(8), solution;
  right.head<6>().setConstant(1);
  RCO_CHECK(system.solve(right, solution));
  RCO_CHECK_LESS_EQUAL((solution.head<6>() - 0.5 * right.head<6>()).norm(), 1e-6);
  RCO_CHECK_LESS_EQUAL(solution.tail<2>().norm(), 1e-6);
}

// triangles of a flat shape, whose rest shapes are equilateral
internal::Planar_problem planar_problem(const Shape& shape, double edge)
{
  internal::Planar_problem problem;
  Matrix_2 rest;
  rest << edge, 0.5 * edge, 0, 0.5 * std::sqrt(3.) * edge;
  for(const auto& f : shape.faces)
  {
    problem.triples.push_back({{f[0], f[1], f[2]}});
    problem.rest_inverse.push_back(rest.inverse());
    problem.metric.push_back(Matrix_2::Identity());
  }
  const Indexed_mesh mesh = indexed(shape);
  for(const char border : mesh.is_border_vertex)
    problem.is_free.push_back(!border);
  return problem;
}

Matrix_2 jacobian(const internal::Planar_problem& p, std::size_t e, const std::vector<Vector_2>& u)
{
  return p.metric[e] * internal::Planar_problem::edges(u, p.triples[e]) * p.rest_inverse[e];
}

template <typename Density>
double
energy_of(const internal::Planar_problem& p, const Density& density, const std::vector<Vector_2>& u)
{
  double sum = 0;
  for(std::size_t e = 0; e < p.triples.size(); ++e)
    sum += density.value(jacobian(p, e, u));
  return sum;
}

int number_inverted(const internal::Planar_problem& p, const std::vector<Vector_2>& u)
{
  int count = 0;
  for(const auto& t : p.triples)
    count += !(internal::Planar_problem::edges(u, t).determinant() > 0);
  return count;
}

// A scrambled regular grid in a fixed border becomes regular again; seen through a linear map by
// the metric, too.
template <typename Density>
void test_known_optimum(const Density& density, double best, const Matrix_2& map)
{
  const Shape regular = equilateral_grid(9, 8);
  const Shape start = scrambled(regular, 0.35, 6, onto_plane);
  internal::Planar_problem problem = planar_problem(regular, 1);
  const auto mapped = [&](std::vector<Vector_2> points) {
    for(Vector_2& p : points)
      p = map * p;
    return points;
  };
  const std::vector<Vector_2> before = mapped(planar_points(start)),
                              goal = mapped(planar_points(regular));
  std::vector<Vector_2> u = before;
  for(Matrix_2& m : problem.metric)
    m = map.inverse();
  internal::Projected_newton optimizer;
  optimizer.analyze(problem);
  double energy = energy_of(problem, density, u);
  for(int step = 0; step < 60; ++step)
  {
    const auto outcome = optimizer.minimize(problem, density, u, 1, 1e-14);
    const double now = energy_of(problem, density, u);
    RCO_CHECK_NEAR(outcome.initial_energy, energy, 1e-9 * energy);
    RCO_CHECK_NEAR(outcome.final_energy, now, 1e-9 * now);
    RCO_CHECK_LESS_EQUAL(now, energy);
    RCO_CHECK_EQUAL(number_inverted(problem, u), 0);
    energy = now;
    if(outcome.steps == 0)
      break;
  }
  RCO_CHECK_NEAR(energy / double(problem.triples.size()), best, 1e-7 * best);
  for(std::size_t v = 0; v < u.size(); ++v)
  {
    RCO_CHECK_LESS((u[v] - goal[v]).norm(), 1e-4);
    if(!problem.is_free[v])
      RCO_CHECK(u[v] == before[v]);
  }
  // the same in one call
  u = before;
  const auto outcome = optimizer.minimize(problem, density, u, 60, 1e-14);
  RCO_CHECK(outcome.steps > 2);
  RCO_CHECK_NEAR(outcome.final_energy, energy, 1e-6 * energy);
}

// samples all over a patch; the barrier is active at those of edges and faces and at some of R's vertices
internal::Patch_samples drifting_samples(const internal::Patch& patch, Random& random)
{
  internal::Patch_samples result;
  result.barrier = internal::Drift_barrier(0.02);
  result.bound = 0.3;
  const int n = patch.polygons.number_of_faces();
  result.samples.resize(4 * n);
  for(int s = 0; s < 4 * n; ++s)
    if(internal::sample_of(patch, s / 4, s % 4) == s)
    {
      result.samples[s].distance = random(0, 0.36);
      result.samples[s].bound = result.bound;
      result.samples[s].direction = random.in_cube(1).normalized();
    }
  for(int f = 0; f < n; f += 2)
  {
    internal::Patch_samples::Projected_sample projected_sample{f, f, random(0, 0.36), 0.3};
    projected_sample.triangle = f;
    projected_sample.barycentric = Vector_3(0.2, 0.5, 0.3);
    projected_sample.direction = random.in_cube(1).normalized();
    result.projected_samples.push_back(projected_sample);
  }
  return result;
}

// the energy, with the barrier, as the optimizer sees it
template <typename Density>
double energy_with_drift(const internal::Planar_problem& problem,
                         const Density& density,
                         std::vector<Vector_2> u)
{
  internal::Projected_newton optimizer;
  optimizer.analyze(problem);
  return optimizer.minimize(problem, density, u, 0, 0).initial_energy;
}

// One Newton step against the same step written down densely: elements' projected Hessians and
// gradients by the chain rule, with the derivatives of the Jacobian by differences (it is linear);
// with a drift barrier in every second trial.
template <typename Density>
void test_newton_step(const Density& density)
{
  Random random(7);
  const Shape regular = equilateral_grid(4, 4);
  for(int trial = 0; trial < 10; ++trial)
  {
    const Shape start = scrambled(regular, 0.2 + 0.02 * trial, 8 + trial, onto_plane);
    internal::Planar_problem problem = planar_problem(regular, 1);
    for(Matrix_2& m : problem.metric)
      m = with_singular_values(random(0.8, 1.2), random(0.8, 1.2), random);
    for(Matrix_2& m : problem.rest_inverse)
      m = m * with_singular_values(random(0.8, 1.2), random(0.8, 1.2), random);
    const std::vector<Vector_2> u = planar_points(start);

    std::vector<int> variable(u.size(), -1);
    int n = 0;
    for(std::size_t v = 0; v < u.size(); ++v)
      if(problem.is_free[v])
        variable[v] = n++;
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(2 * n);
    for(std::size_t e = 0; e < problem.triples.size(); ++e)
    {
      Vector_4 g;
      Matrix_4 h;
      density.projected_derivatives(jacobian(problem, e, u), g, h);
      Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(4, 2 * n);
      for(const int v : problem.triples[e])
        for(int d = 0; d < 2 && variable[v] >= 0; ++d)
        {
          std::vector<Vector_2> w(u);
          w[v](d) += 1;
          chain.col(2 * variable[v] + d) =
            as_vector(jacobian(problem, e, w) - jacobian(problem, e, u));
        }
      gradient += chain.transpose() * g;
      hessian += chain.transpose() * h * chain;
    }
    if(trial % 2 == 1)
    {
      internal::Patch patch;
      patch.polygons = indexed(regular);
      patch.is_free = problem.is_free;
      const internal::Patch_samples samples = drifting_samples(patch, random);
      problem.start = u; // elsewhere than where the step begins
      for(Vector_2& p : problem.start)
        p += 0.1 * Vector_2(random(-1, 1), random(-1, 1));
      std::vector<internal::Tangent_frame> motions(u.size());
      for(internal::Tangent_frame& m : motions)
        for(int i = 0; i < 6; ++i)
          m(i / 2, i % 2) = random(-0.05, 0.05);
      problem.term_triangles = internal::drift_term_triangles(patch, samples);
      problem.drift.collect(patch, samples, [&](int v) { return motions[v]; });
      RCO_CHECK(problem.drift.terms().size() > 10);
      const auto add = [&](const int* corners, const Vector_3& barycentric, double distance,
                           double bound, const Vector_3& direction) {
        if(!internal::Drift_barrier::is_active(distance, bound))
          return;
        Eigen::VectorXd row = Eigen::VectorXd::Zero(2 * n);
        double r = distance;
        for(int k = 0; k < 3; ++k)
        {
          const Vector_2 slope = barycentric(k) * motions[corners[k]].transpose() * direction;
          r += slope.dot(u[corners[k]] - problem.start[corners[k]]);
          if(variable[corners[k]] >= 0)
            row.segment<2>(2 * variable[corners[k]]) = slope;
        }
        const auto d = samples.barrier.derivatives(r, bound);
        gradient += d.first * row;
        hessian += d.second * row * row.transpose();
      };
      for(int s = 0; s < int(samples.samples.size()); ++s)
        add(&patch.polygons.corner_vertex[s / 4 * 3], internal::sample_barycentric(s % 4),
            samples.samples[s].distance, samples.bound, samples.samples[s].direction);
      for(const internal::Patch_samples::Projected_sample& g : samples.projected_samples)
        add(&patch.polygons.corner_vertex[3 * g.triangle], g.barycentric, g.distance, g.bound,
            g.direction);
    }
    // the assembled gradient itself, by differences of the energy
    for(int v = 0; v < int(u.size()); ++v)
      for(int d = 0; d < 2 && variable[v] >= 0; ++d)
      {
        std::vector<Vector_2> low(u), high(u);
        low[v](d) -= 1e-6;
        high[v](d) += 1e-6;
        const double slope =
          (energy_with_drift(problem, density, high) - energy_with_drift(problem, density, low)) /
          2e-6;
        RCO_CHECK_NEAR(gradient(2 * variable[v] + d), slope, 1e-4 * (1 + gradient.norm()));
      }
    const Eigen::VectorXd expected = -hessian.ldlt().solve(gradient);

    std::vector<Vector_2> moved(u);
    internal::Projected_newton optimizer;
    optimizer.analyze(problem);
    const auto outcome = optimizer.minimize(problem, density, moved, 1, 1e-14);
    RCO_CHECK_EQUAL(outcome.steps, 1);
    Eigen::VectorXd step(2 * n);
    for(std::size_t v = 0; v < u.size(); ++v)
      if(variable[v] >= 0)
        step.segment<2>(2 * variable[v]) = moved[v] - u[v];
    // the length may be cut, the direction not
    const double part = step.dot(expected) / expected.squaredNorm();
    RCO_CHECK(part > 1e-3 && part < 1 + 1e-6);
    RCO_CHECK_LESS_EQUAL((step - part * expected).norm(), 1e-5 * step.norm());
  }
}

// a vertex beyond the far side of its ring: the robust continuation brings it back
template <typename Density>
void test_untangling(const Density& density)
{
  const Shape regular = equilateral_grid(5, 5);
  const internal::Planar_problem problem = planar_problem(regular, 1);
  std::vector<Vector_2> u = planar_points(regular);
  const std::vector<Vector_2> goal = u;
  u[14] += Vector_2(1.3, 0.4);
  RCO_CHECK_LESS(0, number_inverted(problem, u));
  const double before = energy_of(problem, density, u);
  internal::Projected_newton optimizer;
  optimizer.analyze(problem);
  for(int step = 0; step < 100; ++step)
    optimizer.minimize(problem, density, u, 1, 1e-14);
  RCO_CHECK_LESS(energy_of(problem, density, u), before);
  RCO_CHECK_EQUAL(number_inverted(problem, u), 0);
  RCO_CHECK_LESS((u[14] - goal[14]).norm(), 1e-3);
}

template <typename Density>
void test_planar_optimizer(const Density& density, double best, const std::string& name)
{
  const Scope scope("Projected_newton, " + name);
  test_known_optimum(density, best, Matrix_2::Identity());
  Matrix_2 map;
  map << 1.5, 0.4, -0.2, 0.7;
  test_known_optimum(density, best, map);
  test_newton_step(density);
  test_untangling(density);
  // nothing is free, nothing moves
  internal::Planar_problem problem = planar_problem(equilateral_grid(2, 2), 1);
  problem.is_free.assign(problem.is_free.size(), 0);
  std::vector<Vector_2> u = planar_points(equilateral_grid(2, 2));
  const std::vector<Vector_2> before = u;
  internal::Projected_newton optimizer;
  optimizer.analyze(problem);
  RCO_CHECK_EQUAL(optimizer.minimize(problem, density, u, 10, 1e-9).steps, 0);
  RCO_CHECK(u == before);
}

int main()
{
  run_test("time_of_collapse", test_time_of_collapse);
  run_test("Block_LDLT", test_factorization);
  run_test("Newton_system", test_newton_system);
  test_planar_optimizer(RCO::Exponential_MIPS_density(1), std::exp(2.), "exponential MIPS, k = 1");
  test_planar_optimizer(RCO::Exponential_MIPS_density(0.5), std::exp(1.),
                        "exponential MIPS, k = 0.5");
  test_planar_optimizer(RCO::Symmetric_Dirichlet_density(), 4, "symmetric Dirichlet");
  return report();
}
