// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_SURFACE_TOPOLOGY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_SURFACE_TOPOLOGY_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/support/compatibility.h>

#include <CGAL/Polygon_mesh_processing/connected_components.h>

#include <boost/property_map/property_map.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// whether two closed surfaces are oriented against each other, by the sign of the volume; false if one
// of them has a border
inline bool are_opposite(const Mesh_copy& source, const Mesh_copy& reference)
{
  const auto volume = [](const Mesh_copy& copy) {
    double sum = 0;
    for(int f = 0; f < copy.mesh.number_of_faces(); ++f)
      for(const auto& t : split_face(copy.mesh, copy.points, f))
      {
        Vector_3 p[3];
        for(int i = 0; i < 3; ++i)
          p[i] = copy.points[copy.mesh.corner_vertex[t[i]]] - copy.points.front();
        sum += p[0].dot(p[1].cross(p[2]));
      }
    return sum;
  };
  for(const Mesh_copy* copy : {&source, &reference})
    if(std::find(copy->mesh.opposite.begin(), copy->mesh.opposite.end(), -1) !=
       copy->mesh.opposite.end())
      return false;
  return volume(source) * volume(reference) < 0;
}

struct Surface_topology
{
  int genus, borders;
};

// Throws Invalid_input if the surface has several components.
inline Surface_topology
topology(const Mesh_copy& copy, const Cut_surface& surface, const std::string& name)
{
  namespace PMP = CGAL::Polygon_mesh_processing;
  const Cut_surface::Mesh& mesh = surface.mesh();
  std::vector<std::size_t> component(mesh.number_of_faces());
  const std::size_t components = PMP::connected_components(
    mesh, boost::make_iterator_property_map(component.begin(), get(boost::face_index, mesh)));
  if(components != 1)
    throw Invalid_input(name + ": has " + std::to_string(components) +
                        " connected components, but must have one");
  int vertices = 0;
  for(int v = 0; v < copy.mesh.number_of_vertices(); ++v)
    vertices += !copy.mesh.is_isolated(v);
  const int characteristic = vertices - int(mesh.number_of_edges()) + int(mesh.number_of_faces()),
            borders = surface.number_of_borders();
  return {(2 - characteristic - borders) / 2, borders};
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_SURFACE_TOPOLOGY_H
