// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_CANONICAL_FRAME_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_CANONICAL_FRAME_H

#include <CGAL/Reference_constrained_optimization/internal/build_indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/has_area.h>

#include <algorithm>
#include <cmath>
#include <limits>
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
// them is near the border between two cells: rounding of the input does not take one across. The grid is
// so fine that no face turns noticeably; where a face is too thin for that, all stays as it is.
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
    double height = std::numeric_limits<double>::infinity();
    for(const Mesh_copy* copy : copies)
      for(int c = 0; c < copy->mesh.number_of_corners(); ++c)
        height = (std::min)(
          height, height_at_corner(
                    copy->mesh, [&](int v) -> const Vector_3& { return copy->points[v]; }, c));
    // a cell is at most 2^-10 of the smallest height, a turn of a tenth of a degree
    const int turn = 10, finest = 40;
    const double exponent = std::ceil(turn - std::log2(height / diagonal));
    if(!(exponent <= finest))
      return;
    double number = 2;
    for(const Mesh_copy* copy : copies)
      number = (std::max)(number, double(copy->mesh.number_of_vertices()));
    m_unit = diagonal;
    m_resolution = std::ldexp(1., -(std::max)(finest_exponent(number), int(exponent)));

    for(int axis = 0; axis < 3; ++axis)
    {
      const auto for_each_coordinate = [&](const Mesh_copy& copy, const auto& visit) {
        for(int v = 0; v < copy.mesh.number_of_vertices(); ++v)
          if(!copy.mesh.is_isolated(v))
            visit(copy.points[v](axis));
      };
      double& low = m_origin(axis);
      low = std::numeric_limits<double>::infinity();
      for_each_coordinate(reference, [&](double x) { low = (std::min)(low, x); });
      std::vector<double> parts; // of a cell
      for(const Mesh_copy* copy : copies)
        for_each_coordinate(*copy, [&](double x) {
          const double cells = in_cells(x, axis);
          parts.push_back(cells - std::floor(cells));
        });
      m_shift(axis) = middle_of_gap(parts);
    }
  }

  // the unit of length, in units of the caller
  double unit() const { return m_unit; }
  // how far coordinates may be from what they were, in units of the frame; 0 if they are the same
  double resolution() const { return m_resolution; }
  // cosine of a turn that rounding to the grid is far from
  double caution() const { return m_resolution == 0 ? 0 : 3e-3; }

  Vector_3 operator()(const Vector_3& p) const
  {
    if(m_resolution == 0)
      return p;
    Vector_3 q;
    for(int axis = 0; axis < 3; ++axis)
      q(axis) = std::floor(in_cells(p(axis), axis) - m_shift(axis)) * m_resolution;
    return q;
  }

  // a length that the caller gave
  double length(double given) const
  {
    return m_resolution == 0 ? given : without_noise(given / m_unit);
  }

  // what the frame would be without the grid
  Vector_3 without_rounding(const Vector_3& p) const
  {
    return m_resolution == 0 ? p : Vector_3((p - m_origin) / m_unit - m_resolution * m_shift);
  }

private:
  // A cell of 2^-exponent is as small as it may be for rounding not to take coordinates to other cells up
  // to a thousand diagonals away from the origin, where it is 1e-13: the largest gap between random
  // numbers in [0, 1) is about log(n) / n, one half of it is on each side of the border, and the second
  // largest gap must not be taken for the largest.
  static int finest_exponent(double number)
  {
    const double far_above_rounding = 8e-12, largest = 36;
    return int(
      (std::min)(largest, std::log2(0.5 * std::log(number) / number / far_above_rounding)));
  }

  double in_cells(double coordinate, int axis) const
  {
    return (coordinate - m_origin(axis)) / m_unit / m_resolution;
  }

  // The middle of the largest interval of the circle [0, 1) that has no number in it; the first of
  // those that are as large but for rounding. One number is 0.
  static double middle_of_gap(std::vector<double>& numbers)
  {
    std::sort(numbers.begin(), numbers.end());
    numbers.push_back(1);
    double largest = 0;
    for(std::size_t i = 1; i < numbers.size(); ++i)
      largest = (std::max)(largest, numbers[i] - numbers[i - 1]);
    const double as_large = 0.999;
    std::size_t i = 1;
    while(numbers[i] - numbers[i - 1] < as_large * largest)
      ++i;
    return 0.5 * (numbers[i] + numbers[i - 1]);
  }

  double m_unit = 1, m_resolution = 0;
  Vector_3 m_origin = Vector_3::Zero(), m_shift = Vector_3::Zero(); // the latter in cells
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_CANONICAL_FRAME_H
