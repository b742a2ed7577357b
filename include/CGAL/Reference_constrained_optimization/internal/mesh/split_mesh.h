// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_SPLIT_MESH_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_SPLIT_MESH_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <array>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The mesh with its faces split into triangles. split(f) gives the corners of the triangles of face f,
// one or two; `on_triangle(f)` is called for each triangle in turn. Opposite corners are taken from the
// mesh, since two quads that share two vertices can have diagonals with the same end points.
template <typename Split, typename OnTriangle>
Indexed_mesh split_mesh(const Indexed_mesh& mesh, const Split& split, const OnTriangle& on_triangle)
{
  std::vector<int> begins(1, 0), corners, old_corner, new_corner(mesh.number_of_corners(), -1);
  for(int f = 0; f < mesh.number_of_faces(); ++f)
    for(const std::array<int, 3>& t : split(f))
    {
      on_triangle(f);
      for(int i = 0; i < 3; ++i)
      {
        const bool is_diagonal = mesh.next(t[i]) != t[(i + 1) % 3];
        if(!is_diagonal)
          new_corner[t[i]] = int(corners.size());
        old_corner.push_back(is_diagonal ? -1 : t[i]);
        corners.push_back(mesh.corner_vertex[t[i]]);
      }
      begins.push_back(int(corners.size()));
    }
  std::vector<int> opposites(corners.size(), -1);
  int unmatched = -1; // the first side of a diagonal, until its other side is found
  for(int c = 0; c < int(corners.size()); ++c)
    if(old_corner[c] < 0)
    {
      if(unmatched >= 0)
      {
        opposites[c] = unmatched;
        opposites[unmatched] = c;
      }
      unmatched = unmatched < 0 ? c : -1;
    }
    else if(mesh.opposite[old_corner[c]] >= 0)
      opposites[c] = new_corner[mesh.opposite[old_corner[c]]];
  return Indexed_mesh(std::move(begins), std::move(corners), std::move(opposites),
                      mesh.number_of_vertices());
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_SPLIT_MESH_H
