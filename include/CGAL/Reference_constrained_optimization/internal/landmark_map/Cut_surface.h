// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CUT_SURFACE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CUT_SURFACE_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_graph.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/split_edge.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <queue>
#include <string>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A surface on which paths are traced between landmarks, disjoint except for their ends. An edge between
// two vertices of landmarks, paths or the border that is no part of them is split: then there is always a
// path between two others, and no triangle has its three vertices on one path.
class Cut_surface
{
public:
  typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
  typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;
  typedef Mesh::Vertex_index Vertex;
  typedef Mesh::Halfedge_index Halfedge;
  typedef Mesh::Edge_index Edge;

  // vertices keep their numbers; those that splitting adds come after them
  explicit Cut_surface(const Mesh_copy& copy, bool is_reversed = false)
  {
    for(const Vector_3& p : copy.points)
      m_mesh.add_vertex(Kernel::Point_3(p.x(), p.y(), p.z()));
    for(int f = 0; f < copy.mesh.number_of_faces(); ++f)
      for(const auto& t : split_face(copy.mesh, copy.points, f))
      {
        const auto at = [&](int i) { return Vertex(copy.mesh.corner_vertex[t[i]]); };
        const Mesh::Face_index added =
          is_reversed ? m_mesh.add_face(at(2), at(1), at(0)) : m_mesh.add_face(at(0), at(1), at(2));
        if(added == Mesh::null_face())
          throw Invalid_input("compatible_initial_mesh: face " + std::to_string(f) +
                              " of one of the meshes is a quad whose diagonal is an edge already");
      }
    m_is_taken = m_mesh.add_property_map<Vertex, bool>("v:is_taken", false).first;
    m_is_cut = m_mesh.add_property_map<Edge, bool>("e:is_cut", false).first;
    for(const Halfedge h : m_mesh.halfedges())
      if(m_mesh.is_border(h))
        m_is_taken[m_mesh.target(h)] = true;
    CGAL::Polygon_mesh_processing::extract_boundary_cycles(m_mesh, std::back_inserter(m_borders));
    m_scale = 1 / std::sqrt(surface_area(copy.mesh, copy.points));
  }

  // the copy has property maps of its own
  Cut_surface(const Cut_surface& other)
    : m_mesh(other.m_mesh),
      m_is_taken(m_mesh.add_property_map<Vertex, bool>("v:is_taken", false).first),
      m_is_cut(m_mesh.add_property_map<Edge, bool>("e:is_cut", false).first),
      m_borders(other.m_borders),
      m_landmarks(other.m_landmarks),
      m_arcs(other.m_arcs),
      m_landmark_distances(other.m_landmark_distances),
      m_scale(other.m_scale)
  {}
  Cut_surface& operator=(const Cut_surface&) = delete;

  const Mesh& mesh() const { return m_mesh; }
  Mesh& mesh() { return m_mesh; }
  const Mesh::Property_map<Edge, bool>& is_cut() const { return m_is_cut; }
  // whether it is a landmark, or on an arc or the border
  bool is_taken(Vertex v) const { return m_is_taken[v]; }
  const std::vector<Vertex>& landmarks() const { return m_landmarks; }
  const std::vector<std::vector<Halfedge>>& arcs() const { return m_arcs; }
  double scale() const { return m_scale; } // of lengths: to unit area

  // length of an edge on the surface scaled to unit area
  double length(Halfedge h) const
  {
    const auto &p = m_mesh.point(m_mesh.source(h)), &q = m_mesh.point(m_mesh.target(h));
    return m_scale * std::sqrt(CGAL::squared_distance(p, q));
  }

  void set_landmarks(const std::vector<int>& vertices)
  {
    for(const int v : vertices)
      add_landmark(Vertex(Vertex::size_type(v)));
  }

  // adds a landmark on the border, at `length` along the border from the landmark `after`; splits an edge
  // if necessary
  int add_border_landmark(int after, double length)
  {
    Halfedge h = border_halfedge_from(m_mesh, m_landmarks[after]);
    for(; length > this->length(h); h = m_mesh.next(h))
      length -= this->length(h);
    const double t = length / this->length(h);
    const Vertex s = m_mesh.source(h), e = m_mesh.target(h);
    Vertex v = t < 0.5 ? s : e;
    if(t > 1e-6 && t < 1 - 1e-6)
      v = split(h, t);
    return add_landmark(v);
  }

  int add_landmark(Vertex v)
  {
    m_landmarks.push_back(v);
    m_is_taken[v] = true;
    return int(m_landmarks.size()) - 1;
  }

  int number_of_borders() const { return int(m_borders.size()); }

  // of a landmark: the number of its border, or -1
  int border_of(int landmark) const
  {
    const Halfedge border = border_halfedge_from(m_mesh, m_landmarks[landmark]);
    if(border == Mesh::null_halfedge())
      return -1;
    for(const Halfedge h : CGAL::halfedges_around_face(border, m_mesh))
    {
      const auto found = std::find(m_borders.begin(), m_borders.end(), h);
      if(found != m_borders.end())
        return int(found - m_borders.begin());
    }
    return -1;
  }

  // indices of the landmarks on a border, in the order of its half-edges
  std::vector<int> border_landmarks(int border) const
  {
    std::vector<int> result;
    for(const Halfedge h : CGAL::halfedges_around_face(m_borders[border], m_mesh))
      for(std::size_t i = 0; i < m_landmarks.size(); ++i)
        if(m_landmarks[i] == m_mesh.target(h))
          result.push_back(int(i));
    return result;
  }

  // length of the border from one of its landmarks to another, or once around to itself
  double border_length(int from, int to) const { return length(border_between(from, to)); }

  // the closest vertex of a border, with its distance
  std::pair<double, Vertex> closest_on_border(int border,
                                              const std::vector<double>& distances) const
  {
    std::pair<double, Vertex> best(std::numeric_limits<double>::infinity(), Mesh::null_vertex());
    for(const Halfedge h : CGAL::halfedges_around_face(m_borders[border], m_mesh))
      best = (std::min)(best, {distances[m_mesh.target(h)], m_mesh.target(h)});
    return best;
  }

  double arc_length(int arc) const { return length(m_arcs[arc]); }

  // the arc of the border from one of its landmarks to the next
  void trace_border_arc(int from, int to) { m_arcs.push_back(border_between(from, to)); }

  // splits all edges between taken vertices that are not part of an arc
  void split_chords()
  {
    std::vector<Edge> chords;
    for(const Edge e : m_mesh.edges())
      if(is_chord(e))
        chords.push_back(e);
    for(const Edge e : chords)
      split(m_mesh.halfedge(e), 0.5);
  }

  // lengths of the shortest paths along edges from a vertex to all others; infinite beyond a limit
  std::vector<double> distances_from(Vertex v,
                                     double limit = std::numeric_limits<double>::infinity()) const
  {
    typedef std::pair<double, Vertex> Reached;
    std::vector<double> result(m_mesh.number_of_vertices(),
                               std::numeric_limits<double>::infinity());
    std::priority_queue<Reached, std::vector<Reached>, std::greater<Reached>> queue;
    result[v] = 0;
    queue.push({0, v});
    while(!queue.empty() && !(queue.top().first > limit))
    {
      const Reached reached = queue.top();
      queue.pop();
      if(!(reached.first > result[reached.second]))
        for(const Halfedge h : CGAL::halfedges_around_source(reached.second, m_mesh))
        {
          const double sum = reached.first + length(h);
          if(sum < result[m_mesh.target(h)])
          {
            result[m_mesh.target(h)] = sum;
            queue.push({sum, m_mesh.target(h)});
          }
        }
    }
    return result;
  }

  // measures the distances of all vertices from the landmarks; vertices that are added are interpolated
  void measure_landmark_distances()
  {
    m_landmark_distances.clear();
    for(const Vertex v : m_landmarks)
      m_landmark_distances.push_back(distances_from(v));
  }
  const std::vector<std::vector<double>>& landmark_distances() const
  {
    return m_landmark_distances;
  }

  // cuts along a path between landmarks
  void cut_along(const std::vector<Vertex>& path)
  {
    std::vector<Halfedge> arc;
    for(std::size_t i = 1; i < path.size(); ++i)
    {
      arc.push_back(m_mesh.halfedge(path[i - 1], path[i]));
      m_is_taken[path[i]] = true;
      m_is_cut[m_mesh.edge(arc.back())] = true;
    }
    std::vector<Edge> chords;
    for(const Halfedge a : arc)
      for(const Halfedge h : CGAL::halfedges_around_target(a, m_mesh))
        if(is_chord(m_mesh.edge(h)))
          chords.push_back(m_mesh.edge(h));
    std::sort(chords.begin(), chords.end());
    chords.erase(std::unique(chords.begin(), chords.end()), chords.end());
    for(const Edge e : chords)
      split(m_mesh.halfedge(e), 0.5);
    m_arcs.push_back(arc);
  }

  // the half-edges that leave a landmark within each of its sectors
  std::vector<std::vector<Halfedge>> halfedges_of_sectors(int landmark,
                                                          const Cut_graph& graph) const
  {
    const std::vector<Halfedge> around = outgoing(landmark);
    const std::vector<int> sector_of = sectors(landmark, graph);
    std::vector<std::vector<Halfedge>> result(graph.number_of_sectors(landmark));
    for(std::size_t i = 0; i < around.size(); ++i)
      if(sector_of[i] >= 0)
        result[sector_of[i]].push_back(around[i]);
    return result;
  }

private:
  bool is_chord(Edge e) const
  {
    const Halfedge h = m_mesh.halfedge(e);
    return m_is_taken[m_mesh.source(h)] && m_is_taken[m_mesh.target(h)] && !m_is_cut[e] &&
           !m_mesh.is_border(e);
  }

  double length(const std::vector<Halfedge>& path) const
  {
    double sum = 0;
    for(const Halfedge h : path)
      sum += length(h);
    return sum;
  }

  // the border's half-edges from one landmark on it to another, or once around to itself
  std::vector<Halfedge> border_between(int from, int to) const
  {
    std::vector<Halfedge> path(1, border_halfedge_from(m_mesh, m_landmarks[from]));
    while(m_mesh.target(path.back()) != m_landmarks[to])
      path.push_back(m_mesh.next(path.back()));
    return path;
  }

  // splits the edge at the fraction t of its length, and the faces at it
  Vertex split(Halfedge h, double t)
  {
    const Vertex from = m_mesh.source(h), to = m_mesh.target(h),
                 v = split_edge_and_faces(m_mesh, h, t);
    m_is_taken[v] = false;
    for(std::vector<double>& d : m_landmark_distances)
      d.push_back((1 - t) * d[from] + t * d[to]);
    return v;
  }

  // the outgoing half-edges of a landmark, counterclockwise; on the border they start after the hole
  std::vector<Halfedge> outgoing(int landmark) const
  {
    const Vertex v = m_landmarks[landmark];
    Halfedge start = m_mesh.opposite(m_mesh.halfedge(v));
    const Halfedge border = border_halfedge_from(m_mesh, v);
    if(border != Mesh::null_halfedge())
      start = m_mesh.opposite(m_mesh.prev(border));
    std::vector<Halfedge> result;
    Halfedge h = start;
    do
    {
      result.push_back(h);
      h = m_mesh.opposite(m_mesh.prev(h));
    } while(h != start);
    return result;
  }

  // the sector of each half-edge that leaves a landmark; -1 for those of arcs
  std::vector<int> sectors(int landmark, const Cut_graph& graph) const
  {
    const std::vector<Halfedge> around = outgoing(landmark);
    const std::vector<Cut_graph::Stub>& stubs = graph.stubs(landmark);
    std::vector<int> stub_of(around.size(), -1);
    for(std::size_t s = 0; s < stubs.size(); ++s)
    {
      const std::vector<Halfedge>& arc = m_arcs[stubs[s].arc];
      const Halfedge h = stubs[s].is_start ? arc.front() : m_mesh.opposite(arc.back());
      stub_of[std::find(around.begin(), around.end(), h) - around.begin()] = int(s);
    }
    std::vector<int> result(around.size(), stubs.empty() ? 0 : -1);
    if(stubs.empty())
      return result;
    int current = 0; // twice around, since the first stub may be late
    for(std::size_t k = 0; k < 2 * around.size(); ++k)
    {
      const std::size_t i = k % around.size();
      if(stub_of[i] >= 0)
        current = stub_of[i];
      result[i] = stub_of[i] >= 0 ? -1 : current;
    }
    return result;
  }

  Mesh m_mesh;
  Mesh::Property_map<Vertex, bool> m_is_taken;
  Mesh::Property_map<Edge, bool> m_is_cut;
  std::vector<Halfedge> m_borders; // one of each
  std::vector<Vertex> m_landmarks;
  std::vector<std::vector<Halfedge>> m_arcs;             // in the order of the graph
  std::vector<std::vector<double>> m_landmark_distances; // per landmark and vertex
  double m_scale = 1;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CUT_SURFACE_H
