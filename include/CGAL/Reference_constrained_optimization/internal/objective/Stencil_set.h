// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_STENCIL_SET_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_STENCIL_SET_H

#include <CGAL/Reference_constrained_optimization/Energy_stencil.h>
#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/Frame.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/summands.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The largest number of vertices of a stencil, and derivatives by their coordinates.
constexpr int largest_stencil = 6;
typedef std::array<Vector_3, largest_stencil> Stencil_points; // of which the first few are used
typedef Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * largest_stencil, 1> Stencil_gradient;
typedef Eigen::
  Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * largest_stencil, 3 * largest_stencil>
    Stencil_hessian;

// The function of a summand with stencils, with its type erased.
class Stencil_function
{
public:
  virtual ~Stencil_function() = default;
  virtual double value(std::size_t stencil, const Stencil_points& points) const = 0;
  // with positive semi-definite Hessian
  virtual double projected_derivatives(std::size_t stencil,
                                       const Stencil_points& points,
                                       Stencil_gradient& gradient,
                                       Stencil_hessian& hessian) const = 0;
};

// The function of a model of the concept, in the user's coordinates.
template <typename Energy>
class Stencil_function_of : public Stencil_function
{
  static constexpr int k = Energy::stencil_size;
  static_assert(k >= 1 && k <= largest_stencil, "A stencil has 1 to 6 vertices.");
  typedef std::array<Vector_3, std::size_t(k)> Points;
  typedef Eigen::Matrix<double, 3 * k, 1> Gradient;
  typedef Eigen::Matrix<double, 3 * k, 3 * k> Hessian;

public:
  // `step`: the length of finite differences, for energies without derivatives
  Stencil_function_of(const Energy& energy, const Frame& frame, double step)
    : m_energy(energy),
      m_frame(frame),
      m_step(step)
  {}

  double value(std::size_t stencil, const Stencil_points& points) const override
  {
    return m_energy.value(stencil, given(points));
  }

  double projected_derivatives(std::size_t stencil,
                               const Stencil_points& points,
                               Stencil_gradient& gradient,
                               Stencil_hessian& hessian) const override
  {
    Gradient g;
    Hessian h;
    const double value = derivatives(m_energy, stencil, given(points), g, h, 0);
    const double unit = m_frame.unit();
    gradient = unit * g;
    hessian = unit * unit * h;
    return value;
  }

private:
  Points given(const Stencil_points& points) const
  {
    Points result;
    for(int i = 0; i < k; ++i)
      result[i] = m_frame.to_user(points[i]);
    return result;
  }

  template <typename E>
  auto derivatives(const E& energy,
                   std::size_t stencil,
                   const Points& points,
                   Gradient& gradient,
                   Hessian& hessian,
                   int) const
    -> decltype(energy.projected_derivatives(stencil, points, gradient, hessian))
  {
    return energy.projected_derivatives(stencil, points, gradient, hessian);
  }

  // by finite differences, without negative eigenvalues
  template <typename E>
  double derivatives(const E& energy,
                     std::size_t stencil,
                     const Points& points,
                     Gradient& gradient,
                     Hessian& hessian,
                     long) const
  {
    const auto at = [&](int i, double a, int j, double b) {
      Points p = points;
      p[i / 3](i % 3) += a;
      p[j / 3](j % 3) += b;
      return energy.value(stencil, p);
    };
    const double d = m_step;
    for(int i = 0; i < 3 * k; ++i)
    {
      gradient(i) = (at(i, d, i, 0) - at(i, -d, i, 0)) / (2 * d);
      for(int j = 0; j <= i; ++j)
        hessian(i, j) = hessian(j, i) =
          (at(i, d, j, d) - at(i, d, j, -d) - at(i, -d, j, d) + at(i, -d, j, -d)) / (4 * d * d);
    }
    const Eigen::SelfAdjointEigenSolver<Hessian> solver(hessian);
    const Hessian& vectors = solver.eigenvectors();
    hessian = vectors * solver.eigenvalues().cwiseMax(0.).asDiagonal() * vectors.transpose();
    return energy.value(stencil, points);
  }

  const Energy& m_energy;
  Frame m_frame;
  double m_step;
};

// All stencils of an energy on a mesh.
class Stencil_set
{
public:
  struct Stencil
  {
    int function;       // of its summand
    std::size_t number; // in the summand
    double weight;
    int size;
    std::array<int, largest_stencil> vertices;
  };

  Stencil_set() = default;

  // The energy and the frame have to live as long as this.
  template <typename Energy, typename Context>
  Stencil_set(const Energy& energy, const Context& context, const Frame& frame)
  {
    for_each_summand(energy, 1, [&](const auto& summand, double weight) {
      typedef std::decay_t<decltype(summand)> Summand;
      if constexpr(Has_stencils<Summand>::value)
        append(summand, weight, context, frame);
    });
    const std::size_t n = context.number_of_vertices();
    if(m_stencils.empty())
      return;
    m_begin.assign(n + 1, 0);
    for(const Stencil& s : m_stencils)
      for(int i = 0; i < s.size; ++i)
        ++m_begin[s.vertices[i] + 1];
    for(std::size_t v = 0; v < n; ++v)
      m_begin[v + 1] += m_begin[v];
    m_at_vertex.resize(m_begin[n]);
    std::vector<int> next(m_begin.begin(), m_begin.end() - 1);
    for(int s = 0; s < size(); ++s)
      for(int i = 0; i < m_stencils[s].size; ++i)
        m_at_vertex[next[m_stencils[s].vertices[i]]++] = s;
  }

  int size() const { return int(m_stencils.size()); }
  bool empty() const { return m_stencils.empty(); }
  const Stencil& operator[](int s) const { return m_stencils[s]; }

  // calls visit(s) for every stencil at a vertex
  template <typename Visit>
  void for_each_at(int v, const Visit& visit) const
  {
    if(!empty())
      for(int i = m_begin[v]; i < m_begin[v + 1]; ++i)
        visit(m_at_vertex[i]);
  }

  double value(int s, const Stencil_points& points) const
  {
    const Stencil& stencil = m_stencils[s];
    return stencil.weight * m_functions[stencil.function]->value(stencil.number, points);
  }
  double projected_derivatives(int s,
                               const Stencil_points& points,
                               Stencil_gradient& gradient,
                               Stencil_hessian& hessian) const
  {
    const Stencil& stencil = m_stencils[s];
    const double value = m_functions[stencil.function]->projected_derivatives(
      stencil.number, points, gradient, hessian);
    gradient *= stencil.weight;
    hessian *= stencil.weight;
    return stencil.weight * value;
  }

  // for vertices at position(v)
  template <typename PositionAccess>
  double value_at(int s, const PositionAccess& position) const
  {
    Stencil_points points;
    for(int i = 0; i < m_stencils[s].size; ++i)
      points[i] = position(m_stencils[s].vertices[i]);
    return value(s, points);
  }
  // of all
  template <typename PositionAccess>
  double sum_at(const PositionAccess& position) const
  {
    double sum = 0;
    for(int s = 0; s < size(); ++s)
      sum += value_at(s, position);
    return sum;
  }

private:
  template <typename Energy, typename Context>
  void append(const Energy& energy, double weight, const Context& context, const Frame& frame)
  {
    constexpr int k = Energy::stencil_size;
    std::vector<Energy_stencil<k>> stencils;
    energy.append_stencils(context, stencils);
    const double relative_step = 1e-4; // of finite differences, relative to the mean edge length
    m_functions.push_back(std::make_shared<Stencil_function_of<Energy>>(
      energy, frame, relative_step * context.mean_edge_length()));
    for(std::size_t i = 0; i < stencils.size(); ++i)
    {
      const Energy_stencil<k>& s = stencils[i];
      const std::string name = "energy: stencil " + std::to_string(i);
      if(!(s.weight >= 0) || !std::isfinite(s.weight))
        throw Invalid_input(name + " has a weight that is negative or not finite");
      Stencil stencil{int(m_functions.size()) - 1, i, weight * s.weight, k, {}};
      for(int j = 0; j < k; ++j)
      {
        if(s.vertices[j] >= context.number_of_vertices())
          throw Invalid_input(name + " names vertex " + std::to_string(s.vertices[j]) +
                              ", which the mesh does not have");
        stencil.vertices[j] = int(s.vertices[j]);
        if(std::find(stencil.vertices.begin(), stencil.vertices.begin() + j, stencil.vertices[j]) !=
           stencil.vertices.begin() + j)
          throw Invalid_input(name + " names vertex " + std::to_string(s.vertices[j]) + " twice");
      }
      if(stencil.weight > 0)
        m_stencils.push_back(stencil);
    }
  }

  std::vector<std::shared_ptr<const Stencil_function>> m_functions; // one per summand
  std::vector<Stencil> m_stencils;
  std::vector<int> m_begin, m_at_vertex; // per vertex: its stencils
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_STENCIL_SET_H
