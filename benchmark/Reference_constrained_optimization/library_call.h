#ifndef RCO_BENCHMARK_LIBRARY_CALL_H
#define RCO_BENCHMARK_LIBRARY_CALL_H

// Calls the library with the settings that the drivers have in common.

#include "Monotonicity_visitor.h"
#include "meshes.h"
#include "method.h"
#include "settings.h"

#include <CGAL/Reference_constrained_optimization/internal/optimize.h>
#include <CGAL/Reference_constrained_optimization/internal/read_parameters.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>
#include <CGAL/tags.h>

#include <functional>
#include <string>

// Appends the common settings to a list of the package's own parameters, which must come first. To
// what it returns CGAL's can be appended.
template <typename Own_parameters, typename Visitor>
auto with_common_settings(const Own_parameters& own, const Common_settings& s, Visitor& visitor)
{
  return own.energy_tolerance(s.tolerance)
    .maximum_patch_size(s.patch_size)
    .number_of_iterations(s.iterations)
    .random_seed(s.seed)
    .maximum_running_time(s.time_limit)
    .visitor(std::ref(visitor));
}

// as the public function does, but for what the method turns off
template <typename Energy, typename Named_parameters>
CGAL::Reference_constrained_optimization::Result optimize(Mesh& mesh,
                                                          const Mesh& reference,
                                                          const Energy& energy,
                                                          const Named_parameters& np,
                                                          const std::string& method,
                                                          [[maybe_unused]] bool parallel)
{
  namespace internal = CGAL::Reference_constrained_optimization::internal;
  internal::Loop_parameters p = internal::read_loop_parameters(internal::cgal_parameters(np));
  set_method(method, p);
  const auto np_reference = CGAL::parameters::default_values();
#ifdef CGAL_LINKED_WITH_TBB
  if(parallel)
    return internal::optimize<CGAL::Parallel_tag>(mesh, reference, energy, p, np, np_reference);
#endif
  return internal::optimize<CGAL::Sequential_tag>(mesh, reference, energy, p, np, np_reference);
}

#endif // RCO_BENCHMARK_LIBRARY_CALL_H
