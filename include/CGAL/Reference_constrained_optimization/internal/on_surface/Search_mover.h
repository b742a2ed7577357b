// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_SEARCH_MOVER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_SEARCH_MOVER_H

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

// Moves the vertices around bad elements, one by one and those of one element together, each time to
// the best of a few places on R around them. Newton steps trust a model that is smooth; where R has a
// sharp vertex or a crease of the size of an element the energy on R is not, and they end in front of
// it. A pattern search needs no model. It is slow, but only the few elements that are left behind by
// the others are its business, and it ends where sweeps over them gain little of what they have gained.
class Search_mover
{
public:
  explicit Search_mover(const Reference_surface& reference, Interruption* interruption = nullptr)
    : m_reference(reference),
      m_interruption(interruption)
  {}

  // elements with a density or with a cosine of an angle above these are what the search is for
  void set_target(double bad, double sharp)
  {
    m_bad = bad;
    m_sharp = sharp;
  }

  template <typename Density>
  bool propose(const Patch& patch, const Patch_samples& samples, const Density& density)
  {
    const auto start = std::chrono::steady_clock::now();
    m_samples = &samples;
    m_placed = patch.placed;
    const bool moves = search(patch, density);
    m_optimization_time = seconds_since(start);
    return moves;
  }

  template <typename Density>
  bool propose_again(const Patch&, const Patch_samples&, const std::vector<double>&, const Density&)
  {
    return false;
  }

  bool place(const Patch& patch, int v, double t, Placed_vertex& result) const
  {
    if(t == 1)
    {
      result = m_placed[v];
      return true;
    }
    const Placed_vertex& from = patch.placed[v];
    return step_on_surface(m_reference, from, t * (m_placed[v].position - from.position), result);
  }

  double motion_length(int v) const { return m_length[v]; }
  double optimization_time() const { return m_optimization_time; }

private:
  static constexpr double first_reach = 0.3, last_reach = 0.01; // in mean edges at a vertex

  // what a vertex looks at: its elements and the drift around it, and whether its faces and their edges
  // are turned or folded, or further from R than they may be
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
    const auto vertex = [&](int w) -> const Placed_vertex& { return m_placed[w]; };
    double sum = 0;
    for(const int f : m_star)
      for(int e = patch.element_begin[f]; e < patch.element_begin[f + 1]; ++e)
        sum += element_energy(density, patch.elements[e], vertex);
    for(const int s : m_star_stencils)
      sum += patch.value(patch.stencils[s], m_placed);
    return sum;
  }

  int defects(const Patch& patch) const
  {
    const Indexed_mesh& mesh = patch.polygons;
    const auto vertex = [&](int w) -> const Placed_vertex& { return m_placed[w]; };
    int count = 0;
    for(const int f : m_star)
    {
      const Vector_3 normal = face_normal(mesh, vertex, f);
      count += is_flipped(mesh, vertex, f, normal) + is_nonconvex(mesh, vertex, f);
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        if(mesh.opposite[c] >= 0)
          count += is_folded(normal, face_normal(mesh, vertex, mesh.corner_face[mesh.opposite[c]]));
    }
    return count;
  }

  Star_measure drift(const Patch& patch) const
  {
    Star_measure m;
    if(!m_samples->are_bounded())
      return m;
    const auto vertex = [&](int w) -> const Placed_vertex& { return m_placed[w]; };
    const auto add = [&](double distance, double bound) {
      m.energy += m_samples->barrier.value(distance, bound);
      m.defects += distance > Drift_barrier::last_part * bound;
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
      for(const int g : m_guests[patch.polygon_of(t)])
      {
        Patch_samples::Guest guest = m_samples->guests[g];
        locate_guest(patch, m_reference, vertex, guest);
        add(guest.distance, guest.bound);
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
          // at one vertex there is none twice
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

  void sort_guests(const Patch& patch)
  {
    m_guests.assign(patch.polygons.number_of_faces(), {});
    for(std::size_t g = 0; g < m_samples->guests.size(); ++g)
      m_guests[m_samples->guests[g].polygon].push_back(int(g));
  }

  // vertices that move at once, and how far they look
  struct Group
  {
    std::vector<int> vertices;
    double reach = first_reach;
  };

  bool may_move(const Patch& patch, int v) const { return patch.is_free[v] && !patch.slides(v); }

  template <typename Density>
  bool is_bad(const Density& density, const Element_set::Element& element) const
  {
    const auto vertex = [&](int v) -> const Placed_vertex& { return m_placed[v]; };
    return element_energy(density, element, vertex) > m_bad ||
           (!element.is_in_quad &&
            smallest_angle_cosine(element.vertices.data(), vertex) > m_sharp);
  }

  // The vertices of bad elements, and those around them, one by one; then two and three of the same bad
  // element: together they may go where each alone would be in the way of the others, as between a
  // crease and an edge that would fold.
  template <typename Density>
  void collect_groups(const Patch& patch, const Density& density)
  {
    const Indexed_mesh& mesh = patch.polygons;
    std::vector<char> is_wanted(patch.vertices.size(), 0);
    std::vector<Group> together;
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
          is_wanted[v] = is_wanted[mesh.target(c)] = is_wanted[mesh.source(mesh.previous(c))] = 1;
        }
      }
      for(std::size_t i = 0; i < free.size(); ++i)
        for(std::size_t j = i + 1; j < free.size(); ++j)
          together.push_back({{free[i], free[j]}});
      if(free.size() == 3)
        together.push_back({free});
    }
    m_groups.clear();
    for(int v = 0; v < int(is_wanted.size()); ++v)
      if(is_wanted[v] && may_move(patch, v))
        m_groups.push_back({{v}});
    m_groups.insert(m_groups.end(), together.begin(), together.end());
  }

  template <typename Density>
  bool search(const Patch& patch, const Density& density)
  {
    const Indexed_mesh& mesh = patch.polygons;
    const int maximum_sweeps = 40, patience = 3; // reach shrinks where a sweep gains nothing
    const double little = 0.001;                 // part of the gain of all sweeps
    double gain_of_all = 0, recent[patience] = {};
    sort_guests(patch);
    m_length.resize(patch.vertices.size());
    collect_groups(patch, density);
    bool has_moved = false, goes_on = true;
    for(int sweep = 0; goes_on && sweep < maximum_sweeps; ++sweep)
    {
      goes_on = false;
      double gain = 0;
      for(std::size_t i = 0; i < m_groups.size(); ++i)
      {
        Group& group = m_groups[i];
        if(group.reach < last_reach)
          continue;
        goes_on = true;
        check_now_and_then(m_interruption, int(i));
        const int v = group.vertices.front();
        const double edge = mean_edge_length_at(
          mesh, [&](int w) -> const Vector_3& { return m_placed[w].position; }, v);
        if(improve(patch, density, group.vertices, group.reach * edge, gain))
        {
          has_moved = true;
          group.reach = (std::min)(first_reach, 1.5 * group.reach);
          // what is around has changed: it is looked at again
          for(Group& other : m_groups)
            if(other.reach < last_reach && are_neighbours(mesh, group.vertices, other.vertices))
              other.reach = 4 * last_reach;
        }
        else
          group.reach *= 0.5;
      }
      gain_of_all += gain;
      recent[sweep % patience] = gain;
      const double recent_gain = std::accumulate(recent, recent + patience, 0.);
      if(gain_of_all > 0 && sweep >= patience && recent_gain < little * gain_of_all)
        break;
    }
    for(std::size_t v = 0; v < m_placed.size(); ++v)
      m_length[v] = (m_placed[v].position - patch.placed[v].position).norm();
    return has_moved;
  }

  static bool are_neighbours(const Indexed_mesh& mesh,
                             const std::vector<int>& first,
                             const std::vector<int>& second)
  {
    for(const int v : first)
      for(const int w : second)
        if(v == w || are_neighbours(mesh, v, w))
          return true;
    return false;
  }

  static bool are_neighbours(const Indexed_mesh& mesh, int v, int w)
  {
    if(mesh.valence(w) < mesh.valence(v))
      std::swap(v, w);
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int c = mesh.vertex_corners[k];
      if(mesh.target(c) == w || mesh.source(mesh.previous(c)) == w)
        return true;
    }
    return false;
  }

  // takes a vertex to the best of eight places at the given distance, or several vertices, all the same
  // way, to the best of four, if that is better than their own; adds what that gains
  template <typename Density>
  bool improve(const Patch& patch,
               const Density& density,
               const std::vector<int>& group,
               double reach,
               double& gain)
  {
    collect_star(patch, group);
    m_here.clear();
    for(const int v : group)
      m_here.push_back(m_placed[v]);
    Vector_3 normal = Vector_3::Zero();
    for(const Placed_vertex& here : m_here)
      normal += here.normal;
    const Tangent_frame frame = tangent_frame(normal);
    Star_measure best = drift(patch);
    best.energy += energy(patch, density);
    best.defects += defects(patch);
    const double energy_before = best.energy;
    m_best_places = m_here;
    bool found = false;
    const double diagonal = std::sqrt(0.5);
    const double directions[8][2] = {
      {1, 0},  {diagonal, diagonal},   {0, 1},  {-diagonal, diagonal},
      {-1, 0}, {-diagonal, -diagonal}, {0, -1}, {diagonal, -diagonal}};
    const auto put = [&](const std::vector<Placed_vertex>& places) {
      for(std::size_t i = 0; i < group.size(); ++i)
        m_placed[group[i]] = places[i];
    };
    const auto go = [&](const Vector_3& way) {
      for(std::size_t i = 0; i < group.size(); ++i)
        if(!step_on_surface(m_reference, m_here[i], way, m_placed[group[i]]))
          return false;
      return true;
    };
    const int stride = group.size() > 1 ? 2 : 1;
    for(int k = 0; k < 8; k += stride)
    {
      if(go(reach * (frame * Vector_2(directions[k][0], directions[k][1]))))
      {
        // drift and defects are costly to measure
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
            m_best_places[i] = m_placed[group[i]];
        }
      }
      put(m_here);
    }
    put(m_best_places);
    gain += (std::max)(0., energy_before - best.energy); // a defect that is mended may cost energy
    return found;
  }

  const Reference_surface& m_reference;
  Interruption* m_interruption;
  double m_bad = std::numeric_limits<double>::infinity();
  double m_sharp = 1;
  const Patch_samples* m_samples = nullptr;
  std::vector<Placed_vertex> m_placed;
  std::vector<std::vector<int>> m_guests; // per polygon
  // around the vertices that move: faces, triangles, and stencils of the patch
  std::vector<int> m_star, m_triangles, m_star_stencils;
  std::vector<Placed_vertex> m_here, m_best_places; // of these
  std::vector<Group> m_groups;
  std::vector<double> m_length; // per vertex: of its way
  double m_optimization_time = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_ON_SURFACE_SEARCH_MOVER_H
