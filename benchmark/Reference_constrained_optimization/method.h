#ifndef RCO_BENCHMARK_METHOD_H
#define RCO_BENCHMARK_METHOD_H

// The variants of the method that the drivers compare.

#include <CGAL/Reference_constrained_optimization/internal/rounds/Loop_parameters.h>

#include <limits>
#include <stdexcept>
#include <string>

// whether --check has anything to check; a method without guarantees need not be one of the above
inline bool has_guarantees(const std::string& method)
{
  return method == "ours" || method == "plain";
}

// ours: the library's defaults; plain: without on-surface steps and finishing; paper: as the paper
// describes it. From the paper it differs in these: a face also counts as touched if it was the seed or
// inside two patches, without which an iteration need not end; borders of the mesh are no boundaries of
// patches; densities are finite everywhere; and the run ends when an iteration changes the energy by
// less than the tolerance.
inline void set_method(const std::string& method,
                       CGAL::Reference_constrained_optimization::internal::Loop_parameters& p)
{
  if(method == "ours")
    return;
  p.use_on_surface_steps = false;
  p.use_finishing_stage = false;
  if(method == "plain")
    return;
  if(method != "paper")
    throw std::invalid_argument("there is no method " + method);
  // patches: one after the other, each as large as the proxy lets it grow
  p.halo = (std::numeric_limits<int>::max)();
  p.use_active_set = false;
  p.selection.grows_by_cost = true;
  p.selection.exempt_size = 1;
  if(p.selection.maximum_patch_size == 0)
    p.selection.maximum_patch_size = (std::numeric_limits<int>::max)();
  // A bijection by Tutte's theorem. Such patches are ragged, and unrolled slowly: without the metric
  // of the surface what is left of the distortion spoils the result.
  p.mover.flattening.use_conformal = false;
  p.mover.flattening.use_mean_value = false;
  p.mover.flattening.target_distortion = 4;
  p.mover.flattening.maximum_descent_steps = 500;
  p.mover.flattening.descent_tolerance = 1e-6;
  // the minimum in the plane, and what comes back from it is kept
  p.mover.use_surface_metric = false;
  p.mover.newton_steps = 200;
  p.proposals_per_patch = 1;
  p.accepts_all = true;
  if(p.drift_bound < 0)
    p.drift_bound = std::numeric_limits<double>::infinity();
}

#endif // RCO_BENCHMARK_METHOD_H
