#pragma once

// What CGAL's Polygon_mesh_processing has that improves triangles. Functions with a number of
// iterations are tried with several, and the one that ends with the largest minimum angle is kept.

#include "../meshes.h"
#include "Mesh_on_reference.h"
#include "Peer_result.h"

#include <CGAL/Polygon_mesh_processing/angle_and_area_smoothing.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/tangential_relaxation.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/angles.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/distance_to_reference.h>

#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

// The best result of several numbers of iterations: the one with the largest minimum angle, and with the
// largest mean where a face that cannot move determines the minimum.
class Best_result
{
public:
  void add(const Peer_result& result)
  {
    const auto angles = RCO::angle_statistics(result.mesh);
    const double rounding = 1e-6;
    const std::pair<double, double> quality(std::round(angles.minimum / rounding), angles.mean);
    if(quality > m_quality)
    {
      m_quality = quality;
      m_result = result;
    }
  }
  const Peer_result& get() const { return m_result; }

private:
  Peer_result m_result;
  std::pair<double, double> m_quality = {-1, 0};
};

constexpr unsigned int tried_numbers_of_iterations[] = {1, 5, 10, 20, 50};

inline std::string iterations_text(unsigned int n)
{
  return std::to_string(n) + (n == 1 ? " iteration" : " iterations");
}

// The angle smoothing of CGAL (its area smoothing needs another library). With safety constraints it
// stops where it is, off the surface, once the mesh intersects itself; what is left off the
// reference is projected here.
inline Peer_result smooth_angles(const Mesh& input, bool with_safety_constraints, double time_limit)
{
  const Stopwatch all;
  Best_result best;
  double seconds_per_iteration = 0;
  for(const unsigned int n : tried_numbers_of_iterations)
  {
    if(all.seconds() + n * seconds_per_iteration > time_limit)
      break;
    Peer_result result = timed(input, [&](Mesh& mesh) {
      CGAL::Polygon_mesh_processing::angle_and_area_smoothing(
        mesh,
        CGAL::parameters::number_of_iterations(n).use_area_smoothing(false).use_safety_constraints(
          with_safety_constraints));
      return iterations_text(n);
    });
    const auto off = RCO::distance_to_reference(result.mesh, input);
    if(!off.is_on_reference())
    {
      const Stopwatch projection;
      Mesh_on_reference on_reference(input);
      on_reference.take_globally(result.mesh);
      on_reference.give(result.mesh);
      result.seconds += projection.seconds();
      char text[64];
      std::snprintf(text, sizeof text, ", left R by %.2g edges",
                    off.maximum / on_reference.mean_edge_length());
      result.note += text;
    }
    seconds_per_iteration = (std::max)(seconds_per_iteration, result.seconds / n);
    best.add(result);
  }
  return best.get();
}

// keeps CGAL's relaxation from lowering the smallest angle of a star, and from inverting a face of it
class Star_guard
{
public:
  explicit Star_guard(const Mesh& mesh) : m_mesh(&mesh) {}

  bool
  operator()(Mesh::Vertex_index v, const Kernel::Point_3& from, const Kernel::Point_3& to) const
  {
    double before = 180, after = 180;
    for(const Mesh::Halfedge_index h : CGAL::halfedges_around_target(v, *m_mesh))
    {
      if(m_mesh->is_border(h))
        continue;
      const Kernel::Point_3& b = m_mesh->point(m_mesh->target(m_mesh->next(h)));
      const Kernel::Point_3& c = m_mesh->point(m_mesh->source(h));
      if(CGAL::cross_product(b - from, c - from) * CGAL::cross_product(b - to, c - to) <= 0)
        return false;
      before = (std::min)(before, smallest_angle(from, b, c));
      after = (std::min)(after, smallest_angle(to, b, c));
    }
    return after >= before;
  }

private:
  static double
  smallest_angle(const Kernel::Point_3& a, const Kernel::Point_3& b, const Kernel::Point_3& c)
  {
    return (std::min)({CGAL::approximate_angle(b, a, c), CGAL::approximate_angle(c, b, a),
                       CGAL::approximate_angle(a, c, b)});
  }

  const Mesh* m_mesh;
};

// CGAL's tangential relaxation, each iteration followed by a projection
inline Peer_result relax(const Mesh& input, bool with_guard, double time_limit)
{
  Best_result best;
  Mesh mesh = input;
  const Stopwatch setup;
  Mesh_on_reference on_reference(input);
  double seconds = setup.seconds();
  unsigned int done = 0;
  for(const unsigned int n : tried_numbers_of_iterations)
  {
    const Stopwatch watch;
    for(; done < n && seconds + watch.seconds() < time_limit; ++done)
    {
      if(with_guard)
        CGAL::Polygon_mesh_processing::tangential_relaxation(
          mesh, CGAL::parameters::allow_move_functor(Star_guard(mesh)));
      else
        CGAL::Polygon_mesh_processing::tangential_relaxation(mesh);
      on_reference.take(mesh);
      on_reference.give(mesh);
    }
    seconds += watch.seconds();
    best.add({mesh, seconds, iterations_text(done)});
  }
  return best.get();
}

// CGAL's isotropic remeshing, to edges as long as they are on average; border edges stay
inline Peer_result remesh(const Mesh& input)
{
  const double mean_edge_length = Mesh_on_reference(input).mean_edge_length();
  return timed(input, [&](Mesh& mesh) {
    const unsigned int number_of_iterations = 10;
    CGAL::Polygon_mesh_processing::isotropic_remeshing(
      faces(mesh), mean_edge_length, mesh,
      CGAL::parameters::number_of_iterations(number_of_iterations).protect_constraints(true));
    mesh.collect_garbage();
    return iterations_text(number_of_iterations);
  });
}
