// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// An energy of stencils, without derivatives.

#pragma once

#include <CGAL/Reference_constrained_optimization/Energy_stencil.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace rco_test {

namespace RCO = CGAL::Reference_constrained_optimization;

// Stencils of six vertices that are zero for collinear ones: the sum of squared second differences along a
// row. Derivatives are computed by the library.
struct Straight_rows
{
  static constexpr int stencil_size = 6;
  int columns, rows; // of vertices

  template <typename Context>
  void append_stencils(const Context&, std::vector<RCO::Energy_stencil<6>>& stencils) const
  {
    for(int j = 0; j < rows; ++j)
      for(int i = 0; i + 5 < columns; ++i)
      {
        RCO::Energy_stencil<6> stencil;
        for(int k = 0; k < 6; ++k)
          stencil.vertices[k] = std::size_t(j * columns + i + k);
        stencils.push_back(stencil);
      }
  }

  double value(std::size_t, const std::array<Eigen::Vector3d, 6>& p) const
  {
    double sum = 0;
    for(int k = 1; k < 5; ++k)
      sum += (p[k - 1] - 2 * p[k] + p[k + 1]).squaredNorm();
    return double(columns * columns) * sum;
  }
};

} // namespace rco_test
