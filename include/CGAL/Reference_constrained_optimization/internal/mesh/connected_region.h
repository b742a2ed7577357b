// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CONNECTED_REGION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CONNECTED_REGION_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The faces that are left and hang together with the first one by edges; they are not left any more.
inline std::vector<int>
take_connected_region(const Indexed_mesh& mesh, int first, std::vector<char>& is_left)
{
  std::vector<int> region(1, first);
  is_left[first] = 0;
  for(std::size_t i = 0; i < region.size(); ++i)
    for(int c = mesh.face_begin[region[i]]; c < mesh.face_begin[region[i] + 1]; ++c)
    {
      const int f = mesh.opposite[c] < 0 ? -1 : mesh.corner_face[mesh.opposite[c]];
      if(f >= 0 && is_left[f])
      {
        is_left[f] = 0;
        region.push_back(f);
      }
    }
  return region;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CONNECTED_REGION_H
