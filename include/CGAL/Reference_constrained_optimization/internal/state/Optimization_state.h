// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_OPTIMIZATION_STATE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_OPTIMIZATION_STATE_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/self_intersections.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/surface_metric.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Element_set.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Stencil_set.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Polyline_set.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Located_vertex.h>
#include <CGAL/Reference_constrained_optimization/internal/support/for_each_block.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// the pairs of faces that intersect, wherever they are
inline std::vector<std::pair<int, int>>
intersecting_faces(const Indexed_mesh& mesh, const std::vector<Located_vertex>& vertices)
{
  std::vector<Vector_3> points;
  for(const Located_vertex& v : vertices)
    points.push_back(v.position);
  return self_intersections(mesh, points);
}

// A number with an upper bound: that of the input, unless more are allowed.
struct Bounded_number
{
  static constexpr int unbounded = (std::numeric_limits<int>::max)() / 2;
  int largest = unbounded, now = 0;
  bool is_bounded() const { return largest < unbounded; }
  int allowance() const { return (std::max)(0, largest - now); }
};

// What the caller constrained.
struct Constraints
{
  std::vector<char> is_constrained; // per vertex: by itself
  std::vector<char> is_line;        // per corner: its edge is constrained or at the border
};

// The mesh on its reference, which movers read and accepted patches change.
struct Optimization_state
{
  const Indexed_mesh& mesh;
  const Reference_surface& reference;
  const Element_set& elements;
  std::vector<Located_vertex> vertices;
  std::vector<char> is_free;
  Polyline_set lines = {};
  // per vertex that slides: its two neighbours on its line in the mesh; else -1
  std::vector<std::array<int, 2>> line_neighbours = {};
  Stencil_set stencils = {};
  std::vector<char> is_in_range = {}; // per face of the mesh; empty if all are to be optimized
  // per triangle of R, whether it belongs to a mechanical part; per face of the mesh, whether its normal
  // deviation from R is bounded; per corner, whether its edge is smooth on input and must not become sharp;
  // empty if there are none
  std::vector<char> is_mechanical = {}, bounds_normal_deviation = {}, is_smooth = {};

  // The mean of the faces' smallest angles may not fall below that of the input if this is set; by how much
  // their sum exceeds it, in degrees.
  bool bounds_mean_angle = false;
  double angle_gain = 0;

  // The largest change of the volume of mechanical parts without a border, and the current one.
  double largest_volume_change = std::numeric_limits<double>::infinity();
  double volume_change = 0;
  bool bounds_volume() const { return std::isfinite(largest_volume_change); }

  // per corner: whether its edge is constrained, as feature lines are, or at the border; none if empty
  std::vector<char> is_line = {};
  bool is_on_line(int c) const { return !is_line.empty() && is_line[c]; }

  // of creases, without the edges of lines, and of pairs of faces that intersect
  struct Counts
  {
    Bounded_number creases, intersections;
  };
  Counts counts = {};

  // Per triangle of R, whether another sheet of R is near; none if empty. Then also the faces of the mesh that
  // are or were at such triangles, with their bounding boxes: only these are tested for intersections. A round
  // updates them, and so does whoever moves vertices between rounds.
  struct Boxed_face
  {
    int face;
    Eigen::AlignedBox3d box;
  };
  std::vector<char> is_near_sheet = {};
  std::vector<Boxed_face> faces_near_sheets = {};
  std::vector<int> near_sheet_index = {}; // per face of the mesh: where it is among them, or -1
  template <typename VertexAccess>
  bool is_near_sheets(const Indexed_mesh& faces, const VertexAccess& vertex, int f) const
  {
    for(int c = faces.face_begin[f]; c < faces.face_begin[f + 1]; ++c)
      if(is_near_sheet[vertex(faces.corner_vertex[c]).on_reference.face])
        return true;
    return false;
  }
  // those of a patch that are at such triangles before or after a step
  template <typename VertexBefore, typename VertexAfter>
  std::vector<int> faces_near_sheets_of(const Indexed_mesh& patch,
                                        const VertexBefore& before,
                                        const VertexAfter& after) const
  {
    std::vector<int> result;
    for(int f = 0; f < (is_near_sheet.empty() ? 0 : patch.number_of_faces()); ++f)
      if(is_near_sheets(patch, after, f) || is_near_sheets(patch, before, f))
        result.push_back(f);
    return result;
  }
  void set_near_sheets(std::vector<char> is_near)
  {
    is_near_sheet = std::move(is_near);
    faces_near_sheets.clear();
    near_sheet_index.assign(is_near_sheet.empty() ? 0 : mesh.number_of_faces(), -1);
    std::vector<int> all(near_sheet_index.size());
    std::iota(all.begin(), all.end(), 0);
    update_near_sheets(all);
  }
  // Tests faces where faces intersect now, too, and counts all pairs again.
  void watch_intersections()
  {
    const std::vector<std::pair<int, int>> pairs = intersecting_faces(mesh, vertices);
    counts.intersections.now = int(pairs.size());
    if(pairs.empty())
      return;
    std::vector<char> is_near = std::move(is_near_sheet);
    is_near.resize(reference.mesh().number_of_faces(), 0);
    for(const std::pair<int, int>& pair : pairs)
      for(const int f : {pair.first, pair.second})
        for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
          is_near[vertices[mesh.corner_vertex[c]].on_reference.face] = 1;
    set_near_sheets(std::move(is_near));
  }
  // after vertices of these faces have moved
  void update_near_sheets(const std::vector<int>& moved)
  {
    if(is_near_sheet.empty())
      return;
    for(const int f : moved)
    {
      int& index = near_sheet_index[f];
      if(index < 0 && !is_near_sheets(
                        mesh, [&](int v) -> const Located_vertex& { return vertices[v]; }, f))
        continue;
      if(index < 0)
      {
        index = int(faces_near_sheets.size());
        faces_near_sheets.push_back({f, {}});
      }
      Eigen::AlignedBox3d& box = faces_near_sheets[index].box;
      box.setEmpty();
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        box.extend(vertices[mesh.corner_vertex[c]].position);
    }
  }

  bool is_optimized(int f) const { return is_in_range.empty() || is_in_range[f]; }

  // nothing is required of faces that are not optimized
  bool has_optimized_face(int v) const
  {
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
      if(is_optimized(mesh.corner_face[mesh.vertex_corners[k]]))
        return true;
    return false;
  }
};

// Whether a face is inverted with respect to R, whether a quad is not convex as seen along R's normals, and
// whether an edge is folded, for vertices given by a function `vertex(v)` that returns a Located_vertex.
// Degenerate faces count in none.
template <typename VertexAccess>
Vector_3 face_normal(const Indexed_mesh& mesh, const VertexAccess& vertex, int f)
{
  const int begin = mesh.face_begin[f], end = mesh.face_begin[f + 1];
  const Vector_3& o = vertex(mesh.corner_vertex[begin]).position;
  Vector_3 n = Vector_3::Zero();
  for(int c = begin + 1; c + 1 < end; ++c)
    n += (vertex(mesh.corner_vertex[c]).position - o)
           .cross(vertex(mesh.corner_vertex[c + 1]).position - o);
  return n;
}

// six times the volume of the cone over a face
template <typename VertexAccess>
double face_volume(const Indexed_mesh& mesh,
                   const VertexAccess& vertex,
                   int f,
                   const Vector_3& normal,
                   const Vector_3& apex)
{
  return normal.dot(vertex(mesh.corner_vertex[mesh.face_begin[f]]).position - apex);
}

template <typename VertexAccess>
bool is_flipped(const Indexed_mesh& mesh, const VertexAccess& vertex, int f, const Vector_3& normal)
{
  Vector_3 sum = Vector_3::Zero();
  for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
    sum += vertex(mesh.corner_vertex[c]).normal;
  return normal.dot(sum) < 0;
}

template <typename VertexAccess>
bool is_nonconvex(const Indexed_mesh& mesh, const VertexAccess& vertex, int f)
{
  if(mesh.degree(f) == 3)
    return false;
  for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
  {
    const Located_vertex &before = vertex(mesh.source(mesh.previous(c))),
                         &here = vertex(mesh.source(c)), &after = vertex(mesh.target(c));
    const Vector_3 normal = (after.position - here.position).cross(before.position - here.position);
    if(normal.dot(before.normal + here.normal + after.normal) < 0)
      return true;
  }
  return false;
}

inline bool is_folded(const Vector_3& normal_a, const Vector_3& normal_b)
{
  return normal_a.dot(normal_b) < -0.5 * normal_a.norm() * normal_b.norm();
}

// Beyond 90 degrees; right angles are no creases, whatever their rounding.
inline bool is_crease(const Vector_3& normal_a, const Vector_3& normal_b)
{
  const double squared_rounding = 1e-12, product = normal_a.dot(normal_b);
  return product < 0 &&
         product * product > squared_rounding * normal_a.squaredNorm() * normal_b.squaredNorm();
}

// Jacobian of one element on the surface
template <typename VertexAccess>
Eigen::Matrix2d element_jacobian(const Element_set::Element& element, const VertexAccess& vertex)
{
  const Located_vertex &a = vertex(element.vertices[0]), &b = vertex(element.vertices[1]),
                       &c = vertex(element.vertices[2]);
  const Eigen::Matrix2d S =
    signed_shape(a.position, b.position, c.position, a.normal + b.normal + c.normal);
  const auto& R = element.rest_inverse;
  // S is upper triangular; entry by entry, since vector loads would stall on the entries just stored
  Eigen::Matrix2d J;
  J(0, 0) = S(0, 0) * R(0, 0) + S(0, 1) * R(1, 0);
  J(1, 0) = S(1, 1) * R(1, 0);
  J(0, 1) = S(0, 0) * R(0, 1) + S(0, 1) * R(1, 1);
  J(1, 1) = S(1, 1) * R(1, 1);
  return J;
}

// density of one element on the surface
template <typename Density, typename VertexAccess>
double element_energy(const Density& density,
                      const Element_set::Element& element,
                      const VertexAccess& vertex)
{
  return element_value(density, element, element_jacobian(element, vertex), 0);
}

// cosine of the smallest angle of a triangle, given by its three vertices; 1 if a side has no length
template <typename VertexAccess>
double smallest_angle_cosine(const int* corners, const VertexAccess& vertex)
{
  Vector_3 sides[3]; // from each vertex to the next
  double lengths[3];
  for(int i = 0; i < 3; ++i)
  {
    sides[i] = vertex(corners[(i + 1) % 3]).position - vertex(corners[i]).position;
    lengths[i] = sides[i].norm();
  }
  double largest = -1;
  for(int i = 0; i < 3; ++i)
  {
    const int before = (i + 2) % 3;
    const double product = lengths[i] * lengths[before];
    largest = (std::max)(largest, product > 0 ? -sides[i].dot(sides[before]) / product : 1.);
  }
  return largest;
}

// The same for a face; -1 for quads, whose angles are not bounded.
template <typename VertexAccess>
double smallest_angle_cosine(const Indexed_mesh& mesh, const VertexAccess& vertex, int f)
{
  return mesh.degree(f) == 3
           ? smallest_angle_cosine(&mesh.corner_vertex[mesh.face_begin[f]], vertex)
           : -1;
}

// six times the volume of the mechanical parts of a mesh
inline double volume_of_mechanical_parts(const Optimization_state& state)
{
  const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
  double sum = 0;
  for(int f = 0; f < int(state.bounds_normal_deviation.size()); ++f)
    if(state.bounds_normal_deviation[f])
      sum += face_volume(state.mesh, vertex, f, face_normal(state.mesh, vertex, f),
                         state.vertices[state.mesh.corner_vertex[0]].position);
  return sum;
}

inline double energy_of_stencils(const Optimization_state& state)
{
  return state.stencils.sum_at(
    [&](int v) -> const Vector_3& { return state.vertices[v].position; });
}

// Measures of the whole mesh. Sums run in the order of the faces, block by block.
struct Global_measure
{
  double energy = 0;          // sum of densities and stencils
  double capped_energy = 0;   // the same with each density capped
  double largest_density = 0; // largest density of the elements that are not inverted
  double largest_cosine = -1; // largest cosine of an angle of a triangle with an element
  std::size_t flips = 0, fold_edges = 0, nonconvex_quads = 0;
  std::size_t defects() const { return flips + fold_edges + nonconvex_quads; }
};

template <typename ConcurrencyTag, typename Density>
Global_measure measure(const Optimization_state& state, const Density& density, double cap)
{
  const Indexed_mesh& mesh = state.mesh;
  const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
  const int n = mesh.number_of_faces();
  std::vector<Vector_3> normals(n);
  for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
    for(int f = begin; f < end; ++f)
      normals[f] = face_normal(mesh, vertex, f);
  });
  std::vector<Global_measure> blocks(number_of_blocks(n));
  for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int block) {
    Global_measure& m = blocks[block];
    for(int f = begin; f < end; ++f)
    {
      m.flips += is_flipped(mesh, vertex, f, normals[f]);
      m.nonconvex_quads += is_nonconvex(mesh, vertex, f);
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        m.fold_edges += mesh.opposite[c] > c &&
                        is_folded(normals[f], normals[mesh.corner_face[mesh.opposite[c]]]);
      for(int e = state.elements.begin(f); e < state.elements.end(f); ++e)
      {
        const Eigen::Matrix2d J = element_jacobian(state.elements[e], vertex);
        const double d = element_value(density, state.elements[e], J, 0);
        m.energy += d;
        m.capped_energy += (std::min)(d, cap);
        if(J.determinant() > 0)
          m.largest_density = (std::max)(m.largest_density, d);
      }
      if(state.elements.begin(f) < state.elements.end(f))
        m.largest_cosine = (std::max)(m.largest_cosine, smallest_angle_cosine(mesh, vertex, f));
    }
  });
  Global_measure sum;
  for(const Global_measure& m : blocks)
  {
    sum.energy += m.energy;
    sum.capped_energy += m.capped_energy;
    sum.largest_density = (std::max)(sum.largest_density, m.largest_density);
    sum.largest_cosine = (std::max)(sum.largest_cosine, m.largest_cosine);
    sum.flips += m.flips;
    sum.fold_edges += m.fold_edges;
    sum.nonconvex_quads += m.nonconvex_quads;
  }
  if(!state.stencils.empty())
  {
    const double stencils = energy_of_stencils(state);
    sum.energy += stencils;
    sum.capped_energy += stencils;
  }
  return sum;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_OPTIMIZATION_STATE_H
