// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_SECONDS_SINCE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_SECONDS_SINCE_H

#include <chrono>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

inline double seconds_since(const std::chrono::steady_clock::time_point& start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_SECONDS_SINCE_H
