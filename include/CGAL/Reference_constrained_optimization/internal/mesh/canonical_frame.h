// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CANONICAL_FRAME_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CANONICAL_FRAME_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/cell_sizes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// the number, but for all behind its first 32 binary digits
inline double without_noise(double x)
{
  const int digits = 32;
  int exponent = 0;
  const double part = std::frexp(x, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(part, digits)), exponent - digits);
}

// Coordinates in which meshes are the same, bit by bit, wherever they lie and whatever their unit of
// length is: the optimization would go another way after the least difference in rounding.
//
// The unit is the reference's diagonal. Coordinates are rounded to a grid that is laid such that none of
// them is near the border between two cells: rounding of the input does not take one across. Points
// whose cells are finer (`cell_sizes.h`) have grids of their own; where a face is too thin for any, all
// stays as it is.
class Canonical_frame
{
public:
  Canonical_frame() = default;

  // the mesh may be the reference
  Canonical_frame(const Mesh_copy& reference, const Mesh_copy& mesh)
  {
    std::vector<const Mesh_copy*> copies(1, &reference);
    if(&mesh != &reference)
      copies.push_back(&mesh);
    const double diagonal = bounding_box_diagonal(reference.mesh, reference.points);
    if(!is_safe_diagonal(diagonal))
      return;
    Cell_sizes cells(copies, diagonal);
    if(cells.is_too_thin())
      return;
    m_cells = std::move(cells);
    m_unit = diagonal;
    m_resolution = m_cells.width(0);
    lay_grids(copies);
  }

  // the unit of length, in units of the caller
  double unit() const { return m_unit; }
  // how far coordinates may be from what they were, in units of the frame; 0 if they are the same
  double resolution() const { return m_resolution; }
  // the same for a vertex of one of the meshes, in the caller's coordinates
  double resolution_at(const Vector_3& p) const
  {
    return m_resolution == 0 ? 0 : m_cells.width(m_cells.level(p));
  }
  // cosine of a turn that rounding to the grid is far from
  double caution() const { return m_resolution == 0 ? 0 : 3e-3; }

  // of a vertex of one of the meshes
  Vector_3 operator()(const Vector_3& p) const
  {
    if(m_resolution == 0)
      return p;
    const int level = m_cells.level(p);
    const Vector_3 cells = in_cells(p, level) - m_shifts[level];
    return cells.array().floor() * m_cells.width(level);
  }

  // a length that the caller gave
  double length(double given) const
  {
    return m_resolution == 0 ? given : without_noise(given / m_unit);
  }

  Vector_3 to_caller(const Vector_3& p) const
  {
    return m_resolution == 0 ? p : Vector_3((p + m_resolution * m_shifts[0]) * m_unit + m_origin);
  }

  // what the frame would be without the grid
  Vector_3 without_rounding(const Vector_3& p) const
  {
    return m_resolution == 0 ? p : Vector_3((p - m_origin) / m_unit - m_resolution * m_shifts[0]);
  }

private:
  Vector_3 in_cells(const Vector_3& p, int level) const
  {
    return (p - m_origin) / m_unit / m_cells.width(level);
  }

  void lay_grids(const std::vector<const Mesh_copy*>& copies)
  {
    const auto for_each_point = [](const Mesh_copy& copy, const auto& visit) {
      for(int v = 0; v < copy.mesh.number_of_vertices(); ++v)
        if(!copy.mesh.is_isolated(v))
          visit(copy.points[v]);
    };
    m_origin.setConstant(std::numeric_limits<double>::infinity());
    for_each_point(*copies[0], [&](const Vector_3& p) { m_origin = m_origin.cwiseMin(p); });
    // where points lie in their cells, per level and axis
    std::vector<std::array<std::vector<double>, 3>> parts(m_cells.number_of_levels());
    for(const Mesh_copy* copy : copies)
      for_each_point(*copy, [&](const Vector_3& p) {
        const int level = m_cells.level(p);
        const Vector_3 cells = in_cells(p, level);
        for(int axis = 0; axis < 3; ++axis)
          parts[level][axis].push_back(cells(axis) - std::floor(cells(axis)));
      });
    m_shifts.assign(parts.size(), Vector_3::Zero());
    for(std::size_t level = 0; level < parts.size(); ++level)
      for(int axis = 0; axis < 3; ++axis)
        if(!parts[level][axis].empty())
          m_shifts[level](axis) = middle_of_gap(parts[level][axis]);
  }

  // The middle of the largest interval of the circle [0, 1) that has no number in it; the first of
  // those that are as large. Rounding changes the sizes by less than a hundredth, and many are equal
  // but for that.
  static double middle_of_gap(std::vector<double>& numbers)
  {
    std::sort(numbers.begin(), numbers.end());
    numbers.push_back(numbers.front() + 1);
    double largest = 0;
    for(std::size_t i = 1; i < numbers.size(); ++i)
      largest = (std::max)(largest, numbers[i] - numbers[i - 1]);
    const double as_large = 0.99;
    std::size_t i = 1;
    while(numbers[i] - numbers[i - 1] < as_large * largest)
      ++i;
    const double middle = 0.5 * (numbers[i] + numbers[i - 1]);
    return middle - std::floor(middle);
  }

  Cell_sizes m_cells;
  double m_unit = 1, m_resolution = 0;
  Vector_3 m_origin = Vector_3::Zero();
  std::vector<Vector_3> m_shifts; // per level, in its cells
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CANONICAL_FRAME_H
