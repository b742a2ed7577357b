// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_COMPATIBLE_REMESHING_ENERGY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_COMPATIBLE_REMESHING_ENERGY_H

#include <CGAL/Reference_constrained_optimization/Energy_element.h>
#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/Symmetric_Dirichlet_density.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/surface_metric.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/face_correspondence.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * makes the map from a source mesh to a mesh of the same connectivity as isometric as possible:
 * equation (5) of the paper with the density of its equation (6),
 * \f$ \sum_f \|J_f\|_F^2 + \|J_f^{-1}\|_F^2 \f$, with \f$ J_f \f$ the Jacobian of the affine map
 * from the source's face `f` to the mesh's.
 *
 * Faces and vertices of the two meshes correspond by their positions in `faces()` and
 * `vertices()`. Quads are split into two triangles along the diagonal that is shorter in the
 * source. The energy keeps a copy of the source.
 *
 * \cgalModels{ReferenceConstrainedEnergy}
 */
class Compatible_remeshing_energy
{
public:
  /// model of `DistortionDensity`.
  typedef Symmetric_Dirichlet_density Density;

  /*!
   * constructs the energy from the source mesh.
   *
   * \tparam SourceMesh a model of `FaceListGraph` and `HalfedgeListGraph`, of triangles and quads
   * \tparam NamedParameters a sequence of \ref bgl_namedparameters "Named Parameters"
   *
   * \param source the mesh \f$ Q \f$ with the shapes at rest
   * \param np optional parameters of the package (first in a chain) and of CGAL (after them):
   *
   * \cgalNamedParamsBegin
   *   \cgalParamNBegin{vertex_point_map}
   *     \cgalParamDescription{a property map from the vertices of `source` to points}
   *     \cgalParamType{a model of `ReadablePropertyMap`}
   *     \cgalParamDefault{`boost::get(CGAL::vertex_point, source)`}
   *   \cgalParamNEnd
   *   \cgalParamNBegin{use_equal_areas}
   *     \cgalParamDescription{whether the source is scaled to the area of the reference first, so
   *                           that a difference in size is no distortion}
   *     \cgalParamType{`bool`}
   *     \cgalParamDefault{`true`}
   *   \cgalParamNEnd
   * \cgalNamedParamsEnd
   *
   * \throws Invalid_input if the source cannot be read (see `reference_constrained_optimize()`) or
   *         has a triangle without area; the message names the face.
   */
  template <typename SourceMesh, typename NamedParameters = parameters::Default_named_parameters>
  explicit Compatible_remeshing_energy(const SourceMesh& source,
                                       const NamedParameters& np = parameters::default_values())
    : m_use_equal_areas(parameters::choose_parameter(
        parameters::get_parameter(internal::cgal_parameters(np), internal_np::use_equal_areas),
        true))
  {
    internal::Mesh_copy copy = internal::read_measured_mesh(source, np, "source");
    m_area = internal::surface_area(copy.mesh, copy.points);
    m_begin.push_back(0);
    for(int f = 0; f < copy.mesh.number_of_faces(); ++f)
    {
      for(const std::array<int, 3>& t : internal::split_face(copy.mesh, copy.points, f))
      {
        Energy_element element;
        internal::Vector_3 p[3];
        for(int i = 0; i < 3; ++i)
        {
          element.corners[i] = t[i] - copy.mesh.face_begin[f];
          p[i] = copy.points[copy.mesh.corner_vertex[t[i]]];
        }
        element.rest = internal::triangle_shape(p[0], p[1], p[2]);
        // a determinant that underflows or is dominated by rounding
        if(!(element.rest.determinant() > 1e-14 * element.rest.squaredNorm()))
          throw Invalid_input("Compatible_remeshing_energy: face " + std::to_string(f) +
                              " of the source has a triangle without area");
        m_elements.push_back(element);
      }
      m_begin.push_back(m_elements.size());
    }
    m_source = std::move(copy.mesh);
  }

  /// the density.
  const Density& density() const { return m_density; }

  /// appends the elements of face `f`: one for a triangle, two for a quad. \throws Invalid_input if
  /// `f` does not have the vertices of the source's face at the same position, in the same order.
  void append_elements(const Energy_context& context,
                       std::size_t f,
                       std::vector<Energy_element>& elements) const
  {
    const int rotation = matched_rotation(context, f);
    const double scale = m_use_equal_areas ? std::sqrt(context.reference_area() / m_area) : 1;
    for(std::size_t e = m_begin[f]; e < m_begin[f + 1]; ++e)
    {
      Energy_element element = m_elements[e];
      for(int& corner : element.corners)
        corner = (corner + rotation) % context.degree(f);
      element.rest *= scale;
      elements.push_back(element);
    }
  }

private:
  // the message names the first face that differs
  int matched_rotation(const Energy_context& context, std::size_t f) const
  {
    const std::string start = "Compatible_remeshing_energy: ";
    const std::size_t n = std::size_t(m_source.number_of_faces());
    if(f >= n)
      throw Invalid_input(start + "face " + std::to_string(f) +
                          " of the mesh has no counterpart: " + "the source has " +
                          std::to_string(n) + " faces, the mesh " +
                          std::to_string(context.number_of_faces()));
    const int rotation = internal::face_rotation(m_source, int(f), context.degree(f),
                                                 [&](int i) { return context.vertex(f, i); });
    if(rotation < 0)
      throw Invalid_input(
        start + "face " + std::to_string(f) + " has the vertices " +
        list(context.degree(f), [&](int i) { return context.vertex(f, i); }) +
        " in the mesh, but " +
        list(m_source.degree(int(f)),
             [&](int i) { return m_source.corner_vertex[m_source.face_begin[f] + i]; }) +
        " in the source");
    if(f + 1 == context.number_of_faces())
    {
      if(f + 1 < n)
        throw Invalid_input(start + "face " + std::to_string(f + 1) +
                            " of the source has no counterpart: the source has " +
                            std::to_string(n) + " faces, the mesh " + std::to_string(f + 1));
      if(context.number_of_vertices() != std::size_t(m_source.number_of_vertices()))
        throw Invalid_input(start + "all faces agree, but the source has " +
                            std::to_string(m_source.number_of_vertices()) + " vertices, the mesh " +
                            std::to_string(context.number_of_vertices()));
    }
    return rotation;
  }

  template <typename VertexAccess>
  static std::string list(int degree, const VertexAccess& vertex)
  {
    std::string text;
    for(int i = 0; i < degree; ++i)
      text += (i > 0 ? " " : "") + std::to_string(vertex(i));
    return text;
  }

  Density m_density;
  bool m_use_equal_areas;
  internal::Indexed_mesh m_source;
  double m_area = 0;
  std::vector<std::size_t> m_begin; // first element of every face, and the number of all
  std::vector<Energy_element> m_elements;
};

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_COMPATIBLE_REMESHING_ENERGY_H
