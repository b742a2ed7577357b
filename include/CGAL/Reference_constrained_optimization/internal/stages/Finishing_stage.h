// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_FINISHING_STAGE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_FINISHING_STAGE_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/Angle_barrier_density.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/active_set.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/Angle_statistics.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/Worst_faces_stage.h>
#include <CGAL/Reference_constrained_optimization/internal/stages/saved_state.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <algorithm>
#include <cmath>
#include <limits>
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
template <typename Visits>
class Finishing_stage
{
  typedef typename Visits::ConcurrencyTag ConcurrencyTag;

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

public:
  explicit Finishing_stage(Visits& visits)
    : m_visits(visits),
      m_state(visits.state),
      m_interruption(&visits.interruption),
      m_saved(visits.state, visits.round_solver.drift_guard()),
      m_faces(visits.state, visits.target_densities)
  {}

  // The mean energy may rise on the way, but not beyond that on input. If it is interrupted the mesh
  // returns to what was saved last.
  void run()
  {
    m_visits.round_solver.set_finishing(true);
    m_visits.interruption.check();
    m_visits.settings.limits.density = m_visits.settings.search_density =
      std::numeric_limits<double>::infinity();
    try
    {
      if(raise_minimum())
        polish();
    }
    catch(...)
    {
      m_saved.restore();
      throw;
    }
    m_visits.round_solver.set_finishing(false);
  }

private:
  // false if it was cut short
  bool raise_minimum()
  {
    m_faces.template measure_all<ConcurrencyTag>();
    m_rings.assign(m_faces.angles().size(), 1);
    const double first_mean = m_faces.mean(), largest_loss = 0.2;
    const double largest_step = 2, equilateral = 60; // degrees
    double step = largest_step;
    const double first_minimum = m_faces.minimum();
    double best = m_faces.minimum();
    const int maximum_passes = 100;
    bool goes_on = true;
    m_credit = largest_credit;
    m_left.assign(m_faces.angles().size(), Left());
    m_saved.forget();
    for(int pass = 0; goes_on && m_credit > 0 && pass < maximum_passes; ++pass)
    {
      if(step < smallest_step || m_faces.minimum() > equilateral - smallest_step)
        break;
      const auto lowest = std::min_element(m_faces.angles().begin(), m_faces.angles().end()) -
                          m_faces.angles().begin();
      if(!m_faces.can_rise(int(lowest)))
        break;
      const double minimum = m_faces.minimum(), mean_before = m_faces.mean();
      // far beyond what the sharpest can reach the barrier would only harm those around it
      const double feasible = m_faces.bound(int(lowest)) + 0.2;
      const double target = (std::min)({minimum + step, feasible, equilateral});
      const double ahead = target - minimum;
      const double lagging = minimum + 0.2 * ahead, enough = minimum + 0.3 * ahead;
      // a little is lent to the neighbours of the sharpest, which would be in the way otherwise
      const double lent = (std::max)(first_minimum, minimum - 0.5 * ahead);
      // The closer the target, the steeper: the angles of a star that is at its limit are then evened out.
      const double steepness = (std::min)(steepest, (std::max)(flattest, 12 / ahead));
      const Goal goal{target, steepness, cosine(lent), cosine(lagging)};
      goes_on = visit_below(target, goal, false);
      if(goes_on && m_faces.minimum() < lagging)
        goes_on = search_below(lagging, goal);
      const double price = 0.02 + 0.05 * (m_faces.minimum() - minimum);
      const bool holds = m_faces.mean() > first_mean - largest_loss &&
                         m_faces.mean() > mean_before - price &&
                         m_faces.energy() <= m_visits.initial_energy;
      if(!holds)
      {
        m_saved.restore();
        measure_touched();
        step *= 0.25;
      }
      else
      {
        const double gain =
          (std::max)(0., m_faces.minimum() - best) + (std::max)(0., m_faces.mean() - mean_before);
        m_credit = (std::min)(largest_credit, m_credit + worth * gain);
        if(m_faces.minimum() > best)
        {
          m_saved.forget();
          m_touched.clear();
          best = m_faces.minimum();
        }
        if(m_faces.minimum() > minimum + 0.8 * ahead)
          step = (std::min)(largest_step, 2 * step);
        else if(m_faces.minimum() < enough)
        {
          const bool widens = widen(enough);
          if(!widens || m_faces.minimum() <= minimum)
            step = (widens ? 0.8 : 0.25) * ahead;
        }
      }
    }
    if(m_faces.minimum() < best)
    {
      m_saved.restore();
      measure_touched();
    }
    return goes_on;
  }

  static constexpr double smallest_step = 0.03;        // degrees
  static constexpr double flattest = 6, steepest = 30; // per degree
  // in visits to as many faces as the mesh has: what passes may cost before they gain, and what a degree
  // of the minimum or of the mean is worth
  static constexpr double largest_credit = 8, worth = 16;

  // Wins back what the mean lost on the way, and more, while the minimum is only held: small patches
  // gain a little everywhere where the large ones before the stage have come to rest.
  void polish()
  {
    const int maximum_passes = 4;
    const double enough = 0.002, calm = 0.1; // degrees: of the mean, and of an angle
    std::vector<char> is_wanted(m_faces.angles().size());
    for(std::size_t f = 0; f < is_wanted.size(); ++f)
      is_wanted[f] = m_faces.angles()[f] < 180;
    for(int pass = 0; pass < maximum_passes; ++pass)
    {
      const double minimum = m_faces.minimum(), mean_before = m_faces.mean();
      const std::vector<double> before = m_faces.angles();
      m_saved.forget();
      m_touched.clear();
      want(is_wanted);
      const Goal goal{minimum, flattest, cosine(minimum), cosine(minimum)};
      const bool goes_on = visit_wanted(goal, false);
      if(m_faces.minimum() < minimum || m_faces.mean() < mean_before ||
         m_faces.energy() > m_visits.initial_energy)
      {
        m_saved.restore();
        return;
      }
      if(!goes_on || m_faces.mean() < mean_before + enough)
        return;
      for(std::size_t f = 0; f < before.size(); ++f)
        is_wanted[f] = std::abs(m_faces.angles()[f] - before[f]) > calm;
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

  bool visit_below(double angle, const Goal& goal, bool searches)
  {
    find_below(angle);
    return visit_wanted(goal, searches);
  }

  // Searches around the faces with an angle below the given one, if they are few: around those that are
  // below what many have. What a search has left, the next one with the same surroundings would leave, too.
  bool search_below(double angle, Goal goal)
  {
    const int useful_rings = 3; // it moves the vertices of a face and those around them
    const std::size_t most = number_of_exceptions(m_state.mesh);
    std::vector<double> low;
    for(std::size_t f = 0; f < m_faces.angles().size(); ++f)
      if(m_faces.angles()[f] < angle && m_faces.can_rise(int(f)))
        low.push_back(m_faces.angles()[f]);
    if(low.size() > most)
    {
      std::nth_element(low.begin(), low.begin() + most, low.end());
      angle = low[most] - m_faces.negligible;
      goal.searched = cosine(angle);
    }
    const auto is_left = [&](int f) {
      return m_left[f].rings >= (std::min)(useful_rings, int(m_rings[f])) &&
             std::abs(m_left[f].angle - m_faces.angles()[f]) < m_faces.negligible;
    };
    find_below(angle);
    if(std::all_of(m_low.begin(), m_low.end(), is_left))
      return true;
    m_credit -= cost_of_search * double(m_low.size()) / m_faces.number_of_faces();
    const bool goes_on = visit_wanted(goal, true);
    for(const int f : m_low)
      m_left[f] = {m_faces.angles()[f], int(m_rings[f])};
    return goes_on;
  }

  bool visit_wanted(const Goal& goal, bool searches)
  {
    m_credit -= double(m_wanted.list.size()) / m_faces.number_of_faces();
    m_saved.add(m_wanted.list);
    m_visits.update_sums();
    m_visits.settings.limits.cosine = goal.sharpest;
    m_visits.settings.search_cosine = goal.searched;
    const bool goes_on =
      m_visits.visit_regions(m_wanted.is_in, searches ? Moves::by_search : Moves::on_surface,
                             Angle_barrier_density<typename Visits::Densities>(
                               m_visits.densities(), goal.target, goal.steepness));
    m_touched.insert(m_touched.end(), m_wanted.list.begin(), m_wanted.list.end());
    m_faces.measure(m_wanted.list);
    return goes_on;
  }

  // wants the faces with an angle below the given one, and the rings around each that it needs
  void find_below(double angle)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    m_wanted.list.clear();
    m_wanted.is_in.assign(m_faces.angles().size(), 0);
    const auto add = [&](int f) {
      if(!m_wanted.is_in[f])
      {
        m_wanted.is_in[f] = 1;
        m_wanted.list.push_back(f);
      }
    };
    m_low.clear();
    int rings = 0;
    for(std::size_t f = 0; f < m_faces.angles().size(); ++f)
    {
      check_now_and_then(m_interruption, int(f));
      if(m_faces.angles()[f] < angle && m_faces.can_rise(int(f)))
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
    for(std::size_t f = 0; f < m_faces.angles().size(); ++f)
      if(m_faces.angles()[f] < angle && m_rings[f] < most)
      {
        ++m_rings[f];
        widens = true;
      }
    return widens;
  }

  static double cosine(double degrees) { return std::cos(degrees / degrees_per_radian); }

  void measure_touched()
  {
    m_faces.measure(m_touched);
    m_touched.clear();
  }

  Visits& m_visits;
  const Optimization_state& m_state;
  Interruption* m_interruption;
  Saved_state m_saved;
  Angle_statistics<typename Visits::Densities> m_faces;
  std::vector<unsigned char> m_rings; // per face: what surroundings it needs
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
