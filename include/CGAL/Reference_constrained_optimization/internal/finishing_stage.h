// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FINISHING_STAGE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FINISHING_STAGE_H

#include <CGAL/Reference_constrained_optimization/internal/active_set.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Whether all elements are triangles with an equilateral triangle at rest: then angles are what the
// energy is about.
inline bool prizes_angles(const Element_set& elements)
{
  for(int e = 0; e < elements.size(); ++e)
  {
    if(elements[e].is_in_quad)
      return false;
    const Eigen::Matrix2d rest = elements[e].rest_inverse.inverse();
    const double a = rest.col(0).norm(), b = rest.col(1).norm();
    const double c = (rest.col(1) - rest.col(0)).norm();
    if(std::abs(a - b) > 1e-9 * a || std::abs(a - c) > 1e-9 * a)
      return false;
  }
  return elements.size() > 0;
}

// Raises the smallest angle of a mesh with the help of a barrier on the angles below a target
// (Angle_barrier_density), on patches around the faces with such angles; the energy is what it was
// everywhere else. What can be reached is not known beforehand, and a target out of reach does harm:
// it rises in steps, each of which must pay, else it is taken back and a smaller one tried.
class Finishing_stage
{
public:
  struct Goal
  {
    double target;   // of the barrier, in degrees
    double sharpest; // cosine of the angle below which none may fall
    double searched; // cosine of the angle below which a search takes over where Newton steps end
  };

  explicit Finishing_stage(const Optimization_state& state) : m_state(state) {}

  // `visit(is_wanted, goal, searches)` optimizes the wanted faces; false if it was cut short. `save()`
  // and `restore()` keep a state to which a step returns.
  template <typename Visit, typename Save, typename Restore>
  void run(const Visit& visit, const Save& save, const Restore& restore)
  {
    measure();
    const double first_mean = m_mean;
    const double largest_step = 4, smallest_step = 0.1, equilateral = 60; // degrees
    double step = largest_step;
    while(step >= smallest_step && m_minimum < equilateral - smallest_step)
    {
      const double minimum = m_minimum, mean = m_mean;
      save();
      const bool goes_on = take_step((std::min)(minimum + step, equilateral), visit);
      const bool rises = m_minimum > minimum + 0.1 * step;
      const bool holds = m_mean > mean - 0.05 && m_mean > first_mean - 0.2;
      if(!rises || !holds)
      {
        restore();
        measure();
        step *= 0.25;
      }
      else if(m_minimum < minimum + 0.8 * step)
        step *= 0.5;
      if(!goes_on)
        return;
    }
  }

private:
  static constexpr double degrees_per_radian = 57.295779513082320877;

  template <typename Visit>
  bool take_step(double target, const Visit& visit)
  {
    const double minimum = m_minimum, step = target - minimum;
    const Goal goal{target, cosine(minimum), cosine(minimum + 0.5 * step)};
    const int maximum_passes = 3;
    for(int pass = 0; pass < maximum_passes && m_minimum < target - 0.2 * step; ++pass)
    {
      if(!visit(faces_below(target + 1, 3), goal, false))
        return false;
      measure();
    }
    if(m_minimum >= minimum + 0.5 * step)
      return true;
    const bool goes_on = visit(faces_below(minimum + 0.5 * step, 3), goal, true);
    measure();
    return goes_on;
  }

  // the faces with an angle below the given one, and some rings around them
  std::vector<char> faces_below(double angle, int rings) const
  {
    const Indexed_mesh& mesh = m_state.mesh;
    std::vector<char> is_low(m_angles.size(), 0);
    for(std::size_t f = 0; f < m_angles.size(); ++f)
      is_low[f] = m_angles[f] < angle;
    return faces_around(mesh, vertices_of(mesh, is_low), rings);
  }

  static double cosine(double degrees) { return std::cos(degrees / degrees_per_radian); }

  // the smallest angle of every face, of all faces that may change, and the mean
  void measure()
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const auto vertex = [&](int v) -> const Placed_vertex& { return m_state.vertices[v]; };
    m_angles.resize(mesh.number_of_faces());
    m_minimum = 180;
    m_mean = 0;
    for(int f = 0; f < mesh.number_of_faces(); ++f)
    {
      double cosine = -1;
      for(int e = m_state.elements.begin(f); e < m_state.elements.end(f); ++e)
        cosine = (std::max)(cosine, smallest_angle_cosine(m_state.elements[e], vertex));
      m_angles[f] = degrees_per_radian * std::acos((std::min)(1., cosine));
      m_mean += m_angles[f];
      bool may_change = false;
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        may_change = may_change || m_state.is_free[mesh.corner_vertex[c]];
      if(may_change)
        m_minimum = (std::min)(m_minimum, m_angles[f]);
      else
        m_angles[f] = 180;
    }
    m_mean /= double(m_angles.size());
  }

  const Optimization_state& m_state;
  std::vector<double> m_angles; // per face; 180 if none of its vertices may move
  double m_minimum = 0, m_mean = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FINISHING_STAGE_H
