// What a program of somebody else looks like: it improves a square whose vertices were shaken.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/generators.h>
#include <CGAL/reference_constrained_optimize.h>

#include <cmath>
#include <iostream>

typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

int main()
{
  Mesh mesh;
  CGAL::make_grid(8, 8, mesh, true);
  for(const Mesh::Vertex_index v : mesh.vertices())
    if(!mesh.is_border(v))
      mesh.point(v) =
        mesh.point(v) + 0.3 * Kernel::Vector_3(std::sin(7. * v.idx()), std::cos(5. * v.idx()), 0);
  namespace RCO = CGAL::Reference_constrained_optimization;
  const RCO::Result result =
    CGAL::reference_constrained_optimize(mesh, mesh, RCO::Minimum_angle_energy());
  std::cout << result.initial_energy << " -> " << result.final_energy << std::endl;
  return result.final_energy < result.initial_energy ? 0 : 1;
}
