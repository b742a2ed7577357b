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

// Where slivers that nothing can open own the sum, an exponential energy falls at the cost of all the other
// elements. So its exponent starts mild where there are many, and becomes steeper, up to what is asked
// for, once they own no more than a part of the energy. Other densities are left as they are.
template <typename Density>
struct Exponent_continuation
{
  explicit Exponent_continuation(const Density& density) : m_density(density) {}
  const Density& density() const { return m_density; }
  bool is_complete() const { return true; }
  template <typename ConcurrencyTag>
  bool advance(const Optimization_state&)
  {
    return false;
  }

private:
  const Density& m_density;
};

template <>
struct Exponent_continuation<Exponential_MIPS_density>
{
  explicit Exponent_continuation(const Exponential_MIPS_density& density)
    : m_target(density),
      m_density(density.exponent_factor() > mildest ? milder(mildest) : density)
  {}

  const Exponential_MIPS_density& density() const { return m_density; }
  // whether that is the one that is asked for
  bool is_complete() const { return m_density.exponent_factor() == m_target.exponent_factor(); }

  // To the steepest exponent that slivers do not own; false if that is what there is. On mechanical parts
  // a tenth of what is asked for is the steepest: slivers between feature lines can never open.
  template <typename ConcurrencyTag>
  bool advance(const Optimization_state& state)
  {
    const double step = std::sqrt(10.);
    const double rounding = 1e-9;
    const double steepest =
      (state.bounds_turn.empty() ? 1 : 0.1) * (1 - rounding) * m_target.exponent_factor();
    bool advances = false;
    while(m_density.exponent_factor() < steepest)
    {
      const double next = m_density.exponent_factor() * step;
      const Exponential_MIPS_density steeper =
        next > (1 - rounding) * m_target.exponent_factor() ? m_target : milder(next);
      if(imbalance<ConcurrencyTag>(state, steeper) > largest_imbalance)
        break;
      m_density = steeper;
      advances = true;
    }
    return advances;
  }

private:
  static constexpr double mildest = 0.1, largest_imbalance = 20;

  // with the cap at the same shape as that of the exponent factor 1
  static Exponential_MIPS_density milder(double factor)
  {
    return Exponential_MIPS_density(factor, 20 * factor);
  }

  // the mean density of the elements, but for the worst of them, over that of the better half
  template <typename ConcurrencyTag>
  static double imbalance(const Optimization_state& state, const Exponential_MIPS_density& density)
  {
    const auto vertex = [&](int v) -> const Placed_vertex& { return state.vertices[v]; };
    std::vector<double> densities(state.elements.size());
    const double none = -1; // where nothing can move
    for_each_block<ConcurrencyTag>(int(densities.size()), [&](int begin, int end, int) {
      for(int e = begin; e < end; ++e)
      {
        const std::array<int, 3>& v = state.elements[e].vertices;
        const bool is_fixed = !state.is_free[v[0]] && !state.is_free[v[1]] && !state.is_free[v[2]];
        densities[e] = is_fixed ? none : element_energy(density, state.elements[e], vertex);
      }
    });
    densities.erase(std::remove(densities.begin(), densities.end(), none), densities.end());
    if(densities.empty())
      return 1;
    const double trimmed = 0.01;
    const std::size_t half = (densities.size() + 1) / 2;
    const std::size_t most =
      (std::max)(half, std::size_t((1 - trimmed) * double(densities.size())));
    const auto begin = densities.begin();
    std::nth_element(begin, begin + (most - 1), densities.end());
    std::nth_element(begin, begin + (half - 1), begin + most);
    const double half_sum = std::accumulate(begin, begin + half, 0.);
    const double sum = std::accumulate(begin + half, begin + most, half_sum);
    return sum / double(most) / (half_sum / double(half));
  }

  const Exponential_MIPS_density& m_target;
  Exponential_MIPS_density m_density;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_EXPONENT_CONTINUATION_H
