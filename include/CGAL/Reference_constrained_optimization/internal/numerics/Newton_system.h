// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_NEWTON_SYSTEM_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_NEWTON_SYSTEM_H

#include <CGAL/Reference_constrained_optimization/internal/numerics/Block_LDLT.h>

#include <Eigen/Core>

#include <array>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The sparse system of a Newton step with two unknowns per free vertex. The pattern and its
// symbolic factorization are computed once; values are summed into slots known beforehand.
class Newton_system
{
public:
  // `variable` numbers the free vertices and is -1 elsewhere; `triples` are the elements, `pairs`
  // further pairs of variables that have a block
  void analyze(const std::vector<int>& variable,
               int number_of_variables,
               const std::vector<std::array<int, 3>>& triples,
               const std::vector<std::array<int, 2>>& pairs = {})
  {
    m_sides.clear();
    for(const auto& t : triples)
      for(int i = 0; i < 3; ++i)
        m_sides.push_back({{variable[t[i]], variable[t[(i + 1) % 3]]}});
    m_first_pair = int(m_sides.size());
    m_sides.insert(m_sides.end(), pairs.begin(), pairs.end());
    m_matrix.analyze(number_of_variables, m_sides);
  }

  void set_zero() { m_matrix.set_zero(); }

  // adds the 2x2 block of variable `a` on the diagonal
  void add_diagonal(int a, const Eigen::Matrix2d& block) { m_matrix.add_diagonal(a, block); }

  // adds the block (rows a, columns b) of side `side` of element `element`: the side from its
  // vertex number `side` (variable a) to the next (variable b)
  void add_side(int element, int side, int a, int b, const Eigen::Matrix2d& block)
  {
    m_matrix.add(3 * element + side, a, b, block);
  }

  // adds the block (rows a, columns b) of a pair, and its transpose
  void add_pair(int pair, int a, int b, const Eigen::Matrix2d& block)
  {
    m_matrix.add(m_first_pair + pair, a, b, block);
  }

  // Solves for the right-hand side; the diagonal is shifted by a small multiple of its mean, which makes
  // the matrix regular in directions of zero curvature. False if the factorization failed.
  bool
  solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& solution, Interruption* interruption = nullptr)
  {
    const double mean = m_matrix.trace() / (2 * m_matrix.size());
    for(const double relative_shift : {1e-9, 1e-5, 1e-2})
    {
      if(!m_matrix.factorize(relative_shift * mean, interruption))
        continue;
      m_matrix.solve(rhs, solution);
      if(solution.allFinite() && rhs.dot(solution) > 0)
        return true;
    }
    return false;
  }

private:
  Block_LDLT m_matrix;
  std::vector<std::array<int, 2>> m_sides; // variables at their ends
  int m_first_pair = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_NEWTON_SYSTEM_H
