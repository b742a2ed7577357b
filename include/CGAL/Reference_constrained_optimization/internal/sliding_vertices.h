// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SLIDING_VERTICES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SLIDING_VERTICES_H

#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/internal/compatibility.h>

#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Lets the vertices of borders and of lines of constrained edges slide, after all vertices were
// placed. Border vertices slide along R's border if they are near it; the others along the line that
// they form on R at the start. Ends, junctions and sharp turns of lines stay, and so do vertices that
// are constrained themselves.
class Sliding_vertices
{
  typedef CGAL::Simple_cartesian<double> Kernel;
  typedef std::vector<Kernel::Segment_3>::const_iterator Segment_iterator;

public:
  Sliding_vertices(Optimization_state& state, const Constraints& constraints, Result& result)
    : m_state(state),
      m_result(result)
  {
    find_neighbours(constraints);
    slide_on_border();
    slide_on_lines();
    for(int v = 0; v < m_state.mesh.number_of_vertices(); ++v)
      if(m_state.vertices[v].on_line.segment < 0)
        m_state.line_neighbours[v] = {{-1, -1}};
  }

private:
  const Vector_3& position(int v) const { return m_state.vertices[v].on_reference.position; }

  // of vertices at which a line goes on without a sharp turn
  void find_neighbours(const Constraints& constraints)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const int n = mesh.number_of_vertices();
    std::vector<int> count(n, 0);
    m_state.line_neighbours.assign(n, {{-1, -1}});
    const auto meet = [&](int v, int w) {
      if(count[v] < 2)
        m_state.line_neighbours[v][count[v]] = w;
      ++count[v];
    };
    for(int c = 0; c < mesh.number_of_corners(); ++c)
      if(constraints.is_line[c] && mesh.opposite[c] < c) // once for each edge
      {
        meet(mesh.target(c), mesh.source(c));
        meet(mesh.source(c), mesh.target(c));
      }
    const double cosine_of_sharp_turn = 0.5;
    for(int v = 0; v < n; ++v)
    {
      std::array<int, 2>& next_to = m_state.line_neighbours[v];
      const bool goes_on =
        count[v] == 2 && !constraints.is_constrained[v] &&
        (position(v) - position(next_to[0]))
            .normalized()
            .dot((position(next_to[1]) - position(v)).normalized()) > cosine_of_sharp_turn;
      if(!goes_on)
        next_to = {{-1, -1}};
    }
  }

  void slide_on_border()
  {
    const Indexed_mesh& reference = m_state.reference.mesh();
    const std::vector<Vector_3>& points = m_state.reference.points();
    std::vector<int> starting(points.size(), -1); // per vertex of R: the border segment from it
    std::vector<Kernel::Segment_3> segments;
    std::vector<int> line_segment; // of each of them
    const auto point = [&](int v) {
      return Kernel::Point_3(points[v].x(), points[v].y(), points[v].z());
    };
    for(int c = 0; c < reference.number_of_corners(); ++c)
      if(reference.opposite[c] < 0 && points[reference.source(c)] != points[reference.target(c)])
      {
        const int s = reference.source(c), t = reference.target(c);
        starting[s] = m_state.lines.add(points[s], points[t], reference.corner_face[c]);
        segments.emplace_back(point(s), point(t));
        line_segment.push_back(starting[s]);
      }
    if(segments.empty())
      return;
    for(int c = 0; c < reference.number_of_corners(); ++c)
      if(reference.opposite[c] < 0 && starting[reference.source(c)] >= 0 &&
         starting[reference.target(c)] >= 0)
        m_state.lines.connect(starting[reference.source(c)], starting[reference.target(c)]);

    Segment_tree<Kernel, Segment_iterator> tree(segments.begin(), segments.end());
    std::vector<Vector_3> positions;
    for(const Placed_vertex& v : m_state.vertices)
      positions.push_back(v.position);
    const double near = 0.1 * mean_edge_length(m_state.mesh, positions);
    for(int v = 0; v < m_state.mesh.number_of_vertices(); ++v)
    {
      if(m_state.line_neighbours[v][0] < 0 || !m_state.mesh.is_border_vertex[v])
        continue;
      const Vector_3& p = positions[v];
      const auto hit = tree.closest_point_and_primitive(Kernel::Point_3(p.x(), p.y(), p.z()));
      const Vector_3 q(hit.first.x(), hit.first.y(), hit.first.z());
      if((p - q).norm() > near)
        continue;
      const int segment = line_segment[hit.second - segments.begin()];
      const Slide_lines::Segment& s = m_state.lines[segment];
      const Vector_3 d = s.to - s.from;
      const double part = (std::min)(1., (std::max)(0., d.dot(q - s.from) / d.squaredNorm()));
      release(v, {segment, part});
    }
  }

  // lines of constrained edges inside the mesh
  void slide_on_lines()
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const int n = mesh.number_of_vertices();
    const auto is_sliding = [&](int v) {
      return !mesh.is_border_vertex[v] && m_state.line_neighbours[v][0] >= 0;
    };
    std::vector<int> arriving(n, -1); // per vertex: the segment that ends in it
    const auto segment = [&](int v, int w) {
      return m_state.lines.add(position(v), position(w), -1);
    };
    std::vector<Line_point> starts(n);
    for(int first = 0; first < n; ++first)
    {
      if(!is_sliding(first) || arriving[first] >= 0)
        continue;
      // back to where the line starts, or once round
      int v = first, before = m_state.line_neighbours[first][0];
      while(is_sliding(before) && before != first)
      {
        const std::array<int, 2>& next_to = m_state.line_neighbours[before];
        const int further = next_to[0] == v ? next_to[1] : next_to[0];
        v = before;
        before = further;
      }
      const int start = v;
      arriving[v] = segment(before, v);
      while(true)
      {
        const std::array<int, 2>& next_to = m_state.line_neighbours[v];
        const int next = next_to[0] == before ? next_to[1] : next_to[0];
        if(next == start && is_sliding(next))
        {
          m_state.lines.connect(arriving[v], arriving[start]);
          break;
        }
        const int s = segment(v, next);
        m_state.lines.connect(arriving[v], s);
        if(!is_sliding(next))
          break;
        arriving[next] = s;
        before = v;
        v = next;
      }
    }
    for(int v = 0; v < n; ++v)
      if(arriving[v] >= 0)
        release(v, {arriving[v], 1});
  }

  void release(int v, const Line_point& where)
  {
    Placed_vertex& placed = m_state.vertices[v];
    const Vector_3 before = placed.position;
    placed.on_line = where;
    if(!place_on_line(m_state.lines, m_state.reference, placed))
    {
      placed.on_line = Line_point();
      return;
    }
    m_state.is_free[v] = 1;
    ++m_result.number_of_free_vertices;
    m_result.largest_initial_distance =
      (std::max)(m_result.largest_initial_distance, (placed.position - before).norm());
  }

  Optimization_state& m_state;
  Result& m_result;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SLIDING_VERTICES_H
