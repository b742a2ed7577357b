// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ENERGY_STENCIL_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ENERGY_STENCIL_H

#include <array>
#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is one term of an energy that depends on the positions in space of some vertices, anywhere in the mesh.
 *
 * \tparam k the number of vertices, 1 to 6
 */
template <int k>
struct Energy_stencil
{
  /// the vertices, each once, by their positions in `vertices(mesh)`.
  std::array<std::size_t, k> vertices;
  /// factor of the value; not negative.
  double weight = 1;
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_ENERGY_STENCIL_H
