// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_TRIAL_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_TRIAL_H

#include <CGAL/Reference_constrained_optimization/internal/shape/Patch_samples.h>

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
  double shared_energy =
    0; // that part which is of stencils with vertices that other patches may move
  double drift_energy = 0; // of the drift barrier
  double angles = 0;       // sum of the faces' smallest angles in degrees, if their mean is bounded
  double volume = 0;       // six times that of the cones over its faces, if it is bounded
  int inner_creases = 0, boundary_creases = 0; // as for defects
  int inner_defects = 0;    // inverted faces, quads that are not convex, and folded edges inside
  int boundary_defects = 0; // folded edges to faces outside
  int defects() const { return inner_defects + boundary_defects; }
  bool is_lower_than(const Patch_measure& before) const
  {
    return energy < before.energy && energy + drift_energy < before.energy + before.drift_energy;
  }
};

// A patch with trial positions of its vertices.
struct Trial
{
  const Patch& patch;
  const Optimization_state& state;
  const std::vector<Located_vertex>& located; // per vertex: its trial position
  const Patch_samples& samples;               // before
  const Patch_quantities &before, &after;
  const Patch_measure& sums_before;
  const std::vector<Vector_3>& outside_normals; // per corner with a face outside: its normal
  const std::vector<int>& changed;              // faces that differ from the last trial
  const std::vector<char>& is_changed;          // per face

  const Indexed_mesh& mesh() const { return patch.polygons; }
  const Located_vertex& operator()(int v) const { return located[v]; }
  // the normal of the face across a corner's edge; to be called only where there is one
  const Vector_3& opposite_normal(int c) const
  {
    const int o = mesh().opposite[c];
    return o >= 0 ? after.normals[mesh().corner_face[o]] : outside_normals[c];
  }
  bool has_opposite(int c) const { return mesh().opposite[c] >= 0 || patch.outside_face[c] >= 0; }
  // the first of the corners of an edge
  int edge(int c) const
  {
    const int o = mesh().opposite[c];
    return o >= 0 && o < c ? o : c;
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

// Bounds on single elements, which change between iterations.
struct Step_limits
{
  double density = 0; // no step may raise the density of an element above it, or further above
  double cosine = 1;  // no step may raise that of an angle above it, or further above
  bool adds_creases = false; // whether patches may add creases, up to the number of the input
};

// An invariant is a rule that every accepted step obeys. It derives from this class and has
//   bool holds(const Trial&, Violating_vertices&) const;
// or, if it is a rule for the sums over a patch,
//   bool holds(const Trial&, const Patch_measure& after, Violating_vertices&) const;
// which adds the violating vertices if it does not hold. Each invariant measures its own quantities, on the
// faces that changed.
struct Invariant
{
  void set(const Step_limits&) {} // before a decision
  void start(const Trial&) {}     // of a new patch, before any measurement
  void measure(const Trial&) {}   // the faces that changed
  void accept() {}                // the last measurement is that before the next trial
  void sum_up(const Trial&, Patch_measure&) const {} // adds its sums over the patch
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_INVARIANTS_TRIAL_H
