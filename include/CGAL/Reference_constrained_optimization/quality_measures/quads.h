// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_QUADS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_QUADS_H

#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds statistics of edge lengths.
 */
struct Edge_statistics
{
  double mean = 0;               ///< mean edge length, in units of length of the points.
  double minimum = 0;            ///< shortest edge over the mean.
  double maximum = 0;            ///< longest edge over the mean.
  double standard_deviation = 0; ///< of length over mean, as a population.
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds statistics of the planarity of quads: the distance between the lines through the two diagonals over
 * the diagonals' mean length, without unit; 0 if the quad is planar.
 */
struct Planarity
{
  double maximum = 0;              ///< largest value.
  double mean = 0;                 ///< mean over the quads.
  std::size_t number_of_quads = 0; ///< quads measured.
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * computes statistics of the edge lengths of a mesh. Every edge counts once.
 *
 * \param mesh the mesh
 * \param np the parameter `vertex_point_map` of `mesh`
 */
template <typename FaceGraph, typename NamedParameters = parameters::Default_named_parameters>
Edge_statistics edge_statistics(const FaceGraph& mesh,
                                const NamedParameters& np = parameters::default_values())
{
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  internal::Moments moments;
  for(int c = 0; c < copy.mesh.number_of_corners(); ++c)
    if(copy.mesh.opposite[c] < c)
      moments.add((copy.points[copy.mesh.source(c)] - copy.points[copy.mesh.target(c)]).norm());
  Edge_statistics result;
  result.mean = moments.mean();
  if(result.mean > 0)
  {
    result.minimum = moments.minimum() / result.mean;
    result.maximum = moments.maximum() / result.mean;
    result.standard_deviation = moments.standard_deviation() / result.mean;
  }
  return result;
}

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * computes how far the quads of a mesh are from being planar. Triangles are skipped.
 *
 * \param mesh the mesh
 * \param np the parameter `vertex_point_map` of `mesh`
 */
template <typename FaceGraph, typename NamedParameters = parameters::Default_named_parameters>
Planarity planarity(const FaceGraph& mesh, const NamedParameters& np = parameters::default_values())
{
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  internal::Moments moments;
  for(int f = 0; f < copy.mesh.number_of_faces(); ++f)
  {
    if(copy.mesh.degree(f) != 4)
      continue;
    const auto point = [&](int i) -> const internal::Vector_3& {
      return copy.points[copy.mesh.corner_vertex[copy.mesh.face_begin[f] + i]];
    };
    const internal::Vector_3 a = point(2) - point(0), b = point(3) - point(1);
    const internal::Vector_3 normal = a.cross(b);
    // four points in a plane if the diagonals are parallel
    const double length = normal.norm(), diagonals = 0.5 * (a.norm() + b.norm());
    moments.add(length > 0 ? std::abs(normal.dot(point(1) - point(0))) / (length * diagonals) : 0);
  }
  Planarity result;
  result.maximum = (std::max)(0., moments.maximum());
  result.mean = moments.mean();
  result.number_of_quads = moments.count();
  return result;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_QUADS_H
