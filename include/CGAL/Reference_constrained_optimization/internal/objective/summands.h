// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_SUMMANDS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_SUMMANDS_H

#include <CGAL/Reference_constrained_optimization/Energy_element.h>
#include <CGAL/Reference_constrained_optimization/Sum_energy.h>

#include <cstddef>
#include <tuple>
#include <type_traits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The terms of an energy: elements, stencils, or both.
template <typename Energy, typename = void>
struct Has_stencils : std::false_type
{};
template <typename Energy>
struct Has_stencils<Energy, std::void_t<decltype(Energy::stencil_size)>> : std::true_type
{};

template <typename Energy, typename = void>
struct Has_elements : std::bool_constant<!Has_stencils<Energy>::value>
{};
template <typename Energy>
struct Has_elements<Energy, std::void_t<typename Energy::Density>> : std::true_type
{};

// calls visit(energy, weight) for every summand, in order
template <typename Energy, typename Visit>
void for_each_summand(const Energy& energy, double weight, const Visit& visit)
{
  visit(energy, weight);
}
template <typename... Energy, typename Visit>
void for_each_summand(const Sum_energy<Energy...>& sum, double weight, const Visit& visit)
{
  std::size_t i = 0;
  std::apply(
    [&](const auto&... energies) {
      (for_each_summand(energies, weight * sum.weights()[i++], visit), ...);
    },
    sum.energies());
}

// the criterion for the worst elements of an energy
template <typename Energy, typename = void>
struct Criterion_of
{
  static constexpr Element_criterion value = Element_criterion::none;
};
template <typename Energy>
struct Criterion_of<Energy, std::void_t<decltype(Energy::element_criterion)>>
{
  static constexpr Element_criterion value = Energy::element_criterion;
};
// of a sum: that of a summand that has one
template <typename Energy>
Element_criterion criterion_of(const Energy& energy)
{
  Element_criterion result = Element_criterion::none;
  for_each_summand(energy, 1, [&](const auto& summand, double weight) {
    const Element_criterion criterion = Criterion_of<std::decay_t<decltype(summand)>>::value;
    if(weight > 0 && criterion != Element_criterion::none)
      result = criterion;
  });
  return result;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_SUMMANDS_H
