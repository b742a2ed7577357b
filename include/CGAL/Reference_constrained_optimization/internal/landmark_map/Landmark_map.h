// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_LANDMARK_MAP_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_LANDMARK_MAP_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/Symmetric_Dirichlet_density.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Landmark_tree.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Spanning_trees.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/extremities.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/polygon_flattening.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/surface_topology.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/transfer_through_polygon.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/surface_metric.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A map between two surfaces from landmarks: both are cut along trees of paths with the same order around
// the landmarks, flattened to the same convex polygon, and the two maps are composed.
class Landmark_map
{
public:
  struct Tried_tree
  {
    Landmark_pairs edges;
    bool is_bijective = false;
    double distortion = std::numeric_limits<double>::infinity(); // capped symmetric Dirichlet
  };

  Landmark_map(const Mesh_copy& source, const Mesh_copy& reference)
    : m_source_copy(source),
      m_source(source),
      m_reference(reference, are_opposite(source, reference)),
      m_number_of_reference_points(int(reference.points.size()))
  {
    const bool source_is_closed = is_sphere(source, m_source, "source");
    const bool reference_is_closed = is_sphere(reference, m_reference, "reference");
    if(source_is_closed != reference_is_closed)
      throw Invalid_input(std::string("source and reference: one of them is closed, the other (") +
                          (source_is_closed ? "reference" : "source") + ") has a border");
    m_area_ratio =
      surface_area(reference.mesh, reference.points) / surface_area(source.mesh, source.points);
  }

  // pairs of vertices, by number
  void set_landmarks(const std::vector<int>& source, const std::vector<int>& reference)
  {
    m_source.set_landmarks(source);
    m_reference.set_landmarks(reference);
    for(std::size_t i = 0; i < source.size(); ++i)
      if(m_source.is_on_border(int(i)) != m_reference.is_on_border(int(i)))
        throw Invalid_input("landmarks: of pair " + std::to_string(i) +
                            " only one vertex is on the border");
    measure_distances();
    if(!m_source.border_is_empty())
      set_border();
    m_source.split_chords();
    m_reference.split_chords();
  }

  // tries trees and keeps the best; the points of the best map, none if there is none
  std::vector<Vector_3> map(int number_of_trees, unsigned int seed, std::vector<Tried_tree>& tried)
  {
    std::vector<Vector_3> best, points;
    double least = std::numeric_limits<double>::infinity();
    for(const Landmark_pairs& edges : candidate_trees(number_of_trees, seed))
    {
      Tried_tree t;
      t.edges = edges;
      t.is_bijective = map_along(t.edges, points);
      if(t.is_bijective)
        t.distortion = distortion(points);
      if(t.distortion < least)
      {
        least = t.distortion;
        best = points;
      }
      tried.push_back(t);
    }
    best.resize((std::min)(best.size(), m_source_copy.points.size()));
    return best;
  }

  // Extremities without a landmark: pairs of their vertices, and those that have no counterpart.
  struct Extremities
  {
    std::vector<std::pair<int, int>> pairs;
    std::vector<int> source, reference;
  };
  Extremities extremities() const
  {
    const std::vector<Extremity> a = internal::extremities(m_source,
                                                           int(m_source_copy.points.size())),
                                 b =
                                   internal::extremities(m_reference, m_number_of_reference_points);
    Extremities result;
    std::vector<char> is_paired_a(a.size(), 0), is_paired_b(b.size(), 0);
    for(const std::pair<int, int>& p : counterparts(a, b))
    {
      result.pairs.emplace_back(a[p.first].vertex, b[p.second].vertex);
      is_paired_a[p.first] = is_paired_b[p.second] = 1;
    }
    const double largest_relative_area = 0.5; // blunt ones may do without a landmark
    for(std::size_t i = 0; i < a.size(); ++i)
      if(!is_paired_a[i] && a[i].relative_area < largest_relative_area)
        result.source.push_back(a[i].vertex);
    for(std::size_t i = 0; i < b.size(); ++i)
      if(!is_paired_b[i] && b[i].relative_area < largest_relative_area)
        result.reference.push_back(b[i].vertex);
    return result;
  }

private:
  void measure_distances()
  {
    const std::size_t n = m_source.landmarks().size();
    m_distance.assign(n, std::vector<double>(n, 0));
    for(std::size_t i = 0; i < n; ++i)
    {
      const Cut_surface::Distances a = m_source.distances(int(i));
      const Cut_surface::Distances b = m_reference.distances(int(i));
      for(std::size_t j = 0; j < n; ++j)
        m_distance[i][j] = a.length[m_source.landmarks()[j]] + b.length[m_reference.landmarks()[j]];
    }
  }

  // adds landmarks on the borders up to three, and checks their order
  void set_border()
  {
    if(m_source.border_landmarks().empty())
      connect_to_border();
    std::vector<int> order = m_source.border_landmarks();
    if(order.size() < 3)
    {
      // a border of few arcs is divided into arcs of equal length
      const int parts = order.size() == 1 ? 3 : 2;
      std::vector<double> lengths[2];
      for(std::size_t i = 0; i < order.size(); ++i)
        for(int s = 0; s < 2; ++s)
        {
          const Cut_surface& surface = s == 0 ? m_source : m_reference;
          lengths[s].push_back(surface.border_length(order[i], order[(i + 1) % order.size()]));
        }
      for(std::size_t i = 0; i < order.size(); ++i)
        for(int part = 1; part < parts; ++part)
        {
          m_source.add_border_landmark(order[i], lengths[0][i] * part / parts);
          m_reference.add_border_landmark(order[i], lengths[1][i] * part / parts);
        }
      measure_distances();
    }
    m_border = m_source.border_landmarks();
    std::vector<int> other = m_reference.border_landmarks();
    std::rotate(other.begin(), std::find(other.begin(), other.end(), m_border.front()),
                other.end());
    if(other != m_border)
    {
      std::reverse(other.begin() + 1, other.end());
      throw Invalid_input(std::string("landmarks: those on the borders are not in the same order") +
                          (other == m_border ? ", but in the opposite one: is one of the surfaces "
                                               "oriented the other way round?"
                                             : ""));
    }
  }

  // connects the landmark that is closest to the borders to a new one there
  void connect_to_border()
  {
    double least = std::numeric_limits<double>::infinity();
    std::pair<Cut_surface::Vertex, Cut_surface::Vertex> best;
    for(std::size_t i = 0; i < m_distance.size(); ++i)
    {
      const auto a = m_source.closest_on_border(m_source.distances(int(i)));
      const auto b = m_reference.closest_on_border(m_reference.distances(int(i)));
      if(a.first + b.first < least)
      {
        least = a.first + b.first;
        best = {a.second, b.second};
      }
    }
    m_source.add_landmark(best.first);
    m_reference.add_landmark(best.second);
    measure_distances();
  }

  // Candidate trees, the best first. Tracing paths is cheap, so that many trees are compared by their
  // lengths: long detours around earlier paths indicate that these passed another landmark on different
  // sides on the two surfaces, and the map would be twisted.
  std::vector<Landmark_pairs> candidate_trees(int number, unsigned int seed) const
  {
    const int trees_per_layout = 4;
    Spanning_trees trees(m_distance, m_border, seed);
    std::vector<std::pair<double, Landmark_pairs>> candidates;
    for(int k = 0; k < trees_per_layout * number; ++k)
    {
      Landmark_pairs edges = trees.tree(k);
      const auto is_same = [&](const auto& other) { return other.second == edges; };
      if(std::find_if(candidates.begin(), candidates.end(), is_same) != candidates.end())
        continue;
      Cut_surface source(m_source), reference(m_reference);
      Landmark_tree tree(int(source.landmarks().size()));
      double cost = std::numeric_limits<double>::infinity();
      if(trace_tree(edges, tree, source, reference))
      {
        double length = 0, direct = 0;
        for(std::size_t i = 0; i < tree.arcs().size(); ++i)
          if(!tree.arcs()[i].is_border)
            length += source.arc_length(int(i)) + reference.arc_length(int(i));
        for(const auto& edge : edges)
          direct += m_distance[edge.first][edge.second];
        cost = edges.empty() ? 0 : length * (length / direct);
      }
      candidates.emplace_back(cost, std::move(edges));
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Landmark_pairs> result;
    for(const auto& candidate : candidates)
      if(int(result.size()) < number)
        result.push_back(candidate.second);
    return result;
  }

  // false if one of the paths does not exist
  bool trace_tree(const Landmark_pairs& edges,
                  Landmark_tree& tree,
                  Cut_surface& source,
                  Cut_surface& reference) const
  {
    if(!m_border.empty())
    {
      tree.add_border(m_border);
      for(const Landmark_tree::Arc& arc : tree.arcs())
      {
        source.trace_border_arc(arc.from, arc.to);
        reference.trace_border_arc(arc.from, arc.to);
      }
    }
    for(const auto& edge : edges)
      if(!trace_path(edge.first, edge.second, tree, source, reference))
        return false;
    return true;
  }

  // the points for one tree; false if one of the surfaces could not be flattened bijectively
  bool map_along(const Landmark_pairs& edges, std::vector<Vector_3>& points) const
  {
    Cut_surface source(m_source), reference(m_reference);
    Landmark_tree tree(int(source.landmarks().size()));
    if(!trace_tree(edges, tree, source, reference))
      return false;

    const std::vector<Landmark_tree::Side> sides = tree.boundary();
    std::vector<double> lengths;
    for(const Landmark_tree::Side& side : sides)
      lengths.push_back(source.arc_length(side.arc) + reference.arc_length(side.arc));
    const auto corners = Polygon_flattening::polygon(lengths);
    Polygon_flattening source_map, reference_map;
    return source_map.flatten(source, sides, corners) &&
           reference_map.flatten(reference, sides, corners) &&
           Polygon_transfer(source, source_map, reference, reference_map).transfer(points);
  }

  // Traces corresponding paths: of all sectors between the paths at both ends, those are chosen in which
  // the sum of the lengths on the two surfaces is smallest.
  static bool
  trace_path(int from, int to, Landmark_tree& tree, Cut_surface& source, Cut_surface& reference)
  {
    double least = std::numeric_limits<double>::infinity();
    int best_from = 0, best_to = 0;
    std::pair<Cut_surface::Distances, Cut_surface::Distances> best;
    for(int s = 0; s < tree.number_of_sectors(from); ++s)
    {
      std::pair<Cut_surface::Distances, Cut_surface::Distances> distances;
      distances.first = source.distances(from, tree, s, to, least);
      double on_source = std::numeric_limits<double>::infinity();
      for(int t = 0; t < tree.number_of_sectors(to); ++t)
        on_source = (std::min)(on_source, source.length_to(to, tree, t, distances.first));
      if(!(on_source < least))
        continue;
      distances.second = reference.distances(from, tree, s, to, least - on_source);
      bool is_best = false;
      for(int t = 0; t < tree.number_of_sectors(to); ++t)
      {
        const double sum = source.length_to(to, tree, t, distances.first) +
                           reference.length_to(to, tree, t, distances.second);
        if(sum < least)
        {
          least = sum;
          best_from = s;
          best_to = t;
          is_best = true;
        }
      }
      if(is_best)
        best = std::move(distances);
    }
    if(!std::isfinite(least))
      return false;
    source.trace_path(from, to, tree, best_to, best.first);
    reference.trace_path(from, to, tree, best_to, best.second);
    tree.add_path(from, best_from, to, best_to);
    return true;
  }

  // mean of the symmetric Dirichlet density; single triangles count up to a cap
  double distortion(const std::vector<Vector_3>& points) const
  {
    const Symmetric_Dirichlet_density density;
    const Indexed_mesh& mesh = m_source_copy.mesh;
    const double cap = 100, scale = std::sqrt(m_area_ratio);
    double sum = 0;
    std::size_t n = 0;
    for(int f = 0; f < mesh.number_of_faces(); ++f)
      for(const auto& t : split_face(mesh, m_source_copy.points, f))
      {
        const int* v[3] = {&mesh.corner_vertex[t[0]], &mesh.corner_vertex[t[1]],
                           &mesh.corner_vertex[t[2]]};
        const std::vector<Vector_3>& q = m_source_copy.points;
        const Eigen::Matrix2d rest = scale * triangle_shape(q[*v[0]], q[*v[1]], q[*v[2]]);
        const Eigen::Matrix2d shape = triangle_shape(points[*v[0]], points[*v[1]], points[*v[2]]);
        const double d = density.value(shape * rest.inverse());
        sum += d < cap ? d : cap;
        ++n;
      }
    return sum / double(n);
  }

  const Mesh_copy& m_source_copy;
  Cut_surface m_source, m_reference;
  int m_number_of_reference_points;
  double m_area_ratio = 1;
  std::vector<std::vector<double>> m_distance; // between landmarks, on both surfaces together
  std::vector<int> m_border;                   // landmarks on the border, in their order
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_LANDMARK_MAP_H
