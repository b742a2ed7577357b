// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_INDEXED_TRIANGLE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_INDEXED_TRIANGLE_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A triangle of a face, with the indices of its vertices.
struct Indexed_triangle
{
  int face;
  std::array<int, 3> vertices;
  std::array<Vector_3, 3> points;
  Eigen::AlignedBox3d box;
  Vector_3 normal;
  double rounding; // of its components

  // Whether the plane of this triangle separates it from the vertices of another that are not its own, in spite
  // of rounding. Most neighbours are on one side.
  bool has_on_one_side(const Indexed_triangle& other) const
  {
    bool is_above = true, is_below = true;
    for(int i = 0; i < 3; ++i)
    {
      if(std::find(vertices.begin(), vertices.end(), other.vertices[i]) != vertices.end())
        continue;
      const Vector_3 d = other.points[i] - points[0];
      const double height = normal.dot(d), error = rounding * d.cwiseAbs().maxCoeff();
      is_above = is_above && height > error;
      is_below = is_below && height < -error;
    }
    return is_above || is_below;
  }
};

// Appends the triangles into which a face is split, its vertices at point(v), but for those without area.
template <typename PointAccess>
void append_triangles(const Indexed_mesh& mesh,
                      const PointAccess& point,
                      int f,
                      std::vector<Indexed_triangle>& triangles)
{
  typedef CGAL::Exact_predicates_inexact_constructions_kernel::Point_3 Point;
  const auto add = [&](const std::array<int, 3>& corners) {
    Indexed_triangle t{f, {}, {}, {}, {}, 0};
    for(int i = 0; i < 3; ++i)
    {
      t.vertices[i] = mesh.corner_vertex[corners[i]];
      t.points[i] = point(t.vertices[i]);
      t.box.extend(t.points[i]);
    }
    const auto &p = t.points[0], &q = t.points[1], &r = t.points[2];
    t.normal = (q - p).cross(r - p);
    const double size = t.box.sizes().maxCoeff(), factor = 1e-14;
    t.rounding = factor * size * size;
    if(t.normal.cwiseAbs().maxCoeff() > t.rounding ||
       !CGAL::collinear(Point(p.x(), p.y(), p.z()), Point(q.x(), q.y(), q.z()),
                        Point(r.x(), r.y(), r.z())))
      triangles.push_back(t);
  };
  const int c = mesh.face_begin[f];
  if(mesh.degree(f) == 3)
    return add({{c, c + 1, c + 2}});
  for(const std::array<int, 3>& corners : split_face(mesh, point, f))
    add(corners);
}

// those of several faces
template <typename PointAccess>
std::vector<Indexed_triangle>
triangles_of(const Indexed_mesh& mesh, const PointAccess& point, const std::vector<int>& faces)
{
  std::vector<Indexed_triangle> triangles;
  triangles.reserve(faces.size());
  for(const int f : faces)
    append_triangles(mesh, point, f, triangles);
  return triangles;
}

// Whether two triangles whose planes may coincide are separated within them, in spite of rounding: without this,
// predicates on flat regions are evaluated exactly. The first `common` vertices of both are the same.
inline bool
are_separated(const std::array<Vector_3, 3>& p, const std::array<Vector_3, 3>& q, int common)
{
  const double rounding = 1e-14;
  if(common == 0)
  {
    const auto is_apart = [&](const std::array<Vector_3, 3>& s, const std::array<Vector_3, 3>& t) {
      const Vector_3 normal = (s[1] - s[0]).cross(s[2] - s[0]);
      for(int i = 0; i < 3; ++i)
      {
        const Vector_3 axis = normal.cross(s[(i + 1) % 3] - s[i]); // s is above
        double lowest = 0, highest = -std::numeric_limits<double>::infinity(), size = 0;
        for(int j = 0; j < 3; ++j)
        {
          lowest = (std::min)(lowest, axis.dot(s[j] - s[i]));
          highest = (std::max)(highest, axis.dot(t[j] - s[i]));
          size = (std::max)({size, (s[j] - s[i]).norm(), (t[j] - s[i]).norm()});
        }
        if(lowest - highest > rounding * axis.norm() * size)
          return true;
      }
      return false;
    };
    return is_apart(p, q) || is_apart(q, p);
  }
  if(common == 1)
  {
    // the plane through the common vertex between the two bisectors
    const Vector_3 a = (p[1] - p[0]).normalized(), b = (p[2] - p[0]).normalized(),
                   c = (q[1] - q[0]).normalized(), d = (q[2] - q[0]).normalized(),
                   axis = (c + d).normalized() - (a + b).normalized();
    return (std::max)(axis.dot(a), axis.dot(b)) < -rounding &&
           (std::min)(axis.dot(c), axis.dot(d)) > rounding;
  }
  // on both sides of the common edge
  const Vector_3 edge = p[1] - p[0], u = p[2] - p[0], v = q[2] - q[0],
                 axis = edge.cross(u).cross(edge);
  return axis.dot(u) > rounding * axis.norm() * u.norm() &&
         axis.dot(v) < -rounding * axis.norm() * v.norm();
}

// whether two triangles intersect other than in a common vertex or edge, exactly
inline bool intersect(const Indexed_triangle& s, const Indexed_triangle& t)
{
  typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
  // the vertices of both, the common ones first
  std::array<int, 3> i, j;
  int common = 0, last_i = 3, last_j = 3;
  bool is_common_j[3] = {false, false, false};
  for(int k = 0; k < 3; ++k)
  {
    const int found =
      int(std::find(t.vertices.begin(), t.vertices.end(), s.vertices[k]) - t.vertices.begin());
    if(found == 3)
      i[--last_i] = k;
    else
    {
      i[common] = k;
      j[common++] = found;
      is_common_j[found] = true;
    }
  }
  if(common == 3)
    return true; // one lies on the other
  if(s.has_on_one_side(t) || t.has_on_one_side(s))
    return false;
  for(int k = 0; k < 3; ++k)
    if(!is_common_j[k])
      j[--last_j] = k;
  const std::array<Vector_3, 3> a = {s.points[i[0]], s.points[i[1]], s.points[i[2]]},
                                b = {t.points[j[0]], t.points[j[1]], t.points[j[2]]};
  if(are_separated(a, b, common))
    return false;
  const auto point = [](const Vector_3& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
  const Kernel::Point_3 p[3] = {point(a[0]), point(a[1]), point(a[2])},
                        q[3] = {point(b[0]), point(b[1]), point(b[2])};
  const Kernel::Triangle_3 first(p[0], p[1], p[2]), second(q[0], q[1], q[2]);
  if(common == 0)
    return CGAL::do_intersect(first, second);
  if(common == 1) // the side opposite to the common vertex meets the other triangle
    return CGAL::do_intersect(Kernel::Segment_3(p[1], p[2]), second) ||
           CGAL::do_intersect(Kernel::Segment_3(q[1], q[2]), first);
  return CGAL::coplanar(p[0], p[1], p[2], q[2]) &&
         CGAL::coplanar_orientation(p[0], p[1], p[2], q[2]) == CGAL::POSITIVE; // folded over
}

typedef CGAL::Box_intersection_d::Box_with_info_d<double, 3, const Indexed_triangle*> Triangle_box;

const std::ptrdiff_t box_intersection_cutoff =
  1000; // the fastest: 2.2 times as fast as its default

inline std::vector<Triangle_box> bounding_boxes(const std::vector<Indexed_triangle>& triangles)
{
  std::vector<Triangle_box> result;
  result.reserve(triangles.size());
  for(const Indexed_triangle& t : triangles)
  {
    Vector_3 low = t.box.min(), high = t.box.max();
    result.emplace_back(low.data(), high.data(), &t);
  }
  return result;
}

// Calls visit(s, t) for the pairs of triangles whose bounding boxes intersect; of the triangles of one set,
// or of a triangle of the first set and one of the second.
template <typename Visit>
void for_each_close_pair(const std::vector<Indexed_triangle>& triangles, const Visit& visit)
{
  std::vector<Triangle_box> boxes = bounding_boxes(triangles);
  CGAL::box_self_intersection_d(
    boxes.begin(), boxes.end(),
    [&](const Triangle_box& s, const Triangle_box& t) { visit(*s.info(), *t.info()); },
    box_intersection_cutoff);
}

template <typename Visit>
void for_each_close_pair(const std::vector<Indexed_triangle>& first,
                         const std::vector<Indexed_triangle>& second,
                         const Visit& visit)
{
  std::vector<Triangle_box> a = bounding_boxes(first), b = bounding_boxes(second);
  CGAL::box_intersection_d(
    a.begin(), a.end(), b.begin(), b.end(),
    [&](const Triangle_box& s, const Triangle_box& t) { visit(*s.info(), *t.info()); },
    box_intersection_cutoff);
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_INDEXED_TRIANGLE_H
