#pragma once

// Points and faces that need not make a mesh, and simple shapes.

#include "../../../test/Reference_constrained_optimization/deformations.h"
#include "../meshes.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

using rco_test::Vector_3, rco_test::pi, rco_test::tetrahedron;
typedef rco_test::Shape Soup;

// Vertices and faces keep their order. Faces that a half-edge mesh cannot hold beside those before them
// are left out, and counted.
inline Mesh to_mesh(const Soup& soup, std::size_t& left_out)
{
  Mesh mesh;
  for(const Vector_3& p : soup.points)
    mesh.add_vertex(Kernel::Point_3(p.x(), p.y(), p.z()));
  for(const std::vector<int>& face : soup.faces)
  {
    std::vector<Mesh::Vertex_index> corners;
    for(const int v : face)
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

inline Soup plane(int nx, int ny)
{
  return rco_test::grid(nx, ny, rco_test::Diagonals::first,
                        [=](int i, int j) { return Vector_3(double(i) / nx, double(j) / ny, 0); });
}

inline Soup torus(int nx, int ny, double big, double small)
{
  const auto point = [=](int i, int j) {
    const double u = 2 * pi * i / nx, v = 2 * pi * j / ny, r = big + small * std::cos(v);
    return Vector_3(r * std::cos(u), r * std::sin(u), small * std::sin(v));
  };
  return rco_test::grid(nx, ny, rco_test::Diagonals::first, point, true, true);
}

inline Soup cylinder(int nx, int ny)
{
  const auto point = [=](int i, int j) {
    return Vector_3(std::cos(2 * pi * i / nx), std::sin(2 * pi * i / nx), double(j) / ny);
  };
  return rco_test::grid(nx, ny, rco_test::Diagonals::first, point, true);
}

// corners of valence 4 in triangles of uneven size
inline Soup sphere(int levels) { return split_on_sphere(rco_test::octahedron(), levels); }
