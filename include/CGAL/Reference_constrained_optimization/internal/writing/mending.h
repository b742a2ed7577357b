// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_MENDING_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_MENDING_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/active_set.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/internal/support/for_each_block.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// What is wrong with faces and edges of a mesh.
struct Flaws
{
  std::vector<char> is_turned; // per face: turned over, or a quad that is not convex
  std::vector<char> is_folded; // per corner, at the first of the two of an edge
  std::vector<double> angles;  // per face, in degrees: its smallest; 180 if nobody asks
  double smallest_angle = 180;
  std::size_t number = 0; // of faces that are turned and edges that are folded
};

// of a state with its vertices where they are given
template <typename ConcurrencyTag>
Flaws find_flaws(const Optimization_state& state, const std::vector<Placed_vertex>& vertices)
{
  const Indexed_mesh& mesh = state.mesh;
  const int n = mesh.number_of_faces();
  const auto vertex = [&](int v) -> const Placed_vertex& { return vertices[v]; };
  const auto position = [&](int v) -> const Vector_3& { return vertices[v].position; };
  std::vector<Vector_3> normals(n);
  Flaws flaws;
  flaws.is_turned.assign(n, 0);
  flaws.is_folded.assign(mesh.number_of_corners(), 0);
  flaws.angles.assign(n, 180);
  for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
    for(int f = begin; f < end; ++f)
    {
      normals[f] = face_normal(mesh, vertex, f);
      flaws.is_turned[f] =
        char(is_flipped(mesh, vertex, f, normals[f]) + is_nonconvex(mesh, vertex, f));
      if(mesh.degree(f) == 3 && state.counts(f) && state.stencils.empty())
        for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
          flaws.angles[f] = (std::min)(flaws.angles[f], corner_angle(mesh, position, c));
    }
  });
  for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
    for(int c = mesh.face_begin[begin]; c < mesh.face_begin[end]; ++c)
      if(mesh.opposite[c] > c)
        flaws.is_folded[c] =
          is_folded(normals[mesh.corner_face[c]], normals[mesh.corner_face[mesh.opposite[c]]]);
  });
  for(int f = 0; f < n; ++f)
  {
    flaws.number += std::size_t(flaws.is_turned[f]);
    flaws.smallest_angle = (std::min)(flaws.smallest_angle, flaws.angles[f]);
  }
  for(const char folded : flaws.is_folded)
    flaws.number += std::size_t(folded);
  return flaws;
}

// Takes the mesh back to its start where something went wrong, and nowhere else: where the caller's
// coordinates are coarser than those of the optimization, quads may become non-convex, or the smallest angle
// fall, by a hair. The vertices of faces with flaws that they did not have return, and with them, ring by
// ring, what gets new ones next to these.
template <typename ConcurrencyTag>
class Mending
{
public:
  Mending(Optimization_state& state, const std::vector<Placed_vertex>& start_vertices)
    : m_state(state),
      m_mesh(state.mesh),
      m_start_vertices(start_vertices),
      m_start(find_flaws<ConcurrencyTag>(state, start_vertices)),
      m_has_returned(m_mesh.number_of_vertices(), 0)
  {}

  // whether anything has returned
  bool has_mended() const { return m_has_mended; }

  // whether the mean of angles is below that at the start, where it is guarded
  bool has_lowered_angles() const
  {
    const auto sum = [](const std::vector<double>& angles) {
      return std::accumulate(angles.begin(), angles.end(), 0.);
    };
    return m_state.guards_angles && sum(flaws().angles) < sum(m_start.angles);
  }

  // Until there are no more flaws than at the start, and no angle is smaller than all were.
  void run()
  {
    while(true)
    {
      const Flaws now = flaws();
      if(now.number <= m_start.number && now.smallest_angle >= m_start.smallest_angle)
        return;
      if(!take_back(vertices_at_flaws(now)))
        return; // all is as it was there
    }
  }

  // Rings of vertices around those that have returned do so, too, twice as many each time. Where none are
  // left they are those of the face whose energy has risen most, or all; false if none is left.
  template <typename Density>
  bool grow(const Density& density)
  {
    m_rings *= 2;
    if(take_back(vertices_of<ConcurrencyTag>(
         m_mesh, faces_around<ConcurrencyTag>(m_mesh, m_has_returned, m_rings / 2 - 1))))
      return true;
    std::vector<char> has_risen_most(m_mesh.number_of_faces(), 0);
    double most = 0;
    int face = -1;
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
    {
      double rise = 0;
      for(int e = m_state.elements.begin(f); e < m_state.elements.end(f); ++e)
        rise += energy(density, e, m_state.vertices) - energy(density, e, m_start_vertices);
      if(rise > most)
      {
        most = rise;
        face = f;
      }
    }
    if(face < 0) // stencils, or what cannot be found
      return take_back(std::vector<char>(m_mesh.number_of_vertices(), 1));
    has_risen_most[face] = 1;
    return take_back(vertices_of<ConcurrencyTag>(m_mesh, has_risen_most));
  }

private:
  Flaws flaws() const { return find_flaws<ConcurrencyTag>(m_state, m_state.vertices); }

  template <typename Density>
  double energy(const Density& density, int e, const std::vector<Placed_vertex>& vertices) const
  {
    return element_energy(density, m_state.elements[e],
                          [&](int v) -> const Placed_vertex& { return vertices[v]; });
  }

  std::vector<char> vertices_at_flaws(const Flaws& flaws) const
  {
    std::vector<char> is_worse(m_mesh.number_of_faces(), 0);
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
      if(flaws.is_turned[f] > m_start.is_turned[f] || flaws.angles[f] < m_start.smallest_angle)
        is_worse[f] = 1;
    for(int c = 0; c < m_mesh.number_of_corners(); ++c)
      if(flaws.is_folded[c] > m_start.is_folded[c])
        is_worse[m_mesh.corner_face[c]] = is_worse[m_mesh.corner_face[m_mesh.opposite[c]]] = 1;
    std::vector<char> result = vertices_of<ConcurrencyTag>(m_mesh, is_worse);
    // where a part of a face has returned already, that was not enough
    std::vector<char> is_again(m_mesh.number_of_vertices(), 0);
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
      if(is_worse[f])
      {
        const int begin = m_mesh.face_begin[f], end = m_mesh.face_begin[f + 1];
        const bool has_part =
          std::any_of(m_mesh.corner_vertex.begin() + begin, m_mesh.corner_vertex.begin() + end,
                      [&](int v) { return m_has_returned[v] != 0; });
        for(int c = begin; c < end; ++c)
          is_again[m_mesh.corner_vertex[c]] |= char(has_part);
      }
    const std::vector<char> ring =
      vertices_of<ConcurrencyTag>(m_mesh, faces_at<ConcurrencyTag>(m_mesh, is_again));
    for(std::size_t v = 0; v < result.size(); ++v)
      result[v] = result[v] || ring[v];
    return result;
  }

  // false if all of them have returned already
  bool take_back(const std::vector<char>& vertices)
  {
    bool is_new = false;
    for(std::size_t v = 0; v < vertices.size(); ++v)
      if(vertices[v] && !m_has_returned[v])
      {
        m_state.vertices[v] = m_start_vertices[v];
        m_has_returned[v] = 1;
        is_new = true;
      }
    m_has_mended = m_has_mended || is_new;
    return is_new;
  }

  Optimization_state& m_state;
  const Indexed_mesh& m_mesh;
  const std::vector<Placed_vertex>& m_start_vertices;
  const Flaws m_start;
  std::vector<char> m_has_returned; // per vertex
  bool m_has_mended = false;
  int m_rings = 1;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_MENDING_H
