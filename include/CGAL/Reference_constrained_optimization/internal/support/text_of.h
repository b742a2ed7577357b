// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_TEXT_OF_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_TEXT_OF_H

#include <sstream>
#include <string>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// a number for a message; small ones keep their digits
inline std::string text_of(double number)
{
  std::ostringstream out;
  out << number;
  return out.str();
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_TEXT_OF_H
