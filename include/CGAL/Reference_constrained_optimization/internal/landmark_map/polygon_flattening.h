// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_POLYGON_FLATTENING_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_POLYGON_FLATTENING_H

#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_graph.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/support/compatibility.h>

#include <CGAL/Eigen_solver_traits.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Surface_mesh_parameterization/Barycentric_mapping_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Error_code.h>
#include <CGAL/Surface_mesh_parameterization/Mean_value_coordinates_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>
#include <CGAL/boost/graph/Seam_mesh.h>

#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// A surface, cut along its arcs and flattened to a convex polygon, one side for each arc of the disk's
// boundary.
class Polygon_flattening
{
  typedef Cut_surface::Mesh Mesh;
  typedef Cut_surface::Halfedge Halfedge;
  typedef Cut_surface::Vertex Vertex;
  typedef Mesh::Property_map<Cut_surface::Edge, bool> Edge_map;
  typedef Mesh::Property_map<Vertex, bool> Vertex_map;
  typedef CGAL::Seam_mesh<Mesh, Edge_map, Vertex_map> Seam_mesh;

public:
  typedef Cut_surface::Kernel::Point_2 Point_2;

  // corners of a polygon inscribed in the unit circle, clockwise, with sides of the given lengths
  // as far as that can be
  static std::vector<Point_2> polygon(const std::vector<double>& lengths)
  {
    double sum = 0;
    for(const double l : lengths)
      sum += l;
    std::vector<Point_2> corners;
    double passed = 0;
    for(const double l : lengths)
    {
      const double angle = -6.283185307179586 * passed;
      corners.emplace_back(std::cos(angle), std::sin(angle));
      // short sides are lengthened, to give room to the faces along them
      passed += 0.5 * l / sum + 0.5 / double(lengths.size());
    }
    return corners;
  }

  // false if no map that is bijective, by exact predicates, was found
  bool flatten(Cut_surface& surface,
               const std::vector<Cut_graph::Side>& sides,
               const std::vector<Point_2>& corners)
  {
    namespace SMP = CGAL::Surface_mesh_parameterization;
    typedef Fixed_border Border;
    typedef CGAL::Eigen_solver_traits<Eigen::SparseLU<CGAL::Eigen_sparse_matrix<double>::EigenType>>
      Solver;
    m_surface = &surface;
    set_border_points(sides, corners);
    // mean value coordinates are not defined at an edge without length
    return (!has_degenerate_edge() &&
            run(SMP::Mean_value_coordinates_parameterizer_3<Seam_mesh, Border, Solver>(
              Border(m_border_points)))) ||
           run(SMP::Barycentric_mapping_parameterizer_3<Seam_mesh, Border, Solver>(
             Border(m_border_points)));
  }

  // the position of the target of a half-edge that has a face; a vertex on a cut has several positions
  const Point_2& operator()(Halfedge h) const { return m_points[h]; }

private:
  // CGAL's concept of a border parameterizer: positions are given per half-edge of the border
  struct Fixed_border
  {
    const std::vector<Point_2>* points;

    explicit Fixed_border(const std::vector<Point_2>& points) : points(&points) {}

    template <typename Border_halfedge,
              typename UvMap,
              typename IndexMap,
              typename IsParameterizedMap>
    CGAL::Surface_mesh_parameterization::Error_code parameterize(
      const Seam_mesh& mesh, Border_halfedge border, UvMap uv, IndexMap, IsParameterizedMap is_done)
    {
      for(const Border_halfedge h : CGAL::halfedges_around_face(border, mesh))
      {
        put(uv, target(h, mesh), (*points)[Halfedge(h)]);
        put(is_done, target(h, mesh), true);
      }
      return CGAL::Surface_mesh_parameterization::OK;
    }
    bool is_border_convex() const { return true; }
  };

  bool has_degenerate_edge() const
  {
    const Mesh& mesh = m_surface->mesh();
    return std::any_of(mesh.edges().begin(), mesh.edges().end(), [&](Cut_surface::Edge e) {
      return CGAL::squared_distance(mesh.point(mesh.vertex(e, 0)), mesh.point(mesh.vertex(e, 1))) ==
             0;
    });
  }

  void set_border_points(const std::vector<Cut_graph::Side>& sides,
                         const std::vector<Point_2>& corners)
  {
    m_border.clear();
    m_border_points.assign(m_surface->mesh().number_of_halfedges(), Point_2(0, 0));
    for(std::size_t i = 0; i < sides.size(); ++i)
    {
      std::vector<Halfedge> run = m_surface->arcs()[sides[i].arc];
      if(!sides[i].is_forward)
      {
        std::reverse(run.begin(), run.end());
        for(Halfedge& h : run)
          h = m_surface->mesh().opposite(h);
      }
      double length = 0, passed = 0;
      for(const Halfedge h : run)
        length += m_surface->length(h);
      const Point_2 &from = corners[i], &to = corners[(i + 1) % corners.size()];
      for(const Halfedge h : run)
      {
        passed += m_surface->length(h);
        m_border_points[h] = h == run.back() ? to : from + (passed / length) * (to - from);
        m_border.push_back(h);
      }
    }
  }

  template <typename Parameterizer>
  bool run(Parameterizer parameterizer)
  {
    namespace SMP = CGAL::Surface_mesh_parameterization;
    Mesh& mesh = m_surface->mesh();
    Vertex_map is_on_seam = mesh.add_property_map<Vertex, bool>("v:is_on_seam", false).first;
    auto uv = mesh.add_property_map<Halfedge, Point_2>("h:uv").first;
    Edge_map is_seam = m_surface->is_cut();
    for(const Cut_surface::Edge e : mesh.edges())
      if(is_seam[e])
        is_on_seam[mesh.vertex(e, 0)] = is_on_seam[mesh.vertex(e, 1)] = true;
    Seam_mesh disk(mesh, is_seam, is_on_seam);
    typedef typename boost::graph_traits<Seam_mesh>::halfedge_descriptor Disk_halfedge;
    const Halfedge h = m_border.front();
    const Disk_halfedge border(h, !mesh.is_border(h));
    const bool is_solved = SMP::parameterize(disk, parameterizer, border, uv) == SMP::OK;
    m_points.assign(mesh.number_of_halfedges(), Point_2(0, 0));
    if(is_solved)
      for(const Halfedge g : mesh.halfedges())
        if(!mesh.is_border(g))
          m_points[g] = uv[target(Disk_halfedge(g, false), disk)];
    mesh.remove_property_map(uv);
    mesh.remove_property_map(is_on_seam);
    return is_solved && is_bijective();
  }

  // Triangles that all have the same orientation and a simple boundary: the map is one-to-one.
  bool is_bijective() const
  {
    const Mesh& mesh = m_surface->mesh();
    for(const Mesh::Face_index f : mesh.faces())
    {
      const Halfedge h = mesh.halfedge(f);
      const Point_2 &a = m_points[h], &b = m_points[mesh.next(h)], &c = m_points[mesh.prev(h)];
      if(!std::isfinite(a.x() + a.y()) || CGAL::orientation(a, b, c) != CGAL::LEFT_TURN)
        return false;
    }
    std::vector<Point_2> boundary;
    for(const Halfedge h : m_border)
      boundary.push_back(m_border_points[h]);
    return CGAL::is_simple_2(boundary.begin(), boundary.end(), Cut_surface::Kernel());
  }

  Cut_surface* m_surface = nullptr;
  std::vector<Halfedge> m_border;
  std::vector<Point_2> m_border_points; // per half-edge of the border: where its target is
  std::vector<Point_2> m_points;        // per half-edge of a face: where its target is
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_POLYGON_FLATTENING_H
