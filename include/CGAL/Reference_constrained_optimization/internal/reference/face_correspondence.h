// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FACE_CORRESPONDENCE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FACE_CORRESPONDENCE_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The shift that maps the cyclic list of vertices of face f to that of another mesh's face of `degree`
// vertices `other(i)`; -1 if the lists differ.
template <typename VertexAccess>
int face_rotation(const Indexed_mesh& mesh, int f, int degree, const VertexAccess& other)
{
  if(mesh.degree(f) != degree)
    return -1;
  for(int shift = 0; shift < degree; ++shift)
  {
    bool is_same = true;
    for(int i = 0; i < degree && is_same; ++i)
      is_same = mesh.corner_vertex[mesh.face_begin[f] + i] == other((i + shift) % degree);
    if(is_same)
      return shift;
  }
  return -1;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FACE_CORRESPONDENCE_H
