// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_LOOP_PARAMETERS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ROUNDS_LOOP_PARAMETERS_H

#include <CGAL/Reference_constrained_optimization/internal/flattening/Flattened_mover.h>
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
  double drift_bound = -1; // a length; negative: see Patch_visits::make_drift_guard
  // decrease per iteration, relative to what the energy has above that of elements at rest
  double energy_tolerance = 4e-3;
  double maximum_running_time = std::numeric_limits<double>::infinity(); // seconds
  unsigned int random_seed = 0;
  int proposals_per_patch = 2; // that is flattened; each after the first needs a gain by the last
  int on_surface_proposals = 3;
  bool use_finishing_stage = true;
  int halo = 4; // rings around the patches of a round in which no other patch of it starts
  Selection_parameters selection;
  Flattened_mover::Parameters mover;
  bool relax_constraints = false;
  bool detect_features = true; // where the caller constrains no edges
  bool use_on_surface_steps = true;
  bool use_active_set = true; // else every iteration visits the whole mesh
  bool accepts_all = false;   // whatever was mapped back is kept, better or not
};

// Sizes are counted in triangles: a quad is two.
inline int triangles_to_faces(const Indexed_mesh& mesh, double triangles)
{
  const double triangles_per_face =
    double(mesh.number_of_corners()) / double(mesh.number_of_faces()) - 2;
  return int(triangles / triangles_per_face);
}

// Larger patches take fewer iterations, each more costly by face: their size grows with the mesh,
// as fast as their number.
inline int patch_size(const Indexed_mesh& mesh, double factor, double smallest)
{
  const double triangles = double(mesh.number_of_corners() - 2 * mesh.number_of_faces());
  const double largest = 4000;
  return triangles_to_faces(
    mesh, (std::min)(largest, (std::max)(smallest, factor * std::sqrt(triangles))));
}

// Where steps on the surface follow, what is laid flat for the sake of sharp triangles is no larger than
// it takes to mend them; stretched elements are a matter of what is around them.
inline Selection_parameters
sized(const Loop_parameters& parameters, const Indexed_mesh& mesh, bool judges_angles)
{
  Selection_parameters selection = parameters.selection;
  // steps on the surface come by everywhere afterwards
  selection.visits_all_well = !parameters.use_on_surface_steps;
  if(selection.maximum_patch_size == 0)
    selection.maximum_patch_size = parameters.use_on_surface_steps && judges_angles
                                     ? patch_size(mesh, 1.2, 150)
                                     : patch_size(mesh, 4.5, 400);
  return selection;
}

// of patches around bad elements that are flattened
inline Selection_parameters small(Selection_parameters selection, const Indexed_mesh& mesh)
{
  const int size = triangles_to_faces(mesh, 200);
  if(selection.maximum_patch_size == 0 || selection.maximum_patch_size > size)
    selection.maximum_patch_size = size;
  return selection;
}

// what the user wants no patch to exceed
inline int largest_patch_size(const Selection_parameters& selection)
{
  return selection.maximum_patch_size > 0 ? selection.maximum_patch_size
                                          : (std::numeric_limits<int>::max)();
}

// Of the patches that are optimized on the surface. In a large patch a vertex can go a long way at
// once; a large mesh is divided nevertheless, so that there is work for several threads.
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
