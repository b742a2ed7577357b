// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_SUM_ENERGY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_SUM_ENERGY_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/support/text_of.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>
#include <utility>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is a weighted sum of energies, made by `sum()`.
 *
 * A summand of weight 0 has no effect. Summands may be sums themselves; a sum has the criterion of its
 * summands for worst elements.
 *
 * \tparam Energy models of `ReferenceConstrainedEnergy`
 *
 * \cgalModels{ReferenceConstrainedEnergy}
 */
template <typename... Energy>
class Sum_energy
{
public:
  /// constructs the sum of copies of `energies`. \throws Invalid_input if a weight is negative or not
  /// finite.
  Sum_energy(const std::array<double, sizeof...(Energy)>& weights, const Energy&... energies)
    : m_weights(weights),
      m_energies(energies...)
  {
    for(const double weight : weights)
      if(!(weight >= 0) || !std::isfinite(weight))
        throw Invalid_input("sum: a weight must be finite and not negative, but is " +
                            internal::text_of(weight));
  }

  /// the weights.
  const std::array<double, sizeof...(Energy)>& weights() const { return m_weights; }
  /// the summands.
  const std::tuple<Energy...>& energies() const { return m_energies; }

private:
  std::array<double, sizeof...(Energy)> m_weights;
  std::tuple<Energy...> m_energies;
};

/// \cond SKIP_IN_MANUAL
namespace internal {

template <typename Arguments, std::size_t... i>
auto sum(const Arguments& arguments, std::index_sequence<i...>)
{
  return Sum_energy<std::decay_t<std::tuple_element_t<2 * i + 1, Arguments>>...>(
    {{double(std::get<2 * i>(arguments))...}}, std::get<2 * i + 1>(arguments)...);
}

} // namespace internal
/// \endcond

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * returns the weighted sum `w1 * e1 + w2 * e2 + ...` of energies as a `Sum_energy`.
 *
 * \tparam Arguments numbers and models of `ReferenceConstrainedEnergy` in turn
 * \param arguments `w1, e1, w2, e2, ...`: weights, finite and not negative, without unit, and energies,
 *        which are copied
 * \throws Invalid_input if a weight is negative or not finite
 */
template <typename... Arguments>
auto sum(const Arguments&... arguments)
{
  static_assert(sizeof...(Arguments) > 0 && sizeof...(Arguments) % 2 == 0,
                "sum() takes a weight and an energy for each summand.");
  return internal::sum(std::tie(arguments...),
                       std::make_index_sequence<sizeof...(Arguments) / 2>());
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_SUM_ENERGY_H
