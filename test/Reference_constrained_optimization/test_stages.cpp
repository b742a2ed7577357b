// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The stages of a run: restarts, clusters of vertices, the finishing stage as a whole, and its statistics; how
// often the visitor is asked, and what the mesh is like when it says no, throws, or the time is up, at any
// moment.

#include "Located_shape.h"
#include "Recorder.h"
#include "deformations.h"
#include "optimization.h"

#include <chrono>
#include <thread>

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
  const double before = smallest_angle(without.first);
  RCO_CHECK_LESS_EQUAL(before + gain, smallest_angle(with.first));
  // the others do not pay for it
  RCO_CHECK_LESS(mean_smallest_angle(without.first) - 0.25, mean_smallest_angle(with.first));
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

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
#define RCO_IS_SLOW
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RCO_IS_SLOW
#endif
#endif

enum class Event { question, iteration_begin, iteration_end, round_begin, round_end, patch };

// Stops at a question, or throws at an event, and takes the time between questions.
struct Visitor : RCO::Default_visitor
{
  typedef std::chrono::steady_clock Clock;

  long stops_at = -1, throws_at = -1; // counted from 0
  Event throws_in = Event::question;
  std::thread::id owner = std::this_thread::get_id();
  double seconds = 1e9; // after which it stops
  const Clock::time_point start = Clock::now();
  Clock::time_point last = start;
  double largest_gap = 0;
  long questions = 0, questions_of_setup = -1, seen = 0, rounds = 0;
  bool has_finishing = false, has_stopped = false;

  void see(Event e)
  {
    if(std::this_thread::get_id() != owner)
      RCO_CHECK(!"only the calling thread may call a visitor");
    if(e == throws_in && seen++ == throws_at)
      throw Stopped();
  }
  void on_iteration_begin(std::size_t)
  {
    if(questions_of_setup < 0)
      questions_of_setup = questions;
    see(Event::iteration_begin);
  }
  void on_iteration_end(std::size_t, double) { see(Event::iteration_end); }
  void on_round_begin(std::size_t)
  {
    ++rounds;
    see(Event::round_begin);
  }
  void on_round_end() { see(Event::round_end); }
  void on_patch_end(const RCO::Patch_report& r)
  {
    has_finishing = has_finishing || r.is_finishing;
    see(Event::patch);
  }
  bool go_further()
  {
    if(has_stopped)
      RCO_CHECK(!"no is no");
    const Clock::time_point now = Clock::now();
    largest_gap = (std::max)(largest_gap, std::chrono::duration<double>(now - last).count());
    last = now;
    see(Event::question);
    has_stopped =
      questions++ == stops_at || std::chrono::duration<double>(now - start).count() > seconds;
    return !has_stopped;
  }
};

// a mesh to be optimized, its reference and the ways to do it
struct Scene
{
  Shape start, reference;
  bool on_surface = true;
  bool has_quads = false;
};

template <typename Tag, typename NamedParameters>
RCO::Result
optimize(Mesh& mesh, const Mesh& reference, const Scene& scene, const NamedParameters& np)
{
  if(scene.has_quads)
    return CGAL::reference_constrained_optimize<Tag>(mesh, reference, RCO::Quad_angle_energy(), np);
  return improve_angles<Tag>(mesh, reference, np);
}

template <typename Tag>
RCO::Result optimize(Mesh& mesh, const Mesh& reference, const Scene& scene, Visitor& visitor)
{
  // parts would be optimized for another exponent, and the energy of the requested one not decrease
  return optimize<Tag>(mesh, reference, scene,
                       params::use_on_surface_steps(scene.on_surface)
                         .detect_features(false)
                         .visitor(std::ref(visitor)));
}

// the energy of a mesh as it is
double energy(Mesh mesh, const Mesh& reference, const Scene& scene)
{
  return optimize<CGAL::Sequential_tag>(mesh, reference, scene, params::number_of_iterations(0))
    .initial_energy;
}

// invariants at any moment
void check_state(const Mesh& mesh, const Mesh& reference, const Scene& scene)
{
  const Mesh start = mesh_of(scene.start);
  check_vertices(scene.start, make_shape(mesh), free_vertices(scene.start));
  RCO_CHECK(RCO::distance_to_reference(mesh, reference).is_on_reference());
  RCO_CHECK_LESS_EQUAL(RCO::orientation_defects(mesh, reference).total(),
                       RCO::orientation_defects(start, reference).total());
  RCO_CHECK_LESS_EQUAL(energy(mesh, reference, scene),
                       energy(start, reference, scene) * (1 + 1e-12));
}

template <typename Tag>
void test_stops(const std::string& name, const Scene& scene)
{
  const Scope stops(name);
  const bool is_sequential = std::is_same<Tag, CGAL::Sequential_tag>::value;
  const Mesh reference = mesh_of(scene.reference);
  Visitor all;
  {
    Mesh mesh = mesh_of(scene.start);
    const RCO::Result r = optimize<Tag>(mesh, reference, scene, all);
    RCO_CHECK(r.status == RCO::Status::converged);
    RCO_CHECK_LESS(0, all.questions_of_setup);
    RCO_CHECK_LESS(all.questions_of_setup, all.questions);
    RCO_CHECK_EQUAL(all.has_finishing, scene.on_surface && !scene.has_quads);
  }
  const long n = all.questions, s = all.questions_of_setup;
  double previous = 0;
  for(const long k : {0l, 1l, s - 1, s, s + 1, s + 5, s + (n - s) / 10, s + (n - s) / 4,
                      s + (n - s) / 2, s + 3 * (n - s) / 4, n - 10, n - 1})
  {
    const Scope scope("stopped at question " + std::to_string(k) + " of " + std::to_string(n));
    Mesh mesh = mesh_of(scene.start);
    Visitor visitor;
    visitor.stops_at = k;
    const RCO::Result r = optimize<Tag>(mesh, reference, scene, visitor);
    check_state(mesh, reference, scene);
    if(!visitor.has_stopped)
    {
      RCO_CHECK(!is_sequential); // how often threads meet is theirs
      continue;
    }
    RCO_CHECK_EQUAL(visitor.questions, k + 1);
    RCO_CHECK(r.status == RCO::Status::interrupted);
    RCO_CHECK_LESS_EQUAL(r.final_energy, r.initial_energy);
    RCO_CHECK_LESS_EQUAL(r.number_of_flips, r.initial_number_of_flips);
    RCO_CHECK_LESS_EQUAL(r.number_of_fold_edges, r.initial_number_of_fold_edges);
    if(visitor.questions_of_setup < 0)
      RCO_CHECK(same_bits(make_shape(mesh), scene.start));
    else if(r.drift_bound < std::numeric_limits<double>::infinity())
      RCO_CHECK(r.drift >= RCO::drift(mesh, reference).reference_to_mesh.root_mean_square);
    if(is_sequential && !scene.has_quads && visitor.questions_of_setup >= 0)
    {
      if(previous > 0)
        RCO_CHECK_LESS_EQUAL(r.final_energy, previous * (1 + 5e-3)); // finishing costs a little
      previous = r.final_energy;
      // as reproducible as all else
      Mesh again = mesh_of(scene.start);
      Visitor other;
      other.stops_at = k;
      optimize<Tag>(again, reference, scene, other);
      RCO_CHECK(same_bits(make_shape(mesh), make_shape(again)));
    }
  }

  const auto throws = [&](Event e, long k) {
    const Scope scope("thrown in event " + std::to_string(int(e)) + ", " + std::to_string(k));
    Mesh mesh = mesh_of(scene.start);
    Visitor visitor;
    visitor.throws_in = e;
    visitor.throws_at = k;
    bool thrown = false;
    try
    {
      optimize<Tag>(mesh, reference, scene, visitor);
    }
    catch(const Stopped&)
    {
      thrown = true;
    }
    RCO_CHECK(thrown || (e == Event::question && !is_sequential));
    check_state(mesh, reference, scene);
    if(thrown && visitor.questions_of_setup < 0)
      RCO_CHECK(same_bits(make_shape(mesh), scene.start));
  };
  for(const long k : {0l, s - 1, s + 1, s + (n - s) / 8, s + (n - s) / 2, n - 10})
    throws(Event::question, k);
  for(const Event e : {Event::iteration_begin, Event::iteration_end, Event::round_begin,
                       Event::round_end, Event::patch})
    throws(e, 0);
  throws(Event::round_begin, all.rounds - 1);
  throws(Event::round_end, all.rounds / 2);
}

template <typename Tag>
void test_all_stops()
{
  Scene scene;
  scene.reference = torus(60, 24);
  scene.start = scrambled(scene.reference, 0.35, 5, onto_torus(1, 0.4));
  // on the reference, to begin with
  const auto project = [&]() {
    Mesh mesh = mesh_of(scene.start);
    CGAL::reference_constrained_optimize(mesh, mesh_of(scene.reference), RCO::Quad_angle_energy(),
                                         params::number_of_iterations(0));
    scene.start = make_shape(mesh);
  };
  project();
  test_stops<Tag>("triangles", scene);
  scene.on_surface = false;
  test_stops<Tag>("flattened patches alone", scene);
  scene.on_surface = true;
  scene.start = scrambled(plane_grid(20, 20, 1, true), 0.3, 2, onto_plane);
  scene.reference = plane_grid(20, 20, 1, true);
  scene.has_quads = true;
  test_stops<Tag>("quads with a border", scene);
}

// the visitor is asked often also on a large mesh, and the clock is looked at as often
template <typename Tag>
void test_latency()
{
#ifdef RCO_IS_SLOW
  const int columns = 100, rows = 30;
  const double limit = 1e9;
#else
  const int columns = 400, rows = 125;
  const double limit = 0.25; // a quiet machine takes a tenth of a second at most
#endif
  const Mesh reference = mesh_of(torus(3 * columns / 4, 3 * rows / 4));
  const Shape rough = scrambled(torus(columns, rows), 0.1, 3, onto_torus(1, 0.4));
  const int attempts = 5; // others may be busy
  double gap = 0, overtime = 0, rest = 0;
  for(int attempt = 0; attempt < attempts; ++attempt)
  {
    Mesh mesh = mesh_of(rough);
    Visitor visitor;
    visitor.seconds = 4; // by then it has seen every stage
    improve_angles<Tag>(mesh, reference,
                        params::number_of_iterations(2).visitor(std::ref(visitor)));
    RCO_CHECK(visitor.has_finishing || visitor.has_stopped);
    rest = std::chrono::duration<double>(Visitor::Clock::now() - visitor.last).count();
    gap = visitor.largest_gap;
    if(gap < limit && rest < limit)
      break;
  }
  RCO_CHECK_LESS(gap, limit);
  RCO_CHECK_LESS(rest, limit);
  for(const double time : {0.05, 0.5})
  {
    for(int attempt = 0; attempt < attempts; ++attempt)
    {
      Mesh mesh = mesh_of(rough);
      const Visitor::Clock::time_point start = Visitor::Clock::now();
      const RCO::Result r =
        improve_angles<Tag>(mesh, reference, params::maximum_running_time(time));
      overtime = std::chrono::duration<double>(Visitor::Clock::now() - start).count() - time;
      if(limit < 1)
        RCO_CHECK(r.status == RCO::Status::time_limit);
      if(overtime < limit)
        break;
    }
    RCO_CHECK_LESS(overtime, limit);
  }
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
  run_test("stops", test_all_stops<CGAL::Sequential_tag>);
  run_test("latency", test_latency<CGAL::Sequential_tag>);
#ifdef CGAL_LINKED_WITH_TBB
  run_test("stops, parallel", test_all_stops<CGAL::Parallel_tag>);
  run_test("latency, parallel", test_latency<CGAL::Parallel_tag>);
#endif
  return report();
}
