// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// What is done to shapes: joined, cut, moved at random, bent.

#pragma once

#include "shapes.h"

#include <Eigen/Geometry>

namespace rco_test {

typedef std::function<Vector_3(const Vector_3&)> Deformation;

inline Shape deformed(Shape s, const Deformation& f)
{
  for(Vector_3& p : s.points)
    p = f(p);
  return s;
}

inline Shape scaled(const Shape& s, double x, double y, double z)
{
  return deformed(s, [=](const Vector_3& p) { return Vector_3(x * p.x(), y * p.y(), z * p.z()); });
}
inline Shape scaled(const Shape& s, double factor) { return scaled(s, factor, factor, factor); }

inline Shape shifted(const Shape& s, const Vector_3& shift)
{
  return deformed(s, [=](const Vector_3& p) -> Vector_3 { return p + shift; });
}

inline Shape rotated(const Shape& s, const Eigen::Matrix3d& rotation)
{
  return deformed(s, [=](const Vector_3& p) -> Vector_3 { return rotation * p; });
}

// both meshes as one, the second shifted
inline Shape joined(const Shape& a, const Shape& b, const Vector_3& shift = Vector_3::Zero())
{
  Shape s = a;
  for(const Vector_3& p : b.points)
    s.points.push_back(p + shift);
  for(std::vector<int> f : b.faces)
  {
    for(int& v : f)
      v += int(a.points.size());
    s.faces.push_back(f);
  }
  return s;
}

// the same with every face oriented the other way
inline Shape turned_round(const Shape& shape)
{
  Shape s = shape;
  for(std::vector<int>& f : s.faces)
    std::reverse(f.begin(), f.end());
  return s;
}

// with the given quads split into triangles
inline Shape split(const Shape& shape, const std::function<bool(int)>& is_split)
{
  Shape s;
  s.points = shape.points;
  for(int i = 0; i < int(shape.faces.size()); ++i)
  {
    const std::vector<int>& f = shape.faces[i];
    if(f.size() == 4 && is_split(i))
      s.quad(f[0], f[1], f[2], f[3], i % 2 == 1);
    else
      s.faces.push_back(f);
  }
  return s;
}

// without the given faces; isolated vertices stay
inline Shape without_faces(const Shape& shape, const std::function<bool(int)>& drop)
{
  Shape s;
  s.points = shape.points;
  for(int f = 0; f < int(shape.faces.size()); ++f)
    if(!drop(f))
      s.faces.push_back(shape.faces[f]);
  return s;
}

// without the vertices that no face uses
inline Shape compacted(const Shape& shape)
{
  Shape s;
  std::vector<int> index(shape.points.size(), -1);
  for(std::vector<int> f : shape.faces)
  {
    for(int& v : f)
    {
      if(index[v] < 0)
      {
        index[v] = int(s.points.size());
        s.points.push_back(shape.points[v]);
      }
      v = index[v];
    }
    s.faces.push_back(f);
  }
  return s;
}

// with the given vertices moved to one of their neighbours each
inline Shape collapsed(Shape s, const std::vector<int>& vertices)
{
  const Indexed_mesh mesh = indexed(s);
  for(const int v : vertices)
    s.points[v] = s.points[mesh.target(mesh.vertex_corners[mesh.vertex_begin[v]])];
  return s;
}

// Vertices away from the border moved at random by up to `amount` of their shortest edge, then back
// onto the surface by `project`.
inline Shape
scrambled(const Shape& shape, double amount, std::uint64_t seed, const Deformation& project)
{
  Shape s = shape;
  const Indexed_mesh mesh = indexed(shape);
  std::vector<double> shortest(shape.points.size(), 1e300);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
  {
    const int a = mesh.source(c), b = mesh.target(c);
    const double length = (shape.points[a] - shape.points[b]).norm();
    shortest[a] = (std::min)(shortest[a], length);
    shortest[b] = (std::min)(shortest[b], length);
  }
  Random random(seed);
  for(std::size_t v = 0; v < s.points.size(); ++v)
  {
    const Vector_3 move = random.in_cube(amount);
    if(!mesh.is_border_vertex[v] && mesh.vertex_begin[v] < mesh.vertex_begin[v + 1])
      s.points[v] = project(shape.points[v] + shortest[v] * move);
  }
  return s;
}

inline Vector_3 onto_plane(const Vector_3& p) { return Vector_3(p.x(), p.y(), 0); }
inline Vector_3 onto_sphere(const Vector_3& p) { return p.normalized(); }
inline Deformation onto_cylinder(double radius)
{
  return [=](const Vector_3& p) {
    const double r = std::hypot(p.x(), p.y());
    return Vector_3(p.x() * radius / r, p.y() * radius / r, p.z());
  };
}
inline Deformation onto_torus(double big, double small)
{
  return [=](const Vector_3& p) {
    const Vector_3 ring = Vector_3(p.x(), p.y(), 0).normalized() * big;
    return Vector_3(ring + (p - ring).normalized() * small);
  };
}

// of the unit sphere
inline Vector_3 bumpy(const Vector_3& p)
{
  return p * (1 + 0.2 * std::sin(3 * p.x() + 1) * std::cos(2 * p.y()) + 0.1 * std::sin(5 * p.z()) +
              0.1 * std::cos(4 * p.y() - 2 * p.x()));
}

inline Vector_3 ellipsoidal(const Vector_3& p) { return Vector_3(1.5 * p.x(), 0.8 * p.y(), p.z()); }

inline Vector_3 twisted(const Vector_3& p)
{
  const double a = 0.7 * p.x(), c = std::cos(a), s = std::sin(a);
  return Vector_3(p.x(), c * p.y() - s * p.z(), s * p.y() + c * p.z());
}

inline Vector_3 bent(const Vector_3& p)
{
  const double r = 1.6, a = p.x() / r;
  return Vector_3((r + p.z()) * std::sin(a), p.y(), (r + p.z()) * std::cos(a) - r);
}

// of the unit square
inline Vector_3 hilly(const Vector_3& p)
{
  const Vector_3 d = p - Vector_3(0.6, 0.45, 0);
  return Vector_3(p.x(), p.y(), 0.35 * std::exp(-8 * d.squaredNorm()) + 0.1 * p.x() * p.x());
}

inline Vector_3 arched(const Vector_3& p)
{
  return Vector_3(1.2 * p.x(), p.y() + 0.1 * p.x(), 0.3 * std::sin(pi * p.x()) * (0.6 + p.y()));
}

// the unit square, `columns` and `rows` wide
inline Shape square(int columns, int rows, bool quads = false)
{
  return deformed(plane_grid(columns, rows, 1, quads),
                  [=](const Vector_3& p) { return Vector_3(p.x(), p.y() * columns / rows, 0); });
}

} // namespace rco_test
