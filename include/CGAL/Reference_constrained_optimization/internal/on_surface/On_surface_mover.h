// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_ON_SURFACE_MOVER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_ON_SURFACE_MOVER_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/surface_metric.h>
#include <CGAL/Reference_constrained_optimization/internal/numerics/projected_newton.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Element_densities.h>
#include <CGAL/Reference_constrained_optimization/internal/on_surface/tangent_step.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/crease_direction.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/face_in_direction.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/tangent_frame.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/drift_terms.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Stencil_terms.h>
#include <CGAL/Reference_constrained_optimization/internal/state/sliding.h>
#include <CGAL/Reference_constrained_optimization/internal/support/seconds_since.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A patch's energy as a function of the coordinates of each vertex in its own tangent plane, to first
// order: vertex i is at p_i + T_i u_i, and an element's shape is that in its own plane. The second
// column of T_i is zero for vertices that slide along a line.
struct Tangent_problem
{
  std::vector<std::array<int, 3>> triples;
  std::vector<Eigen::Matrix2d> rest_inverse;
  std::vector<char> is_free;                      // per vertex
  std::vector<std::array<int, 3>> term_triangles; // of the drift barrier's terms
  Drift_terms drift;
  Stencil_terms stencils;
  static Vector_2 origin(int) { return Vector_2::Zero(); }

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

// The strain regularization after a step of which the given fraction was accepted: smaller if that is
// nearly all of it, larger if much of it was cut.
constexpr double largest_regularization = 0.05;
inline double adapted_regularization(double regularization, double accepted_fraction)
{
  const double smallest_regularization = 0.001;
  if(accepted_fraction > 0.95)
    return (std::max)(smallest_regularization, 0.25 * regularization);
  return accepted_fraction < 0.8 ? (std::min)(6 * largest_regularization, 2.5 * regularization)
                                 : regularization;
}

// Moves the vertices of a patch directly along R: Newton steps in the tangent planes, then back to R
// by the local closest point. Much cheaper than flattening, and as accurate for small steps; but folds are
// not removed.
class On_surface_mover
{
public:
  On_surface_mover(const Reference_surface& reference,
                   int newton_steps,
                   Interruption* interruption = nullptr)
    : m_reference(reference),
      m_newton_steps(newton_steps),
      m_interruption(interruption),
      m_newton(interruption)
  {}

  // of the first step of the patches to come; see Projected_newton
  void set_strain_regularization(double factor) { m_initial_regularization = factor; }

  template <typename Density>
  bool propose(const Patch& patch, const Patch_samples& samples, const Density& density)
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
    m_problem.term_triangles = drift_term_triangles(patch, samples);
    m_problem.stencils.collect(patch, [](int) -> Tangent_frame { return Tangent_frame::Zero(); });
    check(m_interruption);
    m_newton.analyze(m_problem);
    check(m_interruption);
    m_strain_regularization = m_initial_regularization;
    m_stays_on_crease.assign(patch.vertices.size(), samples.are_bounded());
    const bool proposes = step(patch, samples, density);
    m_optimization_time += seconds_since(start);
    return proposes;
  }

  // from where the vertices are now
  template <typename Density>
  bool propose_again(const Patch& patch,
                     const Patch_samples& samples,
                     const std::vector<double>& steps,
                     const Density& density)
  {
    const auto start = std::chrono::steady_clock::now();
    adapt(patch, steps);
    // vertices that could leave their crease may continue to do so
    for(std::size_t v = 0; v < steps.size(); ++v)
      m_stays_on_crease[v] = samples.are_bounded() && steps[v] < 0.5;
    const bool proposes = step(patch, samples, density);
    m_optimization_time += seconds_since(start);
    return proposes;
  }

  // the vertex after the fraction t of its displacement; false if there is no point of R
  bool displaced_vertex(const Patch& patch, int v, double t, Located_vertex& result) const
  {
    const Located_vertex& from = patch.located[v];
    if(patch.slides(v))
      return slide(patch, v, t * m_motion[v](0), m_reference, result);
    return step_on_surface(m_reference, from, t * (m_frames[v] * m_motion[v]), result);
  }

  double displacement_length(int v) const { return m_motion[v].norm(); }
  double optimization_time() const { return m_optimization_time; }
  // the predicted decrease of the last proposal
  double predicted_decrease() const { return m_predicted_decrease; }

private:
  // Newton steps from where the vertices are now
  template <typename Density>
  bool step(const Patch& patch, const Patch_samples& samples, const Density& density)
  {
    linearize(patch, samples, density);
    m_motion.assign(patch.vertices.size(), Vector_2::Zero());
    m_newton.set_strain_regularization(m_strain_regularization);
    const Projected_newton::Outcome outcome = m_newton.minimize(
      m_problem, Patch_elements<Density>{density, patch.elements}, m_motion, m_newton_steps, 1e-8);
    m_predicted_decrease = outcome.predicted_decrease;
    return outcome.steps > 0;
  }

  // reduces the regularization if nearly all of the last step was accepted, increases it if much was cut
  void adapt(const Patch& patch, const std::vector<double>& steps)
  {
    double accepted_fraction = 0;
    for(std::size_t v = 0; v < steps.size(); ++v)
      accepted_fraction += patch.is_free[v] ? steps[v] : 0;
    accepted_fraction /= patch.number_of_free_vertices;
    m_strain_regularization = adapted_regularization(m_strain_regularization, accepted_fraction);
  }

  template <typename Density>
  void linearize(const Patch& patch, const Patch_samples& samples, const Density& density)
  {
    find_planes(patch);
    find_negative_gradients(patch, density);
    m_frames.resize(patch.vertices.size());
    for(std::size_t v = 0; v < patch.vertices.size(); ++v)
      if(patch.slides(int(v)))
        m_frames[v] << patch.lines->tangent(patch.located[v].on_line), Vector_3::Zero();
      else
      {
        // only with R's own planes the model is of first order; where several meet it is the one that the
        // vertex enters
        const Surface_point& on_reference = patch.located[v].on_reference;
        if(m_stays_on_crease[v] && patch.is_free[v])
        {
          const Vector_3 along =
            crease_direction(m_reference, on_reference, m_negative_gradient[v]);
          if(!along.isZero(0))
          {
            m_frames[v] << along, Vector_3::Zero();
            continue;
          }
        }
        const int face = patch.is_free[v]
                           ? face_in_direction(m_reference, on_reference, m_negative_gradient[v])
                           : on_reference.face;
        m_frames[v] = tangent_frame(m_reference.face_normal(face));
      }
    m_problem.corner_maps.resize(3 * patch.elements.size());
    for(std::size_t e = 0; e < patch.elements.size(); ++e)
      for(int i = 0; i < 3; ++i)
        m_problem.corner_maps[3 * e + i] =
          m_planes[e].transpose() * m_frames[patch.elements[e].vertices[i]];
    const auto frame = [&](int v) -> const Tangent_frame& { return m_frames[v]; };
    m_problem.drift.collect(patch, samples, frame);
    m_problem.stencils.collect(patch, frame);
  }

  // the planes of the elements, and their shapes in them
  void find_planes(const Patch& patch)
  {
    m_planes.clear();
    m_problem.shapes.clear();
    for(const Element_set::Element& e : patch.elements)
    {
      const Located_vertex* p[3];
      for(int i = 0; i < 3; ++i)
        p[i] = &patch.located[e.vertices[i]];
      const Vector_3 a = p[1]->position - p[0]->position, b = p[2]->position - p[0]->position;
      const Vector_3 outward = p[0]->normal + p[1]->normal + p[2]->normal;
      Vector_3 normal = a.cross(b);
      if(normal.squaredNorm() > 1e-20 * a.squaredNorm() * b.squaredNorm())
        normal *= normal.dot(outward) < 0 ? -1 : 1;
      else
        normal = outward; // degenerate
      m_planes.push_back(tangent_frame(normal));
      Eigen::Matrix2d shape;
      shape.col(0) = m_planes.back().transpose() * a;
      shape.col(1) = m_planes.back().transpose() * b;
      m_problem.shapes.push_back(shape);
    }
  }

  // the negative gradient in space at the vertices that lie on vertices and edges of R
  template <typename Density>
  void find_negative_gradients(const Patch& patch, const Density& density)
  {
    m_negative_gradient.assign(patch.vertices.size(), Vector_3::Zero());
    const auto is_on_edge = [&](int v) {
      return patch.is_free[v] && !(patch.located[v].on_reference.barycentric.minCoeff() > 0);
    };
    Eigen::Vector4d gradient;
    Eigen::Matrix4d unused;
    for(std::size_t e = 0; e < patch.elements.size(); ++e)
    {
      const Element_set::Element& element = patch.elements[e];
      const std::array<int, 3>& t = element.vertices;
      if(!is_on_edge(t[0]) && !is_on_edge(t[1]) && !is_on_edge(t[2]))
        continue;
      element_derivatives(density, element, m_problem.shapes[e] * element.rest_inverse, gradient,
                          unused, 0);
      const Eigen::Matrix2d by_jacobian = Eigen::Map<const Eigen::Matrix2d>(gradient.data());
      const Eigen::Matrix<double, 3, 2> by_edges =
        m_planes[e] * (by_jacobian * element.rest_inverse.transpose());
      m_negative_gradient[t[0]] += by_edges.col(0) + by_edges.col(1);
      m_negative_gradient[t[1]] -= by_edges.col(0);
      m_negative_gradient[t[2]] -= by_edges.col(1);
    }
    m_problem.stencils.add_descent(m_negative_gradient);
  }

  const Reference_surface& m_reference;
  int m_newton_steps;
  Interruption* m_interruption;
  double m_initial_regularization = largest_regularization,
         m_strain_regularization = largest_regularization;
  Projected_newton m_newton;
  Tangent_problem m_problem;
  std::vector<Tangent_frame> m_frames;       // per vertex
  std::vector<Tangent_frame> m_planes;       // per element
  std::vector<Vector_3> m_negative_gradient; // per vertex
  std::vector<Vector_2> m_motion;            // per vertex, in its frame
  // per vertex: whether it stays on the crease of R on which it is
  std::vector<char> m_stays_on_crease;
  double m_optimization_time = 0;
  double m_predicted_decrease = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_ON_SURFACE_MOVER_H
