// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Stopping: how often the visitor is asked, and what the mesh is like when it says no, throws, or the
// time is up, at any moment.

#include "Recorder.h"
#include "deformations.h"
#include "optimization.h"

#include <chrono>
#include <thread>

using namespace rco_test;

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
void test_states()
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
  const int attempts = 3; // others may be busy
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
    std::cout << visitor.questions << " questions, " << gap << " s between two of them at most, "
              << rest << " s after the last one" << std::endl;
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
    std::cout << time << " s allowed: " << overtime << " s more" << std::endl;
    RCO_CHECK_LESS(overtime, limit);
  }
}

template <typename Tag>
void test_all()
{
  test_states<Tag>();
  test_latency<Tag>();
}

int main()
{
  run_test("sequential", test_all<CGAL::Sequential_tag>);
#ifdef CGAL_LINKED_WITH_TBB
  run_test("parallel", test_all<CGAL::Parallel_tag>);
#endif
  return report();
}
