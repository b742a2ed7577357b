#pragma once

// A triangle mesh whose vertices lie on its own initial shape and slide along it: what those peers
// need that do not bring a projection of their own.

#include "../meshes.h"

#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

#include <cstddef>
#include <vector>

class Mesh_on_reference
{
  typedef RCO::internal::Mesh_copy Mesh_copy;
  typedef RCO::internal::Indexed_mesh Indexed_mesh;
  typedef RCO::internal::Reference_surface Reference_surface;

public:
  typedef RCO::internal::Surface_point Surface_point;
  typedef RCO::internal::Vector_3 Vector;

  explicit Mesh_on_reference(const Mesh& mesh)
    : Mesh_on_reference(RCO::internal::read_face_graph(mesh, mesh.points(), "mesh"))
  {}

  const Indexed_mesh& mesh() const { return m_mesh; }
  const Reference_surface& reference() const { return m_reference; }
  double mean_edge_length() const { return m_reference.mean_edge_length(); }

  bool is_free(int v) const
  {
    return !m_mesh.is_border_vertex[v] && m_mesh.vertex_begin[v] < m_mesh.vertex_begin[v + 1];
  }
  const Vector& point(int v) const { return m_vertices[v].position; }
  const Surface_point& location(int v) const { return m_vertices[v]; }

  // the point of the reference for a vertex that is moved to p, on the same sheet
  Surface_point projection(int v, const Vector& p) const
  {
    return m_reference.local_closest(p, m_vertices[v].face);
  }
  void place(int v, const Surface_point& s) { m_vertices[v] = s; }

  // takes the points of a mesh and projects those that may move, each from where it was last
  void take(const Mesh& mesh)
  {
    for(int v = 0; v < m_mesh.number_of_vertices(); ++v)
      if(is_free(v))
        place(v, projection(v, point_of(mesh, v)));
  }
  // the same for vertices that may have gone far
  void take_globally(const Mesh& mesh)
  {
    for(int v = 0; v < m_mesh.number_of_vertices(); ++v)
      if(is_free(v))
        place(v, m_reference.closest(point_of(mesh, v)));
  }
  void give(Mesh& mesh) const
  {
    for(int v = 0; v < m_mesh.number_of_vertices(); ++v)
      if(is_free(v))
        mesh.point(Mesh::Vertex_index(v)) =
          Kernel::Point_3(point(v).x(), point(v).y(), point(v).z());
  }

private:
  static Vector point_of(const Mesh& mesh, int v)
  {
    const Kernel::Point_3& p = mesh.point(Mesh::Vertex_index(v));
    return Vector(p.x(), p.y(), p.z());
  }

  explicit Mesh_on_reference(const Mesh_copy& copy)
    : m_mesh(copy.mesh),
      m_reference(copy),
      m_vertices(copy.points.size())
  {
    for(int v = 0; v < m_mesh.number_of_vertices(); ++v)
      if(m_mesh.vertex_begin[v] < m_mesh.vertex_begin[v + 1])
      {
        const int face = m_mesh.corner_face[m_mesh.vertex_corners[m_mesh.vertex_begin[v]]];
        m_vertices[v] = m_reference.closest_in_face(copy.points[v], face);
        m_vertices[v].position = copy.points[v];
      }
  }

  Indexed_mesh m_mesh;
  Reference_surface m_reference;
  std::vector<Surface_point> m_vertices;
};
