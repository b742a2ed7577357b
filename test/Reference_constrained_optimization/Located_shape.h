// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Shapes on their reference surfaces, as the optimization holds them.

#pragma once

#include "shapes.h"

#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/initial_state.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/sliding_vertices.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Patch.h>

#include <vector>

namespace rco_test {

struct Located_shape
{
  internal::Mesh_copy copy;
  internal::Reference_surface surface;
  internal::Element_set elements;
  internal::Optimization_state state;

  // vertices of the border are fixed
  template <typename Energy = RCO::Minimum_angle_energy>
  Located_shape(const Shape& start, const Shape& reference, const Energy& energy = Energy())
    : copy(copy_of(start)),
      surface(copy_of(reference)),
      elements(energy,
               RCO::Energy_context(copy.mesh.face_begin,
                                   copy.mesh.corner_vertex,
                                   copy.points.size(),
                                   1,
                                   area(start),
                                   surface.area())),
      state{copy.mesh, surface, elements, {}, {}}
  {
    for(const char is_border : copy.mesh.is_border_vertex)
      state.is_free.push_back(!is_border);
    RCO::Result unused;
    internal::locate_on_reference(copy.points, surface, state, unused);
  }
  Located_shape(const Located_shape&) = delete;

  // lets the vertices of the border slide along that of the reference
  RCO::Result relax_border()
  {
    internal::Constraints constraints;
    constraints.is_constrained.assign(copy.points.size(), 0);
    for(const int o : copy.mesh.opposite)
      constraints.is_line.push_back(o < 0);
    internal::Reference_lines lines;
    const Indexed_mesh& triangles = surface.mesh();
    for(int c = 0; c < triangles.number_of_corners(); ++c)
      if(triangles.opposite[c] < 0)
        lines.border.push_back({{triangles.source(c), triangles.target(c)}});
    RCO::Result result;
    internal::Sliding_vertices(state, constraints, lines, true, 1e-15, result);
    return result;
  }

  // the faces f for which is_in(f) is true
  template <typename Is_in>
  internal::Patch patch_of_faces(const Is_in& is_in) const
  {
    std::vector<int> faces;
    for(int f = 0; f < copy.mesh.number_of_faces(); ++f)
      if(is_in(f))
        faces.push_back(f);
    return internal::Patch_builder(copy.mesh).build(faces, state);
  }
  // the faces whose first vertex is at a place for which is_in(place) is true
  template <typename Is_in>
  internal::Patch patch(const Is_in& is_in) const
  {
    return patch_of_faces(
      [&](int f) { return is_in(copy.points[copy.mesh.corner_vertex[copy.mesh.face_begin[f]]]); });
  }
  internal::Patch whole_patch() const
  {
    return patch([](const Vector_3&) { return true; });
  }

  template <typename Density>
  internal::Global_measure measure(const Density& density) const
  {
    return internal::measure<CGAL::Sequential_tag>(state, density, 1e300);
  }

  // the positions of a patch' vertices are those of a mover's proposal
  template <typename Mover>
  bool move(const internal::Patch& patch, const Mover& mover, double fraction = 1)
  {
    for(int v = 0; v < int(patch.vertices.size()); ++v)
      if(patch.is_free[v] &&
         !mover.displaced_vertex(patch, v, fraction, state.vertices[patch.vertices[v]]))
        return false;
    return true;
  }
};

} // namespace rco_test
