// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READ_PARAMETERS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READ_PARAMETERS_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/Loop_parameters.h>
#include <CGAL/Reference_constrained_optimization/internal/support/text_of.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

template <typename T>
T& unwrap(T& t)
{
  return t;
}
template <typename T>
T& unwrap(std::reference_wrapper<T>& t)
{
  return t.get();
}

inline double checked_positive(double value, const char* name)
{
  if(!(value > 0))
    throw Invalid_input(std::string(name) + " must be positive, but is " + text_of(value));
  return value;
}

// a whole number that is not negative and fits into Integer
template <typename Integer>
Integer checked_count(double value, const char* name)
{
  // the largest value itself may not be representable: it is excluded
  const double end = std::ldexp(1., std::numeric_limits<Integer>::digits);
  if(!(value >= 0) || !(value < end) || value != std::floor(value))
    throw Invalid_input(std::string(name) +
                        " must be a whole number that is not negative, but is " + text_of(value));
  return Integer(value);
}

// The numbers among the named parameters, checked.
template <typename NamedParameters>
Loop_parameters read_loop_parameters(const NamedParameters& np)
{
  using parameters::choose_parameter;
  using parameters::get_parameter;
  Loop_parameters p;
  p.number_of_iterations = checked_count<std::size_t>(
    double(choose_parameter(get_parameter(np, CGAL::internal_np::number_of_iterations),
                            p.number_of_iterations)),
    "number_of_iterations");
  p.random_seed =
    choose_parameter(get_parameter(np, CGAL::internal_np::random_seed), p.random_seed);
  p.maximum_running_time =
    checked_positive(choose_parameter(get_parameter(np, CGAL::internal_np::maximum_running_time),
                                      p.maximum_running_time),
                     "maximum_running_time");
  if constexpr(!parameters::is_default_parameter<NamedParameters,
                                                 internal_np::drift_bound_t>::value)
  {
    p.drift_bound = get_parameter(np, internal_np::drift_bound);
    if(!(p.drift_bound >= 0))
      throw Invalid_input("drift_bound must not be negative, but is " + text_of(p.drift_bound));
  }
  p.energy_tolerance =
    choose_parameter(get_parameter(np, internal_np::energy_tolerance), p.energy_tolerance);
  if(!(p.energy_tolerance >= 0))
    throw Invalid_input("energy_tolerance must not be negative, but is " +
                        text_of(p.energy_tolerance));
  p.use_finishing_stage =
    choose_parameter(get_parameter(np, internal_np::use_finishing_stage), p.use_finishing_stage);
  p.relax_constraints =
    choose_parameter(get_parameter(np, CGAL::internal_np::relax_constraints), p.relax_constraints);
  const bool has_lines =
    !parameters::is_default_parameter<NamedParameters,
                                      CGAL::internal_np::edge_is_constrained_t>::value;
  p.detect_features =
    choose_parameter(get_parameter(np, internal_np::detect_features), p.detect_features) &&
    !has_lines;
  p.allow_creases =
    choose_parameter(get_parameter(np, internal_np::allow_creases), p.allow_creases);
  p.allow_self_intersections = choose_parameter(
    get_parameter(np, CGAL::internal_np::allow_self_intersections), p.allow_self_intersections);
  p.use_on_surface_steps =
    choose_parameter(get_parameter(np, internal_np::use_on_surface_steps), p.use_on_surface_steps);
  p.selection.developability_threshold =
    checked_positive(choose_parameter(get_parameter(np, internal_np::developability_threshold),
                                      p.selection.developability_threshold),
                     "developability_threshold");
  p.selection.maximum_patch_size =
    checked_count<int>(double(choose_parameter(get_parameter(np, internal_np::maximum_patch_size),
                                               p.selection.maximum_patch_size)),
                       "maximum_patch_size");
  return p;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READ_PARAMETERS_H
