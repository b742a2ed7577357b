// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_DISK_TOPOLOGY_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_DISK_TOPOLOGY_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Whether a patch that is a topological disk (or empty) remains one when face f is added: the edges that f
// shares with it must form one contiguous run that leaves out at least one edge, and a vertex of f that is
// not on the run must not belong to the patch yet.
template <typename FaceInPatch, typename VertexInPatch>
bool preserves_disk(const Indexed_mesh& mesh,
                    int f,
                    const FaceInPatch& face_in_patch,
                    const VertexInPatch& vertex_in_patch)
{
  const int begin = mesh.face_begin[f], end = mesh.face_begin[f + 1];
  const auto shared = [&](int c) {
    const int o = mesh.opposite[c];
    return o >= 0 && face_in_patch(mesh.corner_face[o]);
  };
  int number_shared = 0, runs = 0;
  for(int c = begin; c < end; ++c)
  {
    const bool here = shared(c), before = shared(mesh.previous(c));
    number_shared += here;
    runs += here && !before;
    if(!here && !before && vertex_in_patch(mesh.corner_vertex[c]))
      return false;
  }
  if(number_shared == end - begin)
    return false;
  return runs == 1 || number_shared == 0;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SELECTION_DISK_TOPOLOGY_H
