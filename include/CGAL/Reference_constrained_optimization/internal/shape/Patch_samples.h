// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_PATCH_SAMPLES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_PATCH_SAMPLES_H

#include <CGAL/Reference_constrained_optimization/internal/objective/drift_barrier.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Patch.h>

#include <algorithm>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The samples of the distance between a patch and R in both directions, with their bounds; empty if it is
// not bounded. Directions are unit vectors from R to the mesh, known where the barrier is active.
struct Patch_samples
{
  Drift_barrier barrier;
  double bound = 0;
  const std::vector<double>* local_bounds =
    nullptr;                          // per triangle of R, if it is not the same everywhere
  std::vector<double> minimum_bounds; // per polygon, if any exceeds its bound on input

  // a point of the mesh, see drift_samples.h
  struct Sample
  {
    int face = -1; // of R, where its closest point is
    double distance = 0;
    double bound = 0; // there
    Vector_3 direction = Vector_3::Zero();
  };
  std::vector<Sample> samples;

  // a sample of R whose closest point of the mesh is in the patch
  struct Projected_sample
  {
    int reference_sample; // of R
    int polygon;          // local face that holds its closest point
    double distance;      // to it
    double bound;
    int triangle = -1; // local
    Vector_3 barycentric = Vector_3::Zero();
    Vector_3 direction = Vector_3::Zero();
  };
  std::vector<Projected_sample> projected_samples;

  bool are_bounded() const { return !samples.empty(); }

  // of a sample of a polygon of the patch whose closest point is in a triangle of R
  double bound_at(int polygon, int reference_face) const
  {
    const double here = local_bounds ? (*local_bounds)[reference_face] : bound;
    return minimum_bounds.empty() ? here : (std::max)(here, minimum_bounds[polygon]);
  }

  // the energy of the barrier
  double energy() const
  {
    double sum = 0;
    for(const Sample& sample : samples)
      sum += barrier.value(sample.distance, sample.bound);
    for(const Projected_sample& projected_sample : projected_samples)
      sum += barrier.value(projected_sample.distance, projected_sample.bound);
    return sum;
  }
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SHAPE_PATCH_SAMPLES_H
