// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The whole optimization: what every result must satisfy, whatever the mesh.

#include "Recorder.h"
#include "deformations.h"
#include "optimization.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_tree.h>

#include <limits>
#include <set>

using namespace rco_test;

struct Options
{
  unsigned int iterations = 30;
  unsigned int seed = 0;
  double time = 1e9;
  int patch_size = 1000;
  double threshold = 0.25;
  std::vector<char> vertex_is_constrained;         // by position
  std::set<std::pair<int, int>> constrained_edges; // smaller vertex first
  Recorder recorder;
  bool expect_throw = false;
};

struct Measures
{
  double energy = 0; // mean
  std::size_t flips = 0, folds = 0;
  bool is_plain = true; // no element is inverted or near its cap
  double smallest_angle = 180, mean_angle = 0;
};

struct Outcome
{
  RCO::Result result;
  Recorder recorder;
  Shape before, after, reference; // coordinates as the point types hold them
  Measures measures;              // in the end
  std::vector<char> is_free;
  std::vector<std::pair<int, Vector_3>> locations; // face of the reference, weights of its corners
  bool thrown = false;
};

// calls the function for Minimum_angle_energy(k) with everything recorded
template <typename Tag, typename M, typename R>
Outcome recorded(M& mesh, const R& reference, const Options& options, double k)
{
  typedef typename boost::graph_traits<R>::face_descriptor Reference_face;
  typedef std::pair<Reference_face, std::array<double, 3>> Location;
  Outcome out;
  out.before = make_shape(mesh);
  out.reference = make_shape(reference);
  out.recorder = options.recorder;

  out.is_free = free_vertices(out.before, options.vertex_is_constrained);
  auto vertex_map = get(CGAL::dynamic_vertex_property_t<bool>(), mesh);
  auto edge_map = get(CGAL::dynamic_edge_property_t<bool>(), mesh);
  auto location_map = get(CGAL::dynamic_vertex_property_t<Location>(), mesh);
  auto vertex_index = get(CGAL::dynamic_vertex_property_t<int>(), mesh);
  int i = 0;
  for(const auto v : vertices(mesh))
  {
    put(vertex_map, v, !options.vertex_is_constrained.empty() && options.vertex_is_constrained[i]);
    put(vertex_index, v, i++);
  }
  for(const auto e : edges(mesh))
  {
    int a = get(vertex_index, source(e, mesh)), b = get(vertex_index, target(e, mesh));
    const bool constrained =
      options.constrained_edges.count({(std::min)(a, b), (std::max)(a, b)}) != 0;
    put(edge_map, e, constrained);
    if(constrained)
      out.is_free[a] = out.is_free[b] = 0;
  }

  try
  {
    out.result =
      CGAL::reference_constrained_optimize<Tag>(mesh, reference, RCO::Minimum_angle_energy(k),
                                                params::developability_threshold(options.threshold)
                                                  .maximum_patch_size(options.patch_size)
                                                  .vertex_location_map(location_map)
                                                  .number_of_iterations(options.iterations)
                                                  .random_seed(options.seed)
                                                  .maximum_running_time(options.time)
                                                  .vertex_is_constrained_map(vertex_map)
                                                  .edge_is_constrained_map(edge_map)
                                                  .visitor(std::ref(out.recorder)));
  }
  catch(const Stopped&)
  {
    out.thrown = true;
  }
  RCO_CHECK_EQUAL(out.thrown, options.expect_throw);
  out.after = make_shape(mesh);

  const Indexed_mesh indices = indexed(out.before);
  auto face_index = get(CGAL::dynamic_face_property_t<int>(), reference);
  int f = 0;
  for(const auto face : faces(reference))
    put(face_index, face, f++);
  for(const auto v : vertices(mesh))
  {
    const Location& l = get(location_map, v);
    if(indices.vertex_begin[get(vertex_index, v)] == indices.vertex_begin[get(vertex_index, v) + 1])
    {
      out.locations.push_back({-1, Vector_3::Zero()});
      continue;
    }
    // weights belong to source, target and next target of the face's half-edge; faces of a shape
    // start with the target
    out.locations.push_back(
      {get(face_index, l.first), Vector_3(l.second[1], l.second[2], l.second[0])});
  }
  return out;
}

// of triangles as they lie on the reference, for Minimum_angle_energy(k)
Measures measure(const Shape& shape, const Outcome& out, double k)
{
  std::vector<Vector_3> corner_normals(out.reference.points.size(), Vector_3::Zero());
  for(const auto& t : out.reference.faces)
    for(const int v : t)
      corner_normals[v] += vector_area(out.reference, t);
  for(Vector_3& n : corner_normals)
    n.normalize();
  const auto normal_at = [&](int v) {
    Vector_3 n = Vector_3::Zero();
    for(int i = 0; i < 3; ++i)
      n +=
        out.locations[v].second(i) * corner_normals[out.reference.faces[out.locations[v].first][i]];
    return n;
  };

  Measures m;
  std::vector<Vector_3> normals;
  for(const auto& t : shape.faces)
  {
    const Vector_3 &a = shape.points[t[0]], &b = shape.points[t[1]], &c = shape.points[t[2]];
    const Vector_3 n = vector_area(shape, t);
    normals.push_back(n);
    const double turn = n.dot(normal_at(t[0]) + normal_at(t[1]) + normal_at(t[2]));
    m.flips += turn < 0;
    const double lengths = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    const double exponent = k * lengths / (std::sqrt(3.) * n.norm());
    m.is_plain = m.is_plain && turn > 0 && exponent < 2 * k + 18;
    m.energy += std::exp(exponent);
    const double angle = smallest_angle(a, b, c);
    m.smallest_angle = (std::min)(m.smallest_angle, angle);
    m.mean_angle += angle / double(shape.faces.size());
  }
  m.energy /= double(shape.faces.size());
  const Indexed_mesh mesh = indexed(shape);
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(mesh.opposite[c] > c)
    {
      const Vector_3 &p = normals[mesh.corner_face[c]],
                     &q = normals[mesh.corner_face[mesh.opposite[c]]];
      m.folds += p.dot(q) < -0.5 * p.norm() * q.norm();
    }
  return m;
}

// All that must hold of any run.
void check_outcome(const Outcome& out)
{
  const RCO::Result& r = out.result;
  const Recorder& seen = out.recorder;
  const Indexed_mesh surface = indexed(out.reference);
  const std::vector<Vector_3>& points = out.reference.points;
  const double largest =
    internal::largest_coordinate(surface, [&](int v) -> const Vector_3& { return points[v]; });
  const double tolerance = 1e-12 * internal::bounding_box_diagonal(surface, points) +
                           4 * std::numeric_limits<double>::epsilon() * largest;

  const std::size_t number_free = check_vertices(out.before, out.after, out.is_free);
  for(std::size_t v = 0; v < out.after.points.size(); ++v)
  {
    const Vector_3& p = out.after.points[v];
    if(out.locations[v].first < 0)
      continue;
    const Vector_3& b = out.locations[v].second;
    RCO_CHECK(b.minCoeff() >= 0);
    RCO_CHECK_NEAR(b.sum(), 1., 1e-12);
    const std::vector<int>& t = out.reference.faces[out.locations[v].first];
    const Vector_3 q = b(0) * out.reference.points[t[0]] + b(1) * out.reference.points[t[1]] +
                       b(2) * out.reference.points[t[2]];
    RCO_CHECK_LESS_EQUAL((p - q).norm(),
                         tolerance + (out.is_free[v] ? 0 : r.largest_initial_distance));
  }
  if(out.thrown)
    return; // there is no result

  RCO_CHECK_EQUAL(r.number_of_free_vertices, number_free);
  check_progress(r);
  const Measures& after = out.measures;
  RCO_CHECK_EQUAL(after.flips, r.number_of_flips);
  RCO_CHECK_EQUAL(after.folds, r.number_of_fold_edges);
  if(after.is_plain)
    RCO_CHECK_NEAR(r.final_energy, after.energy, 1e-7 * after.energy);

  // what the visitor was told adds up to the result
  RCO_CHECK_EQUAL(r.number_of_iterations, seen.iterations);
  RCO_CHECK_EQUAL(r.number_of_rounds, seen.rounds);
  RCO_CHECK_LESS_EQUAL(r.number_of_patches, seen.announced);
  if(r.status == RCO::Status::converged || r.status == RCO::Status::iteration_limit)
    RCO_CHECK_EQUAL(r.number_of_patches, seen.announced);
  RCO_CHECK_EQUAL(r.sum_of_patch_sizes, double(seen.faces));
  RCO_CHECK_EQUAL(seen.open_rounds, 0u);
  RCO_CHECK_LESS_EQUAL(r.number_of_flattened_patches, r.number_of_accepted_patches);
  seen.check_sums(r,
                  double(out.before.faces.size()) * (out.before.faces.front().size() == 4 ? 4 : 1));
  for(std::size_t i = 0; i < seen.energies.size() && defects_before(r) == 0; ++i)
    RCO_CHECK_LESS_EQUAL(seen.energies[i], i == 0 ? r.initial_energy * (1 + on_the_way)
                                                  : seen.energies[i - 1] * (1 + 1e-12));
  RCO_CHECK(r.running_time >= 0);
  if(r.status == RCO::Status::nothing_to_do)
    RCO_CHECK(r.number_of_iterations == 0);
}

// the run and all checks
template <typename Tag = CGAL::Sequential_tag, typename M, typename R>
Outcome run(M& mesh, const R& reference, const Options& options, double k = 1)
{
  Outcome out = recorded<Tag>(mesh, reference, options, k);
  out.measures = measure(out.after, out, k);
  check_outcome(out);
  return out;
}

template <typename Tag = CGAL::Sequential_tag>
Outcome optimized(const Shape& shape,
                  const Shape& reference,
                  const Options& options = Options(),
                  double k = 1)
{
  Mesh mesh = mesh_of(shape);
  return run<Tag>(mesh, mesh_of(reference), options, k);
}

// scrambled regular shapes become regular again
void test_recovery(const Shape& regular,
                   const std::function<Vector_3(const Vector_3&)>& project,
                   double least_part,
                   const std::string& name)
{
  const Scope scope("recovery of " + name);
  const Shape rough = scrambled(regular, 0.3, 1, project);
  const Outcome out = optimized(rough, regular);
  const Measures& m = out.measures;
  RCO_CHECK_EQUAL(defects_after(out.result), 0u);
  RCO_CHECK_LESS(smallest_angle(rough), 0.6 * smallest_angle(regular));
  RCO_CHECK_LESS_EQUAL(least_part * smallest_angle(regular), m.smallest_angle);
  RCO_CHECK_LESS_EQUAL(0.97 * mean_smallest_angle(regular), m.mean_angle);
  RCO_CHECK_LESS(out.result.final_energy, out.result.initial_energy);
  RCO_CHECK(out.result.status == RCO::Status::converged);
  std::cout << name << ": smallest angle " << smallest_angle(rough) << " -> " << m.smallest_angle
            << " (regular " << smallest_angle(regular) << "), " << out.result.number_of_iterations
            << " iterations" << std::endl;
}

void test_recoveries()
{
  test_recovery(equilateral_grid(14, 12), onto_plane, 0.99, "an equilateral grid");
  test_recovery(icosphere(3), onto_sphere, 0.9, "a sphere");
  test_recovery(torus(40, 16), onto_torus(1, 0.4), 0.9, "a torus");
  test_recovery(cylinder(24, 12, 0.5, 1.5), onto_cylinder(0.5), 0.9, "a tube");
  test_recovery(
    joined(icosphere(2), torus(24, 10, 1, 0.4), Vector_3(3, 0, 0)),
    [](const Vector_3& p) -> Vector_3 {
      if(p.x() < 1.3)
        return p.normalized();
      const Vector_3 c(3, 0, 0);
      return c + onto_torus(1, 0.4)(p - c);
    },
    0.85, "two components");
}

// as quads are not triangles: every corner wants to be right
struct Corner_energy
{
  typedef RCO::Exponential_MIPS_density Density;
  Density m_density;
  const Density& density() const { return m_density; }
  void append_elements(const RCO::Energy_context& context,
                       std::size_t f,
                       std::vector<RCO::Energy_element>& elements) const
  {
    for(int i = 0; i < context.degree(f); ++i)
    {
      RCO::Energy_element e;
      e.corners = {{i, (i + 1) % context.degree(f), (i + 3) % context.degree(f)}};
      elements.push_back(e);
    }
  }
};

void test_quads()
{
  const auto bend = [](const Vector_3& p) { return Vector_3(p.x(), p.y(), 0.1 * p.x() * p.x()); };
  const Shape grid = plane_grid(12, 10, 1, true);
  Mesh mesh = mesh_of(deformed(scrambled(grid, 0.3, 2, onto_plane), bend));
  const Shape rough = make_shape(mesh);
  const Mesh reference = mesh_of(deformed(grid, bend));
  const RCO::Result r = CGAL::reference_constrained_optimize(mesh, reference, Corner_energy());
  check_result(rough, mesh, reference, r);
  RCO_CHECK_LESS(r.final_energy, r.initial_energy);
  RCO_CHECK_NEAR(r.final_energy, std::exp(2.), 0.05 * std::exp(2.));
  RCO_CHECK_EQUAL(r.number_of_flips, 0u);
}

// small meshes and those with nothing to do
void test_small_meshes()
{
  {
    const Scope scope("a tetrahedron");
    Shape shape = tetrahedron();
    const Outcome regular = optimized(shape, shape);
    RCO_CHECK_LESS_EQUAL(regular.result.final_energy, regular.result.initial_energy);
    shape.points[0] += Vector_3(0.4, -0.2, 0.1);
    optimized(shape, shape);
    shape = tetrahedron();
    shape.points[0] += Vector_3(0.1, -0.1, 0.2);
    optimized(shape, tetrahedron());
  }
  {
    const Scope scope("an octahedron on a sphere");
    Shape shape = octahedron();
    shape.points[4] = Vector_3(0.5, 0.4, 0.7).normalized();
    const Outcome out = optimized(shape, icosphere(3));
    RCO_CHECK_LESS(out.result.final_energy, out.result.initial_energy);
  }
  for(const Shape& shape : {plane_grid(1, 1), plane_grid(9, 1), annulus(8, 1)})
  {
    const Scope scope("a strip");
    const Outcome out = optimized(shape, shape);
    RCO_CHECK(out.result.status == RCO::Status::nothing_to_do);
    RCO_CHECK_EQUAL(out.result.final_energy, out.result.initial_energy);
    RCO_CHECK(same_bits(out.before, out.after));
  }
  {
    const Scope scope("one free vertex");
    Shape shape = plane_grid(2, 2);
    const Shape reference = shape;
    shape.points[4] += Vector_3(0.15, 0.1, 0);
    const Outcome out = optimized(shape, reference);
    RCO_CHECK_EQUAL(out.result.number_of_free_vertices, 1u);
    RCO_CHECK_LESS((out.after.points[4] - reference.points[4]).norm(), 0.05);
  }
  {
    const Scope scope("isolated vertices");
    Shape shape = scrambled(plane_grid(6, 6), 0.3, 3, onto_plane);
    shape.add(100, 200, 300);
    const Outcome out = optimized(shape, plane_grid(6, 6));
    RCO_CHECK_EQUAL(out.result.number_of_free_vertices, 25u);
    RCO_CHECK_LESS(out.result.final_energy, out.result.initial_energy);
    // and in the reference
    Shape reference = plane_grid(6, 6);
    reference.add(0.5, 0.5, 10);
    const Outcome other = optimized(shape, reference);
    RCO_CHECK_LESS(other.result.final_energy, other.result.initial_energy);
  }
  for(const bool is_copy : {false, true})
  {
    const Scope scope("components that touch in a vertex of both, and sheets on top of each other");
    const Shape sphere = icosphere(2);
    for(const Shape& shape :
        {joined(sphere, sphere, 2 * sphere.points[5]),
         joined(plane_grid(6, 6), turned_round(plane_grid(6, 6)), Vector_3::Zero())})
    {
      Shape rotated = shape; // the same surface, its vertices in another order
      std::rotate(rotated.points.begin(), rotated.points.begin() + 7, rotated.points.end());
      const int n = int(shape.points.size()), faces = int(shape.faces.size());
      for(auto& f : rotated.faces)
        for(int& v : f)
          v = (v + n - 7) % n;
      const Outcome out = optimized(shape, is_copy ? rotated : shape);
      RCO_CHECK_EQUAL(out.result.initial_number_of_flips, 0u);
      for(int v = 0; v < n; ++v)
        RCO_CHECK_EQUAL(out.locations[v].first < faces / 2, v < n / 2);
    }
  }
  {
    const Scope scope("all vertices constrained");
    Options options;
    const Shape shape = scrambled(icosphere(2), 0.3, 4, onto_sphere);
    options.vertex_is_constrained.assign(shape.points.size(), 1);
    const Outcome out = optimized(shape, icosphere(2), options);
    RCO_CHECK(out.result.status == RCO::Status::nothing_to_do);
    RCO_CHECK(same_bits(out.before, out.after));
    RCO_CHECK_LESS(0., out.result.largest_initial_distance);
  }
}

void test_constraints()
{
  {
    // some vertices, a few of them off the reference
    Shape shape = scrambled(icosphere(3), 0.3, 5, onto_sphere);
    Options options;
    Random random(6);
    for(Vector_3& p : shape.points)
    {
      options.vertex_is_constrained.push_back(random() < 0.2);
      if(options.vertex_is_constrained.back() && random() < 0.2)
        p *= 1.02;
    }
    const Outcome out = optimized(shape, icosphere(3), options);
    RCO_CHECK_LESS(out.result.final_energy, out.result.initial_energy);
    RCO_CHECK_LESS(0.015, out.result.largest_initial_distance);
    std::size_t moved = 0;
    for(std::size_t v = 0; v < shape.points.size(); ++v)
      moved += !same_bits(out.before.points[v], out.after.points[v]);
    RCO_CHECK_LESS(out.result.number_of_free_vertices / 2, moved);
  }
  {
    // the edges of a cube keep its sides apart: every face stays in its plane
    const int n = 8;
    Shape shape = cube(n);
    const Shape reference = shape;
    Random random(7);
    for(Vector_3& p : shape.points)
      if(number_of_planes(p) == 1)
        for(int i = 0; i < 3; ++i)
          if(p(i) != 0 && p(i) != 1)
            p(i) += random(-0.3, 0.3) / n;
    Options options;
    for(const auto& t : shape.faces)
      for(int i = 0; i < 3; ++i)
      {
        const int a = t[i], b = t[(i + 1) % 3];
        if(number_of_planes(0.5 * (shape.points[a] + shape.points[b])) == 2)
          options.constrained_edges.insert({(std::min)(a, b), (std::max)(a, b)});
      }
    RCO_CHECK_EQUAL(options.constrained_edges.size(), std::size_t(12 * n));
    const Outcome out = optimized(shape, reference, options);
    RCO_CHECK_LESS(out.result.final_energy, out.result.initial_energy);
    RCO_CHECK_EQUAL(out.result.number_of_free_vertices, std::size_t(6 * (n - 1) * (n - 1)));
    RCO_CHECK_NEAR(area(out.after), 6., 1e-9);
    RCO_CHECK_LESS(35., smallest_angle(out.after));
  }
}

void test_degenerate_faces()
{
  const Shape regular = icosphere(3);
  const std::vector<int> moved = {100, 250, 400, 600};
  const Shape shape = collapsed(scrambled(regular, 0.25, 8, onto_sphere), moved);
  std::size_t degenerate = 0;
  for(const auto& t : shape.faces)
    degenerate += vector_area(shape, t).norm() == 0;
  RCO_CHECK_EQUAL(degenerate, 8u);
  const Outcome out = optimized(shape, regular);
  RCO_CHECK_LESS(mean_smallest_angle(shape) + 5, out.measures.mean_angle);
  // they open, as they may
  RCO_CHECK_LESS(20., out.measures.smallest_angle);

  // the same vertices cannot move: their faces stay as they are, everything else improves
  Options options;
  for(const Vector_3& p : shape.points)
    options.vertex_is_constrained.push_back(
      std::any_of(moved.begin(), moved.end(), [&](int v) { return shape.points[v] == p; }));
  const Outcome held = optimized(shape, regular, options);
  RCO_CHECK_LESS(mean_smallest_angle(shape) + 4, held.measures.mean_angle);
  std::size_t bad = 0;
  for(const auto& t : held.after.faces)
    bad += smallest_angle(held.after.points[t[0]], held.after.points[t[1]],
                          held.after.points[t[2]]) < 15;
  RCO_CHECK_LESS_EQUAL(bad, 40u);

  // a mesh without any area is refused, not touched
  const Shape line = deformed(
    plane_grid(5, 5), [](const Vector_3& p) { return Vector_3(p.x(), 0.1 + 0.7 * p.x(), 1e-3); });
  Mesh held_back = mesh_of(line);
  const Mesh plane = mesh_of(plane_grid(4, 4, 2));
  RCO_CHECK_THROWS(improve_angles(held_back, plane), RCO::Invalid_input,
                   "mesh: every face has zero area");
  RCO_CHECK(same_bits(make_shape(held_back), line));

  // a reference with faces of no area
  const Outcome both = optimized(scrambled(regular, 0.25, 9, onto_sphere), shape);
  RCO_CHECK_LESS(both.result.final_energy, both.result.initial_energy);

  // a folded start: no more flips and folds than before, and energy where they stay
  const Outcome unfolded =
    optimized(scrambled(plane_grid(14, 14), 0.8, 10, onto_plane), plane_grid(14, 14));
  RCO_CHECK_LESS(5u, unfolded.result.initial_number_of_flips);
  RCO_CHECK_LESS(defects_after(unfolded.result), defects_before(unfolded.result));
  std::cout << "scrambled beyond folding: " << unfolded.result.initial_number_of_flips
            << " flips and " << unfolded.result.initial_number_of_fold_edges << " fold edges -> "
            << unfolded.result.number_of_flips << " and " << unfolded.result.number_of_fold_edges
            << std::endl;
}

// a thin sheet, where the other side is nearer than the next vertex: no vertex changes sides
void test_thin_sheet()
{
  for(const double gap : {1e-2, 1e-5})
  {
    const Shape fine = double_sheet(30, gap, 0.04);
    Shape shape = double_sheet(15, gap, 0.04);
    Random random(11);
    const int half = int(shape.points.size()) / 2;
    Options options;
    options.vertex_is_constrained.assign(shape.points.size(), 0);
    for(std::size_t v = 0; v < shape.points.size(); ++v)
    {
      Vector_3& p = shape.points[v];
      const bool rim = p.head<2>().minCoeff() < 1e-9 || p.head<2>().maxCoeff() > 1 - 1e-9;
      options.vertex_is_constrained[v] = rim;
      if(rim)
        continue;
      p.x() += random(-0.3, 0.3) / 15;
      p.y() += random(-0.3, 0.3) / 15;
      // onto the fine sheet's chord
      const double x = 30 * p.x(), low = std::floor(x) / 30, high = low + 1. / 30;
      const double t = x - std::floor(x);
      p.z() = 0.04 * ((1 - t) * std::sin(4 * pi * low) + t * std::sin(4 * pi * high)) -
              (int(v) < half ? 0 : gap);
    }
    const Outcome out = optimized(shape, fine, options);
    RCO_CHECK_LESS(out.result.final_energy, out.result.initial_energy);
    const int fine_half = int(fine.points.size()) / 2;
    for(std::size_t v = 0; v < shape.points.size(); ++v)
    {
      if(!out.is_free[v])
        continue;
      for(const int w : fine.faces[out.locations[v].first])
        RCO_CHECK_EQUAL(w < fine_half, int(v) < half);
    }
  }
}

// Sheets a tenth of an edge apart, pleats, a blade and fingers that nearly touch: nothing gets worse, and as
// long as nothing intersects nothing will.
void test_close_sheets()
{
  const double edge = 1. / 16;
  const Shape finger = scaled(icosphere(3), 0.3, 0.3, 1);
  const std::vector<std::pair<std::string, Shape>> shapes = {
    {"close sheets", double_sheet(16, 0.1 * edge, 0.1)},
    {"a blade", double_sheet(16, edge, 0.04, 0.98)},
    {"pleats of 173 degrees", pleats(4, 6, 173)},
    {"fins",
     deformed(pleats(4, 6, 160),
              [](const Vector_3& p) { return Vector_3(p.x(), p.y(), (std::max)(p.z(), 0.5)); })},
    {"fingers", joined(finger, finger, Vector_3(0.605, 0.01, 0.02))}};
  int improved = 0;
  std::size_t creases_allowed = 0, intersections_allowed = 0;
  for(const std::pair<std::string, Shape>& s : shapes)
  {
    const Scope scope(s.first);
    for(int seed = 0; seed < 2; ++seed)
    {
      Mesh mesh = mesh_of(s.second);
      const Mesh reference = mesh;
      const auto np = params::detect_features(false);
      const RCO::Result r =
        improve_angles(mesh, reference, np.number_of_iterations(10).random_seed(seed));
      RCO_CHECK_EQUAL(r.initial_number_of_self_intersections, 0u);
      improved += r.final_energy < r.initial_energy;
      check_result(s.second, mesh, reference, r);
      Mesh free = reference;
      const RCO::Result any = improve_angles(
        free, reference,
        np.allow_creases(true).allow_self_intersections(true).number_of_iterations(10).random_seed(
          seed));
      creases_allowed +=
        any.number_of_creases - (std::min)(any.number_of_creases, r.number_of_creases);
      intersections_allowed += any.number_of_self_intersections;
    }
  }
  RCO_CHECK_EQUAL(improved, 8); // nothing can be gained between the folds of the pleats
  RCO_CHECK_LESS(0u, creases_allowed);
  RCO_CHECK_LESS(0u, intersections_allowed);
  std::cout << "if allowed: " << creases_allowed << " more creases, " << intersections_allowed
            << " intersections" << std::endl;
}

void test_determinism()
{
  const Shape regular = torus(40, 16), rough = scrambled(regular, 0.3, 12, onto_torus(1, 0.4));
  Options options;
  options.iterations = 4;
  options.patch_size = 150;
  const Outcome first = optimized(rough, regular, options);
  const Outcome second = optimized(rough, regular, options);
  RCO_CHECK(same_bits(first.after, second.after));
  RCO_CHECK_EQUAL(first.result.final_energy, second.result.final_energy);
  RCO_CHECK_EQUAL(first.result.number_of_patches, second.result.number_of_patches);
  options.seed = 1;
  const Outcome third = optimized(rough, regular, options);
  RCO_CHECK(!same_bits(first.after, third.after));
  RCO_CHECK_NEAR(third.result.final_energy, first.result.final_energy,
                 0.1 * first.result.final_energy);

  options.seed = 0;
  with_threads([&](auto tag) {
    const Outcome out = optimized<decltype(tag)>(rough, regular, options);
    RCO_CHECK(same_bits(first.after, out.after));
    RCO_CHECK_EQUAL(first.result.final_energy, out.result.final_energy);
    RCO_CHECK_EQUAL(first.result.number_of_patches, out.result.number_of_patches);
  });

  // the same object for both, or a copy of it
  Mesh alone = mesh_of(rough), other = mesh_of(rough);
  const Mesh copy = other;
  const Outcome same = run(alone, alone, options), apart = run(other, copy, options);
  RCO_CHECK(same_bits(same.after, apart.after));
  RCO_CHECK_EQUAL(same.result.final_energy, apart.result.final_energy);
  RCO_CHECK_LESS(same.result.final_energy, same.result.initial_energy);
  RCO_CHECK_EQUAL(same.result.largest_initial_distance, 0.);
}

// A cylinder of long strips is as good as it gets, nearly: what searches for better places all the same
// is to give up soon.
void test_nothing_to_gain()
{
  Mesh mesh = mesh_of(closed_cylinder(48, 1, 1, 30));
  const double smallest = smallest_angle(make_shape(mesh));
  Recorder recorder;
  const RCO::Result result = improve_angles(mesh, mesh, params::visitor(std::ref(recorder)));
  RCO_CHECK_LESS(result.number_of_patches, 30u);
  // it is asked whether to go on after every few hundred trials of a search
  RCO_CHECK_LESS(recorder.questions, 1500);
  RCO_CHECK_LESS_EQUAL(result.final_energy, result.initial_energy);
  RCO_CHECK_LESS_EQUAL(smallest, smallest_angle(make_shape(mesh)));
}

void test_endings()
{
  const Shape regular = torus(30, 12);
  // on the reference already, so that the start is known
  const Shape rough = [&] {
    Shape s = scrambled(regular, 0.3, 14, onto_torus(1, 0.4));
    Options none;
    none.iterations = 0;
    return optimized(s, regular, none).after;
  }();
  Options options;
  options.patch_size = 80;

  {
    const Scope s("no iteration");
    options.iterations = 0;
    const Outcome out = optimized(rough, regular, options);
    RCO_CHECK(same_bits(out.before, out.after));
    RCO_CHECK_EQUAL(out.result.number_of_iterations, 0u);
    RCO_CHECK(out.result.status == RCO::Status::iteration_limit);
    RCO_CHECK_EQUAL(out.result.final_energy, out.result.initial_energy);
    options.iterations = 1;
    const Outcome one = optimized(rough, regular, options);
    RCO_CHECK_EQUAL(one.result.number_of_iterations, 1u);
    RCO_CHECK(one.result.status == RCO::Status::iteration_limit);
    RCO_CHECK_LESS(one.result.final_energy, one.result.initial_energy);
    options.iterations = 30;
  }
  const Outcome complete = optimized(rough, regular, options);
  RCO_CHECK(complete.result.status == RCO::Status::converged);
  double previous = complete.result.initial_energy;
  // the finishing stage may cost some energy
  const long first = complete.recorder.questions_of_setup,
             last = complete.recorder.questions_of_iterations - 1;
  for(const long questions : {first, first + 1, (3 * first + last) / 4, (first + last) / 2, last})
  {
    const Scope s("interrupted after " + std::to_string(questions));
    options.recorder.questions_until_stop = questions;
    const Outcome out = optimized(rough, regular, options);
    RCO_CHECK(out.result.status == RCO::Status::interrupted);
    RCO_CHECK_LESS_EQUAL(out.result.final_energy, previous);
    if(questions == first)
      RCO_CHECK(same_bits(out.before, out.after));
    previous = out.result.final_energy;
  }
  RCO_CHECK_LESS(previous, complete.result.initial_energy);
  options.recorder.questions_until_stop = -1;

  for(const int patches : {0, 1, 5, 20})
  {
    const Scope s("thrown at patch " + std::to_string(patches));
    options.recorder.patches_until_throw = patches;
    options.expect_throw = true;
    const Outcome out = optimized(rough, regular, options);
    RCO_CHECK_EQUAL(out.recorder.patches, std::size_t(patches + 1));
    // what was accepted up to then is written, and nothing else
    const double n = double(rough.faces.size());
    if(out.recorder.finishing == 0)
      RCO_CHECK_NEAR(out.measures.energy * n,
                     complete.result.initial_energy * n + out.recorder.energy_change,
                     on_the_way * complete.result.initial_energy * n);
    if(out.recorder.accepted > 0)
      RCO_CHECK_LESS(out.recorder.energy_change, 0.);
  }
  options.recorder.patches_until_throw = -1;
  options.expect_throw = false;

  {
    const Scope s("time limit");
    Mesh mesh = mesh_of(rough);
    const RCO::Result result =
      improve_angles(mesh, mesh_of(regular), params::maximum_running_time(1e-9));
    RCO_CHECK(result.status == RCO::Status::time_limit);
    RCO_CHECK(same_bits(make_shape(mesh), rough));
  }
  {
    const Scope s("a converged mesh");
    const Outcome again = optimized(complete.after, regular, options);
    RCO_CHECK_LESS_EQUAL(again.result.final_energy, complete.result.final_energy);
    RCO_CHECK_LESS(complete.result.final_energy * 0.97, again.result.final_energy);
  }
}

// a larger exponent raises the smallest angle
void test_exponents()
{
  const Shape rough = scrambled(torus(30, 12), 0.3, 15, onto_torus(1, 0.4));
  for(const double k : {0.5, 2.})
  {
    Options options;
    options.iterations = 5;
    const Outcome out = optimized(rough, torus(30, 12), options, k);
    RCO_CHECK_LESS(smallest_angle(rough) + 5, out.measures.smallest_angle);
  }
}

void test_data(const std::string& name, unsigned int iterations)
{
  const Scope scope(name);
  const Shape shape = read_data(name);
  if(shape.faces.empty())
    return;
  Options options;
  options.iterations = iterations;
  const Outcome out = optimized(shape, shape, options);
  const Measures& after = out.measures;
  const double before = smallest_angle(out.before);
  RCO_CHECK_EQUAL(out.result.largest_initial_distance, 0.);
  RCO_CHECK_LESS(out.result.final_energy, out.result.initial_energy);
  RCO_CHECK_LESS_EQUAL(out.result.number_of_flips, out.result.initial_number_of_flips);
  RCO_CHECK_LESS_EQUAL(out.result.number_of_fold_edges, out.result.initial_number_of_fold_edges);
  RCO_CHECK_LESS_EQUAL(before * (1 - 1e-9), after.smallest_angle);
  RCO_CHECK_LESS(mean_smallest_angle(out.before), after.mean_angle);
  std::cout << name << ": smallest angle " << before << " -> " << after.smallest_angle << ", mean "
            << mean_smallest_angle(out.before) << " -> " << after.mean_angle << ", "
            << out.result.number_of_iterations << " iterations, " << out.result.running_time << " s"
            << std::endl;
}

// Distances of what the barrier watches, by the search tree: the larger of the two directions.
double watched_drift(const Mesh& mesh, const Mesh& reference)
{
  typedef CGAL::Simple_cartesian<double> Kernel;
  typedef CGAL::AABB_face_graph_triangle_primitive<Mesh> Primitive;
  typedef RCO::internal::Primitive_tree<Kernel, Primitive> Tree;
  const Tree to_reference(faces(reference).begin(), faces(reference).end(), reference),
    to_mesh(faces(mesh).begin(), faces(mesh).end(), mesh);
  double largest = 0;
  for(const Mesh::Edge_index e : mesh.edges())
    largest = (std::max)(largest, to_reference.squared_distance(CGAL::midpoint(
                                    mesh.point(mesh.vertex(e, 0)), mesh.point(mesh.vertex(e, 1)))));
  for(const Mesh::Face_index f : mesh.faces())
  {
    std::vector<Kernel::Point_3> p;
    for(const Mesh::Vertex_index v : vertices_around_face(mesh.halfedge(f), mesh))
      p.push_back(mesh.point(v));
    largest = (std::max)(largest, to_reference.squared_distance(CGAL::centroid(p[0], p[1], p[2])));
  }
  for(const Mesh::Vertex_index v : reference.vertices())
    largest = (std::max)(largest, to_mesh.squared_distance(reference.point(v)));
  return std::sqrt(largest);
}

// a model with sharp edges: the drift bound holds, and it is not satisfied without it
void test_drift(const std::string& name)
{
  const Scope scope("drift of " + name);
  const Mesh input = mesh_of(read_data(name));
  if(input.is_empty())
    return;
  const double edge = RCO::drift(input, input).reference_mean_edge_length;
  const double infinity = std::numeric_limits<double>::infinity();
  double last = infinity;
  for(const double bound : {infinity, 0.5 * edge, -1., 0.1 * edge})
  {
    Mesh mesh = input;
    const auto np = params::detect_features(false);
    const RCO::Result result =
      bound < 0 ? improve_angles(mesh, input, np.number_of_iterations(5))
                : improve_angles(mesh, input, np.drift_bound(bound).number_of_iterations(5));
    const double drift = watched_drift(mesh, input);
    RCO_CHECK_LESS(result.final_energy, result.initial_energy);
    if(bound == infinity)
    {
      RCO_CHECK_EQUAL(result.drift_bound, infinity);
      RCO_CHECK_LESS(1.2 * 0.25 * edge, drift); // there is something to prevent
    }
    else
    {
      RCO_CHECK_NEAR(result.drift_bound, bound < 0 ? 0.25 * edge : bound, 1e-12 * edge);
      RCO_CHECK_LESS_EQUAL(result.initial_drift, 1e-12 * edge);
      RCO_CHECK_LESS_EQUAL(drift, result.drift + 1e-5 * edge); // coordinates are rounded
      RCO_CHECK_LESS_EQUAL(result.drift, 1.1 * result.drift_bound);
      RCO_CHECK_LESS(RCO::drift(mesh, input).maximum(), 2 * result.drift_bound);
    }
    RCO_CHECK_LESS_EQUAL(drift, last);
    last = drift;

    // from there on with a smaller bound, nothing gets worse
    const RCO::Result again =
      improve_angles(mesh, input, np.drift_bound(0.05 * edge).number_of_iterations(2));
    RCO_CHECK_LESS_EQUAL(again.drift, again.initial_drift * (1 + 1e-12));
    RCO_CHECK_LESS_EQUAL(watched_drift(mesh, input), again.initial_drift * (1 + 1e-12));
  }
}

int main()
{
  run_test("recoveries", test_recoveries);
  run_test("quads", test_quads);
  run_test("small meshes", test_small_meshes);
  run_test("constraints", test_constraints);
  run_test("degenerate faces", test_degenerate_faces);
  run_test("thin sheet", test_thin_sheet);
  run_test("close sheets", test_close_sheets);
  run_test("determinism", test_determinism);
  run_test("nothing to gain", test_nothing_to_gain);
  run_test("endings", test_endings);
  run_test("exponents", test_exponents);
  run_test("drift", [] { test_drift("fandisk.off"); });
  run_test("data", [] {
    test_data("blobby.off", 6);
    test_data("elephant.off", 4);
    test_data("mesh_with_border.off", 6);
    test_data("cow.off", 3);
  });
  return report();
}
