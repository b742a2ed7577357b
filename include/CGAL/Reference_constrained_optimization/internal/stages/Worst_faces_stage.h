// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_WORST_FACES_STAGE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_WORST_FACES_STAGE_H

#include <CGAL/Reference_constrained_optimization/internal/stages/Patch_visits.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>

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

// The largest number of faces that are treated one by one.
inline std::size_t largest_number_of_worst_faces(const Indexed_mesh& mesh)
{
  return 20 + std::size_t(mesh.number_of_faces()) / 500;
}

// The faces with an element beyond `bad`, the worst first, up to that number.
template <typename ConcurrencyTag, typename Density>
std::vector<std::pair<double, int>>
worst_faces(const Optimization_state& state, const Density& density, double bad)
{
  std::vector<std::pair<double, int>> faces = face_densities<ConcurrencyTag>(state, density);
  faces.erase(std::remove_if(faces.begin(), faces.end(),
                             [&](const std::pair<double, int>& d) { return !(d.first > bad); }),
              faces.end());
  const std::size_t n = (std::min)(largest_number_of_worst_faces(state.mesh), faces.size());
  std::partial_sort(faces.begin(), faces.begin() + n, faces.end(),
                    std::greater<std::pair<double, int>>());
  faces.resize(n);
  return faces;
}

// Optimizes the worst faces separately, as long as they improve: by Newton steps on the surface in small
// patches around them, and where these do not improve them, by a pattern search.
template <typename Visits>
class Worst_faces_stage
{
  typedef typename Visits::ConcurrencyTag ConcurrencyTag;
  typedef typename Visits::Densities Densities;

public:
  // `searches_later`: a later stage searches, too, so that this one is restricted to worse elements
  Worst_faces_stage(Visits& visits, bool searches_later)
    : m_visits(visits),
      m_state(visits.state),
      m_densities(visits.densities()),
      m_bad(visits.settings.bad_density),
      m_bad_for_search((searches_later ? 4 : 1) * m_bad)
  {}

  // false if it was cut short
  bool run()
  {
    const int maximum_passes = 10;
    double before = std::numeric_limits<double>::infinity();
    m_visits.settings.limits.uses_allowances = true;
    m_searched_density.assign(m_state.mesh.number_of_faces(), 0);
    for(int pass = 0; pass < maximum_passes; ++pass)
    {
      m_visits.interruption.check();
      const Faces worst = worst_faces<ConcurrencyTag>(m_state, m_densities, m_bad);
      if(worst.empty())
        return true;
      double after = 0;
      for(const std::pair<double, int>& d : worst)
        after += std::log(d.first / m_bad);
      // a search improves much, or nothing
      if(!(after < 0.9 * before))
        return true;
      before = after;
      double& largest = m_visits.settings.limits.density; // no element may end above it
      largest = (std::min)(largest, worst.front().first);
      m_visits.settings.search_density = std::numeric_limits<double>::infinity();
      if(!move(worst))
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

  bool move(const Faces& faces)
  {
    if(!m_visits.visit_regions(with_surroundings(faces), Moves::on_surface, m_densities))
      return false;
    double& search_threshold = m_visits.settings.search_density; // elements above it are searched
    Faces unimproved;
    // where many are as bad as the last of them, they are not searched
    const bool are_all = faces.size() < largest_number_of_worst_faces(m_state.mesh);
    const double common_density = are_all ? 0 : faces.back().first;
    for(const std::pair<double, int>& d : faces)
    {
      const double density = face_density(m_state, m_densities, d.second);
      // a face that has not changed since its last search is not searched again
      const bool is_unchanged = std::abs(density - m_searched_density[d.second]) < 0.01 * density;
      if(!(density > m_bad_for_search) || !(density > 0.8 * d.first) || is_unchanged ||
         !(density > common_density))
        continue;
      unimproved.push_back(d);
      search_threshold = (std::min)(search_threshold, 0.99 * density);
    }
    search_threshold = (std::max)(search_threshold, common_density);
    if(unimproved.empty())
      return true;
    const bool is_completed =
      m_visits.visit_regions(with_surroundings(unimproved), Moves::pattern_search, m_densities);
    for(const std::pair<double, int>& d : unimproved)
      m_searched_density[d.second] = face_density(m_state, m_densities, d.second);
    return is_completed;
  }

  Visits& m_visits;
  const Optimization_state& m_state;
  const Densities& m_densities;
  const double m_bad,
    m_bad_for_search; // faces with an element beyond these are visited, and searched
  std::vector<double> m_searched_density; // per face: its density after it was searched, else 0
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STAGES_WORST_FACES_STAGE_H
