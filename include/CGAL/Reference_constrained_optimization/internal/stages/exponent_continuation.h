// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_EXPONENT_CONTINUATION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_EXPONENT_CONTINUATION_H

#include <CGAL/Reference_constrained_optimization/Exponential_MIPS_density.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The exponent factor of a density; 0 if it has none.
template <typename Density>
double exponent_factor(const Density&)
{
  return 0;
}
inline double exponent_factor(const Exponential_MIPS_density& density)
{
  return density.exponent_factor();
}

// Where slivers that cannot be improved dominate the sum, an exponential energy falls at the cost of all
// other elements. So its exponent starts small where there are many, and is increased, up to the requested
// one, once their share of the energy is limited. Other densities are not changed.
template <typename Densities>
class Exponent_continuation
{
public:
  explicit Exponent_continuation(const Densities& densities)
    : m_target(densities),
      m_densities(densities)
  {
    for(int term = 0; term < densities.number_of_terms(); ++term)
      densities.visit(term, [&](const auto& d) {
        m_target_factor = (std::max)(m_target_factor, exponent_factor(d));
      });
    m_factor = (std::min)(smallest_factor, m_target_factor);
    m_densities = with_factor(m_factor);
  }

  const Densities& densities() const { return m_densities; }
  // whether the requested exponent is reached
  bool is_complete() const { return m_factor == m_target_factor; }

  // Increases the exponent to the largest one that slivers do not dominate; false if it is not changed. On
  // mechanical parts the limit is a tenth of the requested exponent: slivers between feature lines can
  // never be improved.
  template <typename ConcurrencyTag>
  bool advance(const Optimization_state& state)
  {
    const double step = std::sqrt(10.);
    const double rounding = 1e-9;
    const double largest_factor =
      (state.bounds_normal_deviation.empty() ? 1 : 0.1) * (1 - rounding) * m_target_factor;
    bool has_advanced = false;
    while(m_factor < largest_factor)
    {
      double next = m_factor * step;
      if(next > (1 - rounding) * m_target_factor)
        next = m_target_factor;
      const Densities candidate = with_factor(next);
      if(imbalance<ConcurrencyTag>(state, candidate) > largest_imbalance)
        break;
      m_factor = next;
      m_densities = candidate;
      has_advanced = true;
    }
    return has_advanced;
  }

private:
  static constexpr double smallest_factor = 0.1, largest_imbalance = 20;

  // with exponent factors up to the given one
  Densities with_factor(double factor) const
  {
    return m_target.transformed([&](const auto& density) { return with_factor(density, factor); });
  }
  template <typename Density>
  static Density with_factor(const Density& density, double)
  {
    return density;
  }
  // with the cap at the same shape as that of the exponent factor 1
  static Exponential_MIPS_density with_factor(const Exponential_MIPS_density& density,
                                              double factor)
  {
    return factor < density.exponent_factor() ? Exponential_MIPS_density(factor, 20 * factor)
                                              : density;
  }

  // the mean density of the elements, without the worst hundredth, over that of the better half
  template <typename ConcurrencyTag>
  static double imbalance(const Optimization_state& state, const Densities& candidate)
  {
    const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
    std::vector<double> densities(state.elements.size());
    const double none = -1; // for fixed elements
    for_each_block<ConcurrencyTag>(int(densities.size()), [&](int begin, int end, int) {
      for(int e = begin; e < end; ++e)
      {
        const std::array<int, 3>& v = state.elements[e].vertices;
        const bool is_fixed = !state.is_free[v[0]] && !state.is_free[v[1]] && !state.is_free[v[2]];
        densities[e] = is_fixed ? none : element_energy(candidate, state.elements[e], vertex);
      }
    });
    densities.erase(std::remove(densities.begin(), densities.end(), none), densities.end());
    if(densities.empty())
      return 1;
    const double trimmed = 0.01;
    const std::size_t half = (densities.size() + 1) / 2;
    const std::size_t trimmed_size =
      (std::max)(half, std::size_t((1 - trimmed) * double(densities.size())));
    const auto begin = densities.begin();
    std::nth_element(begin, begin + (trimmed_size - 1), densities.end());
    std::nth_element(begin, begin + (half - 1), begin + trimmed_size);
    const double half_sum = std::accumulate(begin, begin + half, 0.);
    const double sum = std::accumulate(begin + half, begin + trimmed_size, half_sum);
    return sum / double(trimmed_size) / (half_sum / double(half));
  }

  const Densities& m_target;
  Densities m_densities;
  double m_target_factor = 0, m_factor = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_EXPONENT_CONTINUATION_H
