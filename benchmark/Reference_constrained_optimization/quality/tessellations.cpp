// Makes three tessellations of one shape, to see how much the result of an optimization depends on
// the triangles it starts from: an isotropic one, one like a raw scan, and one with slivers. The
// vertices of all three lie on the input mesh.
//
//   tessellations [mesh [folder]]
//
// writes <name>_isotropic.off, <name>_scan.off and <name>_sliver.off into the folder; then
//
//   run.py rco_benchmark folder/<name>_*.off -- --reference mesh

#include "../meshes.h"
#include "../shape.h"

#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Random.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace PMP = CGAL::Polygon_mesh_processing;
typedef Kernel::Point_3 Point;
typedef Kernel::Vector_3 Vector;

// whether a triangle agrees with the shape's normal and has no angle below the bound (degrees)
bool is_good(const Shape& shape, const Point& a, const Point& b, const Point& c, double bound)
{
  const Vector n = CGAL::cross_product(b - a, c - a);
  const double length = std::sqrt(n.squared_length());
  const double longest = (std::max)(
    {CGAL::squared_distance(a, b), CGAL::squared_distance(b, c), CGAL::squared_distance(c, a)});
  // height over the longest side; small angles are about height over length
  return n * shape.normal(CGAL::centroid(a, b, c)) > 0.5 * length &&
         length > longest * std::sin(bound * CGAL_PI / 180);
}

double mean_edge_length(const Mesh& mesh) { return RCO::edge_statistics(mesh).mean; }

Mesh isotropic(const Mesh& mesh, const Shape& shape, double edge_length)
{
  Mesh result = mesh;
  PMP::isotropic_remeshing(faces(result), edge_length, result,
                           CGAL::parameters::number_of_iterations(6));
  result.collect_garbage();
  for(const Mesh::Vertex_index v : result.vertices())
    result.point(v) = shape.project(result.point(v));
  return result;
}

// splits an edge at the point that divides it as t : 1 - t, moved onto the shape, where the four
// triangles are good
void split(Mesh& mesh, Mesh::Edge_index e, double t, const Shape& shape, double bound)
{
  const Mesh::Halfedge_index h = mesh.halfedge(e), o = mesh.opposite(h);
  if(mesh.is_border(e))
    return;
  const Point a = mesh.point(mesh.source(h)), b = mesh.point(mesh.target(h));
  const Point c = mesh.point(mesh.target(mesh.next(h))), d = mesh.point(mesh.target(mesh.next(o)));
  const Point p = shape.project(a + t * (b - a));
  if(!is_good(shape, a, p, c, bound) || !is_good(shape, p, b, c, bound) ||
     !is_good(shape, p, a, d, bound) || !is_good(shape, b, p, d, bound))
    return;
  const Mesh::Halfedge_index to_new = CGAL::Euler::split_edge(h, mesh);
  mesh.point(mesh.target(to_new)) = p;
  CGAL::Euler::split_face(to_new, mesh.next(h), mesh);
  CGAL::Euler::split_face(o, mesh.next(mesh.next(o)), mesh);
}

// flips an edge where the two triangles stay good and the mesh manifold
void flip(Mesh& mesh, Mesh::Edge_index e, const Shape& shape, double bound)
{
  const Mesh::Halfedge_index h = mesh.halfedge(e), o = mesh.opposite(h);
  if(mesh.is_border(e) || mesh.degree(mesh.source(h)) < 5 || mesh.degree(mesh.target(h)) < 5)
    return;
  const Mesh::Vertex_index c = mesh.target(mesh.next(h)), d = mesh.target(mesh.next(o));
  const Point a = mesh.point(mesh.source(h)), b = mesh.point(mesh.target(h));
  if(mesh.degree(c) < 8 && mesh.degree(d) < 8 && mesh.halfedge(c, d) == Mesh::null_halfedge() &&
     is_good(shape, mesh.point(c), a, mesh.point(d), bound) &&
     is_good(shape, mesh.point(d), b, mesh.point(c), bound))
    CGAL::Euler::flip_edge(h, mesh);
}

// moves a vertex at random along the shape where its triangles stay good
void jitter(Mesh& mesh, Mesh::Vertex_index v, const Shape& shape, CGAL::Random& random)
{
  if(mesh.is_isolated(v) || mesh.is_border(v))
    return;
  const Point old = mesh.point(v);
  double reach = 0;
  for(const Mesh::Halfedge_index h : mesh.halfedges_around_target(mesh.halfedge(v)))
    reach += std::sqrt(CGAL::squared_distance(old, mesh.point(mesh.source(h)))) / mesh.degree(v);
  const auto coordinate = [&]() { return random.get_double(-0.4, 0.4) * reach; };
  const Vector any(coordinate(), coordinate(), coordinate());
  const Vector normal = shape.normal(old);
  mesh.point(v) = shape.project(old + (any - (any * normal) * normal));
  for(const Mesh::Halfedge_index h : mesh.halfedges_around_target(mesh.halfedge(v)))
    if(!is_good(shape, mesh.point(mesh.source(h)), mesh.point(v),
                mesh.point(mesh.target(mesh.next(h))), 3))
    {
      mesh.point(v) = old;
      return;
    }
}

std::vector<Mesh::Edge_index> all_edges(const Mesh& mesh)
{
  return std::vector<Mesh::Edge_index>(mesh.edges().begin(), mesh.edges().end());
}

// denser where the shape faces the scanner, irregular in valence and spacing
Mesh scan(Mesh mesh, const Shape& shape, CGAL::Random& random)
{
  for(const Mesh::Edge_index e : all_edges(mesh))
  {
    const double facing = shape.normal(mesh.point(mesh.vertex(e, 0))).z();
    if(random.get_double() < 0.25 * facing * facing)
      split(mesh, e, random.get_double(0.3, 0.7), shape, 5);
  }
  for(int pass = 0; pass < 2; ++pass)
  {
    for(const Mesh::Edge_index e : all_edges(mesh))
      if(random.get_double() < 0.1)
        flip(mesh, e, shape, 5);
    for(const Mesh::Vertex_index v : mesh.vertices())
      jitter(mesh, v, shape, random);
  }
  return mesh;
}

// one edge in twenty is split close to one of its ends, down to angles of about one degree
Mesh sliver(Mesh mesh, const Shape& shape, CGAL::Random& random)
{
  for(const Mesh::Edge_index e : all_edges(mesh))
    if(random.get_double() < 0.05)
      split(mesh, e, 0.02 * std::pow(10., random.get_double()), shape, 0.7);
  return mesh;
}

void write_and_tell(const Mesh& mesh,
                    const Mesh& original,
                    const std::string& folder,
                    const std::string& name)
{
  write(mesh, folder, name);
  const RCO::Angle_statistics a = RCO::angle_statistics(mesh);
  const RCO::Orientation_defects d = RCO::orientation_defects(mesh, original);
  std::printf("%s: %d vertices, %d faces, smallest angles %.2f / %.2f / %.2f (min / mean / std), "
              "%d below 10 degrees, drift %.2f mean edges, %d flips, %d fold edges\n",
              name.c_str(), int(mesh.number_of_vertices()), int(mesh.number_of_faces()), a.minimum,
              a.mean, a.standard_deviation, int(a.number_below_10),
              RCO::drift(mesh, original).relative_maximum(), int(d.number_of_flips),
              int(d.number_of_fold_edges));
}

int main(int argc, char* argv[])
{
  const std::string file = argc > 1 ? argv[1] : CGAL::data_file_path("meshes/bear.off");
  const std::string folder = argc > 2 ? argv[2] : ".";
  try
  {
    const Mesh mesh = read(file);
    const std::string base = base_name(file);
    const Shape shape(mesh);
    CGAL::Random random(0);
    const double length = mean_edge_length(mesh);
    write_and_tell(isotropic(mesh, shape, length), mesh, folder, base + "_isotropic");
    // edges are split afterwards: longer ones to start from give about the same number of vertices
    const Mesh coarse = isotropic(mesh, shape, 1.1 * length);
    write_and_tell(scan(coarse, shape, random), mesh, folder, base + "_scan");
    write_and_tell(sliver(coarse, shape, random), mesh, folder, base + "_sliver");
  }
  catch(const std::exception& e)
  {
    std::cerr << file << ": " << e.what() << std::endl;
    return 1;
  }
  return 0;
}
