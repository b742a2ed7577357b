// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_WRITE_BACK_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_WRITE_BACK_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Frame.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

#include <CGAL/property_map.h>

#include <boost/graph/graph_traits.hpp>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Writes the positions of the vertices that differ from `before`, in the frame; the others keep their
// coordinates.
template <typename PolygonMesh, typename VertexPointMap>
void write_points(const PolygonMesh& g,
                  const VertexPointMap& vpm,
                  const std::vector<Vector_3>& before,
                  const Optimization_state& state,
                  const Frame& frame)
{
  typedef typename boost::property_traits<VertexPointMap>::value_type Point;
  int i = 0;
  for(const auto v : vertices(g))
  {
    if(state.vertices[i].position != before[i])
    {
      const Vector_3 p = frame.to_user(state.vertices[i].position);
      put(vpm, v, Point(p.x(), p.y(), p.z()));
    }
    ++i;
  }
}

// A quad has no barycentric coordinates: locations require triangles.
template <typename NamedParameters>
void check_location_map(const Reference_surface& reference, const NamedParameters&)
{
  if constexpr(!parameters::is_default_parameter<NamedParameters,
                                                 internal_np::vertex_location_map_t>::value)
    for(int f = 1; f < reference.mesh().number_of_faces(); ++f)
      if(reference.original_face(f) == reference.original_face(f - 1))
        throw Invalid_input("reference: face " + std::to_string(reference.original_face(f)) +
                            " is a quad, but vertex_location_map needs triangles");
}

// writes the locations on R. Barycentric coordinates are ordered as in CGAL's `locate`: source of
// the face's half-edge first, while faces are read here from its target on.
template <typename PolygonMesh, typename ReferenceMesh, typename NamedParameters>
void write_locations(const PolygonMesh& g,
                     const ReferenceMesh& reference,
                     const NamedParameters& np,
                     const Optimization_state& state)
{
  if constexpr(!parameters::is_default_parameter<NamedParameters,
                                                 internal_np::vertex_location_map_t>::value)
  {
    auto map = parameters::get_parameter(np, internal_np::vertex_location_map);
    const std::vector<typename boost::graph_traits<ReferenceMesh>::face_descriptor> all_faces(
      faces(reference).begin(), faces(reference).end());
    int i = -1;
    for(const auto v : vertices(g))
    {
      ++i;
      if(state.mesh.is_isolated(i))
        continue;
      const Surface_point& p = state.vertices[i].on_reference;
      put(map, v,
          std::make_pair(
            all_faces[state.reference.original_face(p.face)],
            std::array<double, 3>{{p.barycentric(2), p.barycentric(0), p.barycentric(1)}}));
    }
  }
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_WRITING_WRITE_BACK_H
