// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_FEATURE_DEVIATION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_FEATURE_DEVIATION_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/dihedral_angles.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/internal/support/compatibility.h>

#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds how well the sharp edges of a mesh are preserved when its vertices are moved. An edge is sharp if
 * its dihedral angle exceeds 40 degrees; it has a counterpart where the other mesh has an edge with a
 * dihedral angle above 20 degrees, no further away than 0.05 local edge lengths.
 */
struct Feature_deviation
{
  /// part of the length of the sharp edges before, from 0 to 1, that has a counterpart after; 1 if there
  /// were no sharp edges.
  double kept = 1;
  /// length of the sharp edges after that have no counterpart before, over the length of the sharp edges
  /// before; over the diagonal of the bounding box before if there were none.
  double added = 0;
  double length_before = 0; ///< length of the sharp edges before, in units of length of the points.
  double length_after = 0;  ///< length of the sharp edges after.
  /// largest distance of a point of the sharp edges before from the edges after with a dihedral angle above
  /// 20 degrees, in units of length; infinite if there are none.
  double before_to_after = 0;
  double after_to_before = 0; ///< the same the other way.
};

namespace internal {

// The edges of a mesh with large dihedral angles, and distances of points from them.
class Feature_lines
{
  typedef CGAL::Simple_cartesian<double> Kernel;
  typedef std::vector<Kernel::Segment_3>::const_iterator Segment_iterator;
  static constexpr double sharp = 40, visible = 20; // degrees

public:
  explicit Feature_lines(const Mesh_copy& copy)
    : m_copy(copy),
      m_dihedral_angles(dihedral_angles(copy.mesh, copy.points)),
      m_local_length(median_edge_lengths())
  {
    for_each_edge(visible, [&](const Vector_3& a, const Vector_3& b, double) {
      m_segments.emplace_back(kernel_point(a), kernel_point(b));
    });
    m_tree.insert(m_segments.cbegin(), m_segments.cend());
    m_tree.build();
    m_tree.accelerate_distance_queries();
  }
  Feature_lines(const Feature_lines&) = delete;
  Feature_lines& operator=(const Feature_lines&) = delete;

  struct Coverage
  {
    double length = 0, covered = 0, largest_distance = 0;
  };

  // the length of the sharp edges along which the other mesh has visible edges
  Coverage covered_by(const Feature_lines& other) const
  {
    Coverage result;
    for_each_edge(sharp, [&](const Vector_3& a, const Vector_3& b, double local_length) {
      const int parts = 8;
      const double length = (b - a).norm() / parts, close = 0.05 * local_length;
      for(int i = 0; i < parts; ++i)
      {
        const double distance = other.distance(a + (i + 0.5) / parts * (b - a));
        result.length += length;
        result.covered += distance <= close ? length : 0;
        result.largest_distance = (std::max)(result.largest_distance, distance);
      }
    });
    return result;
  }

private:
  static Kernel::Point_3 kernel_point(const Vector_3& p)
  {
    return Kernel::Point_3(p.x(), p.y(), p.z());
  }

  double distance(const Vector_3& p) const
  {
    if(m_segments.empty())
      return std::numeric_limits<double>::infinity();
    return std::sqrt(m_tree.squared_distance(kernel_point(p)));
  }

  // visit(a, b, local edge length) for each edge with a dihedral angle above some degrees
  template <typename Visit>
  void for_each_edge(double degrees, const Visit& visit) const
  {
    const Indexed_mesh& mesh = m_copy.mesh;
    for(int c = 0; c < mesh.number_of_corners(); ++c)
      if(mesh.opposite[c] > c && m_dihedral_angles[c] > degrees)
      {
        const int s = mesh.source(c), t = mesh.target(c);
        const Vector_3 &a = m_copy.points[s], &b = m_copy.points[t];
        if(a != b)
          visit(a, b, 0.5 * (m_local_length[s] + m_local_length[t]));
      }
  }

  // per vertex, of the edges at it
  std::vector<double> median_edge_lengths() const
  {
    const Indexed_mesh& mesh = m_copy.mesh;
    std::vector<double> medians(mesh.number_of_vertices(), 0), lengths;
    for(int v = 0; v < mesh.number_of_vertices(); ++v)
    {
      lengths.clear();
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
      {
        const int c = mesh.vertex_corners[k], incoming = mesh.previous(c);
        lengths.push_back((m_copy.points[mesh.target(c)] - m_copy.points[v]).norm());
        if(mesh.opposite[incoming] < 0) // no face has this edge as an outgoing one
          lengths.push_back((m_copy.points[mesh.source(incoming)] - m_copy.points[v]).norm());
      }
      if(lengths.empty())
        continue;
      const auto middle = lengths.begin() + lengths.size() / 2;
      std::nth_element(lengths.begin(), middle, lengths.end());
      medians[v] = *middle;
    }
    return medians;
  }

  const Mesh_copy& m_copy;
  std::vector<double> m_dihedral_angles; // per corner
  std::vector<double> m_local_length;
  std::vector<Kernel::Segment_3> m_segments;
  Segment_tree<Kernel, Segment_iterator> m_tree;
};

} // namespace internal

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * measures which part of the sharp edges of a mesh is preserved in another one, and the length of those
 * that are new. The two need not have the same connectivity.
 *
 * The dihedral angle of an edge is the angle between the normals of its two faces; it is 0 at borders and
 * at faces without area. Edges are sampled at the middles of eight parts of equal length; the local edge
 * length is the mean over the ends of an edge of the median length of the edges there.
 *
 * \tparam FaceGraphBefore a model of `FaceListGraph` and `HalfedgeListGraph`, with triangles or quads
 * \tparam FaceGraphAfter the same
 * \tparam NamedParametersBefore a sequence of \ref bgl_namedparameters "Named Parameters"
 * \tparam NamedParametersAfter the same
 *
 * \param before the mesh as it was
 * \param after the mesh as it is
 * \param np_before the parameter `vertex_point_map` of `before`
 * \param np_after the parameter `vertex_point_map` of `after`
 *
 * \return what is kept, what is added, and how far apart the lines are.
 *
 * \throws Invalid_input as all quality measures
 */
template <typename FaceGraphBefore,
          typename FaceGraphAfter,
          typename NamedParametersBefore = parameters::Default_named_parameters,
          typename NamedParametersAfter = parameters::Default_named_parameters>
Feature_deviation
feature_deviation(const FaceGraphBefore& before,
                  const FaceGraphAfter& after,
                  const NamedParametersBefore& np_before = parameters::default_values(),
                  const NamedParametersAfter& np_after = parameters::default_values())
{
  const internal::Mesh_copy old_copy = internal::read_measured_mesh(before, np_before, "before");
  const internal::Mesh_copy new_copy = internal::read_measured_mesh(after, np_after, "after");
  const internal::Feature_lines old_lines(old_copy), new_lines(new_copy);
  const auto kept = old_lines.covered_by(new_lines), found = new_lines.covered_by(old_lines);
  Feature_deviation result;
  result.length_before = kept.length;
  result.length_after = found.length;
  result.before_to_after = kept.largest_distance;
  result.after_to_before = found.largest_distance;
  if(kept.length > 0)
    result.kept = kept.covered / kept.length;
  const double unit =
    kept.length > 0 ? kept.length : internal::bounding_box_diagonal(old_copy.mesh, old_copy.points);
  if(unit > 0)
    result.added = (found.length - found.covered) / unit;
  return result;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_FEATURE_DEVIATION_H
