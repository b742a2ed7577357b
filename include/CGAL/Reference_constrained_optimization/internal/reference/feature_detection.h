// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FEATURE_DETECTION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FEATURE_DETECTION_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/connected_region.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/corner_angle.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/Reference_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/flat_regions.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Statistics by which mechanical parts and scans are distinguished, of one connected component. A triangle
// that was split into several counts as one.
struct Feature_statistics
{
  double area = 0;
  double sharp_length = 0; // of edges with a dihedral angle above 40 degrees
  // of those with adjacent edges of less than a third of their dihedral angle
  double crisp_length = 0;
  double bent_length = 0;                        // between 10 and 40 degrees
  std::size_t sharp_edges = 0, turned_edges = 0; // with a dihedral angle above 40, 20 degrees
  std::size_t edges = 0;
  // areas beside the same edges, of the smaller face each: noise turns slivers, and so counts little
  double sharp_area = 0, turned_area = 0;
  double flat_area = 0; // of faces with a coplanar neighbour
  // of planes of two faces, and of more, up to rounding
  double pair_area = 0, plane_area = 0;
  double shortest_edge = std::numeric_limits<double>::infinity();

  // dimensionless; lines that are short compared with the component are not significant
  double amount() const { return area > 0 ? sharp_length / std::sqrt(area) : 0; }
  bool is_significant() const { return amount() > 0.25; }
  double crisp_share() const { return sharp_length > 0 ? crisp_length / sharp_length : 0; }
  double sharp_share() const
  {
    return turned_edges > 0 ? double(sharp_edges) / double(turned_edges) : 0;
  }
  double sharp_area_share() const { return turned_area > 0 ? sharp_area / turned_area : 0; }
  double flat_share() const { return area > 0 ? flat_area / area : 0; }
  double turned_share() const { return edges > 0 ? double(turned_edges) / double(edges) : 0; }
  // it consists of planes and strips; or sharp edges form lines, or hardly any edge has an angle that is
  // neither sharp nor small, or few have and most angles are small
  bool is_mechanical() const
  {
    return is_significant() &&
           (flat_share() > 0.85 || crisp_share() > 0.92 || sharp_share() > 0.65 ||
            (sharp_area_share() > 0.5 && turned_share() < 0.45) ||
            (sharp_share() > 0.4 && turned_share() < 0.25));
  }
  // tessellated from planes, cylinders and cones, whose fillets of a few steps leave hardly a sharp edge.
  // Marching cubes make planes, too, and vertices that nearly coincide.
  bool is_rounded() const
  {
    const double size = std::sqrt(area);
    return bent_length > 0.25 * size && shortest_edge > 1e-6 * size &&
           (pair_area + plane_area > 0.65 * area || plane_area > 0.05 * area);
  }
};

struct Detected_features
{
  // per corner of the surface's triangles, at both sides of an edge
  std::vector<char> is_feature;
  // per triangle: whether it belongs to a mechanical part; empty if none does
  std::vector<char> is_mechanical;
  std::size_t number_of_edges = 0;
  // of the largest component that is a part; if none is, of the largest one
  Feature_statistics statistics;
};

// The feature lines of a surface: the sharp edges of mechanical parts. There edges are sharp or flat, and
// sharp ones form lines between smooth regions; on scans sharp edges are surrounded by edges of nearly the
// same dihedral angle, and there are many more with slightly smaller ones. Each connected component is
// classified separately. Folds are no features: edges where a face is inverted with respect to the
// surface's own vertex normals.
class Feature_detection
{
public:
  // `takes_rounded`: whether rounded parts are mechanical, too
  explicit Feature_detection(const Reference_surface& surface, bool takes_rounded = false)
    : m_surface(surface),
      m_mesh(surface.mesh()),
      m_takes_rounded(takes_rounded)
  {
    m_result.is_feature.assign(m_mesh.number_of_corners(), 0);
    m_result.is_mechanical.assign(m_mesh.number_of_faces(), 0);
    m_is_inside.assign(m_mesh.number_of_corners(), 0);
    m_region_of_face.assign(m_mesh.number_of_faces(), -1);
    compute_dihedral_angles();
    std::vector<char> is_unvisited(m_mesh.number_of_faces(), 1);
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
      if(is_unvisited[f])
        classify(extract_connected_region(m_mesh, f, is_unvisited));
  }

  Detected_features result()
  {
    if(!m_has_mechanical_parts)
      m_result.is_mechanical.clear();
    return std::move(m_result);
  }

private:
  // degrees; the exterior angles of a regular polygon of nine vertices are 40, up to rounding
  static constexpr double sharp_angle = 39.9, small_angle = 20, bent_angle = 10, flat_angle = 1,
                          rounding_angle = 0.02;

  void compute_dihedral_angles()
  {
    m_dihedral_angle.assign(m_mesh.number_of_corners(), 0);
    for(int c = 0; c < m_mesh.number_of_corners(); ++c)
    {
      const int o = m_mesh.opposite[c];
      if(o < c)
        continue;
      const Vector_3 a = m_surface.face_normal(m_mesh.corner_face[c]),
                     b = m_surface.face_normal(m_mesh.corner_face[o]);
      if(!is_degenerate(m_mesh.corner_face[c], a) && !is_degenerate(m_mesh.corner_face[o], b))
        m_dihedral_angle[c] = m_dihedral_angle[o] =
          degrees_per_radian * std::atan2(a.cross(b).norm(), a.dot(b));
    }
  }

  // whether rounding affects the normal of a face
  bool is_degenerate(int f, const Vector_3& normal) const
  {
    double longest = 0;
    for(int i = 0; i < 3; ++i)
      longest = (std::max)(
        longest, (m_surface.corner_point(f, i) - m_surface.corner_point(f, (i + 1) % 3)).norm());
    const double rounding = 1e-10;
    return !(normal.norm() > rounding * longest * longest);
  }

  void classify(const std::vector<int>& component)
  {
    Feature_statistics e;
    find_split_triangles(component);
    std::vector<int> sharp; // corners
    for(const int f : component)
    {
      e.area += face_area(f);
      bool has_coplanar_neighbour = false;
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
        has_coplanar_neighbour =
          has_coplanar_neighbour ||
          (m_mesh.opposite[c] >= 0 && !m_is_inside[c] && m_dihedral_angle[c] < flat_angle);
      e.flat_area += has_coplanar_neighbour ? face_area(f) : 0;
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
      {
        if(m_mesh.opposite[c] < c || m_is_inside[c])
          continue;
        ++e.edges;
        e.shortest_edge = (std::min)(e.shortest_edge, length(c));
        const bool is_bent = m_dihedral_angle[c] > bent_angle && m_dihedral_angle[c] <= sharp_angle;
        e.bent_length += is_bent ? length(c) : 0;
        if(!(m_dihedral_angle[c] > small_angle) || is_fold(c))
          continue;
        const double area =
          (std::min)(face_area(f), face_area(m_mesh.corner_face[m_mesh.opposite[c]]));
        ++e.turned_edges;
        e.turned_area += area;
        if(!(m_dihedral_angle[c] > sharp_angle))
          continue;
        ++e.sharp_edges;
        e.sharp_area += area;
        e.sharp_length += length(c);
        e.crisp_length += is_crisp(c) ? length(c) : 0;
        sharp.push_back(c);
      }
    }
    add_planes(component, e);
    const bool was_mechanical = m_result.statistics.is_mechanical(),
               is_mechanical = e.is_mechanical();
    if(is_mechanical != was_mechanical ? is_mechanical : e.area > m_result.statistics.area)
      m_result.statistics = e;
    if(!is_mechanical && !(m_takes_rounded && e.is_rounded()))
      return;
    m_has_mechanical_parts = true;
    for(const int f : component)
      m_result.is_mechanical[f] = 1;
    if(!e.is_significant())
      return;
    for(const int c : sharp)
      add(c);
    for(const int c : sharp)
    {
      follow(c);
      follow(m_mesh.opposite[c]);
    }
  }

  // Marks the edges inside of regions whose outline is a triangle.
  void find_split_triangles(const std::vector<int>& component)
  {
    visit_regions(component, flat_angle, [&](const std::vector<int>& region) {
      if(!is_triangle(region))
        return;
      for(const int f : region)
        for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
          m_is_inside[c] =
            m_mesh.opposite[c] >= 0 &&
            m_region_of_face[m_mesh.corner_face[m_mesh.opposite[c]]] == m_region_of_face[f];
    });
  }

  void add_planes(const std::vector<int>& component, Feature_statistics& e)
  {
    visit_regions(component, rounding_angle, [&](const std::vector<int>& region) {
      if(is_triangle(region))
        return;
      double area = 0;
      for(const int f : region)
        area += face_area(f);
      (region.size() == 2 ? e.pair_area : e.plane_area) += area;
    });
  }

  template <typename Visit>
  void visit_regions(const std::vector<int>& component, double angle, Visit visit)
  {
    for_each_flat_region(
      m_mesh, component, [&](int c) { return m_dihedral_angle[c] < angle; }, m_region_of_face,
      visit);
  }
  bool is_triangle(const std::vector<int>& region) const
  {
    return region.size() == 1 || number_of_outline_corners(m_mesh, m_surface.points(), region,
                                                           m_region_of_face, flat_angle) == 3;
  }

  void add(int c)
  {
    m_result.is_feature[c] = m_result.is_feature[m_mesh.opposite[c]] = 1;
    ++m_result.number_of_edges;
  }

  // A line that ends at the target of c goes on while its edges are crisp: where surfaces of a part meet
  // along a line, their angle may fade.
  void follow(int c)
  {
    const double faded_angle = 5; // degrees
    while(true)
    {
      const int d = continuation(c, 0.7);
      if(d < 0 || is_line_vertex(m_mesh.target(c), c) || !(m_dihedral_angle[d] > faded_angle) ||
         !is_crisp(d))
        return;
      add(d);
      c = d;
    }
  }

  // whether another feature edge than that of c ends at v
  bool is_line_vertex(int v, int c) const
  {
    for(int k = m_mesh.vertex_begin[v]; k < m_mesh.vertex_begin[v + 1]; ++k)
      if(const int d = m_mesh.vertex_corners[k]; d != m_mesh.opposite[c] && m_result.is_feature[d])
        return true;
    return false;
  }

  // The edge at the target of c that goes on in its direction, with the largest dihedral angle; -1 if there
  // is none.
  int continuation(int c, double smallest_cosine) const
  {
    const int v = m_mesh.target(c);
    const Vector_3 ahead = direction(c).normalized();
    int result = -1;
    double best = 0;
    for(int k = m_mesh.vertex_begin[v]; k < vertex_end(v); ++k)
    {
      const int d = m_mesh.vertex_corners[k]; // leaves v
      if(m_mesh.target(d) == m_mesh.source(c) || m_mesh.opposite[d] < 0)
        continue;
      const double cosine = ahead.dot(direction(d).normalized());
      if(cosine > smallest_cosine && m_dihedral_angle[d] * cosine > best)
      {
        best = m_dihedral_angle[d] * cosine;
        result = d;
      }
    }
    return result;
  }

  // of the corners of v that are looked at
  int vertex_end(int v) const
  {
    const int largest_valence = 64;
    return (std::min)(m_mesh.vertex_begin[v + 1], m_mesh.vertex_begin[v] + largest_valence);
  }

  Vector_3 direction(int c) const
  {
    return m_surface.points()[m_mesh.target(c)] - m_surface.points()[m_mesh.source(c)];
  }
  double length(int c) const { return direction(c).norm(); }
  double face_area(int f) const { return 0.5 * m_surface.face_normal(f).norm(); }

  // Whether the dihedral angles of adjacent edges are much smaller: those of three quarters of the edges at
  // its ends, except for its continuations and for edges of about the same angle, where lines meet.
  bool is_crisp(int c)
  {
    m_adjacent_angles.clear();
    collect_adjacent_angles(c);
    collect_adjacent_angles(m_mesh.opposite[c]);
    if(m_adjacent_angles.empty())
      return true;
    const std::size_t k = (3 * m_adjacent_angles.size()) / 4;
    std::nth_element(m_adjacent_angles.begin(), m_adjacent_angles.begin() + k,
                     m_adjacent_angles.end());
    return m_adjacent_angles[k] < m_dihedral_angle[c] / 3;
  }

  // at the target of c; if nothing ends there but edges inside of split triangles, where it goes on
  void collect_adjacent_angles(int c)
  {
    const std::size_t first = m_adjacent_angles.size();
    const int most_pieces = 64;
    for(int i = 0; i < most_pieces && c >= 0; ++i)
    {
      const int v = m_mesh.target(c), ahead = continuation(c, 0.5);
      bool is_on_edge = false;
      for(int k = m_mesh.vertex_begin[v]; k < vertex_end(v); ++k)
      {
        const int d = m_mesh.vertex_corners[k];
        if(m_mesh.target(d) == m_mesh.source(c) || m_mesh.opposite[d] < 0 || d == ahead)
          continue;
        if(m_is_inside[d])
          is_on_edge = true;
        else
          m_adjacent_angles.push_back(m_dihedral_angle[d]);
      }
      if(!is_on_edge || m_adjacent_angles.size() > first)
        break;
      c = ahead;
    }
    m_adjacent_angles.erase(
      std::remove_if(m_adjacent_angles.begin() + first, m_adjacent_angles.end(),
                     [&](double angle) { return angle >= 0.75 * m_dihedral_angle[c]; }),
      m_adjacent_angles.end());
  }

  bool is_fold(int c) const
  {
    const double fold_angle = 120;
    return m_dihedral_angle[c] > fold_angle &&
           (is_reversed(m_mesh.corner_face[c]) ||
            is_reversed(m_mesh.corner_face[m_mesh.opposite[c]]));
  }
  bool is_reversed(int f) const
  {
    return m_surface.face_normal(f).dot(
             m_surface.normal(m_surface.point(f, Vector_3::Constant(1. / 3)))) < 0;
  }

  const Reference_surface& m_surface;
  const Indexed_mesh& m_mesh;
  bool m_takes_rounded;
  std::vector<double> m_dihedral_angle; // per corner: of its edge, in degrees
  std::vector<double> m_adjacent_angles;
  std::vector<char> m_is_inside; // per corner: its edge is inside of a split triangle
  std::vector<int> m_region_of_face;
  bool m_has_mechanical_parts = false;
  Detected_features m_result;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_FEATURE_DETECTION_H
