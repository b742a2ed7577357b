#pragma once

// The same input in other units, at another place, and with noise.

#include "../meshes.h"

#include <algorithm>
#include <cmath>
#include <random>

struct Variant
{
  double scale = 1;
  double shift = 0; // in diagonals
  double noise = 0; // in mean edge lengths
};

inline bool is_finite(const Kernel::Point_3& p)
{
  return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z());
}

// of the vertices that are finite
inline double diagonal(const Mesh& mesh)
{
  CGAL::Bbox_3 box;
  for(const Mesh::Vertex_index v : mesh.vertices())
    if(is_finite(mesh.point(v)))
      box += mesh.point(v).bbox();
  return mesh.is_empty() ? 0 : std::hypot(box.x_span(), box.y_span(), box.z_span());
}

// the mean length of the edges whose vertices are finite
inline double mean_edge(const Mesh& mesh)
{
  double sum = 0;
  std::size_t n = 0;
  for(const Mesh::Edge_index e : mesh.edges())
  {
    const Kernel::Point_3 &a = mesh.point(mesh.vertex(e, 0)), &b = mesh.point(mesh.vertex(e, 1));
    if(is_finite(a) && is_finite(b))
    {
      sum += std::hypot(a.x() - b.x(), a.y() - b.y(), a.z() - b.z());
      ++n;
    }
  }
  return n > 0 ? sum / double(n) : 0;
}

template <typename Move>
void move_points(Mesh& mesh, const Move& move)
{
  for(const Mesh::Vertex_index v : mesh.vertices())
  {
    Kernel::Point_3& p = mesh.point(v);
    if(is_finite(p))
      p = move(p);
  }
}

// mesh and reference in the variant; noise goes to the mesh alone
inline void apply(const Variant& variant, double reference_diagonal, Mesh& mesh, bool is_reference)
{
  const double s = variant.scale, d = variant.shift * reference_diagonal;
  const Kernel::Vector_3 shift(0.6 * d, -0.48 * d, 0.64 * d);
  if(s != 1 || d != 0)
    move_points(mesh, [&](const Kernel::Point_3& p) {
      return Kernel::Point_3(s * p.x(), s * p.y(), s * p.z()) + shift;
    });
  // what is a tenth of the diagonal away from the reference is refused: stays well below
  const double noise =
    (std::min)(variant.noise * mean_edge(mesh), 0.05 * reference_diagonal * variant.scale);
  if(is_reference || !(noise > 0))
    return;
  std::mt19937 random(1);
  const auto draw = [&]() { return noise * (double(random()) / 2147483648. - 1) / std::sqrt(3.); };
  move_points(mesh, [&](const Kernel::Point_3& p) {
    const double x = draw(), y = draw(), z = draw();
    return p + Kernel::Vector_3(x, y, z);
  });
}
