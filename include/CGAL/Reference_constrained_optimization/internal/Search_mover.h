// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SEARCH_MOVER_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SEARCH_MOVER_H

#include <CGAL/Reference_constrained_optimization/internal/interruption.h>
#include <CGAL/Reference_constrained_optimization/internal/seconds_since.h>
#include <CGAL/Reference_constrained_optimization/internal/tangent_frame.h>
#include <CGAL/Reference_constrained_optimization/internal/tangent_step.h>

#include <Eigen/Core>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Moves the vertices around bad elements one by one, each to the best of a few points of R around it.
// Newton steps trust a model that is smooth; where R has a sharp vertex or a crease of the size of an
// element the energy on R is not, and they end in front of it. A pattern search needs no model. It is
// slow, but only the few elements that are left behind by the others are its business.
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
  bool propose(const Patch& patch, const Density& density)
  {
    const auto start = std::chrono::steady_clock::now();
    m_placed = patch.placed;
    const bool moves = search(patch, density);
    m_optimization_time = seconds_since(start);
    return moves;
  }

  template <typename Density>
  bool propose_again(const Patch&, const std::vector<double>&, const Density&)
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

  template <typename Density>
  double energy(const Patch& patch, const Density& density, int v) const
  {
    const Indexed_mesh& mesh = patch.polygons;
    const auto vertex = [&](int w) -> const Placed_vertex& { return m_placed[w]; };
    double sum = 0;
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int f = mesh.corner_face[mesh.vertex_corners[k]];
      for(int e = patch.element_begin[f]; e < patch.element_begin[f + 1]; ++e)
        sum += element_energy(density, patch.elements[e], vertex);
    }
    return sum;
  }

  int defects(const Patch& patch, int v) const
  {
    const Indexed_mesh& mesh = patch.polygons;
    const auto vertex = [&](int w) -> const Placed_vertex& { return m_placed[w]; };
    int count = 0;
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int f = mesh.corner_face[mesh.vertex_corners[k]];
      const Vector_3 normal = face_normal(mesh, vertex, f);
      count += is_flipped(mesh, vertex, f, normal) + is_nonconvex(mesh, vertex, f);
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        if(mesh.opposite[c] >= 0)
          count += is_folded(normal, face_normal(mesh, vertex, mesh.corner_face[mesh.opposite[c]]));
    }
    return count;
  }

  // the drift of the faces around a vertex
  Star_measure drift(const Patch& patch, int v) const
  {
    Star_measure m;
    if(patch.samples.empty())
      return m;
    const Indexed_mesh& mesh = patch.triangles();
    const auto vertex = [&](int w) -> const Placed_vertex& { return m_placed[w]; };
    const auto add = [&](double distance, double bound) {
      m.energy += patch.barrier.value(distance, bound);
      m.defects += distance > Drift_barrier::last_part * bound;
    };
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int t = mesh.corner_face[mesh.vertex_corners[k]];
      for(int i = 0; i < 4; ++i)
      {
        const int s = sample_of(patch, t, i);
        if(s < 0)
          continue;
        Patch::Sample sample = patch.samples[s];
        locate_sample(patch, m_reference, vertex, s, sample);
        add(sample.distance, patch.bound_of_triangle(s / 4));
      }
      for(const int g : m_guests[patch.polygon_of(t)])
      {
        Patch::Guest guest = patch.guests[g];
        locate_guest(patch, m_reference, vertex, guest);
        add(guest.distance, guest.bound);
      }
    }
    return m;
  }

  void sort_guests(const Patch& patch)
  {
    m_guests.assign(patch.polygons.number_of_faces(), {});
    for(std::size_t g = 0; g < patch.guests.size(); ++g)
      m_guests[patch.guests[g].polygon].push_back(int(g));
  }

  // the vertices of bad elements that may move, and those around them
  template <typename Density>
  std::vector<int> collect(const Patch& patch, const Density& density) const
  {
    const Indexed_mesh& mesh = patch.polygons;
    const auto vertex = [&](int v) -> const Placed_vertex& { return m_placed[v]; };
    std::vector<char> is_wanted(patch.vertices.size(), 0);
    for(const Element_set::Element& e : patch.elements)
      if(element_energy(density, e, vertex) > m_bad || smallest_angle_cosine(e, vertex) > m_sharp)
        for(const int v : e.vertices)
          for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
          {
            const int c = mesh.vertex_corners[k];
            is_wanted[v] = is_wanted[mesh.target(c)] = is_wanted[mesh.source(mesh.previous(c))] = 1;
          }
    std::vector<int> vertices;
    for(int v = 0; v < int(is_wanted.size()); ++v)
      if(is_wanted[v] && patch.is_free[v] && !patch.slides(v))
        vertices.push_back(v);
    return vertices;
  }

  template <typename Density>
  bool search(const Patch& patch, const Density& density)
  {
    const Indexed_mesh& mesh = patch.polygons;
    const std::vector<int> vertices = collect(patch, density);
    const double first_reach = 0.3, last_reach = 0.01; // in mean edges at the vertex
    const int maximum_sweeps = 40;
    sort_guests(patch);
    m_length.assign(patch.vertices.size(), 0);
    m_reach.assign(vertices.size(), first_reach);
    bool has_moved = false, goes_on = !vertices.empty();
    for(int sweep = 0; goes_on && sweep < maximum_sweeps; ++sweep)
    {
      goes_on = false;
      for(std::size_t i = 0; i < vertices.size(); ++i)
      {
        const int v = vertices[i];
        if(m_reach[i] < last_reach)
          continue;
        goes_on = true;
        check_now_and_then(m_interruption, int(i));
        double edge = 0;
        for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
          edge +=
            (m_placed[mesh.target(mesh.vertex_corners[k])].position - m_placed[v].position).norm();
        edge /= mesh.vertex_begin[v + 1] - mesh.vertex_begin[v];
        if(improve(patch, density, v, m_reach[i] * edge))
        {
          has_moved = true;
          m_reach[i] = (std::min)(first_reach, 1.5 * m_reach[i]);
          // what is around has changed: it is looked at again
          for(std::size_t j = 0; j < vertices.size(); ++j)
            if(m_reach[j] < last_reach && are_neighbours(mesh, v, vertices[j]))
              m_reach[j] = 4 * last_reach;
        }
        else
          m_reach[i] *= 0.5;
      }
    }
    for(const int v : vertices)
      m_length[v] = (m_placed[v].position - patch.placed[v].position).norm();
    return has_moved;
  }

  static bool are_neighbours(const Indexed_mesh& mesh, int v, int w)
  {
    for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
    {
      const int c = mesh.vertex_corners[k];
      if(mesh.target(c) == w || mesh.source(mesh.previous(c)) == w)
        return true;
    }
    return false;
  }

  // takes a vertex to the best of eight points at the given distance, if one is better than its own
  template <typename Density>
  bool improve(const Patch& patch, const Density& density, int v, double reach)
  {
    const Placed_vertex here = m_placed[v];
    const Tangent_frame frame = tangent_frame(here.normal);
    Star_measure best = drift(patch, v);
    best.energy += energy(patch, density, v);
    best.defects += defects(patch, v);
    Placed_vertex best_place = here;
    bool found = false;
    const double diagonal = std::sqrt(0.5);
    const double directions[8][2] = {
      {1, 0},  {diagonal, diagonal},   {0, 1},  {-diagonal, diagonal},
      {-1, 0}, {-diagonal, -diagonal}, {0, -1}, {diagonal, -diagonal}};
    for(const double(&d)[2] : directions)
    {
      Placed_vertex& there = m_placed[v];
      if(step_on_surface(m_reference, here, reach * (frame * Vector_2(d[0], d[1])), there))
      {
        // drift and defects are costly to measure
        Star_measure m{energy(patch, density, v), 0};
        if(m < best)
        {
          const Star_measure d = drift(patch, v);
          m.energy += d.energy;
          m.defects = d.defects + defects(patch, v);
        }
        if(m < best)
        {
          best = m;
          best_place = there;
          found = true;
        }
      }
      m_placed[v] = here;
    }
    m_placed[v] = best_place;
    return found;
  }

  const Reference_surface& m_reference;
  Interruption* m_interruption;
  double m_bad = std::numeric_limits<double>::infinity();
  double m_sharp = 1;
  std::vector<Placed_vertex> m_placed;
  std::vector<std::vector<int>> m_guests; // per polygon
  std::vector<double> m_length, m_reach;
  double m_optimization_time = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SEARCH_MOVER_H
