// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_TRIAL_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_TRIAL_H

#include <CGAL/Reference_constrained_optimization/internal/shape/Patch_samples.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Quantities that several invariants use.
struct Patch_quantities
{
  std::vector<Vector_3> normals; // per face
  std::vector<double> densities; // per element
  std::vector<double> cosines;   // per face: of its smallest angle
  std::vector<double> stencils;  // per stencil: its value

  // measures some faces with their vertices at `located`
  template <typename Density>
  void measure(const Patch& patch,
               const std::vector<int>& faces,
               const Density& density,
               const std::vector<Located_vertex>& located)
  {
    const Indexed_mesh& mesh = patch.polygons;
    const auto vertex = [&](int v) -> const Located_vertex& { return located[v]; };
    normals.resize(mesh.number_of_faces());
    densities.resize(patch.elements.size());
    cosines.resize(mesh.number_of_faces());
    for(const int f : faces)
    {
      normals[f] = face_normal(mesh, vertex, f);
      for(int e = patch.element_begin[f]; e < patch.element_begin[f + 1]; ++e)
        densities[e] = element_energy(density, patch.elements[e], vertex);
      cosines[f] = smallest_angle_cosine(mesh, vertex, f);
    }
    stencils.clear();
    for(const Patch::Stencil& s : patch.stencils)
      stencils.push_back(patch.value(s, located));
  }
};

// Sums over a patch and its boundary, before and after.
struct Patch_measure
{
  double energy = 0; // of elements and stencils
  // that part which is of stencils with vertices that other patches may move
  double shared_energy = 0;
  double drift_energy = 0; // of the drift barrier
  double angles = 0;       // sum of the faces' smallest angles in degrees, if their mean is bounded
  double volume = 0;       // six times that of the cones over its faces, if it is bounded
  int inner_creases = 0, boundary_creases = 0; // as for defects
  int creases() const { return inner_creases + boundary_creases; }
  // pairs of faces that intersect, since the first proposal for the patch
  int added_intersections = 0;
  int inner_defects = 0;    // inverted faces, quads that are not convex, and folded edges inside
  int boundary_defects = 0; // folded edges to faces outside
  int defects() const { return inner_defects + boundary_defects; }
  bool is_lower_than(const Patch_measure& before) const
  {
    return energy < before.energy && energy + drift_energy < before.energy + before.drift_energy;
  }
};

// Bounds that change between iterations and stages.
struct Step_limits
{
  double density = 0; // no step may raise the density of an element above it, or further above
  double cosine = 1;  // no step may raise that of an angle above it, or further above
  // whether patches may add creases and intersections, up to the numbers of the input
  bool uses_allowances = false;
};

// A patch with trial positions of its vertices.
struct Trial
{
  const Patch& patch;
  const Optimization_state& state;
  const Step_limits& limits;
  const std::vector<Located_vertex>& located; // per vertex: its trial position
  const Patch_samples& samples;               // before
  const Patch_quantities &before, &after;
  const Patch_measure& sums_before;
  const Patch_measure& initial_sums;            // before the first proposal for the patch
  const std::vector<Vector_3>& outside_normals; // per corner with a face outside: its normal
  const std::vector<int>& changed;              // faces that differ from the last trial
  const std::vector<char>& is_changed;          // per face

  const Indexed_mesh& mesh() const { return patch.polygons; }
  const Located_vertex& operator()(int v) const { return located[v]; }

  // What may be added of something that is counted: for the repair of a defect, and where that is allowed,
  // as many as the mesh has lost since the input.
  int allowance(const Bounded_number& number, const Patch_measure& after) const
  {
    return limits.uses_allowances || !number.is_bounded() || after.defects() < sums_before.defects()
             ? number.allowance()
             : 0;
  }

  // calls visit(e, normal, opposite_normal) for the edges of changed faces that have two faces, some of them
  // twice; e is the first of the corners of the edge
  template <typename Visit>
  void for_each_changed_edge(const Visit& visit) const
  {
    for(const int f : changed)
      for(int c = mesh().face_begin[f]; c < mesh().face_begin[f + 1]; ++c)
      {
        const int o = mesh().opposite[c];
        if(o >= 0)
          visit((std::min)(c, o), after.normals[f], after.normals[mesh().corner_face[o]]);
        else if(patch.outside_face[c] >= 0)
          visit(c, after.normals[f], outside_normals[c]);
      }
  }
};

// A quantity before and after, of every face, edge or sample.
template <typename T>
struct Compared
{
  std::vector<T> before, after;
  void assign(std::size_t n, const T& value)
  {
    before.clear();
    after.assign(n, value);
  }
  void accept() { before = after; }
  bool has_increased(std::size_t i) const { return after[i] > before[i]; }
};

// An invariant is a rule that every accepted step obeys. It derives from this class and has
//   bool holds(const Trial&, Violating_vertices&) const;
// or, if it is a rule for the sums over a patch,
//   bool holds(const Trial&, Patch_measure& after, Violating_vertices&) const;
// which adds the violating vertices if it does not hold. Each invariant measures its own quantities, on the
// faces that changed.
struct Invariant
{
  void start(const Trial&) {}   // of a new patch, before any measurement
  void measure(const Trial&) {} // the faces that changed
  void accept() {}              // the last measurement is that before the next trial
  void sum_up(const Trial&, Patch_measure&) const {} // adds its sums over the patch
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_TRIAL_H
