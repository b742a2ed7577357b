// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_PATCH_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_PATCH_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/split_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>

#include <array>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A set of faces with local indices: positions, free vertices, elements and stencils.
struct Patch
{
  std::vector<int> faces;    // of the whole mesh
  std::vector<int> vertices; // of the whole mesh

  Indexed_mesh polygons; // the faces, in local vertices
  // per corner of polygons: the adjacent face of the mesh if that is not in the patch, else -1
  std::vector<int> outside_face;
  std::vector<char> is_free; // per local vertex
  int number_of_free_vertices = 0;
  std::vector<Located_vertex> located; // per local vertex, as they are now
  // per local vertex that slides: its neighbours on its line, in local vertices; else -1. Empty if
  // none slides.
  std::vector<std::array<int, 2>> line_neighbours;
  std::vector<Vector_3> positions() const
  {
    std::vector<Vector_3> points;
    for(const Located_vertex& v : located)
      points.push_back(v.position);
    return points;
  }
  const Polyline_set* lines = nullptr;
  bool slides(int v) const { return !line_neighbours.empty() && line_neighbours[v][0] >= 0; }
  // per face, and per corner, see Optimization_state; empty if no normal deviation is bounded
  std::vector<char> bounds_normal_deviation, is_smooth;
  std::vector<char> is_line; // per corner, see Optimization_state
  bool is_on_line(int c) const { return !is_line.empty() && is_line[c]; }
  std::vector<Element_set::Element> elements; // in local vertices
  std::vector<int> element_begin;             // per face: its first element; and their number

  // The stencils with a free vertex. Vertices outside the patch are fixed: v < 0 is number ~v of
  // `outside_points`.
  struct Stencil
  {
    int number, size;                          // of all stencils
    std::array<int, largest_stencil> vertices; // local
    bool is_shared;                            // has a vertex that other patches may move
  };
  std::vector<Stencil> stencils;
  std::vector<Vector_3> outside_points;
  const Stencil_set* all_stencils = nullptr;
  const Vector_3& position(int v, const std::vector<Located_vertex>& vertices) const
  {
    return v >= 0 ? vertices[v].position : outside_points[~v];
  }
  double value(const Stencil& stencil, const std::vector<Located_vertex>& vertices) const
  {
    Stencil_points points;
    for(int i = 0; i < stencil.size; ++i)
      points[i] = position(stencil.vertices[i], vertices);
    return all_stencils->value(stencil.number, points);
  }

  // the faces split into triangles, for flattening and point location
  const Indexed_mesh& triangles() const { return is_split ? split : polygons; }

  // the face of polygons() that a triangle is part of, and the first triangle of such a face
  int polygon_of(int triangle) const { return is_split ? split_polygon[triangle] : triangle; }
  int triangle_of(int polygon) const { return is_split ? first_triangle[polygon] : polygon; }

  bool is_split = false;
  Indexed_mesh split;
  std::vector<int> split_polygon, first_triangle;
};

// Builds patches; reuses its index maps.
class Patch_builder
{
public:
  explicit Patch_builder(const Indexed_mesh& mesh)
    : m_face_stamp(mesh.number_of_faces(), 0),
      m_vertex_stamp(mesh.number_of_vertices(), 0),
      m_local(mesh.number_of_vertices(), -1),
      m_local_corner(mesh.number_of_faces(), -1)
  {}

  Patch build(const std::vector<int>& faces, const Optimization_state& state)
  {
    const Indexed_mesh& mesh = state.mesh;
    ++m_stamp;
    Patch patch;
    patch.faces = faces;
    std::vector<int> begins(1, 0), corners, opposites, corners_in_patch;
    begins.reserve(faces.size() + 1);
    for(const int f : faces)
    {
      m_face_stamp[f] = m_stamp;
      m_local_corner[f] = begins.back();
      begins.push_back(begins.back() + mesh.degree(f));
    }
    corners.reserve(begins.back());
    opposites.reserve(begins.back());
    patch.outside_face.reserve(begins.back());
    // an estimate of the number of vertices
    const std::size_t expected_size = std::size_t(begins.back()) / 4;
    patch.located.reserve(expected_size);
    patch.vertices.reserve(expected_size);
    corners_in_patch.reserve(expected_size);
    patch.elements.reserve(begins.back() - 2 * faces.size()); // triangles
    patch.element_begin.reserve(faces.size() + 1);
    for(const int f : faces)
    {
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      {
        const int v = mesh.corner_vertex[c];
        if(m_vertex_stamp[v] != m_stamp)
        {
          m_vertex_stamp[v] = m_stamp;
          m_local[v] = int(patch.vertices.size());
          patch.vertices.push_back(v);
          patch.located.push_back(state.vertices[v]);
          corners_in_patch.push_back(0);
        }
        ++corners_in_patch[m_local[v]];
        corners.push_back(m_local[v]);
        if(!state.is_smooth.empty())
          patch.is_smooth.push_back(state.is_smooth[c]);
        if(!state.is_line.empty())
          patch.is_line.push_back(state.is_line[c]);
        const int o = mesh.opposite[c];
        const int g = o < 0 ? -1 : mesh.corner_face[o];
        const bool is_inside = g >= 0 && m_face_stamp[g] == m_stamp;
        patch.outside_face.push_back(is_inside ? -1 : g);
        opposites.push_back(is_inside ? m_local_corner[g] + o - mesh.face_begin[g] : -1);
      }
      patch.element_begin.push_back(int(patch.elements.size()));
      for(int e = state.elements.begin(f); e < state.elements.end(f); ++e)
      {
        Element_set::Element element = state.elements[e];
        for(int& v : element.vertices)
          v = m_local[v];
        patch.elements.push_back(element);
      }
      patch.is_split = patch.is_split || mesh.degree(f) > 3;
      if(!state.bounds_normal_deviation.empty())
        patch.bounds_normal_deviation.push_back(state.bounds_normal_deviation[f]);
    }
    patch.element_begin.push_back(int(patch.elements.size()));
    const int n = int(patch.vertices.size());
    patch.polygons = Indexed_mesh(std::move(begins), std::move(corners), std::move(opposites), n);
    patch.is_free.reserve(n);
    for(int i = 0; i < n; ++i)
    {
      const int v = patch.vertices[i];
      const bool is_inside = corners_in_patch[i] == mesh.vertex_begin[v + 1] - mesh.vertex_begin[v];
      patch.is_free.push_back(state.is_free[v] && is_inside);
      patch.number_of_free_vertices += patch.is_free.back();
    }
    collect_sliding(state, patch);
    collect_stencils(state, patch);
    if(patch.is_split)
      split(patch);
    return patch;
  }

private:
  void collect_stencils(const Optimization_state& state, Patch& patch)
  {
    patch.all_stencils = &state.stencils;
    if(state.stencils.empty())
      return;
    m_stencil_stamp.resize(state.stencils.size(), 0);
    for(std::size_t i = 0; i < patch.vertices.size(); ++i)
      if(patch.is_free[i])
        state.stencils.for_each_at(patch.vertices[i], [&](int s) {
          if(m_stencil_stamp[s] == m_stamp)
            return;
          m_stencil_stamp[s] = m_stamp;
          const Stencil_set::Stencil& stencil = state.stencils[s];
          Patch::Stencil local{s, stencil.size, {}, false};
          for(int j = 0; j < stencil.size; ++j)
          {
            const int v = stencil.vertices[j];
            const bool is_inside = m_vertex_stamp[v] == m_stamp;
            local.is_shared =
              local.is_shared || (state.is_free[v] && !(is_inside && patch.is_free[m_local[v]]));
            local.vertices[j] = is_inside ? m_local[v] : ~int(patch.outside_points.size());
            if(!is_inside)
              patch.outside_points.push_back(state.vertices[v].position);
          }
          patch.stencils.push_back(local);
        });
  }

  // all faces of a vertex that slides in the patch are in it, and so are its neighbours
  void collect_sliding(const Optimization_state& state, Patch& patch) const
  {
    patch.lines = &state.lines;
    if(state.line_neighbours.empty())
      return;
    for(std::size_t i = 0; i < patch.vertices.size(); ++i)
    {
      const std::array<int, 2>& next_to = state.line_neighbours[patch.vertices[i]];
      if(!patch.is_free[i] || next_to[0] < 0)
        continue;
      if(patch.line_neighbours.empty())
        patch.line_neighbours.assign(patch.vertices.size(), {{-1, -1}});
      patch.line_neighbours[i] = {{m_local[next_to[0]], m_local[next_to[1]]}};
    }
  }

  static void split(Patch& patch)
  {
    const std::vector<Vector_3> points = patch.positions();
    const auto split_polygon = [&](int f) { return split_flat(patch.polygons, points, f); };
    patch.split = split_mesh(patch.polygons, split_polygon, [&](int f) {
      if(patch.split_polygon.empty() || patch.split_polygon.back() != f)
        patch.first_triangle.push_back(int(patch.split_polygon.size()));
      patch.split_polygon.push_back(f);
    });
  }

  // along the shorter diagonal, unless a quad that is not convex would be folded by it
  static std::vector<std::array<int, 3>>
  split_flat(const Indexed_mesh& mesh, const std::vector<Vector_3>& points, int f)
  {
    std::vector<std::array<int, 3>> triangles = split_face(mesh, points, f);
    if(triangles.size() == 1)
      return triangles;
    const auto normal = [&](const std::array<int, 3>& t) {
      const Vector_3& o = points[mesh.corner_vertex[t[0]]];
      const Vector_3 a = points[mesh.corner_vertex[t[1]]] - o;
      return Vector_3(a.cross(points[mesh.corner_vertex[t[2]]] - o));
    };
    if(normal(triangles[0]).dot(normal(triangles[1])) < 0)
    {
      const int c = mesh.face_begin[f];
      const bool was_first = triangles[0][2] == c + 2;
      triangles = was_first ? decltype(triangles){{{c, c + 1, c + 3}}, {{c + 1, c + 2, c + 3}}}
                            : decltype(triangles){{{c, c + 1, c + 2}}, {{c, c + 2, c + 3}}};
    }
    return triangles;
  }

  std::vector<int> m_face_stamp, m_vertex_stamp, m_local;
  std::vector<int> m_local_corner; // per face: its first corner in the patch
  std::vector<int> m_stencil_stamp;
  int m_stamp = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_PATCH_H
