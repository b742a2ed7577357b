// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_ORIENTATION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_ORIENTATION_H

#include <CGAL/Reference_constrained_optimization/internal/reading/Located_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * counts inverted faces and folded edges. Degenerate faces count in neither.
 */
struct Orientation_defects
{
  /// faces whose normal has a negative dot product with the sum of the reference's normals at their
  /// vertices.
  std::size_t number_of_flips = 0;
  /// edges whose two unit face normals have a dot product below -1/2.
  std::size_t number_of_fold_edges = 0;

  /// both together.
  std::size_t total() const { return number_of_flips + number_of_fold_edges; }
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * counts the faces that are inverted with respect to the reference and the edges that are folded.
 *
 * The reference's normal at a vertex of the mesh is interpolated linearly from the area-weighted
 * unit normals at the vertices of the reference's triangle in which the vertex' closest point lies;
 * where several sheets of the reference pass through a vertex, that of the sheet which agrees best with the
 * faces at the vertex. Components of the reference that are oriented against the mesh are reversed first.
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
Orientation_defects
orientation_defects(const FaceGraph& mesh,
                    const ReferenceMesh& reference,
                    const NamedParameters& np = parameters::default_values(),
                    const NamedParametersReference& np_reference = parameters::default_values())
{
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  const internal::Indexed_mesh& m = copy.mesh;
  const internal::Located_mesh vertex(
    copy, internal::read_measured_mesh(reference, np_reference, "reference"));
  Orientation_defects result;
  std::vector<internal::Vector_3> normals(m.number_of_faces());
  for(int f = 0; f < m.number_of_faces(); ++f)
  {
    normals[f] = internal::face_normal(m, vertex, f);
    result.number_of_flips += internal::is_flipped(m, vertex, f, normals[f]);
  }
  for(int c = 0; c < m.number_of_corners(); ++c)
    if(m.opposite[c] > c)
      result.number_of_fold_edges +=
        internal::is_folded(normals[m.corner_face[c]], normals[m.corner_face[m.opposite[c]]]);
  return result;
}

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * counts the quads that are not convex as seen along the reference's normals: at one corner at
 * least, the triangle of the corner and its two neighbours in the face is inverted with respect to the sum
 * of the reference's normals at these three vertices.
 *
 * Parameters are those of `orientation_defects()`. Triangles are skipped.
 */
template <typename FaceGraph,
          typename ReferenceMesh,
          typename NamedParameters = parameters::Default_named_parameters,
          typename NamedParametersReference = parameters::Default_named_parameters>
std::size_t number_of_nonconvex_quads(
  const FaceGraph& mesh,
  const ReferenceMesh& reference,
  const NamedParameters& np = parameters::default_values(),
  const NamedParametersReference& np_reference = parameters::default_values())
{
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  const internal::Indexed_mesh& m = copy.mesh;
  const internal::Located_mesh vertex(
    copy, internal::read_measured_mesh(reference, np_reference, "reference"));
  std::size_t count = 0;
  for(int f = 0; f < m.number_of_faces(); ++f)
    count += internal::is_nonconvex(m, vertex, f);
  return count;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_ORIENTATION_H
