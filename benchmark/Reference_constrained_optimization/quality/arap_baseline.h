#pragma once

// What compatible meshes are compared with: an as-rigid-as-possible energy of the map plus a soft
// constraint to the reference, as in "Volume-enhanced compatible remeshing" (Yang, Zhang, Fu, Liu),
// as far as the paper of this package describes that. It is no reimplementation of that article.

#include "../meshes.h"

#include <CGAL/Reference_constrained_optimization/internal/mesh/surface_metric.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

struct Arap_parameters
{
  int number_of_iterations = 20;
  // Of the squared distance to the tangent plane of the reference at the closest point, growing
  // geometrically from iteration to iteration; a regular vertex has the stiffness 3.5.
  double first_weight = 10, last_weight = 1000;
  // The same for the distance within the tangent plane: sliding is to be free, but the system
  // definite.
  double tangential_weight = 1e-3;
  // Weights of triangles are areas to this power. 1 is the integral over the surface, 0 the sum
  // over triangles that the mean distortion is; the latter folds small triangles.
  double area_exponent = 0.5;
};

// Local and global steps in turn. Of the variants tried, the distance to the closest point instead
// of its tangent plane left several times as many flips and folds at about the same mean;
// projection in the end only left slivers; the closest point of the whole reference instead of the
// local one left a few flips more.
class Arap_baseline
{
  typedef RCO::internal::Mesh_copy Mesh_copy;
  typedef RCO::internal::Reference_surface Reference_surface;
  typedef Eigen::SparseMatrix<double> Matrix;
  typedef Eigen::Matrix<double, Eigen::Dynamic, 3> Rows;

public:
  // `source` gives the shapes at rest
  Arap_baseline(const Mesh_copy& source,
                const Reference_surface& reference,
                const Arap_parameters& p)
    : m_reference(reference),
      m_parameters(p)
  {
    const double scale =
      std::sqrt(reference.area() / RCO::internal::surface_area(source.mesh, source.points));
    const double mean_area = reference.area() / source.mesh.number_of_faces();
    std::vector<Eigen::Triplet<double>> gradient;
    std::vector<double> weights;
    for(int f = 0; f < source.mesh.number_of_faces(); ++f)
      for(const std::array<int, 3>& t : RCO::internal::split_face(source.mesh, source.points, f))
      {
        std::array<int, 3> v;
        for(int i = 0; i < 3; ++i)
          v[i] = source.mesh.corner_vertex[t[i]];
        const Eigen::Matrix2d rest =
          scale * RCO::internal::triangle_shape(source.points[v[0]], source.points[v[1]],
                                                source.points[v[2]]);
        const Eigen::Matrix2d inverse = rest.inverse();
        for(int k = 0; k < 2; ++k)
        {
          const int row = int(weights.size());
          gradient.emplace_back(row, v[0], -inverse(0, k) - inverse(1, k));
          gradient.emplace_back(row, v[1], inverse(0, k));
          gradient.emplace_back(row, v[2], inverse(1, k));
          // an exponent of 1 leads to the cotangent Laplacian
          weights.push_back(mean_area *
                            std::pow(0.5 * rest.determinant() / mean_area, p.area_exponent));
        }
      }
    m_gradient.resize(Eigen::Index(weights.size()), Eigen::Index(source.points.size()));
    m_gradient.setFromTriplets(gradient.begin(), gradient.end());
    m_weighted_transpose =
      m_gradient.transpose() *
      Eigen::Map<Eigen::VectorXd>(weights.data(), Eigen::Index(weights.size())).asDiagonal();
    make_system();
  }

  // moves the points, which then lie on the reference
  void run(std::vector<Eigen::Vector3d>& points)
  {
    const int n = int(points.size());
    std::vector<int> face(n);
    for(int v = 0; v < n; ++v)
    {
      const auto projection = m_reference.closest(points[v]);
      face[v] = projection.face;
      points[v] = projection.position;
    }
    Rows positions(n, 3);
    Eigen::VectorXd right(3 * n);
    for(int i = 0; i < m_parameters.number_of_iterations; ++i)
    {
      for(int v = 0; v < n; ++v)
        positions.row(v) = points[v].transpose();
      const Rows target = m_weighted_transpose * closest_isometries(m_gradient * positions);
      const double progress = double(i) / (std::max)(1, m_parameters.number_of_iterations - 1);
      const double weight =
        m_parameters.first_weight *
        std::pow(m_parameters.last_weight / m_parameters.first_weight, progress);
      Matrix system = m_stiffness;
      for(int v = 0; v < n; ++v)
      {
        const Eigen::Vector3d normal =
          m_reference.normal(m_reference.closest_in_face(points[v], face[v])).normalized();
        const Eigen::Matrix3d block = weight * normal * normal.transpose() +
                                      m_parameters.tangential_weight * Eigen::Matrix3d::Identity();
        for(int b = 0; b < 3; ++b)
          for(int a = b; a < 3; ++a)
            system.coeffRef(3 * v + a, 3 * v + b) += block(a, b);
        right.segment<3>(3 * v) = target.row(v).transpose() + block * points[v];
      }
      m_solver.factorize(system);
      const Eigen::VectorXd solution = m_solver.solve(right);
      for(int v = 0; v < n; ++v)
      {
        const auto projection = m_reference.local_closest(solution.segment<3>(3 * v), face[v]);
        face[v] = projection.face;
        points[v] = projection.position;
      }
    }
  }

private:
  // the pattern of the system, of three unknowns a vertex, and its part that does not change
  void make_system()
  {
    const Matrix laplacian = m_weighted_transpose * m_gradient;
    std::vector<Eigen::Triplet<double>> entries;
    for(Eigen::Index j = 0; j < laplacian.cols(); ++j)
    {
      for(Matrix::InnerIterator i(laplacian, j); i; ++i)
        if(i.row() >= j)
          for(int k = 0; k < 3; ++k)
            entries.emplace_back(int(3 * i.row() + k), int(3 * j + k), i.value());
      for(int b = 0; b < 3; ++b)
        for(int a = b; a < 3; ++a)
          entries.emplace_back(int(3 * j + a), int(3 * j + b), 0.);
    }
    m_stiffness.resize(3 * laplacian.rows(), 3 * laplacian.cols());
    m_stiffness.setFromTriplets(entries.begin(), entries.end());
    m_solver.analyzePattern(m_stiffness);
  }

  // replaces every transposed Jacobian J^T (two rows) by the closest one of an isometry,
  // (J^T J)^(-1/2) J^T, with the square root of a 2x2 matrix in closed form
  static Rows closest_isometries(Rows jacobians)
  {
    for(Eigen::Index r = 0; r < jacobians.rows(); r += 2)
    {
      auto j = jacobians.middleRows<2>(r);
      Eigen::Matrix2d metric = j * j.transpose();
      const double trace = metric.trace();
      const double root = (std::max)(std::sqrt((std::max)(0., metric.determinant())), 1e-6 * trace);
      metric.diagonal().array() += root;
      if(trace > 0)
        j = (std::sqrt(trace + 2 * root) * metric.inverse() * j).eval();
    }
    return jacobians;
  }

  const Reference_surface& m_reference;
  Arap_parameters m_parameters;
  // Jacobians of the map from the positions, two rows a triangle; and its transpose, weighted
  Matrix m_gradient, m_weighted_transpose;
  Matrix m_stiffness; // lower triangle
  Eigen::SimplicialLDLT<Matrix> m_solver;
};

// Deforms `mesh`, of the source's connectivity, on the reference; returns the number of iterations.
// Border vertices move, too: meant for closed surfaces.
inline int arap_baseline(const Mesh& source,
                         const Mesh& reference,
                         Mesh& mesh,
                         const Arap_parameters& p = Arap_parameters())
{
  const auto np = CGAL::parameters::default_values();
  const RCO::internal::Reference_surface surface(
    RCO::internal::read_measured_mesh(reference, np, "reference"));
  std::vector<Eigen::Vector3d> points = RCO::internal::read_measured_mesh(mesh, np, "mesh").points;
  Arap_baseline(RCO::internal::read_measured_mesh(source, np, "source"), surface, p).run(points);
  std::size_t i = 0;
  for(const auto v : mesh.vertices())
  {
    if(!mesh.is_isolated(v))
      mesh.point(v) = Mesh::Point(points[i].x(), points[i].y(), points[i].z());
    ++i;
  }
  return p.number_of_iterations;
}
