// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_LOOP_PARAMETERS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_LOOP_PARAMETERS_H

#include <CGAL/Reference_constrained_optimization/internal/selection/patch_selection.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

struct Loop_parameters
{
  std::size_t number_of_iterations = 100;
  double drift_bound = -1; // a length; negative: see Patch_visits::make_shape_bound
  // decrease per iteration, relative to the excess of the energy over that of elements at rest
  double energy_tolerance = 4e-3;
  double maximum_running_time = std::numeric_limits<double>::infinity(); // seconds
  unsigned int random_seed = 0;
  bool use_finishing_stage = true;
  Selection_parameters selection;
  bool relax_constraints = false;
  bool detect_features = true; // where the caller constrains no edges
  bool use_on_surface_steps = true;
  bool allow_creases = false, allow_self_intersections = false; // more than on input
};

// Sizes are counted in triangles: a quad is two.
inline int triangles_to_faces(const Indexed_mesh& mesh, double triangles)
{
  const double triangles_per_face =
    double(mesh.number_of_corners()) / double(mesh.number_of_faces()) - 2;
  return int(triangles / triangles_per_face);
}

// Larger patches need fewer iterations, each more expensive per face: their size grows with the mesh, as
// fast as their number.
inline int patch_size(const Indexed_mesh& mesh, double factor, double smallest)
{
  const double triangles = double(mesh.number_of_corners() - 2 * mesh.number_of_faces());
  const double largest = 4000;
  return triangles_to_faces(
    mesh, (std::min)(largest, (std::max)(smallest, factor * std::sqrt(triangles))));
}

// Where steps on the surface follow, patches that are flattened because of sharp triangles are small;
// stretched elements depend on larger surroundings.
inline Selection_parameters with_patch_size(const Loop_parameters& parameters,
                                            const Indexed_mesh& mesh,
                                            bool has_angle_criterion)
{
  Selection_parameters selection = parameters.selection;
  // steps on the surface visit all faces afterwards
  selection.requires_interior = !parameters.use_on_surface_steps;
  if(selection.maximum_patch_size == 0)
    selection.maximum_patch_size = parameters.use_on_surface_steps && has_angle_criterion
                                     ? patch_size(mesh, 1.2, 150)
                                     : patch_size(mesh, 4.5, 400);
  return selection;
}

// the bound that the user gave
inline int largest_patch_size(const Selection_parameters& selection)
{
  return selection.maximum_patch_size > 0 ? selection.maximum_patch_size
                                          : (std::numeric_limits<int>::max)();
}

// Of the patches that are optimized on the surface. Large patches allow large displacements; a large mesh
// is divided nevertheless, so that several threads can be used.
inline int on_surface_patch_size(const Selection_parameters& selection, const Indexed_mesh& mesh)
{
  if(selection.maximum_patch_size > 0)
    return selection.maximum_patch_size;
  const double triangles = double(mesh.number_of_corners() - 2 * mesh.number_of_faces());
  const double smallest = 4000, largest = 20000, number = 8;
  return triangles_to_faces(mesh, (std::min)(largest, (std::max)(smallest, triangles / number)));
}

// of the patches around bad elements
inline int small_patch_size(const Selection_parameters& selection, const Indexed_mesh& mesh)
{
  const int size = triangles_to_faces(mesh, 400);
  return selection.maximum_patch_size > 0 ? (std::min)(size, selection.maximum_patch_size) : size;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_LOOP_PARAMETERS_H
