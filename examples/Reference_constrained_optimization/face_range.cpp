// Improves a part of a mesh: the faces above its middle. What is below stays, bit for bit.
//
//   face_range [mesh [result.off]]

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/reference_constrained_optimize.h>

#include <cstddef>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace RCO = CGAL::Reference_constrained_optimization;
typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

// those with all their vertices above
std::vector<Mesh::Face_index> faces_above_the_middle(const Mesh& mesh)
{
  const CGAL::Bbox_3 box = CGAL::Polygon_mesh_processing::bbox(mesh);
  const double middle = 0.5 * (box.ymin() + box.ymax());
  std::vector<Mesh::Face_index> faces;
  for(const Mesh::Face_index f : mesh.faces())
  {
    bool is_above = true;
    for(const Mesh::Vertex_index v : vertices_around_face(mesh.halfedge(f), mesh))
      is_above = is_above && mesh.point(v).y() > middle;
    if(is_above)
      faces.push_back(f);
  }
  return faces;
}

int main(int argc, char* argv[])
{
  const std::string file = argc > 1 ? argv[1] : CGAL::data_file_path("meshes/elephant.off");
  try
  {
    Mesh mesh;
    if(!CGAL::IO::read_polygon_mesh(file, mesh))
      throw std::runtime_error("cannot be read as a polygon mesh");
    const Mesh reference = mesh;
    const std::vector<Mesh::Face_index> faces = faces_above_the_middle(mesh);
    const RCO::Minimum_angle_energy energy;
    //! [Named parameters]
    const auto np =
      CGAL::parameters::developability_threshold(0.1).number_of_iterations(5).random_seed(1);
    //! [Named parameters]
    //! [Face range]
    const RCO::Result result =
      CGAL::reference_constrained_optimize(faces, mesh, reference, energy, np);
    //! [Face range]

    std::size_t moved = 0;
    for(const Mesh::Vertex_index v : mesh.vertices())
      moved += mesh.point(v) != reference.point(v);
    std::cout << faces.size() << " of " << mesh.number_of_faces() << " faces, " << moved << " of "
              << mesh.number_of_vertices() << " vertices moved; mean energy "
              << result.initial_energy << " before, " << result.final_energy
              << " after; mean of the smallest angles " << RCO::angle_statistics(reference).mean
              << " before, " << RCO::angle_statistics(mesh).mean << " after" << std::endl;
    if(argc > 2 && !CGAL::IO::write_polygon_mesh(argv[2], mesh))
      throw std::runtime_error(std::string("cannot write ") + argv[2]);
  }
  catch(const std::exception& e)
  {
    std::cerr << "Error: " << file << ": " << e.what() << std::endl;
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
