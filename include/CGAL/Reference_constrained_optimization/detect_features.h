// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_DETECT_FEATURES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_DETECT_FEATURES_H

#include <CGAL/Reference_constrained_optimization/internal/reading/feature_constraints.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/feature_detection.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

#include <CGAL/boost/graph/iterator.h>

#include <boost/graph/graph_traits.hpp>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * reports on a call of `detect_features()`, with dimensionless statistics of the connected component with
 * the largest area among those that are mechanical parts, or among all if none is.
 */
struct Feature_report
{
  bool has_features = false;               ///< whether an edge was marked.
  std::size_t number_of_feature_edges = 0; ///< edges that were marked.
  /// the share of the area in faces with a coplanar neighbour (a dihedral angle below one degree), as in
  /// tessellations of planes, cylinders and cones, however coarse; above 0.85 it is a part.
  double flat_share = 0;
  /// length of the sharp edges (with a dihedral angle of 40 degrees or more) over the square root of the
  /// area; up to 0.25 it is not significant.
  double amount_of_sharp_edges = 0;
  /// the share of the length of sharp edges with adjacent edges of less than a third of their dihedral
  /// angle; above 0.92 it is a part.
  double crisp_share = 0;
  /// the share of edges with a dihedral angle above 40 degrees among those above 20; above 0.65 it is a
  /// part, above 0.4 too if `turned_share` is below 0.25.
  double sharp_share = 0;
  /// the same share of the areas beside these edges, of the smaller face each, which noise affects less;
  /// above 0.5 it is a part if `turned_share` is below 0.45.
  double sharp_area_share = 0;
  /// the share of edges with a dihedral angle above 20 degrees.
  double turned_share = 0;
};

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * marks the feature edges of a surface: the sharp edges of mechanical parts.
 *
 * A mechanical part consists of planes and strips, or its edges are either sharp or nearly flat, and sharp
 * edges form lines between smooth regions; on a scan, an organic shape or a coarse mesh of one, dihedral
 * angles have all values, and sharp edges lie among others that are nearly as sharp. Each connected
 * component is classified separately, by the shares that `Feature_report` holds; a triangle
 * that was split into several counts as one. The features of a part are all edges with a dihedral angle of 40 degrees or more, except for folds (those above 120 degrees with a
 * face that is inverted with respect to the sum of the normals at its vertices), and their continuations
 * where the angle fades, down to 5 degrees.
 *
 * `CGAL::reference_constrained_optimize()` calls it for the reference unless its parameter
 * `detect_features` is `false` or the user constrains edges.
 *
 * \tparam FaceGraph a model of `FaceListGraph` and `HalfedgeListGraph`, with triangles and quads
 * \tparam EdgeIsConstrainedMap a model of `WritablePropertyMap` with the edge descriptor of `FaceGraph`
 *         as key type and `bool` as value type
 * \tparam NamedParameters a sequence of \ref bgl_namedparameters "Named Parameters"
 *
 * \param mesh the surface
 * \param edge_is_constrained_map receives `true` for every feature edge; other edges are not written.
 * \param np the parameter `vertex_point_map`
 *
 * \return the classification and its statistics.
 *
 * \throws Invalid_input if the mesh is empty, not manifold, without area, or has a coordinate that is not
 *         finite.
 */
template <typename FaceGraph,
          typename EdgeIsConstrainedMap,
          typename NamedParameters = parameters::Default_named_parameters>
Feature_report detect_features(const FaceGraph& mesh,
                               EdgeIsConstrainedMap edge_is_constrained_map,
                               const NamedParameters& np = parameters::default_values())
{
  typedef boost::graph_traits<FaceGraph> Graph_traits;
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  const internal::Reference_surface surface(copy);
  const internal::Detected_features features = internal::Feature_detection(surface).result();
  const std::vector<char> is_feature =
    internal::features_of_polygons(copy.mesh, surface, features.is_feature);
  Feature_report report;
  report.flat_share = features.statistics.flat_share();
  report.amount_of_sharp_edges = features.statistics.amount();
  report.crisp_share = features.statistics.crisp_share();
  report.sharp_share = features.statistics.sharp_share();
  report.sharp_area_share = features.statistics.sharp_area_share();
  report.turned_share = features.statistics.turned_share();
  int f = 0;
  for(const typename Graph_traits::face_descriptor face : faces(mesh))
  {
    // the half-edge to a corner's vertex starts at the corner before it
    int c = copy.mesh.face_begin[f++];
    for(const typename Graph_traits::halfedge_descriptor h :
        CGAL::halfedges_around_face(halfedge(face, mesh), mesh))
    {
      const int before = copy.mesh.previous(c++);
      if(is_feature[before])
      {
        put(edge_is_constrained_map, edge(h, mesh), true);
        report.number_of_feature_edges += before < copy.mesh.opposite[before];
      }
    }
  }
  report.has_features = report.number_of_feature_edges > 0;
  return report;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_DETECT_FEATURES_H
