// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Meshes made by formulas, and measures of them.

#pragma once

#include "Random.h"

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace rco_test {

namespace RCO = CGAL::Reference_constrained_optimization;
namespace internal = RCO::internal;
using internal::Indexed_mesh;

// into which triangles the quads of a grid are split
enum class Diagonals { none, first, second, alternating };

// A polygon mesh as points and faces.
struct Shape
{
  std::vector<Vector_3> points;
  std::vector<std::vector<int>> faces;

  int add(double x, double y, double z)
  {
    points.push_back(Vector_3(x, y, z));
    return int(points.size()) - 1;
  }
  void triangle(int a, int b, int c) { faces.push_back({a, b, c}); }
  // a quad, split along its first diagonal or its second
  void quad(int a, int b, int c, int d, bool second = false)
  {
    triangle(a, b, second ? d : c);
    second ? triangle(b, c, d) : triangle(a, c, d);
  }
  // quads with the vertices at(i, j)
  template <typename At>
  void grid(int columns, int rows, Diagonals diagonals, const At& at)
  {
    for(int j = 0; j < rows; ++j)
      for(int i = 0; i < columns; ++i)
        if(diagonals == Diagonals::none)
          faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        else
          quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1),
               diagonals == Diagonals::second ||
                 (diagonals == Diagonals::alternating && (i + j) % 2 == 1));
  }
};

inline Indexed_mesh indexed(const Shape& shape)
{
  std::vector<int> begins(1, 0), corners;
  for(const std::vector<int>& f : shape.faces)
  {
    corners.insert(corners.end(), f.begin(), f.end());
    begins.push_back(int(corners.size()));
  }
  return Indexed_mesh(begins, corners, int(shape.points.size()));
}

inline CGAL::Reference_constrained_optimization::internal::Mesh_copy copy_of(const Shape& shape)
{
  return {indexed(shape), shape.points};
}

// A grid with the vertices point(i, j). In a direction in which it is closed the last column or row is
// the first one.
template <typename Point>
Shape grid(int columns,
           int rows,
           Diagonals diagonals,
           const Point& point,
           bool closes_columns = false,
           bool closes_rows = false)
{
  Shape s;
  const int nx = closes_columns ? columns : columns + 1, ny = closes_rows ? rows : rows + 1;
  for(int j = 0; j < ny; ++j)
    for(int i = 0; i < nx; ++i)
      s.points.push_back(point(i, j));
  s.grid(columns, rows, diagonals, [&](int i, int j) { return (j % ny) * nx + i % nx; });
  return s;
}

inline Diagonals alternating_unless(bool quads)
{
  return quads ? Diagonals::none : Diagonals::alternating;
}

// nx times ny squares in the xy-plane, split along alternating diagonals (or not at all)
inline Shape plane_grid(int nx, int ny, double length = 1, bool quads = false)
{
  return grid(nx, ny, alternating_unless(quads),
              [&](int i, int j) { return Vector_3(length * i / nx, length * j / nx, 0); });
}

// a rhombus of equilateral triangles
inline Shape equilateral_grid(int nx, int ny, double edge = 1)
{
  return grid(nx, ny, Diagonals::second, [&](int i, int j) {
    return Vector_3(edge * (i + 0.5 * j), edge * 0.5 * std::sqrt(3.) * j, 0);
  });
}

// A strip of triangles around the z-axis: radius and height as functions of the row. `turn` is the
// angle that it covers; all round, the last column is the first. Squares are split or not.
inline Shape revolved(int columns,
                      int rows,
                      const std::function<double(double)>& radius,
                      const std::function<double(double)>& height,
                      double turn = 2 * pi,
                      bool quads = false)
{
  const auto point = [&](int i, int j) {
    const double r = radius(double(j) / rows), a = turn * i / columns;
    return Vector_3(r * std::cos(a), r * std::sin(a), height(double(j) / rows));
  };
  return grid(columns, rows, alternating_unless(quads), point, std::abs(turn - 2 * pi) < 1e-12);
}

inline Shape cylinder(
  int columns, int rows, double radius, double height, double turn = 2 * pi, bool quads = false)
{
  return revolved(
    columns, rows, [=](double) { return radius; }, [=](double t) { return height * t; }, turn,
    quads);
}

// part of a circular cone whose sides make `half_angle` with the axis
inline Shape cone(
  int columns, int rows, double half_angle, double from = 0.2, double to = 1, double turn = 2 * pi)
{
  return revolved(
    columns, rows, [=](double t) { return (to + t * (from - to)) * std::sin(half_angle); },
    [=](double t) { return -(to + t * (from - to)) * std::cos(half_angle); }, turn);
}

// fans that close the two ends of an open cylinder of `columns` columns
inline Shape closed_cylinder(int columns, int rows, double radius, double height)
{
  Shape s = cylinder(columns, rows, radius, height);
  const int bottom = s.add(0, 0, 0), top = s.add(0, 0, height);
  for(int i = 0; i < columns; ++i)
  {
    const int j = (i + 1) % columns;
    s.triangle(j, i, bottom);
    s.triangle(rows * columns + i, rows * columns + j, top);
  }
  return s;
}

// a tube with a wall
inline Shape sleeve(int columns, int rows, double radius, double wall, double height)
{
  const int rings = 2 * (rows + 1);
  const auto point = [&](int i, int j) {
    const bool is_outside = j <= rows;
    const double r = is_outside ? radius : radius - wall, a = 2 * pi * i / columns;
    return Vector_3(r * std::cos(a), r * std::sin(a),
                    height * (is_outside ? j : rings - 1 - j) / rows);
  };
  return grid(columns, rings, Diagonals::first, point, true, true);
}

// in the xy-plane, border outside and inside
inline Shape annulus(int columns, int rows, double inner = 0.5)
{
  return revolved(
    columns, rows, [=](double t) { return 1 - t * (1 - inner); }, [](double) { return 0.; });
}

// A flat spiral ramp: a ring of radii 1 and 2 that turns more often than once and rises slowly.
inline Shape ramp(int columns, int rows, double turns, double rise = 0.05)
{
  Shape s = revolved(
    columns, rows, [](double t) { return 2 - t; }, [](double) { return 0.; }, 2 * pi * turns);
  for(int j = 0; j <= rows; ++j)
    for(int i = 0; i <= columns; ++i)
      s.points[j * (columns + 1) + i].z() = rise * turns * i / columns;
  return s;
}

inline Shape torus(int columns, int rows, double big = 1, double small = 0.4, bool quads = false)
{
  const auto point = [&](int i, int j) {
    const double a = 2 * pi * i / columns, b = 2 * pi * j / rows;
    const double r = big + small * std::cos(b);
    return Vector_3(r * std::cos(a), r * std::sin(a), small * std::sin(b));
  };
  return grid(columns, rows, alternating_unless(quads), point, true, true);
}

inline Shape tetrahedron()
{
  return {{Vector_3(1, 1, 1), Vector_3(-1, -1, 1), Vector_3(-1, 1, -1), Vector_3(1, -1, -1)},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

inline Shape octahedron()
{
  Shape s;
  for(int i = 0; i < 3; ++i)
    for(const double x : {1., -1.})
      s.add(i == 0 ? x : 0, i == 1 ? x : 0, i == 2 ? x : 0);
  for(const int x : {0, 1})
    for(const int y : {2, 3})
      for(const int z : {4, 5})
        (x + y + z) % 2 == 0 ? s.triangle(x, y, z) : s.triangle(x, z, y);
  return s;
}

// every triangle split into four, the new vertices in the middle of edges
inline Shape split_in_four(Shape s)
{
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto inserted = middles.insert({std::minmax(a, b), int(s.points.size())});
    if(inserted.second)
      s.points.push_back((s.points[a] + s.points[b]) / 2);
    return inserted.first->second;
  };
  const std::vector<std::vector<int>> faces = std::move(s.faces);
  s.faces.clear();
  for(const std::vector<int>& f : faces)
  {
    const int a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
    s.triangle(f[0], a, c);
    s.triangle(f[1], b, a);
    s.triangle(f[2], c, b);
    s.triangle(a, b, c);
  }
  return s;
}

// the same `levels` times, with the vertices on the unit sphere
inline Shape split_on_sphere(Shape s, int levels)
{
  for(int l = 0; l < levels; ++l)
  {
    s = split_in_four(std::move(s));
    for(Vector_3& p : s.points)
      p.normalize();
  }
  return s;
}

// the unit sphere: an icosahedron split `levels` times
inline Shape icosphere(int levels)
{
  Shape s;
  const double g = 0.5 * (1 + std::sqrt(5.));
  for(const double a : {-1., 1.})
    for(const double b : {-g, g})
    {
      s.add(a, b, 0);
      s.add(0, a, b);
      s.add(b, 0, a);
    }
  // faces: triples at distance 2 of one another, oriented outwards
  for(int i = 0; i < 12; ++i)
    for(int j = i + 1; j < 12; ++j)
      for(int k = j + 1; k < 12; ++k)
      {
        const auto near = [&](int a, int b) {
          return std::abs((s.points[a] - s.points[b]).norm() - 2) < 1e-9;
        };
        if(!near(i, j) || !near(j, k) || !near(i, k))
          continue;
        const bool out = s.points[i].cross(s.points[j]).dot(s.points[k]) > 0;
        s.triangle(i, out ? j : k, out ? k : j);
      }
  for(Vector_3& p : s.points)
    p.normalize();
  return split_on_sphere(std::move(s), levels);
}

// a cube of n times n squares a side, split or not
inline Shape cube(int n, bool quads = false)
{
  Shape s;
  std::map<std::array<int, 3>, int> index;
  const auto vertex = [&](const std::array<int, 3>& p) {
    const auto inserted = index.insert({p, 0});
    if(inserted.second)
      inserted.first->second = s.add(double(p[0]) / n, double(p[1]) / n, double(p[2]) / n);
    return inserted.first->second;
  };
  for(int axis = 0; axis < 3; ++axis)
    for(const bool high : {false, true})
      for(int i = 0; i < n; ++i)
        for(int j = 0; j < n; ++j)
        {
          const auto at = [&](int di, int dj) {
            std::array<int, 3> p;
            p[axis] = high ? n : 0;
            p[(axis + 1) % 3] = i + di;
            p[(axis + 2) % 3] = j + dj;
            return vertex(p);
          };
          const int a = at(0, 0), b = high ? at(1, 0) : at(0, 1), c = at(1, 1),
                    d = high ? at(0, 1) : at(1, 0);
          if(quads)
            s.faces.push_back({a, b, c, d});
          else
            s.quad(a, b, c, d, (i + j) % 2 == 1);
        }
  return s;
}

// in how many coordinates a point is at the surface of the unit cube
inline int number_of_planes(const Vector_3& p)
{
  int count = 0;
  for(int i = 0; i < 3; ++i)
    count += std::abs(p(i)) < 1e-12 || std::abs(p(i) - 1) < 1e-12;
  return count;
}

// a cube's squares on the unit sphere: quads with 8 irregular vertices
inline Shape cube_sphere(int n)
{
  Shape s = cube(n, true);
  for(Vector_3& p : s.points)
    p = (p - Vector_3(0.5, 0.5, 0.5)).normalized();
  return s;
}

// Two parallel sheets of n times n squares, `gap` apart and closed at the rim; `wave` is the height
// of a wave that both follow, and `taper` the part of the gap that is lost at the other end, as in a knife. The
// first half of the vertices is the upper sheet.
inline Shape double_sheet(int n, double gap, double wave = 0, double taper = 0)
{
  Shape s;
  const auto height = [&](double x) { return wave * std::sin(2 * pi * 2 * x); };
  for(int side = 0; side < 2; ++side)
    for(int j = 0; j <= n; ++j)
      for(int i = 0; i <= n; ++i)
      {
        const double x = double(i) / n;
        s.add(x, double(j) / n, height(x) - side * gap * (1 - taper * x));
      }
  const int m = (n + 1) * (n + 1);
  const auto at = [&](int i, int j) { return j * (n + 1) + i; };
  s.grid(n, n, Diagonals::alternating, at);
  for(int j = 0; j < n; ++j)
    for(int i = 0; i < n; ++i)
      s.quad(m + at(i, j), m + at(i, j + 1), m + at(i + 1, j + 1), m + at(i + 1, j),
             (i + j) % 2 == 1);
  for(int i = 0; i < n; ++i)
  {
    const auto side = [&](int a, int b) { s.quad(b, a, m + a, m + b); };
    side(at(i, 0), at(i + 1, 0));
    side(at(n, i), at(n, i + 1));
    side(at(i + 1, n), at(i, n));
    side(at(0, i + 1), at(0, i));
  }
  return s;
}

// A sheet with pleats, each folded by an angle: n squares to each of its flat parts
inline Shape pleats(int number, int n, double degrees)
{
  const double slope = 0.5 * degrees * pi / 180, length = 1. / n;
  return grid(2 * number * n, 3 * n, Diagonals::alternating, [&](int i, int j) {
    const int part = i / n, rest = i % n;
    const double height = (part % 2 == 0 ? rest : n - rest) * length;
    return Vector_3(i * length * std::cos(slope), j * length, height * std::sin(slope));
  });
}

// whether a face is on the first sheet of double_sheet()
inline bool is_upper(const Shape& sheet, int f)
{
  const int half = int(sheet.points.size()) / 2;
  for(const int v : sheet.faces[f])
    if(v >= half)
      return false;
  return true;
}

// the unit sphere with meridians
inline Shape meridian_sphere(int columns, int rows)
{
  const auto angle = [=](double t) { return pi * (1 + t * (rows - 2)) / rows; };
  Shape s = revolved(
    columns, rows - 2, [=](double t) { return std::sin(angle(t)); },
    [=](double t) { return -std::cos(angle(t)); });
  const int bottom = s.add(0, 0, -1), top = s.add(0, 0, 1);
  for(int i = 0; i < columns; ++i)
  {
    const int j = (i + 1) % columns, last = (rows - 2) * columns;
    s.triangle(j, i, bottom);
    s.triangle(last + i, last + j, top);
  }
  return s;
}

// the vertices' places in the xy-plane
inline std::vector<Vector_2> planar_points(const Shape& s)
{
  std::vector<Vector_2> u;
  for(const Vector_3& p : s.points)
    u.push_back(p.head<2>());
  return u;
}

inline int nearest(const Shape& s, const Vector_3& p)
{
  int best = 0;
  for(int v = 0; v < int(s.points.size()); ++v)
    if((s.points[v] - p).norm() < (s.points[best] - p).norm())
      best = v;
  return best;
}

inline bool same_bits(const Vector_3& a, const Vector_3& b)
{
  return std::memcmp(a.data(), b.data(), sizeof(double) * 3) == 0;
}

inline bool same_bits(const Shape& a, const Shape& b)
{
  if(a.points.size() != b.points.size() || a.faces != b.faces)
    return false;
  for(std::size_t i = 0; i < a.points.size(); ++i)
    if(!same_bits(a.points[i], b.points[i]))
      return false;
  return true;
}

// of a triangle: its normal, twice its area long
inline Vector_3 vector_area(const Shape& s, const std::vector<int>& t)
{
  return (s.points[t[1]] - s.points[t[0]]).cross(s.points[t[2]] - s.points[t[0]]);
}

// of triangles
inline double volume(const Shape& s)
{
  double sum = 0;
  for(const std::vector<int>& t : s.faces)
    sum += s.points[t[0]].dot(s.points[t[1]].cross(s.points[t[2]])) / 6;
  return sum;
}

inline double smallest_angle(const Vector_3& a, const Vector_3& b, const Vector_3& c)
{
  const Vector_3* p[3] = {&a, &b, &c};
  double smallest = 180;
  for(int i = 0; i < 3; ++i)
  {
    const Vector_3 u = *p[(i + 1) % 3] - *p[i], v = *p[(i + 2) % 3] - *p[i];
    smallest = (std::min)(smallest, std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / pi);
  }
  return smallest;
}

inline double smallest_angle(const Shape& s)
{
  double smallest = 180;
  for(const std::vector<int>& f : s.faces)
    smallest = (std::min)(smallest, smallest_angle(s.points[f[0]], s.points[f[1]], s.points[f[2]]));
  return smallest;
}

inline double mean_smallest_angle(const Shape& s)
{
  double sum = 0;
  for(const std::vector<int>& f : s.faces)
    sum += smallest_angle(s.points[f[0]], s.points[f[1]], s.points[f[2]]);
  return sum / double(s.faces.size());
}

inline double area(const Shape& s)
{
  double sum = 0;
  for(const std::vector<int>& f : s.faces)
    for(std::size_t i = 1; i + 1 < f.size(); ++i)
      sum +=
        0.5 * (s.points[f[i]] - s.points[f[0]]).cross(s.points[f[i + 1]] - s.points[f[0]]).norm();
  return sum;
}

} // namespace rco_test
