// Raises the minimum angle of a triangle mesh whose shape stays what it is: the mesh's own initial
// shape is the reference.
//
//   minimum_angle_improvement [mesh [result.off]]

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/reference_constrained_optimize.h>

#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>

namespace RCO = CGAL::Reference_constrained_optimization;
typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

template <typename T>
void print(const char* what, T before, T after)
{
  std::cout << std::left << std::setw(34) << what << std::right << std::setw(10) << before
            << std::setw(10) << after << '\n';
}

void print_table(const Mesh& before, const Mesh& after)
{
  const RCO::Angle_statistics a = RCO::angle_statistics(before), b = RCO::angle_statistics(after);
  const RCO::Orientation_defects c = RCO::orientation_defects(before, before),
                                 d = RCO::orientation_defects(after, before);
  const RCO::Drift drift = RCO::drift(after, before);
  print("", "before", "after");
  print("minimum angle, smallest (degrees)", a.minimum, b.minimum);
  print("  mean over faces", a.mean, b.mean);
  print("  standard deviation", a.standard_deviation, b.standard_deviation);
  print("  faces below 20", a.number_below_20, b.number_below_20);
  print("  faces below 30", a.number_below_30, b.number_below_30);
  print("flipped faces", c.number_of_flips, d.number_of_flips);
  print("folded edges", c.number_of_fold_edges, d.number_of_fold_edges);
  print("drift (mean edge lengths)", 0., drift.relative_maximum());
}

int main(int argc, char* argv[])
{
  const std::string file = argc > 1 ? argv[1] : CGAL::data_file_path("meshes/elephant.off");
  Mesh mesh;
  if(!CGAL::IO::read_polygon_mesh(file, mesh))
  {
    std::cerr << "Error: cannot read a polygon mesh from " << file << std::endl;
    return EXIT_FAILURE;
  }
  std::cout << file << ": " << mesh.number_of_vertices() << " vertices, " << mesh.number_of_faces()
            << " faces\n"
            << std::fixed << std::setprecision(2);
  const Mesh reference = mesh;
  try
  {
    const RCO::Result result =
      CGAL::reference_constrained_optimize(mesh, reference, RCO::Minimum_angle_energy());
    print_table(reference, mesh);
    std::cout << result.number_of_iterations << " iterations, " << result.number_of_patches
              << " patches, " << result.running_time << " seconds\n";
  }
  catch(const RCO::Invalid_input& e)
  {
    std::cerr << "Error: " << file << ": " << e.what() << std::endl;
    return EXIT_FAILURE;
  }
  if(argc > 2)
  {
    std::ofstream out(argv[2]);
    out.precision(17);
    if(!out || !CGAL::IO::write_OFF(out, mesh))
    {
      std::cerr << "Error: cannot write " << argv[2] << std::endl;
      return EXIT_FAILURE;
    }
    std::cout << "result: " << argv[2] << std::endl;
  }
  return EXIT_SUCCESS;
}
