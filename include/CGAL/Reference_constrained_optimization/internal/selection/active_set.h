// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_ACTIVE_SET_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_ACTIVE_SET_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/connected_region.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The active set: only the surroundings of vertices that moved in the last iteration are visited again.

// Few elements are best followed one by one, many by a scan over all, which several threads can do.
inline bool are_few(const std::vector<char>& is_in)
{
  const auto number = std::count(is_in.begin(), is_in.end(), char(1));
  return std::size_t(number) < is_in.size() / 8;
}

// the vertices of the given faces
template <typename ConcurrencyTag = CGAL::Sequential_tag>
std::vector<char> vertices_of(const Indexed_mesh& mesh, const std::vector<char>& is_in)
{
  std::vector<char> result(mesh.number_of_vertices(), 0);
  if(are_few(is_in))
  {
    for(int f = 0; f < mesh.number_of_faces(); ++f)
      if(is_in[f])
        for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
          result[mesh.corner_vertex[c]] = 1;
    return result;
  }
  for_each_block<ConcurrencyTag>(mesh.number_of_vertices(), [&](int begin, int end, int) {
    for(int v = begin; v < end; ++v)
      for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1] && !result[v]; ++k)
        result[v] = is_in[mesh.corner_face[mesh.vertex_corners[k]]];
  });
  return result;
}

// the faces at the given vertices
template <typename ConcurrencyTag = CGAL::Sequential_tag>
std::vector<char> faces_at(const Indexed_mesh& mesh, const std::vector<char>& is_in)
{
  std::vector<char> result(mesh.number_of_faces(), 0);
  if(are_few(is_in))
  {
    for(int v = 0; v < mesh.number_of_vertices(); ++v)
      if(is_in[v])
        for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
          result[mesh.corner_face[mesh.vertex_corners[k]]] = 1;
    return result;
  }
  for_each_block<ConcurrencyTag>(mesh.number_of_faces(), [&](int begin, int end, int) {
    for(int f = begin; f < end; ++f)
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1] && !result[f]; ++c)
        result[f] = is_in[mesh.corner_vertex[c]];
  });
  return result;
}

// the faces at the given vertices, and `rings` rings around them
template <typename ConcurrencyTag = CGAL::Sequential_tag>
std::vector<char>
faces_around(const Indexed_mesh& mesh, const std::vector<char>& is_center, int rings)
{
  std::vector<char> faces = faces_at<ConcurrencyTag>(mesh, is_center);
  for(int ring = 0; ring < rings; ++ring)
    faces = faces_at<ConcurrencyTag>(mesh, vertices_of<ConcurrencyTag>(mesh, faces));
  return faces;
}

// the largest density of the elements of a face
template <typename Density>
double face_density(const Optimization_state& state, const Density& density, int f)
{
  const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
  double largest = 0;
  for(int e = state.elements.begin(f); e < state.elements.end(f); ++e)
    largest = (std::max)(largest, element_energy(density, state.elements[e], vertex));
  return largest;
}

// of every face, with the face
template <typename ConcurrencyTag, typename Density>
std::vector<std::pair<double, int>> face_densities(const Optimization_state& state,
                                                   const Density& density)
{
  std::vector<std::pair<double, int>> result(state.mesh.number_of_faces());
  for_each_block<ConcurrencyTag>(int(result.size()), [&](int begin, int end, int) {
    for(int f = begin; f < end; ++f)
      result[f] = std::make_pair(face_density(state, density, f), f);
  });
  return result;
}

// Faces that only flattening can repair: those that are inverted, folded, or not convex.
template <typename ConcurrencyTag>
std::vector<char> defective_faces(const Optimization_state& state)
{
  const Indexed_mesh& mesh = state.mesh;
  const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
  const int n = mesh.number_of_faces();
  std::vector<char> result(n, 0);
  std::vector<Vector_3> normals(n);
  for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
    for(int f = begin; f < end; ++f)
    {
      normals[f] = face_normal(mesh, vertex, f);
      result[f] = is_flipped(mesh, vertex, f, normals[f]) || is_nonconvex(mesh, vertex, f);
    }
  });
  for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
    for(int f = begin; f < end; ++f)
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        if(mesh.opposite[c] >= 0 &&
           is_folded(normals[f], normals[mesh.corner_face[mesh.opposite[c]]]))
          result[f] = 1;
  });
  return result;
}

// The faces with an element beyond `bad` in regions, connected by edges, of at least `smallest` of them. A
// few bad elements can be improved by moving their vertices; a whole region may have to be flattened.
template <typename ConcurrencyTag, typename Density>
std::vector<char>
bad_regions(const Optimization_state& state, const Density& density, double bad, int smallest)
{
  const Indexed_mesh& mesh = state.mesh;
  std::vector<char> result(mesh.number_of_faces(), 0), is_unvisited(mesh.number_of_faces(), 0);
  for(const std::pair<double, int>& d : face_densities<ConcurrencyTag>(state, density))
    is_unvisited[d.second] = d.first > bad;
  for(int f = 0; f < mesh.number_of_faces(); ++f)
  {
    if(!is_unvisited[f])
      continue;
    const std::vector<int> region = extract_connected_region(mesh, f, is_unvisited);
    if(int(region.size()) >= smallest)
      for(const int g : region)
        result[g] = 1;
  }
  return result;
}

// removes from the vertices that moved those further than a ring from bad elements
template <typename ConcurrencyTag, typename Density>
void keep_near_bad(const Optimization_state& state,
                   const Density& density,
                   double bad,
                   std::vector<char>& moved)
{
  const Indexed_mesh& mesh = state.mesh;
  std::vector<char> is_near(mesh.number_of_vertices(), 0);
  for(const std::pair<double, int>& d : face_densities<ConcurrencyTag>(state, density))
    if(d.first > bad)
      for(int c = mesh.face_begin[d.second]; c < mesh.face_begin[d.second + 1]; ++c)
        is_near[mesh.corner_vertex[c]] = 1;
  const std::vector<char> is_bad = is_near;
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(is_bad[mesh.source(c)] || is_bad[mesh.target(c)])
      is_near[mesh.source(c)] = is_near[mesh.target(c)] = 1;
  for(int v = 0; v < mesh.number_of_vertices(); ++v)
    moved[v] = moved[v] && is_near[v];
}

// the mean density of the better half of the elements
template <typename ConcurrencyTag, typename Density>
double lower_half_mean(const Optimization_state& state, const Density& density)
{
  const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
  std::vector<double> densities(state.elements.size());
  for_each_block<ConcurrencyTag>(int(densities.size()), [&](int begin, int end, int) {
    for(int e = begin; e < end; ++e)
      densities[e] = element_energy(density, state.elements[e], vertex);
  });
  const std::size_t half = densities.size() / 2 + 1;
  std::nth_element(densities.begin(), densities.begin() + (half - 1), densities.end());
  double sum = 0;
  for(std::size_t i = 0; i < half; ++i)
    sum += densities[i];
  return sum / double(half);
}

// The energy of the elements if all had the shape of their rest triangles, scaled such that their areas add
// up to those of the mesh as it is.
template <typename Density>
double rest_energy(const Optimization_state& state, const Density& density)
{
  const auto vertex = [&](int v) -> const Located_vertex& { return state.vertices[v]; };
  double area = 0, rest_area = 0;
  for(int e = 0; e < state.elements.size(); ++e)
  {
    const double rest = 1 / state.elements[e].rest_inverse.determinant();
    area += rest * std::abs(element_jacobian(state.elements[e], vertex).determinant());
    rest_area += rest;
  }
  const double scale = area > 0 ? std::sqrt(area / rest_area) : 1;
  double energy = 0;
  for(int term = 0; term < density.number_of_terms(); ++term)
    density.visit(term, [&](const auto& d) {
      energy += state.elements.weight_of_term(term) * d.value(scale * Eigen::Matrix2d::Identity());
    });
  return energy;
}

// the mean length of the edges at every vertex
inline std::vector<double> vertex_edge_lengths(const Indexed_mesh& mesh,
                                               const std::vector<Vector_3>& points)
{
  std::vector<double> lengths(mesh.number_of_vertices());
  for(int v = 0; v < mesh.number_of_vertices(); ++v)
    lengths[v] = mean_edge_length_at(
      mesh, [&](int w) -> const Vector_3& { return points[w]; }, v);
  return lengths;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_ACTIVE_SET_H
