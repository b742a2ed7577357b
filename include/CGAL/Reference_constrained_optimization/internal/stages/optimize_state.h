// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_OPTIMIZE_STATE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_OPTIMIZE_STATE_H

#include <CGAL/Reference_constrained_optimization/internal/stages/Finishing_stage.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/Iteration_stage.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/Worst_faces_stage.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/separate_clusters.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Runs the stages one after the other, until one is interrupted.
template <typename Visits>
void run_stages(Visits& visits)
{
  const Loop_parameters& parameters = visits.parameters;
  Global_measure before = visits.initialize();
  Iteration_stage<Visits> iterations(visits);
  visits.result.status = Status::iteration_limit;
  if(visits.has_angle_criterion && parameters.use_on_surface_steps &&
     parameters.number_of_iterations > 0)
  {
    if(!separate_clusters(visits))
      return;
    if(!visits.advance_densities(before))
      before = visits.remeasure();
  }
  if(!iterations.run(before) || !parameters.use_on_surface_steps)
    return;
  const bool finishes = parameters.use_finishing_stage && visits.has_angle_criterion;
  if(Worst_faces_stage<Visits>(visits, finishes).run() && finishes)
    Finishing_stage<Visits>(visits).run();
}

// Optimizes a mesh on its reference; `initial_energy` is its energy. The state holds the accepted patches,
// also after an interruption or if a visitor throws.
template <typename ConcurrencyTag, typename Densities, typename Visitor>
void optimize_state(Optimization_state& state,
                    const Densities& densities,
                    double initial_energy,
                    const Loop_parameters& parameters,
                    Visitor& visitor,
                    Result& result,
                    Interruption& interruption)
{
  Patch_visits<ConcurrencyTag, Densities, Visitor> visits(
    state, densities, initial_energy, parameters, visitor, result, interruption);
  const auto finalize_result = [&]() {
    if(interruption.has_stopped())
      result.status = interruption.status();
    Shape_bound& shape_bound = visits.round_solver.shape_bound();
    if(shape_bound.is_enabled())
      result.drift = shape_bound.template drift<ConcurrencyTag>(state);
  };
  try
  {
    run_stages(visits);
  }
  catch(const Interrupted&)
  {}
  catch(...)
  {
    finalize_result();
    throw;
  }
  finalize_result();
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_OPTIMIZE_STATE_H
