// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NEWTON_SYSTEM_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NEWTON_SYSTEM_H

#include <CGAL/Reference_constrained_optimization/internal/Indexed_mesh.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The sparse matrix of a Newton step with two unknowns per free vertex. The pattern and its
// symbolic factorization are computed once; values are summed into slots known beforehand.
class Newton_system
{
  typedef Eigen::SparseMatrix<double> Matrix;
  typedef Eigen::SimplicialLDLT<Matrix, Eigen::Lower> Solver;

public:
  // `variable` numbers the free vertices and is -1 elsewhere; `triples` are the elements
  void analyze(const std::vector<int>& variable,
               int number_of_variables,
               const std::vector<std::array<int, 3>>& triples)
  {
    m_size = number_of_variables;
    std::vector<std::vector<int>> below(m_size); // larger neighbours of every variable
    for(const auto& t : triples)
      for(int i = 0; i < 3; ++i)
      {
        const int a = variable[t[i]], b = variable[t[(i + 1) % 3]];
        if(a >= 0 && b >= 0)
          below[(std::min)(a, b)].push_back((std::max)(a, b));
      }
    std::size_t count = 0;
    for(auto& b : below)
    {
      std::sort(b.begin(), b.end());
      b.erase(std::unique(b.begin(), b.end()), b.end());
      count += 3 + 4 * b.size();
    }
    m_matrix.resize(2 * m_size, 2 * m_size);
    m_matrix.resizeNonZeros(count);
    int* outer = m_matrix.outerIndexPtr();
    int* inner = m_matrix.innerIndexPtr();
    int k = 0;
    for(int j = 0; j < m_size; ++j)
      for(int b = 0; b < 2; ++b)
      {
        outer[2 * j + b] = k;
        for(int a = b; a < 2; ++a)
          inner[k++] = 2 * j + a;
        for(const int i : below[j])
          for(int a = 0; a < 2; ++a)
            inner[k++] = 2 * i + a;
      }
    outer[2 * m_size] = k;

    m_slots.clear();
    for(const auto& t : triples)
      for(int i = 0; i < 3; ++i)
      {
        const int a = variable[t[i]], b = variable[t[(i + 1) % 3]];
        int slot = -1;
        if(a >= 0 && b >= 0)
        {
          const auto& list = below[(std::min)(a, b)];
          slot = int(std::lower_bound(list.begin(), list.end(), (std::max)(a, b)) - list.begin());
        }
        m_slots.push_back(slot);
      }
    m_solver.analyzePattern(m_matrix);
  }

  void set_zero() { std::fill(m_matrix.valuePtr(), m_matrix.valuePtr() + m_matrix.nonZeros(), 0.); }

  // adds the 2x2 block of variable `a` on the diagonal
  void add_diagonal(int a, const Eigen::Matrix2d& block)
  {
    double* values = m_matrix.valuePtr();
    const int* outer = m_matrix.outerIndexPtr();
    values[outer[2 * a]] += block(0, 0);
    values[outer[2 * a] + 1] += block(1, 0);
    values[outer[2 * a + 1]] += block(1, 1);
  }

  // adds the block (rows a, columns b) of side `side` of element `element`: the side from its
  // vertex number `side` (variable a) to the next (variable b)
  void add_side(int element, int side, int a, int b, const Eigen::Matrix2d& block)
  {
    double* values = m_matrix.valuePtr();
    const int* outer = m_matrix.outerIndexPtr();
    const int slot = m_slots[3 * element + side];
    const int column = (std::min)(a, b);
    double* first = values + outer[2 * column] + 2 + 2 * slot;
    double* second = values + outer[2 * column + 1] + 1 + 2 * slot;
    if(a > b)
    {
      first[0] += block(0, 0);
      first[1] += block(1, 0);
      second[0] += block(0, 1);
      second[1] += block(1, 1);
    }
    else
    {
      first[0] += block(0, 0);
      first[1] += block(0, 1);
      second[0] += block(1, 0);
      second[1] += block(1, 1);
    }
  }

  // Solves for the right-hand side; the diagonal is shifted by a tiny part of its mean, which
  // decides directions that no element resists. False if the factorization failed.
  bool solve(const Eigen::VectorXd& right, Eigen::VectorXd& solution)
  {
    double mean = 0;
    const int* outer = m_matrix.outerIndexPtr();
    for(int i = 0; i < 2 * m_size; ++i)
      mean += m_matrix.valuePtr()[outer[i]];
    mean /= 2 * m_size;
    for(const double part : {1e-9, 1e-5, 1e-2})
    {
      m_solver.setShift(part * mean);
      m_solver.factorize(m_matrix);
      if(m_solver.info() != Eigen::Success)
        continue;
      solution = m_solver.solve(right);
      if(m_solver.info() == Eigen::Success && solution.allFinite() && right.dot(solution) > 0)
        return true;
    }
    return false;
  }

private:
  int m_size = 0;
  Matrix m_matrix;
  Solver m_solver;
  std::vector<int> m_slots;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NEWTON_SYSTEM_H
