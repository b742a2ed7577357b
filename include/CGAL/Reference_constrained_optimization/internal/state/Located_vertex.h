// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_LOCATED_VERTEX_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_LOCATED_VERTEX_H

#include <CGAL/Reference_constrained_optimization/internal/reference/Polyline_set.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A vertex with its point of R and R's normal there.
struct Located_vertex
{
  Surface_point on_reference;
  Vector_3 position = Vector_3::Zero(); // differs from on_reference for constrained vertices off R
  Vector_3 normal = Vector_3::Zero();
  Polyline_point on_line; // of vertices that slide
};

// Moves a vertex to its point of a line; false if there is no point of R on the same sheet.
inline bool locate_on_line(const Polyline_set& lines,
                           const Reference_surface& reference,
                           Located_vertex& vertex)
{
  const int face = lines[vertex.on_line.segment].face;
  const Surface_point projection = reference.local_closest(
    lines.position(vertex.on_line), face >= 0 ? face : vertex.on_reference.face);
  const Vector_3 normal = reference.normal(projection);
  if(!(normal.dot(vertex.normal) > 0))
    return false;
  vertex.on_reference = projection;
  vertex.position = projection.position;
  vertex.normal = normal;
  return true;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_LOCATED_VERTEX_H
