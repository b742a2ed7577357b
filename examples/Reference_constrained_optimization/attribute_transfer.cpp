// Carries the colours of a mesh's vertices over to the optimized mesh. Its vertices have gone elsewhere
// on the surface, but the optimization tells where: in which face of the reference, and at which
// barycentric coordinates.
//
//   attribute_transfer [mesh [result.ply]]

#include "face_tree.h"
#include "input_mesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/Color.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/locate.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/IO/PLY.h>
#include <CGAL/reference_constrained_optimize.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>

namespace RCO = CGAL::Reference_constrained_optimization;
namespace PMP = CGAL::Polygon_mesh_processing;
typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef Kernel::Point_3 Point;
typedef CGAL::Surface_mesh<Point> Mesh;
typedef Mesh::Vertex_index Vertex;
typedef std::pair<Mesh::Face_index, std::array<double, 3>> Location;
typedef std::array<double, 3> Rgb; // in [0, 1]
typedef Mesh::Property_map<Vertex, Rgb> Rgb_map;

// a pattern of a few waves over the length of the mesh
struct Pattern
{
  CGAL::Bbox_3 box;
  Rgb operator()(const Point& p) const
  {
    const double length =
      (std::max)({box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin()});
    const auto wave = [&](double x) { return 0.5 + 0.5 * std::sin(12 * x / length); };
    return {{wave(p.x()), wave(p.y()), wave(p.z())}};
  }
};

// the attribute at a place of the reference: linear in each of its faces
Rgb interpolate(const Location& location, const Mesh& reference, const Rgb_map& colors)
{
  Rgb result{{0, 0, 0}};
  Mesh::Halfedge_index h = reference.halfedge(location.first);
  Vertex v = reference.source(h); // where the coordinates begin
  for(const double weight : location.second)
  {
    for(int i = 0; i < 3; ++i)
      result[i] += weight * colors[v][i];
    v = reference.target(h);
    h = reference.next(h);
  }
  return result;
}

double difference(const Rgb& a, const Rgb& b)
{
  double largest = 0;
  for(int i = 0; i < 3; ++i)
    largest = (std::max)(largest, std::abs(a[i] - b[i]));
  return largest;
}

int main(int argc, char* argv[])
try
{
  Mesh mesh;
  read_or_make(argc > 1 ? argv[1] : "", mesh);
  const auto added = mesh.add_property_map<Vertex, CGAL::IO::Color>("v:color");
  const bool has_colors = !added.second; // there were some in the file
  auto written = added.first;

  // the reference has colours; the mesh gets them from it
  Mesh reference = mesh;
  const Pattern pattern{PMP::bbox(reference)};
  Rgb_map colors = reference.add_property_map<Vertex, Rgb>("v:rgb").first;
  for(const Vertex v : reference.vertices())
  {
    const CGAL::IO::Color c = written[v];
    colors[v] = has_colors ? Rgb{{c.red() / 255., c.green() / 255., c.blue() / 255.}}
                           : pattern(reference.point(v));
  }

  auto location = mesh.add_property_map<Vertex, Location>("v:location").first;
  const RCO::Result result = CGAL::reference_constrained_optimize(
    mesh, reference, RCO::Minimum_angle_energy(), CGAL::parameters::vertex_location_map(location));

  double from_searched = 0, from_pattern = 0, moved = 0;
  Face_tree<Kernel, Mesh> tree;
  PMP::build_AABB_tree(reference, tree);
  for(const Vertex v : mesh.vertices())
  {
    if(mesh.is_isolated(v))
      continue; // it is nowhere on the surface
    const Rgb color = interpolate(location[v], reference, colors);
    const auto byte = [&](int i) {
      return static_cast<unsigned char>(
        std::lround(255 * (std::min)(1., (std::max)(0., color[i]))));
    };
    written[v] = CGAL::IO::Color(byte(0), byte(1), byte(2));
    // what the same place has when it is searched for, and when the pattern is evaluated there
    const auto searched = PMP::locate_with_AABB_tree(mesh.point(v), tree, reference);
    from_searched = (std::max)(
      from_searched,
      difference(color,
                 interpolate(
                   {searched.first, {{searched.second[0], searched.second[1], searched.second[2]}}},
                   reference, colors)));
    from_pattern = (std::max)(from_pattern, difference(color, pattern(mesh.point(v))));
    moved += mesh.point(v) != reference.point(v);
  }
  std::cout << moved << " vertices moved in " << result.running_time << " s\n"
            << "colours (0 to 1) differ at most by " << from_searched
            << " from those at the closest point of the reference";
  if(!has_colors)
    std::cout << ", and by " << from_pattern
              << " from the pattern itself, which the reference has at its vertices only";
  std::cout << std::endl;
  if(from_searched > 1e-6)
    throw std::runtime_error("the colours are not where they belong");

  const std::string name = argc > 2 ? argv[2] : "attribute_transfer.ply";
  if(!CGAL::IO::write_PLY(name, mesh,
                          CGAL::parameters::vertex_color_map(written).use_binary_mode(false)))
    throw std::runtime_error("cannot write " + name);
  std::cout << "result: " << name << std::endl;
  return EXIT_SUCCESS;
}
catch(const std::exception& e)
{
  std::cerr << "Error: " << e.what() << std::endl;
  return EXIT_FAILURE;
}
