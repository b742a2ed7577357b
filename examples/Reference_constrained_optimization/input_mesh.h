// The mesh of an example: from a file, CGAL's elephant, or made here if that is not to be found.

#ifndef RCO_EXAMPLE_INPUT_MESH_H
#define RCO_EXAMPLE_INPUT_MESH_H

#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/boost/graph/generators.h>
#include <CGAL/subdivision_method_3.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

// a ball with bumps whose triangles are sheared
template <typename Mesh>
void make_bumpy_ball(Mesh& mesh)
{
  typedef typename Mesh::Point Point;
  CGAL::make_icosahedron(mesh, Point(0, 0, 0), 1.);
  CGAL::Subdivision_method_3::Loop_subdivision(mesh, CGAL::parameters::number_of_iterations(4));
  for(const auto v : mesh.vertices())
  {
    const Point& p = mesh.point(v);
    const double r = std::sqrt(CGAL::square(p.x()) + CGAL::square(p.y()) + CGAL::square(p.z()));
    const double x = p.x() / r, y = p.y() / r, z = p.z() / r;
    const double bump = 1 + 0.1 * std::sin(5 * x) * std::cos(4 * y);
    const double twist = 0.6 * std::sin(4 * z), c = std::cos(twist), s = std::sin(twist);
    mesh.point(v) = Point(bump * (c * x - s * y), bump * (s * x + c * y), bump * z);
  }
}

// reads the named file if there is a name
template <typename Mesh>
void read_or_make(const std::string& name, Mesh& mesh)
{
  const std::string file = name.empty() ? CGAL::data_file_path("meshes/elephant.off") : name;
  if(name.empty() && !std::ifstream(file))
  {
    make_bumpy_ball(mesh);
    std::cout << "a ball with bumps";
  }
  else if(CGAL::IO::read_polygon_mesh(file, mesh))
    std::cout << file;
  else
    throw std::runtime_error("cannot read a polygon mesh from " + file);
  std::cout << ": " << mesh.number_of_vertices() << " vertices, " << mesh.number_of_faces()
            << " faces" << std::endl;
}

#endif // RCO_EXAMPLE_INPUT_MESH_H
