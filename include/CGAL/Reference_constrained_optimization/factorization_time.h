// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_FACTORIZATION_TIME_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_FACTORIZATION_TIME_H

#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * is the number of vertices above which running times are not reported in units of a factorization: fill-in
 * and memory traffic grow faster than the mesh, so that a method would seem fast.
 */
constexpr std::size_t factorization_time_vertex_limit = 200000;

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * measures the time of one numeric factorization of the system that a Newton step on the whole mesh
 * would solve, in seconds of wall-clock time. Running times divided by it can be compared between
 * machines.
 *
 * The matrix has two unknowns per vertex and a 2x2 block for every vertex, every edge and both
 * diagonals of every quad: for a triangle mesh that is the pattern of its Laplacian. It is positive
 * definite. It is factorized by
 * `Eigen::SimplicialLDLT` in the order of `Eigen::AMDOrdering`; ordering and symbolic analysis are
 * not counted. The factorization is repeated, on small meshes often, and the best time is returned.
 *
 * \param mesh the mesh; isolated vertices are skipped
 * \param np the parameter `vertex_point_map` of `mesh`
 */
template <typename FaceGraph, typename NamedParameters = parameters::Default_named_parameters>
double factorization_time(const FaceGraph& mesh,
                          const NamedParameters& np = parameters::default_values())
{
  typedef Eigen::SparseMatrix<double> Matrix;
  const internal::Mesh_copy copy = internal::read_measured_mesh(mesh, np, "mesh");
  const internal::Indexed_mesh& m = copy.mesh;
  std::vector<int> variable(m.number_of_vertices(), -1);
  int n = 0;
  for(int v = 0; v < m.number_of_vertices(); ++v)
    if(m.vertex_begin[v + 1] > m.vertex_begin[v])
      variable[v] = n++;

  // the Kronecker product of the shifted graph Laplacian and a positive definite 2x2 matrix
  const double block[2][2] = {{1, 0.5}, {0.5, 1}};
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int i, int j, double weight) {
    for(int a = 0; a < 2; ++a)
      for(int b = 0; b < 2; ++b)
        if(2 * i + a >= 2 * j + b)
          entries.emplace_back(2 * i + a, 2 * j + b, weight * block[a][b]);
  };
  for(int i = 0; i < n; ++i)
    add(i, i, 1e-3);
  const auto couple = [&](int v, int w) {
    const int i = variable[v], j = variable[w];
    add(i, i, 1);
    add(j, j, 1);
    add((std::max)(i, j), (std::min)(i, j), -1);
  };
  for(int c = 0; c < m.number_of_corners(); ++c)
    if(m.opposite[c] < c)
      couple(m.source(c), m.target(c));
  for(int f = 0; f < m.number_of_faces(); ++f)
    if(m.degree(f) == 4) // both diagonals are sides of elements
      for(int c = m.face_begin[f]; c < m.face_begin[f] + 2; ++c)
        couple(m.source(c), m.source(c + 2));
  Matrix matrix(2 * n, 2 * n);
  matrix.setFromTriplets(entries.begin(), entries.end());

  Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>> solver;
  solver.analyzePattern(matrix);
  double best = std::numeric_limits<double>::infinity(), total = 0;
  const double enough = 0.5; // seconds
  const int fewest_repeats = 3, most_repeats = 50;
  for(int i = 0; i < most_repeats && (i < fewest_repeats || total < enough); ++i)
  {
    const auto start = std::chrono::steady_clock::now();
    solver.factorize(matrix);
    const double time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    best = (std::min)(best, time);
    total += time;
  }
  return best;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_FACTORIZATION_TIME_H
