// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_REFERENCE_LINES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_REFERENCE_LINES_H

#include <CGAL/Reference_constrained_optimization/internal/reading/initial_state.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/polyline_tracing.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The lines of R that vertices of the mesh may slide along, as edges of R.
struct Reference_lines
{
  Line_edges border;
  Line_edges features; // those that the caller names, or else the edges where R is sharp
  bool features_are_given = false; // by the caller, or detected

  void set_features(Line_edges edges)
  {
    features = std::move(edges);
    features_are_given = true;
  }
};

// `mesh` is R with its quads
template <typename ReferenceMesh, typename NamedParameters>
Reference_lines read_reference_lines(const ReferenceMesh& graph,
                                     const NamedParameters& np,
                                     const Indexed_mesh& mesh,
                                     const Reference_surface& reference)
{
  Reference_lines lines;
  const Indexed_mesh& triangles = reference.mesh();
  for(int c = 0; c < triangles.number_of_corners(); ++c)
    if(triangles.opposite[c] < 0)
      lines.border.push_back({{triangles.source(c), triangles.target(c)}});
  if constexpr(parameters::is_default_parameter<NamedParameters,
                                                CGAL::internal_np::edge_is_constrained_t>::value)
  {
    for(const int c : reference.creases())
      lines.features.push_back({{triangles.source(c), triangles.target(c)}});
  }
  else
  {
    lines.features_are_given = true;
    const Constraints constraints = read_constraints(graph, np, mesh);
    for(int c = 0; c < mesh.number_of_corners(); ++c)
      if(c < mesh.opposite[c] && constraints.is_line[c])
        lines.features.push_back({{mesh.source(c), mesh.target(c)}});
  }
  return lines;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_REFERENCE_LINES_H
