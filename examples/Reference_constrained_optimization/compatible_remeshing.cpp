// Compatible remeshing: lays the mesh of one shape, the source, over another shape, the reference,
// so that the map between the two distorts little.
//
//   compatible_remeshing source reference start [output prefix]
//   compatible_remeshing [mesh]
//
// The start is a mesh with the source's connectivity on the reference, or a file of landmarks
// (.txt): lines of two numbers, a vertex of the source and its counterpart on the reference. With
// one mesh or none, the reference is a deformed copy of it with another triangulation.
//
// Writes the result, and the source, the start and the result with the same checker on all three.

#include "checker.h"
#include "deformed_pair.h"

#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Real_timer.h>
#include <CGAL/Reference_constrained_optimization/Compatible_remeshing_energy.h>
#include <CGAL/Reference_constrained_optimization/compatible_initial_mesh.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/reference_constrained_optimize.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace RCO = CGAL::Reference_constrained_optimization;

Mesh read_mesh(const std::string& file)
{
  Mesh mesh;
  if(!CGAL::IO::read_polygon_mesh(file, mesh) || !CGAL::is_triangle_mesh(mesh))
    throw std::runtime_error(file + " cannot be read as a triangle mesh");
  return mesh;
}

Landmarks read_landmarks(const std::string& file, const Mesh& source, const Mesh& reference)
{
  std::ifstream in(file);
  if(!in)
    throw std::runtime_error(file + " cannot be read");
  Landmarks landmarks;
  std::string line, rest;
  for(int number = 1; std::getline(in, line); ++number)
  {
    Mesh::size_type v, w;
    std::istringstream words(line);
    if(!(words >> v >> w) || words >> rest || v >= source.number_of_vertices() ||
       w >= reference.number_of_vertices())
      throw std::runtime_error(file + ", line " + std::to_string(number) +
                               ": a vertex of the source and one of the reference are expected");
    landmarks.emplace_back(Mesh::Vertex_index(v), Mesh::Vertex_index(w));
  }
  return landmarks;
}

Mesh make_initial_mesh(const Mesh& source, const Mesh& reference, const Landmarks& landmarks)
{
  CGAL::Real_timer timer;
  timer.start();
  Mesh mesh;
  const RCO::Initial_mesh_report report =
    RCO::compatible_initial_mesh(source, reference, landmarks, mesh);
  std::cout << landmarks.size() << " landmarks; " << report.number_of_bijective_maps << " of "
            << report.number_of_trees << " trees gave a bijective map; " << timer.time()
            << " seconds" << std::endl;
  return mesh;
}

template <typename T>
void print(const char* what, T before, T after)
{
  std::cout << std::left << std::setw(44) << what << std::right << std::setw(14) << before
            << std::setw(14) << after << '\n';
}

void print_table(const Mesh& source, const Mesh& reference, const Mesh& before, const Mesh& after)
{
  const auto none = CGAL::parameters::default_values();
  const double area = CGAL::to_double(CGAL::Polygon_mesh_processing::area(reference));
  const auto distortion = [&](const Mesh& mesh) {
    return RCO::distortion_statistics(source, mesh, none, none, area);
  };
  const RCO::Distortion_statistics a = distortion(before), b = distortion(after);
  const RCO::Orientation_defects c = RCO::orientation_defects(before, reference),
                                 d = RCO::orientation_defects(after, reference);
  const RCO::Drift e = RCO::drift(before, reference), f = RCO::drift(after, reference);
  std::cout << std::fixed << std::setprecision(2);
  print("", "before", "after");
  print("distortion (2: isometric), mean", a.mean, b.mean);
  print("  median", a.median, b.median);
  print("  99 %", a.percentile_99, b.percentile_99);
  print("  maximum", a.maximum, b.maximum);
  print("flipped faces", c.number_of_flips, d.number_of_flips);
  print("folded edges", c.number_of_fold_edges, d.number_of_fold_edges);
  print("drift, mesh to reference (mean edges)", e.relative_mesh_to_reference(),
        f.relative_mesh_to_reference());
  // how far the ends of the reference stick out of the mesh
  print("coverage, reference to mesh (mean edges)", e.relative_reference_to_mesh(),
        f.relative_reference_to_mesh());
  std::cout << std::scientific << std::setprecision(1);
  print("furthest vertex from the reference (length)",
        RCO::distance_to_reference(before, reference).maximum,
        RCO::distance_to_reference(after, reference).maximum);
}

int main(int argc, char* argv[])
{
  if(argc == 3 || argc > 5)
  {
    std::cerr << "Usage: compatible_remeshing source reference start [output prefix]\n"
              << "       compatible_remeshing [mesh]" << std::endl;
    return EXIT_FAILURE;
  }
  std::cout << std::setprecision(3);
  try
  {
    const Mesh source = read_mesh(argc > 1 ? argv[1] : CGAL::data_file_path("meshes/bear_bis.off"));
    Mesh reference, initial;
    if(argc < 3)
    {
      const Landmarks landmarks = make_deformed_pair(source, reference);
      initial = make_initial_mesh(source, reference, landmarks);
    }
    else
    {
      const std::string start = argv[3];
      reference = read_mesh(argv[2]);
      if(std::filesystem::path(start).extension() == ".txt")
        initial = make_initial_mesh(source, reference, read_landmarks(start, source, reference));
      else
        initial = read_mesh(start);
    }
    std::cout << "source: " << source.number_of_vertices()
              << " vertices; reference: " << reference.number_of_vertices() << " vertices"
              << std::endl;

    Mesh mesh = initial;
    const RCO::Result result = CGAL::reference_constrained_optimize(
      mesh, reference, RCO::Compatible_remeshing_energy(source));
    print_table(source, reference, initial, mesh);
    const std::size_t iterations = result.number_of_iterations;
    std::cout << std::defaultfloat << std::setprecision(3) << iterations << " iterations of "
              << (iterations > 0 ? double(result.number_of_patches) / double(iterations) : 0)
              << " patches, " << result.running_time << " seconds\n";

    const std::string prefix = argc > 4 ? argv[4] : "compatible";
    if(!CGAL::IO::write_OFF(prefix + "_result.off", mesh, CGAL::parameters::stream_precision(17)))
      throw std::runtime_error(prefix + "_result.off cannot be written");
    const Checker checker(source, prefix);
    checker.write_image();
    checker.write_mesh(source, "source");
    checker.write_mesh(initial, "start");
    checker.write_mesh(mesh, "result");
    std::cout << "written: " << prefix << "_result.off, and " << prefix
              << "_{source,start,result}.{ply,obj,mtl} to look at" << std::endl;
  }
  catch(const std::exception& e)
  {
    std::cerr << "Error: " << e.what() << std::endl;
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
