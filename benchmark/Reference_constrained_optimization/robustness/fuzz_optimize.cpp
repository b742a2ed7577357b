// A fuzz target: bytes are decoded to a small mesh and parameters, the package optimizes it, and its
// guarantees are verified. With RCO_FUZZ_VERBOSE in the environment an input and its outcome are printed,
// to reproduce a failure.

#include "checked_run.h"
#include "fuzz_input.h"

#include <CGAL/Reference_constrained_optimization/Compatible_remeshing_energy.h>
#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/Quad_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/Quad_regularity_energy.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/reference_constrained_optimize.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

namespace {

struct Fuzz_visitor : Monotonicity_visitor
{
  std::size_t stop_after = 0, questions = 0;

  bool go_further() { return ++questions != stop_after; }
};

typedef Mesh::Property_map<Mesh::Edge_index, bool> Edge_map;

Edge_map edge_map(Mesh& mesh, const Fuzz_pattern& pattern)
{
  const Edge_map map = mesh.add_property_map<Mesh::Edge_index, bool>("is_constrained").first;
  for(const Mesh::Edge_index e : mesh.edges())
    map[e] = pattern(std::size_t(e));
  return map;
}

struct Fuzz_run : Run
{
  Edge_map is_line;
  Fuzz_visitor visitor;

  Fuzz_run(const Fuzz_input& in, const Mesh& reference)
    : Run(in.mesh, reference, in.vertices),
      is_line(edge_map(mesh, in.edges))
  {}
};

std::vector<Mesh::Face_index> face_range(const Fuzz_input& in, const Mesh& mesh)
{
  std::vector<Mesh::Face_index> range;
  for(const Mesh::Face_index f : mesh.faces())
    if(in.faces(std::size_t(f)))
      range.push_back(f);
  return range;
}

template <typename Energy, typename NamedParameters>
void call(Fuzz_input& in,
          const Edge_map& reference_lines,
          const Energy& energy,
          const NamedParameters& np,
          Fuzz_run& r)
{
  const Mesh& reference = in.has_reference ? in.reference : r.mesh;
  if(in.faces.is_used)
    r.result =
      CGAL::reference_constrained_optimize(face_range(in, r.mesh), r.mesh, reference, energy, np);
  else if(in.reference_edges.is_used && in.has_reference)
    r.result = CGAL::reference_constrained_optimize(
      r.mesh, reference, energy, np, CGAL::parameters::edge_is_constrained_map(reference_lines));
  else
    r.result = CGAL::reference_constrained_optimize(r.mesh, reference, energy, np);
}

template <typename Energy>
void optimize(Fuzz_input& in,
              const Edge_map& reference_lines,
              const Energy& energy,
              unsigned iterations,
              Fuzz_run& r)
{
  const auto own = CGAL::parameters::use_on_surface_steps(in.on_surface)
                     .use_finishing_stage(in.finishing)
                     .developability_threshold(in.developability_threshold)
                     .energy_tolerance(in.energy_tolerance)
                     .drift_bound(in.drift_bound)
                     .maximum_patch_size(in.patch_size);
  const auto call_with = [&](const auto& np) {
    call(in, reference_lines, energy,
         np.random_seed(in.seed)
           .number_of_iterations(iterations)
           .vertex_is_constrained_map(r.is_constrained)
           .edge_is_constrained_map(r.is_line)
           .relax_constraints(in.relax_constraints)
           .visitor(std::ref(r.visitor)),
         r);
  };
  // there are no locations on quads
  if(CGAL::is_triangle_mesh(in.reference))
    call_with(own.vertex_location_map(r.locations.map()));
  else
    call_with(own);
}

void optimize(Fuzz_input& in, const Edge_map& reference_lines, unsigned iterations, Fuzz_run& r)
{
  switch(in.energy)
  {
  case Fuzz_energy::minimum_angle:
    return optimize(in, reference_lines, RCO::Minimum_angle_energy(), iterations, r);
  case Fuzz_energy::compatible_remeshing:
    return optimize(in, reference_lines, RCO::Compatible_remeshing_energy(in.source), iterations,
                    r);
  case Fuzz_energy::quad_regularity:
    return optimize(in, reference_lines, RCO::Quad_regularity_energy(), iterations, r);
  case Fuzz_energy::quad_angle:
    return optimize(in, reference_lines, RCO::Quad_angle_energy(), iterations, r);
  }
}

std::vector<Vertex_freedom> freedom(const Fuzz_input& in, const Fuzz_run& r)
{
  std::vector<Vertex_freedom> freedom(in.mesh.number_of_vertices(), Vertex_freedom::on_reference);
  const Vertex_freedom on_line =
    in.relax_constraints ? Vertex_freedom::on_line : Vertex_freedom::fixed;
  for(const Mesh::Edge_index e : in.mesh.edges())
    if(r.is_line[e] || in.mesh.is_border(e))
      freedom[in.mesh.vertex(e, 0)] = freedom[in.mesh.vertex(e, 1)] = on_line;
  for(const Mesh::Vertex_index v : in.mesh.vertices())
    if(r.is_constrained[v] || in.mesh.is_isolated(v))
      freedom[v] = Vertex_freedom::fixed;
  for(const Mesh::Face_index f : in.mesh.faces())
    if(in.faces.is_used && !in.faces(std::size_t(f)))
      for(const Mesh::Vertex_index v : in.mesh.vertices_around_face(in.mesh.halfedge(f)))
        freedom[v] = Vertex_freedom::fixed;
  return freedom;
}

bool is_verbose() { return std::getenv("RCO_FUZZ_VERBOSE") != nullptr; }

void print(const Fuzz_input& in)
{
  if(!is_verbose())
    return;
  std::cerr.precision(17);
  std::cerr << "energy " << int(in.energy) << ", on surface " << in.on_surface << ", finishing "
            << in.finishing << ", relaxed " << in.relax_constraints << ", iterations "
            << in.iterations << ", seed " << in.seed << ", patch size " << in.patch_size
            << ", developability " << in.developability_threshold << ", tolerance "
            << in.energy_tolerance << ", drift bound " << in.drift_bound << ", stop after "
            << in.stop_after;
  const auto list = [&](const std::string& name, const Fuzz_pattern& pattern, std::size_t n) {
    if(!pattern.is_used)
      return;
    std::cerr << "\n" << name << ":";
    for(std::size_t i = 0; i < n; ++i)
      if(pattern(i))
        std::cerr << " " << i;
  };
  list("constrained vertices", in.vertices, in.mesh.number_of_vertices());
  list("constrained edges", in.edges, in.mesh.number_of_edges());
  list("edges of the reference", in.reference_edges, in.reference.number_of_edges());
  list("range of faces", in.faces, in.mesh.number_of_faces());
  std::cerr << "\n";
  const auto print_mesh = [](const std::string& name, const Mesh& mesh) {
    std::cerr << name << " ";
    CGAL::IO::write_OFF(std::cerr, mesh, CGAL::parameters::stream_precision(17));
  };
  print_mesh("mesh", in.mesh);
  if(in.has_reference)
    print_mesh("reference", in.reference);
  if(in.energy == Fuzz_energy::compatible_remeshing)
    print_mesh("source", in.source);
}

void print(const std::string& text)
{
  if(is_verbose())
    std::cerr << text << std::endl;
}

// the guarantees that the package violates, in words
std::string violated_guarantees(Fuzz_input& in)
{
  const Edge_map reference_lines = edge_map(in.reference, in.reference_edges);
  Fuzz_run run(in, in.reference);
  run.visitor.stop_after = in.stop_after;
  try
  {
    optimize(in, reference_lines, in.iterations, run);
  }
  catch(const RCO::Invalid_input& e)
  {
    print(std::string("refused: ") + e.what());
    return same_bits(run.mesh, in.mesh) ? "" : "mesh touched in spite of: " + std::string(e.what());
  }
  const RCO::Result& r = run.result;
  print("status " + std::to_string(int(r.status)) + ", free vertices " +
        std::to_string(r.number_of_free_vertices) + ", iterations " +
        std::to_string(r.number_of_iterations) + ", patches " +
        std::to_string(r.number_of_accepted_patches) + " of " +
        std::to_string(r.number_of_patches) + ", energy " + std::to_string(r.initial_energy) +
        " -> " + std::to_string(r.final_energy) + ", defects " +
        std::to_string(number_of_initial_defects(r)) + " -> " +
        std::to_string(number_of_defects(r)));
  const bool is_stopped = r.status == RCO::Status::interrupted;
  if(is_stopped && in.stop_after == 0)
    return "it stopped by itself";
  if(is_stopped && same_bits(run.mesh, in.mesh))
    return ""; // perhaps in setup: then there are no energies

  Fuzz_run placed(in, in.reference);
  optimize(in, reference_lines, 0, placed);
  const auto is_optimized = [&](Mesh::Face_index f) {
    return !in.faces.is_used || in.faces(std::size_t(f));
  };
  std::string text = violated_guarantees(in.mesh, placed, run, in.reference, freedom(in, run),
                                         is_optimized, run.visitor.violations)
                       .text();
  if(text.empty() && in.twice)
  {
    Fuzz_run again(in, in.reference);
    again.visitor.stop_after = in.stop_after;
    optimize(in, reference_lines, in.iterations, again);
    if(!same_bits(run.mesh, again.mesh))
      text = "another run gives another mesh";
  }
  return text;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Fuzz_input input = Fuzz_decoder(data, size).decode();
  print(input);
  std::string text;
  try
  {
    text = violated_guarantees(input);
  }
  catch(const std::exception& e)
  {
    text = std::string("exception: ") + e.what();
  }
  if(!text.empty())
  {
    std::cerr << "fuzz_optimize: " << text << std::endl;
    std::abort();
  }
  return 0;
}
