// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_COMPATIBILITY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_COMPATIBILITY_H

// The one place for differences between CGAL 5.5 and 6.x.

#include <CGAL/config.h>
#include <CGAL/version.h>

#ifndef CGAL_EIGEN3_ENABLED
#error                                                                                             \
  "Reference_constrained_optimization needs Eigen: define CGAL_EIGEN3_ENABLED (CMake: link CGAL::Eigen3_support)"
#endif

#include <CGAL/AABB_tree.h>
#if CGAL_VERSION_NR >= 1060000000
#include <CGAL/AABB_segment_primitive_3.h>
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_triangle_primitive_3.h>
#else
#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_triangle_primitive.h>
#endif
#if CGAL_VERSION_NR >= 1060200000
#include <CGAL/boost/graph/border.h>
#else
#include <CGAL/Polygon_mesh_processing/border.h>
#endif

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

#if CGAL_VERSION_NR >= 1060000000
template <typename Kernel, typename Primitive>
using Primitive_tree = CGAL::AABB_tree<CGAL::AABB_traits_3<Kernel, Primitive>>;
template <typename Kernel, typename Iterator>
using Triangle_tree = Primitive_tree<Kernel, CGAL::AABB_triangle_primitive_3<Kernel, Iterator>>;
template <typename Kernel, typename Iterator>
using Segment_tree = Primitive_tree<Kernel, CGAL::AABB_segment_primitive_3<Kernel, Iterator>>;
#else
template <typename Kernel, typename Primitive>
using Primitive_tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
template <typename Kernel, typename Iterator>
using Triangle_tree = Primitive_tree<Kernel, CGAL::AABB_triangle_primitive<Kernel, Iterator>>;
template <typename Kernel, typename Iterator>
using Segment_tree = Primitive_tree<Kernel, CGAL::AABB_segment_primitive<Kernel, Iterator>>;
#endif

#if CGAL_VERSION_NR >= 1060200000
using CGAL::extract_boundary_cycles;
#else
using CGAL::Polygon_mesh_processing::extract_boundary_cycles;
#endif

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_COMPATIBILITY_H
