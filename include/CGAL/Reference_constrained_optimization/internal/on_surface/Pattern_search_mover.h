// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_PATTERN_SEARCH_MOVER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_PATTERN_SEARCH_MOVER_H

#include <CGAL/Reference_constrained_optimization/internal/on_surface/tangent_step.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/tangent_frame.h>
#include <CGAL/Reference_constrained_optimization/internal/shape/drift_samples.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>
#include <CGAL/Reference_constrained_optimization/internal/support/seconds_since.h>

#include <Eigen/Core>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Pattern search: moves the vertices around bad elements, one by one and those of one element together,
// each time to the best of a few points of R around them. Newton steps assume a smooth energy; at a sharp
// vertex or a crease of R of the size of an element it is not smooth, and they stall. A pattern search
// needs no derivatives. It is slow, but applied to a few elements only, and it ends when sweeps decrease
// the energy by little of the total decrease.
class Pattern_search_mover
{
public:
  explicit Pattern_search_mover(const Reference_surface& reference,
                                Interruption* interruption = nullptr)
    : m_reference(reference),
      m_interruption(interruption)
  {}

  // elements with a density or with a cosine of an angle above these are searched
  void set_thresholds(double density_threshold, double cosine_threshold)
  {
    m_density_threshold = density_threshold;
    m_cosine_threshold = cosine_threshold;
  }

  template <typename Density>
  bool propose(const Patch& patch, const Patch_samples& samples, const Density& density)
  {
    const auto start = std::chrono::steady_clock::now();
    m_samples = &samples;
    m_located = patch.located;
    const bool moves = search(patch, density);
    m_optimization_time = seconds_since(start);
    return moves;
  }

  template <typename Density>
  bool propose_again(const Patch&, const Patch_samples&, const std::vector<double>&, const Density&)
  {
    return false;
  }

  bool displaced_vertex(const Patch& patch, int v, double t, Located_vertex& result) const
  {
    if(t == 1)
    {
      result = m_located[v];
      return true;
    }
    const Located_vertex& from = patch.located[v];
    return step_on_surface(m_reference, from, t * (m_located[v].position - from.position), result);
  }

  double displacement_length(int v) const { return m_displacement_lengths[v]; }
  double optimization_time() const { return m_optimization_time; }

private:
  // in mean edge lengths at a vertex
  static constexpr double initial_step_size = 0.3, final_step_size = 0.01;

  // the energy of the elements and the drift around a vertex, and the number of faces and edges there that
  // are inverted or folded, or further from R than allowed
  struct Star_measure
  {
    double energy = 0;
    int defects = 0;
    bool operator<(const Star_measure& other) const
    {
      return defects < other.defects || (defects == other.defects && energy < other.energy);
    }
  };

  // of the faces around the vertices that move
  template <typename Density>
  double energy(const Patch& patch, const Density& density) const
  {
    const auto vertex = [&](int w) -> const Located_vertex& { return m_located[w]; };
    double sum = 0;
    for(const int f : m_star)
      for(int e = patch.element_begin[f]; e < patch.element_begin[f + 1]; ++e)
        sum += element_energy(density, patch.elements[e], vertex);
    for(const int s : m_star_stencils)
      sum += patch.value(patch.stencils[s], m_located);
    return sum;
  }

  int defects(const Patch& patch) const
  {
    const Indexed_mesh& mesh = patch.polygons;
    const auto vertex = [&](int w) -> const Located_vertex& { return m_located[w]; };
    int count = 0;
    for(const int f : m_star)
    {
      const Vector_3 normal = face_normal(mesh, vertex, f);
      count += is_flipped(mesh, vertex, f, normal) + is_nonconvex(mesh, vertex, f);
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        if(mesh.opposite[c] >= 0)
        {
          const Vector_3 other = face_normal(mesh, vertex, mesh.corner_face[mesh.opposite[c]]);
          count += is_folded(normal, other) + (!patch.is_on_line(c) && is_crease(normal, other));
        }
    }
    return count;
  }

  Star_measure drift(const Patch& patch) const
  {
    Star_measure m;
    if(!m_samples->are_bounded())
      return m;
    const auto vertex = [&](int w) -> const Located_vertex& { return m_located[w]; };
    const auto add = [&](double distance, double bound) {
      m.energy += m_samples->barrier.value(distance, bound);
      m.defects += distance > Drift_barrier::limit_factor * bound;
    };
    for(const int t : m_triangles)
    {
      for(int i = 0; i < 4; ++i)
      {
        const int s = sample_of(patch, t, i);
        if(s < 0)
          continue;
        Patch_samples::Sample sample = m_samples->samples[s];
        locate_sample(patch, *m_samples, m_reference, vertex, s, sample);
        add(sample.distance, sample.bound);
      }
      for(const int g : m_projected_samples[patch.polygon_of(t)])
      {
        Patch_samples::Projected_sample projected_sample = m_samples->projected_samples[g];
        locate_projected_sample(patch, m_reference, vertex, projected_sample);
        add(projected_sample.distance, projected_sample.bound);
      }
    }
    return m;
  }

  // the faces and triangles around some vertices
  void collect_star(const Patch& patch, const std::vector<int>& vertices)
  {
    const auto collect = [&](const Indexed_mesh& mesh, std::vector<int>& faces) {
      faces.clear();
      for(const int v : vertices)
        for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
        {
          const int f = mesh.corner_face[mesh.vertex_corners[k]];
          // a single vertex has no face twice
          if(vertices.size() == 1 || std::find(faces.begin(), faces.end(), f) == faces.end())
            faces.push_back(f);
        }
    };
    collect(patch.polygons, m_star);
    collect(patch.triangles(), m_triangles);
    m_star_stencils.clear();
    for(std::size_t s = 0; s < patch.stencils.size(); ++s)
      for(int i = 0; i < patch.stencils[s].size; ++i)
        if(std::find(vertices.begin(), vertices.end(), patch.stencils[s].vertices[i]) !=
           vertices.end())
        {
          m_star_stencils.push_back(int(s));
          break;
        }
  }

  void sort_projected_samples(const Patch& patch)
  {
    m_projected_samples.assign(patch.polygons.number_of_faces(), {});
    for(std::size_t g = 0; g < m_samples->projected_samples.size(); ++g)
      m_projected_samples[m_samples->projected_samples[g].polygon].push_back(int(g));
  }

  // vertices that move together, and their step size
  struct Group
  {
    std::vector<int> vertices;
    double step_size = initial_step_size;
  };

  bool may_move(const Patch& patch, int v) const { return patch.is_free[v] && !patch.slides(v); }

  template <typename Density>
  bool is_bad(const Density& density, const Element_set::Element& element) const
  {
    const auto vertex = [&](int v) -> const Located_vertex& { return m_located[v]; };
    return element_energy(density, element, vertex) > m_density_threshold ||
           (!element.is_in_quad &&
            smallest_angle_cosine(element.vertices.data(), vertex) > m_cosine_threshold);
  }

  // The vertices of bad elements, and those around them, one by one; then two and three of the same bad
  // element: together they can reach positions that they cannot reach one by one, as between a crease and
  // an edge that would fold.
  template <typename Density>
  void collect_groups(const Patch& patch, const Density& density)
  {
    const Indexed_mesh& mesh = patch.polygons;
    std::vector<char> is_selected(patch.vertices.size(), 0);
    std::vector<Group> joint_groups;
    for(const Element_set::Element& element : patch.elements)
    {
      if(!is_bad(density, element))
        continue;
      std::vector<int> free;
      for(const int v : element.vertices)
      {
        if(may_move(patch, v) && mesh.valence(v) <= largest_small_valence)
          free.push_back(v);
        for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
        {
          const int c = mesh.vertex_corners[k];
          is_selected[v] = is_selected[mesh.target(c)] =
            is_selected[mesh.source(mesh.previous(c))] = 1;
        }
      }
      for(std::size_t i = 0; i < free.size(); ++i)
        for(std::size_t j = i + 1; j < free.size(); ++j)
          joint_groups.push_back({{free[i], free[j]}});
      if(free.size() == 3)
        joint_groups.push_back({free});
    }
    m_groups.clear();
    for(int v = 0; v < int(is_selected.size()); ++v)
      if(is_selected[v] && may_move(patch, v))
        m_groups.push_back({{v}});
    m_groups.insert(m_groups.end(), joint_groups.begin(), joint_groups.end());
  }

  template <typename Density>
  bool search(const Patch& patch, const Density& density)
  {
    const Indexed_mesh& mesh = patch.polygons;
    // the step size shrinks where a sweep gains nothing
    const int maximum_sweeps = 40, stall_limit = 3;
    const double stall_tolerance = 0.001; // relative to the gain of all sweeps
    double total_gain = 0, recent[stall_limit] = {};
    sort_projected_samples(patch);
    m_displacement_lengths.resize(patch.vertices.size());
    collect_groups(patch, density);
    bool has_moved = false, is_active = true;
    for(int sweep = 0; is_active && sweep < maximum_sweeps; ++sweep)
    {
      is_active = false;
      double gain = 0;
      for(std::size_t i = 0; i < m_groups.size(); ++i)
      {
        Group& group = m_groups[i];
        if(group.step_size < final_step_size)
          continue;
        is_active = true;
        check_periodically(m_interruption, int(i));
        const int v = group.vertices.front();
        const double edge = mean_edge_length_at(
          mesh, [&](int w) -> const Vector_3& { return m_located[w].position; }, v);
        if(improve(patch, density, group.vertices, group.step_size * edge, gain))
        {
          has_moved = true;
          group.step_size = (std::min)(initial_step_size, 1.5 * group.step_size);
          // neighbours are searched again
          for(Group& other : m_groups)
            if(other.step_size < final_step_size &&
               are_neighbours(mesh, group.vertices, other.vertices))
              other.step_size = 4 * final_step_size;
        }
        else
          group.step_size *= 0.5;
      }
      total_gain += gain;
      recent[sweep % stall_limit] = gain;
      const double recent_gain = std::accumulate(recent, recent + stall_limit, 0.);
      if(total_gain > 0 && sweep >= stall_limit && recent_gain < stall_tolerance * total_gain)
        break;
    }
    for(std::size_t v = 0; v < m_located.size(); ++v)
      m_displacement_lengths[v] = (m_located[v].position - patch.located[v].position).norm();
    return has_moved;
  }

  static bool are_neighbours(const Indexed_mesh& mesh,
                             const std::vector<int>& first,
                             const std::vector<int>& second)
  {
    for(const int v : first)
      for(const int w : second)
        if(v == w || mesh.face_at(v, w) >= 0)
          return true;
    return false;
  }

  // moves a vertex to the best of eight points at the given distance, or several vertices by the same
  // displacement to the best of four, if that is an improvement; adds the decrease of the energy
  template <typename Density>
  bool improve(const Patch& patch,
               const Density& density,
               const std::vector<int>& group,
               double step_size,
               double& gain)
  {
    collect_star(patch, group);
    m_current.clear();
    for(const int v : group)
      m_current.push_back(m_located[v]);
    Vector_3 normal = Vector_3::Zero();
    for(const Located_vertex& current : m_current)
      normal += current.normal;
    const Tangent_frame frame = tangent_frame(normal);
    Star_measure best = drift(patch);
    best.energy += energy(patch, density);
    best.defects += defects(patch);
    const double energy_before = best.energy;
    m_best = m_current;
    bool found = false;
    const double diagonal = std::sqrt(0.5);
    const double directions[8][2] = {
      {1, 0},  {diagonal, diagonal},   {0, 1},  {-diagonal, diagonal},
      {-1, 0}, {-diagonal, -diagonal}, {0, -1}, {diagonal, -diagonal}};
    const auto set_group = [&](const std::vector<Located_vertex>& places) {
      for(std::size_t i = 0; i < group.size(); ++i)
        m_located[group[i]] = places[i];
    };
    const auto move_group = [&](const Vector_3& displacement) {
      for(std::size_t i = 0; i < group.size(); ++i)
        if(!step_on_surface(m_reference, m_current[i], displacement, m_located[group[i]]))
          return false;
      return true;
    };
    const int stride = group.size() > 1 ? 2 : 1;
    for(int k = 0; k < 8; k += stride)
    {
      if(move_group(step_size * (frame * Vector_2(directions[k][0], directions[k][1]))))
      {
        // drift and defects are expensive to measure
        Star_measure m{energy(patch, density), 0};
        if(m < best)
        {
          const Star_measure d = drift(patch);
          m.energy += d.energy;
          m.defects = d.defects + defects(patch);
        }
        if(m < best)
        {
          best = m;
          found = true;
          for(std::size_t i = 0; i < group.size(); ++i)
            m_best[i] = m_located[group[i]];
        }
      }
      set_group(m_current);
    }
    set_group(m_best);
    gain += (std::max)(0., energy_before - best.energy); // the repair of a defect may cost energy
    return found;
  }

  const Reference_surface& m_reference;
  Interruption* m_interruption;
  double m_density_threshold = std::numeric_limits<double>::infinity();
  double m_cosine_threshold = 1;
  const Patch_samples* m_samples = nullptr;
  std::vector<Located_vertex> m_located;
  std::vector<std::vector<int>> m_projected_samples; // per polygon
  // around the vertices that move: faces, triangles, and stencils of the patch
  std::vector<int> m_star, m_triangles, m_star_stencils;
  std::vector<Located_vertex> m_current, m_best; // of these
  std::vector<Group> m_groups;
  std::vector<double> m_displacement_lengths; // per vertex
  double m_optimization_time = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_PATTERN_SEARCH_MOVER_H
