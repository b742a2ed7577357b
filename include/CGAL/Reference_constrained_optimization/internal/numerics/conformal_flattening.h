// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_CONFORMAL_FLATTENING_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_CONFORMAL_FLATTENING_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/numerics/Block_LDLT.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The least-squares conformal map of a disk of triangles (B. Levy et al., Least Squares Conformal
// Maps for Automatic Texture Atlas Generation, 2002), with two fixed vertices.
//
// With the edge opposite to corner i of a triangle as a complex number w_i in the triangle's plane,
// and u_i the corner's place as another one, the map is conformal where sum w_i u_i = 0. Minimized is
// the sum of the squares of these over the triangles' areas: twice the Dirichlet energy less the
// area. For corners i and j it has the 2x2 block of conj(w_i) w_j, over the area.
class Conformal_flattening
{
public:
  // `shapes` are the edge matrices of the triangles in their planes, of positive determinant;
  // `fixed` are two vertices as far apart as can be. The map has any scale; false if there is none.
  bool flatten(const Indexed_mesh& triangles,
               const std::vector<Eigen::Matrix2d>& shapes,
               const std::array<int, 2>& fixed,
               std::vector<Vector_2>& u)
  {
    const int n = triangles.number_of_vertices();
    u.assign(n, Vector_2::Zero());
    if(fixed[0] == fixed[1])
      return false;
    u[fixed[1]] = Vector_2::UnitX();
    number_variables(n, fixed);
    if(m_size == 0)
      return false;

    m_sides.clear();
    for(int c = 0; c < triangles.number_of_corners(); ++c)
      m_sides.push_back({{m_variable[triangles.source(c)], m_variable[triangles.target(c)]}});
    m_matrix.analyze(m_size, m_sides);
    assemble(triangles, shapes, u);
    if(!m_matrix.factorize(0))
      return false;
    m_matrix.solve(m_rhs, m_solution);
    if(!m_solution.allFinite())
      return false;
    for(int v = 0; v < n; ++v)
      if(m_variable[v] >= 0)
        u[v] = m_solution.segment<2>(2 * m_variable[v]);
    return true;
  }

private:
  void number_variables(int n, const std::array<int, 2>& fixed)
  {
    m_variable.resize(n);
    m_size = 0;
    for(int v = 0; v < n; ++v)
      m_variable[v] = v == fixed[0] || v == fixed[1] ? -1 : m_size++;
  }

  void assemble(const Indexed_mesh& triangles,
                const std::vector<Eigen::Matrix2d>& shapes,
                const std::vector<Vector_2>& u)
  {
    m_matrix.set_zero();
    m_rhs.setZero(2 * m_size);
    for(int t = 0; t < triangles.number_of_faces(); ++t)
    {
      const Eigen::Matrix2d& s = shapes[t];
      const Vector_2 w[3] = {s.col(1) - s.col(0), -s.col(1), s.col(0)};
      const double weight = 1 / s.determinant();
      for(int i = 0; i < 3; ++i)
      {
        const int v = triangles.corner_vertex[3 * t + i], a = m_variable[v];
        if(a >= 0)
          m_matrix.add_diagonal(a, weight * w[i].squaredNorm() * Eigen::Matrix2d::Identity());
        const int j = (i + 1) % 3;
        const int x = triangles.corner_vertex[3 * t + j], b = m_variable[x];
        const Eigen::Matrix2d block = weight * conjugate_product(w[i], w[j]);
        if(a >= 0 && b >= 0)
          m_matrix.add(3 * t + i, a, b, block);
        else if(a >= 0)
          m_rhs.segment<2>(2 * a) -= block * u[x];
        else if(b >= 0)
          m_rhs.segment<2>(2 * b) -= block.transpose() * u[v];
      }
    }
  }

  // conj(a) b as the matrix that multiplies by it
  static Eigen::Matrix2d conjugate_product(const Vector_2& a, const Vector_2& b)
  {
    const double real = a.dot(b), imaginary = a(0) * b(1) - a(1) * b(0);
    Eigen::Matrix2d m;
    m << real, -imaginary, imaginary, real;
    return m;
  }

  int m_size = 0;
  Block_LDLT m_matrix;
  std::vector<int> m_variable;
  std::vector<std::array<int, 2>> m_sides;
  Eigen::VectorXd m_rhs, m_solution;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_CONFORMAL_FLATTENING_H
