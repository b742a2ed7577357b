#pragma once

// Where the package says that the vertices lie on a triangle mesh, and what follows. A closest point
// may be on another sheet where a surface passes through itself.

#include "../meshes.h"

#include <CGAL/Reference_constrained_optimization/quality_measures/orientation.h>

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

inline double largest_coordinate(const Mesh& mesh)
{
  double largest = 0;
  for(const Mesh::Vertex_index v : mesh.vertices())
    for(int i = 0; i < 3; ++i)
      largest = (std::max)(largest, std::abs(mesh.point(v)[i]));
  return largest;
}

class Locations
{
public:
  typedef std::pair<Mesh::Face_index, std::array<double, 3>> Location;
  typedef Mesh::Property_map<Mesh::Vertex_index, Location> Map;

  // the map is kept in `mesh`
  Locations(Mesh& mesh, const Mesh& reference)
    : m_mesh(mesh),
      m_reference(reference),
      m_map(mesh.add_property_map<Mesh::Vertex_index, Location>("location").first)
  {}

  const Map& map() const { return m_map; }

  // the largest distance of a vertex from where it is said to be, and infinity for a barycentric
  // coordinate that is no part of one
  template <typename Is_free>
  double largest_distance(const Is_free& is_free) const
  {
    double largest = 0;
    for(const Mesh::Vertex_index v : m_mesh.vertices())
    {
      if(m_mesh.is_isolated(v) || !is_free(v))
        continue;
      Kernel::Vector_3 p = CGAL::NULL_VECTOR;
      for(int i = 0; i < 3; ++i)
      {
        const double b = m_map[v].second[i];
        if(!(b >= 0 && b <= 1 + 1e-12))
          return std::numeric_limits<double>::infinity();
        p = p + b * (m_reference.point(corner(v, i)) - CGAL::ORIGIN);
      }
      const Kernel::Vector_3 d = p - (m_mesh.point(v) - CGAL::ORIGIN);
      largest = (std::max)(largest, std::hypot(d.x(), d.y(), d.z()));
    }
    return largest;
  }

  // The reference's vertex normals. Each of its components is oriented as the faces of the mesh on it, of
  // those that count.
  template <typename Counts>
  std::vector<Kernel::Vector_3> oriented_normals(const Counts& counts) const
  {
    std::vector<Kernel::Vector_3> normals = vertex_normals();
    std::vector<std::size_t> component(m_reference.number_of_faces());
    CGAL::Polygon_mesh_processing::connected_components(m_reference,
                                                        CGAL::make_property_map(component));
    std::vector<double> agreement(component.size(), 0); // per component
    std::vector<char> is_reversed(normals.size(), 0);
    for(const Mesh::Face_index f : m_mesh.faces())
      if(counts(f))
        for(const Mesh::Vertex_index v : m_mesh.vertices_around_face(m_mesh.halfedge(f)))
          agreement[component[m_map[v].first]] += normal(m_mesh, f) * normal_at(v, normals);
    for(const Mesh::Face_index f : m_reference.faces())
      if(agreement[component[f]] < 0)
        for(const Mesh::Vertex_index v : m_reference.vertices_around_face(m_reference.halfedge(f)))
          is_reversed[v] = 1;
    for(std::size_t v = 0; v < normals.size(); ++v)
      if(is_reversed[v])
        normals[v] = -normals[v];
    return normals;
  }

  // As the measure of the same name, but with the given normals of the reference at the locations. What
  // rounding decides on, as the side to which a face without area is turned, counts or does not.
  RCO::Orientation_defects orientation_defects(const std::vector<Kernel::Vector_3>& of_reference,
                                               bool with_doubtful) const
  {
    const double largest = largest_coordinate(m_mesh);
    struct Face
    {
      Kernel::Vector_3 normal;
      double side, doubt; // the product with the reference's normals, and how much of it is noise
      bool is_doubtful() const { return !(length(normal) > doubt); }
    };
    std::vector<Face> faces;
    for(const Mesh::Face_index f : m_mesh.faces())
    {
      const Mesh::Halfedge_index h = m_mesh.halfedge(f);
      const double a = edge_length(h), b = edge_length(m_mesh.next(h));
      Kernel::Vector_3 sum = CGAL::NULL_VECTOR;
      for(const Mesh::Vertex_index v : m_mesh.vertices_around_face(h))
        sum = sum + normal_at(v, of_reference);
      const Kernel::Vector_3 n = normal(m_mesh, f);
      faces.push_back({n, n * sum, (std::max)(1e-9 * a * b, 1e-13 * largest * (a + b))});
    }
    RCO::Orientation_defects defects;
    const double sign = with_doubtful ? 1 : -1, slack = sign * 1e-9;
    for(const Face& f : faces)
      defects.number_of_flips += f.side < sign * 3 * f.doubt;
    for(const Mesh::Edge_index e : m_mesh.edges())
    {
      if(m_mesh.is_border(e))
        continue;
      const Face &f = faces[m_mesh.face(m_mesh.halfedge(e, 0))],
                 &g = faces[m_mesh.face(m_mesh.halfedge(e, 1))];
      if(f.is_doubtful() || g.is_doubtful())
        defects.number_of_fold_edges += with_doubtful;
      else
        defects.number_of_fold_edges += unit(f.normal) * unit(g.normal) < -0.5 + slack;
    }
    return defects;
  }

private:
  Mesh::Vertex_index corner(Mesh::Vertex_index v, int i) const
  {
    const Mesh::Halfedge_index h = m_reference.halfedge(m_map[v].first);
    return i == 0   ? m_reference.source(h)
           : i == 1 ? m_reference.target(h)
                    : m_reference.target(m_reference.next(h));
  }
  Kernel::Vector_3 normal_at(Mesh::Vertex_index v,
                             const std::vector<Kernel::Vector_3>& of_reference) const
  {
    Kernel::Vector_3 sum = CGAL::NULL_VECTOR;
    for(int i = 0; i < 3; ++i)
      sum = sum + m_map[v].second[i] * of_reference[corner(v, i)];
    return sum;
  }
  // unit vectors, or zero where the faces cancel out
  std::vector<Kernel::Vector_3> vertex_normals() const
  {
    std::vector<Kernel::Vector_3> normals(m_reference.number_of_vertices(), CGAL::NULL_VECTOR);
    std::vector<double> areas(normals.size(), 0);
    for(const Mesh::Face_index f : m_reference.faces())
      for(const Mesh::Vertex_index v : m_reference.vertices_around_face(m_reference.halfedge(f)))
      {
        const Kernel::Vector_3 n = normal(m_reference, f);
        normals[v] = normals[v] + n;
        areas[v] += length(n);
      }
    for(std::size_t v = 0; v < areas.size(); ++v)
      normals[v] = length(normals[v]) > 1e-14 * areas[v] ? unit(normals[v])
                                                         : Kernel::Vector_3(CGAL::NULL_VECTOR);
    return normals;
  }
  double edge_length(Mesh::Halfedge_index h) const
  {
    return length(m_mesh.point(m_mesh.target(h)) - m_mesh.point(m_mesh.source(h)));
  }
  static Kernel::Vector_3 normal(const Mesh& mesh, Mesh::Face_index f)
  {
    const Mesh::Halfedge_index h = mesh.halfedge(f);
    const Kernel::Point_3 &a = mesh.point(mesh.source(h)), &b = mesh.point(mesh.target(h)),
                          &c = mesh.point(mesh.target(mesh.next(h)));
    return CGAL::cross_product(b - a, c - a);
  }
  static double length(const Kernel::Vector_3& n) { return std::hypot(n.x(), n.y(), n.z()); }
  static Kernel::Vector_3 unit(const Kernel::Vector_3& n)
  {
    const double l = length(n);
    return l > 0 ? n / l : n;
  }

  Mesh& m_mesh;
  const Mesh& m_reference;
  Map m_map;
};
