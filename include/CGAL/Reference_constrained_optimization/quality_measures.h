// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_H

/*!
 * \file quality_measures.h
 *
 * includes every measure of a mesh and its reference that tests, examples and benchmarks use, but
 * for `quality_measures/certified_drift.h`, which takes long to compile.
 */

#include <CGAL/Reference_constrained_optimization/factorization_time.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/angles.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/distance_to_reference.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/distortion.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/drift.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/feature_deviation.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/map_statistics.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/minimum_angle_estimate.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/normal_deviation.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/orientation.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/quads.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/self_intersections.h>

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_QUALITY_MEASURES_H
