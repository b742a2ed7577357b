// Which edges are sharp, kept apart from the mesh so that it can be constant.

#ifndef RCO_PROGRAM_SHARP_EDGES_H
#define RCO_PROGRAM_SHARP_EDGES_H

#include "mesh.h"

#include <CGAL/Polygon_mesh_processing/detect_features.h>

#include <boost/property_map/property_map.hpp>

#include <vector>

class Sharp_edges
{
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

  // those where the surface turns by more than the angle, and borders; none at 180 degrees
  Sharp_edges(const Mesh& mesh, double degrees) : m_is_sharp(mesh.num_edges(), false)
  {
    if(degrees < 180)
      CGAL::Polygon_mesh_processing::detect_sharp_edges(mesh, degrees, map());
  }
  Map map() { return Map{&m_is_sharp}; }
};

#endif // RCO_PROGRAM_SHARP_EDGES_H
