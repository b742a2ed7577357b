// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_ANGLE_STATISTICS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_ANGLE_STATISTICS_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/internal/support/for_each_block.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The smallest angles of faces, their mean and minimum, and the energy, updated as a few faces change.
template <typename Densities>
class Angle_statistics
{
public:
  // `densities`: those of the energy
  Angle_statistics(const Optimization_state& state, const Densities& densities)
    : m_state(state),
      m_densities(densities)
  {}

  // per face: its smallest; 180 if none of its vertices may move
  const std::vector<double>& angles() const { return m_angles; }
  double minimum() const { return m_minimum; }                 // of all faces that may change
  double number_of_faces() const { return m_number_of_faces; } // that are optimized

  // The angle sum at a vertex bounds the smallest angle of the faces around it: the least of the angles
  // there is their mean at most, and the largest, the mean at least, leaves the rest to the other two of
  // its face.
  double angle_bound(int f) const
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const auto position = [&](int v) -> const Vector_3& { return m_state.vertices[v].position; };
    double least = 60;
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      least = (std::min)(least, vertex_angle_bound(mesh, position, mesh.corner_vertex[c]));
    return least;
  }

  static constexpr double negligible = 0.01; // degrees
  bool can_improve(int f) const { return m_angles[f] <= angle_bound(f) - negligible; }

  double mean() const { return m_sum / m_number_of_faces; }
  double energy() const { return m_energy + energy_of_stencils(m_state); }

  template <typename ConcurrencyTag>
  void measure_all()
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const int n = mesh.number_of_faces();
    m_angles.assign(n, 0);
    std::vector<double> angles(n);
    m_number_of_faces = 0;
    for(int f = 0; f < n; ++f)
      m_number_of_faces += m_state.is_optimized(f);
    m_energies.resize(n);
    for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
      for(int f = begin; f < end; ++f)
      {
        angles[f] = m_state.is_optimized(f) ? smallest_angle(f) : 0;
        m_energies[f] = face_energy(f);
        bool may_change = false;
        for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
          may_change = may_change || m_state.is_free[mesh.corner_vertex[c]];
        m_angles[f] = may_change ? angles[f] : 180;
      }
    });
    m_sum = 0;
    for(const double angle : angles)
      m_sum += angle;
    m_energy = 0;
    for(const double energy : m_energies)
      m_energy += energy;
    m_minimum = *std::min_element(m_angles.begin(), m_angles.end());
  }

  // again, where the mesh may have changed
  void measure(const std::vector<int>& faces)
  {
    for(const int f : faces)
      if(m_angles[f] < 180)
      {
        const double angle = smallest_angle(f);
        m_sum += angle - m_angles[f];
        m_angles[f] = angle;
        const double energy = face_energy(f);
        m_energy += energy - m_energies[f];
        m_energies[f] = energy;
      }
    m_minimum = *std::min_element(m_angles.begin(), m_angles.end());
  }

private:
  double face_energy(int f) const
  {
    const auto vertex = [&](int v) -> const Located_vertex& { return m_state.vertices[v]; };
    double sum = 0;
    for(int e = m_state.elements.begin(f); e < m_state.elements.end(f); ++e)
      sum += element_energy(m_densities, m_state.elements[e], vertex);
    return sum;
  }

  double smallest_angle(int f) const
  {
    const auto vertex = [&](int v) -> const Located_vertex& { return m_state.vertices[v]; };
    if(m_state.elements.begin(f) == m_state.elements.end(f))
      return 180; // not optimized
    return degrees_per_radian *
           std::acos((std::min)(1., smallest_angle_cosine(m_state.mesh, vertex, f)));
  }

  const Optimization_state& m_state;
  const Densities& m_densities;
  std::vector<double> m_angles, m_energies; // per face
  double m_number_of_faces = 0;             // that are optimized
  double m_energy = 0;                      // of all
  double m_minimum = 0;                     // of all faces that may change
  double m_sum = 0;                         // of all
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_ANGLE_STATISTICS_H
