// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_SLIDING_VERTICES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_SLIDING_VERTICES_H

#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/reference_lines.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/internal/support/compatibility.h>

#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Makes the vertices of borders and of lines of constrained edges slide, after all vertices were located.
// Border vertices slide along R's border if they are near it, others along R's feature lines if these are
// given or if the initial line does not consist of edges of R; else along that line. Ends, junctions and
// sharp turns of lines are fixed, as are vertices that are constrained themselves.
class Sliding_vertices
{
  typedef CGAL::Simple_cartesian<double> Kernel;
  typedef std::vector<Kernel::Segment_3>::const_iterator Segment_iterator;

public:
  Sliding_vertices(Optimization_state& state,
                   const Constraints& constraints,
                   const Reference_lines& lines,
                   bool relaxes_border,
                   double rounding,
                   Result& result)
    : m_state(state),
      m_cosine_of_sharp_turn(result.number_of_feature_edges > 0 ? cosine_on_mechanical_parts : 0.5),
      m_rounding(rounding),
      m_tolerance((std::max)(1e-9 * state.reference.diagonal(), rounding)),
      m_result(result)
  {
    const Indexed_mesh& mesh = state.mesh;
    const int n = mesh.number_of_vertices();
    Line_edges edges;
    for(int c = 0; c < mesh.number_of_corners(); ++c)
      if(constraints.is_line[c] && mesh.opposite[c] < c) // once for each edge
        edges.push_back({{mesh.source(c), mesh.target(c)}});
    const auto position = [&](int v) { return state.vertices[v].on_reference.position; };
    state.line_neighbours = line_neighbours(
      edges, n, position, [&](int v) { return constraints.is_constrained[v] != 0; },
      m_cosine_of_sharp_turn);

    if(relaxes_border)
      attach_to_reference_lines(lines.border, [&](int v) { return mesh.is_border_vertex[v] != 0; });
    attach_to_reference_lines(lines.features, [&](int v) {
      return !mesh.is_border_vertex[v] &&
             (lines.features_are_given || !own_line_is_on_reference(v));
    });
    attach_to_own_lines(edges, position);
    for(int v = 0; v < n; ++v)
      if(state.vertices[v].on_line.segment < 0)
        state.line_neighbours[v] = {{-1, -1}};
  }

private:
  // 19 degrees: all vertices of arcs with less than 19 vertices per turn are fixed, since chords would
  // shorten them
  static constexpr double cosine_on_mechanical_parts = 0.9455;

  // lines of R
  template <typename IsCandidate>
  void attach_to_reference_lines(const Line_edges& edges, const IsCandidate& is_candidate)
  {
    const std::vector<Vector_3>& points = m_state.reference.points();
    const Indexed_mesh& reference = m_state.reference.mesh();
    const auto position = [&](int v) { return points[v]; };
    const std::size_t first = m_state.lines.segments().size();
    trace_polylines(
      edges,
      line_neighbours(
        edges, int(points.size()), position, [](int) { return false; }, m_cosine_of_sharp_turn),
      position, [&](int v, int w) { return reference.face_at(v, w); }, m_state.lines);
    std::vector<Kernel::Segment_3> segments;
    std::vector<int> line_segment; // of each of them
    const auto point = [](const Vector_3& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
    for(std::size_t i = first; i < m_state.lines.segments().size(); ++i)
    {
      const Polyline_set::Segment& s = m_state.lines[int(i)];
      if(s.from == s.to)
        continue;
      segments.emplace_back(point(s.from), point(s.to));
      line_segment.push_back(int(i));
    }
    if(segments.empty())
      return;

    Segment_tree<Kernel, Segment_iterator> tree(segments.begin(), segments.end());
    std::vector<Vector_3> positions;
    for(const Located_vertex& v : m_state.vertices)
      positions.push_back(v.position);
    const double near = 0.1 * mean_edge_length(m_state.mesh, positions);
    for(int v = 0; v < m_state.mesh.number_of_vertices(); ++v)
    {
      if(m_state.line_neighbours[v][0] < 0 || !is_candidate(v))
        continue;
      const Vector_3& p = positions[v];
      const auto hit = tree.closest_point_and_primitive(point(p));
      const Vector_3 q(hit.first.x(), hit.first.y(), hit.first.z());
      if((p - q).norm() > near)
        continue;
      const int segment = line_segment[hit.second - segments.begin()];
      const Polyline_set::Segment& s = m_state.lines[segment];
      const Vector_3 d = s.to - s.from;
      const double fraction = (std::min)(1., (std::max)(0., d.dot(q - s.from) / d.squaredNorm()));
      attach(v, {segment, fraction});
    }
  }

  // whether the edges of the mesh on both sides are parts of edges of R; chords of a rim are not, even if
  // they are on R
  bool own_line_is_on_reference(int v) const
  {
    const Reference_surface& reference = m_state.reference;
    const Surface_point& here = m_state.vertices[v].on_reference;
    for(const int w : m_state.line_neighbours[v])
    {
      const Vector_3 middle = 0.5 * (here.position + m_state.vertices[w].on_reference.position);
      const Surface_point projection = reference.local_closest(middle, here.face);
      int i = 0; // the corner that the closest edge is opposite to
      const double fraction = projection.barycentric.minCoeff(&i);
      const double side = (reference.corner_point(projection.face, (i + 1) % 3) -
                           reference.corner_point(projection.face, (i + 2) % 3))
                            .norm();
      const double height = reference.face_normal(projection.face).norm() / side;
      if((projection.position - middle).norm() > m_tolerance || fraction * height > m_tolerance)
        return false;
    }
    return true;
  }

  // interior lines of the mesh, where R has none
  template <typename PointAccess>
  void attach_to_own_lines(Line_edges edges, const PointAccess& position)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const auto slides = [&](int v) {
      return !mesh.is_border_vertex[v] && m_state.line_neighbours[v][0] >= 0 &&
             m_state.vertices[v].on_line.segment < 0;
    };
    edges.erase(
      std::remove_if(edges.begin(), edges.end(),
                     [&](const std::array<int, 2>& e) { return !slides(e[0]) && !slides(e[1]); }),
      edges.end());
    std::vector<std::array<int, 2>> neighbours = m_state.line_neighbours;
    for(int v = 0; v < mesh.number_of_vertices(); ++v)
      if(!slides(v))
        neighbours[v] = {{-1, -1}};
    const std::vector<Polyline_point> points = trace_polylines(
      edges, neighbours, position, [](int, int) { return -1; }, m_state.lines);
    for(int v = 0; v < mesh.number_of_vertices(); ++v)
      if(slides(v))
        attach(v, points[v]);
  }

  void attach(int v, const Polyline_point& where)
  {
    Located_vertex& located = m_state.vertices[v];
    const Vector_3 before = located.position;
    located.on_line = where;
    if(!locate_on_line(m_state.lines, m_state.reference, located))
    {
      located.on_line = Polyline_point();
      return;
    }
    if((located.position - before).norm() <= m_rounding)
      located.position = before; // it is on its line already, and keeps its coordinates
    m_state.is_free[v] = 1;
    ++m_result.number_of_free_vertices;
  }

  Optimization_state& m_state;
  double m_cosine_of_sharp_turn;
  double m_rounding, m_tolerance;
  Result& m_result;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_SLIDING_VERTICES_H
