// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_DEFAULT_VISITOR_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_DEFAULT_VISITOR_H

#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * reports on one patch to a visitor. Sums run over the patch's own elements and edges, measured on
 * the reference.
 */
struct Patch_report
{
  std::size_t number_of_faces = 0; ///< faces of the patch.
  double energy_before = 0;        ///< sum of the densities before.
  double energy_after = 0;         ///< sum of the densities after (equal if not accepted).
  std::size_t defects_before = 0;  ///< flips, fold edges and non-convex quads before.
  std::size_t defects_after = 0;   ///< the same after.
  bool accepted = false;           ///< whether the new positions were kept.
  /// whether the patch belongs to the finishing stage. There the energies contain its barrier on angles,
  /// and accepted patches are reverted if the whole pass is not an improvement.
  bool is_finishing = false;
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is the visitor that does nothing, a base class for visitors. A visitor is passed with the named
 * parameter `visitor`, by `std::ref` if it has a state that matters to the caller. All calls come
 * from the calling thread.
 *
 * \cgalModels{ReferenceConstrainedOptimizationVisitor}
 */
struct Default_visitor
{
  /// is called before the outer iteration `iteration` (from 0).
  void on_iteration_begin(std::size_t /* iteration */) {}
  /// is called after it, with the mean density.
  void on_iteration_end(std::size_t /* iteration */, double /* energy */) {}
  /// is called before a round of face-disjoint patches is solved.
  void on_round_begin(std::size_t /* number_of_patches */) {}
  /// is called after it.
  void on_round_end() {}
  /// is called once for every patch of a round, after the decision on it.
  void on_patch_end(const Patch_report& /* report */) {}
  /// is called often, also within patches and during setup; `false` ends the optimization at the last
  /// accepted state.
  bool go_further() { return true; }
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_DEFAULT_VISITOR_H
