// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_SEPARATE_CLUSTERS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_SEPARATE_CLUSTERS_H

#include <CGAL/Reference_constrained_optimization/internal/stages/Patch_visits.h>

#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Separates vertices that nearly coincide, as long as the number of clusters decreases. False if
// interrupted.
template <typename Visits>
bool separate_clusters(Visits& visits)
{
  typedef typename Visits::ConcurrencyTag ConcurrencyTag;
  Optimization_state& state = visits.state;
  const auto point = [&](int v) -> const Vector_3& { return state.vertices[v].position; };
  const std::size_t none = (std::numeric_limits<std::size_t>::max)();
  std::size_t before = none;
  bool is_complete = true;
  while(is_complete)
  {
    std::vector<char> is_in(state.mesh.number_of_vertices(), 0);
    std::size_t number = 0;
    for(const std::vector<int>& cluster : vertex_clusters(state.mesh, point))
      for(const int v : cluster)
      {
        is_in[v] = 1;
        number += state.is_free[v];
      }
    if(number == 0 || number >= before)
      break;
    before = number;
    // angles of faces within a cluster have any value: the mean may decrease by this much, in degrees, and
    // the iterations that follow raise it
    const double largest_decrease = 1;
    state.angle_gain = largest_decrease * state.mesh.number_of_faces();
    const std::vector<char> faces = faces_around<ConcurrencyTag>(state.mesh, is_in, 1);
    is_complete = visits.visit_regions(faces, Moves::cluster_separation, visits.densities());
  }
  if(before != none)
    visits.update_sums();
  return is_complete;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_SEPARATE_CLUSTERS_H
