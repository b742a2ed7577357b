// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_INDEXED_MESH_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_INDEXED_MESH_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/support/for_each_block.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

typedef Eigen::Vector2d Vector_2;
typedef Eigen::Vector3d Vector_3;

// Fans of more faces than this are not traversed for each of their faces: that would take quadratic time.
constexpr int largest_small_valence = 64;

// A polygon mesh in plain arrays. A corner is a face's vertex and at the same time the half-edge
// from it to the face's next vertex; the corners of a face are consecutive.
class Indexed_mesh
{
public:
  std::vector<int> face_begin;    // first corner of each face, and the number of corners at the end
  std::vector<int> corner_vertex; // per corner
  std::vector<int> corner_face;   // per corner
  std::vector<int> opposite;      // per corner, -1 at the border
  std::vector<int> vertex_begin;  // first entry of each vertex in vertex_corners
  std::vector<int> vertex_corners; // corners at each vertex, ascending
  std::vector<char> is_border_vertex;
  bool has_border() const
  {
    return std::find(is_border_vertex.begin(), is_border_vertex.end(), 1) != is_border_vertex.end();
  }

  Indexed_mesh() = default;

  // faces are given by face_begin and corner_vertex; edges that are not manifold are refused
  template <typename ConcurrencyTag = CGAL::Sequential_tag>
  Indexed_mesh(std::vector<int> begins,
               std::vector<int> vertices,
               int number_of_vertices,
               const ConcurrencyTag& = ConcurrencyTag())
    : face_begin(std::move(begins)),
      corner_vertex(std::move(vertices))
  {
    collect_corners(number_of_vertices);
    match_opposites<ConcurrencyTag>();
    mark_border_vertices();
  }

  // the same for a part of a mesh whose opposite corners are known
  Indexed_mesh(std::vector<int> begins,
               std::vector<int> vertices,
               std::vector<int> opposites,
               int number_of_vertices)
    : face_begin(std::move(begins)),
      corner_vertex(std::move(vertices)),
      opposite(std::move(opposites))
  {
    collect_corners(number_of_vertices);
    mark_border_vertices();
  }

  int number_of_faces() const { return int(face_begin.size()) - 1; }
  int number_of_vertices() const { return int(vertex_begin.size()) - 1; }
  int number_of_corners() const { return int(corner_vertex.size()); }
  int degree(int f) const { return face_begin[f + 1] - face_begin[f]; }

  int next(int c) const
  {
    const int f = corner_face[c];
    return c + 1 < face_begin[f + 1] ? c + 1 : face_begin[f];
  }
  int previous(int c) const
  {
    const int f = corner_face[c];
    return c > face_begin[f] ? c - 1 : face_begin[f + 1] - 1;
  }
  int source(int c) const { return corner_vertex[c]; }
  int target(int c) const { return corner_vertex[next(c)]; }

  int valence(int v) const { return vertex_begin[v + 1] - vertex_begin[v]; } // faces at a vertex
  bool is_isolated(int v) const { return valence(v) == 0; }
  // a face with the vertex, which must have one, and with both of an edge, -1 if there is none
  int face_at(int v) const { return corner_face[vertex_corners[vertex_begin[v]]]; }
  int face_at(int v, int w) const
  {
    if(valence(w) < valence(v))
      std::swap(v, w);
    for(int k = vertex_begin[v]; k < vertex_begin[v + 1]; ++k)
    {
      const int c = vertex_corners[k];
      if(target(c) == w || source(previous(c)) == w)
        return corner_face[c];
    }
    return -1;
  }

  // the first vertex whose faces do not form one fan, or -1
  template <typename ConcurrencyTag = CGAL::Sequential_tag>
  int find_nonmanifold_vertex() const
  {
    return find_first<ConcurrencyTag>(number_of_vertices(), [&](int v) { return !is_fan(v); });
  }

private:
  // the first index below n for which predicate(i) is true, or -1
  template <typename ConcurrencyTag, typename Predicate>
  static int find_first(int n, const Predicate& predicate)
  {
    std::atomic<int> first(n);
    for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
      int i = begin;
      while(i < end && !predicate(i))
        ++i;
      int known = first;
      while(i < end && i < known && !first.compare_exchange_weak(known, i))
        ;
    });
    return first < n ? int(first) : -1;
  }

  // whether the faces at a vertex form one fan
  bool is_fan(int v) const
  {
    const int degree = valence(v);
    if(degree == 0)
      return true;
    const int start = vertex_corners[vertex_begin[v]];
    int count = 1, c = start;
    for(int o = opposite[previous(c)]; o >= 0; o = opposite[previous(c)])
    {
      if(o == start)
        return count == degree;
      c = o;
      if(++count > degree)
        return false;
    }
    c = start;
    while(opposite[c] >= 0)
    {
      c = next(opposite[c]);
      if(++count > degree)
        return false;
    }
    return count == degree;
  }

  void collect_corners(int number_of_vertices)
  {
    corner_face.resize(corner_vertex.size());
    for(int f = 0; f < number_of_faces(); ++f)
      for(int c = face_begin[f]; c < face_begin[f + 1]; ++c)
        corner_face[c] = f;
    vertex_begin.assign(number_of_vertices + 1, 0);
    for(const int v : corner_vertex)
      ++vertex_begin[v + 1];
    for(int v = 0; v < number_of_vertices; ++v)
      vertex_begin[v + 1] += vertex_begin[v];
    vertex_corners.resize(corner_vertex.size());
    std::vector<int> cursor(vertex_begin.begin(), vertex_begin.end() - 1);
    for(int c = 0; c < int(corner_vertex.size()); ++c)
      vertex_corners[cursor[corner_vertex[c]]++] = c;
  }

  template <typename ConcurrencyTag>
  void match_opposites()
  {
    const int n = int(corner_vertex.size());
    std::vector<int> targets(n);
    for(int c = 0; c < n; ++c)
      targets[c] = target(c);
    opposite.assign(n, -1);
    const int refused = find_first<ConcurrencyTag>(n, [&](int c) {
      const int s = source(c), t = targets[c];
      // an edge is searched for at the end of smaller valence, as large fans would take long
      const bool searches_target = valence(t) < valence(s);
      const int v = searches_target ? t : s;
      int matches = 0, duplicates = 0;
      for(int k = vertex_begin[v]; k < vertex_begin[v + 1]; ++k)
      {
        const int outgoing = vertex_corners[k], incoming = previous(outgoing);
        const int match = searches_target ? outgoing : incoming,
                  duplicate = searches_target ? incoming : outgoing;
        if(source(match) == t && targets[match] == s)
        {
          opposite[c] = match;
          ++matches;
        }
        duplicates += source(duplicate) == s && targets[duplicate] == t;
      }
      return s == t || matches > 1 || duplicates > 1;
    });
    if(refused >= 0)
      refuse(refused);
  }

  void refuse(int c) const
  {
    const int s = source(c), t = target(c);
    const std::string face = std::to_string(corner_face[c]);
    if(s == t)
      throw Invalid_input("face " + face + " has an edge from vertex " + std::to_string(s) +
                          " to itself");
    throw Invalid_input("the edge between vertices " + std::to_string(s) + " and " +
                        std::to_string(t) + " (face " + face + ") is not manifold");
  }

  void mark_border_vertices()
  {
    is_border_vertex.assign(number_of_vertices(), 0);
    for(int c = 0; c < number_of_corners(); ++c)
      if(opposite[c] < 0)
        is_border_vertex[source(c)] = is_border_vertex[target(c)] = 1;
  }
};

// vector area of a face: half the sum of the cross products around it
inline Vector_3
face_vector_area(const Indexed_mesh& mesh, const std::vector<Vector_3>& points, int f)
{
  const int begin = mesh.face_begin[f], degree = mesh.degree(f);
  const Vector_3& o = points[mesh.corner_vertex[begin]];
  Vector_3 sum = Vector_3::Zero();
  for(int i = 1; i + 1 < degree; ++i)
    sum += (points[mesh.corner_vertex[begin + i]] - o)
             .cross(points[mesh.corner_vertex[begin + i + 1]] - o);
  return 0.5 * sum;
}

inline double mean_edge_length(const Indexed_mesh& mesh, const std::vector<Vector_3>& points)
{
  double sum = 0;
  std::size_t count = 0;
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(mesh.opposite[c] < c)
    {
      sum += (points[mesh.source(c)] - points[mesh.target(c)]).norm();
      ++count;
    }
  return count == 0 ? 0 : sum / double(count);
}

// the mean length of the edges at a vertex; `point(v)` is the position of one
template <typename PointAccess>
double mean_edge_length_at(const Indexed_mesh& mesh, const PointAccess& point, int v)
{
  const int begin = mesh.vertex_begin[v], end = mesh.vertex_begin[v + 1];
  double sum = 0;
  for(int k = begin; k < end; ++k)
    sum += (point(mesh.target(mesh.vertex_corners[k])) - point(v)).norm();
  return begin < end ? sum / (end - begin) : 0;
}

inline double surface_area(const Indexed_mesh& mesh, const std::vector<Vector_3>& points)
{
  double sum = 0;
  for(int f = 0; f < mesh.number_of_faces(); ++f)
    sum += face_vector_area(mesh, points, f).norm();
  return sum;
}

// vertices without faces are ignored in these
inline Eigen::AlignedBox3d bounding_box(const Indexed_mesh& mesh,
                                        const std::vector<Vector_3>& points)
{
  Eigen::AlignedBox3d box;
  for(const int v : mesh.corner_vertex)
    box.extend(points[v]);
  return box;
}
inline double bounding_box_diagonal(const Indexed_mesh& mesh, const std::vector<Vector_3>& points)
{
  return mesh.corner_vertex.empty() ? 0 : bounding_box(mesh, points).diagonal().norm();
}

// whether fourth powers of lengths, those of small edges too, stay in the range of double
inline bool is_safe_diagonal(double diagonal) { return diagonal > 1e-60 && diagonal < 1e60; }

// `point(v)` is the position of a vertex
template <typename PointAccess>
double largest_coordinate(const Indexed_mesh& mesh, const PointAccess& point)
{
  double largest = 0;
  for(const int v : mesh.corner_vertex)
    largest = (std::max)(largest, point(v).cwiseAbs().maxCoeff());
  return largest;
}

// The corners of face f, split into triangles; quads along their shorter diagonal, unless that leaves
// triangles without area, as where opposite vertices coincide, and the other does not.
template <typename PointAccess>
std::vector<std::array<int, 3>>
split_face(const Indexed_mesh& mesh, const PointAccess& point, int f)
{
  typedef std::vector<std::array<int, 3>> Triangles;
  const int c = mesh.face_begin[f];
  if(mesh.degree(f) == 3)
    return {{{c, c + 1, c + 2}}};
  const auto at = [&](int i) -> const Vector_3& { return point(mesh.corner_vertex[i]); };
  const auto area = [&](const Triangles& triangles) {
    double sum = 0;
    for(const std::array<int, 3>& t : triangles)
      sum += (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).norm();
    return sum;
  };
  Triangles shorter = {{{c, c + 1, c + 2}}, {{c, c + 2, c + 3}}},
            longer = {{{c, c + 1, c + 3}}, {{c + 1, c + 2, c + 3}}};
  if((at(c) - at(c + 2)).squaredNorm() > (at(c + 1) - at(c + 3)).squaredNorm())
    shorter.swap(longer);
  const double rounding = 1e-12;
  return area(shorter) < rounding * area(longer) ? longer : shorter;
}

inline std::vector<std::array<int, 3>>
split_face(const Indexed_mesh& mesh, const std::vector<Vector_3>& points, int f)
{
  return split_face(
    mesh, [&](int v) -> const Vector_3& { return points[v]; }, f);
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_INDEXED_MESH_H
