// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_FINISHING_STAGE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_FINISHING_STAGE_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/active_set.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/worst_faces.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Raises the smallest angle of a mesh with the help of a barrier on the angles below a target
// (Angle_barrier_density), on small patches around the faces with such angles; the energy is what it
// was everywhere else. What can be reached is not known beforehand: the target runs ahead of the
// smallest angle, by less where that does not follow. A face that lags behind is given wider
// surroundings first, up to a few rings: most need none. The best state is kept. Effort is bounded by what
// it gains: passes live on credit.
template <typename ConcurrencyTag>
class Finishing_stage
{
public:
  struct Goal
  {
    double target;    // of the barrier, in degrees
    double steepness; // of the barrier, per degree
    double sharpest;  // cosine of the angle below which none may fall
    double searched;  // cosine of the angle below which a search takes over where Newton steps end
  };

  struct Faces
  {
    std::vector<int> list;
    std::vector<char> is_in; // per face of the mesh
  };

  // `energy(f)` is that of a face; their sum and that of stencils may rise, but not beyond `largest_energy`.
  Finishing_stage(const Optimization_state& state,
                  std::function<double(int)> energy,
                  double largest_energy,
                  Interruption* interruption = nullptr)
    : m_state(state),
      m_interruption(interruption),
      m_face_energy(std::move(energy)),
      m_largest_energy(largest_energy)
  {}

  // `visit(faces, goal, searches)` optimizes these faces; false if it was cut short. `save()`
  // and `restore()` keep a state to which the stage returns.
  template <typename Visit, typename Save, typename Restore>
  void run(const Visit& visit, const Save& save, const Restore& restore)
  {
    measure_all();
    const double first_mean = mean(), largest_loss = 0.2;
    const double largest_step = 2, equilateral = 60; // degrees
    double step = largest_step;
    const double first_minimum = m_minimum;
    double best = m_minimum;
    const int maximum_passes = 100;
    bool goes_on = true;
    m_credit = largest_credit;
    m_left.assign(m_angles.size(), Left());
    save();
    for(int pass = 0; goes_on && m_credit > 0 && pass < maximum_passes; ++pass)
    {
      if(step < smallest_step || m_minimum > equilateral - smallest_step)
        break;
      const auto lowest = std::min_element(m_angles.begin(), m_angles.end()) - m_angles.begin();
      if(!can_rise(int(lowest)))
        break;
      const double minimum = m_minimum, mean_before = mean();
      // far beyond what the sharpest can reach the barrier would only harm those around it
      const double feasible = bound(int(lowest)) + 0.2;
      const double target = (std::min)({minimum + step, feasible, equilateral});
      const double ahead = target - minimum;
      const double lagging = minimum + 0.2 * ahead, enough = minimum + 0.3 * ahead;
      // a little is lent to the neighbours of the sharpest, which would be in the way otherwise
      const double lent = (std::max)(first_minimum, minimum - 0.5 * ahead);
      // The closer the target, the steeper: the angles of a star that is at its limit are then evened out.
      const double steepness = (std::min)(steepest, (std::max)(flattest, 12 / ahead));
      const Goal goal{target, steepness, cosine(lent), cosine(lagging)};
      goes_on = visit_below(target, goal, false, visit);
      if(goes_on && m_minimum < lagging)
        goes_on = search_below(lagging, goal, visit);
      const double price = 0.02 + 0.05 * (m_minimum - minimum);
      const bool holds = mean() > first_mean - largest_loss && mean() > mean_before - price &&
                         energy() <= m_largest_energy;
      if(!holds)
      {
        restore();
        measure_touched();
        step *= 0.25;
      }
      else
      {
        const double gain = (std::max)(0., m_minimum - best) + (std::max)(0., mean() - mean_before);
        m_credit = (std::min)(largest_credit, m_credit + worth * gain);
        if(m_minimum > best)
        {
          save();
          m_touched.clear();
          best = m_minimum;
        }
        if(m_minimum > minimum + 0.8 * ahead)
          step = (std::min)(largest_step, 2 * step);
        else if(m_minimum < enough)
        {
          const bool widens = widen(enough);
          if(!widens || m_minimum <= minimum)
            step = (widens ? 0.8 : 0.25) * ahead;
        }
      }
    }
    if(m_minimum < best)
    {
      restore();
      measure_touched();
    }
    if(goes_on)
      polish(visit, save, restore);
  }

private:
  static constexpr double smallest_step = 0.03, negligible = 0.01; // degrees
  static constexpr double flattest = 6, steepest = 30;             // per degree
  // in visits to as many faces as the mesh has: what passes may cost before they gain, and what a degree
  // of the minimum or of the mean is worth
  static constexpr double largest_credit = 8, worth = 16;

  // Wins back what the mean lost on the way, and more, while the minimum is only held: small patches
  // gain a little everywhere where the large ones before the stage have come to rest.
  template <typename Visit, typename Save, typename Restore>
  void polish(const Visit& visit, const Save& save, const Restore& restore)
  {
    const int maximum_passes = 4;
    const double enough = 0.002, calm = 0.1; // degrees: of the mean, and of an angle
    std::vector<char> is_wanted(m_angles.size());
    for(std::size_t f = 0; f < is_wanted.size(); ++f)
      is_wanted[f] = m_angles[f] < 180;
    for(int pass = 0; pass < maximum_passes; ++pass)
    {
      const double minimum = m_minimum, mean_before = mean();
      const std::vector<double> before = m_angles;
      save();
      m_touched.clear();
      want(is_wanted);
      const Goal goal{minimum, flattest, cosine(minimum), cosine(minimum)};
      const bool goes_on = visit_wanted(goal, false, visit);
      if(m_minimum < minimum || mean() < mean_before || energy() > m_largest_energy)
      {
        restore();
        return;
      }
      if(!goes_on || mean() < mean_before + enough)
        return;
      for(std::size_t f = 0; f < before.size(); ++f)
        is_wanted[f] = std::abs(m_angles[f] - before[f]) > calm;
      is_wanted = faces_around<ConcurrencyTag>(
        m_state.mesh, vertices_of<ConcurrencyTag>(m_state.mesh, is_wanted), 1);
    }
  }

  static constexpr double cost_of_search = 200; // for a face, in visits to one

  // of a face after it was searched: its angle, and the surroundings that it had
  struct Left
  {
    double angle = -1;
    int rings = 0;
  };

  void want(const std::vector<char>& is_wanted)
  {
    m_wanted.is_in = is_wanted;
    m_wanted.list.clear();
    for(std::size_t f = 0; f < is_wanted.size(); ++f)
      if(is_wanted[f])
        m_wanted.list.push_back(int(f));
  }

  template <typename Visit>
  bool visit_below(double angle, const Goal& goal, bool searches, const Visit& visit)
  {
    find_below(angle);
    return visit_wanted(goal, searches, visit);
  }

  // Searches around the faces with an angle below the given one, if they are few: around those that are
  // below what many have. What a search has left, the next one with the same surroundings would leave, too.
  template <typename Visit>
  bool search_below(double angle, Goal goal, const Visit& visit)
  {
    const int useful_rings = 3; // it moves the vertices of a face and those around them
    const std::size_t most = number_of_exceptions(m_state.mesh);
    std::vector<double> low;
    for(std::size_t f = 0; f < m_angles.size(); ++f)
      if(m_angles[f] < angle && can_rise(int(f)))
        low.push_back(m_angles[f]);
    if(low.size() > most)
    {
      std::nth_element(low.begin(), low.begin() + most, low.end());
      angle = low[most] - negligible;
      goal.searched = cosine(angle);
    }
    const auto is_left = [&](int f) {
      return m_left[f].rings >= (std::min)(useful_rings, int(m_rings[f])) &&
             std::abs(m_left[f].angle - m_angles[f]) < negligible;
    };
    find_below(angle);
    if(std::all_of(m_low.begin(), m_low.end(), is_left))
      return true;
    m_credit -= cost_of_search * double(m_low.size()) / m_number_of_faces;
    const bool goes_on = visit_wanted(goal, true, visit);
    for(const int f : m_low)
      m_left[f] = {m_angles[f], int(m_rings[f])};
    return goes_on;
  }

  template <typename Visit>
  bool visit_wanted(const Goal& goal, bool searches, const Visit& visit)
  {
    m_credit -= double(m_wanted.list.size()) / m_number_of_faces;
    const bool goes_on = visit(m_wanted, goal, searches);
    m_touched.insert(m_touched.end(), m_wanted.list.begin(), m_wanted.list.end());
    measure(m_wanted.list);
    return goes_on;
  }

  // wants the faces with an angle below the given one, and the rings around each that it needs
  void find_below(double angle)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    m_wanted.list.clear();
    m_wanted.is_in.assign(m_angles.size(), 0);
    const auto add = [&](int f) {
      if(!m_wanted.is_in[f])
      {
        m_wanted.is_in[f] = 1;
        m_wanted.list.push_back(f);
      }
    };
    m_low.clear();
    int rings = 0;
    for(std::size_t f = 0; f < m_angles.size(); ++f)
    {
      check_now_and_then(m_interruption, int(f));
      if(m_angles[f] < angle && can_rise(int(f)))
      {
        m_low.push_back(int(f));
        rings = (std::max)(rings, int(m_rings[f]));
      }
    }
    check(m_interruption);
    for(; rings > 0; --rings)
    {
      for(const int f : m_low)
        if(m_rings[f] >= rings)
          add(f);
      for(std::size_t i = 0, end = m_wanted.list.size(); i < end; ++i)
        for(int c = mesh.face_begin[m_wanted.list[i]]; c < mesh.face_begin[m_wanted.list[i] + 1];
            ++c)
        {
          const int v = mesh.corner_vertex[c];
          for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
            add(mesh.corner_face[mesh.vertex_corners[k]]);
        }
    }
  }

  // more rings around the faces with an angle below the given one; false if they have enough
  bool widen(double angle)
  {
    const int most = 8; // it is for a few faces only
    bool widens = false;
    for(std::size_t f = 0; f < m_angles.size(); ++f)
      if(m_angles[f] < angle && m_rings[f] < most)
      {
        ++m_rings[f];
        widens = true;
      }
    return widens;
  }

  // A vertex bounds the smallest angle of the faces around it, as long as the sum of the angles there
  // stays: the least of these is their mean at most, and the largest, the mean at least, leaves no more
  // for the other two of its face.
  double bound(int f) const
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const auto position = [&](int v) -> const Vector_3& { return m_state.vertices[v].position; };
    double least = 60;
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      least = (std::min)(least, shared_angle(mesh, position, mesh.corner_vertex[c]));
    return least;
  }

  bool can_rise(int f) const { return m_angles[f] <= bound(f) - negligible; }

  static double cosine(double degrees) { return std::cos(degrees / degrees_per_radian); }
  double mean() const { return m_sum / m_number_of_faces; }
  double energy() const { return m_energy + energy_of_stencils(m_state); }

  // of a face
  double smallest_angle(int f) const
  {
    const auto vertex = [&](int v) -> const Placed_vertex& { return m_state.vertices[v]; };
    if(m_state.elements.begin(f) == m_state.elements.end(f))
      return 180; // it is none of the stage's
    return degrees_per_radian *
           std::acos((std::min)(1., smallest_angle_cosine(m_state.mesh, vertex, f)));
  }

  void measure_all()
  {
    const Indexed_mesh& mesh = m_state.mesh;
    const int n = mesh.number_of_faces();
    m_angles.assign(n, 0);
    m_rings.assign(n, 1);
    std::vector<double> angles(n);
    m_number_of_faces = 0;
    for(int f = 0; f < n; ++f)
      m_number_of_faces += m_state.counts(f);
    m_energies.resize(n);
    for_each_block<ConcurrencyTag>(n, [&](int begin, int end, int) {
      for(int f = begin; f < end; ++f)
      {
        angles[f] = m_state.counts(f) ? smallest_angle(f) : 0;
        m_energies[f] = m_face_energy(f);
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
        const double energy = m_face_energy(f);
        m_energy += energy - m_energies[f];
        m_energies[f] = energy;
      }
    m_minimum = *std::min_element(m_angles.begin(), m_angles.end());
  }
  void measure_touched()
  {
    measure(m_touched);
    m_touched.clear();
  }

  const Optimization_state& m_state;
  Interruption* m_interruption;
  const std::function<double(int)> m_face_energy;
  const double m_largest_energy;
  std::vector<double> m_angles; // per face: its smallest; 180 if none of its vertices may move
  std::vector<unsigned char> m_rings; // per face: what surroundings it needs
  std::vector<double> m_energies;     // per face
  double m_number_of_faces = 0;       // that are to be optimized
  double m_energy = 0;                // of all
  double m_minimum = 0;               // of all faces that may change
  double m_sum = 0;                   // of all
  double m_credit = 0;
  std::vector<Left> m_left; // per face
  Faces m_wanted;
  std::vector<int> m_low;
  std::vector<int> m_touched; // faces that are not as they were when saved
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_FINISHING_STAGE_H
