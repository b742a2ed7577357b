// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_BLOCK_LDLT_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_BLOCK_LDLT_H

#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <Eigen/Core>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Sparse L D L^T of symmetric positive definite matrices of 2x2 blocks: a block per vertex of a
// graph and one per edge. Order, elimination tree and pattern are those of the graph, a quarter of
// the scalar matrix's. Rows of L are computed one by one (T. A. Davis, Algorithm 849: A Concise
// Sparse Cholesky Factorization Package, 2005), and columns of L with the same pattern, of which
// there are many, are applied two at a time.
//
// The values are summed right into the permuted upper triangle, and nothing is allocated after
// `analyze`. The same calls give the same bits.
class Block_LDLT
{
public:
  // The graph of so many vertices and of the edges `pairs`: in any direction, repeated or not;
  // those with a negative end are skipped, and no edge is a loop.
  void analyze(int number_of_vertices, const std::vector<std::array<int, 2>>& pairs)
  {
    m_size = number_of_vertices;
    collect_edges(pairs);
    order();
    permute();
    find_pattern();
    m_values.resize(m_value_row.size());
    m_diagonal.resize(m_size);
    m_factor.resize(m_column_row.size());
    m_inverse.resize(m_size);
    m_row.assign(m_size, Block());
    m_x.resize(2 * m_size);
  }

  int size() const { return m_size; }

  void set_zero()
  {
    std::fill(m_values.begin(), m_values.end(), Block());
    std::fill(m_diagonal.begin(), m_diagonal.end(), Block());
  }

  // adds to the diagonal block of vertex `a`
  void add_diagonal(int a, const Eigen::Matrix2d& block)
  {
    Block& sum = m_diagonal[m_position[a]];
    for(int i = 0; i < 4; ++i)
      sum.v[i] += block.data()[i];
  }

  // adds to the block of rows a, columns b, and its transpose to that of rows b, columns a; {a, b}
  // are the ends of pair number `pair` of `analyze`
  void add(int pair, int a, int b, const Eigen::Matrix2d& block)
  {
    Block& sum = m_values[m_slot[pair]];
    const int swapped = m_position[a] > m_position[b];
    sum.v[0] += block(0, 0);
    sum.v[1 + swapped] += block(1, 0);
    sum.v[2 - swapped] += block(0, 1);
    sum.v[3] += block(1, 1);
  }

  // of the matrix, without a shift
  double trace() const
  {
    double sum = 0;
    for(const Block& d : m_diagonal)
      sum += d.v[0] + d.v[3];
    return sum;
  }

  // factorizes the matrix plus `shift` times the identity; false if that is not positive definite. After an
  // interruption the next call starts from the beginning.
  bool factorize(double shift, Interruption* interruption = nullptr)
  {
    std::fill(m_row.begin(), m_row.end(), Block()); // it is incomplete after a failure
    std::copy(m_column_begin.begin(), m_column_begin.end() - 1, m_column_end.begin());
    for(int k = 0; k < m_size; ++k)
    {
      check_periodically(interruption, k);
      for(int p = m_value_begin[k]; p < m_value_begin[k + 1]; ++p)
        m_row[m_value_row[p]] = m_values[p];
      const Block& diagonal = m_diagonal[k];
      double d[3] = {diagonal.v[0] + shift, diagonal.v[1], diagonal.v[3] + shift};
      const int end = m_row_begin[k + 1];
      for(int q = m_row_begin[k]; q < end;)
      {
        const int j = m_row_column[q];
        if(m_has_same_rows[j] && q + 1 < end)
        {
          apply_columns<2>(j, d);
          q += 2;
        }
        else
        {
          apply_columns<1>(j, d);
          ++q;
        }
      }
      if(!invert(d[0], d[1], d[2], m_inverse[k]))
        return false;
    }
    return true;
  }

  // the solution for the last factorization; both may be the same vector
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& solution)
  {
    for(int i = 0; i < m_size; ++i)
    {
      m_x[2 * m_position[i]] = rhs(2 * i);
      m_x[2 * m_position[i] + 1] = rhs(2 * i + 1);
    }
    for(int j = 0; j < m_size; ++j)
    {
      const double x0 = m_x[2 * j], x1 = m_x[2 * j + 1];
      for(int p = m_column_begin[j]; p < m_column_begin[j + 1]; ++p)
      {
        const Block& l = m_factor[p];
        double* x = &m_x[2 * m_column_row[p]];
        x[0] -= l.v[0] * x0 + l.v[2] * x1;
        x[1] -= l.v[1] * x0 + l.v[3] * x1;
      }
    }
    for(int j = m_size - 1; j >= 0; --j)
    {
      const Block& d = m_inverse[j];
      double x0 = d.v[0] * m_x[2 * j] + d.v[2] * m_x[2 * j + 1];
      double x1 = d.v[1] * m_x[2 * j] + d.v[3] * m_x[2 * j + 1];
      for(int p = m_column_begin[j]; p < m_column_begin[j + 1]; ++p)
      {
        const Block& l = m_factor[p];
        const double* x = &m_x[2 * m_column_row[p]];
        x0 -= l.v[0] * x[0] + l.v[1] * x[1];
        x1 -= l.v[2] * x[0] + l.v[3] * x[1];
      }
      m_x[2 * j] = x0;
      m_x[2 * j + 1] = x1;
    }
    solution.resize(2 * m_size);
    for(int i = 0; i < m_size; ++i)
    {
      solution(2 * i) = m_x[2 * m_position[i]];
      solution(2 * i + 1) = m_x[2 * m_position[i] + 1];
    }
  }

private:
  // in column-major order
  struct alignas(32) Block
  {
    double v[4];
  };

  // written with local values, since compilers reload those that a store may change
  static void subtract_product(const Block& l, const Block& z, Block& sum)
  {
    const double s0 = sum.v[0] - (l.v[0] * z.v[0] + l.v[2] * z.v[1]);
    const double s1 = sum.v[1] - (l.v[1] * z.v[0] + l.v[3] * z.v[1]);
    const double s2 = sum.v[2] - (l.v[0] * z.v[2] + l.v[2] * z.v[3]);
    const double s3 = sum.v[3] - (l.v[1] * z.v[2] + l.v[3] * z.v[3]);
    sum = {{s0, s1, s2, s3}};
  }

  // Adds to the row of L being computed its entries in `width` columns of the same pattern, which
  // begin at j, and takes their part from the diagonal block (d[0], d[1]; d[1], d[2]).
  template <int width>
  void apply_columns(int j, double* d)
  {
    Block z[width];
    const Block* l[width];
    const int number = m_column_end[j] - m_column_begin[j] - (width - 1);
    for(int c = 0; c < width; ++c)
    {
      z[c] = m_row[j + c];
      m_row[j + c] = Block();
      l[c] = &m_factor[m_column_begin[j + c]];
      for(int b = 0; b < c; ++b)
        subtract_product(*l[b]++, z[b], z[c]);
    }
    const int* rows = &m_column_row[m_column_begin[j] + width - 1];
    for(int p = 0; p < number; ++p)
    {
      Block sum = m_row[rows[p]];
      for(int c = 0; c < width; ++c)
        subtract_product(l[c][p], z[c], sum);
      m_row[rows[p]] = sum;
    }
    for(int c = 0; c < width; ++c)
    {
      const Block &inverse = m_inverse[j + c], &y = z[c];
      const double l0 = inverse.v[0] * y.v[0] + inverse.v[2] * y.v[1];
      const double l1 = inverse.v[1] * y.v[0] + inverse.v[3] * y.v[1];
      const double l2 = inverse.v[0] * y.v[2] + inverse.v[2] * y.v[3];
      const double l3 = inverse.v[1] * y.v[2] + inverse.v[3] * y.v[3];
      d[0] -= l0 * y.v[0] + l1 * y.v[1];
      d[1] -= l2 * y.v[0] + l3 * y.v[1];
      d[2] -= l2 * y.v[2] + l3 * y.v[3];
      m_factor[m_column_end[j + c]++] = {{l0, l2, l1, l3}};
    }
  }

  // false if the symmetric block is not positive definite
  static bool invert(double d0, double d1, double d3, Block& inverse)
  {
    const double infinity = std::numeric_limits<double>::infinity();
    if(!(d0 > 0 && d0 < infinity))
      return false;
    const double factor = d1 / d0, rest = d3 - factor * d1;
    if(!(rest > 0 && rest < infinity))
      return false;
    const double i3 = 1 / rest, i1 = -factor * i3;
    inverse = {{1 / d0 - factor * i1, i1, i1, i3}};
    return true;
  }

  // prefix sums: turns counts, which begin at [1], into offsets
  static void prefix_sums(std::vector<int>& begins)
  {
    for(std::size_t i = 1; i < begins.size(); ++i)
      begins[i] += begins[i - 1];
  }

  // m_slot: which edge a pair is; m_edges: the graph, each edge once, by its smaller vertex
  void collect_edges(const std::vector<std::array<int, 2>>& pairs)
  {
    m_begin.assign(m_size + 1, 0);
    for(const auto& p : pairs)
      if(p[0] >= 0 && p[1] >= 0)
        ++m_begin[(std::min)(p[0], p[1]) + 1];
    prefix_sums(m_begin);
    m_list.resize(m_begin[m_size]);
    m_next.assign(m_begin.begin(), m_begin.end() - 1);
    for(std::size_t i = 0; i < pairs.size(); ++i)
      if(pairs[i][0] >= 0 && pairs[i][1] >= 0)
        m_list[m_next[(std::min)(pairs[i][0], pairs[i][1])]++] = int(i);

    m_slot.assign(pairs.size(), -1);
    m_mark.assign(m_size, -1); // the last edge to a vertex
    m_edges.resize(m_size, m_size);
    m_edges.resizeNonZeros(m_size + m_begin[m_size]);
    int* outer = m_edges.outerIndexPtr();
    int* inner = m_edges.innerIndexPtr();
    int count = 0;
    for(int a = 0; a < m_size; ++a)
    {
      outer[a] = count;
      inner[count++] = a; // the ordering takes vertices without a diagonal for dense ones
      for(int p = m_begin[a]; p < m_begin[a + 1]; ++p)
      {
        const std::array<int, 2>& pair = pairs[m_list[p]];
        const int b = (std::max)(pair[0], pair[1]);
        if(m_mark[b] < outer[a])
        {
          m_mark[b] = count;
          inner[count++] = b;
        }
        m_slot[m_list[p]] = m_mark[b];
      }
    }
    outer[m_size] = count;
    m_edges.resizeNonZeros(count);
    std::fill(m_edges.valuePtr(), m_edges.valuePtr() + count, 0);
  }

  void order()
  {
    m_ordering(m_edges.selfadjointView<Eigen::Lower>(), m_permutation);
    m_position.resize(m_size);
    for(int k = 0; k < m_size; ++k)
      m_position[m_permutation.indices()(k)] = k;
  }

  // where the blocks of the upper triangle are, column by column; m_slot refers to them afterwards
  void permute()
  {
    const int* outer = m_edges.outerIndexPtr();
    const int* inner = m_edges.innerIndexPtr();
    const int count = outer[m_size];
    m_value_begin.assign(m_size + 1, 0);
    for(int a = 0; a < m_size; ++a)
      for(int e = outer[a] + 1; e < outer[a + 1]; ++e)
        ++m_value_begin[(std::max)(m_position[a], m_position[inner[e]]) + 1];
    prefix_sums(m_value_begin);
    m_next.assign(m_value_begin.begin(), m_value_begin.end() - 1);
    m_value_row.resize(count - m_size);
    m_list.resize(count);
    for(int a = 0; a < m_size; ++a)
      for(int e = outer[a] + 1; e < outer[a + 1]; ++e)
      {
        const int i = m_position[a], j = m_position[inner[e]];
        m_list[e] = m_next[(std::max)(i, j)]++;
        m_value_row[m_list[e]] = (std::min)(i, j);
      }
    for(int& slot : m_slot)
      if(slot >= 0)
        slot = m_list[slot];
  }

  // the pattern of L: the rows of each column and the columns of each row, in ascending order
  void find_pattern()
  {
    m_parent.assign(m_size, -1); // in the elimination tree
    m_mark.assign(m_size, -1);
    m_column_begin.assign(m_size + 1, 0);
    m_row_begin.resize(m_size + 1);
    m_row_column.clear();
    for(int k = 0; k < m_size; ++k)
    {
      m_row_begin[k] = int(m_row_column.size());
      m_mark[k] = k;
      for(int p = m_value_begin[k]; p < m_value_begin[k + 1]; ++p)
        for(int j = m_value_row[p]; m_mark[j] != k; j = m_parent[j])
        {
          if(m_parent[j] < 0)
            m_parent[j] = k;
          m_mark[j] = k;
          m_row_column.push_back(j);
          ++m_column_begin[j + 1];
        }
    }
    m_row_begin[m_size] = int(m_row_column.size());
    prefix_sums(m_column_begin);
    m_column_end.assign(m_column_begin.begin(), m_column_begin.end() - 1);
    m_column_row.resize(m_row_column.size());
    for(int k = 0; k < m_size; ++k)
      for(int q = m_row_begin[k]; q < m_row_begin[k + 1]; ++q)
        m_column_row[m_column_end[m_row_column[q]]++] = k;
    m_next.assign(m_row_begin.begin(), m_row_begin.end() - 1);
    m_has_same_rows.assign(m_size, 0);
    for(int j = 0; j < m_size; ++j)
    {
      for(int p = m_column_begin[j]; p < m_column_begin[j + 1]; ++p)
        m_row_column[m_next[m_column_row[p]]++] = j;
      m_has_same_rows[j] =
        m_parent[j] == j + 1 && m_column_begin[j + 1] - m_column_begin[j] ==
                                  m_column_begin[j + 2] - m_column_begin[j + 1] + 1;
    }
  }

  typedef Eigen::SparseMatrix<signed char> Graph;

  int m_size = 0;
  Graph m_edges;
  Eigen::AMDOrdering<int> m_ordering;
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> m_permutation;
  std::vector<int> m_position; // of a vertex in the order of elimination
  std::vector<int> m_slot;     // of a pair in m_values
  // the upper triangle of the matrix by columns
  std::vector<int> m_value_begin, m_value_row;
  std::vector<Block> m_values, m_diagonal;
  // L: by columns, with the rows' columns besides
  std::vector<int> m_column_begin, m_column_row, m_row_begin, m_row_column;
  std::vector<char> m_has_same_rows; // the next column has the same rows
  std::vector<Block> m_factor, m_inverse;
  std::vector<Block> m_row;
  std::vector<int> m_column_end;
  std::vector<double> m_x;
  std::vector<int> m_parent, m_mark, m_begin, m_next, m_list;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_NUMERICS_BLOCK_LDLT_H
