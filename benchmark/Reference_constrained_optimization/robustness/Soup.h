#pragma once

// Points and faces that need not make a mesh, and simple shapes.

#include "../meshes.h"

#include <cmath>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

struct Soup
{
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> faces;

  std::size_t add(double x, double y, double z)
  {
    points.emplace_back(x, y, z);
    return points.size() - 1;
  }
  void triangle(std::size_t a, std::size_t b, std::size_t c) { faces.push_back({a, b, c}); }
  void quad(std::size_t a, std::size_t b, std::size_t c, std::size_t d)
  {
    triangle(a, b, c);
    triangle(a, c, d);
  }
};

// Vertices and faces keep their order. Faces that a half-edge mesh cannot hold beside those before them
// are left out, and counted.
inline Mesh to_mesh(const Soup& soup, std::size_t& left_out)
{
  Mesh mesh;
  for(const Kernel::Point_3& p : soup.points)
    mesh.add_vertex(p);
  for(const std::vector<std::size_t>& face : soup.faces)
  {
    std::vector<Mesh::Vertex_index> corners;
    for(const std::size_t v : face)
      corners.emplace_back(Mesh::size_type(v));
    left_out += mesh.add_face(corners) == Mesh::null_face();
  }
  return mesh;
}

// throws if a half-edge mesh cannot hold all
inline Mesh to_mesh(const Soup& soup)
{
  std::size_t left_out = 0;
  Mesh mesh = to_mesh(soup, left_out);
  if(left_out > 0)
    throw std::runtime_error("the faces do not make a half-edge mesh");
  return mesh;
}

// nx times ny squares, split; at(x, y) is the point of the parameters, which are in [0, 1]
template <typename At>
Soup grid(int nx, int ny, const At& at)
{
  Soup s;
  for(int j = 0; j <= ny; ++j)
    for(int i = 0; i <= nx; ++i)
      s.points.push_back(at(double(i) / nx, double(j) / ny));
  const auto index = [&](int i, int j) { return std::size_t(j * (nx + 1) + i); };
  for(int j = 0; j < ny; ++j)
    for(int i = 0; i < nx; ++i)
      s.quad(index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
  return s;
}

inline Soup plane(int nx, int ny)
{
  return grid(nx, ny, [](double x, double y) { return Kernel::Point_3(x, y, 0); });
}

// Squares that close in the first direction, or in both: a band or a torus. `turn(u, v)` gives the
// point of two angles, or of an angle and a height in [0, 1].
template <typename At>
Soup wrapped(int nx, int ny, bool both, const At& at)
{
  const double pi = 3.14159265358979323846;
  Soup s;
  const int rows = both ? ny : ny + 1;
  for(int j = 0; j < rows; ++j)
    for(int i = 0; i < nx; ++i)
      s.points.push_back(at(2 * pi * i / nx, both ? 2 * pi * j / ny : double(j) / ny));
  const auto index = [&](int i, int j) { return std::size_t((j % rows) * nx + i % nx); };
  for(int j = 0; j < ny; ++j)
    for(int i = 0; i < nx; ++i)
      s.quad(index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
  return s;
}

inline Soup torus(int nx, int ny, double big, double small)
{
  return wrapped(nx, ny, true, [=](double u, double v) {
    const double r = big + small * std::cos(v);
    return Kernel::Point_3(r * std::cos(u), r * std::sin(u), small * std::sin(v));
  });
}

inline Soup cylinder(int nx, int ny)
{
  return wrapped(nx, ny, false,
                 [](double u, double h) { return Kernel::Point_3(std::cos(u), std::sin(u), h); });
}

inline Soup tetrahedron()
{
  Soup s;
  s.add(1, 1, 1);
  s.add(-1, -1, 1);
  s.add(-1, 1, -1);
  s.add(1, -1, -1);
  s.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return s;
}

// an octahedron split `levels` times, on the unit sphere: corners of valence 4 in triangles of uneven size
inline Soup sphere(int levels)
{
  Soup s;
  for(int axis = 0; axis < 3; ++axis)
    for(const double sign : {1., -1.})
      s.add(axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0);
  for(const std::size_t x : {0, 1})
    for(const std::size_t y : {2, 3})
      for(const std::size_t z : {4, 5})
        (x + y + z) % 2 == 0 ? s.triangle(x, y, z) : s.triangle(x, z, y);
  for(int l = 0; l < levels; ++l)
  {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
    const auto middle = [&](std::size_t a, std::size_t b) {
      const auto inserted = middles.insert({std::minmax(a, b), s.points.size()});
      if(inserted.second)
      {
        const Kernel::Vector_3 sum = (s.points[a] - CGAL::ORIGIN) + (s.points[b] - CGAL::ORIGIN);
        s.points.push_back(CGAL::ORIGIN + sum / std::sqrt(sum.squared_length()));
      }
      return inserted.first->second;
    };
    const std::vector<std::vector<std::size_t>> coarse = std::move(s.faces);
    s.faces.clear();
    for(const std::vector<std::size_t>& f : coarse)
    {
      const std::size_t a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
      s.triangle(f[0], a, c);
      s.triangle(f[1], b, a);
      s.triangle(f[2], c, b);
      s.triangle(a, b, c);
    }
  }
  return s;
}

// every point moved
template <typename Move>
Soup moved(Soup s, const Move& move)
{
  for(Kernel::Point_3& p : s.points)
    p = move(p);
  return s;
}

inline Soup scaled(const Soup& s, double x, double y, double z)
{
  return moved(
    s, [=](const Kernel::Point_3& p) { return Kernel::Point_3(x * p.x(), y * p.y(), z * p.z()); });
}

inline Soup shifted(const Soup& s, double x, double y, double z)
{
  return moved(s, [=](const Kernel::Point_3& p) { return p + Kernel::Vector_3(x, y, z); });
}

// both as one
inline Soup joined(Soup a, const Soup& b)
{
  const std::size_t n = a.points.size();
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for(std::vector<std::size_t> f : b.faces)
  {
    for(std::size_t& v : f)
      v += n;
    a.faces.push_back(f);
  }
  return a;
}

inline Soup turned_round(Soup s)
{
  for(std::vector<std::size_t>& f : s.faces)
    std::swap(f.front(), f.back());
  return s;
}
