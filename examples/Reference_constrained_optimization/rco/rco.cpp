// The package as a program: `rco angle`, `rco quad` and `rco map`; `rco --help` tells more.

#include "interruption.h"
#include "landmarks.h"
#include "measures.h"
#include "mesh.h"
#include "mesh_files.h"
#include "optimization.h"
#include "options.h"
#include "outcome.h"
#include "report.h"
#include "run_unless_interrupted.h"
#include "verdict.h"

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/compatible_initial_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

namespace {

// of edges and of the shorter diagonals of quads, as in the library
double mean_edge_length(const Mesh& mesh)
{
  double sum = 0;
  std::size_t number = mesh.number_of_edges();
  const auto distance = [&](Mesh::Vertex_index v, Mesh::Vertex_index w) {
    return std::sqrt(CGAL::squared_distance(mesh.point(v), mesh.point(w)));
  };
  for(const Mesh::Edge_index e : mesh.edges())
    sum += distance(mesh.vertex(e, 0), mesh.vertex(e, 1));
  for(const Mesh::Face_index f : mesh.faces())
    if(mesh.degree(f) == 4)
    {
      const Mesh::Halfedge_index h = mesh.halfedge(f), opposite = mesh.next(mesh.next(h));
      sum += (std::min)(distance(mesh.source(h), mesh.source(opposite)),
                        distance(mesh.target(h), mesh.target(opposite)));
      ++number;
    }
  return sum / double(number);
}

double length_of(const Drift_bound& bound, const Mesh& reference)
{
  return bound.is_in_mean_edges ? bound.value * mean_edge_length(reference) : bound.value;
}

// where a map starts
Mesh read_initial_mesh(const Options& options,
                       const Mesh& source,
                       const Mesh& reference,
                       const Landmarks& landmarks,
                       RCO::Initial_mesh_report& report)
{
  if(!options.initial.empty())
    return read_mesh(options.initial);
  if(landmarks.empty())
    return source;
  Mesh initial;
  report = RCO::compatible_initial_mesh(source, reference, landmarks, initial,
                                        CGAL::parameters::random_seed(options.random_seed));
  return initial;
}

// Ends the program while measuring goes on; the result is written.
[[noreturn]] void end_unmeasured(const Options& options)
{
  const std::string message =
    "interrupted while measuring" + (options.output.empty() ? "" : "; result: " + options.output);
  if(options.prints_json)
    print_json(std::cout, message, Outcome::interrupted);
  else if(!options.is_quiet)
    std::cout << message << std::endl;
  std::cout.flush();
  std::_Exit(int(Outcome::interrupted));
}

Outcome run(const Options& options)
{
  const Mesh input = read_mesh(options.input);
  const bool is_own_reference = options.reference.empty();
  const Mesh reference = is_own_reference ? input : read_mesh(options.reference);
  const bool is_map = options.application == Application::map;
  const Landmarks landmarks =
    options.landmarks.empty() ? Landmarks() : read_landmarks(options.landmarks, input, reference);
  Report report;
  const Mesh initial =
    is_map ? read_initial_mesh(options, input, reference, landmarks, report.initial) : input;
  if(!options.output.empty())
    check_output(options.output, initial);

  Mesh mesh = initial;
  report.number_of_vertices = mesh.number_of_vertices();
  report.number_of_faces = mesh.number_of_faces();
  {
    const Interruptible interruptible;
    report.result = optimize(mesh, reference, input, landmarks,
                             length_of(options.drift_bound, reference), options);
    if(!options.output.empty())
      write_mesh(options.output, mesh);
  }
  if(report.result.status == RCO::Status::interrupted)
    interruption_is_wanted = 0; // it has had its effect
  const bool prints = options.prints_json || !options.is_quiet;
  const bool is_measured = run_unless_interrupted([&]() {
    report.before =
      measure(initial, is_own_reference ? nullptr : &reference, input, landmarks, options, prints);
    report.after = measure(mesh, &reference, input, landmarks, options, prints);
  });
  if(!is_measured)
    end_unmeasured(options);
  report.verdict = verdict_on(report.result, report.before, report.after);
  if(options.prints_json)
    print_json(std::cout, options, report);
  else if(prints)
    print_table(std::cout, options, report);
  return report.verdict.outcome;
}

// what could not be read is not known to ask for it
bool wants_json(int argc, char* argv[])
{
  return std::find(argv, argv + argc, std::string("--json")) != argv + argc;
}

int fail(Outcome outcome, const std::string& message, bool prints_json)
{
  std::cerr << "rco: " << message << std::endl;
  if(prints_json)
    print_json(std::cout, message, outcome);
  return int(outcome);
}

} // namespace

int main(int argc, char* argv[])
{
  const bool prints_json = wants_json(argc, argv);
  try
  {
    Options options;
    if(!read_options(argc, argv, options))
      return int(Outcome::improved);
    if(options.threads > 1 && !can_use_threads())
      throw Failure(Outcome::bad_usage, "--threads: this program was built without TBB");
    return int(run(options));
  }
  catch(const Failure& e)
  {
    return fail(e.outcome(), e.what(), prints_json);
  }
  catch(const RCO::Invalid_input& e)
  {
    return fail(Outcome::refused_input, e.what(), prints_json);
  }
  catch(const std::exception& e)
  {
    return fail(Outcome::failure, e.what(), prints_json);
  }
}
