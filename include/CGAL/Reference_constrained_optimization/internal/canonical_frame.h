// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_CANONICAL_FRAME_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_CANONICAL_FRAME_H

#include <CGAL/Reference_constrained_optimization/internal/build_indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/has_area.h>

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
// them is near the border between two cells: rounding of the input does not take one across. Points of
// thin faces have finer grids, by themselves, so that no face turns noticeably; where a face is too thin
// for any, all stays as it is.
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
    double number = 2;
    for(const Mesh_copy* copy : copies)
      number = (std::max)(number, double(copy->mesh.number_of_vertices()));
    m_exponent = coarsest_exponent(number);
    for(const Mesh_copy* copy : copies)
      if(!add_fine_points(*copy, diagonal))
      {
        m_fine_points.clear();
        return;
      }
    // of equal points of both meshes the finer one counts
    std::sort(m_fine_points.begin(), m_fine_points.end(), is_before);
    m_fine_points.erase(
      std::unique(m_fine_points.begin(), m_fine_points.end(),
                  [](const Fine_point& p, const Fine_point& q) { return p.first == q.first; }),
      m_fine_points.end());
    m_unit = diagonal;
    m_resolution = std::ldexp(1., -m_exponent);
    lay_grids(copies);
  }

  // the unit of length, in units of the caller
  double unit() const { return m_unit; }
  // how far coordinates may be from what they were, in units of the frame; 0 if they are the same
  double resolution() const { return m_resolution; }
  // the same for a vertex of one of the meshes, in the caller's coordinates
  double resolution_at(const Vector_3& p) const { return cell(level(p)); }
  // cosine of a turn that rounding to the grid is far from
  double caution() const { return m_resolution == 0 ? 0 : 3e-3; }

  // of a vertex of one of the meshes
  Vector_3 operator()(const Vector_3& p) const
  {
    if(m_resolution == 0)
      return p;
    const std::size_t l = level(p);
    Vector_3 q;
    for(int axis = 0; axis < 3; ++axis)
      q(axis) = std::floor(in_cells(p(axis), axis, l) - m_shifts[l](axis)) * cell(l);
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
    return m_resolution == 0 ? p : Vector_3((p - m_origin) / m_unit - m_resolution * m_shifts[0]);
  }

private:
  // a point whose cells are finer than most, and the exponent of their size
  typedef std::pair<std::array<double, 3>, int> Fine_point;

  static std::array<double, 3> coordinates(const Vector_3& p) { return {{p(0), p(1), p(2)}}; }

  static bool is_before(const Fine_point& p, const Fine_point& q)
  {
    return p.first < q.first || (p.first == q.first && p.second > q.second);
  }

  // A cell of 2^-exponent is as small as it may be for rounding not to take coordinates to other cells up
  // to a thousand diagonals away from the origin, where it is 1e-13: the largest gap between random
  // numbers in [0, 1) is about log(n) / n, one half of it is on each side of the border, and the second
  // largest gap must not be taken for the largest.
  static int coarsest_exponent(double number)
  {
    const double far_above_rounding = 8e-12, largest = 36;
    return int(
      (std::min)(largest, std::log2(0.5 * std::log(number) / number / far_above_rounding)));
  }

  // A cell is at most 2^-10 of the smallest height of a point's faces: a turn of a tenth of a degree, or
  // two where grids meet, since points of two grids move by up to two cells against one another.
  // False if some face is too thin.
  bool add_fine_points(const Mesh_copy& copy, double diagonal)
  {
    const int turn = 10, finest = 40;
    const Indexed_mesh& mesh = copy.mesh;
    const auto point = [&](int v) -> const Vector_3& { return copy.points[v]; };
    std::vector<int> exponents(mesh.number_of_vertices(), m_exponent);
    for(int f = 0; f < mesh.number_of_faces(); ++f)
    {
      double height = std::numeric_limits<double>::infinity();
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        height = (std::min)(height, height_at_corner(mesh, point, c));
      const double exponent =
        (std::max)(double(m_exponent), std::ceil(turn - std::log2(height / diagonal)));
      if(!(exponent <= finest))
        return false;
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      {
        int& e = exponents[mesh.corner_vertex[c]];
        e = (std::max)(e, int(exponent));
      }
    }
    for(int v = 0; v < mesh.number_of_vertices(); ++v)
      if(exponents[v] > m_exponent)
        m_fine_points.emplace_back(coordinates(copy.points[v]), exponents[v]);
    return true;
  }

  // 0 for the grid of most points, which is the coarsest
  std::size_t level(const Vector_3& p) const
  {
    if(m_fine_points.empty())
      return 0;
    const std::array<double, 3> key = coordinates(p);
    const auto i = std::lower_bound(
      m_fine_points.begin(), m_fine_points.end(), key,
      [](const Fine_point& q, const std::array<double, 3>& k) { return q.first < k; });
    return i != m_fine_points.end() && i->first == key ? std::size_t(i->second - m_exponent) : 0;
  }

  double cell(std::size_t level) const { return std::ldexp(m_resolution, -int(level)); }

  double in_cells(double coordinate, int axis, std::size_t level) const
  {
    return (coordinate - m_origin(axis)) / m_unit / cell(level);
  }

  void lay_grids(const std::vector<const Mesh_copy*>& copies)
  {
    int finest = m_exponent;
    for(const Fine_point& p : m_fine_points)
      finest = (std::max)(finest, p.second);
    m_shifts.assign(std::size_t(finest - m_exponent) + 1, Vector_3::Zero());
    const auto for_each_point = [](const Mesh_copy& copy, const auto& visit) {
      for(int v = 0; v < copy.mesh.number_of_vertices(); ++v)
        if(!copy.mesh.is_isolated(v))
          visit(copy.points[v]);
    };
    m_origin.setConstant(std::numeric_limits<double>::infinity());
    for_each_point(*copies[0], [&](const Vector_3& p) { m_origin = m_origin.cwiseMin(p); });
    std::vector<std::vector<double>> parts(m_shifts.size()); // of a cell
    for(int axis = 0; axis < 3; ++axis)
    {
      for(std::vector<double>& p : parts)
        p.clear();
      for(const Mesh_copy* copy : copies)
        for_each_point(*copy, [&](const Vector_3& p) {
          const std::size_t l = level(p);
          const double cells = in_cells(p(axis), axis, l);
          parts[l].push_back(cells - std::floor(cells));
        });
      for(std::size_t l = 0; l < parts.size(); ++l)
        if(!parts[l].empty())
          m_shifts[l](axis) = middle_of_gap(parts[l]);
    }
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

  int m_exponent = 0; // of most cells
  double m_unit = 1, m_resolution = 0;
  Vector_3 m_origin = Vector_3::Zero();
  std::vector<Fine_point> m_fine_points; // sorted
  std::vector<Vector_3> m_shifts;        // per level, in its cells
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_CANONICAL_FRAME_H
