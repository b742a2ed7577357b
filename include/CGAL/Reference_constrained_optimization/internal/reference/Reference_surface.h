// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_REFERENCE_SURFACE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_REFERENCE_SURFACE_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/connected_region.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/has_area.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/split_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/reference/closest_point.h>
#include <CGAL/Reference_constrained_optimization/internal/support/compatibility.h>

#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <mutex>
#include <queue>
#include <unordered_set>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// a point of the reference: where it is, in which triangle, and its barycentric coordinates there
struct Surface_point
{
  Vector_3 position = Vector_3::Zero();
  int face = -1;
  Vector_3 barycentric = Vector_3::Zero();
};

// The reference R: triangles, unit area-weighted vertex normals, global and local closest points.
class Reference_surface
{
  typedef CGAL::Simple_cartesian<double> Kernel;
  typedef std::vector<Kernel::Triangle_3>::const_iterator Triangle_iterator;
  typedef std::vector<Kernel::Segment_3>::const_iterator Segment_iterator;

public:
  explicit Reference_surface(const Mesh_copy& copy, double distance_of_origin = 0)
    : m_points(copy.points),
      m_search(std::make_unique<Search>())
  {
    split(copy);
    m_diagonal = bounding_box_diagonal(m_mesh, m_points);
    if(m_diagonal > 0 && !is_safe_diagonal(m_diagonal))
      throw Invalid_input("reference: its diagonal is not between 1e-60 and 1e60: other units of "
                          "length are needed");
    if(!has_area(
         m_mesh, [this](int v) -> const Vector_3& { return m_points[v]; }, distance_of_origin))
      throw Invalid_input("reference: every face has zero area");
    compute_normals();
    find_creases();
    m_mean_edge_length = internal::mean_edge_length(m_mesh, m_points);
    m_area = surface_area(m_mesh, m_points);
  }

  const Indexed_mesh& mesh() const { return m_mesh; }
  const std::vector<Vector_3>& points() const { return m_points; }
  double diagonal() const { return m_diagonal; }
  double mean_edge_length() const { return m_mean_edge_length; }
  double area() const { return m_area; }
  int original_face(int f) const { return m_original_face[f]; }

  const Vector_3& corner_point(int f, int i) const
  {
    return m_points[m_mesh.corner_vertex[m_mesh.face_begin[f] + i]];
  }

  Surface_point point(int f, const Vector_3& barycentric) const
  {
    Surface_point s;
    s.face = f;
    s.barycentric = barycentric;
    s.position = barycentric(0) * corner_point(f, 0) + barycentric(1) * corner_point(f, 1) +
                 barycentric(2) * corner_point(f, 2);
    return s;
  }

  // vertex normals, interpolated linearly; not of unit length
  Vector_3 normal(const Surface_point& s) const
  {
    Vector_3 n = Vector_3::Zero();
    for(int i = 0; i < 3; ++i)
      n += s.barycentric(i) * m_normals[m_mesh.corner_vertex[m_mesh.face_begin[s.face] + i]];
    return n;
  }

  // not of unit length; its orientation is that of the input, also after reverse()
  Vector_3 face_normal(int f) const
  {
    return (corner_point(f, 1) - corner_point(f, 0)).cross(corner_point(f, 2) - corner_point(f, 0));
  }

  // whether rounding affects the plane of a face, or its squared area underflows
  bool is_degenerate(int f) const
  {
    const double length = side_length(f, longest_side(f));
    const double rounding = 1e-14, smallest = 1e-150;
    return !(face_normal(f).norm() > (std::max)(rounding * length * length, smallest));
  }

  // whether R is sharp at the edge at corner c
  bool is_crease(int c) const
  {
    const double cosine = 0.9; // of the angle between the normals on both sides
    const int o = m_mesh.opposite[c];
    if(o < 0)
      return false;
    const Vector_3 a = face_normal(m_mesh.corner_face[c]), b = face_normal(m_mesh.corner_face[o]);
    return a.dot(b) < cosine * a.norm() * b.norm();
  }

  // one corner for each edge where R is sharp
  const std::vector<int>& creases() const { return m_creases; }

  // Samples of R whose distance to the mesh is bounded: first the vertices, then the midpoints of the
  // creases, where a mesh with vertices on both sides is furthest away.
  int number_of_reference_samples() const
  {
    return m_mesh.number_of_vertices() + int(m_creases.size());
  }
  int crease(int reference_sample) const
  {
    return m_creases[reference_sample - m_mesh.number_of_vertices()];
  }
  Vector_3 reference_sample(int i) const
  {
    if(i < m_mesh.number_of_vertices())
      return m_points[i];
    const int c = crease(i);
    return 0.5 * (m_points[m_mesh.source(c)] + m_points[m_mesh.target(c)]);
  }

  // the same, with the orientation that reverse() gave to the vertices' normals
  Vector_3 oriented_face_normal(int f) const
  {
    return m_is_reversed.empty() || !m_is_reversed[f] ? face_normal(f) : Vector_3(-face_normal(f));
  }

  // reverses the normals of whole components, given by their faces
  void reverse(const std::vector<char>& is_reversed)
  {
    m_is_reversed.resize(is_reversed.size(), 0);
    for(std::size_t f = 0; f < is_reversed.size(); ++f)
      m_is_reversed[f] = m_is_reversed[f] != is_reversed[f];
    for(int v = 0; v < m_mesh.number_of_vertices(); ++v)
      if(!m_mesh.is_isolated(v) && is_reversed[m_mesh.face_at(v)])
        m_normals[v] = -m_normals[v];
  }

  Surface_point closest_in_face(const Vector_3& p, int f) const
  {
    return point(
      f, closest_barycentric(p, corner_point(f, 0), corner_point(f, 1), corner_point(f, 2)));
  }

  // the vertex as a point of R; it must have a face
  Surface_point at_vertex(int v) const
  {
    const int c = m_mesh.vertex_corners[m_mesh.vertex_begin[v]], f = m_mesh.corner_face[c];
    return {m_points[v], f, Vector_3::Unit(c - m_mesh.face_begin[f])};
  }

  // closest point of all of R, by the tree
  Surface_point closest(const Vector_3& p) const
  {
    const Search& s = search();
    return closest_of_degenerate_edges(
      p, s.triangles.empty() ? Surface_point()
                             : closest_of(p, s.tree.closest_point_and_primitive(kernel_point(p))));
  }

  // the same where a point of R is known already: the tree looks only at what is closer
  Surface_point closest(const Vector_3& p, const Surface_point& known) const
  {
    const Search& s = search();
    if(s.triangles.empty())
      return closest_of_degenerate_edges(p, known);
    const auto hit = s.tree.closest_point_and_primitive(
      kernel_point(p), {kernel_point(known.position), Triangle_iterator(s.triangles.end())});
    return closest_of_degenerate_edges(
      p, hit.second == Triangle_iterator(s.triangles.end()) ? known : closest_of(p, hit));
  }

  // The same where a face is known that may be near. The local closest point from there bounds the search,
  // which is skipped if it is p up to rounding.
  Surface_point closest_near(const Vector_3& p, int face, double rounding) const
  {
    const Projection projection = local_closest_point(
      m_mesh, [&](int v) -> const Vector_3& { return m_points[v]; }, p, face,
      largest_small_valence);
    const double distance = std::sqrt(projection.squared_distance);
    const Surface_point known = {projection.position, projection.face, projection.barycentric};
    if(distance <= rounding)
      return known;
    return distance < m_mean_edge_length ? closest(p, known) : closest(p);
  }

  // The same for a vertex of a mesh: the vertex of R that has its number may be near.
  Surface_point closest_from_vertex(const Vector_3& p, int v) const
  {
    return v < m_mesh.number_of_vertices() && !m_mesh.is_isolated(v)
             ? closest_near(p, m_mesh.face_at(v), 1e-14 * m_diagonal)
             : closest(p);
  }

  // The distance from the centroid of a face to the surface opposite to it, through the material or across
  // a gap, at most `largest_distance`. Faces that share a vertex with it are not opposite.
  double clearance(int f, double largest_distance) const
  {
    const Vector_3 middle = (corner_point(f, 0) + corner_point(f, 1) + corner_point(f, 2)) / 3;
    const Vector_3 direction = face_normal(f).normalized();
    double least = largest_distance;
    for(const int g : intersected_faces(middle - largest_distance * direction,
                                        middle + largest_distance * direction))
    {
      const Vector_3 normal = face_normal(g);
      if(!share_vertex(f, g) && normal.dot(direction) != 0)
        least = (std::min)(
          least, std::abs(normal.dot(corner_point(g, 0) - middle) / normal.dot(direction)));
    }
    return least;
  }

  // the faces that have an area and intersect a segment
  std::vector<int> intersected_faces(const Vector_3& source, const Vector_3& target) const
  {
    const Search& s = search();
    std::vector<Triangle_iterator> hits;
    s.tree.all_intersected_primitives(Kernel::Segment_3(kernel_point(source), kernel_point(target)),
                                      std::back_inserter(hits));
    return faces_of(hits);
  }

  bool share_vertex(int f, int g) const
  {
    for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
      for(int d = m_mesh.face_begin[g]; d < m_mesh.face_begin[g + 1]; ++d)
        if(m_mesh.corner_vertex[c] == m_mesh.corner_vertex[d])
          return true;
    return false;
  }

  // the closest point of every face within a distance of p, by the tree
  std::vector<Surface_point> all_within(const Vector_3& p, double distance) const
  {
    const Search& s = search();
    const Vector_3 half = Vector_3::Constant(distance);
    std::vector<Triangle_iterator> hits;
    s.tree.all_intersected_primitives(
      Kernel::Iso_cuboid_3(kernel_point(p - half), kernel_point(p + half)),
      std::back_inserter(hits));
    std::vector<Surface_point> result;
    for(const int f : faces_of(hits))
    {
      const Surface_point q = closest_in_face(p, f);
      if((q.position - p).norm() <= distance)
        result.push_back(q);
    }
    return result;
  }

  // local closest point, from `face` on
  Surface_point local_closest(const Vector_3& p, int face) const
  {
    const Projection projection = local_closest_point(
      m_mesh, [&](int v) -> const Vector_3& { return m_points[v]; }, p, face);
    return {projection.position, projection.face, projection.barycentric};
  }

  // whether `to` can be reached from `from` over vertices of R within the given length of path
  bool is_reachable(const Surface_point& from, const Surface_point& to, double length) const
  {
    typedef std::pair<double, int> Entry;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
    std::unordered_set<int> reached;
    if(from.face == to.face)
      return true;
    const auto corner = [&](int f, int i) {
      return m_mesh.corner_vertex[m_mesh.face_begin[f] + i];
    };
    for(int i = 0; i < 3; ++i)
      queue.push(Entry((corner_point(from.face, i) - from.position).norm(), corner(from.face, i)));
    const std::size_t limit = 2000;
    while(!queue.empty() && reached.size() < limit)
    {
      const Entry e = queue.top();
      queue.pop();
      if(e.first > length)
        return false;
      if(!reached.insert(e.second).second)
        continue;
      for(int i = 0; i < 3; ++i)
        if(corner(to.face, i) == e.second &&
           e.first + (m_points[e.second] - to.position).norm() <= length)
          return true;
      for(int k = m_mesh.vertex_begin[e.second]; k < m_mesh.vertex_begin[e.second + 1]; ++k)
      {
        const int c = m_mesh.vertex_corners[k];
        for(const int v : {m_mesh.target(c), m_mesh.source(m_mesh.previous(c))})
          queue.push(Entry(e.first + (m_points[v] - m_points[e.second]).norm(), v));
      }
    }
    return false;
  }

private:
  // built on first use
  struct Search
  {
    std::once_flag is_built;
    std::vector<Kernel::Triangle_3> triangles;
    std::vector<int> face;   // per triangle
    bool has_pieces = false; // whether some face was subdivided into several triangles
    Triangle_tree<Kernel, Triangle_iterator> tree;
    // Faces of nearly zero area make queries of such a tree inaccurate. They are replaced by their longest
    // edges, unless the face on the other side is not degenerate; components that are a point are such an
    // edge, too.
    std::vector<Kernel::Segment_3> degenerate_edges;
    std::vector<int> degenerate_edge_face;
    Segment_tree<Kernel, Segment_iterator> degenerate_edge_tree;
  };

  static Kernel::Point_3 kernel_point(const Vector_3& p)
  {
    return Kernel::Point_3(p.x(), p.y(), p.z());
  }

  const Search& search() const
  {
    std::call_once(m_search->is_built, [this]() { build_tree(); });
    return *m_search;
  }

  std::vector<int> faces_of(const std::vector<Triangle_iterator>& hits) const
  {
    const Search& s = *m_search;
    std::vector<int> faces;
    for(const Triangle_iterator& hit : hits)
      faces.push_back(s.face[hit - Triangle_iterator(s.triangles.begin())]);
    if(s.has_pieces)
    {
      std::sort(faces.begin(), faces.end());
      faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    }
    return faces;
  }

  template <typename Hit>
  Surface_point closest_of(const Vector_3& p, const Hit& hit) const
  {
    const Search& s = *m_search;
    return closest_in_face(p, s.face[hit.second - Triangle_iterator(s.triangles.begin())]);
  }

  // the closest point of a degenerate edge if it is closer by more than rounding, or if no other point is
  // known
  Surface_point closest_of_degenerate_edges(const Vector_3& p, const Surface_point& known) const
  {
    const Search& s = *m_search;
    if(s.degenerate_edges.empty())
      return known;
    const auto hit = s.degenerate_edge_tree.closest_point_and_primitive(kernel_point(p));
    const int face =
      s.degenerate_edge_face[hit.second - Segment_iterator(s.degenerate_edges.begin())];
    const Surface_point on_degenerate_edge = closest_in_face(p, face);
    const double rounding = 1e-14 * m_diagonal;
    return known.face < 0 ||
               (on_degenerate_edge.position - p).norm() + rounding < (known.position - p).norm()
             ? on_degenerate_edge
             : known;
  }

  void build_tree() const
  {
    Search& s = *m_search;
    const double fill = box_to_face_ratio_limit();
    bool has_point = false;
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
    {
      const Vector_3 p[3] = {corner_point(f, 0), corner_point(f, 1), corner_point(f, 2)};
      if(!is_degenerate(f))
      {
        add_pieces(p, f, box_to_face_ratio(f) / fill);
        continue;
      }
      const int i = longest_side(f), behind = m_mesh.opposite[m_mesh.face_begin[f] + i];
      const double length = side_length(f, i);
      has_point = has_point || !(length > 0);
      if(length > 0 && (behind < 0 || is_degenerate(m_mesh.corner_face[behind])))
        add_degenerate_edge(p[i], p[(i + 1) % 3], f);
    }
    if(has_point)
      add_points();
    s.tree.insert(s.triangles.begin(), s.triangles.end());
    s.tree.build();
    s.tree.accelerate_distance_queries();
    s.degenerate_edge_tree.insert(s.degenerate_edges.begin(), s.degenerate_edges.end());
    s.degenerate_edge_tree.build();
    s.degenerate_edge_tree.accelerate_distance_queries();
  }

  void add_degenerate_edge(const Vector_3& from, const Vector_3& to, int f) const
  {
    m_search->degenerate_edges.emplace_back(kernel_point(from), kernel_point(to));
    m_search->degenerate_edge_face.push_back(f);
  }

  // Components that are a single point; the tree requires segments of positive length.
  void add_points() const
  {
    std::vector<char> is_unvisited(m_mesh.number_of_faces(), 1);
    for(int first = 0; first < m_mesh.number_of_faces(); ++first)
      if(is_unvisited[first] && !(side_length(first, longest_side(first)) > 0))
      {
        const std::vector<int> component = extract_connected_region(m_mesh, first, is_unvisited);
        const bool is_point = std::none_of(component.begin(), component.end(), [&](int f) {
          return side_length(f, longest_side(f)) > 0;
        });
        const double tiny_length = 1e-14 * m_diagonal;
        if(is_point)
          add_degenerate_edge(corner_point(first, 0),
                              corner_point(first, 0) + Vector_3(tiny_length, 0, 0), first);
      }
  }

  // Bounding boxes of the faces of a large fan overlap, so that a query would visit all of them. Faces that
  // are small compared with their boxes are subdivided in the tree.
  void add_pieces(const Vector_3* p, int f, double number) const
  {
    Search& s = *m_search;
    if(!(number > 1))
    {
      s.triangles.emplace_back(kernel_point(p[0]), kernel_point(p[1]), kernel_point(p[2]));
      s.face.push_back(f);
      return;
    }
    s.has_pieces = true;
    int i = 0;
    for(const int k : {1, 2})
      if((p[(k + 1) % 3] - p[k]).squaredNorm() > (p[(i + 1) % 3] - p[i]).squaredNorm())
        i = k;
    const Vector_3 &a = p[i], &b = p[(i + 1) % 3], &c = p[(i + 2) % 3], middle = 0.5 * (a + b);
    const Vector_3 first[3] = {a, middle, c}, second[3] = {middle, b, c};
    add_pieces(first, f, number / 2);
    add_pieces(second, f, number / 2);
  }

  // the area of the largest side of a face's bounding box over twice the area of the face, up to a limit
  double box_to_face_ratio(int f) const
  {
    const Vector_3 &a = corner_point(f, 0), &b = corner_point(f, 1), &c = corner_point(f, 2);
    const Vector_3 box = a.cwiseMax(b).cwiseMax(c) - a.cwiseMin(b).cwiseMin(c);
    const double side = (std::max)({box.x() * box.y(), box.y() * box.z(), box.z() * box.x()});
    const double limit = 1024;
    return (std::min)(side / face_normal(f).norm(), limit);
  }

  // the ratio above which a face is subdivided, such that the mean number of pieces per face is bounded
  double box_to_face_ratio_limit() const
  {
    double sum = 0;
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
      if(!is_degenerate(f))
        sum += box_to_face_ratio(f);
    const double at_least = 16, pieces = 8;
    return (std::max)(at_least, sum / (pieces * m_mesh.number_of_faces()));
  }

  int longest_side(int f) const
  {
    int i = 0;
    for(const int k : {1, 2})
      if(side_length(f, k) > side_length(f, i))
        i = k;
    return i;
  }

  double side_length(int f, int i) const
  {
    return (corner_point(f, (i + 1) % 3) - corner_point(f, i)).norm();
  }

  // quads into triangles
  void split(const Mesh_copy& copy)
  {
    const int n = copy.mesh.number_of_faces();
    if(copy.mesh.number_of_corners() == 3 * n)
    {
      m_mesh = copy.mesh;
      for(int f = 0; f < n; ++f)
        m_original_face.push_back(f);
      return;
    }
    m_mesh = split_mesh(
      copy.mesh, [&](int f) { return split_face(copy.mesh, copy.points, f); },
      [&](int f) { m_original_face.push_back(f); });
  }

  void compute_normals()
  {
    m_normals.assign(m_points.size(), Vector_3::Zero());
    std::vector<double> areas(m_points.size(), 0);
    for(int f = 0; f < m_mesh.number_of_faces(); ++f)
    {
      const Vector_3 a = face_vector_area(m_mesh, m_points, f);
      const double area = a.norm();
      for(int c = m_mesh.face_begin[f]; c < m_mesh.face_begin[f + 1]; ++c)
      {
        m_normals[m_mesh.corner_vertex[c]] += a;
        areas[m_mesh.corner_vertex[c]] += area;
      }
    }
    for(std::size_t v = 0; v < m_normals.size(); ++v)
    {
      // where normals cancel out, as on a rim folded flat, rounding must not decide on the orientation
      const double length = m_normals[v].norm(), rounding = 1e-14 * areas[v];
      if(length > rounding)
        m_normals[v] /= length;
      else
        m_normals[v].setZero();
    }
  }

  void find_creases()
  {
    for(int c = 0; c < m_mesh.number_of_corners(); ++c)
      if(c < m_mesh.opposite[c] && is_crease(c))
        m_creases.push_back(c);
  }

  Indexed_mesh m_mesh;
  std::vector<Vector_3> m_points;
  std::vector<Vector_3> m_normals;
  std::vector<char> m_is_reversed; // per face; empty if none is
  std::vector<int> m_creases;      // corners
  std::vector<int> m_original_face;
  std::unique_ptr<Search> m_search;
  double m_diagonal = 0, m_mean_edge_length = 0, m_area = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_REFERENCE_SURFACE_H
