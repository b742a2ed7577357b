// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Cone proxies, disk topology, the growing of patches, and partitions.

#include "checks.h"
#include "deformations.h"

#include <CGAL/Random.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/active_set.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_partition.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_rounds.h>

#include <numeric>
#include <set>

using namespace rco_test;

Eigen::Matrix3d turn(Random& random)
{
  const Vector_3 axis = random.in_cube(1).normalized();
  return Eigen::AngleAxisd(random(0, 6), axis).toRotationMatrix();
}

internal::Face_geometry geometry_of(const Shape& shape, const Indexed_mesh& mesh)
{
  internal::Face_geometry geometry;
  geometry.update(mesh, shape.points);
  return geometry;
}

// the proxy of all faces of a shape
internal::Cone_proxy proxy_of(const Shape& shape)
{
  const Indexed_mesh mesh = indexed(shape);
  const internal::Face_geometry geometry = geometry_of(shape, mesh);
  internal::Cone_proxy_fit fit;
  for(int f = 0; f < mesh.number_of_faces(); ++f)
    fit.add(geometry.normals[f], geometry.areas[f]);
  const internal::Cone_proxy proxy = fit.fit();
  // its mean cost is the mean of its costs
  double sum = 0, area = 0;
  for(int f = 0; f < mesh.number_of_faces(); ++f)
  {
    sum += geometry.areas[f] * proxy.cost(geometry.normals[f]);
    area += geometry.areas[f];
  }
  RCO_CHECK_NEAR(proxy.mean_cost, sum / area, 1e-10);
  RCO_CHECK_NEAR(proxy.axis.norm(), 1., 1e-12);
  RCO_CHECK(proxy.cosine >= 0 && proxy.cosine <= 1 + 1e-12);
  return proxy;
}

void test_cone_proxy()
{
  Random random(1);
  for(int i = 0; i < 20; ++i)
  {
    const Eigen::Matrix3d r = turn(random);
    const Vector_3 z = r.col(2);

    const internal::Cone_proxy plane = proxy_of(rotated(plane_grid(4, 3), r));
    RCO_CHECK_LESS_EQUAL((plane.axis - z).norm(), 1e-6);
    RCO_CHECK_NEAR(plane.cosine, 1., 1e-9);
    RCO_CHECK_LESS_EQUAL(plane.mean_cost, 1e-12);

    for(const double part : {1., 0.3})
    {
      const internal::Cone_proxy tube =
        proxy_of(rotated(cylinder(20, 3, 0.5, 1, 2 * pi * part), r));
      RCO_CHECK_LESS_EQUAL(tube.axis.cross(z).norm(), 1e-6);
      RCO_CHECK_NEAR(tube.cosine, 0., 1e-6);
      RCO_CHECK_LESS_EQUAL(tube.mean_cost, 1e-9);
    }

    const double half_angle = random(0.2, 1.2);
    const int sides = 24;
    const internal::Cone_proxy hat = proxy_of(rotated(cone(sides, 4, half_angle), r));
    // the planes of a pyramid with that many sides touch a slightly narrower cone
    const double slope = std::tan(half_angle) * std::cos(pi / sides);
    RCO_CHECK_LESS_EQUAL((hat.axis - z).norm(), 1e-5);
    RCO_CHECK_NEAR(hat.cosine, slope / std::sqrt(1 + slope * slope), 1e-6);
    RCO_CHECK_NEAR(hat.cosine, std::sin(half_angle), 0.01);
    RCO_CHECK_LESS_EQUAL(hat.mean_cost, 1e-9);
    // part of it suffices
    const internal::Cone_proxy slice =
      proxy_of(rotated(cone(sides, 4, half_angle, 0.2, 1, 2 * pi * 0.4), r));
    RCO_CHECK_LESS_EQUAL((slice.axis - z).norm(), 1e-3);
    RCO_CHECK_LESS_EQUAL(slice.mean_cost, 1e-6);
  }

  // a cap of a sphere: heights are distributed evenly, so the cost is the variance of an interval
  for(const double angle : {0.3, 0.8, 1.3})
  {
    internal::Cone_proxy_fit fit;
    const int rings = 400, columns = 36;
    const double low = std::cos(angle);
    for(int j = 0; j < rings; ++j)
      for(int i = 0; i < columns; ++i)
      {
        const double h = low + (1 - low) * (j + 0.5) / rings, a = 2 * pi * i / columns;
        const double rho = std::sqrt(1 - h * h);
        fit.add(Vector_3(rho * std::cos(a), rho * std::sin(a), h), 0.7);
      }
    const internal::Cone_proxy cap = fit.fit();
    RCO_CHECK_LESS_EQUAL((cap.axis - Vector_3::UnitZ()).norm(), 1e-9);
    RCO_CHECK_NEAR(cap.cosine, 0.5 * (1 + low), 1e-9);
    RCO_CHECK_NEAR(cap.mean_cost, (1 - low) * (1 - low) / 12, 1e-6);
  }

  // no axis with its best cosine does better
  for(int i = 0; i < 50; ++i)
  {
    std::vector<std::pair<Vector_3, double>> faces; // normals and areas
    internal::Cone_proxy_fit fit;
    double total = 0;
    const Vector_3 middle = random.in_cube(1);
    for(int k = 0; k < 12; ++k)
    {
      faces.push_back({(middle + random.in_cube(1)).normalized(), random(0.1, 2)});
      total += faces.back().second;
      fit.add(faces.back().first, faces.back().second);
    }
    const internal::Cone_proxy best = fit.fit();
    for(int k = 0; k < 500; ++k)
    {
      internal::Cone_proxy other;
      other.axis = random.in_cube(1).normalized();
      other.cosine = 0;
      for(const auto& f : faces)
        other.cosine += f.second / total * other.axis.dot(f.first);
      double cost = 0;
      for(const auto& f : faces)
        cost += f.second / total * other.cost(f.first);
      RCO_CHECK_LESS_EQUAL(best.mean_cost, cost + 2e-6);
    }
  }
  // nothing to fit, or faces without area only
  internal::Cone_proxy_fit empty;
  RCO_CHECK(empty.fit().axis.allFinite());
  empty.add(Vector_3::Zero(), 0);
  RCO_CHECK(empty.fit().axis.allFinite());
}

bool is_connected(const Indexed_mesh& mesh, const std::vector<int>& faces)
{
  std::set<int> missing(faces.begin(), faces.end());
  std::vector<int> stack(1, faces.front());
  missing.erase(faces.front());
  while(!stack.empty())
  {
    const int f = stack.back();
    stack.pop_back();
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      if(mesh.opposite[c] >= 0 && missing.erase(mesh.corner_face[mesh.opposite[c]]))
        stack.push_back(mesh.corner_face[mesh.opposite[c]]);
  }
  return missing.empty();
}

// Whether some faces are a disk, told from nothing but their lists of vertices: they are connected, of Euler
// characteristic 1, and those at a vertex are one fan, in which no more than one face lacks a next one.
bool is_disk(const Indexed_mesh& mesh, const std::vector<int>& faces)
{
  std::map<std::pair<int, int>, int> uses; // of undirected edges
  std::map<int, int> fans;                 // per vertex: faces, and then those without a next one
  for(const int f : faces)
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
    {
      const int s = mesh.source(c), t = mesh.target(c);
      ++uses[std::minmax(s, t)];
      ++fans[s];
    }
  for(const auto& edge : uses)
    if(edge.second == 2)
      for(const int v : {edge.first.first, edge.first.second})
        --fans[v];
  for(const auto& fan : fans)
    if(fan.second > 1)
      return false;
  const int euler = int(fans.size()) - int(uses.size()) + int(faces.size());
  return euler == 1 && is_connected(mesh, faces);
}

// preserves_disk() against the definition, for every face beside random disks
void test_disk_topology(const Shape& shape, const std::string& name)
{
  const Scope scope("disk topology on " + name);
  const Indexed_mesh mesh = indexed(shape);
  const int n = mesh.number_of_faces();
  Random random(2);
  int refused = 0, allowed = 0;
  for(int trial = 0; trial < 25; ++trial)
  {
    std::vector<int> patch;
    std::vector<char> in_patch(n, 0), has_vertex(shape.points.size(), 0);
    const auto add = [&](int f) {
      patch.push_back(f);
      in_patch[f] = 1;
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        has_vertex[mesh.corner_vertex[c]] = 1;
    };
    add(random.index(n));
    const int goal = 1 + random.index((std::min)(n, 80));
    while(true)
    {
      std::vector<int> growing;
      for(int f = 0; f < n; ++f)
      {
        bool is_beside = false;
        for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
          is_beside =
            is_beside || (mesh.opposite[c] >= 0 && in_patch[mesh.corner_face[mesh.opposite[c]]]);
        if(in_patch[f] || !is_beside)
          continue;
        std::vector<int> larger(patch);
        larger.push_back(f);
        const bool expected = is_disk(mesh, larger);
        const bool keeps = internal::preserves_disk(
          mesh, f, [&](int g) { return in_patch[g] != 0; },
          [&](int v) { return has_vertex[v] != 0; });
        RCO_CHECK_EQUAL(keeps, expected);
        (expected ? allowed : refused) += 1;
        if(expected)
          growing.push_back(f);
      }
      if(growing.empty() || int(patch.size()) >= goal)
        break;
      add(growing[random.index(int(growing.size()))]);
    }
  }
  RCO_CHECK(allowed > 0 || n < 2);
  // a strip refuses nothing
  RCO_CHECK(refused > 0 || name == "two triangles" || name == "a strip");
}

// faces outside the 2-ring of the boundary to other faces, and the seed, by the definition
std::set<int> touched_by_definition(const Indexed_mesh& mesh, const std::vector<int>& patch)
{
  const std::set<int> inside(patch.begin(), patch.end());
  std::set<int> near; // vertices, first those of edges between the patch and other faces
  for(const int f : patch)
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      if(mesh.opposite[c] >= 0 && inside.count(mesh.corner_face[mesh.opposite[c]]) == 0)
        near.insert({mesh.source(c), mesh.target(c)});
  const auto away = [&]() {
    std::set<int> faces = inside;
    for(const int f : patch)
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        if(near.count(mesh.corner_vertex[c]) != 0)
          faces.erase(f);
    return faces;
  };
  const std::set<int> outside_first_ring = away();
  for(const int f : patch)
    if(outside_first_ring.count(f) == 0)
      for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
        near.insert(mesh.corner_vertex[c]);
  std::set<int> result = away();
  result.insert(patch.front());
  return result;
}

internal::Selection_parameters selection_parameters(double threshold, int cap, int exempt)
{
  internal::Selection_parameters parameters;
  parameters.developability_threshold = threshold;
  parameters.maximum_patch_size = cap;
  parameters.exempt_size = exempt;
  return parameters;
}

// of numbers that are there once
std::set<int> as_set(const std::vector<int>& numbers)
{
  const std::set<int> result(numbers.begin(), numbers.end());
  RCO_CHECK_EQUAL(result.size(), numbers.size());
  return result;
}

const auto nothing_taken = [](int) { return false; };

// What holds for every patch, on any mesh. Returns the size of the largest.
std::size_t test_growing(const Shape& shape, const std::string& name)
{
  const Scope scope("patches on " + name);
  const Indexed_mesh mesh = indexed(shape);
  const internal::Face_geometry geometry = geometry_of(shape, mesh);
  const int n = mesh.number_of_faces();
  std::size_t largest = 0;
  for(const double threshold : {0.02, 0.25, 10.})
    for(const int cap : {1, 3, 40, 100000})
      for(const int exempt : {1, 70})
      {
        const auto parameters = selection_parameters(threshold, cap, exempt);
        internal::Patch_selection selection(mesh, parameters);
        Random random(3);
        for(int trial = 0; trial < (std::min)(n, 12); ++trial)
        {
          const int seed = n <= 12 ? trial : random.index(n);
          std::vector<char> taken(n, 0);
          if(trial % 3 == 2)
            for(int f = 0; f < n; ++f)
              taken[f] = f != seed && random() < 0.05;
          const auto is_taken = [&](int f) { return taken[f] != 0; };
          const std::vector<int> patch = selection.grow(seed, geometry, is_taken);
          if(!RCO_CHECK(!patch.empty() && patch.front() == seed))
            continue;
          RCO_CHECK_LESS_EQUAL(int(patch.size()), cap);
          RCO_CHECK(is_disk(mesh, patch));
          // it is a disk at any time
          for(const double part : {0.2, 0.5, 0.8})
          {
            const std::size_t size = 1 + std::size_t(part * double(patch.size() - 1));
            RCO_CHECK(is_disk(mesh, std::vector<int>(patch.begin(), patch.begin() + size)));
          }
          for(const int f : patch)
            RCO_CHECK(!taken[f]);
          // the same again, also in an object that has done nothing else
          RCO_CHECK(selection.grow(seed, geometry, is_taken) == patch);
          internal::Patch_selection fresh(mesh, parameters);
          RCO_CHECK(fresh.grow(seed, geometry, is_taken) == patch);
          const std::set<int> expected = touched_by_definition(mesh, patch);
          RCO_CHECK(as_set(fresh.touched(patch)) == expected);
          // an object that has seen more patches may be done with more faces
          const std::set<int> again = as_set(selection.touched(patch)), all = as_set(patch);
          RCO_CHECK(std::includes(again.begin(), again.end(), expected.begin(), expected.end()));
          RCO_CHECK(std::includes(all.begin(), all.end(), again.begin(), again.end()));
          largest = (std::max)(largest, patch.size());
        }
      }
  return largest;
}

void test_patches()
{
  const Shape sphere = icosphere(2);
  const Shape holed =
    without_faces(sphere, [](int f) { return (f >= 10 && f < 14) || f == 100 || f == 200; });
  struct Case
  {
    std::string name;
    Shape shape;
    std::size_t largest = 0; // patch, if it is known
  };
  const Case cases[] = {
    {"an annulus", annulus(12, 3)},
    {"a thin annulus", annulus(8, 1)},
    {"a tetrahedron", tetrahedron(), 3},
    {"an icosahedron", icosphere(0)},
    {"a sphere with holes", holed},
    {"a torus", torus(16, 8)},
    {"a tube", cylinder(10, 6, 0.5, 1)},
    {"a closed cylinder", closed_cylinder(10, 6, 0.5, 1)},
    {"a cube", cube(4)},
    {"two components", joined(plane_grid(6, 6), icosphere(1), Vector_3(5, 0, 0))},
    {"two triangles", plane_grid(1, 1), 2},
    {"a strip", plane_grid(12, 1)},
    {"a plane", plane_grid(9, 9), 162},
    {"quads", plane_grid(8, 7, 1, true), 56},
    {"a double sheet", double_sheet(6, 1e-3)},
  };
  for(const Case& c : cases)
  {
    test_disk_topology(c.shape, c.name);
    const std::size_t largest = test_growing(c.shape, c.name);
    RCO_CHECK(c.largest == 0 || largest == c.largest);
  }
  // a closed surface keeps a hole
  test_disk_topology(sphere, "a sphere");
  const std::size_t on_sphere = test_growing(sphere, "a sphere");
  RCO_CHECK(on_sphere > 200 && on_sphere < sphere.faces.size());
}

// patches of a round are disjoint, and every component has one
void test_rounds()
{
  const Shape shape = joined(plane_grid(6, 6), icosphere(1), Vector_3(5, 0, 0));
  const Indexed_mesh mesh = indexed(shape);
  internal::Selection_parameters parameters;
  parameters.maximum_patch_size = 20;
  internal::Patch_selection selection(mesh, parameters);
  selection.clear_visits();
  std::vector<int> seeds(mesh.number_of_faces()), count(seeds.size(), 0);
  std::iota(seeds.begin(), seeds.end(), 0);
  std::vector<char> is_untouched(seeds.size(), 1);
  const auto patches =
    internal::Patch_rounds(mesh).select(seeds, is_untouched, selection, geometry_of(shape, mesh));
  RCO_CHECK_LESS_EQUAL(2, int(patches.size()));
  for(const std::vector<int>& patch : patches)
    for(const int f : patch)
      RCO_CHECK_EQUAL(++count[f], 1);
}

void test_touched()
{
  internal::Selection_parameters parameters;
  parameters.maximum_patch_size = 1000;
  // the whole mesh is one patch: its own border is no boundary, so all is touched
  const Shape plane = plane_grid(8, 8);
  const Indexed_mesh mesh = indexed(plane);
  internal::Patch_selection whole(mesh, parameters);
  const std::vector<int> patch = whole.grow(30, geometry_of(plane, mesh), nothing_taken);
  RCO_CHECK_EQUAL(patch.size(), plane.faces.size());
  RCO_CHECK_EQUAL(whole.touched(patch).size(), plane.faces.size());
  // a patch that is boundary all over touches its seed alone
  parameters.maximum_patch_size = 4;
  internal::Patch_selection tiny(mesh, parameters);
  const std::vector<int> few = tiny.grow(60, geometry_of(plane, mesh), nothing_taken);
  RCO_CHECK_EQUAL(few.size(), 4u);
  RCO_CHECK(tiny.touched(few) == std::vector<int>(1, 60));
}

void test_threshold()
{
  // on a cube a patch that starts on flat ground stays on its side
  const Shape box = cube(6);
  const Indexed_mesh box_mesh = indexed(box);
  const internal::Face_geometry box_geometry = geometry_of(box, box_mesh);
  internal::Patch_selection on_box(box_mesh, selection_parameters(0.01, 1000, 0));
  for(int seed = 0; seed < box_mesh.number_of_faces(); ++seed)
  {
    const std::vector<int> patch = on_box.grow(seed, box_geometry, nothing_taken);
    bool is_at_edge = false;
    for(const int v : box.faces[seed])
      is_at_edge = is_at_edge || number_of_planes(box.points[v]) > 1;
    if(is_at_edge)
      continue;
    RCO_CHECK_EQUAL(patch.size(), 72u);
    for(const int f : patch)
      RCO_CHECK_LESS(0.99, box_geometry.normals[f].dot(box_geometry.normals[seed]));
  }

  // below the size at which the proxy is fitted anew all faces fit one of the seed's 1-rings
  const Shape sphere = icosphere(3);
  const Indexed_mesh mesh = indexed(sphere);
  const internal::Face_geometry geometry = geometry_of(sphere, mesh);
  Random random(4);
  for(const int exempt : {0, 20})
    for(const double threshold : {1e-4, 1e-3, 1e-2})
    {
      internal::Patch_selection selection(mesh, selection_parameters(threshold, 127, exempt));
      for(int trial = 0; trial < 10; ++trial)
      {
        const int seed = random.index(mesh.number_of_faces());
        const std::vector<int> patch = selection.grow(seed, geometry, nothing_taken);
        RCO_CHECK_LESS_EQUAL((std::min)(exempt, 127), int(patch.size()));
        bool some_proxy_fits = int(patch.size()) <= exempt;
        for(int c = mesh.face_begin[seed]; c < mesh.face_begin[seed + 1]; ++c)
        {
          const int v = mesh.corner_vertex[c];
          internal::Cone_proxy_fit fit;
          for(int k = mesh.vertex_begin[v]; k < mesh.vertex_begin[v + 1]; ++k)
          {
            const int f = mesh.corner_face[mesh.vertex_corners[k]];
            fit.add(geometry.normals[f], geometry.areas[f]);
          }
          bool fits = true;
          for(int i = exempt; i < int(patch.size()); ++i)
            fits = fits && fit.fit().cost(geometry.normals[patch[i]]) < threshold;
          some_proxy_fits = some_proxy_fits || fits;
        }
        RCO_CHECK(some_proxy_fits);
      }
    }

  // a larger threshold lets patches grow on a sphere; a cylinder is developable, which is found out
  // once the proxy is fitted to the patch itself
  const auto mean_size = [&](const Shape& s, double threshold, int exempt) {
    const Indexed_mesh m = indexed(s);
    const internal::Face_geometry g = geometry_of(s, m);
    internal::Patch_selection selection(m, selection_parameters(threshold, 100000, exempt));
    Random seeds(5);
    double sum = 0;
    for(int i = 0; i < 20; ++i)
      sum += double(selection.grow(seeds.index(m.number_of_faces()), g, nothing_taken).size());
    return sum / 20;
  };
  RCO_CHECK_LESS(mean_size(sphere, 0.001, 10), 0.5 * mean_size(sphere, 0.05, 10));
  const Shape tube = cylinder(20, 40, 0.5, 4);
  RCO_CHECK_LESS(0.8 * double(tube.faces.size()), mean_size(tube, 0.001, 300));
  RCO_CHECK_LESS(mean_size(sphere, 0.001, 300), 0.7 * double(sphere.faces.size()));
}

// faces without area neither stop the growing nor break the geometry
void test_degenerate_faces()
{
  Shape shape = plane_grid(8, 8);
  shape.points[40] = shape.points[41];
  const Indexed_mesh mesh = indexed(shape);
  const internal::Face_geometry geometry = geometry_of(shape, mesh);
  for(int f = 0; f < mesh.number_of_faces(); ++f)
  {
    RCO_CHECK(geometry.normals[f].allFinite());
    RCO_CHECK(std::isfinite(geometry.areas[f]) && geometry.centroids[f].allFinite());
  }
  test_growing(shape, "a plane with faces of no area");
}

typedef std::vector<std::vector<int>> Patches;

Patches
divided(const Indexed_mesh& mesh, const std::vector<char>& is_selected, int size, unsigned int seed)
{
  internal::Patch_partition partition(mesh, size);
  RCO_CHECK_EQUAL(partition.patch_size(), size);
  CGAL::Random random(seed);
  const Patches patches = partition.divide(is_selected, random);

  std::vector<int> times(mesh.number_of_faces(), 0);
  std::size_t previous = times.size();
  for(const std::vector<int>& patch : patches)
  {
    if(!RCO_CHECK(!patch.empty()))
      continue;
    RCO_CHECK_LESS_EQUAL(patch.size(), previous);
    previous = patch.size();
    for(const int f : patch)
      ++times[f];
    RCO_CHECK(is_connected(mesh, patch));
  }
  for(int f = 0; f < mesh.number_of_faces(); ++f)
    RCO_CHECK_EQUAL(times[f], int(is_selected[f] != 0));

  // an object that has divided something else before gives the same
  internal::Patch_partition used(mesh, 7 * size);
  CGAL::Random other(seed + 1), again(seed);
  used.divide(is_selected, other);
  used.set_patch_size(size);
  RCO_CHECK(used.divide(is_selected, again) == patches);

  // whole regions: again all wanted faces once, and none that touches another unless it was too large
  CGAL::Random third(seed);
  std::vector<int> patch_of(mesh.number_of_faces(), -1);
  int number = 0;
  for(const std::vector<int>& patch : used.divide_regions(is_selected, third))
  {
    RCO_CHECK(is_connected(mesh, patch));
    for(const int f : patch)
    {
      RCO_CHECK_EQUAL(patch_of[f], -1);
      patch_of[f] = number;
    }
    ++number;
  }
  int touching = 0;
  for(int f = 0; f < mesh.number_of_faces(); ++f)
  {
    RCO_CHECK_EQUAL(patch_of[f] >= 0, is_selected[f] != 0);
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      if(mesh.opposite[c] >= 0 && patch_of[f] >= 0)
      {
        const int other = patch_of[mesh.corner_face[mesh.opposite[c]]];
        touching += other >= 0 && other != patch_of[f];
      }
  }
  const bool any_large = std::count(is_selected.begin(), is_selected.end(), char(1)) > 3 * size;
  RCO_CHECK(any_large || touching == 0);
  return patches;
}

void test_partition()
{
  {
    const Scope s("regular torus");
    const Indexed_mesh mesh = indexed(torus(80, 40));
    const std::vector<char> all(mesh.number_of_faces(), 1);
    for(const int size : {50, 200, 1000})
      for(unsigned int seed = 0; seed < 5; ++seed)
      {
        const Patches patches = divided(mesh, all, size, seed);
        RCO_CHECK_EQUAL(int(patches.size()), (mesh.number_of_faces() + size - 1) / size);
        RCO_CHECK_LESS_EQUAL(double(patches.front().size()), 3.2 * size);
        // cells of seeds that happen to be close stay small, but few of them
        const auto large =
          std::count_if(patches.begin(), patches.end(), [&](const std::vector<int>& patch) {
            return 3.2 * double(patch.size()) >= size;
          });
        RCO_CHECK_LESS_EQUAL(0.9 * double(patches.size()), double(large));
      }
    RCO_CHECK(divided(mesh, all, 200, 0) != divided(mesh, all, 200, 1));
    RCO_CHECK(divided(mesh, std::vector<char>(all.size(), 0), 200, 0).empty());
    RCO_CHECK_EQUAL(divided(mesh, all, 1000000, 0).size(), 1u);
    RCO_CHECK_EQUAL(divided(mesh, all, 1, 0).size(), all.size());
  }
  {
    const Scope s("several components");
    // the small ones mostly get no seed, or one only and are a cell without end
    const Shape shape = joined(joined(joined(torus(30, 12), tetrahedron(), Vector_3(5, 0, 0)),
                                      icosphere(1), Vector_3(0, 5, 0)),
                               plane_grid(9, 5, 1, true), Vector_3(0, 0, 5));
    const Indexed_mesh mesh = indexed(shape);
    const std::vector<char> all(mesh.number_of_faces(), 1);
    for(unsigned int seed = 0; seed < 10; ++seed)
      for(const int size : {3, 40, 400, 100000})
        RCO_CHECK_LESS_EQUAL(4u, divided(mesh, all, size, seed).size());
    RCO_CHECK_EQUAL(divided(mesh, all, 100000, 0).size(), 4u);
  }
  {
    const Scope s("some faces");
    const Indexed_mesh mesh = indexed(torus(30, 12));
    Random random(1);
    for(const double share : {0.002, 0.1, 0.5, 0.9})
      for(unsigned int seed = 0; seed < 5; ++seed)
      {
        std::vector<char> is_selected(mesh.number_of_faces());
        for(char& w : is_selected)
          w = random() < share;
        divided(mesh, is_selected, 30, seed);
      }
    std::vector<char> one(mesh.number_of_faces(), 0);
    one[17] = 1;
    RCO_CHECK(divided(mesh, one, 30, 0) == Patches(1, {17}));
  }
}

// The faces around vertices, ring by ring, whether they are few or many.
void test_active_set()
{
  const Indexed_mesh mesh = indexed(torus(30, 12));
  Random random(6);
  for(const double share : {0., 0.002, 0.2})
    for(const int rings : {0, 1, 3})
    {
      std::vector<char> is_center;
      std::set<int> vertices, faces;
      for(int v = 0; v < mesh.number_of_vertices(); ++v)
      {
        is_center.push_back(random() < share);
        if(is_center[v])
          vertices.insert(v);
      }
      for(int ring = 0; ring <= rings; ++ring)
      {
        for(int c = 0; c < mesh.number_of_corners(); ++c)
          if(vertices.count(mesh.source(c)))
            faces.insert(mesh.corner_face[c]);
        for(int c = 0; c < mesh.number_of_corners(); ++c)
          if(faces.count(mesh.corner_face[c]))
            vertices.insert(mesh.source(c));
      }
      const std::vector<char> around = internal::faces_around(mesh, is_center, rings);
      for(int f = 0; f < mesh.number_of_faces(); ++f)
        RCO_CHECK_EQUAL(bool(around[f]), faces.count(f) > 0);
    }
}

int main()
{
  run_test("cone proxy", test_cone_proxy);
  run_test("patches", test_patches);
  run_test("rounds", test_rounds);
  run_test("touched", test_touched);
  run_test("developability threshold", test_threshold);
  run_test("degenerate faces", test_degenerate_faces);
  run_test("partition", test_partition);
  run_test("active set", test_active_set);
  return report();
}
