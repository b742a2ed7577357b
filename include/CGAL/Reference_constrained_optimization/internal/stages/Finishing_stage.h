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
// was everywhere else. The largest possible minimum is not known in advance: the target exceeds the
// smallest angle by a step, which is reduced where the angle does not follow. The surroundings of a face
// that does not reach the target are enlarged first, up to a few rings. The best state is kept. The effort
// is limited by a budget, which gains increase.
template <typename Visits>
class Finishing_stage
{
  typedef typename Visits::ConcurrencyTag ConcurrencyTag;

  struct Goal
  {
    double target;         // of the barrier, in degrees
    double steepness;      // of the barrier, per degree
    double largest_cosine; // cosine of the angle below which no angle may fall
    // cosine of the angle below which faces are searched after Newton steps
    double search_threshold;
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
      m_saved(visits.state, visits.round_solver.shape_bound()),
      m_faces(visits.state, visits.target_densities)
  {}

  // The mean energy may increase temporarily, but not above that of the input. If it is interrupted the
  // mesh returns to the state that was saved last.
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
  // false if it was interrupted
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
    bool is_completed = true;
    m_budget = largest_budget;
    m_searched.assign(m_faces.angles().size(), Searched());
    m_saved.clear();
    for(int pass = 0; is_completed && m_budget > 0 && pass < maximum_passes; ++pass)
    {
      if(step < smallest_step || m_faces.minimum() > equilateral - smallest_step)
        break;
      const auto lowest = std::min_element(m_faces.angles().begin(), m_faces.angles().end()) -
                          m_faces.angles().begin();
      if(!m_faces.can_improve(int(lowest)))
        break;
      const double minimum = m_faces.minimum(), mean_before = m_faces.mean();
      // a target far beyond what the sharpest face can reach would only degrade its neighbours
      const double feasible = m_faces.angle_bound(int(lowest)) + 0.2;
      const double target = (std::min)({minimum + step, feasible, equilateral});
      const double target_distance = target - minimum;
      const double search_limit = minimum + 0.2 * target_distance,
                   sufficient = minimum + 0.3 * target_distance;
      // the neighbours of the sharpest face may lose a little, to give way to it
      const double lower_bound = (std::max)(first_minimum, minimum - 0.5 * target_distance);
      // The closer the target, the steeper: this makes the angles of a star at its limit equal.
      const double steepness =
        (std::min)(largest_steepness, (std::max)(smallest_steepness, 12 / target_distance));
      const Goal goal{target, steepness, cosine(lower_bound), cosine(search_limit)};
      is_completed = visit_below(target, goal, false);
      if(is_completed && m_faces.minimum() < search_limit)
        is_completed = search_below(search_limit, goal);
      const double allowed_loss = 0.02 + 0.05 * (m_faces.minimum() - minimum);
      const bool is_acceptable = m_faces.mean() > first_mean - largest_loss &&
                                 m_faces.mean() > mean_before - allowed_loss &&
                                 m_faces.energy() <= m_visits.initial_energy;
      if(!is_acceptable)
      {
        m_saved.restore();
        measure_changed();
        step *= 0.25;
      }
      else
      {
        const double gain =
          (std::max)(0., m_faces.minimum() - best) + (std::max)(0., m_faces.mean() - mean_before);
        m_budget = (std::min)(largest_budget, m_budget + budget_per_degree * gain);
        if(m_faces.minimum() > best)
        {
          m_saved.clear();
          m_changed_faces.clear();
          best = m_faces.minimum();
        }
        if(m_faces.minimum() > minimum + 0.8 * target_distance)
          step = (std::min)(largest_step, 2 * step);
        else if(m_faces.minimum() < sufficient)
        {
          const bool widens = widen(sufficient);
          if(!widens || m_faces.minimum() <= minimum)
            step = (widens ? 0.8 : 0.25) * target_distance;
        }
      }
    }
    if(m_faces.minimum() < best)
    {
      m_saved.restore();
      measure_changed();
    }
    return is_completed;
  }

  static constexpr double smallest_step = 0.03;                           // degrees
  static constexpr double smallest_steepness = 6, largest_steepness = 30; // per degree
  // in visits of the whole mesh: the largest cost of passes without a gain, and the cost that a degree of
  // the minimum or of the mean justifies
  static constexpr double largest_budget = 8, budget_per_degree = 16;

  // Raises the mean again while the minimum is kept: small patches still gain a little where the large ones
  // before the stage have converged.
  void polish()
  {
    const int maximum_passes = 4;
    // degrees: of the mean, and of an angle
    const double sufficient = 0.002, largest_unchanged = 0.1;
    std::vector<char> is_selected(m_faces.angles().size());
    for(std::size_t f = 0; f < is_selected.size(); ++f)
      is_selected[f] = m_faces.angles()[f] < 180;
    for(int pass = 0; pass < maximum_passes; ++pass)
    {
      const double minimum = m_faces.minimum(), mean_before = m_faces.mean();
      const std::vector<double> before = m_faces.angles();
      m_saved.clear();
      m_changed_faces.clear();
      select(is_selected);
      const Goal goal{minimum, smallest_steepness, cosine(minimum), cosine(minimum)};
      const bool is_completed = visit_selected(goal, false);
      if(m_faces.minimum() < minimum || m_faces.mean() < mean_before ||
         m_faces.energy() > m_visits.initial_energy)
      {
        m_saved.restore();
        return;
      }
      if(!is_completed || m_faces.mean() < mean_before + sufficient)
        return;
      for(std::size_t f = 0; f < before.size(); ++f)
        is_selected[f] = std::abs(m_faces.angles()[f] - before[f]) > largest_unchanged;
      is_selected = faces_around<ConcurrencyTag>(
        m_state.mesh, vertices_of<ConcurrencyTag>(m_state.mesh, is_selected), 1);
    }
  }

  static constexpr double cost_of_search = 200; // per face, in visits of a face

  // of a face after it was searched: its angle, and the rings around it
  struct Searched
  {
    double angle = -1;
    int rings = 0;
  };

  void select(const std::vector<char>& is_selected)
  {
    m_selected.is_in = is_selected;
    m_selected.list.clear();
    for(std::size_t f = 0; f < is_selected.size(); ++f)
      if(is_selected[f])
        m_selected.list.push_back(int(f));
  }

  bool visit_below(double angle, const Goal& goal, bool searches)
  {
    find_below(angle);
    return visit_selected(goal, searches);
  }

  // Searches around the faces with an angle below the given one; if these are many, only around those below
  // the angle that many have. Faces that a search did not change are not searched again with the same
  // surroundings.
  bool search_below(double angle, Goal goal)
  {
    const int useful_rings = 3; // it moves the vertices of a face and their neighbours
    const std::size_t most = largest_number_of_worst_faces(m_state.mesh);
    std::vector<double> low;
    for(std::size_t f = 0; f < m_faces.angles().size(); ++f)
      if(m_faces.angles()[f] < angle && m_faces.can_improve(int(f)))
        low.push_back(m_faces.angles()[f]);
    if(low.size() > most)
    {
      std::nth_element(low.begin(), low.begin() + most, low.end());
      angle = low[most] - m_faces.negligible;
      goal.search_threshold = cosine(angle);
    }
    const auto is_unchanged = [&](int f) {
      return m_searched[f].rings >= (std::min)(useful_rings, int(m_rings[f])) &&
             std::abs(m_searched[f].angle - m_faces.angles()[f]) < m_faces.negligible;
    };
    find_below(angle);
    if(std::all_of(m_low_faces.begin(), m_low_faces.end(), is_unchanged))
      return true;
    m_budget -= cost_of_search * double(m_low_faces.size()) / m_faces.number_of_faces();
    const bool is_completed = visit_selected(goal, true);
    for(const int f : m_low_faces)
      m_searched[f] = {m_faces.angles()[f], int(m_rings[f])};
    return is_completed;
  }

  bool visit_selected(const Goal& goal, bool searches)
  {
    m_budget -= double(m_selected.list.size()) / m_faces.number_of_faces();
    m_saved.add(m_selected.list);
    m_visits.update_sums();
    m_visits.settings.limits.cosine = goal.largest_cosine;
    m_visits.settings.search_cosine = goal.search_threshold;
    const bool is_completed =
      m_visits.visit_regions(m_selected.is_in, searches ? Moves::pattern_search : Moves::on_surface,
                             Angle_barrier_density<typename Visits::Densities>(
                               m_visits.densities(), goal.target, goal.steepness));
    m_changed_faces.insert(m_changed_faces.end(), m_selected.list.begin(), m_selected.list.end());
    m_faces.measure(m_selected.list);
    return is_completed;
  }

  // selects the faces with an angle below the given one, and the rings around each
  void find_below(double angle)
  {
    const Indexed_mesh& mesh = m_state.mesh;
    m_selected.list.clear();
    m_selected.is_in.assign(m_faces.angles().size(), 0);
    const auto add = [&](int f) {
      if(!m_selected.is_in[f])
      {
        m_selected.is_in[f] = 1;
        m_selected.list.push_back(f);
      }
    };
    m_low_faces.clear();
    int rings = 0;
    for(std::size_t f = 0; f < m_faces.angles().size(); ++f)
    {
      check_periodically(m_interruption, int(f));
      if(m_faces.angles()[f] < angle && m_faces.can_improve(int(f)))
      {
        m_low_faces.push_back(int(f));
        rings = (std::max)(rings, int(m_rings[f]));
      }
    }
    check(m_interruption);
    for(; rings > 0; --rings)
    {
      for(const int f : m_low_faces)
        if(m_rings[f] >= rings)
          add(f);
      for(std::size_t i = 0, end = m_selected.list.size(); i < end; ++i)
        for(int c = mesh.face_begin[m_selected.list[i]];
            c < mesh.face_begin[m_selected.list[i] + 1]; ++c)
        {
          const int v = mesh.corner_vertex[c];
          for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
            add(mesh.corner_face[mesh.vertex_corners[k]]);
        }
    }
  }

  // adds a ring around the faces with an angle below the given one; false if all have the largest number
  bool widen(double angle)
  {
    const int most = 8; // this concerns a few faces only
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

  void measure_changed()
  {
    m_faces.measure(m_changed_faces);
    m_changed_faces.clear();
  }

  Visits& m_visits;
  const Optimization_state& m_state;
  Interruption* m_interruption;
  Saved_state m_saved;
  Angle_statistics<typename Visits::Densities> m_faces;
  std::vector<unsigned char> m_rings; // per face: the number of rings that are optimized with it
  double m_budget = 0;
  std::vector<Searched> m_searched; // per face
  Faces m_selected;
  std::vector<int> m_low_faces;
  std::vector<int> m_changed_faces; // faces that have changed since the last save
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_FINISHING_STAGE_H
