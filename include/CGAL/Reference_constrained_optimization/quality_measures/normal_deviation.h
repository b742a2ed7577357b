// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_NORMAL_DEVIATION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_NORMAL_DEVIATION_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/Located_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/face_normal_deviation.h>

#include <algorithm>
#include <array>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * holds statistics of the angles between the normals of a mesh and of its reference, in degrees from 0 to
 * 180. Faces are weighted by area.
 */
struct Normal_deviation
{
  double mean = 0;           ///< mean over the area.
  double maximum = 0;        ///< largest deviation of a face.
  double share_above_10 = 0; ///< part of the area in faces with a deviation above 10 degrees.
  double share_above_20 = 0; ///< the same for 20 degrees.
  double share_above_45 = 0; ///< the same for 45 degrees.
};

namespace internal {

// Angle between a normal and that of the reference's face that is closest to p, searched from the face
// closest to a nearby point. At an edge or a vertex of the reference, where several faces are closest, the
// smallest angle. Faces without area are ignored, unless there are no others.
inline double normal_deviation_at(const Reference_surface& reference,
                                  const Vector_3& p,
                                  const Vector_3& normal,
                                  Surface_point& closest)
{
  const double rounding = 1e-12 * reference.diagonal();
  closest = reference.closest_near(p, closest.face, rounding);
  double smallest = 360;
  const auto consider = [&](int f) {
    if(!reference.is_degenerate(f))
      smallest = (std::min)(smallest, angle_between(normal, reference.oriented_face_normal(f)));
  };
  consider(closest.face);
  const double nothing = 1e-4; // the others need no search then
  if(smallest > nothing)
    for(const Surface_point& q : reference.all_within(p, (closest.position - p).norm() + rounding))
      consider(q.face);
  return smallest <= 180 ? smallest : angle_between(normal, reference.normal(closest));
}

} // namespace internal

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * measures the angles between the normals of the faces of a mesh and of a reference, which distances do not
 * measure, as a surface may be close to another and rough.
 *
 * At seven points of each triangle (quads are split by their shorter diagonal): its centroid, the three
 * points with barycentric coordinates (.6, .2, .2), and the three points (.495, .495, .01) next to the
 * midpoints of its edges, the angle is taken between the triangle's normal and that of the reference's face
 * at the closest point; where several faces of the reference are equally close, the smallest angle. The
 * deviation of a triangle is the mean of the seven. Triangles without area do not count, on either side.
 * Components of the reference that are oriented against the mesh are reversed first.
 *
 * Parameters are those of `orientation_defects()`.
 *
 * \return the deviation in degrees: mean, maximum and distribution; zeros if no face of the mesh has an
 *         area.
 *
 * \throws Invalid_input as all quality measures, and if every face of the reference has zero area
 */
template <typename FaceGraph,
          typename ReferenceMesh,
          typename NamedParameters = parameters::Default_named_parameters,
          typename NamedParametersReference = parameters::Default_named_parameters>
Normal_deviation
normal_deviation(const FaceGraph& mesh,
                 const ReferenceMesh& reference,
                 const NamedParameters& np = parameters::default_values(),
                 const NamedParametersReference& np_reference = parameters::default_values())
{
  typedef internal::Vector_3 Vector_3;
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  const internal::Located_mesh located(
    copy, internal::read_measured_mesh(reference, np_reference, "reference"));

  Normal_deviation result;
  double area = 0, sum = 0;
  for(int f = 0; f < copy.mesh.number_of_faces(); ++f)
    for(const std::array<int, 3>& t : internal::split_face(copy.mesh, copy.points, f))
    {
      const auto corner = [&](int i) -> const Vector_3& {
        return copy.points[copy.mesh.corner_vertex[t[i]]];
      };
      const Vector_3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      const double weight = 0.5 * normal.norm();
      if(!(weight > 0))
        continue;
      internal::Surface_point closest = located(copy.mesh.corner_vertex[t[0]]).on_reference;
      double deviation = 0;
      for(const Vector_3& b : internal::normal_deviation_samples())
        deviation += internal::normal_deviation_at(
          located.reference(), b(0) * corner(0) + b(1) * corner(1) + b(2) * corner(2), normal,
          closest);
      deviation /= double(internal::normal_deviation_samples().size());
      area += weight;
      sum += weight * deviation;
      result.maximum = (std::max)(result.maximum, deviation);
      result.share_above_10 += deviation > 10 ? weight : 0;
      result.share_above_20 += deviation > 20 ? weight : 0;
      result.share_above_45 += deviation > 45 ? weight : 0;
    }
  if(area > 0)
  {
    result.mean = sum / area;
    result.share_above_10 /= area;
    result.share_above_20 /= area;
    result.share_above_45 /= area;
  }
  return result;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_NORMAL_DEVIATION_H
