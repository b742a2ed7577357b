// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_DEFECT_REPAIR_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_DEFECT_REPAIR_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/active_set.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/internal/support/for_each_block.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Defects of faces and edges of a mesh, and its self-intersections.
struct Output_defects
{
  std::vector<char> is_inverted;          // per face: inverted, or a quad that is not convex
  std::vector<char> is_folded, is_crease; // per corner, at the first of the two of an edge
  std::vector<std::pair<int, int>> intersections;
  std::vector<double> angles; // per face, in degrees: its smallest; 180 if it is not bounded
  double smallest_angle = 180;
  std::size_t number = 0, number_of_creases = 0; // of inverted faces and folded edges; of creases
};

// of a state with the given vertices
template <typename ConcurrencyTag>
Output_defects find_output_defects(const Optimization_state& state,
                                   const std::vector<Located_vertex>& vertices)
{
  const Indexed_mesh& mesh = state.mesh;
  const int n = mesh.number_of_faces();
  const auto vertex = [&](int v) -> const Located_vertex& { return vertices[v]; };
  const auto position = [&](int v) -> const Vector_3& { return vertices[v].position; };
  std::vector<Vector_3> normals(n);
  Output_defects defects;
  defects.is_inverted.assign(n, 0);
  defects.is_folded.assign(mesh.number_of_corners(), 0);
  defects.is_crease = defects.is_folded;
  defects.angles.assign(n, 180);
  for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
    for(int f = begin; f < end; ++f)
    {
      normals[f] = face_normal(mesh, vertex, f);
      defects.is_inverted[f] =
        char(is_flipped(mesh, vertex, f, normals[f]) + is_nonconvex(mesh, vertex, f));
      if(mesh.degree(f) == 3 && state.is_optimized(f) && state.stencils.empty())
        for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
          defects.angles[f] = (std::min)(defects.angles[f], corner_angle(mesh, position, c));
    }
  });
  for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
    for(int c = mesh.face_begin[begin]; c < mesh.face_begin[end]; ++c)
      if(mesh.opposite[c] > c)
      {
        const Vector_3 &a = normals[mesh.corner_face[c]],
                       &b = normals[mesh.corner_face[mesh.opposite[c]]];
        defects.is_folded[c] = is_folded(a, b);
        defects.is_crease[c] = !state.is_on_line(c) && is_crease(a, b);
      }
  });
  for(int f = 0; f < n; ++f)
  {
    defects.number += std::size_t(defects.is_inverted[f]);
    defects.smallest_angle = (std::min)(defects.smallest_angle, defects.angles[f]);
  }
  for(const char folded : defects.is_folded)
    defects.number += std::size_t(folded);
  for(const char crease : defects.is_crease)
    defects.number_of_creases += std::size_t(crease);
  defects.intersections = intersecting_faces(mesh, vertices);
  return defects;
}

// Restores initial positions around new defects, and nowhere else: where the user's coordinates are coarser
// than those of the optimization, quads may become non-convex, or the smallest angle decrease, by a little.
// The vertices of faces with new defects are restored, and, ring by ring, those of neighbours that get new
// defects by that.
template <typename ConcurrencyTag>
class Defect_repair
{
public:
  // `start`: the defects at the start
  Defect_repair(Optimization_state& state,
                const std::vector<Located_vertex>& start_vertices,
                const Output_defects& start)
    : m_state(state),
      m_mesh(state.mesh),
      m_start_vertices(start_vertices),
      m_start(start),
      m_now(find_output_defects<ConcurrencyTag>(state, state.vertices)),
      m_is_restored(m_mesh.number_of_vertices(), 0)
  {}

  // whether a vertex was restored
  bool has_restored_vertices() const { return m_has_restored_vertices; }

  // whether the mean angle is below the initial one, if it is bounded
  bool has_lowered_angles() const
  {
    const auto sum = [](const std::vector<double>& angles) {
      return std::accumulate(angles.begin(), angles.end(), 0.);
    };
    return m_state.bounds_mean_angle && sum(m_now.angles) < sum(m_start.angles);
  }

  // Until there are no more defects, creases and self-intersections than initially, and no angle is below the
  // initial minimum.
  void run()
  {
    while(m_now.number > m_start.number || has_more_creases() || has_more_intersections() ||
          m_now.smallest_angle < m_start.smallest_angle)
      if(!restore(vertices_at_new_defects()))
        return; // all vertices there are restored
  }

  const Output_defects& defects() const { return m_now; }

  // Restores rings of vertices around the restored ones, twice as many each time; if there are none, those
  // of the face whose energy has increased most, or all. False if all are restored.
  template <typename Density>
  bool enlarge(const Density& density)
  {
    m_rings *= 2;
    if(restore(vertices_of<ConcurrencyTag>(
         m_mesh, faces_around<ConcurrencyTag>(m_mesh, m_is_restored, m_rings / 2 - 1))))
      return true;
    std::vector<char> has_largest_increase(m_mesh.number_of_faces(), 0);
    double largest = 0;
    int face = -1;
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
    {
      double rise = 0;
      for(int e = m_state.elements.begin(f); e < m_state.elements.end(f); ++e)
        rise += energy(density, e, m_state.vertices) - energy(density, e, m_start_vertices);
      if(rise > largest)
      {
        largest = rise;
        face = f;
      }
    }
    if(face < 0) // the increase is that of stencils, or cannot be located
      return restore(std::vector<char>(m_mesh.number_of_vertices(), 1));
    has_largest_increase[face] = 1;
    return restore(vertices_of<ConcurrencyTag>(m_mesh, has_largest_increase));
  }

private:
  // than allowed
  bool has_more_creases() const
  {
    return int(m_now.number_of_creases) > m_state.counts.creases.largest;
  }
  bool has_more_intersections() const
  {
    return int(m_now.intersections.size()) > m_state.counts.intersections.largest;
  }

  template <typename Density>
  double energy(const Density& density, int e, const std::vector<Located_vertex>& vertices) const
  {
    return element_energy(density, m_state.elements[e],
                          [&](int v) -> const Located_vertex& { return vertices[v]; });
  }

  std::vector<char> vertices_at_new_defects() const
  {
    std::vector<char> is_worse(m_mesh.number_of_faces(), 0);
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
      if(m_now.is_inverted[f] > m_start.is_inverted[f] || m_now.angles[f] < m_start.smallest_angle)
        is_worse[f] = 1;
    for(int c = 0; c < m_mesh.number_of_corners(); ++c)
      if(m_now.is_folded[c] > m_start.is_folded[c] ||
         (has_more_creases() && m_now.is_crease[c] > m_start.is_crease[c]))
        is_worse[m_mesh.corner_face[c]] = is_worse[m_mesh.corner_face[m_mesh.opposite[c]]] = 1;
    if(has_more_intersections())
    {
      std::vector<std::pair<int, int>> added;
      std::set_difference(m_now.intersections.begin(), m_now.intersections.end(),
                          m_start.intersections.begin(), m_start.intersections.end(),
                          std::back_inserter(added));
      for(const std::pair<int, int>& pair : added)
        is_worse[pair.first] = is_worse[pair.second] = 1;
    }
    std::vector<char> result = vertices_of<ConcurrencyTag>(m_mesh, is_worse);
    // where some vertices of a face are restored already, that was not sufficient
    std::vector<char> is_again(m_mesh.number_of_vertices(), 0);
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
      if(is_worse[f])
      {
        const int begin = m_mesh.face_begin[f], end = m_mesh.face_begin[f + 1];
        const bool has_part =
          std::any_of(m_mesh.corner_vertex.begin() + begin, m_mesh.corner_vertex.begin() + end,
                      [&](int v) { return m_is_restored[v] != 0; });
        for(int c = begin; c < end; ++c)
          is_again[m_mesh.corner_vertex[c]] |= char(has_part);
      }
    const std::vector<char> ring =
      vertices_of<ConcurrencyTag>(m_mesh, faces_at<ConcurrencyTag>(m_mesh, is_again));
    for(std::size_t v = 0; v < result.size(); ++v)
      result[v] = result[v] || ring[v];
    return result;
  }

  // false if all of them are restored already
  bool restore(const std::vector<char>& vertices)
  {
    bool is_new = false;
    for(std::size_t v = 0; v < vertices.size(); ++v)
      if(vertices[v] && !m_is_restored[v])
      {
        m_state.vertices[v] = m_start_vertices[v];
        m_is_restored[v] = 1;
        is_new = true;
      }
    m_has_restored_vertices = m_has_restored_vertices || is_new;
    if(is_new)
      m_now = find_output_defects<ConcurrencyTag>(m_state, m_state.vertices);
    return is_new;
  }

  Optimization_state& m_state;
  const Indexed_mesh& m_mesh;
  const std::vector<Located_vertex>& m_start_vertices;
  const Output_defects& m_start;
  Output_defects m_now;
  std::vector<char> m_is_restored; // per vertex
  bool m_has_restored_vertices = false;
  int m_rings = 1;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_DEFECT_REPAIR_H
