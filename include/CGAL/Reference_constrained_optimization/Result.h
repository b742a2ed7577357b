// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_RESULT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_RESULT_H

#include <cstddef>
#include <limits>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is the reason why an optimization ended.
 */
enum class Status {
  converged,       ///< no patch moves any more, or the energy falls by less than the tolerance.
  iteration_limit, ///< `number_of_iterations` outer iterations were made.
  /// `maximum_running_time` ran out; the mesh holds the last accepted state. It is untouched if that was
  /// during setup: energies and counts of defects are then 0.
  time_limit,
  interrupted,  ///< the visitor stopped it; otherwise the same.
  nothing_to_do ///< no vertex is free to move; the mesh is as it was.
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds the wall-clock seconds spent in each step of the algorithm, summed over all patches (and,
 * with `CGAL::Parallel_tag`, over all threads).
 */
struct Stage_times
{
  double setup = 0;        ///< validation, search structure, location of the vertices.
  double selection = 0;    ///< growing of patches, and dividing the mesh into them.
  double flattening = 0;   ///< parameterization of patches.
  double optimization = 0; ///< Newton steps, in the plane and on the surface, and searches.
  double acceptance = 0;   ///< mapping back to the reference and testing there.
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * reports on a call of `CGAL::reference_constrained_optimize()`.
 *
 * Energies are means over the elements of the energy's density, measured on the mesh as its
 * vertices lie on the reference, and always finite: densities are continued beyond their cap.
 * Lengths are in the unit of the points.
 */
struct Result
{
  double initial_energy = 0; ///< mean density before the first step.
  double final_energy = 0;   ///< mean density after the last step.

  std::size_t number_of_iterations = 0; ///< outer iterations made (\f$ N_{out} \f$ in the paper).
  /// patches visited, in all iterations and after them (search, finishing stage); \f$ N_{in} \f$ is this
  /// over `number_of_iterations`.
  std::size_t number_of_patches = 0;
  /// rounds of face-disjoint patches, in all iterations and after them.
  std::size_t number_of_rounds = 0;
  std::size_t number_of_accepted_patches = 0;  ///< patches whose new positions were kept.
  std::size_t number_of_flattened_patches = 0; ///< accepted patches that went through the plane.

  Status status = Status::nothing_to_do; ///< why the optimization ended.

  std::size_t initial_number_of_flips = 0; ///< inverted faces at the start.
  std::size_t number_of_flips = 0;         ///< inverted faces at the end.
  /// edges at the start whose two unit face normals have a dot product below -1/2.
  std::size_t initial_number_of_fold_edges = 0;
  std::size_t number_of_fold_edges = 0; ///< the same at the end.
  /// quads at the start that are not convex as seen along the reference's normals.
  std::size_t initial_number_of_nonconvex_quads = 0;
  std::size_t number_of_nonconvex_quads = 0; ///< the same at the end.

  /// creases at the start: edges whose two face normals are more than 90 degrees apart, but for those that are
  /// constrained or feature edges; the other folded edges are among them.
  std::size_t initial_number_of_creases = 0;
  std::size_t number_of_creases = 0; ///< the same at the end; not more, unless allowed.

  /// pairs of faces at the start that intersect other than in a common vertex or edge; see
  /// `number_of_self_intersecting_pairs()`.
  std::size_t initial_number_of_self_intersections = 0;
  std::size_t number_of_self_intersections = 0; ///< the same at the end; not more, unless allowed.

  /// largest distance of an input vertex to the reference; free vertices are moved onto it.
  double largest_initial_distance = 0;
  std::size_t number_of_free_vertices = 0; ///< vertices that were allowed to move.
  /// edges of the mesh that were detected as feature edges.
  std::size_t number_of_feature_edges = 0;

  /// the drift bound, in units of length of the points, where it is largest: by default it is smaller where
  /// the reference is fine; infinite if it was off.
  double drift_bound = std::numeric_limits<double>::infinity();
  /// the distance between mesh and reference at the start, in units of length: the largest one of the
  /// midpoints of the mesh's edges and faces from the reference, and of the vertices and crease midpoints
  /// of the reference from the mesh. 0 if the drift was not bounded; `drift()` measures it independently of
  /// that, at more samples.
  double initial_drift = 0;
  /// the same at the end, an upper bound for these samples up to rounding.
  double drift = 0;

  std::size_t conformal_flattenings = 0;     ///< flattenings accepted from the fast path (LSCM).
  std::size_t convex_border_flattenings = 0; ///< from the fall-back (convex border, then descent).
  std::size_t overlapping_flattenings = 0; ///< locally injective, but with a self-crossing border.
  std::size_t failed_flattenings =
    0; ///< patches that were skipped because neither path was injective.
  /// sums over flattened patches of the mean symmetric Dirichlet energy of the flattening (4 is
  /// isometric); divided by the number of flattenings it tells how developable the patches are.
  double sum_of_flattening_distortion = 0;
  double sum_of_patch_sizes = 0; ///< sum over patches of their number of faces.

  Stage_times times;       ///< times of the steps.
  double running_time = 0; ///< wall-clock seconds in all.
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_RESULT_H
