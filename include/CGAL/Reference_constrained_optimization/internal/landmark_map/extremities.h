// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_EXTREMITIES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_EXTREMITIES_H

#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>

#include <CGAL/Polygon_mesh_processing/measure.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The end of a limb, an ear, a tail: a vertex that is further from all landmarks than those around it, where
// the surface is smaller than a disk. Lengths are of the surface scaled to unit area.
struct Extremity
{
  int vertex;
  double distance;               // from the closest landmark
  double relative_area;          // of the surface within half of that, over that of a disk
  std::vector<double> distances; // from each landmark
};

// The area within a distance of a vertex over that of a disk. It is 1 if the border or few vertices are within, or
// if these are no topological disk, as around the middle of a limb.
inline double relative_area_around(const Cut_surface& surface,
                                   double radius,
                                   const std::vector<double>& distance_of_vertex)
{
  namespace PMP = CGAL::Polygon_mesh_processing;
  typedef Cut_surface::Mesh Mesh;
  const Mesh& mesh = surface.mesh();
  const auto is_inside = [&](Mesh::Vertex_index v) { return distance_of_vertex[v] < radius; };
  const int fewest_vertices = 8;
  int number = 0;
  for(const Mesh::Vertex_index v : mesh.vertices())
    if(is_inside(v))
    {
      ++number;
      if(mesh.is_border(v))
        return 1;
    }
  int euler_characteristic = number;
  for(const Mesh::Edge_index e : mesh.edges())
    euler_characteristic -= is_inside(mesh.vertex(e, 0)) && is_inside(mesh.vertex(e, 1));
  double sum = 0;
  for(const Mesh::Face_index f : mesh.faces())
  {
    const auto vertices = CGAL::vertices_around_face(mesh.halfedge(f), mesh);
    const auto inside = std::count_if(vertices.begin(), vertices.end(), is_inside);
    euler_characteristic += inside == 3;
    if(inside > 0)
      sum += double(inside) / 3 * CGAL::to_double(PMP::face_area(f, mesh));
  }
  const double pi = 3.14159265358979323846;
  return number < fewest_vertices || euler_characteristic != 1
           ? 1
           : sum * surface.scale() * surface.scale() / (pi * radius * radius);
}

// Those of a surface with landmarks among its first n vertices, the furthest first; of several that are close
// to one another only the furthest.
inline std::vector<Extremity> extremities(const Cut_surface& surface, int n)
{
  const double smallest_distance = 0.06, largest_relative_area = 0.6;
  const Cut_surface::Mesh& mesh = surface.mesh();
  const std::vector<std::vector<double>>& from_landmark = surface.landmark_distances();
  std::vector<double> distance(mesh.number_of_vertices(), std::numeric_limits<double>::infinity());
  for(const std::vector<double>& d : from_landmark)
    for(std::size_t v = 0; v < distance.size(); ++v)
      distance[v] = (std::min)(distance[v], d[v]);
  std::vector<Cut_surface::Vertex> furthest;
  for(const Cut_surface::Vertex v : mesh.vertices())
  {
    if(int(v) >= n || mesh.is_isolated(v) || mesh.is_border(v) || distance[v] < smallest_distance)
      continue;
    const auto around = CGAL::halfedges_around_source(v, mesh);
    if(std::none_of(around.begin(), around.end(), [&](Cut_surface::Halfedge h) {
         return distance[mesh.target(h)] > distance[v];
       }))
      furthest.push_back(v);
  }
  std::stable_sort(
    furthest.begin(), furthest.end(),
    [&](Cut_surface::Vertex a, Cut_surface::Vertex b) { return distance[a] > distance[b]; });
  // each of them takes a time that is linear in the size of the mesh, and scans have many
  const std::size_t largest_number = 200;
  furthest.resize((std::min)(furthest.size(), largest_number));
  std::vector<char> is_near(mesh.number_of_vertices(), 0); // a further one
  std::vector<Extremity> result;
  for(const Cut_surface::Vertex v : furthest)
  {
    if(is_near[v])
      continue;
    const double radius = 0.5 * distance[v];
    const std::vector<double> from_here = surface.distances_from(v, radius);
    const double relative_area = relative_area_around(surface, radius, from_here);
    if(relative_area > largest_relative_area)
      continue;
    for(std::size_t w = 0; w < from_here.size(); ++w)
      is_near[w] = is_near[w] || from_here[w] < radius;
    Extremity e{int(v), distance[v], relative_area, {}};
    for(const std::vector<double>& d : from_landmark)
      e.distances.push_back(d[v]);
    result.push_back(std::move(e));
  }
  return result;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_EXTREMITIES_H
