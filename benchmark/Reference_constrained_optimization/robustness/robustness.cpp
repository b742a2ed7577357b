// Runs the package on one input, in another unit or place or with noise, and tells how the run ended.
// --help tells the rest.

#include "../driver.h"
#include "Soup.h"
#include "checked_run.h"
#include "outcome.h"
#include "stress_inputs.h"
#include "variants.h"

#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>

#include <algorithm>
#include <functional>
#include <iterator>

namespace PMP = CGAL::Polygon_mesh_processing;

const std::string usage =
  R"(usage: robustness input [options]

Optimizes a mesh (OFF, OBJ, PLY, STL), or one that is generated with something wrong, and prints a line of
JSON: how the run ended, whether that is expected, and the smallest angles of the faces. What the package
guarantees is verified. robustness.py does so for many.

  --generated            the input is the name of one that is generated
  --names                prints the names of those that are, with | between them
  --survey               tells of a file what is in it: faces, has_polygons, and is_repaired, whether
                         it has to be oriented, and split where it is not manifold, to be read at all
  --triangulate          split the polygons of a file first
  --scale S              multiply all coordinates
  --shift D              move mesh and reference by D diagonals
  --noise N              move the vertices by up to N mean edges against the mesh without noise
  --seed N               random seed of the package
  --flattened            without on-surface steps and finishing stage
  --relax-constraints    vertices slide along borders

Exit code: 0, 2 if an option could not be used.
)";

struct Input
{
  Mesh mesh, reference;
  bool has_reference = false; // otherwise the mesh is its own
  std::function<bool(std::size_t)> is_constrained;
  Expectation expected;
};

// Files that hold no half-edge mesh as they stand get their faces oriented and vertices and edges that
// are not manifold split, as CGAL's reader of polygon soups does.
bool read_or_repair(const std::string& path, Mesh& mesh, bool& is_repaired)
{
  is_repaired = !CGAL::IO::read_polygon_mesh(path, mesh);
  if(!is_repaired)
    return true;
  mesh.clear();
  return PMP::IO::read_polygon_mesh(path, mesh);
}

void survey(const std::string& path, Row& row)
{
  Mesh mesh;
  bool is_repaired = false;
  const bool is_readable = read_or_repair(path, mesh, is_repaired);
  row.add("faces", double(mesh.number_of_faces()));
  row.add("is_repaired", is_readable && is_repaired);
  row.add("has_polygons", is_readable && !CGAL::is_triangle_mesh(mesh));
}

// by other means than the package's own
Expectation expected_of_file(const Mesh& mesh)
{
  if(mesh.number_of_faces() == 0)
    return is_refused("mesh: the mesh has no face");
  for(const Mesh::Face_index f : mesh.faces())
    if(mesh.degree(f) > 4)
      return is_refused("mesh: face " + std::to_string(f) + " has ");
  std::vector<Mesh::Halfedge_index> nonmanifold;
  PMP::non_manifold_vertices(mesh, std::back_inserter(nonmanifold));
  if(!nonmanifold.empty())
    return is_refused("mesh: vertex ");
  if(!CGAL::is_triangle_mesh(mesh))
    return is_refused("Minimum_angle_energy: face ");
  if(!(PMP::area(mesh) > 0))
    return is_refused("reference: every face has zero area");
  return is_optimized();
}

// what is expected is known even if the rest throws
void read_file(const std::string& path, bool is_triangulated, Input& in)
{
  bool is_repaired = false;
  in.expected = is(Outcome::no_mesh);
  if(!read_or_repair(path, in.mesh, is_repaired))
    throw std::runtime_error("cannot be read as a mesh");
  if(is_triangulated && !PMP::triangulate_faces(in.mesh))
    throw std::runtime_error("cannot be triangulated");
  in.reference = in.mesh;
  in.expected = expected_of_file(in.mesh);
}

void generate(const Stress_input& stress_input, bool has_noise, Input& in)
{
  in.expected = has_noise ? stress_input.expected_with_noise : stress_input.expected;
  in.is_constrained = stress_input.is_constrained;
  in.has_reference = stress_input.has_reference;
  in.mesh = to_mesh(stress_input.mesh);
  in.reference = stress_input.has_reference ? to_mesh(stress_input.reference) : in.mesh;
}

void tell(const Input& in, Outcome outcome, std::string text, Row& row)
{
  const bool is_expected = in.expected.is_met(outcome, text);
  if(!is_expected)
    text += (text.empty() ? "expected: " : "; expected: ") + in.expected.text();
  row.add("outcome", name(outcome));
  row.add("is_expected", is_expected);
  row.add("text", text);
}

bool run(const Command_line& arguments, Row& row)
{
  const std::string name = arguments.name(0, "");
  const std::vector<Stress_input> all = stress_inputs();
  if(arguments.has("--names"))
  {
    std::string names;
    for(const Stress_input& stress_input : all)
      names += (names.empty() ? "" : "|") + stress_input.name;
    row.add("names", names);
    return true;
  }
  if(arguments.has("--survey"))
  {
    survey(name, row);
    return true;
  }
  const Variant variant = {arguments.number("--scale", 1.), arguments.number("--shift", 0.),
                           arguments.number("--noise", 0.)};
  const Run_settings settings = {!arguments.has("--flattened"), !arguments.has("--flattened"),
                                 arguments.has("--relax-constraints"),
                                 arguments.number("--seed", 0u)};
  Input in;
  try
  {
    if(arguments.has("--generated"))
    {
      const auto stress_input =
        std::find_if(all.begin(), all.end(), [&](const Stress_input& n) { return n.name == name; });
      if(stress_input == all.end())
        throw std::invalid_argument("there is no generated input of this name");
      generate(*stress_input, variant.noise > 0, in);
    }
    else
      read_file(name, arguments.has("--triangulate"), in);
  }
  catch(const std::exception& e)
  {
    tell(in, Outcome::no_mesh, e.what(), row);
    return true;
  }
  if(settings.relax_constraints &&
     in.expected.outcomes == std::vector<Outcome>{Outcome::nothing_to_do})
    in.expected = is_optimized(); // borders may have something to do
  const double size = diagonal(in.reference);
  const bool has_reference = in.has_reference || variant.noise > 0;
  apply(variant, size, in.mesh, !has_reference);
  apply(variant, size, in.reference, true);
  Run_figures figures;
  std::string text;
  const Outcome outcome = checked_run(in.mesh, has_reference ? &in.reference : nullptr,
                                      in.is_constrained, settings, figures, text);
  row.add("faces", double(figures.number_of_faces));
  row.add("theta_min_in", figures.angle_minimum_in);
  row.add("theta_mean_in", figures.angle_mean_in);
  row.add("theta_min_out", figures.angle_minimum_out);
  row.add("theta_mean_out", figures.angle_mean_out);
  row.add("time_s", figures.seconds);
  tell(in, outcome, text, row);
  return true;
}

int main(int argc, char* argv[])
{
  return drive(argc, argv, usage,
               {{"--generated", false},
                {"--names", false},
                {"--survey", false},
                {"--triangulate", false},
                {"--scale", true},
                {"--shift", true},
                {"--noise", true},
                {"--seed", true},
                {"--flattened", false},
                {"--relax-constraints", false}},
               run);
}
