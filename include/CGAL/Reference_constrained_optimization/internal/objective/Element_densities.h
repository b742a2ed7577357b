// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ELEMENT_DENSITIES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ELEMENT_DENSITIES_H

#include <CGAL/Reference_constrained_optimization/internal/numerics/projected_derivatives.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Element_set.h>

#include <Eigen/Core>

#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The densities of an energy's summands: that of an element is one of them, times the element's weight.
template <typename... Density>
class Element_densities
{
public:
  explicit Element_densities(std::tuple<Density...> densities) : m_densities(std::move(densities))
  {}

  double value(const Element_set::Element& element, const Eigen::Matrix2d& J) const
  {
    double result = 0;
    visit(element.term, [&](const auto& density) { result = element.weight * density.value(J); });
    return result;
  }

  // with positive semi-definite Hessian
  double projected_derivatives(const Element_set::Element& element,
                               const Eigen::Matrix2d& J,
                               Eigen::Vector4d& gradient,
                               Eigen::Matrix4d& hessian) const
  {
    if constexpr(sizeof...(Density) != 1) // so that compilers see them initialized
    {
      gradient.setZero();
      hessian.setZero();
    }
    double result = 0;
    visit(element.term, [&](const auto& density) {
      result = element.weight * internal::projected_derivatives(density, J, gradient, hessian, 0);
      gradient *= element.weight;
      hessian *= element.weight;
    });
    return result;
  }

  // calls a function of the density of a summand
  template <typename Visit>
  void visit(int term, const Visit& visit) const
  {
    if constexpr(sizeof...(Density) == 1)
      visit(std::get<0>(m_densities));
    else
    {
      int i = 0;
      std::apply(
        [&](const auto&... densities) { ((i++ == term ? visit(densities) : void()), ...); },
        m_densities);
    }
  }

  // with each density replaced by a function of it
  template <typename Function>
  Element_densities transformed(const Function& function) const
  {
    return Element_densities(std::apply(
      [&](const auto&... densities) { return std::tuple<Density...>(function(densities)...); },
      m_densities));
  }

  static constexpr int number_of_terms() { return int(sizeof...(Density)); }

private:
  std::tuple<Density...> m_densities;
};

// the densities of the summands that have elements, in order
template <typename Energy>
auto tuple_of_densities(const Energy& energy)
{
  if constexpr(Has_elements<Energy>::value)
    return std::make_tuple(energy.density());
  else
    return std::tuple<>();
}
template <typename... Energy>
auto tuple_of_densities(const Sum_energy<Energy...>& sum)
{
  return std::apply(
    [](const auto&... energies) { return std::tuple_cat(tuple_of_densities(energies)...); },
    sum.energies());
}

template <typename... Density>
Element_densities<Density...> make_element_densities(std::tuple<Density...> densities)
{
  return Element_densities<Density...>(std::move(densities));
}
template <typename Energy>
auto element_densities(const Energy& energy)
{
  return make_element_densities(tuple_of_densities(energy));
}

// The elements of a patch by index, for Newton's method.
template <typename Density>
struct Patch_elements
{
  const Density& density;
  const std::vector<Element_set::Element>& elements;

  double value(std::size_t e, const Eigen::Matrix2d& J) const
  {
    return element_value(density, elements[e], J, 0);
  }
  double projected_derivatives(std::size_t e,
                               const Eigen::Matrix2d& J,
                               Eigen::Vector4d& gradient,
                               Eigen::Matrix4d& hessian) const
  {
    return element_derivatives(density, elements[e], J, gradient, hessian, 0);
  }
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ELEMENT_DENSITIES_H
