// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Several data structures, kernels and number types, units and places, parts of a mesh, and where its
// vertices are on R.

#include "deformations.h"
#include "optimization.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Linear_cell_complex_for_bgl_combinatorial_map_helper.h>
#include <CGAL/Polygon_mesh_processing/locate.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/boost/graph/graph_traits_Linear_cell_complex_for_combinatorial_map.h>

#include <limits>
#include <list>

namespace PMP = CGAL::Polygon_mesh_processing;
using namespace rco_test;

typedef boost::graph_traits<Mesh>::face_descriptor Face;

// gives the same as a Surface_mesh does, to the last bit of the mesh's number type
template <typename M>
void test_model(const std::string& name, double unit_in_last_place)
{
  const Scope scope(name);
  const Shape regular = torus(24, 12), rough = scrambled(regular, 0.3, 4, onto_torus(1, 0.4));
  // the number type rounds what goes in: compare with what the mesh holds
  M mesh = make_mesh<M>(rough), reference = make_mesh<M>(regular);
  Mesh expected = mesh_of(make_shape(mesh));
  const Mesh expected_reference = mesh_of(make_shape(reference));
  const RCO::Result r = improve_angles(mesh, reference);
  const RCO::Result e = improve_angles(expected, expected_reference);
  RCO_CHECK_EQUAL(r.final_energy, e.final_energy);
  RCO_CHECK_LESS(r.final_energy, r.initial_energy);
  const Shape a = make_shape(mesh), b = make_shape(expected);
  RCO_CHECK(a.faces == b.faces);
  for(std::size_t v = 0; v < a.points.size(); ++v)
    for(int i = 0; i < 3; ++i)
      RCO_CHECK_LESS_EQUAL(std::abs(a.points[v](i) - b.points[v](i)),
                           unit_in_last_place * std::abs(b.points[v](i)));
  // its own reference
  M own = make_mesh<M>(regular);
  RCO_CHECK(improve_angles(own, own).number_of_free_vertices > 0);
  // mesh and reference of two types
  Mesh mixed = mesh_of(rough);
  RCO_CHECK_LESS(improve_angles(mixed, reference).final_energy, r.initial_energy);
  // part of it
  M part = make_mesh<M>(rough);
  std::vector<typename boost::graph_traits<M>::face_descriptor> range;
  for(const auto f : faces(part))
    if(range.size() < 200)
      range.push_back(f);
  const RCO::Result p =
    CGAL::reference_constrained_optimize(range, part, reference, RCO::Minimum_angle_energy());
  RCO_CHECK_LESS(0u, p.number_of_free_vertices);
  RCO_CHECK_LESS(p.number_of_free_vertices, r.number_of_free_vertices);
  RCO_CHECK_LESS(p.final_energy, p.initial_energy);
}

void test_models()
{
  typedef CGAL::Exact_predicates_inexact_constructions_kernel Epick;
  typedef CGAL::Exact_predicates_exact_constructions_kernel Epeck;
  typedef CGAL::Linear_cell_complex_traits<3, Epick> Traits;
  typedef CGAL::Linear_cell_complex_for_bgl_combinatorial_map_helper<2, 3, Traits>::type Cells;
  const double ulp = std::numeric_limits<float>::epsilon();
  test_model<Mesh>("Surface_mesh, double", 0);
  test_model<CGAL::Surface_mesh<Epick::Point_3>>("Surface_mesh, Epick", 0);
  test_model<CGAL::Polyhedron_3<Epick>>("Polyhedron_3, Epick", 0);
  test_model<Cells>("Linear_cell_complex, Epick", 0);
  test_model<CGAL::Surface_mesh<CGAL::Simple_cartesian<float>::Point_3>>("Surface_mesh, float",
                                                                         ulp);
  test_model<CGAL::Surface_mesh<Epeck::Point_3>>("Surface_mesh, Epeck", 0);
}

template <typename R>
void check_locations(Mesh mesh, const R& reference, bool relaxes)
{
  typedef typename boost::graph_traits<R>::face_descriptor Reference_face;
  typedef std::pair<Reference_face, std::array<double, 3>> Location;
  auto location = mesh.add_property_map<Mesh::Vertex_index, Location>("v:location").first;
  improve_angles(mesh, reference, params::vertex_location_map(location).relax_constraints(relaxes));
  const Shape shape = make_shape(reference);
  const double diagonal = internal::bounding_box_diagonal(indexed(shape), shape.points);
  for(const Mesh::Vertex_index v : mesh.vertices())
  {
    const Location& l = location[v];
    RCO_CHECK_NEAR(l.second[0] + l.second[1] + l.second[2], 1., 1e-14);
    for(const double w : l.second)
    {
      RCO_CHECK_LESS_EQUAL(0., w);
      RCO_CHECK_LESS_EQUAL(w, 1.);
    }
    const auto p = PMP::construct_point(l, reference);
    RCO_CHECK_LESS_EQUAL(std::sqrt(CGAL::to_double(CGAL::squared_distance(p, mesh.point(v)))),
                         1e-12 * diagonal);
  }
}

void test_locations()
{
  const Shape regular = torus(30, 14), rough = scrambled(regular, 0.3, 4, onto_torus(1, 0.4));
  check_locations(mesh_of(rough), mesh_of(regular), false);
  check_locations(mesh_of(rough), make_mesh<CGAL::Polyhedron_3<Kernel>>(regular), false);
  // on what is the reference already, far from the origin, with a border
  const Mesh moved = mesh_of(shifted(cylinder(20, 14, 1, 3), Vector_3(1e3, -2e3, 5e2)));
  check_locations(moved, moved, true);
  const Shape plane = plane_grid(9, 7);
  check_locations(mesh_of(scrambled(plane, 0.4, 9, onto_plane)), mesh_of(plane), true);
}

// optimizes the faces that `is_in` names, and checks what holds for any of them
template <typename Tag, typename NamedParameters, typename IsIn>
RCO::Result
optimize_part(Mesh& mesh, const Mesh& reference, const NamedParameters& np, const IsIn& is_in)
{
  std::list<Face> range; // any range will do
  std::vector<char> may_move(mesh.number_of_vertices(), 1);
  for(const Face f : mesh.faces())
    if(is_in(std::size_t(f)))
      range.push_back(f);
    else
      for(const auto v : CGAL::vertices_around_face(halfedge(f, mesh), mesh))
        may_move[v] = 0;
  range.insert(range.end(), range.begin(), range.end());
  const Shape before = make_shape(mesh);
  const RCO::Result r = CGAL::reference_constrained_optimize<Tag>(range, mesh, reference,
                                                                  RCO::Minimum_angle_energy(), np);
  const Shape after = make_shape(mesh);
  check_vertices(before, after, may_move);
  if(r.number_of_free_vertices > 0)
    RCO_CHECK(!same_bits(before, after));
  RCO_CHECK_LESS_EQUAL(r.number_of_flips, r.initial_number_of_flips);
  RCO_CHECK_LESS_EQUAL(r.number_of_fold_edges, r.initial_number_of_fold_edges);
  return r;
}

void test_ranges()
{
  typedef CGAL::Sequential_tag Tag;
  const auto none = params::default_values();
  const Shape regular = torus(40, 20), rough = scrambled(regular, 0.3, 4, onto_torus(1, 0.4));
  const Mesh reference = mesh_of(regular), start = mesh_of(rough);
  const std::size_t n = rough.faces.size();
  Mesh whole = start, mesh = start;
  const RCO::Result all = improve_angles(whole, reference);
  {
    const Scope s("all faces are the whole mesh");
    const RCO::Result r = CGAL::reference_constrained_optimize(
      faces(mesh), mesh, reference, RCO::Minimum_angle_energy(), params::random_seed(0),
      params::default_values());
    RCO_CHECK(same_bits(make_shape(mesh), make_shape(whole)));
    RCO_CHECK_EQUAL(r.final_energy, all.final_energy);
    RCO_CHECK_EQUAL(r.drift, all.drift);
  }
  {
    const Scope s("half of them");
    mesh = start;
    const auto is_in = [&](std::size_t f) { return f < n / 2; };
    const RCO::Result r = optimize_part<Tag>(mesh, reference, none, is_in);
    RCO_CHECK_LESS(r.final_energy, r.initial_energy);
    // what the energy is of: these faces
    double sum = 0;
    const Shape after = make_shape(mesh);
    for(std::size_t f = 0; f < n / 2; ++f)
    {
      const std::vector<int>& t = after.faces[f];
      const Vector_3 &a = after.points[t[0]], &b = after.points[t[1]], &c = after.points[t[2]];
      const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
      sum += std::exp(squares / (std::sqrt(3.) * vector_area(after, t).norm()));
    }
    RCO_CHECK_NEAR(r.final_energy, sum / double(n / 2), 1e-9 * r.final_energy);
    // as good as where the whole mesh is optimized, but for what its fixed surroundings cost
    RCO_CHECK_LESS(r.final_energy, 0.5 * (all.initial_energy + all.final_energy));
    Mesh flattened = start;
    const RCO::Result f =
      optimize_part<Tag>(flattened, reference, params::use_on_surface_steps(false), is_in);
    RCO_CHECK_LESS(f.final_energy, f.initial_energy);
#ifdef CGAL_LINKED_WITH_TBB
    Mesh parallel = start;
    optimize_part<CGAL::Parallel_tag>(parallel, reference, none, is_in);
    RCO_CHECK(same_bits(make_shape(parallel), make_shape(mesh)));
#endif
  }
  {
    const Scope s("every other column, and faces that touch at a vertex");
    mesh = start;
    optimize_part<Tag>(mesh, reference, none, [](std::size_t f) { return (f / 2) % 40 % 8 < 4; });
    mesh = start;
    optimize_part<Tag>(mesh, reference, none, [](std::size_t f) {
      return ((f / 2) % 40 < 10 && f / 80 < 10) || ((f / 2) % 40 >= 10 && f / 80 >= 10);
    });
  }
  {
    const Scope s("nothing to do");
    for(const std::size_t number : {std::size_t(0), std::size_t(1)})
    {
      mesh = start;
      const RCO::Result r =
        optimize_part<Tag>(mesh, reference, none, [&](std::size_t f) { return f < number; });
      RCO_CHECK(r.status == RCO::Status::nothing_to_do);
      RCO_CHECK(std::isfinite(r.final_energy));
      RCO_CHECK(same_bits(make_shape(mesh), rough));
    }
  }
  {
    const Scope s("nothing is required of the faces outside");
    // two components: one on the reference, one far away, and with a quad
    Shape two = joined(rough, torus(10, 6), Vector_3(50, 0, 0));
    two.faces.push_back(
      {two.add(70, 0, 0), two.add(71, 0, 0), two.add(71, 1, 0), two.add(70, 1, 0)});
    mesh = mesh_of(two);
    RCO_CHECK_THROWS(improve_angles(mesh, reference), RCO::Invalid_input, "has 4 vertices");
    const RCO::Result r =
      optimize_part<Tag>(mesh, reference, none, [&](std::size_t f) { return f < n; });
    RCO_CHECK_NEAR(r.final_energy, all.final_energy, 0.01 * all.final_energy);
    RCO_CHECK_NEAR(r.drift_bound, all.drift_bound, 1e-9);
    RCO_CHECK_LESS(r.initial_drift, 0.2);
  }
  {
    const Scope s("lines slide inside the range only");
    const Shape plane = plane_grid(16, 16);
    const Mesh flat = mesh_of(plane);
    mesh = mesh_of(scrambled(plane, 0.4, 9, onto_plane));
    optimize_part<Tag>(mesh, flat, params::relax_constraints(true),
                       [](std::size_t f) { return f < 256; });
  }
  {
    const Scope s("a face that is none");
    mesh = start;
    RCO_CHECK_THROWS(CGAL::reference_constrained_optimize(std::vector<Face>(1, Mesh::null_face()),
                                                          mesh, reference,
                                                          RCO::Minimum_angle_energy()),
                     RCO::Invalid_input, "faces: the range");
    RCO_CHECK(same_bits(make_shape(mesh), rough));
  }
}

// triangles and quads side by side, with an energy that is defined on both
void test_mixed_faces()
{
  const Shape quads = torus(30, 14, 1, 0.4, true), triangles = torus(30, 14);
  Shape mixed = quads;
  mixed.faces.clear();
  for(std::size_t f = 0; f < quads.faces.size(); ++f)
    if(f % 30 < 15)
      mixed.faces.push_back(quads.faces[f]);
    else
      for(const std::size_t t : {2 * f, 2 * f + 1})
        mixed.faces.push_back(triangles.faces[t]);
  const Mesh source = mesh_of(mixed), reference = mesh_of(triangles);
  for(const bool on_surface : {true, false})
  {
    Mesh mesh = mesh_of(scrambled(mixed, 0.2, 4, onto_torus(1, 0.4)));
    const Shape start = make_shape(mesh);
    const RCO::Result r = CGAL::reference_constrained_optimize(
      mesh, reference, RCO::Compatible_remeshing_energy(source),
      params::use_on_surface_steps(on_surface).drift_bound(0.05));
    RCO_CHECK_LESS(r.final_energy - 4, 0.5 * (r.initial_energy - 4));
    check_result(start, mesh, reference, r);
  }
}

struct Place
{
  double factor = 1;
  Vector_3 shift = Vector_3::Zero(); // after it
  Vector_3 operator()(const Vector_3& p) const { return factor * p + shift; }
};

Mesh moved_mesh(const Shape& shape, const Place& place) { return mesh_of(deformed(shape, place)); }

// Optimizes in several units and places; `optimize(mesh, reference, factor)` is what is done. In units that
// are powers of two the results are the same, to the last bit; elsewhere they are as good.
template <typename Optimize>
void check_places(const std::string& name,
                  const Shape& shape,
                  const Shape& regular,
                  bool is_own,
                  const Optimize& optimize)
{
  const Scope scope(name);
  const auto run = [&](const Place& place, Mesh& mesh) {
    mesh = moved_mesh(shape, place);
    return is_own ? optimize(mesh, mesh, place.factor)
                  : optimize(mesh, moved_mesh(regular, place), place.factor);
  };
  Mesh first;
  const RCO::Result expected = run(Place(), first);
  const Shape a = make_shape(first);
  RCO_CHECK_LESS(0u, expected.number_of_accepted_patches);
  for(const int exponent : {-150, -20, -1, 3, 20, 180})
  {
    const double factor = std::ldexp(1., exponent);
    Mesh mesh;
    const RCO::Result r = run({factor, {0, 0, 0}}, mesh);
    RCO_CHECK_EQUAL(r.final_energy, expected.final_energy);
    RCO_CHECK_EQUAL(r.number_of_patches, expected.number_of_patches);
    RCO_CHECK_EQUAL(r.drift_bound, factor * expected.drift_bound);
    RCO_CHECK_EQUAL(r.initial_drift, factor * expected.initial_drift);
    RCO_CHECK_EQUAL(r.drift, factor * expected.drift);
    const Shape b = make_shape(mesh);
    std::size_t number_of_others = 0;
    for(std::size_t v = 0; v < a.points.size(); ++v)
      number_of_others += !same_bits(b.points[v], factor * a.points[v]);
    RCO_CHECK_EQUAL(number_of_others, 0u);
  }
  for(const Place& place :
      {Place{1e6, {0, 0, 0}}, Place{1e-6, {0, 0, 0}}, Place{0.0254, {10, -30, 0.1}},
       Place{1, {2e3, -3e3, 1e3}}, Place{1e-6, {-5e-3, 1e-3, 0}}, Place{1, {-4e6, 3e6, 0}}})
  {
    Mesh mesh;
    const RCO::Result r = run(place, mesh);
    RCO_CHECK_LESS(std::abs(r.final_energy - expected.final_energy),
                   0.05 * (expected.initial_energy - expected.final_energy));
    const Mesh start = moved_mesh(shape, place),
               reference = is_own ? start : moved_mesh(regular, place);
    const RCO::Angle_statistics before = RCO::angle_statistics(start),
                                after = RCO::angle_statistics(mesh);
    RCO_CHECK_LESS_EQUAL(RCO::orientation_defects(mesh, reference).total(),
                         RCO::orientation_defects(start, reference).total());
    RCO_CHECK_LESS_EQUAL(before.minimum, after.minimum + 1e-6);
    RCO_CHECK_LESS_EQUAL(before.mean, after.mean);
    RCO_CHECK(RCO::distance_to_reference(mesh, reference).is_on_reference());
    RCO_CHECK_LESS_EQUAL(r.drift, (std::max)(1.1 * r.drift_bound, r.initial_drift) * (1 + 1e-9));
  }
}

void test_places()
{
  const Shape regular = torus(40, 20), rough = scrambled(regular, 0.3, 4, onto_torus(1, 0.4));
  const auto angles = [](auto& mesh, const Mesh& reference, double) {
    return improve_angles(mesh, reference);
  };
  check_places("a mesh and its reference", rough, regular, false, angles);
  check_places("its own reference", rough, rough, true, angles);
  check_places("coordinates that are all on a grid, in a plane, with a border that slides",
               scrambled(plane_grid(16, 16), 0.3, 9, onto_plane), plane_grid(16, 16), false,
               [](Mesh& mesh, const Mesh& reference, double) {
                 return improve_angles(mesh, reference, params::relax_constraints(true));
               });
  check_places("a bound that is given is told as it was given", rough, rough, true,
               [](Mesh& mesh, const Mesh& reference, double factor) {
                 const RCO::Result r =
                   improve_angles(mesh, reference, params::drift_bound(0.03 * factor));
                 RCO_CHECK_EQUAL(r.drift_bound, 0.03 * factor);
                 return r;
               });
  const Mesh source = mesh_of(regular);
  check_places("rest shapes that are scaled to the reference", rough, regular, false,
               [&](Mesh& mesh, const Mesh& reference, double) {
                 return CGAL::reference_constrained_optimize(
                   mesh, reference, RCO::Compatible_remeshing_energy(source));
               });
  {
    const Scope s("distances that are told");
    Shape off = rough;
    off.points[7] += Vector_3(0, 0, 0.1);
    Mesh mesh = mesh_of(off), large = moved_mesh(off, {1e6, {0, 0, 0}});
    const double near = angles(mesh, mesh_of(regular), 1).largest_initial_distance,
                 far =
                   angles(large, moved_mesh(regular, {1e6, {0, 0, 0}}), 1).largest_initial_distance;
    RCO_CHECK(near > 0.01 && near <= 0.1 + 1e-3);
    RCO_CHECK_NEAR(far, 1e6 * near, 1e-9 * far);
    off.points[7] += Vector_3(0, 0, 10);
    mesh = moved_mesh(off, {1e6, {0, 0, 0}});
    RCO_CHECK_THROWS(angles(mesh, moved_mesh(regular, {1e6, {0, 0, 0}}), 1), RCO::Invalid_input,
                     "e+06 away");
  }
}

// The number of folds does not increase where edges are nearly folded. (Found by a fuzzer.)
void test_nearly_folded()
{
  for(const double cosine : {-0.5, -0.5001, -0.4999, -0.498, -0.4965, -0.49})
  {
    const double angle = std::acos(cosine);
    const auto fold = [=](const Vector_3& p) {
      const double x = (std::max)(p.x() - 8, 0.);
      return Vector_3(p.x() - x + x * std::cos(angle), p.y(), p.z() + x * std::sin(angle));
    };
    const Shape plane = plane_grid(16, 16, 16);
    for(const double amount : {0.1, 0.3})
      for(const bool on_surface : {true, false})
      {
        Mesh mesh = mesh_of(deformed(scrambled(plane, amount, 9, onto_plane), fold));
        const Mesh reference = mesh_of(deformed(plane, fold));
        const Shape start = make_shape(mesh);
        const RCO::Orientation_defects before = RCO::orientation_defects(mesh, reference);
        const RCO::Result r =
          improve_angles(mesh, reference, params::use_on_surface_steps(on_surface));
        check_result(start, mesh, reference, r);
        RCO_CHECK_LESS_EQUAL(defects_after(r), before.total());
        RCO_CHECK_LESS(r.final_energy, r.initial_energy);
      }
  }
}

int main()
{
  run_test("models", test_models);
  run_test("units and places", test_places);
  run_test("ridges at the limit of a fold", test_nearly_folded);
  run_test("triangles and quads", test_mixed_faces);
  run_test("locations", test_locations);
  run_test("ranges of faces", test_ranges);
  return report();
}
