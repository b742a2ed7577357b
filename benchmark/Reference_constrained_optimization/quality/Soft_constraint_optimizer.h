#pragma once

// The approach without a hard constraint: vertices move freely in space, and squared distances to
// the reference are part of the energy. In turn, every vertex is projected onto the reference, the
// energy of equation (8) plus the weighted distances to the tangent planes there is minimized, and
// the weight is raised. A last projection puts the vertices onto the reference.

#include "Mesh_on_reference.h"
#include "limited_memory_bfgs.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

class Soft_constraint_optimizer
{
  typedef Mesh_on_reference::Vector Vector;

public:
  struct Settings
  {
    double first_weight = 100, weight_factor = 4; // of squares, in mean edge lengths
    int rounds = 4, iterations_per_round = 300;
    double tolerance = 1e-6; // relative decrease of the energy per iteration that ends a round
  };

  // the mesh is moved by run()
  explicit Soft_constraint_optimizer(Mesh_on_reference& mesh)
    : m_mesh(mesh),
      m_unit(mesh.mean_edge_length())
  {}

  // returns the number of iterations
  int run(const Settings& settings)
  {
    const int n = m_mesh.mesh().number_of_vertices();
    Eigen::VectorXd x(3 * n);
    for(int v = 0; v < n; ++v)
      x.segment<3>(3 * v) = m_mesh.point(v) / m_unit;
    m_weight = settings.first_weight;
    int iterations = 0;
    for(int round = 0; round < settings.rounds; ++round, m_weight *= settings.weight_factor)
    {
      renew_planes();
      renew_normals(x);
      iterations +=
        minimize([this](const Eigen::VectorXd& y, Eigen::VectorXd& g) { return energy(y, g); }, x,
                 1e-2, settings.iterations_per_round, settings.tolerance);
      for(int v = 0; v < n; ++v)
        if(m_mesh.is_free(v))
          m_mesh.place(v, m_mesh.projection(v, m_unit * x.segment<3>(3 * v)));
    }
    return iterations;
  }

private:
  struct Plane
  {
    Vector point, normal;
  };

  // lengths are in mean edges from here on, so that weights mean the same for every mesh
  void renew_planes()
  {
    m_planes.resize(m_mesh.mesh().number_of_vertices());
    for(int v = 0; v < m_mesh.mesh().number_of_vertices(); ++v)
      if(m_mesh.is_free(v))
        m_planes[v] = {m_mesh.point(v) / m_unit,
                       m_mesh.reference().normal(m_mesh.location(v)).normalized()};
  }

  // The normals that areas are signed by: in space, the shape of a triangle does not tell which side
  // is up. Those of the reference, except for faces that are inverted already.
  void renew_normals(const Eigen::VectorXd& x)
  {
    const auto& mesh = m_mesh.mesh();
    m_normals.resize(mesh.number_of_faces());
    for(int f = 0; f < mesh.number_of_faces(); ++f)
    {
      const Vector a = corner(x, f, 0), b = corner(x, f, 1), c = corner(x, f, 2);
      const Vector own = (b - a).cross(c - a);
      Vector sum = Vector::Zero();
      for(int i = 0; i < 3; ++i)
        sum += m_mesh.reference().normal(m_mesh.location(corner_vertex(f, i)));
      m_normals[f] = (own.dot(sum) > 0 ? sum : own).normalized();
    }
  }

  int corner_vertex(int f, int i) const
  {
    return m_mesh.mesh().corner_vertex[m_mesh.mesh().face_begin[f] + i % 3];
  }
  Vector corner(const Eigen::VectorXd& x, int f, int i) const
  {
    return x.segment<3>(3 * corner_vertex(f, i));
  }

  // infinite if a face is inverted
  double energy(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const
  {
    gradient.setZero();
    const double root = std::sqrt(3.);
    double sum = 0;
    for(int f = 0; f < m_mesh.mesh().number_of_faces(); ++f)
    {
      if(m_normals[f].isZero(0)) // a face without area
        continue;
      const Vector p[3] = {corner(x, f, 0), corner(x, f, 1), corner(x, f, 2)};
      const double area = root * (p[1] - p[0]).cross(p[2] - p[0]).dot(m_normals[f]);
      if(!(area > 0))
        return std::numeric_limits<double>::infinity();
      const double shape =
        ((p[1] - p[0]).squaredNorm() + (p[2] - p[1]).squaredNorm() + (p[0] - p[2]).squaredNorm()) /
        area;
      // a few slivers would dominate the energy: continued linearly beyond the cap
      const double cap = 20, e = std::exp((std::min)(shape, cap));
      sum += shape < cap ? e : e * (1 + shape - cap);
      for(int i = 0; i < 3; ++i)
      {
        const Vector &b = p[(i + 1) % 3], &c = p[(i + 2) % 3];
        if(m_mesh.is_free(corner_vertex(f, i)))
          gradient.segment<3>(3 * corner_vertex(f, i)) +=
            e / area * (2 * (2 * p[i] - b - c) - shape * root * m_normals[f].cross(c - b));
      }
    }
    for(int v = 0; v < m_mesh.mesh().number_of_vertices(); ++v)
      if(m_mesh.is_free(v))
      {
        const double d = m_planes[v].normal.dot(x.segment<3>(3 * v) - m_planes[v].point);
        sum += m_weight * d * d;
        gradient.segment<3>(3 * v) += 2 * m_weight * d * m_planes[v].normal;
      }
    return sum;
  }

  Mesh_on_reference& m_mesh;
  double m_unit, m_weight = 0;
  std::vector<Plane> m_planes;
  std::vector<Vector> m_normals;
};
