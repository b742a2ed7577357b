// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INVALID_INPUT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INVALID_INPUT_H

#include <stdexcept>
#include <string>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is thrown when a mesh, a reference, an energy or a parameter cannot be used.
 *
 * The message is a sentence that names the offending element (a vertex or a face, by its position
 * in the range `vertices(g)` or `faces(g)`). The mesh that was to be optimized is untouched.
 */
class Invalid_input : public std::invalid_argument
{
public:
  /// constructs the exception from its message.
  explicit Invalid_input(const std::string& message) : std::invalid_argument(message) {}
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INVALID_INPUT_H
