// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_POINT_INDEX_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_POINT_INDEX_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <boost/functional/hash.hpp>

#include <array>
#include <cstddef>
#include <unordered_map>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// exact coordinates as a key
typedef std::array<double, 3> Point_key;

inline Point_key point_key(const Vector_3& p)
{
  return {{p.x() + 0., p.y() + 0., p.z() + 0.}}; // no -0
}

template <typename Value>
using Point_map = std::unordered_map<Point_key, Value, boost::hash<Point_key>>;

// Which of some points has exactly the given coordinates. A mesh often is its own reference, or
// shares vertices with it: those vertices need no search.
class Point_index
{
public:
  // leaves out the vertices for which is_used(v) is false
  template <typename IsUsed>
  Point_index(const std::vector<Vector_3>& points, const IsUsed& is_used)
  {
    m_vertex.reserve(points.size());
    for(int v = 0; v < int(points.size()); ++v)
      if(is_used(v))
      {
        const auto inserted = m_vertex.emplace(point_key(points[v]), v);
        if(!inserted.second)
          inserted.first->second = -1; // there are several
      }
  }

  // -1 if there is none, or more than one
  int find(const Vector_3& p) const
  {
    const auto found = m_vertex.find(point_key(p));
    return found == m_vertex.end() ? -1 : found->second;
  }

private:
  Point_map<int> m_vertex;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_MESH_POINT_INDEX_H
