// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_MAP_STATISTICS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_MAP_STATISTICS_H

#include <CGAL/Reference_constrained_optimization/quality_measures/distortion.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/drift.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/orientation.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds what makes a map between two surfaces good or of no use: its distortion, its defects, and which part
 * of the reference it covers, once or more often.
 */
struct Map_statistics
{
  Distortion_statistics distortion; ///< the source scaled to the area of the reference.
  Orientation_defects defects;      ///< inverted faces and folded edges.
  Drift drift;                      ///< distances both ways.
  /// samples of the reference, four in each triangle.
  std::size_t number_of_samples = 0;
  /// samples that are the closest point of exactly one point of the mesh, whose face is not inverted there.
  std::size_t number_of_samples_hit_once = 0;
  /// samples that are not the closest point of any point of the mesh.
  std::size_t number_of_samples_not_hit = 0;
  /// parts of the area of the reference, from 0 to 1: of the samples that are hit more than once or from an
  /// inverted face, and of those that are not hit.
  double area_hit_more_than_once = 0, area_not_hit = 0;
  /// the largest connected region of triangles of the reference that are further than three of its mean
  /// edges from the mesh, as a part of the area.
  double largest_uncovered_region = 0;
  /// the part of the source's area in faces that shrink to less than a thousandth of their area.
  double collapsed_area = 0;

  /// limits for a map that can be used: of the mean distortion; and of the area that is hit more than once and
  /// of the largest region that is uncovered, as parts of the area of the reference.
  static constexpr double largest_mean_distortion = 100, largest_flawed_area = 0.001;
  /// whether the map can be used: its mean distortion is at most 100, it is injective but for a thousandth
  /// of the reference's area, and no region of more than that is uncovered. A map onto a part of the reference
  /// is not usable in this sense.
  bool is_usable() const
  {
    return distortion.mean <= largest_mean_distortion &&
           area_hit_more_than_once <= largest_flawed_area &&
           largest_uncovered_region <= largest_flawed_area;
  }
};

namespace internal {

// Which part of R is covered by a mesh, where each point of the mesh is mapped to its closest point of R. The
// points that are mapped to a point x inside a triangle lie on the line through x along its normal.
class Coverage
{
public:
  Coverage(const Reference_surface& mesh,
           const Reference_surface& reference,
           double largest_distance)
    : m_mesh(mesh),
      m_reference(reference),
      m_reach(largest_distance),
      m_rounding(1e-9 * reference.diagonal())
  {}

  void measure(Map_statistics& result) const
  {
    // a little irregular, so that no sample lies on an edge of a mesh that was made by regular subdivision
    const Vector_3 samples[4] = {
      {0.337, 0.341, 0.322}, {0.597, 0.198, 0.205}, {0.203, 0.601, 0.196}, {0.195, 0.207, 0.598}};
    const double largest_gap = 3 * m_reference.mean_edge_length();
    const int n = m_reference.mesh().number_of_faces();
    std::vector<char> is_uncovered(n, 1);
    // where faces of the same orientation are upright, and where opposite ones are
    std::size_t hit_once[2] = {0, 0};
    double hit_more[2] = {0, 0};
    double area = 0, not_hit = 0;
    Surface_point last;
    for(int f = 0; f < n; ++f)
    {
      const double sample_area = 0.5 * m_reference.face_normal(f).norm() / 4;
      area += 4 * sample_area;
      for(const Vector_3& barycentric : samples)
      {
        const Vector_3 x = m_reference.point(f, barycentric).position;
        last = last.face < 0 ? m_mesh.closest(x) : m_mesh.closest_near(x, last.face, m_rounding);
        is_uncovered[f] = is_uncovered[f] && (last.position - x).norm() > largest_gap;
        ++result.number_of_samples;
        const Hits hits = hits_of(x, f);
        if(hits.same + hits.opposite == 0)
        {
          ++result.number_of_samples_not_hit;
          not_hit += sample_area;
          continue;
        }
        for(const int i : {0, 1})
          if((i == 0 ? hits.same : hits.opposite) == 1 && hits.same + hits.opposite == 1)
            ++hit_once[i];
          else
            hit_more[i] += sample_area;
      }
    }
    const int orientation = hit_once[0] < hit_once[1] ? 1 : 0;
    result.number_of_samples_hit_once = hit_once[orientation];
    result.area_hit_more_than_once = hit_more[orientation] / area;
    result.area_not_hit = not_hit / area;
    result.largest_uncovered_region = largest_region(is_uncovered) / area;
  }

private:
  struct Hits
  {
    int same = 0, opposite = 0; // orientation
  };

  // the points of the mesh whose closest point is x, in face f of R
  Hits hits_of(const Vector_3& x, int f) const
  {
    Hits hits;
    const Vector_3 normal = m_reference.face_normal(f).stableNormalized();
    const double reach = m_reach + m_rounding;
    for(const int g : m_mesh.intersected_faces(x - reach * normal, x + reach * normal))
    {
      const Vector_3 other = m_mesh.face_normal(g);
      const double cosine = other.dot(normal);
      if(cosine == 0)
        continue;
      const double height = other.dot(m_mesh.corner_point(g, 0) - x) / cosine;
      const Vector_3 y = x + height * normal;
      const Surface_point closest = m_reference.closest_near(y, f, m_rounding);
      if((closest.position - y).norm() < std::abs(height) - m_rounding)
        continue;
      ++(cosine > 0 ? hits.same : hits.opposite);
    }
    return hits;
  }

  // the area of the largest connected region of these triangles of R
  double largest_region(std::vector<char> is_in_region) const
  {
    double largest = 0;
    for(std::size_t first = 0; first < is_in_region.size(); ++first)
    {
      if(!is_in_region[first])
        continue;
      double area = 0;
      for(const int f : extract_connected_region(m_reference.mesh(), int(first), is_in_region))
        area += 0.5 * m_reference.face_normal(f).norm();
      largest = (std::max)(largest, area);
    }
    return largest;
  }

  const Reference_surface &m_mesh, &m_reference;
  double m_reach, m_rounding;
};

// the part of the source's area in faces that shrink to less than a thousandth of their area
inline double collapsed_area(const Mesh_copy& source, const Mesh_copy& mesh)
{
  const double smallest_part = 0.001, scale = surface_area(mesh.mesh, mesh.points) /
                                              surface_area(source.mesh, source.points);
  double area = 0, collapsed = 0;
  for(int f = 0; f < source.mesh.number_of_faces(); ++f)
  {
    const double before = face_vector_area(source.mesh, source.points, f).norm(),
                 after = face_vector_area(source.mesh, mesh.points, f).norm();
    area += before;
    collapsed += after < smallest_part * scale * before ? before : 0;
  }
  return collapsed / area;
}

} // namespace internal

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * measures a map from one surface to another: that from `source` to `mesh`, a mesh of the same connectivity on
 * `reference`.
 *
 * Every point of the mesh is mapped to its closest point of the reference. A sample of the reference is *hit*
 * by each point of the mesh whose closest point it is; such points lie on the line along the normal of its
 * triangle. Where vertices are on the reference and the mesh bridges a convex edge, samples beside that edge may
 * not be hit. The two may be oriented oppositely.
 *
 * \param source the mesh with the shapes at rest. Faces and vertices of it and of `mesh` correspond by their
 *        positions in `faces()` and `vertices()`.
 * \param mesh the mesh on the reference
 * \param reference the reference
 * \param np_source the parameter `vertex_point_map` of `source`
 * \param np the parameter `vertex_point_map` of `mesh`
 * \param np_reference the parameter `vertex_point_map` of `reference`
 *
 * \throws Invalid_input if source and mesh do not correspond, or a mesh has no area.
 */
template <typename SourceMesh,
          typename FaceGraph,
          typename ReferenceMesh,
          typename NamedParametersSource = parameters::Default_named_parameters,
          typename NamedParameters = parameters::Default_named_parameters,
          typename NamedParametersReference = parameters::Default_named_parameters>
Map_statistics
map_statistics(const SourceMesh& source,
               const FaceGraph& mesh,
               const ReferenceMesh& reference,
               const NamedParametersSource& np_source = parameters::default_values(),
               const NamedParameters& np = parameters::default_values(),
               const NamedParametersReference& np_reference = parameters::default_values())
{
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  const internal::Reference_surface m(copy);
  const internal::Reference_surface r(
    internal::read_measured_mesh(reference, np_reference, "reference"));
  Map_statistics result;
  result.distortion = distortion_statistics(source, mesh, np_source, np, r.area());
  result.defects = orientation_defects(mesh, reference, np, np_reference);
  result.drift = internal::mutual_drift(m, r);
  internal::Coverage(m, r, result.drift.mesh_to_reference.maximum).measure(result);
  result.collapsed_area =
    internal::collapsed_area(internal::read_measured_mesh(source, np_source, "source"), copy);
  return result;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_MAP_STATISTICS_H
