// Makes the quads of a mesh regular: edges of one length, or at least right angles.
// A triangle mesh is first made into a quad mesh, and is its reference.

#include "command_line.h"
#include "quad_mesh_generation.h"

#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/reference_constrained_optimize.h>

#include <cstddef>
#include <cstdlib>
#include <exception>
#include <iomanip>
#include <iostream>
#include <stdexcept>
#include <string>

const char* const usage =
  R"(Usage: quad_mesh_optimization [mesh [result.obj]] [options]

  --reference FILE     the surface to stay on (default: the mesh's own initial shape)
  --energy NAME        "regularity" (default) or "angle"
  --leg-length L       of the regularity energy's rest triangles, in mean edges (default 5)
  --relax-borders      lets vertices at the border slide along it
)";

template <typename T>
void print(const char* what, T before, T after)
{
  std::cout << std::left << std::setw(44) << what << std::right << std::setw(14) << before
            << std::setw(14) << after << '\n';
}

void print_table(const Mesh& before, const Mesh& after, const Mesh& reference, bool relax_borders)
{
  const RCO::Edge_statistics a = RCO::edge_statistics(before), b = RCO::edge_statistics(after);
  const RCO::Corner_angle_statistics c = RCO::corner_angle_statistics(before),
                                     d = RCO::corner_angle_statistics(after);
  const RCO::Planarity e = RCO::planarity(before), f = RCO::planarity(after);
  const RCO::Orientation_defects g = RCO::orientation_defects(before, reference),
                                 h = RCO::orientation_defects(after, reference);
  const RCO::Drift i = RCO::drift(before, reference), j = RCO::drift(after, reference);
  std::cout << std::fixed << std::setprecision(2);
  print("", "before", "after");
  print("edge length over mean, minimum", a.minimum, b.minimum);
  print("  maximum", a.maximum, b.maximum);
  print("  standard deviation", a.standard_deviation, b.standard_deviation);
  print("corner angle (degrees), minimum", c.minimum, d.minimum);
  print("  maximum", c.maximum, d.maximum);
  print("  mean", c.mean, d.mean);
  print("  standard deviation", c.standard_deviation, d.standard_deviation);
  std::cout << std::setprecision(4);
  print("planarity (0: planar), maximum", e.maximum, f.maximum);
  print("  mean", e.mean, f.mean);
  print("non-convex quads", RCO::number_of_nonconvex_quads(before, reference),
        RCO::number_of_nonconvex_quads(after, reference));
  print("flipped faces", g.number_of_flips, h.number_of_flips);
  print("folded edges", g.number_of_fold_edges, h.number_of_fold_edges);
  std::cout << std::setprecision(2);
  print("drift, mesh to reference (its mean edges)", i.relative_mesh_to_reference(),
        j.relative_mesh_to_reference());
  print("  reference to mesh", i.relative_reference_to_mesh(), j.relative_reference_to_mesh());
  const auto distance = [&](const Mesh& mesh) {
    const auto none = CGAL::parameters::default_values();
    const auto is_free = [&](Mesh::Vertex_index v) { return relax_borders || !mesh.is_border(v); };
    return RCO::distance_to_reference(mesh, reference, none, none, is_free).maximum;
  };
  std::cout << std::scientific << std::setprecision(1);
  print("furthest free vertex (length)", distance(before), distance(after));
}

RCO::Result optimize(Mesh& mesh, const Mesh& reference, const Command_line& arguments)
{
  const auto np = CGAL::parameters::relax_constraints(arguments.has("--relax-borders"));
  const std::string energy = arguments.text("--energy", "regularity");
  if(energy == "regularity")
    return CGAL::reference_constrained_optimize(
      mesh, reference, RCO::Quad_regularity_energy(arguments.number("--leg-length", 5.)), np);
  if(energy != "angle")
    throw std::runtime_error("--energy wants regularity or angle, not " + energy);
  if(arguments.has("--leg-length"))
    throw std::runtime_error("--leg-length has no meaning for the angle energy");
  return CGAL::reference_constrained_optimize(mesh, reference, RCO::Quad_angle_energy(), np);
}

int main(int argc, char* argv[])
{
  try
  {
    const Command_line arguments(argc, argv, usage, 2,
                                 {{"--reference", true},
                                  {"--energy", true},
                                  {"--leg-length", true},
                                  {"--relax-borders", false}});
    Mesh mesh = read_mesh(arguments.name(0, CGAL::data_file_path("meshes/elephant.off")));
    const Mesh reference =
      arguments.has("--reference") ? read_mesh(arguments.text("--reference", "")) : mesh;
    if(CGAL::is_triangle_mesh(mesh))
      mesh = make_quad_mesh(mesh);
    std::cout << "mesh: " << mesh.number_of_vertices() << " vertices, " << mesh.number_of_faces()
              << " faces; reference: " << reference.number_of_vertices() << " vertices"
              << std::endl;

    const Mesh initial = mesh;
    const RCO::Result result = optimize(mesh, reference, arguments);
    print_table(initial, mesh, reference, arguments.has("--relax-borders"));
    const std::size_t iterations = result.number_of_iterations;
    std::cout << std::defaultfloat << std::setprecision(3) << iterations << " iterations of "
              << (iterations > 0 ? double(result.number_of_patches) / double(iterations) : 0)
              << " patches, " << result.running_time << " seconds\n";

    const std::string output = arguments.name(1, "");
    if(!output.empty())
      write_mesh(output, mesh);
  }
  catch(const std::exception& e)
  {
    std::cerr << "Error: " << e.what() << std::endl;
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
