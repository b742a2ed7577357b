// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_NAMED_PARAMETERS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_NAMED_PARAMETERS_H

#include <CGAL/Named_function_parameters.h>

#include <type_traits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal_np {

enum developability_threshold_t { developability_threshold };
enum energy_tolerance_t { energy_tolerance };
enum drift_bound_t { drift_bound };
enum use_on_surface_steps_t { use_on_surface_steps };
enum use_finishing_stage_t { use_finishing_stage };
enum vertex_location_map_t { vertex_location_map };
enum maximum_patch_size_t { maximum_patch_size };
enum use_equal_areas_t { use_equal_areas };
enum detect_features_t { detect_features };
enum allow_creases_t { allow_creases };

} // namespace internal_np

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is a list of named parameters to which this package's own parameters can be appended.
 *
 * Own parameters come first in a chain, CGAL's after:
 * `developability_threshold(0.1).drift_bound(0.2).number_of_iterations(5)`.
 */
template <typename T, typename Tag, typename Base = CGAL::internal_np::No_property>
struct Named_parameters : public CGAL::Named_function_parameters<T, Tag, Base>
{
  /// the CGAL list it extends.
  typedef CGAL::Named_function_parameters<T, Tag, Base> Cgal_parameters;

  /// constructs a list of one parameter.
  explicit Named_parameters(const T& v) : Cgal_parameters(v) {}
  /// appends a parameter to a list.
  Named_parameters(const T& v, const Base& base) : Cgal_parameters(v, base) {}

#define CGAL_RCO_ADD_NAMED_PARAMETER(NAME)                                                         \
  template <typename K>                                                                            \
  Named_parameters<K, internal_np::NAME##_t, Cgal_parameters> NAME(const K& k) const               \
  {                                                                                                \
    return Named_parameters<K, internal_np::NAME##_t, Cgal_parameters>(k, *this);                  \
  }
  /// appends the parameter of the same name: see `CGAL::parameters::developability_threshold()`.
  CGAL_RCO_ADD_NAMED_PARAMETER(developability_threshold)
  /// appends the parameter of the same name: see `CGAL::parameters::energy_tolerance()`.
  CGAL_RCO_ADD_NAMED_PARAMETER(energy_tolerance)
  /// appends the parameter of the same name: see `CGAL::parameters::drift_bound()`.
  CGAL_RCO_ADD_NAMED_PARAMETER(drift_bound)
  /// appends the parameter of the same name: see `CGAL::parameters::use_on_surface_steps()`.
  CGAL_RCO_ADD_NAMED_PARAMETER(use_on_surface_steps)
  /// appends the parameter of the same name: see `CGAL::parameters::use_finishing_stage()`.
  CGAL_RCO_ADD_NAMED_PARAMETER(use_finishing_stage)
  /// appends the parameter of the same name: see `CGAL::parameters::vertex_location_map()`.
  CGAL_RCO_ADD_NAMED_PARAMETER(vertex_location_map)
  /// appends the parameter of the same name: see `CGAL::parameters::maximum_patch_size()`.
  CGAL_RCO_ADD_NAMED_PARAMETER(maximum_patch_size)
  /// appends the parameter of the same name: see `CGAL::parameters::use_equal_areas()`.
  CGAL_RCO_ADD_NAMED_PARAMETER(use_equal_areas)
  /// appends the parameter of the same name: see `CGAL::parameters::detect_features()`.
  CGAL_RCO_ADD_NAMED_PARAMETER(detect_features)
  /// appends the parameter of the same name: see `CGAL::parameters::allow_creases()`.
  CGAL_RCO_ADD_NAMED_PARAMETER(allow_creases)
#undef CGAL_RCO_ADD_NAMED_PARAMETER
};

namespace internal {

// A list of this package derives from several lists of CGAL, so that template deduction in CGAL's look-up
// functions is ambiguous: this returns the outermost.
template <typename T, typename Tag, typename Base>
const CGAL::Named_function_parameters<T, Tag, Base>&
cgal_parameters(const Named_parameters<T, Tag, Base>& np)
{
  return np;
}

template <typename T, typename Tag, typename Base>
const CGAL::Named_function_parameters<T, Tag, Base>&
cgal_parameters(const CGAL::Named_function_parameters<T, Tag, Base>& np)
{
  return np;
}

} // namespace internal
} // namespace Reference_constrained_optimization

namespace parameters {

#define CGAL_RCO_ADD_NAMED_PARAMETER(NAME)                                                         \
  template <typename K>                                                                            \
  Reference_constrained_optimization::Named_parameters<                                            \
    K, Reference_constrained_optimization::internal_np::NAME##_t>                                  \
  NAME(const K& k)                                                                                 \
  {                                                                                                \
    return Reference_constrained_optimization::Named_parameters<                                   \
      K, Reference_constrained_optimization::internal_np::NAME##_t>(k);                            \
  }
/// \addtogroup PkgReferenceConstrainedOptimizationRef
/// @{

/// starts a list with \f$ \epsilon_d \f$, the largest cost of a face in a patch's cone proxy.
CGAL_RCO_ADD_NAMED_PARAMETER(developability_threshold)
/// starts a list with the relative decrease of the energy below which the optimization stops.
CGAL_RCO_ADD_NAMED_PARAMETER(energy_tolerance)
/// starts a list with the largest distance between mesh and reference, a length.
CGAL_RCO_ADD_NAMED_PARAMETER(drift_bound)
/// starts a list with whether patches are optimized directly on the reference.
CGAL_RCO_ADD_NAMED_PARAMETER(use_on_surface_steps)
/// starts a list with whether a last stage raises the smallest angles.
CGAL_RCO_ADD_NAMED_PARAMETER(use_finishing_stage)
/// starts a list with a property map that receives every vertex' location on the reference.
CGAL_RCO_ADD_NAMED_PARAMETER(vertex_location_map)
/// starts a list with the largest number of faces of a patch.
CGAL_RCO_ADD_NAMED_PARAMETER(maximum_patch_size)
/// starts a list with whether a compatible mesh's source is scaled to the area of the reference.
CGAL_RCO_ADD_NAMED_PARAMETER(use_equal_areas)
/// starts a list with whether feature lines are detected and kept.
CGAL_RCO_ADD_NAMED_PARAMETER(detect_features)
/// starts a list with whether edges may be folded by more than 90 degrees that are not on input.
CGAL_RCO_ADD_NAMED_PARAMETER(allow_creases)
/// @}
#undef CGAL_RCO_ADD_NAMED_PARAMETER

} // namespace parameters
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_NAMED_PARAMETERS_H
