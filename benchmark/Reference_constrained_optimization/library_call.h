#pragma once

// Calls the library with the settings that the drivers have in common.

#include "paper_pipeline.h"
#include "settings.h"

#include <CGAL/Reference_constrained_optimization/named_parameters.h>
#include <CGAL/reference_constrained_optimize.h>
#include <CGAL/tags.h>

#include <functional>
#include <stdexcept>

// Appends the common settings to a list of the package's own parameters, which must come first. To
// what it returns CGAL's can be appended.
template <typename Own_parameters, typename Visitor>
auto with_common_settings(const Own_parameters& own, const Common_settings& s, Visitor& visitor)
{
  return own.energy_tolerance(s.tolerance)
    .use_on_surface_steps(s.method != "plain")
    .maximum_patch_size(s.patch_size)
    .number_of_iterations(s.iterations)
    .random_seed(s.seed)
    .maximum_running_time(s.time_limit)
    .visitor(std::ref(visitor));
}

// by the public function, or as the paper describes it
template <typename Energy, typename Named_parameters>
RCO::Result optimize(Mesh& mesh,
                     const Mesh& reference,
                     const Energy& energy,
                     const Named_parameters& np,
                     const Common_settings& s)
{
  if(s.method == "paper")
    return paper::optimize(mesh, reference, energy, RCO::internal::cgal_parameters(np));
  if(s.method != "ours" && s.method != "plain")
    throw std::invalid_argument("there is no method " + s.method);
#ifdef CGAL_LINKED_WITH_TBB
  if(s.parallel)
    return CGAL::reference_constrained_optimize<CGAL::Parallel_tag>(mesh, reference, energy, np);
#endif
  return CGAL::reference_constrained_optimize(mesh, reference, energy, np);
}
