// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_FEATURE_CONSTRAINTS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_FEATURE_CONSTRAINTS_H

#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/feature_detection.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/polyline_tracing.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/internal/support/compatibility.h>

#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// one corner of a polygon mesh for an edge of the triangles that it was split into; -1 for a diagonal
inline int polygon_corner(const Indexed_mesh& polygons, const Reference_surface& surface, int c)
{
  const Indexed_mesh& triangles = surface.mesh();
  const int f = surface.original_face(triangles.corner_face[c]);
  for(int d = polygons.face_begin[f]; d < polygons.face_begin[f + 1]; ++d)
    if(polygons.source(d) == triangles.source(c) && polygons.target(d) == triangles.target(c))
      return d;
  return -1;
}

// per corner of the polygons that R was split from
inline std::vector<char> features_of_polygons(const Indexed_mesh& polygons,
                                              const Reference_surface& surface,
                                              const std::vector<char>& is_feature)
{
  std::vector<char> result(polygons.number_of_corners(), 0);
  for(int c = 0; c < int(is_feature.size()); ++c)
  {
    const int d = is_feature[c] ? polygon_corner(polygons, surface, c) : -1;
    if(d >= 0)
      result[d] = 1;
  }
  return result;
}

inline Line_edges feature_edges(const Indexed_mesh& triangles, const std::vector<char>& is_feature)
{
  Line_edges edges;
  for(int c = 0; c < triangles.number_of_corners(); ++c)
    if(is_feature[c] && c < triangles.opposite[c])
      edges.push_back({{triangles.source(c), triangles.target(c)}});
  return edges;
}

// adds lines to the constraints
inline void constrain(const std::vector<char>& is_feature,
                      const Indexed_mesh& mesh,
                      Constraints& constraints,
                      Result& result)
{
  for(int c = 0; c < int(is_feature.size()); ++c)
    if(is_feature[c])
    {
      constraints.is_line[c] = 1;
      result.number_of_feature_edges += c < mesh.opposite[c];
    }
}

// Tips of mechanical parts, as that of a cone, stay: vertices at which angles add up to less than 270
// degrees. The mesh is R, or a copy of it.
inline void constrain_tips(const Indexed_mesh& mesh,
                           const Reference_surface& surface,
                           const std::vector<char>& is_mechanical,
                           Constraints& constraints)
{
  const double sum_at_tip = 270;
  const Indexed_mesh& triangles = surface.mesh();
  const auto position = [&](int v) -> const Vector_3& { return surface.points()[v]; };
  std::vector<double> sum(mesh.number_of_vertices(), 0);
  for(int c = 0; c < triangles.number_of_corners(); ++c)
    sum[triangles.source(c)] += corner_angle(triangles, position, c);
  for(int v = 0; v < mesh.number_of_vertices(); ++v)
    if(!mesh.is_isolated(v) && !mesh.is_border_vertex[v] && is_mechanical[triangles.face_at(v)] &&
       sum[v] < sum_at_tip)
      constraints.is_constrained[v] = 1;
}

// the faces of the mesh whose vertices all lie on marked triangles of R; empty if there are none
inline std::vector<char> faces_on(const Optimization_state& state,
                                  const std::vector<char>& is_marked)
{
  const Indexed_mesh& mesh = state.mesh;
  std::vector<char> result;
  if(is_marked.empty())
    return result;
  result.assign(mesh.number_of_faces(), 1);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(!is_marked[state.vertices[mesh.corner_vertex[c]].on_reference.face])
      result[mesh.corner_face[c]] = 0;
  return result;
}

// the corners of faces with a bounded normal deviation whose edges have a dihedral angle below 20 degrees
inline std::vector<char> smooth_edges(const Optimization_state& state)
{
  const Indexed_mesh& mesh = state.mesh;
  const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
  const double cosine_of_turn = 0.94;
  std::vector<char> result(mesh.number_of_corners(), 0);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(mesh.opposite[c] > c)
    {
      const int f = mesh.corner_face[c], g = mesh.corner_face[mesh.opposite[c]];
      const Vector_3 a = face_normal(mesh, vertex, f), b = face_normal(mesh, vertex, g);
      result[c] = result[mesh.opposite[c]] =
        (state.bounds_normal_deviation[f] || state.bounds_normal_deviation[g]) &&
        a.dot(b) >= cosine_of_turn * a.norm() * b.norm();
    }
  return result;
}

// For a mesh that is not R itself, the edges along feature lines of R: those that are sharp and whose end
// points and midpoint lie on such lines. Per corner.
inline std::vector<char> traced_features(const Indexed_mesh& mesh,
                                         const std::vector<Vector_3>& positions,
                                         const Reference_surface& surface,
                                         const std::vector<char>& is_feature)
{
  typedef CGAL::Simple_cartesian<double> Kernel;
  typedef std::vector<Kernel::Segment_3>::const_iterator Segment_iterator;
  const auto point = [](const Vector_3& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
  std::vector<char> result(mesh.number_of_corners(), 0);
  std::vector<Kernel::Segment_3> segments;
  for(const std::array<int, 2>& e : feature_edges(surface.mesh(), is_feature))
    if(surface.points()[e[0]] != surface.points()[e[1]])
      segments.emplace_back(point(surface.points()[e[0]]), point(surface.points()[e[1]]));
  if(segments.empty())
    return result;
  Segment_tree<Kernel, Segment_iterator> tree(segments.begin(), segments.end());
  tree.accelerate_distance_queries();
  const auto distance = [&](const Vector_3& x) {
    return std::sqrt(tree.squared_distance(point(x)));
  };
  // vertices on a line, up to rounding
  std::vector<double> shortest(positions.size(), std::numeric_limits<double>::infinity());
  for(int c = 0; c < mesh.number_of_corners(); ++c)
  {
    const double length = (positions[mesh.target(c)] - positions[mesh.source(c)]).norm();
    for(const int v : {mesh.source(c), mesh.target(c)})
      shortest[v] = (std::min)(shortest[v], length);
  }
  const double small_part = 0.01, sagitta = 0.1, cosine_of_turn = 0.94; // 20 degrees
  std::vector<char> is_on_line(positions.size(), 0);
  for(std::size_t v = 0; v < positions.size(); ++v)
    is_on_line[v] = !mesh.is_isolated(int(v)) && distance(positions[v]) <= small_part * shortest[v];
  for(int c = 0; c < mesh.number_of_corners(); ++c)
  {
    const int o = mesh.opposite[c], v = mesh.source(c), w = mesh.target(c);
    if(o < c || !is_on_line[v] || !is_on_line[w])
      continue;
    const Vector_3 a = face_vector_area(mesh, positions, mesh.corner_face[c]),
                   b = face_vector_area(mesh, positions, mesh.corner_face[o]);
    const Vector_3 &p = positions[v], &q = positions[w];
    result[c] = result[o] = a.dot(b) < cosine_of_turn * a.norm() * b.norm() &&
                            distance(0.5 * (p + q)) <= sagitta * (p - q).norm();
  }
  return result;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_FEATURE_CONSTRAINTS_H
