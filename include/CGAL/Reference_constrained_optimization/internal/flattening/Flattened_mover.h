// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_FLATTENED_MOVER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_FLATTENED_MOVER_H

#include <CGAL/Reference_constrained_optimization/internal/flattening/mapping_back.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/patch_flattening.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/planar_location.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Element_densities.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/tangent_frame.h>
#include <CGAL/Reference_constrained_optimization/internal/state/sliding.h>
#include <CGAL/Reference_constrained_optimization/internal/support/seconds_since.h>

#include <chrono>
#include <cmath>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A mover proposes new positions of a patch's free vertices. It provides
//   bool propose(const Patch&, const Patch_samples&, const Density&);
// which returns whether there is a proposal;
//   bool displaced_vertex(const Patch&, int v, double t, Located_vertex&);
// which moves local vertex v by the fraction t in (0, 1] of its displacement, and returns whether that is
// possible;
//   bool propose_again(const Patch&, const Patch_samples&, const std::vector<double>& steps,
//                     const Density&);
// which makes a further proposal after one was accepted, with the given fraction of its displacement for
// every vertex, and the patch was updated.
//
// This one uses the plane: it flattens the patch, minimizes in the metric of the surface, and maps back. A
// further proposal starts from the last accepted positions in the plane, with the metric evaluated there.
class Flattened_mover
{
public:
  explicit Flattened_mover(const Reference_surface& reference, Interruption* interruption = nullptr)
    : m_reference(reference),
      m_interruption(interruption),
      m_flattener(interruption),
      m_optimizer(interruption)
  {}

  template <typename Density>
  bool propose(const Patch& patch, const Patch_samples& samples, const Density& density)
  {
    const auto start = std::chrono::steady_clock::now();
    const Indexed_mesh& triangles = patch.triangles();
    m_flattening = m_flattener.flatten(triangles, patch.positions());
    const bool is_flat = m_flattening.path != Flattening_path::failed;
    m_overlaps = is_flat && !has_simple_border(triangles, m_flattening.positions);
    m_flattening_time = seconds_since(start);
    m_optimization_time = 0;
    if(!is_flat)
      return false;

    check(m_interruption);
    const auto start_of_descent = std::chrono::steady_clock::now();
    m_problem.term_triangles = drift_term_triangles(patch, samples);
    m_start_triangle.assign(m_flattening.positions.size(), -1);
    for(int c = 0; c < triangles.number_of_corners(); ++c)
      m_start_triangle[triangles.corner_vertex[c]] = c / 3;
    set_up_problem(patch, samples);
    m_optimizer.analyze(m_problem);
    const bool proposes = optimize(patch, density);
    m_optimization_time = seconds_since(start_of_descent);
    return proposes;
  }

  template <typename Density>
  bool propose_again(const Patch& patch,
                     const Patch_samples& samples,
                     const std::vector<double>& steps,
                     const Density& density)
  {
    const auto start = std::chrono::steady_clock::now();
    std::vector<Vector_2>& u = m_flattening.positions;
    for(std::size_t v = 0; v < u.size(); ++v)
      u[v] += steps[v] * (m_target[v] - u[v]);
    bool proposes = false;
    if(is_locally_injective(patch.triangles(), u))
    {
      set_up_problem(patch, samples);
      proposes = optimize(patch, density);
    }
    m_optimization_time += seconds_since(start);
    return proposes;
  }

  bool displaced_vertex(const Patch& patch, int v, double t, Located_vertex& result) const
  {
    const Vector_2& from = m_flattening.positions[v];
    if(patch.slides(v))
      return slide(patch, v,
                   t * m_sliding_scale[v] * m_problem.sliding_direction[v].dot(m_target[v] - from),
                   m_reference, result);
    const Vector_2 to = from + t * (m_target[v] - from);
    const Planar_location location =
      walk(patch.triangles(), m_flattening.positions, to, m_start_triangle[v]);
    return location.triangle >= 0 && map_to_reference(patch, location, m_reference, result);
  }

  const Flattening& flattening() const { return m_flattening; }
  const std::vector<Vector_2>& target() const { return m_target; }
  bool overlaps() const { return m_overlaps; }
  double flattening_time() const { return m_flattening_time; }
  double displacement_length(int v) const
  {
    return (m_target[v] - m_flattening.positions[v]).norm();
  }
  double optimization_time() const { return m_optimization_time; }

private:
  template <typename Density>
  bool optimize(const Patch& patch, const Density& density)
  {
    m_target = m_flattening.positions;
    const Patch_elements<Density> elements{density, patch.elements};
    const int newton_steps = 3;
    return m_optimizer.minimize(m_problem, elements, m_target, newton_steps, 1e-8).steps > 0;
  }

  void set_up_problem(const Patch& patch, const Patch_samples& samples)
  {
    const std::vector<Vector_2>& u = m_flattening.positions;
    m_problem.set_elements(patch, [&](const Element_set::Element& e) {
      const Located_vertex &a = patch.located[e.vertices[0]], &b = patch.located[e.vertices[1]],
                           &c = patch.located[e.vertices[2]];
      return surface_metric(
        Planar_problem::edges(u, e.vertices),
        signed_shape(a.position, b.position, c.position, a.normal + b.normal + c.normal), 1);
    });
    find_sliding_directions(patch);
    find_motions(patch, samples);
    const auto motion = [&](int v) -> const Tangent_frame& { return m_motions[v]; };
    m_problem.start = u;
    m_problem.drift.collect(patch, samples, motion);
    m_problem.stencils.collect(patch, motion);
  }

  // The derivative of a vertex' position on R by its position in the plane: the mean over the triangles
  // around it, projected onto the tangent plane of R.
  void find_motions(const Patch& patch, const Patch_samples& samples)
  {
    if(!samples.are_bounded() && patch.stencils.empty())
      return;
    const Indexed_mesh& triangles = patch.triangles();
    const std::vector<Vector_2>& u = m_flattening.positions;
    m_motions.assign(u.size(), Tangent_frame::Zero());
    std::vector<int> count(u.size(), 0);
    for(int t = 0; t < triangles.number_of_faces(); ++t)
    {
      const int* v = &triangles.corner_vertex[3 * t];
      const Eigen::Matrix2d flat = Planar_problem::edges(u, {{v[0], v[1], v[2]}});
      if(!(flat.determinant() > 1e-3 * flat.squaredNorm()))
        continue;
      Tangent_frame edges;
      edges << patch.located[v[1]].position - patch.located[v[0]].position,
        patch.located[v[2]].position - patch.located[v[0]].position;
      const Tangent_frame motion = edges * flat.inverse();
      for(int i = 0; i < 3; ++i)
      {
        m_motions[v[i]] += motion;
        ++count[v[i]];
      }
    }
    for(int v = 0; v < int(u.size()); ++v)
      if(patch.slides(v))
        m_motions[v] = m_sliding_scale[v] * patch.lines->tangent(patch.located[v].on_line) *
                       m_problem.sliding_direction[v].transpose();
      else if(count[v] > 0)
      {
        const Vector_3 normal = patch.located[v].normal.normalized();
        m_motions[v] = (m_motions[v] - normal * (normal.transpose() * m_motions[v])) / count[v];
      }
  }

  // In the plane a vertex slides in parallel to the line between its two neighbours; one unit there
  // is m_sliding_scale units of length on R, forward if it is positive.
  void find_sliding_directions(const Patch& patch)
  {
    const std::vector<Vector_2>& u = m_flattening.positions;
    m_problem.sliding_direction.clear();
    if(patch.line_neighbours.empty())
      return;
    m_problem.sliding_direction.assign(u.size(), Vector_2::Zero());
    m_sliding_scale.assign(u.size(), 0);
    for(int v = 0; v < int(u.size()); ++v)
    {
      if(!patch.slides(v))
        continue;
      const std::array<int, 2>& next_to = patch.line_neighbours[v];
      const Vector_2 flat = u[next_to[1]] - u[next_to[0]];
      const Vector_3 along =
        patch.located[next_to[1]].position - patch.located[next_to[0]].position;
      const double length = flat.norm();
      if(!(length > 0))
      {
        m_problem.is_free[v] = 0;
        continue;
      }
      const Vector_3 forward = patch.lines->tangent(patch.located[v].on_line);
      m_problem.sliding_direction[v] = flat / length;
      m_sliding_scale[v] = (forward.dot(along) < 0 ? -1 : 1) * along.norm() / length;
    }
  }

  const Reference_surface& m_reference;
  Interruption* m_interruption;
  Patch_flattener m_flattener;
  Projected_newton m_optimizer;
  Planar_problem m_problem;
  Flattening m_flattening;
  std::vector<Vector_2> m_target;
  std::vector<int> m_start_triangle;
  std::vector<double> m_sliding_scale;
  std::vector<Tangent_frame> m_motions; // per vertex
  bool m_overlaps = false;
  double m_flattening_time = 0, m_optimization_time = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_FLATTENED_MOVER_H
