// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_SLIDING_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_SLIDING_H

#include <CGAL/Reference_constrained_optimization/internal/state/Patch.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A vertex of a patch after sliding by a length along its line, forward or (if negative) backward; false if
// the line ends before.
inline bool slide(const Patch& patch,
                  int v,
                  double length,
                  const Reference_surface& reference,
                  Located_vertex& result)
{
  result = patch.located[v];
  return patch.lines->advance(result.on_line, length) &&
         locate_on_line(*patch.lines, reference, result);
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_SLIDING_H
