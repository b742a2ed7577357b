// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_WORST_FACES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_WORST_FACES_H

#include <CGAL/Reference_constrained_optimization/internal/rounds/patch_solver.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/active_set.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// How many faces of a mesh may be worked on one by one: of a large one a five-hundredth and some.
inline std::size_t number_of_exceptions(const Indexed_mesh& mesh)
{
  return 20 + std::size_t(mesh.number_of_faces()) / 500;
}

// The faces with an element beyond `bad`, the worst first, as far as they are exceptions.
template <typename ConcurrencyTag, typename Density>
std::vector<std::pair<double, int>>
worst_faces(const Optimization_state& state, const Density& density, double bad)
{
  std::vector<std::pair<double, int>> faces = face_densities<ConcurrencyTag>(state, density);
  faces.erase(std::remove_if(faces.begin(), faces.end(),
                             [&](const std::pair<double, int>& d) { return !(d.first > bad); }),
              faces.end());
  const std::size_t n = (std::min)(number_of_exceptions(state.mesh), faces.size());
  std::partial_sort(faces.begin(), faces.begin() + n, faces.end(),
                    std::greater<std::pair<double, int>>());
  faces.resize(n);
  return faces;
}

// Visits the worst faces by themselves, as long as that helps: by Newton steps on the surface in small
// patches around them, and where these leave them as they were, by a search for better places of
// their vertices. Without steps on the surface small patches are flattened instead.
template <typename ConcurrencyTag, typename Density>
class Worst_faces_stage
{
public:
  // what a visit has to do with faces
  struct Goal
  {
    double worst;    // no element may end beyond it
    double searched; // elements beyond it are what a search is for
  };

  // Faces with an element beyond `bad` are visited, those beyond `bad_for_search` searched, too.
  Worst_faces_stage(const Optimization_state& state,
                    const Density& density,
                    double bad,
                    double bad_for_search,
                    Interruption* interruption = nullptr)
    : m_state(state),
      m_density(density),
      m_bad(bad),
      m_bad_for_search(bad_for_search),
      m_interruption(interruption)
  {}

  // `visit(faces, moves, goal)` optimizes these faces; false if it was cut short, and so is this.
  template <typename Visit>
  bool run(bool use_on_surface_steps, const Visit& visit)
  {
    const int maximum_passes = 10;
    double before = std::numeric_limits<double>::infinity();
    m_found.assign(m_state.mesh.number_of_faces(), 0);
    for(int pass = 0; pass < maximum_passes; ++pass)
    {
      check(m_interruption);
      const Faces worst = worst_faces<ConcurrencyTag>(m_state, m_density, m_bad);
      if(worst.empty())
        return true;
      double after = 0;
      for(const std::pair<double, int>& d : worst)
        after += std::log(d.first / m_bad);
      // a search has much to gain, or nothing
      const double enough =
        use_on_surface_steps ? 0.9 * before : before - 0.01 * double(worst.size());
      if(!(after < enough))
        return true;
      before = after;
      const Goal goal{worst.front().first, std::numeric_limits<double>::infinity()};
      const bool goes_on = use_on_surface_steps ? move(worst, goal, visit)
                                                : visit(marked(worst), Moves::flattened, goal);
      if(!goes_on)
        return false;
    }
    return true;
  }

private:
  typedef std::vector<std::pair<double, int>> Faces; // with their densities

  std::vector<char> marked(const Faces& faces) const
  {
    std::vector<char> result(m_state.mesh.number_of_faces(), 0);
    for(const std::pair<double, int>& d : faces)
      result[d.second] = 1;
    return result;
  }

  std::vector<char> with_surroundings(const Faces& faces) const
  {
    return faces_around(m_state.mesh, vertices_of(m_state.mesh, marked(faces)), 2);
  }

  template <typename Visit>
  bool move(const Faces& faces, Goal goal, const Visit& visit)
  {
    if(!visit(with_surroundings(faces), Moves::on_surface, goal))
      return false;
    Faces stuck;
    // where many are as bad as the last of them a search has no exceptions to deal with
    const bool are_all = faces.size() < number_of_exceptions(m_state.mesh);
    const double common = are_all ? 0 : faces.back().first;
    for(const std::pair<double, int>& d : faces)
    {
      const double density = face_density(m_state, m_density, d.second);
      // what a search has left, and nothing has touched since, the next would leave, too
      const bool was_left = std::abs(density - m_found[d.second]) < 0.01 * density;
      if(!(density > m_bad_for_search) || !(density > 0.8 * d.first) || was_left ||
         !(density > common))
        continue;
      stuck.push_back(d);
      goal.searched = (std::min)(goal.searched, 0.99 * density);
    }
    goal.searched = (std::max)(goal.searched, common);
    if(stuck.empty())
      return true;
    const bool goes_on = visit(with_surroundings(stuck), Moves::by_search, goal);
    for(const std::pair<double, int>& d : stuck)
      m_found[d.second] = face_density(m_state, m_density, d.second);
    return goes_on;
  }

  const Optimization_state& m_state;
  const Density& m_density;
  double m_bad, m_bad_for_search;
  Interruption* m_interruption;
  std::vector<double> m_found; // per face: its density after it was searched, else 0
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_WORST_FACES_H
