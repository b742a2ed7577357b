// Makes a quad mesh out of a triangle mesh, for quad_mesh_optimization to improve.

#include "command_line.h"
#include "quad_mesh_generation.h"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

const char* const usage =
  R"(Usage: make_quad_mesh [triangles.off [quads.obj]] [--jitter J] [--seed S]

  --jitter J   shakes the vertices by up to J mean edges (0 to 1, default 0)
  --seed S     another whole number shakes them otherwise (default 0)
)";

int main(int argc, char* argv[])
{
  try
  {
    const Command_line arguments(argc, argv, usage, 2, {{"--jitter", true}, {"--seed", true}});
    const std::string input = arguments.name(0, CGAL::data_file_path("meshes/elephant.off"));
    const std::string output = arguments.name(1, "quads.obj");
    const double jitter = arguments.number("--jitter", 0.);
    if(jitter < 0 || jitter > 1)
      throw std::runtime_error("--jitter wants a number from 0 to 1");

    const Mesh triangles = read_mesh(input);
    if(!CGAL::is_triangle_mesh(triangles))
      throw std::runtime_error(input + " is not a triangle mesh");
    const Mesh quads = make_quad_mesh(triangles, jitter, arguments.number("--seed", 0u));
    const RCO::Corner_angle_statistics angles = RCO::corner_angle_statistics(quads);
    std::cout << quads.number_of_vertices() << " vertices, " << quads.number_of_faces()
              << " quads, " << RCO::number_of_nonconvex_quads(quads, triangles)
              << " of them not convex; angles from " << angles.minimum << " to " << angles.maximum
              << " degrees, standard deviation " << angles.standard_deviation << std::endl;
    write_mesh(output, quads);
  }
  catch(const std::exception& e)
  {
    std::cerr << "Error: " << e.what() << std::endl;
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
