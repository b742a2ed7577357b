#ifndef RCO_BENCHMARK_LIBRARY_CALL_H
#define RCO_BENCHMARK_LIBRARY_CALL_H

// Calls the library with the settings that the drivers have in common.

#include "Monotonicity_visitor.h"
#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/named_parameters.h>
#include <CGAL/reference_constrained_optimize.h>
#include <CGAL/tags.h>

#include <functional>

// Appends the common settings to a list of the package's own parameters, which must come first. To
// what it returns CGAL's can be appended.
template <typename Own_parameters, typename Settings, typename Options>
auto with_common_settings(const Own_parameters& own,
                          const Settings& s,
                          const Options& o,
                          Monotonicity_visitor& visitor)
{
  return own.energy_tolerance(s.tolerance)
    .maximum_patch_size(s.patch_size)
    .use_on_surface_steps(!o.plain)
    .use_finishing_stage(!o.plain)
    .number_of_iterations(s.iterations)
    .random_seed(s.seed)
    .maximum_running_time(s.time_limit)
    .visitor(std::ref(visitor));
}

template <typename Energy, typename Named_parameters>
CGAL::Reference_constrained_optimization::Result optimize(Mesh& mesh,
                                                          const Mesh& reference,
                                                          const Energy& energy,
                                                          const Named_parameters& np,
                                                          [[maybe_unused]] bool parallel)
{
#ifdef CGAL_LINKED_WITH_TBB
  if(parallel)
    return CGAL::reference_constrained_optimize<CGAL::Parallel_tag>(mesh, reference, energy, np);
#endif
  return CGAL::reference_constrained_optimize(mesh, reference, energy, np);
}

#endif // RCO_BENCHMARK_LIBRARY_CALL_H
