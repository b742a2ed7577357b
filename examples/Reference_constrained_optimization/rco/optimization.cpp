#include "optimization.h"

#include "Progress.h"
#include "sharp_edges.h"
#include "soft_landmarks.h"

#include <CGAL/Reference_constrained_optimization/Compatible_remeshing_energy.h>
#include <CGAL/reference_constrained_optimize.h>
#include <CGAL/tags.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/global_control.h>
#endif

namespace {

#ifdef CGAL_LINKED_WITH_TBB
typedef CGAL::Parallel_tag Concurrency_tag; // with one thread the same bits as Sequential_tag
#else
typedef CGAL::Sequential_tag Concurrency_tag;
#endif

template <typename Energy>
RCO::Result optimize(Mesh& mesh,
                     const Mesh& reference,
                     const Energy& energy,
                     double drift_bound,
                     const Options& options)
{
  Progress progress(options);
  const auto call = [&](const auto& own_parameters) {
    const auto np = own_parameters.number_of_iterations(options.number_of_iterations)
                      .random_seed(options.random_seed)
                      .maximum_running_time(options.maximum_running_time)
                      .relax_constraints(options.relax_constraints)
                      .allow_self_intersections(options.allow_self_intersections)
                      .visitor(std::ref(progress));
    if(!(options.sharp_edges < 180))
      return CGAL::reference_constrained_optimize<Concurrency_tag>(mesh, reference, energy, np);
    Sharp_edges sharp(mesh, options.sharp_edges), reference_sharp(reference, options.sharp_edges);
    return CGAL::reference_constrained_optimize<Concurrency_tag>(
      mesh, reference, energy, np.edge_is_constrained_map(sharp.map()),
      CGAL::parameters::edge_is_constrained_map(reference_sharp.map()));
  };
  const auto own = CGAL::parameters::energy_tolerance(options.energy_tolerance)
                     .developability_threshold(options.developability_threshold)
                     .maximum_patch_size(options.maximum_patch_size)
                     .detect_features(options.detects_features)
                     .allow_creases(options.allow_creases)
                     .use_on_surface_steps(options.use_on_surface_steps)
                     .use_finishing_stage(options.use_finishing_stage);
  return drift_bound < 0 ? call(own) : call(own.drift_bound(drift_bound));
}

} // namespace

bool can_use_threads() { return std::is_same<Concurrency_tag, CGAL::Parallel_tag>::value; }

RCO::Result optimize(Mesh& mesh,
                     const Mesh& reference,
                     const Mesh& source,
                     const Landmarks& landmarks,
                     double drift_bound,
                     const Options& options)
{
#ifdef CGAL_LINKED_WITH_TBB
  std::unique_ptr<tbb::global_control> limit;
  if(options.threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  std::size_t(options.threads));
#endif
  switch(options.application)
  {
  case Application::angle:
    return optimize(mesh, reference, RCO::Minimum_angle_energy(options.exponent_factor),
                    drift_bound, options);
  case Application::quad:
    if(options.uses_angle_energy)
      return optimize(mesh, reference, RCO::Quad_angle_energy(), drift_bound, options);
    return optimize(mesh, reference, RCO::Quad_regularity_energy(options.leg_length_factor),
                    drift_bound, options);
  case Application::map:
    return optimize(mesh, reference,
                    RCO::sum(1,
                             RCO::Compatible_remeshing_energy(
                               source, CGAL::parameters::use_equal_areas(options.use_equal_areas)),
                             options.soft_landmarks, Landmark_attraction(landmarks, reference)),
                    drift_bound, options);
  }
  return RCO::Result();
}
