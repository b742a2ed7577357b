// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_LANDMARK_MAP_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_LANDMARK_MAP_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/Symmetric_Dirichlet_density.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_graph.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Spanning_trees.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/border_landmarks.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/corresponding_paths.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/counterparts.h>
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
// the landmarks, flattened to the same convex polygon, and the two maps are composed. Handles are opened by further paths.
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
    const Surface_topology a = topology(source, m_source, "source"),
                           b = topology(reference, m_reference, "reference");
    const auto text = [](const Surface_topology& t) {
      return "genus " + std::to_string(t.genus) + " and " + std::to_string(t.borders) + " borders";
    };
    if(a.genus != b.genus || a.borders != b.borders)
      throw Invalid_input("source and reference: the source has " + text(a) +
                          ", the reference has " + text(b) + ", but these must be the same");
    m_genus = a.genus;
    m_area_ratio =
      surface_area(reference.mesh, reference.points) / surface_area(source.mesh, source.points);
  }

  // pairs of vertices, by number
  void set_landmarks(const std::vector<int>& source, const std::vector<int>& reference)
  {
    m_source.set_landmarks(source);
    m_reference.set_landmarks(reference);
    m_borders = set_border_landmarks(m_source, m_reference);
    measure_distances();
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

  // Extremities without a landmark: pairs of their vertices, and those that have no counterpart, each with the
  // vertex of the other surface whose distances from the landmarks are most similar.
  struct Extremities
  {
    std::vector<std::pair<int, int>> pairs, without_counterpart_in_reference,
      without_counterpart_in_source;
  };
  Extremities extremities() const
  {
    const std::vector<Extremity> a = internal::extremities(m_source,
                                                           int(m_source_copy.points.size())),
                                 b =
                                   internal::extremities(m_reference, m_number_of_reference_points);
    Extremities result;
    std::vector<char> is_paired_a(a.size(), 0), is_paired_b(b.size(), 0);
    const auto distances = [](const std::vector<Extremity>& extremities) {
      std::vector<std::vector<double>> d;
      for(const Extremity& e : extremities)
        d.push_back(e.distances);
      return d;
    };
    const double largest_difference = 0.25;
    for(const std::pair<int, int>& p : counterparts(distances(a), distances(b), largest_difference))
    {
      result.pairs.emplace_back(a[p.first].vertex, b[p.second].vertex);
      is_paired_a[p.first] = is_paired_b[p.second] = 1;
    }
    const double largest_relative_area = 0.5; // blunt ones may do without a landmark
    for(std::size_t i = 0; i < a.size(); ++i)
      if(!is_paired_a[i] && a[i].relative_area < largest_relative_area)
        result.without_counterpart_in_reference.emplace_back(
          a[i].vertex,
          most_similar_vertex(m_reference, m_number_of_reference_points, a[i].distances));
    for(std::size_t i = 0; i < b.size(); ++i)
      if(!is_paired_b[i] && b[i].relative_area < largest_relative_area)
        result.without_counterpart_in_source.emplace_back(
          most_similar_vertex(m_source, int(m_source_copy.points.size()), b[i].distances),
          b[i].vertex);
    return result;
  }

private:
  void measure_distances()
  {
    const std::size_t n = m_source.landmarks().size();
    m_distance.assign(n, std::vector<double>(n, 0));
    m_source.measure_landmark_distances();
    m_reference.measure_landmark_distances();
    for(std::size_t i = 0; i < n; ++i)
      for(std::size_t j = 0; j < n; ++j)
        m_distance[i][j] = m_source.landmark_distances()[i][m_source.landmarks()[j]] +
                           m_reference.landmark_distances()[i][m_reference.landmarks()[j]];
  }

  // Candidate trees, the best first. Tracing paths is cheap, so that many trees are compared by their
  // lengths: long detours around earlier paths indicate that these passed another landmark on different
  // sides on the two surfaces, and the map would be twisted.
  std::vector<Landmark_pairs> candidate_trees(int number, unsigned int seed) const
  {
    const int trees_per_layout = 4;
    Spanning_trees trees(m_distance, m_borders, seed);
    std::vector<std::pair<double, Landmark_pairs>> candidates;
    for(int k = 0; k < trees_per_layout * number; ++k)
    {
      Landmark_pairs edges = trees.tree(k);
      const auto is_same = [&](const auto& other) { return other.second == edges; };
      if(std::find_if(candidates.begin(), candidates.end(), is_same) != candidates.end())
        continue;
      Cut cut(m_source, m_reference);
      double direct = 0;
      for(const auto& edge : edges)
        direct += m_distance[edge.first][edge.second];
      const double length = trace_tree(edges, cut);
      candidates.emplace_back(edges.empty() ? 0 : length * (length / direct), std::move(edges));
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Landmark_pairs> result;
    for(const auto& candidate : candidates)
      if(int(result.size()) < number)
        result.push_back(candidate.second);
    return result;
  }

  // both surfaces, cut along graphs of the same combinatorics
  struct Cut
  {
    Cut_surface source, reference;
    Cut_graph graph;
    Cut(const Cut_surface& a, const Cut_surface& b)
      : source(a),
        reference(b),
        graph(int(a.landmarks().size()))
    {}

    // cuts along the shortest pair of paths, and returns its length; it is infinite if there is none
    template <typename IsAllowed>
    double cut_along_path(const Landmark_pairs& ends,
                          const std::vector<Crossed_edges> (&curves)[2],
                          const IsAllowed& is_allowed)
    {
      const Path_pair p = corresponding_paths(source, reference, graph, ends, curves, is_allowed);
      if(std::isfinite(p.length()))
      {
        source.cut_along(p.source.vertices);
        reference.cut_along(p.reference.vertices);
        graph.add_path(p.from, p.from_sector, p.to, p.to_sector);
      }
      return p.length();
    }
  };

  // cuts along the borders and a tree, and returns the length of its paths
  double trace_tree(const Landmark_pairs& edges, Cut& cut) const
  {
    for(const std::vector<int>& border : m_borders)
      cut.graph.add_border(border);
    for(const Cut_graph::Arc& arc : cut.graph.arcs())
    {
      cut.source.trace_border_arc(arc.from, arc.to);
      cut.reference.trace_border_arc(arc.from, arc.to);
    }
    double length = 0;
    for(const auto& edge : edges)
      if(std::isfinite(length))
        length += cut.cut_along_path({edge}, {}, [](int, int, int, int) { return true; });
    return length;
  }

  // Opens the handles by two paths for each: one that does not separate the surface, whose boundary is two
  // cycles then, and one between these. False if a path does not exist.
  bool open_handles(Cut& cut) const
  {
    Landmark_pairs all;
    const int n = int(m_source.landmarks().size());
    for(int i = 0; i < n; ++i)
      for(int j = i + 1; j < n; ++j)
        all.emplace_back(i, j);
    for(int handle = 0; handle < m_genus; ++handle)
    {
      if(!std::isfinite(
           cut.cut_along_path(all, {closed_curves(cut.source), closed_curves(cut.reference)},
                              [](int, int, int, int) { return true; })))
        return false;
      const std::vector<std::vector<int>> cycle = cut.graph.boundary().cycle_of_sector;
      if(!std::isfinite(cut.cut_along_path(all, {}, [&](int from, int s, int to, int t) {
           return cycle[from][s] != cycle[to][t];
         })))
        return false;
    }
    return true;
  }

  // the points for one tree; false if one of the surfaces could not be flattened bijectively
  bool map_along(const Landmark_pairs& edges, std::vector<Vector_3>& points) const
  {
    Cut cut(m_source, m_reference);
    if(!std::isfinite(trace_tree(edges, cut)) || !open_handles(cut))
      return false;
    const std::vector<Cut_graph::Side> sides = cut.graph.boundary().cycles.front();
    std::vector<double> lengths;
    for(const Cut_graph::Side& side : sides)
      lengths.push_back(cut.source.arc_length(side.arc) + cut.reference.arc_length(side.arc));
    const auto corners = Polygon_flattening::polygon(lengths);
    Polygon_flattening source_map, reference_map;
    return source_map.flatten(cut.source, sides, corners) &&
           reference_map.flatten(cut.reference, sides, corners) &&
           Polygon_transfer(cut.source, source_map, cut.reference, reference_map).transfer(points);
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
  int m_genus = 0;
  double m_area_ratio = 1;
  std::vector<std::vector<double>> m_distance; // between landmarks, on both surfaces together
  std::vector<std::vector<int>> m_borders;     // landmarks on each, in their order
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_LANDMARK_MAP_H
