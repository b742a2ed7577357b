#pragma once

// A Gauss-Seidel smoother: one vertex at a time, by a Newton step in the tangent plane of the
// reference, on the logarithm of its star's energy, sum of exp(s |J|^2 / det J).

#include "Mesh_on_reference.h"
#include "triangle_shape.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

class Star_smoother
{
public:
  // the mesh is moved by run()
  Star_smoother(Mesh_on_reference& mesh, double exponent_factor)
    : m_mesh(mesh),
      m_factor(exponent_factor)
  {}

  void run(int number_of_sweeps)
  {
    for(int sweep = 0; sweep < number_of_sweeps; ++sweep)
      for(int v = 0; v < m_mesh.mesh().number_of_vertices(); ++v)
        if(m_mesh.is_free(v))
          visit(v);
  }

private:
  struct Side // of a vertex' star, in the order of its triangle after the vertex
  {
    Vector b, c, normal;
  };

  void visit(int v)
  {
    collect_star(v);
    const Vector at = m_mesh.point(v);
    const double before = energy(at);
    const Vector step = std::isfinite(before) ? newton_step(v) : centroid() - at;
    const int most_halvings = 5;
    double length = 1;
    for(int i = 0; i <= most_halvings; ++i, length *= 0.5)
    {
      const Mesh_on_reference::Surface_point projection = m_mesh.projection(v, at + length * step);
      if(!turns_a_face(projection.position) && energy(projection.position) < before)
      {
        m_mesh.place(v, projection);
        return;
      }
    }
  }

  void collect_star(int v)
  {
    const auto& mesh = m_mesh.mesh();
    m_star.clear();
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int corner = mesh.vertex_corners[k];
      const Vector &a = m_mesh.point(v), &b = m_mesh.point(mesh.target(corner)),
                   &c = m_mesh.point(mesh.source(mesh.previous(corner)));
      m_star.push_back({b, c, (b - a).cross(c - a)});
    }
  }

  Vector centroid() const
  {
    Vector sum = Vector::Zero();
    for(const Side& side : m_star)
      sum += side.b + side.c;
    return sum / (2 * double(m_star.size()));
  }

  // the logarithm of the sum of the exponentials, which would overflow
  double energy(const Vector& at) const
  {
    m_exponents.clear();
    for(const Side& side : m_star)
      m_exponents.push_back(m_factor * triangle_shape(at, side.b, side.c));
    const double largest = *std::max_element(m_exponents.begin(), m_exponents.end());
    if(!std::isfinite(largest))
      return std::numeric_limits<double>::infinity();
    double sum = 0;
    for(const double e : m_exponents)
      sum += std::exp(e - largest);
    return largest + std::log(sum);
  }

  Vector newton_step(int v) const
  {
    const Vector at = m_mesh.point(v);
    const double value = energy(at);
    Vector gradient = Vector::Zero();
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    for(const Side& side : m_star)
    {
      const Triangle_shape_jet jet = triangle_shape_jet(at, side.b, side.c);
      const double share = m_factor * std::exp(m_factor * jet.value - value);
      gradient += share * jet.gradient;
      hessian += share * jet.hessian + (m_factor * share * jet.gradient) * jet.gradient.transpose();
    }
    hessian -= gradient * gradient.transpose();

    const Vector normal = m_mesh.reference().normal(m_mesh.location(v)).normalized();
    Eigen::Matrix<double, 3, 2> tangents;
    tangents.col(0) = normal.unitOrthogonal();
    tangents.col(1) = normal.cross(tangents.col(0));
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
    solver.computeDirect(tangents.transpose() * hessian * tangents);
    // a step against the gradient also where the energy is not convex
    Eigen::Vector2d curvature = solver.eigenvalues().cwiseAbs();
    curvature = curvature.cwiseMax(1e-3 * curvature.maxCoeff());
    const Eigen::Vector2d slope =
      solver.eigenvectors().transpose() * tangents.transpose() * gradient;
    return -(tangents * (solver.eigenvectors() * slope.cwiseQuotient(curvature)));
  }

  bool turns_a_face(const Vector& at) const
  {
    for(const Side& side : m_star)
      if((side.b - at).cross(side.c - at).dot(side.normal) <= 0 && !side.normal.isZero(0))
        return true;
    return false;
  }

  Mesh_on_reference& m_mesh;
  double m_factor;
  std::vector<Side> m_star;
  mutable std::vector<double> m_exponents;
};
