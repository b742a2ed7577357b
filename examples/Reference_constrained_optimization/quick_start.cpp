#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>
#include <CGAL/reference_constrained_optimize.h>
#include <iostream>

namespace RCO = CGAL::Reference_constrained_optimization;

int main(int argc, char* argv[])
{
  CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3> mesh;
  if(argc < 3 || !CGAL::IO::read_polygon_mesh(argv[1], mesh))
    return 1;
  // mesh and reference are one object: its shape on entry is the reference
  RCO::Result r = CGAL::reference_constrained_optimize(mesh, mesh, RCO::Minimum_angle_energy());
  std::cout << r.initial_energy << " -> " << r.final_energy << std::endl;
  CGAL::IO::write_polygon_mesh(argv[2], mesh, CGAL::parameters::stream_precision(17));
}
