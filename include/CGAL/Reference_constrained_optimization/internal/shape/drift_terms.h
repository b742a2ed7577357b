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

// The drift barrier as Newton's method sees it: the distance of a sample in a triangle is linear in
// the coordinates u of the triangle's three vertices. The closest point goes along with the sample, so
// that only the motion across the surface counts: the row of vertex k is b_k T_k^t n.
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
      if(Drift_barrier::is_felt(sample.distance, sample.bound))
        add(s / 4, sample_barycentric(s % 4), sample.distance, sample.bound, sample.direction);
    }
    for(const Patch_samples::Guest& guest : samples.guests)
      if(Drift_barrier::is_felt(guest.distance, guest.bound))
        add(guest.triangle, guest.barycentric, guest.distance, guest.bound, guest.direction);
  }

  const std::vector<Term>& terms() const { return m_terms; }

  const Drift_barrier& barrier() const { return m_barrier; }

private:
  Drift_barrier m_barrier;
  std::vector<Term> m_terms;
};

// the triangles in which terms may be; none if the barrier is off
inline std::vector<std::array<int, 3>> drift_carriers(const Patch& patch,
                                                      const Patch_samples& samples)
{
  std::vector<std::array<int, 3>> carriers;
  if(!samples.are_bounded())
    return carriers;
  const Indexed_mesh& triangles = patch.triangles();
  for(int t = 0; t < triangles.number_of_faces(); ++t)
  {
    const int* v = &triangles.corner_vertex[3 * t];
    carriers.push_back({{v[0], v[1], v[2]}});
  }
  return carriers;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_DRIFT_TERMS_H
