// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_MOVER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_MOVER_H

#include <CGAL/Reference_constrained_optimization/internal/projected_newton.h>
#include <CGAL/Reference_constrained_optimization/internal/seconds_since.h>
#include <CGAL/Reference_constrained_optimization/internal/sliding.h>
#include <CGAL/Reference_constrained_optimization/internal/surface_metric.h>

#include <Eigen/Core>

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A patch's energy as a function of the coordinates of each vertex in its own tangent plane, to first
// order: vertex i is at p_i + T_i u_i, and an element's shape is seen in the plane of the element. The
// second column of T_i is zero for vertices that slide along a line.
struct Tangent_problem
{
  typedef Eigen::Matrix<double, 3, 2> Frame;

  std::vector<std::array<int, 3>> triples;
  std::vector<Eigen::Matrix2d> rest_inverse;
  std::vector<char> is_free; // per vertex

  std::vector<Eigen::Matrix2d> shapes;      // at u = 0
  std::vector<Eigen::Matrix2d> corner_maps; // three per element

  Eigen::Matrix2d shape(std::size_t e, const std::vector<Vector_2>& u) const
  {
    const std::array<int, 3>& t = triples[e];
    const Vector_2 first = corner_map(e, 0) * u[t[0]];
    Eigen::Matrix2d result = shapes[e];
    result.col(0) += corner_map(e, 1) * u[t[1]] - first;
    result.col(1) += corner_map(e, 2) * u[t[2]] - first;
    return result;
  }
  const Eigen::Matrix2d& corner_map(std::size_t e, int i) const { return corner_maps[3 * e + i]; }
};

// Moves the vertices of a patch directly along R: Newton steps in the tangent planes, then back to R
// by the local closest point. Much cheaper than a flattened patch, as accurate where steps are
// small; but what is folded stays folded.
class On_surface_mover
{
public:
  On_surface_mover(const Reference_surface& reference, int newton_steps)
    : m_reference(reference),
      m_newton_steps(newton_steps)
  {}

  template <typename Density>
  bool propose(const Patch& patch, const Density& density)
  {
    m_optimization_time = 0;
    const auto start = std::chrono::steady_clock::now();
    m_problem.triples.clear();
    m_problem.rest_inverse.clear();
    m_problem.is_free = patch.is_free;
    for(const Element_set::Element& e : patch.elements)
    {
      m_problem.triples.push_back(e.vertices);
      m_problem.rest_inverse.push_back(e.rest_inverse);
    }
    m_newton.analyze(m_problem);
    m_optimization_time += seconds_since(start);
    return propose_again(patch, {}, density);
  }

  // from where the vertices are now
  template <typename Density>
  bool propose_again(const Patch& patch, const std::vector<double>&, const Density& density)
  {
    const auto start = std::chrono::steady_clock::now();
    linearize(patch);
    m_motion.assign(patch.vertices.size(), Vector_2::Zero());
    const int steps = m_newton.minimize(m_problem, density, m_motion, m_newton_steps, 1e-8).steps;
    m_optimization_time += seconds_since(start);
    return steps > 0;
  }

  // the vertex after the part t of its way; false if R is not found there
  bool place(const Patch& patch, int v, double t, Placed_vertex& result) const
  {
    const Placed_vertex& from = patch.placed[v];
    if(patch.slides(v))
      return slide(patch, v, t * m_motion[v](0), m_reference, result);
    const Vector_3 way = t * (m_frames[v] * m_motion[v]);
    const Vector_3 target = from.position + way;
    const Surface_point foot = m_reference.descend(target, from.on_reference.face);
    const Vector_3 normal = m_reference.normal(foot);
    // a tangent leaves R slowly; else the surface ends here, or turns away
    if((foot.position - target).squaredNorm() > 0.25 * way.squaredNorm() ||
       !(normal.dot(from.normal) > 0))
      return false;
    result.on_reference = foot;
    result.position = foot.position;
    result.normal = normal;
    return true;
  }

  double motion_length(int v) const { return m_motion[v].norm(); }
  double optimization_time() const { return m_optimization_time; }

private:
  static Tangent_problem::Frame frame(const Vector_3& normal)
  {
    int axis = 0;
    normal.cwiseAbs().minCoeff(&axis);
    Tangent_problem::Frame result;
    result.col(0) = normal.cross(Vector_3::Unit(axis)).normalized();
    result.col(1) = normal.cross(result.col(0)).normalized();
    return result;
  }

  // R's own plane where there is one: only in it is the model of first order
  Vector_3 tangent_normal(const Placed_vertex& v) const
  {
    const bool is_inside = v.on_reference.barycentric.minCoeff() > 0;
    return is_inside ? m_reference.face_normal(v.on_reference.face) : v.normal;
  }

  void linearize(const Patch& patch)
  {
    m_frames.resize(patch.vertices.size());
    for(std::size_t v = 0; v < patch.vertices.size(); ++v)
      if(patch.slides(int(v)))
        m_frames[v] << patch.lines->tangent(patch.placed[v].on_line), Vector_3::Zero();
      else
        m_frames[v] = frame(tangent_normal(patch.placed[v]));
    m_problem.shapes.clear();
    m_problem.corner_maps.clear();
    for(const Element_set::Element& e : patch.elements)
    {
      const Placed_vertex* p[3];
      for(int i = 0; i < 3; ++i)
        p[i] = &patch.placed[e.vertices[i]];
      const Vector_3 a = p[1]->position - p[0]->position, b = p[2]->position - p[0]->position;
      const Vector_3 outward = p[0]->normal + p[1]->normal + p[2]->normal;
      Vector_3 normal = a.cross(b);
      if(normal.squaredNorm() > 1e-20 * a.squaredNorm() * b.squaredNorm())
        normal *= normal.dot(outward) < 0 ? -1 : 1;
      else
        normal = outward; // no plane of its own
      const Tangent_problem::Frame plane = frame(normal);
      Eigen::Matrix2d shape;
      shape.col(0) = plane.transpose() * a;
      shape.col(1) = plane.transpose() * b;
      m_problem.shapes.push_back(shape);
      for(int i = 0; i < 3; ++i)
        m_problem.corner_maps.push_back(plane.transpose() * m_frames[e.vertices[i]]);
    }
  }

  const Reference_surface& m_reference;
  int m_newton_steps;
  Projected_newton m_newton;
  Tangent_problem m_problem;
  std::vector<Tangent_problem::Frame> m_frames; // per vertex
  std::vector<Vector_2> m_motion;               // per vertex, in its frame
  double m_optimization_time = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_MOVER_H
