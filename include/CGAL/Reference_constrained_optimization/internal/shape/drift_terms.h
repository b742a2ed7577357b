// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_TERMS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_TERMS_H

#include <CGAL/Reference_constrained_optimization/internal/objective/drift_barrier.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/drift_samples.h>

#include <array>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The drift barrier linearized for Newton's method: the distance of a sample in a triangle is linear in the
// coordinates u of the triangle's three vertices. The closest point moves with the sample, so that only the
// motion normal to the surface counts: the row of vertex k is b_k T_k^t n.
class Drift_terms
{
public:
  struct Term
  {
    int triangle; // of the patch
    double distance, bound;
    Vector_2 rows[3];
  };

  // `motion(v)` is the matrix (3x2) by which vertex v moves in space when its coordinates do
  template <typename Motion>
  void collect(const Patch& patch, const Patch_samples& samples, const Motion& motion)
  {
    m_terms.clear();
    m_barrier = samples.barrier;
    if(!samples.are_bounded())
      return;
    const auto add = [&](int triangle, const Vector_3& barycentric, double distance, double bound,
                         const Vector_3& direction) {
      const int* corners = &patch.triangles().corner_vertex[3 * triangle];
      Term term{triangle, distance, bound, {}};
      for(int k = 0; k < 3; ++k)
        term.rows[k] = barycentric(k) * (motion(corners[k]).transpose() * direction);
      m_terms.push_back(term);
    };
    for(int s = 0; s < int(samples.samples.size()); ++s)
    {
      const Patch_samples::Sample& sample = samples.samples[s];
      if(Drift_barrier::is_active(sample.distance, sample.bound))
        add(s / 4, sample_barycentric(s % 4), sample.distance, sample.bound, sample.direction);
    }
    for(const Patch_samples::Projected_sample& projected_sample : samples.projected_samples)
      if(Drift_barrier::is_active(projected_sample.distance, projected_sample.bound))
        add(projected_sample.triangle, projected_sample.barycentric, projected_sample.distance,
            projected_sample.bound, projected_sample.direction);
  }

  const std::vector<Term>& terms() const { return m_terms; }

  const Drift_barrier& barrier() const { return m_barrier; }

private:
  Drift_barrier m_barrier;
  std::vector<Term> m_terms;
};

// the triangles of the terms; none if the barrier is off
inline std::vector<std::array<int, 3>> drift_term_triangles(const Patch& patch,
                                                            const Patch_samples& samples)
{
  std::vector<std::array<int, 3>> term_triangles;
  if(!samples.are_bounded())
    return term_triangles;
  const Indexed_mesh& triangles = patch.triangles();
  for(int t = 0; t < triangles.number_of_faces(); ++t)
  {
    const int* v = &triangles.corner_vertex[3 * t];
    term_triangles.push_back({{v[0], v[1], v[2]}});
  }
  return term_triangles;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_TERMS_H
