// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_FACE_INTERSECTIONS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_FACE_INTERSECTIONS_H

#include <CGAL/Reference_constrained_optimization/internal/invariants/Trial.h>
#include <CGAL/Reference_constrained_optimization/internal/invariants/Violating_vertices.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/self_intersections.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The number of pairs of faces that intersect does not increase in a patch, but for its allowance. Only faces
// near which R has another sheet are tested, with each other and with those of the mesh as it is; the commit
// tests them with other patches of the same round. To be tested last, since it takes longest.
struct Face_intersections : Invariant
{
  // the faces of new pairs are violating
  bool holds(const Trial& trial, Patch_measure& after, Violating_vertices& violating) const
  {
    const Bounded_number& number = trial.state.counts.intersections;
    const auto vertex_before = [&](int v) -> const Located_vertex& {
      return trial.patch.located[v];
    };
    const std::vector<int> faces =
      trial.state.faces_near_sheets_of(trial.mesh(), vertex_before, trial);
    if(faces.empty())
      return true;
    const Pairs pairs = intersections(trial, trial.located, faces);
    if(pairs.empty() && number.now == 0)
      return true;
    const Pairs pairs_before = intersections(trial, trial.patch.located, faces);
    after.added_intersections =
      trial.sums_before.added_intersections + int(pairs.size()) - int(pairs_before.size());
    if(after.added_intersections <= trial.allowance(number, after))
      return true;
    for(const std::pair<int, int>& p : pairs)
      if(!std::binary_search(pairs_before.begin(), pairs_before.end(), p))
        for(const int f : {p.first, p.second})
          if(f >= 0)
            violating.add_face(f);
    return false;
  }

private:
  // of faces of the patch; or the second is ~f for a face f of the mesh
  typedef std::vector<std::pair<int, int>> Pairs;

  static Pairs intersections(const Trial& trial,
                             const std::vector<Located_vertex>& located,
                             const std::vector<int>& faces)
  {
    const Optimization_state& state = trial.state;
    std::vector<Indexed_triangle> inside = triangles_of(
      trial.mesh(), [&](int v) -> const Vector_3& { return located[v].position; }, faces);
    Eigen::AlignedBox3d box;
    for(Indexed_triangle& t : inside)
    {
      box.extend(t.box);
      for(int& v : t.vertices)
        v = trial.patch.vertices[v];
    }
    std::vector<int> others;
    for(const Optimization_state::Boxed_face& other : state.faces_near_sheets)
      if(box.intersects(other.box))
        others.push_back(other.face);
    if(!others.empty())
    {
      std::vector<int> own = trial.patch.faces;
      std::sort(own.begin(), own.end());
      others.erase(
        std::remove_if(others.begin(), others.end(),
                       [&](int f) { return std::binary_search(own.begin(), own.end(), f); }),
        others.end());
    }
    const std::vector<Indexed_triangle> outside = triangles_of(
      state.mesh, [&](int v) -> const Vector_3& { return state.vertices[v].position; }, others);
    Pairs pairs = self_intersections(inside);
    for_each_close_pair(inside, outside, [&](const Indexed_triangle& s, const Indexed_triangle& t) {
      if(intersect(s, t))
        pairs.emplace_back(s.face, ~t.face);
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_FACE_INTERSECTIONS_H
