// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FEATURE_DETECTION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FEATURE_DETECTION_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/connected_region.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// What tells a mechanical part from a scan, of one connected component or of all that has one verdict.
struct Feature_evidence
{
  double area = 0;
  double sharp_length = 0; // of edges that turn by more than 40 degrees
  double crisp_length = 0; // of those beside which the surface turns by less than a third of that
  std::size_t sharp_edges = 0, turned_edges = 0; // that turn by more than 40, 20 degrees
  std::size_t edges = 0;
  double flat_area = 0; // of faces with a neighbour that goes on in the same plane

  // without unit; lines that are short against the size of a component say nothing about it
  double amount() const { return area > 0 ? sharp_length / std::sqrt(area) : 0; }
  double crisp_share() const { return sharp_length > 0 ? crisp_length / sharp_length : 0; }
  double sharp_share() const
  {
    return turned_edges > 0 ? double(sharp_edges) / double(turned_edges) : 0;
  }
  double flat_share() const { return area > 0 ? flat_area / area : 0; }
  double turned_share() const { return edges > 0 ? double(turned_edges) / double(edges) : 0; }
  // it is made of planes and strips; or sharp edges are lines, or hardly any edge is turned that is not
  // sharp, or few are and most edges are not turned at all
  bool is_mechanical() const
  {
    return amount() > 0.25 && (flat_share() > 0.8 || crisp_share() > 0.92 || sharp_share() > 0.65 ||
                               (sharp_share() > 0.4 && turned_share() < 0.25));
  }
};

struct Detected_features
{
  // per corner of the surface's triangles, at both sides of an edge
  std::vector<char> is_feature;
  // per triangle: whether it is of a mechanical part; empty if none is
  std::vector<char> is_mechanical;
  std::size_t number_of_edges = 0;
  // of the largest component that is a part; if none is, of the largest one
  Feature_evidence evidence;
};

// The feature lines of a surface: the sharp edges of mechanical parts. There edges are sharp or not turned
// at all, and sharp ones are lines with smooth ground on both sides; on scans sharp edges are surrounded by
// edges that turn nearly as much, and there are many more that turn a little less. Each connected
// component is judged by itself. Folds are no features: edges where a face is turned against the
// surface's own vertex normals.
class Feature_detection
{
public:
  explicit Feature_detection(const Reference_surface& surface)
    : m_surface(surface),
      m_mesh(surface.mesh())
  {
    m_result.is_feature.assign(m_mesh.number_of_corners(), 0);
    m_result.is_mechanical.assign(m_mesh.number_of_faces(), 0);
    measure_turns();
    std::vector<char> is_left(m_mesh.number_of_faces(), 1);
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
      if(is_left[f])
        judge(take_connected_region(m_mesh, f, is_left));
  }

  Detected_features take()
  {
    if(!m_has_parts)
      m_result.is_mechanical.clear();
    return std::move(m_result);
  }

private:
  // degrees; a regular polygon of nine vertices turns by 40, but for rounding
  static constexpr double sharp_turn = 39.9, small_turn = 20, no_turn = 1;

  void measure_turns()
  {
    m_turn.assign(m_mesh.number_of_corners(), 0);
    for(int c = 0; c < m_mesh.number_of_corners(); ++c)
    {
      const int o = m_mesh.opposite[c];
      if(o < c)
        continue;
      const Vector_3 a = m_surface.face_normal(m_mesh.corner_face[c]),
                     b = m_surface.face_normal(m_mesh.corner_face[o]);
      if(!is_flat(m_mesh.corner_face[c], a) && !is_flat(m_mesh.corner_face[o], b))
        m_turn[c] = m_turn[o] = degrees_per_radian * std::atan2(a.cross(b).norm(), a.dot(b));
    }
  }

  // whether rounding has a say in where a face looks
  bool is_flat(int f, const Vector_3& normal) const
  {
    double longest = 0;
    for(int i = 0; i < 3; ++i)
      longest = (std::max)(
        longest, (m_surface.corner_point(f, i) - m_surface.corner_point(f, (i + 1) % 3)).norm());
    const double rounding = 1e-10;
    return !(normal.norm() > rounding * longest * longest);
  }

  void judge(const std::vector<int>& component)
  {
    Feature_evidence e;
    std::vector<int> sharp; // corners
    for(const int f : component)
    {
      e.area += 0.5 * m_surface.face_normal(f).norm();
      bool goes_on = false;
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        goes_on = goes_on || (m_mesh.opposite[c] >= 0 && m_turn[c] < no_turn);
      e.flat_area += goes_on ? 0.5 * m_surface.face_normal(f).norm() : 0;
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
      {
        if(m_mesh.opposite[c] < c)
          continue;
        ++e.edges;
        if(!(m_turn[c] > small_turn) || is_fold(c))
          continue;
        ++e.turned_edges;
        if(!(m_turn[c] > sharp_turn))
          continue;
        ++e.sharp_edges;
        e.sharp_length += length(c);
        e.crisp_length += is_crisp(c) ? length(c) : 0;
        sharp.push_back(c);
      }
    }
    const bool was_mechanical = m_result.evidence.is_mechanical(),
               is_mechanical = e.is_mechanical();
    if(is_mechanical != was_mechanical ? is_mechanical : e.area > m_result.evidence.area)
      m_result.evidence = e;
    if(!is_mechanical)
      return;
    m_has_parts = true;
    for(const int f : component)
      m_result.is_mechanical[f] = 1;
    for(const int c : sharp)
      m_result.is_feature[c] = m_result.is_feature[m_mesh.opposite[c]] = 1;
    m_result.number_of_edges += sharp.size();
  }

  Vector_3 direction(int c) const
  {
    return m_surface.points()[m_mesh.target(c)] - m_surface.points()[m_mesh.source(c)];
  }
  double length(int c) const { return direction(c).norm(); }

  // Whether the surface turns much less at the edges beside this one: at three quarters of those at its
  // ends, but for its continuations and for edges that are about as sharp, where lines meet.
  bool is_crisp(int c)
  {
    m_beside.clear();
    collect_beside(c);
    collect_beside(m_mesh.opposite[c]);
    if(m_beside.empty())
      return true;
    const std::size_t k = (3 * m_beside.size()) / 4;
    std::nth_element(m_beside.begin(), m_beside.begin() + k, m_beside.end());
    return m_beside[k] < m_turn[c] / 3;
  }

  // at the target of c
  void collect_beside(int c)
  {
    const int v = m_mesh.target(c), from = m_mesh.source(c);
    const Vector_3 ahead = direction(c).normalized();
    const std::size_t first = m_beside.size();
    double best = 0;
    std::size_t continuation = std::size_t(-1);
    const int enough = 64; // edges of a vertex
    const int end = (std::min)(m_mesh.vertex_begin[v + 1], m_mesh.vertex_begin[v] + enough);
    for(int k = m_mesh.vertex_begin[v]; k < end; ++k)
    {
      const int d = m_mesh.vertex_corners[k]; // leaves v
      if(m_mesh.target(d) == from || m_mesh.opposite[d] < 0)
        continue;
      const double cosine = ahead.dot(direction(d).normalized());
      if(cosine > 0.5 && m_turn[d] * cosine > best)
      {
        best = m_turn[d] * cosine;
        continuation = m_beside.size();
      }
      m_beside.push_back(m_turn[d]);
    }
    if(continuation != std::size_t(-1))
      m_beside.erase(m_beside.begin() + continuation);
    m_beside.erase(std::remove_if(m_beside.begin() + first, m_beside.end(),
                                  [&](double turn) { return turn >= 0.75 * m_turn[c]; }),
                   m_beside.end());
  }

  bool is_fold(int c) const
  {
    const double fold_turn = 120;
    return m_turn[c] > fold_turn && (is_reversed(m_mesh.corner_face[c]) ||
                                     is_reversed(m_mesh.corner_face[m_mesh.opposite[c]]));
  }
  bool is_reversed(int f) const
  {
    return m_surface.face_normal(f).dot(
             m_surface.normal(m_surface.point(f, Vector_3::Constant(1. / 3)))) < 0;
  }

  const Reference_surface& m_surface;
  const Indexed_mesh& m_mesh;
  std::vector<double> m_turn; // per corner: of its edge, in degrees
  std::vector<double> m_beside;
  bool m_has_parts = false;
  Detected_features m_result;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FEATURE_DETECTION_H
