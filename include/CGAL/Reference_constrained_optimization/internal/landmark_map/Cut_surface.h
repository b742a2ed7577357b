// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CUT_SURFACE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CUT_SURFACE_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Landmark_tree.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/split_edge.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
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

  // lengths of the shortest paths from a landmark within one of its sectors
  struct Distances
  {
    std::vector<double> length;      // per vertex
    std::vector<Vertex> predecessor; // per vertex
  };

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
      {
        m_is_taken[m_mesh.target(h)] = true;
        m_border = h;
      }
    m_scale = 1 / std::sqrt(surface_area(copy.mesh, copy.points));
  }

  // the copy has property maps of its own
  Cut_surface(const Cut_surface& other)
    : m_mesh(other.m_mesh),
      m_is_taken(m_mesh.add_property_map<Vertex, bool>("v:is_taken", false).first),
      m_is_cut(m_mesh.add_property_map<Edge, bool>("e:is_cut", false).first),
      m_border(other.m_border),
      m_landmarks(other.m_landmarks),
      m_arcs(other.m_arcs),
      m_scale(other.m_scale)
  {}
  Cut_surface& operator=(const Cut_surface&) = delete;

  const Mesh& mesh() const { return m_mesh; }
  Mesh& mesh() { return m_mesh; }
  const Mesh::Property_map<Edge, bool>& is_cut() const { return m_is_cut; }
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

  bool is_on_border(int landmark) const { return m_mesh.is_border(m_landmarks[landmark]); }

  // indices of the landmarks on the border, in the order of its half-edges
  std::vector<int> border_landmarks() const
  {
    std::vector<int> result;
    if(m_border == Mesh::null_halfedge())
      return result;
    for(const Halfedge h : CGAL::halfedges_around_face(m_border, m_mesh))
      for(std::size_t i = 0; i < m_landmarks.size(); ++i)
        if(m_landmarks[i] == m_mesh.target(h))
          result.push_back(int(i));
    return result;
  }

  // length of the border from one of its landmarks to another, or once around to itself
  double border_length(int from, int to) const { return length(border_between(from, to)); }

  bool border_is_empty() const { return m_border == Mesh::null_halfedge(); }

  // the closest vertex of the border, with its distance
  std::pair<double, Vertex> closest_on_border(const Distances& distances) const
  {
    std::pair<double, Vertex> best(std::numeric_limits<double>::infinity(), Mesh::null_vertex());
    for(const Halfedge h : CGAL::halfedges_around_face(m_border, m_mesh))
      best = (std::min)(best, {distances.length[m_mesh.target(h)], m_mesh.target(h)});
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

  // distances of all vertices from a landmark, or from any vertex up to a limit, without obstacles
  Distances distances(int landmark) const { return distances_from(m_landmarks[landmark]); }
  Distances distances_from(Vertex v, double limit = std::numeric_limits<double>::infinity()) const
  {
    return search(
      v, [](Vertex) { return false; }, [](Halfedge) { return true; }, {}, limit);
  }
  // distances from a landmark within a sector, over vertices that are not taken, of the vertices
  // around another landmark, up to a limit; those of vertices further away are not all computed
  Distances distances(int from,
                      const Landmark_tree& tree,
                      int sector,
                      int to,
                      double limit = std::numeric_limits<double>::infinity()) const
  {
    const std::vector<int> sector_of = sectors(from, tree);
    const Vertex start = m_landmarks[from];
    std::vector<Vertex> goals;
    for(const Halfedge h : outgoing(to))
      if(!m_is_taken[m_mesh.target(h)])
        goals.push_back(m_mesh.target(h));
    return search(
      start, [&](Vertex v) { return m_is_taken[v] && v != start; },
      [&](Halfedge h) { return sector_of[rank(from, h)] == sector; }, goals, limit);
  }

  // length of the path to a landmark that arrives there within a sector; infinite if there is none
  double
  length_to(int landmark, const Landmark_tree& tree, int sector, const Distances& distances) const
  {
    return last_step(landmark, tree, sector, distances).first;
  }

  // cuts along the path that arrives within a sector, from `from` to `to`
  void
  trace_path(int from, int to, const Landmark_tree& tree, int sector, const Distances& distances)
  {
    const Halfedge last = last_step(to, tree, sector, distances).second;
    std::vector<Halfedge> arc(1, last);
    Vertex v = m_mesh.source(last);
    while(v != m_landmarks[from])
    {
      const Vertex u = distances.predecessor[v];
      arc.push_back(m_mesh.halfedge(u, v));
      m_is_taken[v] = true;
      v = u;
    }
    std::reverse(arc.begin(), arc.end());
    for(const Halfedge h : arc)
      m_is_cut[m_mesh.edge(h)] = true;
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
    const Vertex v = split_edge_and_faces(m_mesh, h, t);
    m_is_taken[v] = false;
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

  std::size_t rank(int landmark, Halfedge h) const
  {
    const std::vector<Halfedge> around = outgoing(landmark);
    return std::size_t(std::find(around.begin(), around.end(), h) - around.begin());
  }

  // the sector of each half-edge that leaves a landmark; -1 for those of arcs
  std::vector<int> sectors(int landmark, const Landmark_tree& tree) const
  {
    const std::vector<Halfedge> around = outgoing(landmark);
    const std::vector<Landmark_tree::Stub>& stubs = tree.stubs(landmark);
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

  // shortest paths (Dijkstra), up to a limit or until all goals, if there are any, are reached
  template <typename Blocked, typename FirstStep>
  Distances search(Vertex start,
                   const Blocked& is_blocked,
                   const FirstStep& may_start,
                   const std::vector<Vertex>& goals,
                   double limit = std::numeric_limits<double>::infinity()) const
  {
    typedef std::pair<double, Vertex> Reached;
    Distances d;
    d.length.assign(m_mesh.number_of_vertices(), std::numeric_limits<double>::infinity());
    d.predecessor.assign(m_mesh.number_of_vertices(), Mesh::null_vertex());
    std::vector<char> is_goal(m_mesh.number_of_vertices(), 0);
    for(const Vertex v : goals)
      is_goal[v] = 1;
    std::size_t missing = goals.size();
    std::priority_queue<Reached, std::vector<Reached>, std::greater<Reached>> queue;
    d.length[start] = 0;
    queue.push({0, start});
    while(!queue.empty())
    {
      const auto [length_to_v, v] = queue.top();
      queue.pop();
      if(length_to_v > limit)
        break;
      if(length_to_v > d.length[v])
        continue;
      if(is_goal[v])
      {
        is_goal[v] = 0;
        if(--missing == 0)
          break;
      }
      for(const Halfedge h : CGAL::halfedges_around_source(v, m_mesh))
      {
        const Vertex w = m_mesh.target(h);
        const double sum = length_to_v + length(h);
        if(sum < d.length[w] && !is_blocked(w) && (v != start || may_start(h)))
        {
          d.length[w] = sum;
          d.predecessor[w] = v;
          queue.push({sum, w});
        }
      }
    }
    return d;
  }

  std::pair<double, Halfedge>
  last_step(int landmark, const Landmark_tree& tree, int sector, const Distances& distances) const
  {
    const std::vector<Halfedge> around = outgoing(landmark);
    const std::vector<int> sector_of = sectors(landmark, tree);
    std::pair<double, Halfedge> best(std::numeric_limits<double>::infinity(),
                                     Mesh::null_halfedge());
    for(std::size_t i = 0; i < around.size(); ++i)
      if(sector_of[i] == sector)
      {
        const Vertex v = m_mesh.target(around[i]);
        const double sum = distances.length[v] + length(around[i]);
        if(!m_is_taken[v] && sum < best.first)
          best = {sum, m_mesh.opposite(around[i])};
      }
    return best;
  }

  Mesh m_mesh;
  Mesh::Property_map<Vertex, bool> m_is_taken;
  Mesh::Property_map<Edge, bool> m_is_cut;
  Halfedge m_border = Mesh::null_halfedge();
  std::vector<Vertex> m_landmarks;
  std::vector<std::vector<Halfedge>> m_arcs; // in the order of the tree
  double m_scale = 1;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CUT_SURFACE_H
