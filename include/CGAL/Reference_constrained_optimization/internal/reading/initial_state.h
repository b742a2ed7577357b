// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_INITIAL_STATE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_INITIAL_STATE_H

#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/connected_region.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/has_area.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/point_index.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>
#include <CGAL/Reference_constrained_optimization/internal/support/text_of.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

#include <CGAL/boost/graph/iterator.h>

#include <boost/graph/graph_traits.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// reads the vertices and edges that are constrained
template <typename PolygonMesh, typename NamedParameters>
Constraints
read_constraints(const PolygonMesh& g, const NamedParameters& np, const Indexed_mesh& mesh)
{
  typedef boost::graph_traits<PolygonMesh> Graph_traits;
  Constraints constraints;
  constraints.is_constrained.assign(mesh.number_of_vertices(), 0);
  constraints.is_line.assign(mesh.number_of_corners(), 0);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    constraints.is_line[c] = mesh.opposite[c] < 0;

  if constexpr(!parameters::is_default_parameter<NamedParameters,
                                                 CGAL::internal_np::vertex_is_constrained_t>::value)
  {
    const auto map = parameters::get_parameter(np, CGAL::internal_np::vertex_is_constrained);
    int i = 0;
    for(const typename Graph_traits::vertex_descriptor v : vertices(g))
      constraints.is_constrained[i++] = get(map, v);
  }
  if constexpr(!parameters::is_default_parameter<NamedParameters,
                                                 CGAL::internal_np::edge_is_constrained_t>::value)
  {
    const auto map = parameters::get_parameter(np, CGAL::internal_np::edge_is_constrained);
    int f = 0;
    for(const typename Graph_traits::face_descriptor face : faces(g))
    {
      // the half-edge to a corner's vertex starts at the corner before it
      int c = mesh.face_begin[f];
      for(const typename Graph_traits::halfedge_descriptor h :
          CGAL::halfedges_around_face(halfedge(face, g), g))
      {
        if(get(map, edge(h, g)))
          constraints.is_line[mesh.previous(c)] = 1;
        ++c;
      }
      ++f;
    }
  }
  return constraints;
}

// Decides which vertices may move freely: those with faces, not constrained and on no constrained or
// border edge.
inline std::vector<char> free_vertices(const Indexed_mesh& mesh, const Constraints& constraints)
{
  std::vector<char> is_free(mesh.number_of_vertices(), 0);
  for(int v = 0; v < mesh.number_of_vertices(); ++v)
    is_free[v] = !constraints.is_constrained[v] && mesh.vertex_begin[v + 1] > mesh.vertex_begin[v];
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(constraints.is_line[c])
      is_free[mesh.source(c)] = is_free[mesh.target(c)] = 0;
  return is_free;
}

inline double cosine_between(const Vector_3& a, const Vector_3& b)
{
  const double lengths = a.norm() * b.norm();
  return lengths > 0 ? a.dot(b) / lengths : 0;
}

// The closest points on all sheets of R within a distance of a vertex, the given one first. Empty if there
// is only one sheet.
inline std::vector<Surface_point> sheets_at(const Reference_surface& reference,
                                            const Vector_3& p,
                                            const Surface_point& found,
                                            double distance)
{
  const Vector_3 found_normal = reference.normal(found);
  const double same_sheet = 0.9;
  std::vector<Surface_point> sheets;
  for(const Surface_point& q : reference.all_within(p, distance))
    if(cosine_between(reference.normal(q), found_normal) < same_sheet)
      sheets.push_back(q);
  if(!sheets.empty())
    sheets.insert(sheets.begin(), found);
  return sheets;
}

// The one of these points whose sheet agrees best with the faces at the vertex. As long as the orientation
// is unknown, the sign of the normals only breaks ties.
inline Surface_point matching_sheet(const Indexed_mesh& mesh,
                                    const std::vector<Vector_3>& points,
                                    int v,
                                    const Reference_surface& reference,
                                    const std::vector<Surface_point>& sheets,
                                    bool is_orientation_known)
{
  Vector_3 normal = Vector_3::Zero();
  for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    normal += face_vector_area(mesh, points, mesh.corner_face[mesh.vertex_corners[k]]);
  const auto agreement = [&](const Surface_point& q) {
    const double c = cosine_between(reference.normal(q), normal), tie_weight = 1e-3;
    return is_orientation_known ? c : std::abs(c) + tie_weight * c;
  };
  Surface_point best = sheets.front();
  for(const Surface_point& q : sheets)
    if(agreement(q) > agreement(best))
      best = q;
  return best;
}

// Locates every vertex on R, by the tree unless R has a vertex at the same place, and moves free vertices
// onto R. Components of the reference that are oriented against the mesh are reversed.
template <typename ConcurrencyTag = CGAL::Sequential_tag>
void locate_on_reference(const std::vector<Vector_3>& points,
                         Reference_surface& reference,
                         Optimization_state& state,
                         Result& result,
                         Interruption* interruption = nullptr,
                         double distance_of_origin = 0)
{
  const Indexed_mesh& mesh = state.mesh;
  // a vertex this close is on R, and its coordinates are kept
  const double rounding = rounding_of(
    mesh, [&](int v) -> const Vector_3& { return points[v]; }, distance_of_origin);
  const double tolerance = 1e-12 * reference.diagonal() + rounding;

  const Indexed_mesh& surface = reference.mesh();
  const auto is_used = [&](int v) { return !surface.is_isolated(v); };
  const Point_index index(reference.points(), is_used);
  // of several coincident vertices of R, the one with the same index if R is the mesh
  const auto find_coincident_vertex = [&](int v) {
    const bool is_coincident =
      v < surface.number_of_vertices() && is_used(v) && reference.points()[v] == points[v];
    return is_coincident ? v : index.find(points[v]);
  };
  state.vertices.resize(points.size());
  std::vector<std::vector<Surface_point>> sheets(points.size());
  for_each_block<ConcurrencyTag>(mesh.number_of_vertices(), [&](int begin, int end, int) {
    for(int v = begin; v < end; ++v)
    {
      check_periodically(interruption, v);
      if(!mesh.is_isolated(v))
      {
        const int coincident_vertex = find_coincident_vertex(v);
        Surface_point& point = state.vertices[v].on_reference;
        point = coincident_vertex >= 0 ? reference.at_vertex(coincident_vertex)
                                       : reference.closest_from_vertex(points[v], v);
        if(coincident_vertex < 0 && (point.position - points[v]).norm() <= tolerance)
        {
          sheets[v] = sheets_at(reference, points[v], point, tolerance);
          if(!sheets[v].empty())
            point = matching_sheet(mesh, points, v, reference, sheets[v], false);
        }
      }
    }
  });
  const auto set_position = [&](int v) {
    Located_vertex& located = state.vertices[v];
    const bool moves =
      state.is_free[v] && (located.on_reference.position - points[v]).norm() > rounding;
    located.position = moves ? located.on_reference.position : points[v];
  };
  for(int v = 0; v < mesh.number_of_vertices(); ++v)
  {
    set_position(v);
    result.number_of_free_vertices += state.is_free[v] && !mesh.is_isolated(v);
  }

  const auto update_normals = [&]() {
    for(Located_vertex& located : state.vertices)
      if(located.on_reference.face >= 0)
        located.normal = reference.normal(located.on_reference);
  };
  update_normals();
  const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
  std::vector<double> agreement(surface.number_of_faces(), 0); // per face of R
  bool disagrees = false;
  for(int f = 0; f < mesh.number_of_faces(); ++f)
  {
    if(!state.is_optimized(f))
      continue;
    const Vector_3 n = face_normal(mesh, vertex, f);
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
    {
      const Located_vertex& v = vertex(mesh.corner_vertex[c]);
      const double d = n.dot(v.normal);
      // undecided where there are several sheets
      if(sheets[mesh.corner_vertex[c]].empty())
        agreement[v.on_reference.face] += d;
      disagrees = disagrees || d < 0;
    }
  }
  if(!disagrees)
    return;
  std::vector<char> is_unvisited(surface.number_of_faces(), 1), is_reversed(is_unvisited.size(), 0);
  for(int first = 0; first < surface.number_of_faces(); ++first)
  {
    if(!is_unvisited[first])
      continue;
    const std::vector<int> component = extract_connected_region(surface, first, is_unvisited);
    double sum = 0;
    for(const int f : component)
      sum += agreement[f];
    if(sum < 0)
      for(const int f : component)
        is_reversed[f] = 1;
  }
  reference.reverse(is_reversed);
  // of two sheets of opposite orientation, the one that agrees with the mesh
  for(int v = 0; v < mesh.number_of_vertices(); ++v)
    if(!sheets[v].empty())
    {
      state.vertices[v].on_reference = matching_sheet(mesh, points, v, reference, sheets[v], true);
      set_position(v);
    }
  update_normals();
}

// Throws Invalid_input for a mesh that is not close to R; vertices that are not optimized are ignored.
// `unit` is the unit of length in the message.
inline void
check_distances(const std::vector<Vector_3>& points, const Optimization_state& state, double unit)
{
  const double limit = 0.1 * state.reference.diagonal();
  for(std::size_t v = 0; v < points.size(); ++v)
  {
    if(!state.has_optimized_face(int(v)))
      continue;
    const double distance = (state.vertices[v].on_reference.position - points[v]).norm();
    if(!(distance <= limit))
      throw Invalid_input("mesh: vertex " + std::to_string(v) + " is " + text_of(distance * unit) +
                          " away from the reference, but at most " + text_of(limit * unit) +
                          ", a tenth of the reference's diagonal, is allowed");
  }
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_INITIAL_STATE_H
