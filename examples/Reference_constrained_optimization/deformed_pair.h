// Makes a pair for compatible remeshing out of one mesh: the mesh, and a scaled, twisted and bent
// copy of it with another triangulation. A few vertices at the ends of the shape are landmarks.

#ifndef RCO_EXAMPLE_DEFORMED_PAIR_H
#define RCO_EXAMPLE_DEFORMED_PAIR_H

#include <CGAL/Bbox_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <boost/graph/dijkstra_shortest_paths.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;
typedef std::vector<std::pair<Mesh::Vertex_index, Mesh::Vertex_index>> Landmarks;

// Scales a box by 1, 1.4 and 0.7 along its sides, from the longest to the shortest, twists it about
// the longest by 60 degrees and bends it by 75. Bijective, and the orientation is kept.
class Deformation
{
  Kernel::Point_3 m_center;
  int m_axis[3] = {0, 1, 2};
  double m_length;

public:
  explicit Deformation(const CGAL::Bbox_3& box)
    : m_center(CGAL::midpoint(Kernel::Point_3(box.xmin(), box.ymin(), box.zmin()),
                              Kernel::Point_3(box.xmax(), box.ymax(), box.zmax())))
  {
    const auto side = [&](int i) { return box.max(i) - box.min(i); };
    std::sort(m_axis, m_axis + 3, [&](int i, int j) { return side(i) > side(j); });
    m_length = side(m_axis[0]);
  }
  Kernel::Point_3 operator()(const Kernel::Point_3& p) const
  {
    const Kernel::Vector_3 d = p - m_center;
    const double x = d[m_axis[0]] / m_length, y = 1.4 * d[m_axis[1]], z = 0.7 * d[m_axis[2]];
    const double twist = 1.05 * x, bend = 1.3 * x, radius = m_length / 1.3;
    const double r = radius + y * std::sin(twist) + z * std::cos(twist);
    double moved[3];
    moved[m_axis[0]] = r * std::sin(bend);
    moved[m_axis[1]] = y * std::cos(twist) - z * std::sin(twist);
    moved[m_axis[2]] = r * std::cos(bend) - radius;
    return m_center + Kernel::Vector_3(moved[0], moved[1], moved[2]);
  }
};

// Vertices at the ends of the shape: each next is the one furthest, along edges, from those before.
inline std::vector<Mesh::Vertex_index> furthest_vertices(const Mesh& mesh, std::size_t number)
{
  std::vector<double> distance(num_vertices(mesh)), nearest;
  const auto index = get(boost::vertex_index, mesh);
  std::vector<Mesh::Vertex_index> result;
  Mesh::Vertex_index v(0);
  while(result.size() < number)
  {
    boost::dijkstra_shortest_paths(
      mesh, v,
      boost::vertex_index_map(index)
        .distance_map(boost::make_iterator_property_map(distance.begin(), index))
        .weight_map(get(boost::edge_weight, mesh)));
    if(result.size() < 2) // vertex 0 is no landmark: it only serves to find the first end
      nearest = distance;
    for(std::size_t i = 0; i < nearest.size(); ++i)
      nearest[i] = (std::min)(nearest[i], distance[i]);
    const auto furthest = std::max_element(nearest.begin(), nearest.end());
    v = Mesh::Vertex_index(Mesh::size_type(furthest - nearest.begin()));
    result.push_back(v);
  }
  return result;
}

inline Mesh::Vertex_index nearest_vertex(const Mesh& mesh, const Kernel::Point_3& p)
{
  return *std::min_element(mesh.vertices().begin(), mesh.vertices().end(),
                           [&](Mesh::Vertex_index v, Mesh::Vertex_index w) {
                             return CGAL::squared_distance(mesh.point(v), p) <
                                    CGAL::squared_distance(mesh.point(w), p);
                           });
}

// The reference is made from the source; returns the landmarks.
inline Landmarks make_deformed_pair(const Mesh& source, Mesh& reference)
{
  const Deformation deformation(CGAL::Polygon_mesh_processing::bbox(source));
  reference = source;
  double length = 0;
  for(const Mesh::Vertex_index v : reference.vertices())
    reference.point(v) = deformation(source.point(v));
  for(const Mesh::Edge_index e : reference.edges())
    length += get(boost::edge_weight, reference, e) / double(reference.number_of_edges());
  CGAL::Polygon_mesh_processing::isotropic_remeshing(reference.faces(), length, reference,
                                                     CGAL::parameters::number_of_iterations(3));
  reference.collect_garbage();

  Landmarks landmarks;
  for(const Mesh::Vertex_index v : furthest_vertices(source, 8))
    landmarks.emplace_back(v, nearest_vertex(reference, deformation(source.point(v))));
  return landmarks;
}

#endif // RCO_EXAMPLE_DEFORMED_PAIR_H
