// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_DRIFT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_DRIFT_H

#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds the distances of samples of one surface from another, in units of length of the points.
 */
struct Directed_drift
{
  double maximum = 0;                ///< largest distance of a sample.
  double root_mean_square = 0;       ///< root mean square over the samples.
  std::size_t number_of_samples = 0; ///< samples taken.
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds the distances between a mesh and its reference in both directions. Distances are in units of length
 * of the points, except where a name starts with `relative`: those are divided by the mean edge length of
 * the reference.
 */
struct Drift
{
  Directed_drift mesh_to_reference;      ///< from samples of the mesh to the reference.
  Directed_drift reference_to_mesh;      ///< from samples of the reference to the mesh.
  double reference_mean_edge_length = 0; ///< of the reference, quads split.

  /// the larger of the two maxima.
  double maximum() const
  {
    return (std::max)(mesh_to_reference.maximum, reference_to_mesh.maximum);
  }
  /// the larger of the two root mean squares.
  double root_mean_square() const
  {
    return (std::max)(mesh_to_reference.root_mean_square, reference_to_mesh.root_mean_square);
  }
  /// the larger of the two maxima, in mean edge lengths of the reference.
  double relative_maximum() const { return maximum() / reference_mean_edge_length; }
  /// the larger of the two root mean squares, in mean edge lengths of the reference.
  double relative_root_mean_square() const
  {
    return root_mean_square() / reference_mean_edge_length;
  }
  /// largest distance of a sample of the mesh, in mean edge lengths of the reference.
  double relative_mesh_to_reference() const
  {
    return mesh_to_reference.maximum / reference_mean_edge_length;
  }
  /// largest distance of a sample of the reference, in mean edge lengths of the reference.
  double relative_reference_to_mesh() const
  {
    return reference_to_mesh.maximum / reference_mean_edge_length;
  }
};

namespace internal {

inline Directed_drift directed_drift(const Reference_surface& from, const Reference_surface& to)
{
  const Indexed_mesh& mesh = from.mesh();
  const std::vector<Vector_3>& points = from.points();
  Directed_drift result;
  double largest = 0, sum = 0;
  // The face of the other surface with the same index is likely to be near, and so is the closest face of
  // the sample before.
  const double rounding = 1e-12 * to.diagonal(); // closest points in needles are not more accurate
  Surface_point last;
  const auto sample = [&](const Vector_3& p) {
    last = last.face < 0 ? to.closest(p) : to.closest_near(p, last.face, rounding);
    const double d = (last.position - p).squaredNorm();
    largest = (std::max)(largest, d);
    sum += d;
    ++result.number_of_samples;
  };
  // face by face, and from the middle of each, so that successive samples are close to the same face
  std::vector<char> is_done(points.size(), 0);
  for(int f = 0; f < mesh.number_of_faces(); ++f)
  {
    const Vector_3 corner[3] = {from.corner_point(f, 0), from.corner_point(f, 1),
                                from.corner_point(f, 2)};
    const Vector_3 sum_of_corners = corner[0] + corner[1] + corner[2];
    const Vector_3 middle = sum_of_corners / 3;
    if(f < to.mesh().number_of_faces())
    {
      const Surface_point same = to.closest_in_face(middle, f);
      if(last.face < 0 || (same.position - middle).norm() < (last.position - middle).norm())
        last = same;
    }
    sample(middle);
    for(int i = 0; i < 3; ++i)
      sample(0.2 * sum_of_corners + 0.4 * corner[i]);
    for(int i = 0; i < 3; ++i)
    {
      const int c = mesh.face_begin[f] + i, v = mesh.corner_vertex[c];
      if(!is_done[v])
        sample(corner[i]);
      is_done[v] = 1;
      if(mesh.opposite[c] < c)
        sample(0.5 * (corner[i] + corner[(i + 1) % 3]));
    }
  }
  result.maximum = std::sqrt(largest);
  result.root_mean_square = std::sqrt(sum / double(result.number_of_samples));
  return result;
}

inline Drift mutual_drift(const Reference_surface& mesh, const Reference_surface& reference)
{
  Drift result;
  result.mesh_to_reference = directed_drift(mesh, reference);
  result.reference_to_mesh = directed_drift(reference, mesh);
  result.reference_mean_edge_length = reference.mean_edge_length();
  return result;
}

} // namespace internal

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * measures the distance between a mesh and its reference in both directions. Vertices of an optimized mesh
 * are on the reference; its faces need not be.
 *
 * On every triangle of both surfaces (quads are split by their shorter diagonal) these points are
 * sampled: the vertices, the midpoints of the edges, the centroid and the three points with
 * barycentric coordinates (.6, .2, .2); vertices and edges once each. Each sample's distance to the
 * closest point of the other surface is taken. The true Hausdorff distance is at least the maximum;
 * `certified_drift()` bounds it from above. Isolated vertices are skipped.
 *
 * \param mesh the mesh
 * \param reference the reference
 * \param np the parameter `vertex_point_map` of `mesh`
 * \param np_reference the parameter `vertex_point_map` of `reference`
 */
template <typename FaceGraph,
          typename ReferenceMesh,
          typename NamedParameters = parameters::Default_named_parameters,
          typename NamedParametersReference = parameters::Default_named_parameters>
Drift drift(const FaceGraph& mesh,
            const ReferenceMesh& reference,
            const NamedParameters& np = parameters::default_values(),
            const NamedParametersReference& np_reference = parameters::default_values())
{
  const internal::Reference_surface m(internal::read_measured_mesh(mesh, np, "mesh"));
  const internal::Reference_surface r(
    internal::read_measured_mesh(reference, np_reference, "reference"));
  return internal::mutual_drift(m, r);
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_DRIFT_H
