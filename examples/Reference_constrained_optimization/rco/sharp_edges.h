// Which edges are sharp, kept apart from the mesh so that it can be constant.

#ifndef RCO_PROGRAM_SHARP_EDGES_H
#define RCO_PROGRAM_SHARP_EDGES_H

#include "mesh.h"

#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>

#include <CGAL/Kernel_traits.h>

#include <boost/property_map/property_map.hpp>

#include <vector>

class Sharp_edges
{
  typedef CGAL::Kernel_traits<Mesh::Point>::Kernel::Vector_3 Vector;

  std::vector<bool> m_is_sharp;

public:
  // a model of ReadWritePropertyMap, valid as long as the object is
  struct Map
  {
    typedef Mesh::Edge_index key_type;
    typedef bool value_type;
    typedef bool reference;
    typedef boost::read_write_property_map_tag category;
    std::vector<bool>* is_sharp;

    friend bool get(const Map& map, Mesh::Edge_index e) { return (*map.is_sharp)[e.idx()]; }
    friend void put(const Map& map, Mesh::Edge_index e, bool value)
    {
      (*map.is_sharp)[e.idx()] = value;
    }
  };

  // Those where the surface turns by more than the angle, and borders, but no folds: edges of a face that is
  // turned against the normals at its vertices where the surface turns by more than 120 degrees.
  Sharp_edges(const Mesh& mesh, double degrees) : m_is_sharp(mesh.num_edges(), false)
  {
    namespace PMP = CGAL::Polygon_mesh_processing;
    PMP::detect_sharp_edges(mesh, degrees, map());
    std::vector<bool> is_turned_far(mesh.num_edges(), false);
    const double fold = 120;
    PMP::detect_sharp_edges(mesh, fold, Map{&is_turned_far});
    std::vector<Vector> face_normals(mesh.num_faces()), vertex_normals(mesh.num_vertices());
    PMP::compute_normals(
      mesh,
      boost::make_iterator_property_map(vertex_normals.begin(), get(CGAL::vertex_index, mesh)),
      boost::make_iterator_property_map(face_normals.begin(), get(CGAL::face_index, mesh)));
    const auto is_reversed = [&](Mesh::Face_index f) {
      Vector sum = CGAL::NULL_VECTOR;
      for(const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f)))
        sum = sum + vertex_normals[v];
      return face_normals[f] * sum < 0;
    };
    for(const Mesh::Edge_index e : mesh.edges())
      if(is_turned_far[e] && !mesh.is_border(e) &&
         (is_reversed(mesh.face(mesh.halfedge(e, 0))) ||
          is_reversed(mesh.face(mesh.halfedge(e, 1)))))
        m_is_sharp[e] = false;
  }
  Map map() { return Map{&m_is_sharp}; }
};

#endif // RCO_PROGRAM_SHARP_EDGES_H
