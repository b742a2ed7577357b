// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Shapes as CGAL's meshes and back, and shapes from files.

#pragma once

#include "shapes.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>
#include <CGAL/number_utils.h>

#include <boost/graph/graph_traits.hpp>

#include <iostream>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace rco_test {

namespace params = CGAL::parameters;
typedef CGAL::Simple_cartesian<double> Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

// a shape as a model of MutableFaceGraph; vertices and faces keep their order
template <typename Mesh>
Mesh make_mesh(const Shape& shape)
{
  Mesh mesh;
  auto vpm = get(CGAL::vertex_point, mesh);
  typedef typename boost::property_traits<decltype(vpm)>::value_type Point;
  typedef typename boost::graph_traits<Mesh>::vertex_descriptor Vertex;
  std::vector<Vertex> all;
  for(const Vector_3& p : shape.points)
  {
    all.push_back(add_vertex(mesh));
    put(vpm, all.back(), Point(p.x(), p.y(), p.z()));
  }
  for(const std::vector<int>& f : shape.faces)
  {
    std::vector<Vertex> corners;
    for(const int v : f)
      corners.push_back(all[v]);
    CGAL::Euler::add_face(corners, mesh);
  }
  return mesh;
}

inline Mesh mesh_of(const Shape& shape) { return make_mesh<Mesh>(shape); }

template <typename Mesh>
Shape make_shape(const Mesh& mesh)
{
  Shape shape;
  auto vpm = get(CGAL::vertex_point, mesh);
  auto index = get(CGAL::dynamic_vertex_property_t<int>(), mesh);
  for(const auto v : vertices(mesh))
  {
    const auto& p = get(vpm, v);
    put(index, v,
        shape.add(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())));
  }
  for(const auto f : faces(mesh))
  {
    std::vector<int> corners;
    for(const auto v : CGAL::vertices_around_face(halfedge(f, mesh), mesh))
      corners.push_back(get(index, v));
    shape.faces.push_back(corners);
  }
  return shape;
}

// one of CGAL's meshes; where it is not installed, an empty shape, and it is told that it is skipped
inline Shape read_data(const std::string& name)
{
  Mesh mesh;
  if(!CGAL::IO::read_OFF(std::string(RCO_DATA_DIR) + "/" + name, mesh))
    std::cout << name << " was not found, skipped" << std::endl;
  return make_shape(mesh);
}

} // namespace rco_test
