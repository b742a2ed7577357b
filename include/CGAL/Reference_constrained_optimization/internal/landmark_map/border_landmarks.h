// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_BORDER_LANDMARKS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_BORDER_LANDMARKS_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/counterparts.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/split_edge.h>

#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The border of the reference for each of the source: that with the same landmarks, and for borders without
// landmarks that at the most similar distances from all landmarks. Throws Invalid_input if landmarks contradict
// one another.
inline std::vector<int> corresponding_borders(const Cut_surface& source,
                                              const Cut_surface& reference)
{
  const int n = source.number_of_borders();
  std::vector<int> result(n, -1), pair_of(n, -1);
  for(int i = 0; i < int(source.landmarks().size()); ++i)
  {
    const int a = source.border_of(i), b = reference.border_of(i);
    if((a < 0) != (b < 0))
      throw Invalid_input("landmarks: of pair " + std::to_string(i) +
                          " only one vertex is on the border");
    if(a < 0)
      continue;
    const auto same = std::find(result.begin(), result.end(), b);
    const int other = same != result.end() ? int(same - result.begin()) : a;
    if((other != a || result[a] != b) && pair_of[other] >= 0)
      throw Invalid_input("landmarks: pairs " + std::to_string(pair_of[other]) + " and " +
                          std::to_string(i) +
                          " are on the same border of one of the meshes, and on two of the other");
    result[a] = b;
    pair_of[a] = i;
  }
  const auto distances = [](const Cut_surface& surface, const std::vector<int>& borders) {
    std::vector<std::vector<double>> from_landmarks(borders.size());
    for(const std::vector<double>& d : surface.landmark_distances())
      for(std::size_t k = 0; k < borders.size(); ++k)
        from_landmarks[k].push_back(surface.closest_on_border(borders[k], d).first);
    return from_landmarks;
  };
  std::vector<int> free_source, free_reference;
  for(int i = 0; i < n; ++i)
  {
    if(result[i] < 0)
      free_source.push_back(i);
    if(std::find(result.begin(), result.end(), i) == result.end())
      free_reference.push_back(i);
  }
  const double any_difference = 1000; // all of them are paired
  for(const std::pair<int, int>& p : counterparts(
        distances(source, free_source), distances(reference, free_reference), any_difference))
    result[free_source[p.first]] = free_reference[p.second];
  return result;
}

// A border as the sequence of its vertices, with the lengths up to them.
class Border_line
{
public:
  // from a vertex of the border on
  Border_line(const Cut_surface& surface, Cut_surface::Vertex first) : m_surface(surface)
  {
    const Cut_surface::Mesh& mesh = surface.mesh();
    double length = 0;
    for(const Cut_surface::Halfedge h :
        CGAL::halfedges_around_face(border_halfedge_from(mesh, first), mesh))
    {
      m_vertices.push_back(mesh.source(h));
      m_lengths.push_back(length);
      length += surface.length(h);
    }
    m_vertices.push_back(first);
    m_lengths.push_back(length);
  }

  const std::vector<Cut_surface::Vertex>& vertices() const { return m_vertices; }

  // the distances from all landmarks at equally spaced points, from the i-th vertex on
  std::vector<std::vector<double>> distances(std::size_t i, int number_of_points) const
  {
    std::vector<std::vector<double>> result;
    for(int k = 0; k < number_of_points; ++k)
    {
      double s = m_lengths[i] + k * m_lengths.back() / number_of_points;
      s -= s < m_lengths.back() ? 0 : m_lengths.back();
      const auto next = std::upper_bound(m_lengths.begin() + 1, m_lengths.end() - 1, s);
      const std::size_t j = std::size_t(next - m_lengths.begin());
      const double t = (s - m_lengths[j - 1]) / (m_lengths[j] - m_lengths[j - 1]);
      std::vector<double> point;
      for(const std::vector<double>& d : m_surface.landmark_distances())
        point.push_back((1 - t) * d[m_vertices[j - 1]] + t * d[m_vertices[j]]);
      result.push_back(std::move(point));
    }
    return result;
  }

private:
  const Cut_surface& m_surface;
  std::vector<Cut_surface::Vertex> m_vertices; // the first one twice
  std::vector<double> m_lengths;
};

// The vertex of a border of the reference that corresponds to one of the source's: that for which the distances
// from all landmarks are most similar, all around the border.
inline Cut_surface::Vertex corresponding_border_vertex(const Cut_surface& source,
                                                       Cut_surface::Vertex vertex,
                                                       const Cut_surface& reference,
                                                       Cut_surface::Vertex any_of_reference)
{
  const int number_of_points = 16;
  const std::vector<std::vector<double>> expected =
    Border_line(source, vertex).distances(0, number_of_points);
  const Border_line other(reference, any_of_reference);
  double least = std::numeric_limits<double>::infinity();
  Cut_surface::Vertex best = any_of_reference;
  for(std::size_t i = 0; i + 1 < other.vertices().size(); ++i)
  {
    const std::vector<std::vector<double>> found = other.distances(i, number_of_points);
    double sum = 0;
    for(int k = 0; k < number_of_points; ++k)
      sum += difference_of_distances(expected[k], found[k]);
    if(sum < least)
    {
      least = sum;
      best = other.vertices()[i];
    }
  }
  return best;
}

// Gives borders landmarks up to three, so that they are sides of a polygon: a border without any gets one where it is
// closest to another, and where that is on the reference; parts between landmarks are divided into equal lengths.
// Returns the landmarks of each border, in the order of the source's. Throws Invalid_input if their order on the
// reference is another.
inline std::vector<std::vector<int>> set_border_landmarks(Cut_surface& source,
                                                          Cut_surface& reference)
{
  if(source.number_of_borders() == 0)
    return {};
  source.measure_landmark_distances();
  reference.measure_landmark_distances();
  const std::vector<int> corresponding = corresponding_borders(source, reference);
  const int n = int(source.landmarks().size());
  std::vector<std::vector<int>> result;
  for(int border = 0; border < int(corresponding.size()); ++border)
  {
    const int other_border = corresponding[border];
    if(source.border_landmarks(border).empty())
    {
      std::pair<double, Cut_surface::Vertex> closest(std::numeric_limits<double>::infinity(), {});
      for(int i = 0; i < n; ++i)
        closest =
          (std::min)(closest, source.closest_on_border(border, source.landmark_distances()[i]));
      const Cut_surface::Vertex any =
        reference.closest_on_border(other_border, reference.landmark_distances()[0]).second;
      const Cut_surface::Vertex other =
        corresponding_border_vertex(source, closest.second, reference, any);
      source.add_landmark(closest.second);
      reference.add_landmark(other);
    }
    std::vector<int> order = source.border_landmarks(border);
    if(order.size() < 3)
    {
      const int parts = order.size() == 1 ? 3 : 2;
      std::vector<double> lengths[2];
      for(std::size_t i = 0; i < order.size(); ++i)
      {
        const int next = order[(i + 1) % order.size()];
        lengths[0].push_back(source.border_length(order[i], next));
        lengths[1].push_back(reference.border_length(order[i], next));
      }
      for(std::size_t i = 0; i < order.size(); ++i)
        for(int part = 1; part < parts; ++part)
        {
          source.add_border_landmark(order[i], lengths[0][i] * part / parts);
          reference.add_border_landmark(order[i], lengths[1][i] * part / parts);
        }
    }
    order = source.border_landmarks(border);
    std::vector<int> other = reference.border_landmarks(other_border);
    std::rotate(other.begin(), std::find(other.begin(), other.end(), order.front()), other.end());
    if(other != order)
    {
      std::reverse(other.begin() + 1, other.end());
      throw Invalid_input(std::string("landmarks: those on the borders are not in the same order") +
                          (other == order ? ", but in the opposite one: is one of the surfaces "
                                            "oriented the other way round?"
                                          : ""));
    }
    result.push_back(std::move(order));
  }
  return result;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_BORDER_LANDMARKS_H
