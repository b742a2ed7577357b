// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_PATCH_FLATTENING_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_PATCH_FLATTENING_H

#include <CGAL/Reference_constrained_optimization/Symmetric_Dirichlet_density.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/injectivity.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/planar_optimization.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/surface_metric.h>
#include <CGAL/Reference_constrained_optimization/internal/support/compatibility.h>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/Barycentric_mapping_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Circular_border_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Mean_value_coordinates_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

enum class Flattening_path {
  conformal,     // found to be injective
  convex_border, // onto a disk, then symmetric Dirichlet descent with a free border
  failed
};

struct Flattening
{
  std::vector<Vector_2> positions; // per vertex; of the same total area as the patch
  Flattening_path path = Flattening_path::failed;
  double distortion = 0; // area-weighted mean of the symmetric Dirichlet density (4: isometric)
};

// Which parameterizations are used; the paper's is the second alone.
struct Flattening_parameters
{
  bool use_conformal = true;
  bool use_mean_value = true;               // on a convex border, before equal weights are tried
  double largest_conformal_distortion = 20; // distortion beyond which a conformal map is not used
  // A conformal map shrinks the ends of long patches, where results are then inaccurate: the distortion is
  // minimized until it is below this.
  double target_distortion = 4.05;
  int maximum_descent_steps = 25;
  double descent_tolerance = 1e-2; // the relative decrease that ends the minimization
};

// Flattens a disk of triangles (paper 3.2) with CGAL's Surface_mesh_parameterization: conformally, or onto a
// convex border. What it returns is locally injective by an exact check. The border may cross itself: points
// are located by walking within a sheet, which is not affected.
class Patch_flattener
{
  typedef CGAL::Simple_cartesian<double> Kernel;
  typedef CGAL::Surface_mesh<Kernel::Point_3> Surface_mesh;
  typedef Surface_mesh::Vertex_index Vertex;
  typedef Surface_mesh::Halfedge_index Halfedge;
  typedef Surface_mesh::Property_map<Vertex, Kernel::Point_2> Uv_map;

public:
  explicit Patch_flattener(Interruption* interruption = nullptr)
    : m_interruption(interruption),
      m_optimizer(interruption)
  {}

  Flattening flatten(const Indexed_mesh& triangles,
                     const std::vector<Vector_3>& points,
                     const Flattening_parameters& parameters = Flattening_parameters())
  {
    namespace SMP = CGAL::Surface_mesh_parameterization;
    typedef SMP::Circular_border_arc_length_parameterizer_3<Surface_mesh> Arc_length_border;
    typedef SMP::Circular_border_uniform_parameterizer_3<Surface_mesh> Uniform_border;

    Flattening flattening;
    compute_shapes(triangles, points);
    if(!(m_area > 0) || !build(triangles, points))
      return flattening;

    const auto is_parameterized = [&](const auto& parameterizer) {
      return run(parameterizer, flattening.positions) && is_usable(triangles, flattening.positions);
    };
    bool is_conformal =
      parameters.use_conformal && is_parameterized(SMP::LSCM_parameterizer_3<Surface_mesh>());
    check(m_interruption);
    if(is_conformal)
    {
      flattening.distortion = distortion(triangles, flattening.positions);
      is_conformal = flattening.distortion < parameters.largest_conformal_distortion;
    }
    const bool is_usable_start =
      is_conformal ||
      (parameters.use_mean_value && !m_has_degenerate_edge && // its weights are not defined there
       is_parameterized(
         SMP::Mean_value_coordinates_parameterizer_3<Surface_mesh, Arc_length_border>())) ||
      is_parameterized(SMP::Barycentric_mapping_parameterizer_3<Surface_mesh, Uniform_border>());
    if(!is_usable_start)
      return flattening;
    check(m_interruption);
    flattening.path = is_conformal ? Flattening_path::conformal : Flattening_path::convex_border;
    if(flattening.path == Flattening_path::convex_border ||
       flattening.distortion > parameters.target_distortion)
    {
      const std::vector<Vector_2> start = flattening.positions;
      minimize_distortion(triangles, flattening.positions, parameters);
      if(!is_locally_injective(triangles, flattening.positions))
        flattening.positions = start;
      flattening.distortion = distortion(triangles, flattening.positions);
    }
    return flattening;
  }

private:
  // shapes of the triangles in space; degenerate ones are given an area, so that they can be approached
  void compute_shapes(const Indexed_mesh& triangles, const std::vector<Vector_3>& points)
  {
    m_shapes.clear();
    m_area = 0;
    double shortest = std::numeric_limits<double>::infinity();
    for(int t = 0; t < triangles.number_of_faces(); ++t)
    {
      const int* v = &triangles.corner_vertex[3 * t];
      const Vector_3 &a = points[v[0]], &b = points[v[1]], &c = points[v[2]];
      m_shapes.push_back(triangle_shape(a, b, c));
      m_area += 0.5 * m_shapes.back().determinant();
      shortest = (std::min)({shortest, (b - a).norm(), (c - b).norm(), (a - c).norm()});
    }
    const double mean_length = std::sqrt(m_area / triangles.number_of_faces());
    // it may vanish by rounding when the patch is moved to the origin
    m_has_degenerate_edge = !(shortest > 1e-9 * mean_length);
    for(Eigen::Matrix2d& s : m_shapes)
    {
      s(0, 0) = (std::max)(s(0, 0), 0.01 * mean_length);
      s(1, 1) = (std::max)(s(1, 1), 0.01 * (std::max)(mean_length, s(0, 0)));
    }
  }

  // CGAL's mesh of the patch, moved to the origin and scaled to unit area. False if there is no border, or
  // if two edges join the same vertices, as diagonals of quads may do: such a patch has no injective flattening.
  bool build(const Indexed_mesh& triangles, const std::vector<Vector_3>& points)
  {
    m_mesh.clear();
    m_mesh.reserve(Surface_mesh::size_type(points.size()),
                   Surface_mesh::size_type(3 * points.size()),
                   Surface_mesh::size_type(triangles.number_of_faces()));
    const double scale = 1 / std::sqrt(m_area);
    for(const Vector_3& p : points)
    {
      const Vector_3 q = scale * (p - points.front());
      m_mesh.add_vertex(Kernel::Point_3(q.x(), q.y(), q.z()));
    }
    for(int t = 0; t < triangles.number_of_faces(); ++t)
    {
      const int* v = &triangles.corner_vertex[3 * t];
      if(m_mesh.add_face(Vertex(v[0]), Vertex(v[1]), Vertex(v[2])) == Surface_mesh::null_face())
        return false;
    }
    const auto halfedges = m_mesh.halfedges();
    const auto border = std::find_if(halfedges.begin(), halfedges.end(),
                                     [this](Halfedge h) { return m_mesh.is_border(h); });
    if(border == halfedges.end())
      return false;
    m_border = *border;
    return true;
  }

  template <typename Parameterizer>
  bool run(const Parameterizer& parameterizer, std::vector<Vector_2>& u)
  {
    Uv_map uv = m_mesh.add_property_map<Vertex, Kernel::Point_2>("v:uv").first;
    const auto error =
      CGAL::Surface_mesh_parameterization::parameterize(m_mesh, parameterizer, m_border, uv);
    u.clear();
    for(const Vertex v : m_mesh.vertices())
      u.emplace_back(uv[v].x(), uv[v].y());
    m_mesh.remove_property_map(uv);
    return error == CGAL::Surface_mesh_parameterization::OK;
  }

  // Checks injectivity and scales to the area of the patch. A conformal map may shrink the ends of long
  // patches to nothing: such maps are injective, but useless.
  bool is_usable(const Indexed_mesh& triangles, std::vector<Vector_2>& u) const
  {
    if(!is_locally_injective(triangles, u))
      return false;
    double area = 0;
    for(int t = 0; t < triangles.number_of_faces(); ++t)
      area += 0.5 * plane_edges(triangles, u, t).determinant();
    const double scale = std::sqrt(m_area / area);
    if(!(area > 0) || !std::isfinite(scale))
      return false;
    for(Vector_2& p : u)
      p *= scale;
    return true;
  }

  void minimize_distortion(const Indexed_mesh& triangles,
                           std::vector<Vector_2>& u,
                           const Flattening_parameters& parameters)
  {
    Planar_problem problem;
    for(int t = 0; t < triangles.number_of_faces(); ++t)
    {
      const int* v = &triangles.corner_vertex[3 * t];
      problem.triples.push_back({{v[0], v[1], v[2]}});
      problem.rest_inverse.push_back(m_shapes[t].inverse());
      problem.metric.push_back(Eigen::Matrix2d::Identity());
    }
    problem.is_free.assign(u.size(), 1);
    m_optimizer.analyze(problem);
    double current_distortion = distortion(triangles, u);
    for(int step = 0; step < parameters.maximum_descent_steps; ++step)
    {
      // folds open slowly at first
      const double tolerance = current_distortion > 5 ? 1e-6 : parameters.descent_tolerance;
      const Projected_newton::Outcome outcome =
        m_optimizer.minimize(problem, Symmetric_Dirichlet_density(), u, 1, tolerance);
      const double decrease = outcome.initial_energy - outcome.final_energy;
      current_distortion = distortion(triangles, u);
      if(outcome.steps == 0 || decrease < tolerance * outcome.final_energy ||
         current_distortion < parameters.target_distortion)
        return;
    }
  }

  double distortion(const Indexed_mesh& triangles, const std::vector<Vector_2>& u) const
  {
    const Symmetric_Dirichlet_density density;
    double sum = 0, area = 0;
    for(int t = 0; t < triangles.number_of_faces(); ++t)
    {
      const double a = m_shapes[t].determinant();
      sum += a * density.value(plane_edges(triangles, u, t) * m_shapes[t].inverse());
      area += a;
    }
    return sum / area;
  }

  static Eigen::Matrix2d
  plane_edges(const Indexed_mesh& triangles, const std::vector<Vector_2>& u, int t)
  {
    const int* v = &triangles.corner_vertex[3 * t];
    return Planar_problem::edges(u, {{v[0], v[1], v[2]}});
  }

  Interruption* m_interruption;
  Surface_mesh m_mesh;
  Halfedge m_border;
  std::vector<Eigen::Matrix2d> m_shapes;
  double m_area = 0;
  bool m_has_degenerate_edge = false;
  Projected_newton m_optimizer;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FLATTENING_PATCH_FLATTENING_H
