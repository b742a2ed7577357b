// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The stages of a run: restarts, clusters of vertices, the finishing stage as a whole, and its statistics.

#include "Located_shape.h"
#include "deformations.h"
#include "optimization.h"

using namespace rco_test;

template <typename Tag = CGAL::Sequential_tag>
std::pair<Shape, RCO::Result>
optimized(const Shape& start, const Shape& regular, bool finishes, unsigned int seed = 0)
{
  Mesh mesh = mesh_of(start);
  const Shape before = make_shape(mesh);
  const Mesh reference = mesh_of(regular);
  const RCO::Result r =
    improve_angles<Tag>(mesh, reference, params::use_finishing_stage(finishes).random_seed(seed));
  check_result(before, mesh, reference, r);
  RCO_CHECK_EQUAL(defects_after(r), 0u);
  RCO_CHECK_LESS(r.final_energy, r.initial_energy);
  return {make_shape(mesh), r};
}

// `gain` is what the finishing stage must add to the smallest angle, in degrees
void test_finishing(const std::string& name, const Shape& start, const Shape& regular, double gain)
{
  const Scope scope("finishing stage, " + name);
  const auto without = optimized(start, regular, false);
  const auto with = optimized(start, regular, true);
  const double before = smallest_angle(without.first), after = smallest_angle(with.first);
  RCO_CHECK_LESS_EQUAL(before + gain, after);
  // the others do not pay for it
  RCO_CHECK_LESS(mean_smallest_angle(without.first) - 0.25, mean_smallest_angle(with.first));
  std::cout << name << ": smallest angle " << smallest_angle(start) << " -> " << before << " -> "
            << after << std::endl;

  RCO_CHECK(same_bits(with.first, optimized(start, regular, true).first));
  const auto other = optimized(start, regular, true, 1);
  RCO_CHECK_LESS_EQUAL(before, smallest_angle(other.first) + 2);
  with_threads([&](auto tag) {
    const auto parallel = optimized<decltype(tag)>(start, regular, true);
    RCO_CHECK(same_bits(with.first, parallel.first));
    RCO_CHECK_EQUAL(with.second.final_energy, parallel.second.final_energy);
    RCO_CHECK_EQUAL(with.second.number_of_patches, parallel.second.number_of_patches);
  });
}

// the largest patch and the energy of each iteration
struct Largest_patches : RCO::Default_visitor
{
  std::vector<std::size_t> sizes;
  std::vector<double> energies;
  bool iterates = false;
  void on_iteration_begin(std::size_t)
  {
    iterates = true;
    sizes.push_back(0);
  }
  void on_iteration_end(std::size_t, double energy)
  {
    iterates = false;
    energies.push_back(energy);
  }
  void on_patch_end(const RCO::Patch_report& report)
  {
    if(iterates)
      sizes.back() = (std::max)(sizes.back(), report.number_of_faces);
  }
};

// After convergence, all of a mesh that was divided into several patches is visited in a single one; but
// not if the caller bounds their size.
void test_restarts()
{
  const Shape ring = torus(80, 40), start = scrambled(ring, 0.3, 13, onto_torus(1, 0.4));
  const Mesh reference = mesh_of(ring);
  for(const unsigned int maximum : {0u, 2000u, 2000000000u})
  {
    Largest_patches visitor;
    Mesh mesh = mesh_of(start);
    const RCO::Result r = improve_angles(
      mesh, reference,
      params::maximum_patch_size(maximum).use_finishing_stage(false).visitor(std::ref(visitor)));
    RCO_CHECK(r.status == RCO::Status::converged);
    if(maximum <= 2000)
      RCO_CHECK_LESS(visitor.sizes.front(), ring.faces.size());
    const std::size_t largest = *std::max_element(visitor.sizes.begin(), visitor.sizes.end());
    if(maximum == 0)
      RCO_CHECK_EQUAL(largest, ring.faces.size());
    else
      RCO_CHECK_LESS_EQUAL(largest, std::size_t(maximum));
    for(std::size_t i = 1; i < visitor.energies.size(); ++i)
      RCO_CHECK_LESS_EQUAL(visitor.energies[i], visitor.energies[i - 1] * (1 + 1e-12));
  }
}

// A saddle with a border where vertices nearly coincide with their neighbours, inside and at the border, as
// marching cubes produce them. Faces at fixed vertices of the border stay sharp: the faces at these short
// edges, and no others.
void test_clusters(double size)
{
  const Scope scope("clusters of " + std::to_string(-std::log10(size)) + " digits");
  const int n = 16;
  Shape start = plane_grid(n, n);
  const Indexed_mesh grid = indexed(start);
  std::vector<char> is_in(start.points.size(), 0);
  for(const int center : {2 * (n + 1) + 7, 7 * (n + 1) + 4, 8 * (n + 1) + 11, 13 * (n + 1) + 13, 6,
                          9 * (n + 1), 12 * (n + 1) - 1, n * (n + 1) + 5})
  {
    const Vector_3 p = start.points[center];
    for(int k = grid.vertex_begin[center]; k < grid.vertex_begin[center + 1]; ++k)
    {
      const int c = grid.vertex_corners[k];
      for(const int v : {center, grid.target(c), grid.source(grid.previous(c))})
        if(!is_in[v])
        {
          is_in[v] = 1;
          start.points[v] = p + size * (start.points[v] - p);
        }
    }
  }
  for(Vector_3& p : start.points)
    p.z() = 0.5 * (p.x() - 0.4) * (p.y() - 0.6);
  std::size_t held = 0;
  for(int c = 0; c < grid.number_of_corners(); ++c)
    held += grid.opposite[c] < 0 && is_in[grid.source(c)] && is_in[grid.target(c)];
  const auto sharp = [](const Shape& shape) {
    std::size_t count = 0;
    for(const std::vector<int>& f : shape.faces)
      count += smallest_angle(Shape{shape.points, {f}}) < 10;
    return count;
  };
  RCO_CHECK_LESS(2 * held, sharp(start));
  for(const unsigned int seed : {0, 1, 2, 3})
  {
    const auto result = optimized(start, start, true, seed);
    RCO_CHECK_LESS_EQUAL(sharp(result.first), held);
    RCO_CHECK_LESS(mean_smallest_angle(start), mean_smallest_angle(result.first));
    RCO_CHECK_LESS_EQUAL(smallest_angle(start), smallest_angle(result.first));
    std::cout << "clusters of " << size << ": faces below 10 degrees " << sharp(start) << " -> "
              << sharp(result.first) << ", of which stay " << held << "; mean "
              << mean_smallest_angle(start) << " -> " << mean_smallest_angle(result.first)
              << std::endl;
  }
}

// Statistics that follow changes are those of all faces anew, and what was saved can be restored.
void test_statistics()
{
  const Shape regular = icosphere(2);
  Located_shape scene(scrambled(regular, 0.3, 2, onto_sphere), regular);
  const auto densities =
    internal::make_element_densities(std::make_tuple(RCO::Exponential_MIPS_density(1)));
  typedef internal::Angle_statistics<std::decay_t<decltype(densities)>> Statistics;
  Statistics statistics(scene.state, densities);
  const auto check_all = [&](const Shape& shape) {
    Statistics anew(scene.state, densities);
    anew.measure_all<CGAL::Sequential_tag>();
    RCO_CHECK_NEAR(statistics.energy(), anew.energy(), 1e-9 * anew.energy());
    RCO_CHECK_NEAR(statistics.minimum(), smallest_angle(shape), 1e-6);
    RCO_CHECK_NEAR(statistics.mean(), mean_smallest_angle(shape), 1e-6);
  };
  const auto shape = [&]() {
    Shape s = regular;
    for(std::size_t v = 0; v < s.points.size(); ++v)
      s.points[v] = scene.state.vertices[v].position;
    return s;
  };
  statistics.measure_all<CGAL::Sequential_tag>();
  const Shape start = shape();
  check_all(start);
  internal::Shape_bound shape_bound;
  shape_bound.initialize<CGAL::Sequential_tag>(scene.state, 0.1, true, internal::Drift_barrier(1));
  internal::Saved_state saved(scene.state, shape_bound);
  std::vector<int> changed;
  for(int f = 0; f < scene.copy.mesh.number_of_faces(); f += 9)
    changed.push_back(f);
  saved.add(changed);
  std::vector<char> moves(start.points.size(), 0);
  for(const int f : changed)
    moves[start.faces[f][0]] = 1;
  for(std::size_t v = 0; v < moves.size(); ++v)
    if(moves[v])
      scene.state.vertices[v].position *= 1.1;
  changed.clear();
  for(int f = 0; f < scene.copy.mesh.number_of_faces(); ++f)
    if(moves[start.faces[f][0]] || moves[start.faces[f][1]] || moves[start.faces[f][2]])
      changed.push_back(f);
  statistics.measure(changed);
  check_all(shape());
  saved.restore();
  statistics.measure(changed);
  RCO_CHECK(same_bits(shape(), start));
  check_all(start);
}

int main()
{
  run_test("restarting", test_restarts);
  for(const double size : {1e-4, 1e-11, 1e-13})
    test_clusters(size);
  const Shape ring = torus(50, 20), ball = icosphere(3), square = plane_grid(24, 24);
  test_finishing("torus", scrambled(ring, 0.3, 10, onto_torus(1, 0.4)), ring, 0.5);
  test_finishing("sphere", scrambled(ball, 0.3, 11, onto_sphere), ball, 0);
  test_finishing("square", scrambled(square, 0.3, 12, onto_plane), square, 0);
  const Shape blobby = read_data("blobby.off");
  if(!blobby.faces.empty())
    test_finishing("blobby", blobby, blobby, 2);
  run_test("statistics", test_statistics);
  return report();
}
