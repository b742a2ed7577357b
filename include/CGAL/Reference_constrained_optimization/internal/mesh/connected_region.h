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

// The unvisited faces that are connected with the first one by edges; they are marked as visited.
inline std::vector<int>
extract_connected_region(const Indexed_mesh& mesh, int first, std::vector<char>& is_unvisited)
{
  std::vector<int> region(1, first);
  is_unvisited[first] = 0;
  for(std::size_t i = 0; i < region.size(); ++i)
    for(int c = mesh.face_begin[region[i]]; c < mesh.face_begin[region[i] + 1]; ++c)
    {
      const int f = mesh.opposite[c] < 0 ? -1 : mesh.corner_face[mesh.opposite[c]];
      if(f >= 0 && is_unvisited[f])
      {
        is_unvisited[f] = 0;
        region.push_back(f);
      }
    }
  return region;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_CONNECTED_REGION_H
