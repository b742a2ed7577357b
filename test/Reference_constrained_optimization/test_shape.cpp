// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Distances between mesh and reference in both directions, their samples, and normal deviations.

#include "Located_shape.h"
#include "checks.h"
#include "deformations.h"

#include <CGAL/Reference_constrained_optimization/internal/shape/Shape_bound.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/face_normal_deviation.h>

using namespace rco_test;

// a coarse sphere on a finer one
struct Scene : Located_shape
{
  internal::Shape_bound shape_bound;
  Scene() : Located_shape(scrambled(icosphere(2), 0.2, 1, onto_sphere), icosphere(3))
  {
    shape_bound.initialize<CGAL::Sequential_tag>(state, 0.01, true, internal::Drift_barrier(1));
  }
  double drift() { return shape_bound.drift<CGAL::Sequential_tag>(state); }

  // the largest distance of midpoints and centroids of the mesh, and of vertices of R, by search in all faces
  double searched_drift() const
  {
    internal::Mesh_copy now = copy;
    for(std::size_t v = 0; v < now.points.size(); ++v)
      now.points[v] = state.vertices[v].position;
    const internal::Reference_surface mesh(now);
    double largest = 0;
    const auto add = [&](const internal::Reference_surface& to, const Vector_3& p) {
      largest = (std::max)(largest, (to.closest(p).position - p).norm());
    };
    for(int f = 0; f < now.mesh.number_of_faces(); ++f)
      for(int i = 0; i < 4; ++i)
        add(surface, mesh.point(f, internal::sample_barycentric(i)).position);
    for(const Vector_3& p : surface.points())
      add(mesh, p);
    return largest;
  }
};

void test_distances()
{
  Scene scene;
  const double drift = scene.searched_drift();
  RCO_CHECK_LESS(0.01, drift);
  RCO_CHECK_NEAR(scene.shape_bound.initial_drift(), drift, 1e-12);
  RCO_CHECK_NEAR(scene.drift(), drift, 1e-12);
  RCO_CHECK_LESS_EQUAL(drift, scene.shape_bound.bound() * internal::Drift_barrier::limit_factor *
                                (1 + 1e-12));

  // two patches have all samples, each of R once
  std::vector<int> times(scene.surface.number_of_reference_samples(), 0);
  double largest = 0;
  for(const bool is_upper : {false, true})
  {
    const internal::Patch_samples samples = scene.shape_bound.gather(
      scene.state, scene.patch([=](const Vector_3& p) { return (p.z() > 0) == is_upper; }));
    for(const internal::Patch_samples::Sample& s : samples.samples)
      largest = (std::max)(largest, s.distance);
    for(const internal::Patch_samples::Projected_sample& s : samples.projected_samples)
    {
      ++times[s.reference_sample];
      largest = (std::max)(largest, s.distance);
    }
  }
  RCO_CHECK(times == std::vector<int>(times.size(), 1));
  RCO_CHECK_NEAR(largest, drift, 1e-12);
}

// Where a part of R is far from the mesh, only what is there may be so far.
void test_uncovered_part()
{
  const Shape all = plane_grid(40, 20, 2);
  Shape half = all;
  for(Vector_3& p : half.points)
    p.x() *= 0.5;
  Located_shape scene(half, all);
  internal::Shape_bound shape_bound;
  const double edge = scene.surface.mean_edge_length();
  shape_bound.initialize<CGAL::Sequential_tag>(scene.state, 0.25 * edge, true,
                                               internal::Drift_barrier(1));
  RCO_CHECK_LESS(10 * edge, shape_bound.initial_drift());
  RCO_CHECK_NEAR(shape_bound.bound(), 3 * edge, 1e-12);
  int covered = 0, uncovered = 0;
  for(const internal::Patch_samples::Projected_sample& s :
      shape_bound.gather(scene.state, scene.whole_patch()).projected_samples)
  {
    (s.distance < 3 * edge ? covered : uncovered) += 1;
    RCO_CHECK_LESS_EQUAL(s.bound, (std::max)(3 * edge, s.distance) * (1 + 1e-12));
    RCO_CHECK_LESS_EQUAL(s.distance, s.bound * internal::Drift_barrier::limit_factor * (1 + 1e-12));
  }
  RCO_CHECK(covered > 100 && uncovered > 100);
}

// What a patch gathered is stored again, and can be restored.
void test_store()
{
  Scene scene;
  const double before = scene.drift();
  const internal::Patch patch = scene.whole_patch();
  internal::Shape_bound::Snapshot snapshot;
  for(const int f : patch.faces)
    scene.shape_bound.save(scene.copy.mesh, f, snapshot);
  internal::Patch_samples samples = scene.shape_bound.gather(scene.state, patch);
  for(internal::Located_vertex& v : scene.state.vertices)
    v.position *= 1.02; // off R
  const auto vertex = [&](int v) -> const internal::Located_vertex& {
    return scene.state.vertices[patch.vertices[v]];
  };
  for(int s = 0; s < int(samples.samples.size()); ++s)
    if(internal::sample_of(patch, s / 4, s % 4) == s)
      internal::locate_sample(patch, samples, scene.surface, vertex, s, samples.samples[s]);
  for(internal::Patch_samples::Projected_sample& s : samples.projected_samples)
    internal::locate_projected_sample(patch, scene.surface, vertex, s);
  scene.shape_bound.store(patch.faces, samples.projected_samples,
                          scene.shape_bound.stored_samples(scene.copy.mesh, patch, samples));
  RCO_CHECK_LESS(1.1 * before, scene.drift() + 0.02);
  RCO_CHECK_NEAR(scene.drift(), scene.searched_drift(), 1e-6);
  RCO_CHECK_LESS(0., samples.energy());
  scene.shape_bound.restore(snapshot);
  RCO_CHECK_EQUAL(scene.drift(), before);
}

// a plane over another one
void test_normal_deviation()
{
  const Shape plane = plane_grid(3, 3);
  for(const double angle : {0., 10., 40.})
  {
    Located_shape scene(plane, plane_grid(20, 20));
    for(internal::Located_vertex& v : scene.state.vertices)
      v.position.z() = std::tan(angle * pi / 180) * v.position.x();
    const auto vertex = [&](int v) -> const internal::Located_vertex& {
      return scene.state.vertices[v];
    };
    for(int f = 0; f < scene.copy.mesh.number_of_faces(); ++f)
      RCO_CHECK_NEAR(
        internal::face_normal_deviation(scene.copy.mesh, scene.surface, vertex, f,
                                        internal::face_normal(scene.copy.mesh, vertex, f)),
        angle, 1e-6);
  }
  // faces in one triangle of R deviate by nothing
  Located_shape scene(plane_grid(20, 20), plane_grid(1, 1));
  const auto vertex = [&](int v) -> const internal::Located_vertex& {
    return scene.state.vertices[v];
  };
  RCO_CHECK_EQUAL(
    internal::face_normal_deviation(scene.copy.mesh, scene.surface, vertex, 30, Vector_3(1, 0, 0)),
    0.);
}

int main()
{
  run_test("distances", test_distances);
  run_test("uncovered part", test_uncovered_part);
  run_test("store", test_store);
  run_test("normal deviation", test_normal_deviation);
  return report();
}
