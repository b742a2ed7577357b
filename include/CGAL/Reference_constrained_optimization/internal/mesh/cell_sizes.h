// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CELL_SIZES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CELL_SIZES_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/has_area.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/point_index.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// How finely the vertices of meshes may be rounded. Cells are 2^-exponent wide, in units of a diagonal:
// as small as rounding allows for most vertices, smaller for those of thin faces, so that no face turns
// noticeably.
class Cell_sizes
{
public:
  Cell_sizes() = default;

  Cell_sizes(const std::vector<const Mesh_copy*>& copies, double diagonal)
  {
    double number = 2;
    for(const Mesh_copy* copy : copies)
      number = (std::max)(number, double(copy->mesh.number_of_vertices()));
    m_coarsest = m_finest = coarsest_exponent(number);
    for(const Mesh_copy* copy : copies)
      add_fine_cells(*copy, diagonal);
  }

  // whether some face is too thin for any cell
  bool is_too_thin() const { return m_is_too_thin; }

  // 0 for the cells of most vertices; those of the next level are half as wide
  int level(const Vector_3& p) const
  {
    if(m_exponents.empty())
      return 0;
    const auto found = m_exponents.find(point_key(p));
    return found == m_exponents.end() ? 0 : found->second - m_coarsest;
  }

  int number_of_levels() const { return m_finest - m_coarsest + 1; }

  double width(int level) const { return std::ldexp(1., -(m_coarsest + level)); }

private:
  // A cell is as small as it may be for rounding not to take coordinates to other cells up to a
  // thousand diagonals away from the origin, where it is 1e-13: the largest gap between random
  // numbers in [0, 1) is about log(n) / n, one half of it is on each side of the border, and the second
  // largest gap must not be taken for the largest.
  static int coarsest_exponent(double number)
  {
    const double far_above_rounding = 8e-12, largest = 36;
    return int(
      (std::min)(largest, std::log2(0.5 * std::log(number) / number / far_above_rounding)));
  }

  // A cell is at most 2^-10 of the smallest height of a vertex' faces: a turn of a tenth of a degree, or
  // two where cells of two sizes meet, since their points move by up to two cells against one another.
  void add_fine_cells(const Mesh_copy& copy, double diagonal)
  {
    const int turn = 10, finest = 40;
    const Indexed_mesh& mesh = copy.mesh;
    const auto point = [&](int v) -> const Vector_3& { return copy.points[v]; };
    for(int f = 0; f < mesh.number_of_faces(); ++f)
    {
      double height = std::numeric_limits<double>::infinity();
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        height = (std::min)(height, height_at_corner(mesh, point, c));
      const double exponent = std::ceil(turn - std::log2(height / diagonal));
      if(!(exponent > m_coarsest)) // lengths that overflow say nothing, too
        continue;
      if(exponent > finest)
      {
        m_is_too_thin = true;
        return;
      }
      m_finest = (std::max)(m_finest, int(exponent));
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      {
        int& e = m_exponents[point_key(point(mesh.corner_vertex[c]))];
        e = (std::max)(e, int(exponent));
      }
    }
  }

  int m_coarsest = 0, m_finest = 0;
  bool m_is_too_thin = false;
  Point_map<int> m_exponents; // of points whose cells are finer than most; equal points have one
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CELL_SIZES_H
