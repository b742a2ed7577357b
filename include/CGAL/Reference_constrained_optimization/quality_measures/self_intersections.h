// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_SELF_INTERSECTIONS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_SELF_INTERSECTIONS_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/triangulated_copy.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>

#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <boost/iterator/function_output_iterator.hpp>

#include <cstddef>
#include <utility>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * counts the pairs of faces that intersect other than in a common vertex or edge, as
 * `CGAL::Polygon_mesh_processing::self_intersections()` reports them.
 *
 * Quads are split by their shorter diagonal into triangles, and pairs of triangles are counted.
 * Triangles without area are left out.
 *
 * \param mesh the mesh
 * \param np the parameter `vertex_point_map` of `mesh`
 */
template <typename FaceGraph, typename NamedParameters = parameters::Default_named_parameters>
std::size_t
number_of_self_intersecting_pairs(const FaceGraph& mesh,
                                  const NamedParameters& np = parameters::default_values())
{
  const internal::Triangulated_copy triangles =
    internal::triangulated_copy(internal::read_measured_mesh(mesh, np, "mesh"));
  typedef internal::Triangulated_copy::Face_index Face;
  std::size_t count = 0;
  Polygon_mesh_processing::self_intersections(
    triangles,
    boost::make_function_output_iterator([&](const std::pair<Face, Face>&) { ++count; }));
  return count;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_SELF_INTERSECTIONS_H
