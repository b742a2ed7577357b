// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_PROJECTED_NEWTON_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_PROJECTED_NEWTON_H

#include <CGAL/Reference_constrained_optimization/internal/numerics/Newton_system.h>
#include <CGAL/Reference_constrained_optimization/internal/numerics/flip_free_step.h>
#include <CGAL/Reference_constrained_optimization/internal/numerics/projected_derivatives.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Projected Newton descent on a sum of densities over triangles whose shapes are affine in two
// coordinates per vertex: positive semi-definite element Hessians, no step beyond the collapse of a
// triangle, Armijo's rule.
//
// A problem has `triples` (elements), `rest_inverse`, `is_free` (per vertex), `shape(e, u)`, the edge
// matrix of element e for coordinates u, and `corner_map(e, i)`, the matrix by which the i-th vertex
// of element e moves when its coordinates do; `elements` gives value and derivatives of an element, by its
// number or as a density for all. The energy contains the terms `drift`, a Drift_terms, in triangles of the
// vertices `term_triangles`, and `stencils`, a Stencil_terms; both for the displacement of vertices from
// `origin(v)`.
class Projected_newton
{
public:
  // may be interrupted between its steps, and within them
  explicit Projected_newton(Interruption* interruption = nullptr) : m_interruption(interruption) {}

  struct Outcome
  {
    int steps = 0;
    double initial_energy = 0, final_energy = 0;
    // the decrease that the quadratic model predicts for the undamped first step
    double predicted_decrease = 0;
  };

  // numbers the unknowns of a problem and factorizes its pattern; `minimize` may then be called any
  // number of times for problems with the same triples and free vertices
  template <typename Problem>
  void analyze(const Problem& problem)
  {
    m_variable.assign(problem.is_free.size(), -1);
    m_size = 0;
    for(std::size_t i = 0; i < problem.is_free.size(); ++i)
      if(problem.is_free[i])
        m_variable[i] = m_size++;
    m_triples = problem.triples;
    m_first_term_triangle = 0;
    if(problem.term_triangles != problem.triples) // which then need no entries of their own
    {
      m_first_term_triangle = int(m_triples.size());
      m_triples.insert(m_triples.end(), problem.term_triangles.begin(),
                       problem.term_triangles.end());
    }
    std::vector<std::array<int, 2>> pairs;
    m_first_pair.clear();
    for(const auto& term : problem.stencils.terms())
    {
      m_first_pair.push_back(int(pairs.size()));
      for(int i = 0; i < term.size; ++i)
        for(int j = 0; j < i; ++j)
          pairs.push_back({{variable(term.vertices[i]), variable(term.vertices[j])}});
    }
    if(m_size > 0)
      m_system.analyze(m_variable, m_size, m_triples, pairs);
    m_rhs.resize(2 * m_size);
  }

  // Adds to the Hessian of every element this multiple of its trace, on the diagonal. Energies that are
  // invariant to scale have directions of small curvature, along which a step would be far too long; this
  // regularization penalizes strain only, so that neighbours may still move a long way together.
  void set_strain_regularization(double factor) { m_strain_regularization = factor; }

  // `u` is changed in place. Stops after `maximum_steps`, or when the predicted decrease is less than
  // `tolerance` times the energy that all elements would have with the density of the best: a few that
  // cannot be improved may dominate the sum.
  template <typename Problem, typename Elements>
  Outcome minimize(const Problem& problem,
                   const Elements& elements,
                   std::vector<Vector_2>& u,
                   int maximum_steps,
                   double tolerance)
  {
    Outcome outcome;
    if(m_size == 0)
      return outcome;

    check(m_interruption);
    double energy = assemble(problem, elements, u);
    outcome.initial_energy = outcome.final_energy = energy;
    std::vector<Vector_2> moved(u);
    for(int step = 0; step < maximum_steps; ++step)
    {
      check(m_interruption);
      if(!m_system.solve(m_rhs, m_direction, m_interruption))
        break;
      check(m_interruption);
      if(step == 0)
        outcome.predicted_decrease = 0.5 * m_rhs.dot(m_direction);
      const bool is_safe = damp(problem, u);
      const double decrease = m_rhs.dot(m_direction);
      if(!(decrease > tolerance * m_scale))
        break;

      double t = is_safe ? 1 : (std::min)(1., 0.9 * largest_flip_free_step(problem, u));
      double trial = 0;
      bool found = false;
      for(int halving = 0; halving < 20 && !found; ++halving)
      {
        for(std::size_t i = 0; i < u.size(); ++i)
          if(m_variable[i] >= 0)
            moved[i] = u[i] + t * m_direction.segment<2>(2 * m_variable[i]);
        check(m_interruption);
        trial = value(problem, elements, moved);
        found = trial <= energy - 1e-4 * t * decrease;
        if(!found)
          t *= 0.5;
      }
      if(!found)
        break;
      const double actual_decrease = energy - trial;
      u = moved;
      energy = outcome.final_energy = trial;
      ++outcome.steps;
      if(step + 1 == maximum_steps || actual_decrease < tolerance * m_scale)
        break;
      check(m_interruption);
      assemble(problem, elements, u);
    }
    return outcome;
  }

private:
  template <typename Problem, typename Elements>
  static double
  value(const Problem& problem, const Elements& elements, const std::vector<Vector_2>& u)
  {
    double sum = 0;
    for(std::size_t e = 0; e < problem.triples.size(); ++e)
      sum += value_of(elements, e, problem.shape(e, u) * problem.rest_inverse[e], 0);
    for(const auto& term : problem.drift.terms())
      sum += problem.drift.barrier().value(distance(problem, term, u), term.bound);
    for(const auto& term : problem.stencils.terms())
      sum += problem.stencils.value(term, displacement(problem, u));
    return sum;
  }

  // negative beyond the other surface, where the barrier is zero
  template <typename Problem, typename Term>
  static double distance(const Problem& problem, const Term& term, const std::vector<Vector_2>& u)
  {
    const std::array<int, 3>& t = problem.term_triangles[term.triangle];
    double d = term.distance;
    for(int k = 0; k < 3; ++k)
      d += term.rows[k].dot(u[t[k]] - problem.origin(t[k]));
    return d;
  }

  template <typename Problem>
  static auto displacement(const Problem& problem, const std::vector<Vector_2>& u)
  {
    return [&](int v) { return Vector_2(u[v] - problem.origin(v)); };
  }

  int variable(int v) const { return v < 0 ? -1 : m_variable[v]; }

  // matrix and right-hand side (the negative gradient) at u; returns the energy
  template <typename Problem, typename Elements>
  double assemble(const Problem& problem, const Elements& elements, const std::vector<Vector_2>& u)
  {
    m_system.set_zero();
    m_rhs.setZero();
    double sum = 0, least = std::numeric_limits<double>::infinity();
    const auto add = [&](double value) {
      sum += value;
      least = (std::min)(least, std::abs(value));
    };
    Eigen::Vector4d gradient;
    Eigen::Matrix4d hessian;
    Eigen::Matrix<double, 4, 2> motion[3];
    for(std::size_t e = 0; e < problem.triples.size(); ++e)
    {
      const std::array<int, 3>& t = problem.triples[e];
      const Eigen::Matrix2d& rest = problem.rest_inverse[e];
      const Eigen::Matrix2d J = problem.shape(e, u) * rest;
      const int variable[3] = {m_variable[t[0]], m_variable[t[1]], m_variable[t[2]]};
      if(variable[0] < 0 && variable[1] < 0 && variable[2] < 0)
      {
        add(value_of(elements, e, J, 0));
        continue;
      }
      add(derivatives_of(elements, e, J, gradient, hessian, 0));
      hessian.diagonal().array() += m_strain_regularization * hessian.trace();

      // dJ = corner_map * du_i * w_i^T, with w_i the rows that belong to vertex i: `motion`
      // in the entries of J
      const double w[3][2] = {{-rest(0, 0) - rest(1, 0), -rest(0, 1) - rest(1, 1)},
                              {rest(0, 0), rest(0, 1)},
                              {rest(1, 0), rest(1, 1)}};
      for(int i = 0; i < 3; ++i)
      {
        const Eigen::Matrix2d& map = problem.corner_map(e, i);
        motion[i].topRows<2>() = w[i][0] * map;
        motion[i].bottomRows<2>() = w[i][1] * map;
      }
      for(int j = 0; j < 3; ++j)
      {
        const int b = variable[j], i = (j + 2) % 3, a = variable[i];
        if(b < 0)
          continue;
        m_rhs.segment<2>(2 * b) -= motion[j].transpose() * gradient;
        const Eigen::Matrix<double, 4, 2> hessian_motion = hessian * motion[j];
        m_system.add_diagonal(b, motion[j].transpose() * hessian_motion);
        if(a >= 0)
          m_system.add_side(int(e), i, a, b, motion[i].transpose() * hessian_motion);
      }
    }
    m_scale = least * double(problem.triples.size());
    return sum + add_drift(problem, u) + add_stencils(problem, u);
  }

  // returns the energy
  template <typename Problem>
  double add_stencils(const Problem& problem, const std::vector<Vector_2>& u)
  {
    double sum = 0;
    typedef std::decay_t<decltype(problem.stencils)> Stencils;
    typename Stencils::Gradient gradient;
    typename Stencils::Hessian hessian;
    for(std::size_t s = 0; s < problem.stencils.terms().size(); ++s)
    {
      const auto& term = problem.stencils.terms()[s];
      sum += problem.stencils.derivatives(term, displacement(problem, u), gradient, hessian);
      int pair = m_first_pair[s];
      for(int i = 0; i < term.size; ++i)
      {
        const int a = variable(term.vertices[i]);
        if(a >= 0)
        {
          m_rhs.segment<2>(2 * a) -= gradient.template segment<2>(2 * i);
          m_system.add_diagonal(a, hessian.template block<2, 2>(2 * i, 2 * i));
        }
        for(int j = 0; j < i; ++j, ++pair)
        {
          const int b = variable(term.vertices[j]);
          if(a >= 0 && b >= 0)
            m_system.add_pair(pair, a, b, hessian.template block<2, 2>(2 * i, 2 * j));
        }
      }
    }
    return sum;
  }

  // Gauss and Newton's Hessian; returns the energy
  template <typename Problem>
  double add_drift(const Problem& problem, const std::vector<Vector_2>& u)
  {
    double sum = 0;
    for(const auto& term : problem.drift.terms())
    {
      const auto d = problem.drift.barrier().derivatives(distance(problem, term, u), term.bound);
      sum += d.value;
      const std::array<int, 3>& t = problem.term_triangles[term.triangle];
      for(int j = 0; j < 3; ++j)
      {
        const int i = (j + 2) % 3, a = m_variable[t[i]], b = m_variable[t[j]];
        if(b < 0)
          continue;
        m_rhs.segment<2>(2 * b) -= d.first * term.rows[j];
        m_system.add_diagonal(b, d.second * term.rows[j] * term.rows[j].transpose());
        if(a >= 0)
          m_system.add_side(m_first_term_triangle + term.triangle, i, a, b,
                            d.second * term.rows[i] * term.rows[j].transpose());
      }
    }
    return sum;
  }

  // Damps the motion of the vertices of elements that would collapse, so that the step length is not
  // determined by a few elements, unless little of the descent would remain. Returns whether no element
  // collapses in a full step.
  template <typename Problem>
  bool damp(const Problem& problem, const std::vector<Vector_2>& u)
  {
    m_undamped = m_direction;
    bool is_safe = false;
    const int maximum_passes = 3; // unequal damping may make others collapse
    for(int pass = 0; pass < maximum_passes && !is_safe; ++pass)
    {
      m_damping.assign(m_size, 1.);
      is_safe = true;
      for_each_collapse(problem, u, [&](std::size_t e, double time) {
        const double factor = 0.9 * time;
        if(!(factor < 1))
          return;
        is_safe = false;
        for(const int v : problem.triples[e])
          if(m_variable[v] >= 0)
            m_damping[m_variable[v]] = (std::min)(m_damping[m_variable[v]], factor);
      });
      if(!is_safe)
        for(int i = 0; i < m_size; ++i)
          m_direction.segment<2>(2 * i) *= m_damping[i];
    }
    if(m_rhs.dot(m_direction) > 0.1 * m_rhs.dot(m_undamped))
      return is_safe;
    m_direction = m_undamped;
    return false;
  }

  template <typename Problem>
  double largest_flip_free_step(const Problem& problem, const std::vector<Vector_2>& u) const
  {
    double step = std::numeric_limits<double>::infinity();
    for_each_collapse(problem, u, [&](std::size_t, double time) { step = (std::min)(step, time); });
    return step;
  }

  // calls visit(e, t) with the fraction t of the motion at which element e collapses
  template <typename Problem, typename Visit>
  void for_each_collapse(const Problem& problem,
                         const std::vector<Vector_2>& u,
                         const Visit& visit) const
  {
    const auto motion = [&](int v) -> Vector_2 {
      return m_variable[v] < 0 ? Vector_2(Vector_2::Zero())
                               : Vector_2(m_direction.segment<2>(2 * m_variable[v]));
    };
    for(std::size_t e = 0; e < problem.triples.size(); ++e)
    {
      const Eigen::Matrix2d shape = problem.shape(e, u);
      // inverted already, or nearly: the density is finite there, and increases further on
      const double flat = 1e-3;
      const double area = shape.determinant();
      if(!(area > flat * shape.squaredNorm()))
        continue;
      const std::array<int, 3>& t = problem.triples[e];
      const Vector_2 first = problem.corner_map(e, 0) * motion(t[0]);
      Eigen::Matrix2d d;
      d.col(0) = problem.corner_map(e, 1) * motion(t[1]) - first;
      d.col(1) = problem.corner_map(e, 2) * motion(t[2]) - first;
      visit(e, time_of_collapse(shape, d));
    }
  }

  Interruption* m_interruption;
  int m_size = 0;
  // position of the first triangle of the barrier's terms among the triples
  int m_first_term_triangle = 0;
  std::vector<std::array<int, 3>> m_triples; // of the system
  std::vector<int> m_first_pair;             // per stencil
  double m_strain_regularization = 0;
  double m_scale = 0; // of the energy, for tolerances
  Newton_system m_system;
  std::vector<int> m_variable;
  Eigen::VectorXd m_rhs, m_direction, m_undamped;
  std::vector<double> m_damping; // per variable: the factor of its motion
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_PROJECTED_NEWTON_H
