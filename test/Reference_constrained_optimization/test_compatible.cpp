// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Compatible remeshing: the energy, initial meshes from landmarks, and the optimization from them.

#include "Recorder.h"
#include "optimization.h"
#include "surfaces.h"

#include <CGAL/Reference_constrained_optimization/Compatible_remeshing_energy.h>
#include <CGAL/Reference_constrained_optimization/compatible_initial_mesh.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/subdivision_method_3.h>

#include <array>
#include <limits>
#include <map>
#include <set>

using namespace rco_test;

typedef CGAL::Exact_predicates_inexact_constructions_kernel Epick;
typedef CGAL::Polyhedron_3<Epick> Polyhedron;
typedef RCO::Compatible_remeshing_energy Energy;

Eigen::Matrix2d gram(const Shape& s, const std::vector<int>& t)
{
  const Vector_3 a = s.points[t[1]] - s.points[t[0]], b = s.points[t[2]] - s.points[t[0]];
  Eigen::Matrix2d g;
  g << a.dot(a), a.dot(b), a.dot(b), b.dot(b);
  return g;
}

// the density of one triangle, the source scaled; infinite for a mesh's triangle without area
double dirichlet(const Shape& source, const Shape& mesh, const std::vector<int>& t, double scale)
{
  const Eigen::Matrix2d q = scale * scale * gram(source, t), m = gram(mesh, t);
  if(!(m.determinant() > 0))
    return std::numeric_limits<double>::infinity();
  return (q.inverse() * m).trace() + (m.inverse() * q).trace();
}

double mean_dirichlet(const Shape& source, const Shape& mesh, double scale)
{
  double sum = 0;
  for(const std::vector<int>& t : source.faces)
    sum += dirichlet(source, mesh, t, scale);
  return sum / double(source.faces.size());
}

// triangles that are inverted or worse than the cap count as the cap
double capped_energy(const Shape& source,
                     const Shape& mesh,
                     const internal::Reference_surface& surface,
                     double cap)
{
  const double scale = std::sqrt(surface.area() / area(source));
  double sum = 0;
  for(const std::vector<int>& t : source.faces)
  {
    Vector_3 up = Vector_3::Zero();
    for(const int v : t)
      up += surface.normal(surface.closest(mesh.points[v]));
    sum +=
      vector_area(mesh, t).dot(up) > 0 ? (std::min)(cap, dirichlet(source, mesh, t, scale)) : cap;
  }
  return sum / double(source.faces.size());
}

// the same faces in the same order; each may start at another of its vertices
bool same_connectivity(const Shape& a, const Shape& b)
{
  if(a.points.size() != b.points.size() || a.faces.size() != b.faces.size())
    return false;
  for(std::size_t f = 0; f < a.faces.size(); ++f)
  {
    std::vector<int> face = b.faces[f];
    const auto first = std::find(face.begin(), face.end(), a.faces[f].front());
    std::rotate(face.begin(), first, face.end());
    if(face != a.faces[f])
      return false;
  }
  return true;
}

// the source scaled to the reference's area
RCO::Distortion_statistics distortion(const Mesh& source, const Mesh& mesh, double area)
{
  const auto np = params::default_values();
  return RCO::distortion_statistics(source, mesh, np, np, area);
}

struct Outcome
{
  RCO::Result result;
  Shape after;
  RCO::Distortion_statistics distortion; // at the end
};

// the optimization, with all that must hold whatever the meshes; triangles only
Outcome
optimized(const Shape& source, const Shape& start, const Shape& reference, bool on_surface = true)
{
  Outcome out;
  Mesh mesh = mesh_of(start);
  const Mesh q = mesh_of(source), r = mesh_of(reference);
  const Energy energy(q);
  const RCO::Orientation_defects defects = RCO::orientation_defects(mesh, r);
  Recorder recorder;
  out.result = CGAL::reference_constrained_optimize(
    mesh, r, energy, params::use_on_surface_steps(on_surface).visitor(std::ref(recorder)));
  out.after = make_shape(mesh);
  out.distortion = distortion(q, mesh, area(reference));

  RCO_CHECK(same_connectivity(start, out.after));
  const RCO::Result& result = out.result;
  check_result(make_shape(mesh_of(start)), mesh, r, result);
  RCO_CHECK_EQUAL(result.initial_number_of_flips, defects.number_of_flips);
  RCO_CHECK_EQUAL(result.initial_number_of_fold_edges, defects.number_of_fold_edges);
  RCO_CHECK_EQUAL(result.number_of_accepted_patches, recorder.accepted);
  // no stretch is beyond the density's cap
  if(result.number_of_flips == 0 && out.distortion.maximum < 1000)
    RCO_CHECK_NEAR(result.final_energy, 2 * out.distortion.mean, 1e-9 * result.final_energy);
  return out;
}

// faces start with the first, the second, ... of their vertices in turn
Shape with_other_first_vertices(Shape shape)
{
  for(std::size_t f = 0; f < shape.faces.size(); ++f)
  {
    std::vector<int>& face = shape.faces[f];
    std::rotate(face.begin(), face.begin() + f % face.size(), face.end());
  }
  return shape;
}

template <typename Source, typename NamedParameters = params::Default_named_parameters>
RCO::Result start_of(Mesh mesh,
                     const Mesh& reference,
                     const Source& source,
                     const NamedParameters& np = params::default_values())
{
  return CGAL::reference_constrained_optimize(mesh, reference, Energy(source, np),
                                              params::number_of_iterations(0u));
}

void test_energy()
{
  const Shape shape = deformed(icosphere(2), bumpy), source = deformed(icosphere(2), ellipsoidal);
  const Mesh mesh = mesh_of(shape), q = mesh_of(source);
  const Shape fine = deformed(icosphere(4), bumpy); // mesh and reference differ in area
  const Mesh reference = mesh_of(fine);
  RCO_CHECK_LESS(area(shape), 0.995 * area(fine));
  const RCO::Result result = start_of(mesh, reference, q);
  const double energy = result.initial_energy;
  RCO_CHECK_EQUAL(result.initial_number_of_flips, 0u);
  RCO_CHECK_EQUAL(result.final_energy, energy);
  RCO_CHECK_NEAR(energy, 2 * distortion(q, mesh, area(fine)).mean, 1e-10 * energy);
  RCO_CHECK_NEAR(energy, mean_dirichlet(source, shape, std::sqrt(area(fine) / area(source))),
                 1e-10 * energy);
  RCO_CHECK_LESS(4.1, energy);

  // size does not count unless it is to
  const Shape large = scaled(source, 10);
  const Mesh large_q = mesh_of(large);
  RCO_CHECK_NEAR(start_of(mesh, reference, large_q).initial_energy, energy, 1e-10 * energy);
  const auto own_sizes = params::use_equal_areas(false);
  RCO_CHECK_NEAR(start_of(mesh, reference, q, own_sizes).initial_energy,
                 mean_dirichlet(source, shape, 1), 1e-10 * energy);
  RCO_CHECK_NEAR(start_of(mesh, reference, large_q, own_sizes).initial_energy,
                 mean_dirichlet(large, shape, 1), 1e-9 * mean_dirichlet(large, shape, 1));
  RCO_CHECK_LESS(10 * energy, start_of(mesh, reference, large_q, own_sizes).initial_energy);

  // other types
  RCO_CHECK_NEAR(start_of(mesh, reference, make_mesh<Polyhedron>(source)).initial_energy, energy,
                 1e-10 * energy);

  // faces that start elsewhere, each third in the same way
  const Shape turned = with_other_first_vertices(source);
  const Mesh turned_q = mesh_of(turned);
  RCO_CHECK(make_shape(turned_q).faces != make_shape(q).faces);
  RCO_CHECK_NEAR(start_of(mesh, reference, turned_q).initial_energy, energy, 1e-10 * energy);
}

void test_energy_of_quads()
{
  Shape source = deformed(square(8, 6, true), arched);
  const Shape shape = deformed(square(8, 6, true), hilly);
  const Mesh mesh = mesh_of(shape);
  double shorter_first = 0;
  Shape split = source;
  split.faces.clear();
  for(const std::vector<int>& f : source.faces)
  {
    const bool second = (source.points[f[0]] - source.points[f[2]]).norm() >
                        (source.points[f[1]] - source.points[f[3]]).norm();
    shorter_first += !second;
    split.quad(f[0], f[1], f[2], f[3], second);
  }
  RCO_CHECK(shorter_first > 0 && shorter_first < double(source.faces.size()));
  // quads that start elsewhere, too
  const Shape turned = with_other_first_vertices(source);
  const Shape reference = deformed(square(30, 24), hilly);
  const double expected = mean_dirichlet(split, shape, std::sqrt(area(reference) / area(split)));
  const Mesh r = mesh_of(reference);
  Mesh moving = mesh;
  const RCO::Result result =
    CGAL::reference_constrained_optimize(moving, r, Energy(mesh_of(source)));
  // free vertices were moved onto the reference first
  RCO_CHECK_NEAR(result.initial_energy, expected, 0.02 * expected);
  RCO_CHECK_LESS(result.final_energy, result.initial_energy);
  RCO_CHECK_EQUAL(result.number_of_flips, 0u);
  Mesh same = mesh;
  const RCO::Result again = CGAL::reference_constrained_optimize(
    same, mesh, Energy(mesh_of(turned), params::use_equal_areas(false)),
    params::number_of_iterations(0u));
  RCO_CHECK_NEAR(again.initial_energy, mean_dirichlet(split, shape, 1), 1e-9 * expected);
}

void test_energy_mismatches()
{
  const Shape shape = deformed(square(6, 5), hilly);
  const auto refuses = [&](const Shape& source, const std::string& text) {
    const Scope s(text);
    Mesh mesh = mesh_of(shape);
    const Shape before = make_shape(mesh);
    const auto optimize = [&](const auto& q) {
      CGAL::reference_constrained_optimize(mesh, mesh_of(shape), Energy(q));
    };
    RCO_CHECK_THROWS(optimize(mesh_of(source)), RCO::Invalid_input, text);
    RCO_CHECK_THROWS(optimize(make_mesh<Polyhedron>(source)), RCO::Invalid_input, text);
    RCO_CHECK(same_bits(before, make_shape(mesh)));
  };
  const int n = int(shape.faces.size());
  {
    // one square is split along its other diagonal
    const int k = 11;
    const std::vector<int> q = square(6, 5, true).faces[k];
    Shape other, source = shape;
    other.quad(q[0], q[1], q[2], q[3], true);
    std::copy(other.faces.begin(), other.faces.end(), source.faces.begin() + 2 * k);
    RCO_CHECK(source.faces[2 * k] != shape.faces[2 * k]);
    refuses(source, "face " + std::to_string(2 * k) + " has the vertices");
  }
  refuses(turned_round(shape), "face 0 has the vertices");
  refuses(without_faces(shape, [=](int f) { return f >= n - 2; }),
          "face " + std::to_string(n - 2) + " of the mesh has no counterpart");
  {
    Shape source = shape;
    source.add(2, 0, 0);
    source.add(2, 1, 0);
    refuses(source, "vertices, the mesh " + std::to_string(shape.points.size()));
    source.triangle(5, int(shape.points.size()), 6); // behind the last face, along the border
    const Mesh closed = mesh_of(source);
    RCO_CHECK_EQUAL(int(faces(closed).size()), n + 1);
    refuses(source, "face " + std::to_string(n) + " of the source has no counterpart");
  }
  {
    Shape source = shape;
    const int f = 17;
    source.points[source.faces[f][0]] =
      0.5 * (source.points[source.faces[f][1]] + source.points[source.faces[f][2]]);
    int first = f;
    for(int g = n - 1; g >= 0; --g)
      if(gram(source, source.faces[g]).determinant() < 1e-20)
        first = g;
    RCO_CHECK_THROWS(Energy(mesh_of(source)), RCO::Invalid_input,
                     "face " + std::to_string(first) +
                       " of the source has a triangle without area");
  }
}

Vector_3 twisted_ellipsoidal(const Vector_3& p) { return twisted(ellipsoidal(p)); }
Vector_3 bent_ellipsoidal(const Vector_3& p) { return bent(ellipsoidal(p)); }

void test_known_optimum(const std::string& name, const Shape& shape, std::uint64_t seed)
{
  const Scope scope("back to " + name);
  double displacement = 0;
  const internal::Reference_surface surface = surface_of(shape);
  const Shape start = wandered(shape, surface, 24, 0.3, seed, displacement);
  const Outcome out = optimized(shape, start, shape);
  RCO_CHECK_EQUAL(out.result.initial_number_of_flips, 0u);
  RCO_CHECK_LESS(0.4, displacement);
  RCO_CHECK_LESS(5., out.result.initial_energy);
  RCO_CHECK_LESS_EQUAL(out.distortion.mean, 2.001);
}

void test_known_optima()
{
  for(const int seed : {1, 2, 3})
    test_known_optimum("a blob", deformed(icosphere(4), bumpy), seed);
  test_known_optimum("a twisted ellipsoid", deformed(icosphere(4), twisted_ellipsoidal), 4);
  test_known_optimum("a bent ellipsoid", deformed(icosphere(4), bent_ellipsoidal), 5);
  test_known_optimum("a torus", torus(72, 36), 6);
  test_known_optimum("a hill", deformed(square(50, 50), hilly), 7);
}

struct Pair
{
  Shape source, reference;
  std::vector<std::pair<int, int>> landmarks;
};

template <typename Source>
auto descriptors(const Source& source, const Mesh& reference, const Pair& pair)
{
  typedef typename boost::graph_traits<Source>::vertex_descriptor Vertex;
  std::vector<std::pair<Vertex, Mesh::Vertex_index>> result;
  for(const auto& l : pair.landmarks)
    result.push_back({*std::next(vertices(source).begin(), l.first),
                      *std::next(vertices(reference).begin(), l.second)});
  return result;
}

// two spheres of different triangles, and landmarks near given directions
Pair sphere_pair(const Shape& source,
                 const Deformation& to_source,
                 const Shape& reference,
                 const Deformation& to_reference,
                 int number_of_landmarks)
{
  const std::vector<Vector_3> directions = {Vector_3(1, 0.1, 0.1),     Vector_3(-0.6, 0.7, 0.2),
                                            Vector_3(-0.5, -0.7, 0.4), Vector_3(0.1, 0.1, -1),
                                            Vector_3(0.2, 0.2, 1),     Vector_3(0.3, 0.9, -0.3),
                                            Vector_3(0.3, -0.9, -0.2), Vector_3(-0.9, 0, -0.3)};
  Pair pair{deformed(source, to_source), deformed(reference, to_reference), {}};
  for(int i = 0; i < number_of_landmarks; ++i)
    pair.landmarks.push_back({nearest(source, directions[i].normalized()),
                              nearest(reference, directions[i].normalized())});
  return pair;
}

// two squares, and landmarks near given points
Pair square_pair(const std::vector<Vector_2>& points)
{
  const Shape source = square(20, 18);
  const Shape reference = deformed(square(25, 31), [](const Vector_3& p) -> Vector_3 {
    const double b = 0.05 * std::sin(pi * p.x()) * std::sin(pi * p.y());
    return p + Vector_3(b, -b, 0);
  });
  Pair pair{deformed(source, arched), deformed(reference, hilly), {}};
  for(const Vector_2& p : points)
    pair.landmarks.push_back(
      {nearest(source, Vector_3(p.x(), p.y(), 0)), nearest(reference, Vector_3(p.x(), p.y(), 0))});
  return pair;
}

double distance_to_border(const Shape& s, const Indexed_mesh& mesh, const Vector_3& p)
{
  double least = std::numeric_limits<double>::infinity();
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(mesh.opposite[c] < 0)
    {
      const Vector_3 &a = s.points[mesh.source(c)], d = s.points[mesh.target(c)] - a;
      const double t = (std::min)(1., (std::max)(0., (p - a).dot(d) / d.squaredNorm()));
      least = (std::min)(least, (a + t * d - p).norm());
    }
  return least;
}

struct Mapped
{
  RCO::Initial_mesh_report report;
  Shape shape;
};

// the initial mesh, with all that must hold of it
template <typename Source = Mesh>
Mapped mapped(const Pair& pair, const std::string& name, unsigned int seed = 0)
{
  const Scope scope("the map of " + name);
  const Source source = make_mesh<Source>(pair.source);
  const Mesh reference = mesh_of(pair.reference);
  const Shape source_before = make_shape(source), reference_before = make_shape(reference);
  Mesh output = mesh_of(tetrahedron()); // goes
  Mapped m;
  try
  {
    m.report = RCO::compatible_initial_mesh(source, reference, descriptors(source, reference, pair),
                                            output, params::random_seed(seed));
  }
  catch(const RCO::Invalid_input& e)
  {
    check(false, "a map is found", e.what(), __FILE__, __LINE__);
    return m;
  }
  m.shape = make_shape(output);
  RCO_CHECK(same_bits(source_before, make_shape(source)));
  RCO_CHECK(same_bits(reference_before, make_shape(reference)));
  RCO_CHECK(same_connectivity(source_before, m.shape));
  // isolated vertices are not valid to CGAL
  RCO_CHECK_EQUAL(is_valid_polygon_mesh(output), is_valid_polygon_mesh(source));
  for(const auto& l : pair.landmarks)
    RCO_CHECK(same_bits(m.shape.points[l.first], pair.reference.points[l.second]));
  const Indexed_mesh indices = indexed(pair.source), other = indexed(pair.reference);
  for(std::size_t v = 0; v < m.shape.points.size(); ++v)
    if(indices.vertex_begin[v] == indices.vertex_begin[v + 1])
      RCO_CHECK(same_bits(m.shape.points[v], pair.source.points[v]));
    else if(indices.is_border_vertex[v])
      RCO_CHECK_LESS_EQUAL(distance_to_border(pair.reference, other, m.shape.points[v]), 1e-12);
  RCO_CHECK(RCO::distance_to_reference(output, reference).is_on_reference());

  const RCO::Initial_mesh_report& r = m.report;
  RCO_CHECK(0 < r.number_of_bijective_maps && r.number_of_bijective_maps <= r.number_of_trees);
  RCO_CHECK(r.number_of_trees <= 6);
  // a tree on all landmarks and borders
  std::size_t number_of_edges = 0;
  for(const auto& l : pair.landmarks)
    number_of_edges += !indices.is_border_vertex[l.first];
  std::vector<Mesh::Halfedge_index> borders;
  CGAL::Polygon_mesh_processing::extract_boundary_cycles(output, std::back_inserter(borders));
  RCO_CHECK_EQUAL(r.landmark_tree.size(),
                  number_of_edges + r.added_landmarks.size() + borders.size() - 1);
  RCO_CHECK(r.capped_energy >= 4 - 1e-9);
  if(pair.source.faces.front().size() == 3)
  {
    const double scale = std::sqrt(area(pair.reference) / area(pair.source));
    double sum = 0;
    for(const std::vector<int>& t : pair.source.faces)
      sum += (std::min)(100., dirichlet(pair.source, m.shape, t, scale));
    RCO_CHECK_NEAR(r.capped_energy, sum / double(pair.source.faces.size()), 1e-6 * r.capped_energy);
  }
  return m;
}

void test_closed_maps()
{
  const Shape from = icosphere(3), to = meridian_sphere(36, 20);
  for(const int n : {3, 4, 8})
  {
    const Scope scope(std::to_string(n) + " landmarks");
    Pair pair = sphere_pair(from, bumpy, to, bent_ellipsoidal, n);
    const Mapped plain = mapped(pair, "spheres, " + std::to_string(n) + " landmarks");
    RCO_CHECK(volume(plain.shape) > 0.8 * volume(pair.reference));
    RCO_CHECK(same_bits(plain.shape, mapped(pair, "the same spheres").shape));
    RCO_CHECK_LESS(plain.report.capped_energy, 20.);
    // the reference turned inside out: no other mesh comes of it
    pair.reference = turned_round(pair.reference);
    const Mapped other = mapped(pair, "spheres of opposite orientations");
    RCO_CHECK(volume(other.shape) > 0);
    RCO_CHECK_NEAR(other.report.capped_energy, plain.report.capped_energy,
                   0.05 * plain.report.capped_energy);
    // a vertex without faces, in the midst of the others
    pair.reference = turned_round(pair.reference);
    pair.source.points.insert(pair.source.points.begin() + 3, Vector_3(7, 8, 9));
    for(std::vector<int>& f : pair.source.faces)
      for(int& v : f)
        v += v >= 3;
    for(auto& l : pair.landmarks)
      l.first += l.first >= 3;
    mapped(pair, "spheres, an isolated vertex");
    mapped<Polyhedron>(sphere_pair(from, bumpy, to, bumpy, n), "spheres of two types", 5);
  }
  {
    const Scope scope("onto itself");
    Pair pair = sphere_pair(from, bumpy, from, bumpy, 6);
    const Mapped same = mapped(pair, "a sphere onto itself");
    RCO_CHECK_NEAR(same.report.capped_energy, 4., 1e-4);
    double furthest = 0;
    for(std::size_t v = 0; v < same.shape.points.size(); ++v)
      furthest = (std::max)(furthest, (same.shape.points[v] - pair.source.points[v]).norm());
    RCO_CHECK_LESS(furthest, 1e-6);
  }
}

// Limbs without a landmark are found on both surfaces and paired, and reported if there is only one.
void test_extremities()
{
  const std::vector<Vector_3> limbs = {Vector_3(1, 0, 0), Vector_3(-0.6, 0.8, 0),
                                       Vector_3(-0.7, -0.5, 0.5).normalized()};
  const auto with_limbs = [&](const Shape& sphere, int number, double length) {
    return deformed(sphere, [&](const Vector_3& p) {
      double factor = 1;
      for(int i = 0; i < number; ++i)
        factor += length * std::exp(-25 * (p.normalized() - limbs[i]).squaredNorm());
      return Vector_3(factor * p);
    });
  };
  const Shape from = icosphere(5), to = meridian_sphere(100, 60);
  Shape shape;
  const auto map = [&](int number_on_reference) {
    Pair pair = {with_limbs(from, 3, 3), with_limbs(to, number_on_reference, 2.5), {}};
    for(const Vector_3& p : {Vector_3(0, 0, 1), Vector_3(0, 0, -1), Vector_3(0, -1, 0),
                             Vector_3(0.5, 0.8, 0.3).normalized()})
      pair.landmarks.emplace_back(nearest(from, p), nearest(to, p));
    const Mesh source = mesh_of(pair.source), reference = mesh_of(pair.reference);
    Mesh output;
    const RCO::Initial_mesh_report report =
      RCO::compatible_initial_mesh(source, reference, descriptors(source, reference, pair), output);
    shape = make_shape(output);
    for(const std::pair<int, int>& added : report.added_landmarks)
    {
      RCO_CHECK_LESS((from.points[added.first] - to.points[added.second]).norm(), 0.2);
      RCO_CHECK(same_bits(shape.points[added.first], pair.reference.points[added.second]));
    }
    RCO_CHECK(report.unpaired_in_reference.empty());
    return report;
  };
  const RCO::Initial_mesh_report all = map(3);
  RCO_CHECK_EQUAL(all.added_landmarks.size(), 3u);
  RCO_CHECK(all.unpaired_in_source.empty());
  RCO_CHECK_LESS(all.capped_energy, 8.);

  const RCO::Initial_mesh_report two = map(2);
  RCO_CHECK_EQUAL(two.unpaired_in_source.size(), 1u);
  for(const int v : two.unpaired_in_source)
    RCO_CHECK_LESS((from.points[v] - limbs[2]).norm(), 0.2);
  // it takes some room on the reference all the same
  double area_of_limb = 0;
  for(const std::vector<int>& f : shape.faces)
    if((from.points[f[0]] - limbs[2]).norm() < 0.3)
      area_of_limb += vector_area(shape, f).norm();
  RCO_CHECK_LESS(0.001 * area(shape), area_of_limb);
  const Pair long_limb{closed_cylinder(10, 120, 0.1, 12), icosphere(3), {{0, 0}, {3, 3}, {6, 6}}};
  RCO_CHECK_EQUAL(mapped(long_limb, "a long limb onto a ball").report.unpaired_in_source.size(),
                  1u);
}

void test_disk_maps()
{
  const std::vector<Vector_2> corners = {Vector_2(0, 0), Vector_2(1, 0), Vector_2(1, 1),
                                         Vector_2(0, 1)};
  const std::vector<Vector_2> inner = {Vector_2(0.3, 0.3), Vector_2(0.7, 0.4), Vector_2(0.5, 0.75)};
  std::vector<Vector_2> points = corners;
  const Mapped plain = mapped(square_pair(points), "squares by their corners");
  RCO_CHECK_LESS(plain.report.capped_energy, 6.);
  points.insert(points.end(), inner.begin(), inner.end());
  mapped(square_pair(points), "squares by corners and inner vertices");
  points = inner;
  points.insert(points.begin() + 1, corners[0]);
  mapped(square_pair(points), "squares by one corner and inner vertices");
  points.push_back(Vector_2(1, 0.6));
  mapped(square_pair(points), "squares by two vertices of the border and inner ones");
  mapped(square_pair(inner), "squares by inner vertices");

  Pair pair = square_pair(corners);
  pair.source = deformed(square(20, 18, true), arched); // same vertices
  mapped(pair, "a square of quads");
  pair = square_pair(corners);
  pair.reference = pair.source;
  for(auto& l : pair.landmarks)
    l.second = l.first;
  RCO_CHECK_NEAR(mapped(pair, "a square onto itself").report.capped_energy, 4., 1e-4);
}

// meshes on which paths have no room
void test_coarse_maps()
{
  const Shape small[] = {tetrahedron(), octahedron(), icosphere(0)};
  for(const Shape& a : small)
    for(const bool all : {false, true})
    {
      const Scope scope(std::to_string(a.points.size()) + (all ? " landmarks" : " vertices"));
      Pair pair{a, a, {}};
      const int n = all ? int(a.points.size()) : 3;
      for(int i = 0; i < n; ++i)
      {
        // the three of the first face, which are neighbours
        const int v = all ? i : a.faces[0][i];
        pair.landmarks.push_back({v, v});
      }
      const Mapped m = mapped(pair, "a coarse mesh onto itself");
      RCO_CHECK_NEAR(m.report.capped_energy, 4., 1e-4);
      pair.reference = deformed(a, bent_ellipsoidal);
      mapped(pair, "a coarse mesh onto a bent one");
    }
  // neighbours on a coarse mesh that are far apart on the other, and the other way round
  const Shape coarse = octahedron(), fine = icosphere(3);
  Pair pair{coarse, fine, {}};
  for(int v = 0; v < 6; ++v)
    pair.landmarks.push_back({v, nearest(fine, coarse.points[v])});
  mapped(pair, "an octahedron onto a sphere");
  std::swap(pair.source, pair.reference);
  for(auto& l : pair.landmarks)
    std::swap(l.first, l.second);
  mapped(pair, "a sphere onto an octahedron");

  // a square of two triangles, and one whose vertices are all on the border
  Pair disk{square(1, 1), deformed(square(7, 5), hilly), {{0, 0}, {1, 7}, {3, 47}, {2, 40}}};
  mapped(disk, "two triangles onto a square");
  disk.source = square(5, 1);
  disk.landmarks = {{0, 0}, {5, 7}, {11, 47}, {6, 40}};
  mapped(disk, "a strip onto a square");
}

// The smoothed surface of unit cubes, without the squares that `drop(centre, normal)` names; the first vertices
// are those before it is subdivided, whatever the number of levels.
Shape smoothed_cubes(const std::vector<Vector_3>& cubes,
                     const std::function<bool(const Vector_3&, const Vector_3&)>& drop,
                     int levels)
{
  std::map<std::array<int, 3>, int> vertex_at;
  Shape shape;
  const auto vertex = [&](const Vector_3& p) {
    const std::array<int, 3> at = {int(std::lround(2 * p.x())), int(std::lround(2 * p.y())),
                                   int(std::lround(2 * p.z()))};
    const auto found = vertex_at.emplace(at, int(shape.points.size()));
    return found.second ? shape.add(p.x(), p.y(), p.z()) : found.first->second;
  };
  for(const Vector_3& cube : cubes)
    for(int axis = 0; axis < 3; ++axis)
      for(const double sign : {-1., 1.})
      {
        const Vector_3 normal = sign * Vector_3::Unit(axis), centre = cube + 0.5 * normal;
        const bool is_inside = std::any_of(cubes.begin(), cubes.end(), [&](const Vector_3& other) {
          return (other - cube - normal).norm() < 0.1;
        });
        if(is_inside || drop(centre, normal))
          continue;
        const Vector_3 u = 0.5 * Vector_3::Unit((axis + 1) % 3), v = normal.cross(u);
        shape.faces.push_back({vertex(centre - u - v), vertex(centre + u - v),
                               vertex(centre + u + v), vertex(centre - u + v)});
      }
  Mesh mesh = mesh_of(shape);
  CGAL::Subdivision_method_3::CatmullClark_subdivision(mesh, params::number_of_iterations(levels));
  return make_shape(mesh);
}

Shape in_triangles(const Shape& quads, bool second)
{
  Shape result;
  result.points = quads.points;
  for(const std::vector<int>& q : quads.faces)
    result.quad(q[0], q[1], q[2], q[3], second);
  return result;
}

// Two triangulations of a surface, one of them deformed. From a few landmarks the map is found that is also found
// from the deformation.
void test_topology(const std::string& name,
                   const std::vector<Vector_3>& cubes,
                   const std::function<bool(const Vector_3&, const Vector_3&)>& drop,
                   int number_of_landmarks)
{
  const Scope scope(name);
  const int n = int(smoothed_cubes(cubes, drop, 0).points.size());
  const auto stretched = [](const Vector_3& p) {
    return Vector_3(1.3 * p.x() + 0.1 * p.y(), p.y() + 0.04 * p.x() * p.x(), 0.8 * p.z());
  };
  const Shape fine = smoothed_cubes(cubes, drop, 3);
  Pair pair{in_triangles(smoothed_cubes(cubes, drop, 2), false),
            deformed(in_triangles(fine, true), stretched),
            {}};
  std::vector<int> chosen(1, 0); // the furthest from those before
  while(int(chosen.size()) < number_of_landmarks)
  {
    const auto distance = [&](int v) {
      double least = std::numeric_limits<double>::infinity();
      for(const int c : chosen)
        least = (std::min)(least, (fine.points[v] - fine.points[c]).norm());
      return least;
    };
    int best = 0;
    for(int v = 0; v < n; ++v)
      best = distance(v) > distance(best) ? v : best;
    chosen.push_back(best);
  }
  for(const int v : chosen)
    pair.landmarks.push_back({v, v});
  const Outcome known = optimized(pair.source, deformed(pair.source, stretched), pair.reference);
  const Outcome found = optimized(pair.source, mapped(pair, name).shape, pair.reference);
  RCO_CHECK_LESS(known.distortion.mean, 2.3);
  RCO_CHECK_LESS(found.distortion.mean, 1.02 * known.distortion.mean);
  RCO_CHECK_EQUAL(found.result.number_of_flips, 0u);
}

void test_topologies()
{
  const auto none = [](const Vector_3&, const Vector_3&) { return false; };
  const auto plate = [](int holes) {
    std::vector<Vector_3> cubes;
    for(int i = 0; i < 2 * holes + 1; ++i)
      for(int j = 0; j < 3; ++j)
        if(i % 2 == 0 || j != 1)
          cubes.emplace_back(i, j, 0);
    return cubes;
  };
  test_topology("genus 1", plate(1), none, 8);
  test_topology("genus 2", plate(2), none, 10);
  test_topology("genus 3", plate(3), none, 12);
  test_topology(
    "a disk with two holes", plate(2),
    [](const Vector_3&, const Vector_3& normal) { return normal.z() < 0.5; }, 8);
  std::vector<Vector_3> block;
  for(int i = 0; i < 27; ++i)
    block.emplace_back(i % 3, i / 3 % 3, i / 9);
  test_topology(
    "a sphere with three holes", block,
    [](const Vector_3& centre, const Vector_3&) {
      const Vector_3 d = centre - Vector_3(1, 1, 1); // the middles of three sides
      return std::abs(d.norm() - 1.5) < 0.1 && d.sum() > 0;
    },
    6);
  test_topology(
    "a handle with a border", plate(1),
    [](const Vector_3& centre, const Vector_3& normal) {
      return normal.z() > 0.5 && centre.x() < 0.5 && std::abs(centre.y() - 1) < 0.1;
    },
    8);

  // landmarks on one of two borders tell where the other one is
  Pair rings{annulus(60, 8), annulus(47, 6), {}};
  for(const double angle : {0.1, 1.5, 3.3, 5.})
  {
    const Vector_3 p(std::cos(angle), std::sin(angle), 0);
    rings.landmarks.push_back({nearest(rings.source, p), nearest(rings.reference, p)});
  }
  RCO_CHECK_LESS(
    optimized(rings.source, mapped(rings, "a ring").shape, rings.reference).distortion.mean, 2.03);
}

// Random landmarks, few vertices: `random_point(k)` is where the k-th shall be.
template <typename Random_point>
void add_landmarks(
  Pair& pair, const Shape& from, const Shape& to, int number, const Random_point& random_point)
{
  std::set<int> used[2];
  while(int(pair.landmarks.size()) < number)
  {
    const Vector_3 p = random_point(int(pair.landmarks.size()));
    const int a = nearest(from, p), b = nearest(to, p);
    if(used[0].count(a) || used[1].count(b))
      continue;
    used[0].insert(a);
    used[1].insert(b);
    pair.landmarks.push_back({a, b});
  }
}

void test_random_maps()
{
  Random random(7);
  const Shape coarse = icosphere(1), other = meridian_sphere(9, 7);
  for(int k = 0; k < 30; ++k)
  {
    const bool swap = k % 2 == 1;
    const Shape &from = swap ? other : coarse, &to = swap ? coarse : other;
    Pair pair{deformed(from, bumpy), deformed(to, ellipsoidal), {}};
    add_landmarks(pair, from, to, 3 + random.index(8), [&](int) { return random.in_cube(1); });
    mapped(pair, "coarse spheres, random landmarks, " + std::to_string(k), k);
  }
}

// the same for squares, with any number of landmarks on the border
void test_random_disk_maps()
{
  Random random(8);
  const Shape a = square(6, 5), b = square(7, 8);
  for(int k = 0; k < 30; ++k)
  {
    Pair pair{deformed(a, arched), deformed(b, hilly), {}};
    const int n = 3 + random.index(6), on_border = random.index(n + 1);
    add_landmarks(pair, a, b, n, [&](int i) {
      Vector_3 p(random(0.25, 0.75), random(0.25, 0.75), 0);
      if(i < on_border)
        p(random.index(2)) = random() < 0.5 ? 0 : 1;
      return p;
    });
    mapped(pair, "coarse squares, random landmarks, " + std::to_string(k), k);
  }
}

// meshes with faces of no area are mapped all the same
void test_degenerate_maps()
{
  for(const bool bad_source : {true, false})
  {
    const Scope scope(bad_source ? "degenerate source" : "degenerate reference");
    Pair pair = sphere_pair(icosphere(3), ellipsoidal, meridian_sphere(36, 20), ellipsoidal, 4);
    Shape& bad = bad_source ? pair.source : pair.reference;
    bad = collapsed(bad, {100, 250, 400, 600});
    const Mesh source = mesh_of(pair.source), reference = mesh_of(pair.reference);
    Mesh output;
    const RCO::Initial_mesh_report report =
      RCO::compatible_initial_mesh(source, reference, descriptors(source, reference, pair), output);
    RCO_CHECK(report.number_of_bijective_maps > 0);
    RCO_CHECK(std::isfinite(report.capped_energy));
    RCO_CHECK(RCO::distance_to_reference(output, reference).is_on_reference());
    RCO_CHECK(same_connectivity(pair.source, make_shape(output)));
  }
}

void test_map_parameters()
{
  const Pair pair = sphere_pair(icosphere(2), bumpy, meridian_sphere(20, 12), ellipsoidal, 7);
  const Mesh source = mesh_of(pair.source), reference = mesh_of(pair.reference);
  const auto landmarks = descriptors(source, reference, pair);
  double previous = std::numeric_limits<double>::infinity();
  Shape six;
  for(const unsigned int n : {1u, 3u, 6u, 12u})
  {
    Mesh output;
    const RCO::Initial_mesh_report report = RCO::compatible_initial_mesh(
      source, reference, landmarks, output, params::number_of_iterations(n));
    RCO_CHECK(report.number_of_trees <= n);
    if(n == 1)
      RCO_CHECK_EQUAL(report.number_of_trees, 1u);
    // the first trees are the same
    RCO_CHECK_LESS_EQUAL(report.capped_energy, previous);
    previous = report.capped_energy;
    if(n == 6)
      six = make_shape(output);
  }
  Mesh output;
  RCO_CHECK_THROWS(RCO::compatible_initial_mesh(source, reference, landmarks, output,
                                                params::number_of_iterations(0u)),
                   RCO::Invalid_input, "at least one tree");

  // points in other maps
  Mesh moved[2] = {source, reference};
  Mesh::Property_map<Mesh::Vertex_index, Mesh::Point> maps[3];
  for(int i = 0; i < 2; ++i)
  {
    maps[i] = moved[i].add_property_map<Mesh::Vertex_index, Mesh::Point>("v:other").first;
    for(const auto v : moved[i].vertices())
      std::swap(maps[i][v], moved[i].point(v));
  }
  maps[2] = output.add_property_map<Mesh::Vertex_index, Mesh::Point>("v:other").first;
  RCO::compatible_initial_mesh(moved[0], moved[1], landmarks, output,
                               params::vertex_point_map(maps[0]), params::vertex_point_map(maps[1]),
                               params::vertex_point_map(maps[2]));
  for(const auto v : output.vertices())
  {
    const Mesh::Point& p = maps[2][v];
    RCO_CHECK(same_bits(Vector_3(p.x(), p.y(), p.z()), six.points[std::size_t(v)]));
  }
}

void test_map_errors()
{
  const auto refuses = [](const Pair& pair, const std::string& text,
                          std::pair<int, int> stranger = {-1, -1}) {
    const Scope s(text);
    const Mesh source = mesh_of(pair.source), reference = mesh_of(pair.reference);
    auto landmarks = descriptors(source, reference, pair);
    if(stranger.first >= 0)
      landmarks[1] = {Mesh::Vertex_index(stranger.first), Mesh::Vertex_index(stranger.second)};
    Mesh output = mesh_of(octahedron());
    const Shape before = make_shape(output);
    RCO_CHECK_THROWS(RCO::compatible_initial_mesh(source, reference, landmarks, output),
                     RCO::Invalid_input, text);
    RCO_CHECK(same_bits(before, make_shape(output)));
  };
  const Shape ball = icosphere(1), other = meridian_sphere(8, 6);
  const Pair good = sphere_pair(ball, bumpy, other, ellipsoidal, 5);
  Pair pair = good;
  pair.landmarks.resize(2);
  refuses(pair, "at least three");
  pair.landmarks.clear();
  refuses(pair, "at least three");
  pair = good;
  pair.landmarks[3].first = pair.landmarks[1].first;
  refuses(pair, "of the source is in two pairs, 1 and 3");
  pair = good;
  pair.landmarks[4].second = pair.landmarks[0].second;
  refuses(pair, "of the reference is in two pairs, 0 and 4");
  refuses(good, "pair 1 names a vertex that the source", {1000, 3});
  refuses(good, "pair 1 names a vertex that the reference", {3, 1000});
  refuses(good, "pair 1 names a vertex that the source",
          {int(std::uint32_t(Mesh::null_vertex()) & 0x7fffffffu), 3});
  pair = good;
  pair.source.add(0, 0, 0);
  pair.landmarks[2].first = int(ball.points.size());
  refuses(pair, "(pair 2) has no face");
  pair = good;
  pair.reference.add(0, 0, 0);
  pair.landmarks[2].second = int(other.points.size());
  refuses(pair, "(pair 2) has no face");

  const Pair by_index{torus(12, 8), torus(12, 8), {{0, 0}, {30, 30}, {60, 60}, {80, 80}}};
  pair = by_index;
  pair.source = meridian_sphere(20, 12);
  refuses(pair, "the source has genus 0 and 0 borders, the reference has genus 1 and 0 borders");
  pair.reference = annulus(30, 4);
  refuses(pair, "the reference has genus 0 and 2 borders");
  pair.reference = joined(icosphere(1), icosphere(1), Vector_3(3, 0, 0));
  refuses(pair, "reference: has 2 connected components");
  std::swap(pair.source, pair.reference);
  refuses(pair, "source: has 2 connected components");

  const auto at = [](int i, int j) { return 9 * j + i; };
  const Shape grid = deformed(square(8, 8), hilly);
  pair = Pair{grid, grid, {{at(0, 0), at(0, 0)}, {at(8, 0), at(8, 0)}, {at(4, 8), at(4, 7)}}};
  refuses(pair, "of pair 2 only one vertex is on the border");
  std::swap(pair.landmarks[2].first, pair.landmarks[2].second);
  refuses(pair, "of pair 2 only one vertex is on the border");
  pair.landmarks = {
    {at(0, 0), at(0, 0)}, {at(8, 0), at(0, 8)}, {at(8, 8), at(8, 8)}, {at(0, 8), at(8, 0)}};
  refuses(pair, "opposite");
  // neither way round
  const int around[] = {at(0, 0), at(8, 8), at(8, 0), at(0, 8)};
  for(int i = 0; i < 4; ++i)
    pair.landmarks[i].second = around[i];
  refuses(pair, "not in the same order");

  // a long limb without a landmark, and without a vertex that could be a counterpart: too small in the plane to be
  // told from a point
  pair = Pair{closed_cylinder(10, 120, 0.1, 12), tetrahedron(), {{0, 0}, {3, 1}, {6, 2}, {41, 3}}};
  refuses(pair, "long parts, may help, as at the vertices");
}

void test_from_initial_meshes()
{
  const auto run = [](const Pair& pair, const std::string& name) {
    const Mapped start = mapped(pair, name);
    const Scope scope("optimization of " + name);
    if(start.shape.points.empty())
      return;
    const Outcome out = optimized(pair.source, start.shape, pair.reference);
    RCO_CHECK_LESS(out.result.final_energy, out.result.initial_energy);
    RCO_CHECK_LESS(out.result.number_of_flattened_patches, out.result.number_of_accepted_patches);
    const Outcome plain = optimized(pair.source, start.shape, pair.reference, false);
    RCO_CHECK_LESS(plain.result.final_energy, plain.result.initial_energy);
    RCO_CHECK_EQUAL(plain.result.number_of_flattened_patches,
                    plain.result.number_of_accepted_patches);
    RCO_CHECK_LESS(0u, plain.result.number_of_flattened_patches);
    RCO_CHECK_NEAR(plain.distortion.mean, out.distortion.mean, 0.1 * out.distortion.mean);
  };
  run(sphere_pair(icosphere(3), twisted_ellipsoidal, meridian_sphere(48, 30), bent_ellipsoidal, 8),
      "two ellipsoids");
  run(sphere_pair(meridian_sphere(30, 20), bumpy, icosphere(4), ellipsoidal, 4),
      "a blob and an ellipsoid");
  run(square_pair({Vector_2(0, 0), Vector_2(1, 0), Vector_2(1, 1), Vector_2(0, 1)}), "two squares");
}

// returns the largest distortion at the end
double check_hard_start(const std::string& name,
                        const Shape& source,
                        const Shape& start,
                        const Shape& reference)
{
  const Scope scope("hard start: " + name);
  const internal::Reference_surface surface = surface_of(reference);
  const Outcome out = optimized(source, start, reference);
  RCO_CHECK_LESS_EQUAL(capped_energy(source, out.after, surface, 100),
                       capped_energy(source, start, surface, 100));
  return out.distortion.maximum;
}

void test_hard_starts()
{
  for(const bool has_border : {false, true})
    for(const int seed : {1, 2})
    {
      const Deformation f = has_border ? Deformation(hilly) : Deformation(bumpy);
      const Shape base = has_border ? square(24, 24) : icosphere(3);
      const Shape fine = has_border ? square(40, 40) : icosphere(4);
      const Shape source = deformed(base, f), reference = deformed(fine, f);
      const Indexed_mesh mesh = indexed(source);
      // onto R, then some onto vertices of it that are up to two edges away
      const internal::Reference_surface surface = surface_of(reference);
      Shape start = source;
      Random random(seed);
      const double edge = internal::mean_edge_length(mesh, source.points);
      for(std::size_t v = 0; v < start.points.size(); ++v)
      {
        if(mesh.is_border_vertex[v])
          continue;
        start.points[v] = surface.closest(start.points[v]).position;
        if(random() > 0.05)
          continue;
        std::vector<int> near;
        for(std::size_t w = 0; w < reference.points.size(); ++w)
          if((reference.points[w] - source.points[v]).norm() < 2 * edge)
            near.push_back(int(w));
        start.points[v] = reference.points[near[random.index(int(near.size()))]];
      }
      check_hard_start(std::string(has_border ? "a square" : "a sphere") +
                         " with vertices on others, seed " + std::to_string(seed),
                       source, start, reference);
    }
  {
    // one vertex is moved, in its face, to 1e-4 of that face's height
    const Shape source = deformed(icosphere(3), bumpy);
    Shape start = source;
    const std::vector<int>& t = source.faces[200];
    Vector_3& p = start.points[t[0]];
    p = 0.5 * (start.points[t[1]] + start.points[t[2]]) * (1 - 1e-4) + 1e-4 * p;
    RCO_CHECK_LESS(0.9e8, dirichlet(source, start, t, 1));
    RCO_CHECK_LESS(check_hard_start("a face of distortion 1e8", source, start, source), 3.);
  }
}

// Two quads of an octahedron that have two vertices in common: the shorter diagonal of both joins these,
// and there is an edge twice in the triangles that they are split into.
void test_shared_diagonals()
{
  Shape shape = scaled(octahedron(), 1, 1, 0.5);
  shape.faces = {{0, 2, 4}, {0, 5, 2}, {0, 4, 3, 5}, {1, 4, 2, 5}, {1, 3, 4}, {1, 5, 3}};
  Shape skewed = shape;
  skewed.points[0] += Vector_3(0.2, 0.1, 0.05);
  skewed.points[4] += Vector_3(0.1, -0.2, 0.1);
  for(const bool on_surface : {true, false})
    for(const bool is_own : {true, false})
    {
      const Scope scope(std::string(on_surface ? "on the surface" : "flattened") +
                        (is_own ? ", its own reference" : ""));
      Mesh mesh = mesh_of(skewed);
      const Mesh reference = mesh_of(shape);
      const Energy energy(reference);
      const RCO::Result r = CGAL::reference_constrained_optimize(
        mesh, is_own ? mesh : reference, energy, params::use_on_surface_steps(on_surface));
      check_progress(r);
    }
}

int main()
{
  run_test("the energy", test_energy);
  run_test("the energy of quads", test_energy_of_quads);
  run_test("sources that do not match", test_energy_mismatches);
  run_test("closed maps", test_closed_maps);
  run_test("extremities", test_extremities);
  run_test("disk maps", test_disk_maps);
  run_test("topologies", test_topologies);
  run_test("coarse maps", test_coarse_maps);
  run_test("random maps", test_random_maps);
  run_test("random disk maps", test_random_disk_maps);
  run_test("maps of degenerate meshes", test_degenerate_maps);
  run_test("parameters of maps", test_map_parameters);
  run_test("errors of maps", test_map_errors);
  run_test("optimization of maps", test_from_initial_meshes);
  run_test("hard starts", test_hard_starts);
  run_test("known optima", test_known_optima);
  run_test("shared diagonals", test_shared_diagonals);
  return report();
}
