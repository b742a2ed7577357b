// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_CERTIFIED_DRIFT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_CERTIFIED_DRIFT_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/triangulated_copy.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>

#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/tags.h>

#include <algorithm>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds bounds on the Hausdorff distances between a mesh and its reference, in units of length of
 * the points.
 */
struct Certified_drift
{
  double mesh_to_reference = 0; ///< estimate of the distance from the mesh to the reference.
  double reference_to_mesh = 0; ///< estimate of the distance from the reference to the mesh.
  double error_bound = 0;       ///< no estimate is further than this from the true distance.

  /// a distance that no point of either surface exceeds.
  double upper_bound() const
  {
    return (std::max)(mesh_to_reference, reference_to_mesh) + error_bound;
  }
  /// a distance that some point of one of the surfaces reaches.
  double lower_bound() const
  {
    return (std::max)(0., (std::max)(mesh_to_reference, reference_to_mesh) - error_bound);
  }
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * bounds the distance between a mesh and its reference, over all points of both surfaces, with
 * `CGAL::Polygon_mesh_processing::bounded_error_Hausdorff_distance()`.
 *
 * In contrast to `drift()`, which measures samples, it gives a guaranteed bound, and takes much longer.
 * This function has a header of its own, which `quality_measures.h` does not include.
 *
 * \param mesh the mesh
 * \param reference the reference
 * \param error_bound the largest error of the estimates, positive, in units of length of the points
 * \param np the parameter `vertex_point_map` of `mesh`
 * \param np_reference the parameter `vertex_point_map` of `reference`
 *
 * \throws Invalid_input if all faces of a mesh are degenerate or `error_bound` is not positive.
 */
template <typename FaceGraph,
          typename ReferenceMesh,
          typename NamedParameters = parameters::Default_named_parameters,
          typename NamedParametersReference = parameters::Default_named_parameters>
Certified_drift
certified_drift(const FaceGraph& mesh,
                const ReferenceMesh& reference,
                double error_bound,
                const NamedParameters& np = parameters::default_values(),
                const NamedParametersReference& np_reference = parameters::default_values())
{
  namespace PMP = Polygon_mesh_processing;
  if(!(error_bound > 0))
    throw Invalid_input("certified_drift: the error bound must be positive");
  const internal::Triangulated_copy m =
    internal::triangulated_copy(internal::read_measured_mesh(mesh, np, "mesh"));
  const internal::Triangulated_copy r =
    internal::triangulated_copy(internal::read_measured_mesh(reference, np_reference, "reference"));
  if(m.is_empty() || r.is_empty())
    throw Invalid_input("certified_drift: all faces of a mesh are degenerate");
  Certified_drift result;
  result.error_bound = error_bound;
  result.mesh_to_reference =
    PMP::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(m, r, error_bound);
  result.reference_to_mesh =
    PMP::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(r, m, error_bound);
  return result;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_CERTIFIED_DRIFT_H
