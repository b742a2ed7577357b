// Makes quad meshes to try: every triangle becomes three quads, by one step of Catmull-Clark
// subdivision, and the vertices are put back onto the triangles. On demand they are then shaken.

#ifndef RCO_EXAMPLE_QUAD_MESH_GENERATION_H
#define RCO_EXAMPLE_QUAD_MESH_GENERATION_H

#include "face_tree.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>

#include <cstddef>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace RCO = CGAL::Reference_constrained_optimization;
typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

inline Mesh read_mesh(const std::string& file)
{
  Mesh mesh;
  if(!CGAL::IO::read_polygon_mesh(file, mesh) || mesh.number_of_faces() == 0)
    throw std::runtime_error(file + " cannot be read as a manifold polygon mesh");
  return mesh;
}

inline void write_mesh(const std::string& file, const Mesh& mesh)
{
  if(!CGAL::IO::write_OBJ(file, mesh, CGAL::parameters::stream_precision(17)))
    throw std::runtime_error(file + " cannot be written");
}

// Closest points of a triangle mesh, with normals that vary smoothly: interpolated from the
// vertices, as number_of_nonconvex_quads() takes them.
class Smooth_surface
{
  typedef Kernel::Point_3 Point;
  typedef Kernel::Vector_3 Vector;

  const Mesh& m_triangles;
  Face_tree<Kernel, Mesh> m_tree;
  std::vector<Vector> m_normals; // unit normals at the vertices

  static double length(const Vector& v) { return CGAL::approximate_sqrt(v.squared_length()); }

public:
  struct Location
  {
    Point point;
    Vector normal;
  };

  explicit Smooth_surface(const Mesh& triangles)
    : m_triangles(triangles),
      m_normals(triangles.number_of_vertices(), CGAL::NULL_VECTOR)
  {
    std::vector<Mesh::Face_index> faces; // those with an area
    for(const Mesh::Face_index f : triangles.faces())
    {
      if(CGAL::Polygon_mesh_processing::is_degenerate_triangle_face(f, triangles))
        continue;
      faces.push_back(f);
      const Mesh::Halfedge_index h = triangles.halfedge(f);
      const Point& p = triangles.point(triangles.source(h));
      const Vector normal =
        CGAL::cross_product(triangles.point(triangles.target(h)) - p,
                            triangles.point(triangles.target(triangles.next(h))) - p);
      for(const Mesh::Vertex_index v : vertices_around_face(h, triangles))
        m_normals[v] += normal;
    }
    if(faces.empty())
      throw std::runtime_error("all triangles are degenerate");
    for(Vector& n : m_normals)
      if(length(n) > 0)
        n /= length(n);
    m_tree.insert(faces.begin(), faces.end(), triangles);
    m_tree.build();
  }

  Location closest(const Point& p) const
  {
    const auto found = m_tree.closest_point_and_primitive(p);
    Location result{found.first, CGAL::NULL_VECTOR};
    // weights: the areas of the parts into which the point splits the triangle
    double sum = 0;
    for(const Mesh::Halfedge_index h :
        halfedges_around_face(m_triangles.halfedge(found.second), m_triangles))
    {
      const double area =
        length(CGAL::cross_product(m_triangles.point(m_triangles.source(h)) - result.point,
                                   m_triangles.point(m_triangles.target(h)) - result.point));
      result.normal += area * m_normals[m_triangles.target(m_triangles.next(h))];
      sum += area;
    }
    if(sum > 0)
      result.normal /= sum;
    return result;
  }
};

// Moves the vertices of a quad mesh at random along the surface that they lie on, by `size` mean
// edges at most. No quad loses its convexity. Vertices at the border stay.
class Jitter
{
  typedef Smooth_surface::Location Location;

  Mesh& m_quads;
  const Smooth_surface& m_surface;
  std::vector<Location> m_locations; // of all vertices
  std::mt19937 m_random;             // its bits, unlike distributions, are the same everywhere

  double random_coordinate() { return double(m_random()) / 2147483648. - 1; }

  Kernel::Vector_3 random_vector_in_unit_ball()
  {
    while(true)
    {
      const double x = random_coordinate(), y = random_coordinate(), z = random_coordinate();
      if(x * x + y * y + z * z <= 1)
        return Kernel::Vector_3(x, y, z);
    }
  }

  bool is_convex(Mesh::Face_index f) const
  {
    for(const Mesh::Halfedge_index h : halfedges_around_face(m_quads.halfedge(f), m_quads))
    {
      const Location &a = m_locations[m_quads.source(h)], &b = m_locations[m_quads.target(h)],
                     &c = m_locations[m_quads.target(m_quads.next(h))];
      const Kernel::Vector_3 normal = CGAL::cross_product(c.point - b.point, a.point - b.point);
      if(normal * (a.normal + b.normal + c.normal) < 0)
        return false;
    }
    return true;
  }

  std::size_t number_of_nonconvex_quads_around(Mesh::Vertex_index v) const
  {
    std::size_t number = 0;
    for(const Mesh::Face_index f : faces_around_target(m_quads.halfedge(v), m_quads))
      number += !is_convex(f);
    return number;
  }

  void move(Mesh::Vertex_index v, Kernel::Vector_3 step)
  {
    const Location start = m_locations[v];
    const double square = start.normal.squared_length();
    if(square > 0)
      step -= (step * start.normal) / square * start.normal;
    const std::size_t number = number_of_nonconvex_quads_around(v);
    for(int i = 0; i < 10; ++i, step /= 2)
    {
      m_locations[v] = m_surface.closest(start.point + step);
      if(number_of_nonconvex_quads_around(v) <= number)
        return;
    }
    m_locations[v] = start;
  }

public:
  Jitter(Mesh& quads, const Smooth_surface& surface, unsigned int seed)
    : m_quads(quads),
      m_surface(surface),
      m_random(seed)
  {
    for(const Kernel::Point_3& p : quads.points())
      m_locations.push_back(surface.closest(p));
  }

  void operator()(double size)
  {
    const double longest = size * RCO::edge_statistics(m_quads).mean;
    for(const Mesh::Vertex_index v : m_quads.vertices())
      if(!m_quads.is_border(v))
      {
        move(v, longest * random_vector_in_unit_ball());
        m_quads.point(v) = m_locations[v].point;
      }
  }
};

inline Mesh make_quad_mesh(const Mesh& triangles, double jitter = 0, unsigned int seed = 0)
{
  RCO::edge_statistics(triangles); // throws if the mesh is no good, which the tree would not

  Mesh quads = triangles;
  CGAL::Subdivision_method_3::CatmullClark_subdivision(quads);
  const Smooth_surface surface(triangles);
  for(const Mesh::Vertex_index v : quads.vertices())
    if(!quads.is_border(v))
      quads.point(v) = surface.closest(quads.point(v)).point;
    else if(triangles.has_valid_index(v))
      quads.point(v) = triangles.point(v); // the others halve an edge of the border
  if(jitter > 0)
    Jitter(quads, surface, seed)(jitter);
  return quads;
}

#endif // RCO_EXAMPLE_QUAD_MESH_GENERATION_H
