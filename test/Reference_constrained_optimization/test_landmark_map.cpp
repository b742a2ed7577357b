// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Maps from landmarks: trees of paths, and flattenings of surfaces that are cut along them.

#include "checks.h"
#include "deformations.h"

#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/corresponding_paths.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/polygon_flattening.h>

#include <cmath>

using namespace rco_test;

// each path is passed in both directions, the border in one, and every side starts where the last
// one ended
void check_boundary(const internal::Cut_graph& tree)
{
  const std::vector<internal::Cut_graph::Side> sides = tree.boundary().cycles.front();
  std::vector<int> forward(tree.arcs().size(), 0), backward(tree.arcs().size(), 0);
  const auto ends = [&](std::size_t i) {
    const internal::Cut_graph::Arc& arc = tree.arcs()[sides[i % sides.size()].arc];
    return sides[i % sides.size()].is_forward ? std::make_pair(arc.from, arc.to)
                                              : std::make_pair(arc.to, arc.from);
  };
  for(std::size_t i = 0; i < sides.size(); ++i)
  {
    ++(sides[i].is_forward ? forward : backward)[sides[i].arc];
    RCO_CHECK_EQUAL(ends(i).second, ends(i + 1).first);
  }
  for(std::size_t a = 0; a < tree.arcs().size(); ++a)
  {
    RCO_CHECK_EQUAL(forward[a], 1);
    RCO_CHECK_EQUAL(backward[a], tree.arcs()[a].is_border ? 0 : 1);
  }
}

// pairs that connect n nodes, the first `connected` being so already; in random order
std::vector<std::pair<int, int>> random_tree(int n, int connected, Random& random)
{
  std::vector<std::pair<int, int>> edges;
  for(int i = (std::max)(1, connected); i < n; ++i)
    edges.push_back({random.index(i), i});
  for(std::size_t i = edges.size(); i > 1; --i)
    std::swap(edges[i - 1], edges[random.index(int(i))]);
  for(auto& e : edges)
    if(random() < 0.5)
      std::swap(e.first, e.second);
  return edges;
}

void test_landmark_trees()
{
  Random random(1);
  for(int k = 0; k < 300; ++k)
  {
    const Scope scope("random tree " + std::to_string(k));
    const int border = k % 2 == 0 ? 0 : 3 + random.index(4), n = border + 2 + random.index(9);
    internal::Cut_graph tree(n);
    std::vector<int> on_border;
    for(int i = 0; i < border; ++i)
      on_border.push_back(i);
    if(border > 0)
      tree.add_border(on_border);
    for(const auto& e : random_tree(n, border, random))
      tree.add_path(e.first, random.index(tree.number_of_sectors(e.first)), e.second,
                    random.index(tree.number_of_sectors(e.second)));
    check_boundary(tree);
  }
}

// Cuts along a random tree and lays out: if a map is found it is one-to-one. Whether one was found.
bool check_flattening(const Shape& shape,
                      const std::vector<int>& landmarks,
                      const std::vector<std::pair<int, int>>& edges)
{
  internal::Cut_surface cut(copy_of(shape));
  cut.set_landmarks(landmarks);
  cut.split_chords();
  internal::Cut_graph tree{int(landmarks.size())};
  const std::vector<int> border =
    cut.number_of_borders() == 0 ? std::vector<int>() : cut.border_landmarks(0);
  if(!border.empty())
  {
    tree.add_border(border);
    for(std::size_t i = 0; i < border.size(); ++i)
      cut.trace_border_arc(border[i], border[(i + 1) % border.size()]);
  }
  for(const auto& e : edges)
  {
    const internal::Path_pair path = internal::corresponding_paths(
      cut, cut, tree, {e}, {}, [](int, int, int, int) { return true; });
    // with all chords split there is always a way
    if(!RCO_CHECK(std::isfinite(path.length())))
      return false;
    RCO_CHECK(path.source.vertices == path.reference.vertices);
    cut.cut_along(path.source.vertices);
    tree.add_path(e.first, path.from_sector, e.second, path.to_sector);
  }
  check_boundary(tree);

  const std::vector<internal::Cut_graph::Side> sides = tree.boundary().cycles.front();
  std::vector<double> lengths;
  for(const internal::Cut_graph::Side& s : sides)
    lengths.push_back(cut.arc_length(s.arc));
  const auto corners = internal::Polygon_flattening::polygon(lengths);
  internal::Polygon_flattening map;
  if(!map.flatten(cut, sides, corners))
    return false;
  const internal::Cut_surface::Mesh& mesh = cut.mesh();
  double covered = 0;
  for(const auto f : mesh.faces())
  {
    const auto h = mesh.halfedge(f);
    const auto &a = map(h), &b = map(mesh.next(h)), &c = map(mesh.prev(h));
    RCO_CHECK(CGAL::orientation(a, b, c) == CGAL::LEFT_TURN);
    covered += CGAL::area(a, b, c);
  }
  double polygon = 0;
  for(std::size_t i = 1; i + 1 < corners.size(); ++i)
    polygon -= CGAL::area(corners[0], corners[i], corners[i + 1]); // clockwise
  RCO_CHECK_LESS(0., polygon);
  RCO_CHECK_NEAR(covered, polygon, 1e-9);
  // the two sides of an edge that is not cut agree
  for(const auto e : mesh.edges())
  {
    const auto h = mesh.halfedge(e), o = mesh.opposite(h);
    if(!cut.is_cut()[e] && !mesh.is_border(e))
      RCO_CHECK(map(h) == map(mesh.prev(o)) && map(o) == map(mesh.prev(h)));
  }
  return true;
}

void test_flattenings()
{
  Random random(2);
  const Shape shapes[] = {octahedron(), icosphere(0), deformed(icosphere(2), bumpy),
                          deformed(meridian_sphere(16, 10), ellipsoidal)};
  int found = 0, tried = 0;
  for(int k = 0; k < 24; ++k)
  {
    const Scope scope("flattening " + std::to_string(k));
    const Shape& shape = shapes[k % 4];
    const int n = (std::min)(3 + random.index(5), int(shape.points.size()));
    std::vector<int> all, landmarks;
    for(int v = 0; v < int(shape.points.size()); ++v)
      all.push_back(v);
    for(int i = 0; i < n; ++i)
    {
      std::swap(all[i], all[i + random.index(int(all.size()) - i)]);
      landmarks.push_back(all[i]);
    }
    ++tried;
    found += check_flattening(shape, landmarks, random_tree(n, 0, random));
  }
  RCO_CHECK_EQUAL(found, tried);
  {
    const Scope scope("flattening a square");
    const auto at = [](int i, int j) { return 11 * j + i; };
    const Shape shape = deformed(square(10, 10), hilly);
    const std::vector<int> landmarks = {at(0, 0), at(10, 0), at(10, 10), at(0, 10),
                                        at(3, 3), at(7, 4),  at(5, 8),   at(5, 9)};
    for(int k = 0; k < 4; ++k)
      RCO_CHECK(check_flattening(shape, landmarks, random_tree(8, 4, random)));
  }
  const Scope scope("flattening a long limb");
  RCO_CHECK(!check_flattening(closed_cylinder(10, 120, 0.1, 12), {0, 3, 6}, {{0, 1}, {1, 2}}));
}

int main()
{
  run_test("landmark trees", test_landmark_trees);
  run_test("flattenings", test_flattenings);
  return report();
}
