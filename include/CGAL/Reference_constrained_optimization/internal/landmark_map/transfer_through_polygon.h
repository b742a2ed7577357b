// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_TRANSFER_THROUGH_POLYGON_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_TRANSFER_THROUGH_POLYGON_H

#include <CGAL/Reference_constrained_optimization/internal/landmark_map/polygon_flattening.h>

#include <CGAL/Random.h>

#include <algorithm>
#include <cstddef>
#include <queue>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Composes the two maps of a source and a reference into one polygon: finds the point of the
// reference for each vertex of the source.
class Polygon_transfer
{
  typedef Cut_surface::Mesh Mesh;
  typedef Cut_surface::Halfedge Halfedge;
  typedef Cut_surface::Vertex Vertex;
  typedef Polygon_flattening::Point_2 Point_2;

public:
  Polygon_transfer(const Cut_surface& source,
                   const Polygon_flattening& source_map,
                   const Cut_surface& reference,
                   const Polygon_flattening& reference_map)
    : m_source(source),
      m_source_map(source_map),
      m_reference(reference),
      m_reference_map(reference_map)
  {}

  // points on the reference, per vertex of the source; false if a vertex could not be located
  bool transfer(std::vector<Vector_3>& points)
  {
    const Mesh& mesh = m_source.mesh();
    points.assign(mesh.number_of_vertices(), Vector_3::Zero());
    std::vector<char> is_done(mesh.number_of_vertices(), 0);
    for(std::size_t i = 0; i < m_source.arcs().size(); ++i)
      transfer_arc(i, points, is_done);
    for(std::size_t i = 0; i < m_source.landmarks().size(); ++i)
    {
      const Vertex v = m_source.landmarks()[i];
      points[v] = reference_point(m_reference.landmarks()[i]);
      is_done[v] = 1;
    }
    return transfer_interior(points, is_done);
  }

private:
  Vector_3 reference_point(Vertex v) const
  {
    const auto& p = m_reference.mesh().point(v);
    return Vector_3(p.x(), p.y(), p.z());
  }

  // a vertex on an arc keeps its fraction of the arc length
  void transfer_arc(std::size_t i, std::vector<Vector_3>& points, std::vector<char>& is_done) const
  {
    const std::vector<Halfedge>& from = m_source.arcs()[i];
    const std::vector<Halfedge>& to = m_reference.arcs()[i];
    const double ratio = m_reference.arc_length(int(i)) / m_source.arc_length(int(i));
    double place = 0, passed = 0;
    std::size_t k = 0;
    for(const Halfedge h : from)
    {
      place += ratio * m_source.length(h);
      while(k + 1 < to.size() && passed + m_reference.length(to[k]) < place)
        passed += m_reference.length(to[k++]);
      const double t = (std::min)(1., (place - passed) / m_reference.length(to[k]));
      const Mesh& r = m_reference.mesh();
      points[m_source.mesh().target(h)] =
        (1 - t) * reference_point(r.source(to[k])) + t * reference_point(r.target(to[k]));
      is_done[m_source.mesh().target(h)] = 1;
    }
  }

  // breadth first over the source, so that each vertex is located starting from one of its neighbours
  bool transfer_interior(std::vector<Vector_3>& points, std::vector<char>& is_done)
  {
    const Mesh& mesh = m_source.mesh();
    std::queue<std::pair<Halfedge, Halfedge>> queue; // to a vertex; a half-edge of the guessed face
    const Halfedge first = m_source.arcs().front().front();
    const Halfedge guess = m_reference.arcs().front().front();
    std::vector<char> is_expanded(mesh.number_of_vertices(), 0);
    const auto expand = [&](Vertex v, Halfedge face) {
      is_expanded[v] = 1;
      for(const Halfedge h : CGAL::halfedges_around_source(v, mesh))
        if(!is_expanded[mesh.target(h)])
          queue.push({h, face});
    };
    expand(mesh.target(first), with_face(m_reference.mesh(), guess));
    while(!queue.empty())
    {
      const Halfedge h = queue.front().first;
      Halfedge face = queue.front().second;
      queue.pop();
      const Vertex v = mesh.target(h);
      if(is_expanded[v])
        continue;
      if(!is_done[v])
      {
        face = locate(m_source_map(with_face(mesh, h)), face);
        if(face == Mesh::null_halfedge())
          return false;
        points[v] = interpolate(m_source_map(with_face(mesh, h)), face);
        is_done[v] = 1;
      }
      expand(v, face);
    }
    return true;
  }

  // a half-edge to the same vertex that has a face
  static Halfedge with_face(const Mesh& mesh, Halfedge h)
  {
    return mesh.is_border(h) ? mesh.opposite(mesh.next(h)) : h;
  }

  // Walks through the reference's triangles towards p, with exact predicates; the order in which
  // sides are tried is random, so that no walk goes in circles.
  Halfedge locate(const Point_2& p, Halfedge h)
  {
    const Mesh& mesh = m_reference.mesh();
    const std::size_t limit = 100 + 20 * std::size_t(mesh.number_of_faces());
    for(std::size_t step = 0; step < limit; ++step)
    {
      for(int turn = m_random.get_int(0, 3); turn > 0; --turn)
        h = mesh.next(h);
      bool is_inside = true;
      for(int i = 0; i < 3 && is_inside; ++i, h = mesh.next(h))
      {
        const Halfedge o = mesh.opposite(h);
        const bool is_boundary = mesh.is_border(o) || m_reference.is_cut()[mesh.edge(h)];
        if(!is_boundary && CGAL::orientation(m_reference_map(mesh.prev(h)), m_reference_map(h),
                                             p) == CGAL::RIGHT_TURN)
        {
          h = o;
          is_inside = false;
          break;
        }
      }
      if(is_inside)
        return h;
    }
    return Mesh::null_halfedge();
  }

  Vector_3 interpolate(const Point_2& p, Halfedge h) const
  {
    const Mesh& mesh = m_reference.mesh();
    const Halfedge corner[3] = {h, mesh.next(h), mesh.prev(h)};
    double weight[3], sum = 0;
    for(int i = 0; i < 3; ++i)
    {
      weight[i] = (std::max)(0., CGAL::area(p, m_reference_map(corner[(i + 1) % 3]),
                                            m_reference_map(corner[(i + 2) % 3])));
      sum += weight[i];
    }
    Vector_3 result = Vector_3::Zero();
    for(int i = 0; i < 3; ++i)
      result += (sum > 0 ? weight[i] / sum : 1. / 3) * reference_point(mesh.target(corner[i]));
    return result;
  }

  const Cut_surface& m_source;
  const Polygon_flattening& m_source_map;
  const Cut_surface& m_reference;
  const Polygon_flattening& m_reference_map;
  CGAL::Random m_random{0};
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_TRANSFER_THROUGH_POLYGON_H
