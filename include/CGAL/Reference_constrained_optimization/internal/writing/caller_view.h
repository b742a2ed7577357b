// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_CALLER_VIEW_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_CALLER_VIEW_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/canonical_frame.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/closest_point.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/internal/support/for_each_block.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The vertices of a state in the caller's coordinates: a location on the reference means the same in
// both. Vertices that lie on the caller's reference keep their bits until they move.
class Caller_view
{
public:
  // the caller's points; `reference` may be `mesh`
  Caller_view(const Canonical_frame& frame,
              const std::vector<Vector_3>& mesh,
              const std::vector<Vector_3>& reference,
              Optimization_state& state)
    : m_frame(frame),
      m_mesh(mesh),
      m_reference(reference),
      m_state(state),
      m_is_own(&mesh == &reference),
      m_rounding(4 * std::numeric_limits<double>::epsilon() *
                 largest_coordinate(state.mesh, [&](int v) -> const Vector_3& { return mesh[v]; }))
  {}

  // to be called when all vertices are placed and none has moved
  void remember_start() { m_start = m_state.vertices; }

  // whether some vertex went further than its grid is wide
  bool has_moved_noticeably() const
  {
    const double cells = 16;
    for(std::size_t v = 0; v < m_start.size(); ++v)
      if((m_state.vertices[v].position - m_start[v].position).norm() >
         cells * m_frame.resolution_at(m_mesh[v]))
        return true;
    return false;
  }

  // Takes the state back, with the points of the reference that vertices had: from where they have
  // got to since, others might be found.
  void return_to_start() { m_state.vertices = m_start; }

  // the same for one vertex
  void return_to_start(int v) { m_state.vertices[v] = m_start[v]; }

  const Optimization_state& state() const { return m_state; }

  // where a vertex' point of the reference is
  Surface_point location(int v) const
  {
    Surface_point s = m_state.vertices[v].on_reference;
    const Indexed_mesh& surface = m_state.reference.mesh();
    const auto point = [&](int w) -> const Vector_3& { return m_reference[w]; };
    s.position.setZero();
    for(int i = 0; i < 3; ++i)
      s.position += s.barycentric(i) * point(surface.corner_vertex[surface.face_begin[s.face] + i]);
    if(has_moved(v) || slides(v) || s.position == m_mesh[v])
      return s;
    const Foot foot = descend_to(surface, point, m_mesh[v], s.face);
    return {foot.position, foot.face, foot.barycentric};
  }

  Vector_3 position(int v) const
  {
    if(!m_state.is_free[v])
      return m_mesh[v];
    const Vector_3 p = location(v).position;
    // vertices that slide may have been put on their lines in the frame, within a few cells
    const double cells = 4;
    const double touching =
      m_is_own ? cells * m_frame.unit() * m_frame.resolution_at(m_mesh[v]) : 0;
    return has_moved(v) || (p - m_mesh[v]).norm() > (std::max)(m_rounding, touching) ? p
                                                                                     : m_mesh[v];
  }

  // of all vertices
  template <typename ConcurrencyTag>
  std::vector<Vector_3> positions() const
  {
    std::vector<Vector_3> result(m_state.vertices.size());
    for_each_block<ConcurrencyTag>(int(result.size()), [&](int begin, int end, int) {
      for(int v = begin; v < end; ++v)
        result[v] = position(v);
    });
    return result;
  }

  // of the vertices of what is optimized from the reference, before they move
  double largest_distance() const
  {
    double largest = 0;
    for(int v = 0; v < m_state.mesh.number_of_vertices(); ++v)
      if(m_state.has_face_that_counts(v))
        largest = (std::max)(largest, (location(v).position - m_mesh[v]).norm());
    return largest;
  }

  // measures the mesh as the caller gets it, without caution
  template <typename ConcurrencyTag, typename Density>
  Global_measure measure(const Density& density) const
  {
    return call_as_given<ConcurrencyTag>([&](const std::vector<Vector_3>&) {
      return internal::measure<ConcurrencyTag>(m_state, density,
                                               std::numeric_limits<double>::infinity());
    });
  }

  // Calls a function of the caller's positions, while the state has them, too, but for unit and origin, and
  // no caution.
  template <typename ConcurrencyTag, typename Function>
  auto call_as_given(const Function& function) const
  {
    const std::vector<Vector_3> given = positions<ConcurrencyTag>();
    std::vector<Vector_3> framed = given;
    for(Vector_3& p : framed)
      p = m_frame.without_rounding(p);
    double caution = 0;
    const auto exchange = [&]() {
      std::swap(m_state.caution, caution);
      for(std::size_t v = 0; v < framed.size(); ++v)
        std::swap(m_state.vertices[v].position, framed[v]);
    };
    exchange();
    const auto result = function(given);
    exchange();
    return result;
  }

  // calls a function while the state is what it was at the start
  template <typename Function>
  auto call_at_start(const Function& function)
  {
    std::vector<Placed_vertex> now = m_start;
    now.swap(m_state.vertices);
    const auto result = function();
    now.swap(m_state.vertices);
    return result;
  }

private:
  bool slides(int v) const { return m_state.vertices[v].on_line.segment >= 0; }

  bool has_moved(int v) const { return m_state.vertices[v].position != m_start[v].position; }

  const Canonical_frame& m_frame;
  const std::vector<Vector_3>& m_mesh;
  const std::vector<Vector_3>& m_reference;
  Optimization_state& m_state;
  bool m_is_own; // whether the mesh is the reference
  std::vector<Placed_vertex> m_start;
  double m_rounding;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_CALLER_VIEW_H
