// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Named parameters in all their spellings, and the refusal of what cannot be used.

#include "deformations.h"
#include "optimization.h"

#include <CGAL/Polyhedron_3.h>

#include <limits>

namespace tags = CGAL::Reference_constrained_optimization::internal_np;
using namespace rco_test;

typedef Kernel::Point_3 Point;
typedef boost::graph_traits<Mesh>::vertex_descriptor Vertex;

const double not_a_number = std::numeric_limits<double>::quiet_NaN(),
             infinity = std::numeric_limits<double>::infinity();

template <typename Tag, typename Parameters>
auto parameter(const Parameters& np, const Tag& tag)
{
  return params::get_parameter(internal::cgal_parameters(np), tag);
}

void test_chains()
{
  // every one of ours may come first ...
  RCO_CHECK_EQUAL(parameter(params::developability_threshold(0.3), tags::developability_threshold),
                  0.3);
  RCO_CHECK_EQUAL(parameter(params::energy_tolerance(0.01), tags::energy_tolerance), 0.01);
  RCO_CHECK_EQUAL(parameter(params::drift_bound(2.), tags::drift_bound), 2.);
  RCO_CHECK_EQUAL(parameter(params::use_on_surface_steps(false), tags::use_on_surface_steps),
                  false);
  RCO_CHECK_EQUAL(parameter(params::use_finishing_stage(false), tags::use_finishing_stage), false);
  RCO_CHECK_EQUAL(parameter(params::vertex_location_map(7), tags::vertex_location_map), 7);
  RCO_CHECK_EQUAL(parameter(params::maximum_patch_size(50), tags::maximum_patch_size), 50);
  // ... and each may follow, in one chain and in the reverse order, with CGAL's behind them
  const auto has_all = [](const auto& np) {
    RCO_CHECK_EQUAL(parameter(np, tags::developability_threshold), 0.3);
    RCO_CHECK_EQUAL(parameter(np, tags::energy_tolerance), 0.01);
    RCO_CHECK_EQUAL(parameter(np, tags::drift_bound), 2.);
    RCO_CHECK_EQUAL(parameter(np, tags::use_on_surface_steps), false);
    RCO_CHECK_EQUAL(parameter(np, tags::use_finishing_stage), true);
    RCO_CHECK_EQUAL(parameter(np, tags::vertex_location_map), 7);
    RCO_CHECK_EQUAL(parameter(np, tags::maximum_patch_size), 50);
    RCO_CHECK_EQUAL(parameter(np, tags::allow_creases), true);
    RCO_CHECK_EQUAL(parameter(np, CGAL::internal_np::random_seed), 9);
    RCO_CHECK_EQUAL(parameter(np, CGAL::internal_np::relax_constraints), true);
    RCO_CHECK_EQUAL(parameter(np, CGAL::internal_np::number_of_iterations), 5);
  };
  has_all(params::developability_threshold(0.3)
            .energy_tolerance(0.01)
            .drift_bound(2.)
            .use_on_surface_steps(false)
            .use_finishing_stage(true)
            .vertex_location_map(7)
            .maximum_patch_size(50)
            .allow_creases(true)
            .random_seed(9)
            .relax_constraints(true)
            .number_of_iterations(5));
  has_all(params::maximum_patch_size(50)
            .allow_creases(true)
            .vertex_location_map(7)
            .use_finishing_stage(true)
            .use_on_surface_steps(false)
            .drift_bound(2.)
            .energy_tolerance(0.01)
            .developability_threshold(0.3)
            .number_of_iterations(5)
            .relax_constraints(true)
            .random_seed(9));
  // what they mean to the loop
  const internal::Loop_parameters standard =
    internal::read_loop_parameters(internal::cgal_parameters(params::default_values()));
  const internal::Loop_parameters untouched;
  RCO_CHECK_EQUAL(standard.number_of_iterations, 100u);
  RCO_CHECK_EQUAL(standard.random_seed, 0u);
  RCO_CHECK_EQUAL(standard.selection.developability_threshold, 0.25);
  RCO_CHECK_EQUAL(standard.selection.maximum_patch_size, untouched.selection.maximum_patch_size);
  RCO_CHECK_EQUAL(standard.energy_tolerance, untouched.energy_tolerance);
  RCO_CHECK_EQUAL(standard.maximum_running_time, infinity);
  const internal::Loop_parameters read =
    internal::read_loop_parameters(internal::cgal_parameters(params::maximum_patch_size(50)
                                                               .energy_tolerance(0.01)
                                                               .developability_threshold(0.3)
                                                               .allow_creases(true)
                                                               .maximum_running_time(12.5)
                                                               .allow_self_intersections(true)
                                                               .number_of_iterations(4)
                                                               .random_seed(8)));
  RCO_CHECK_EQUAL(read.number_of_iterations, 4u);
  RCO_CHECK_EQUAL(read.random_seed, 8u);
  RCO_CHECK_EQUAL(read.selection.developability_threshold, 0.3);
  RCO_CHECK_EQUAL(read.selection.maximum_patch_size, 50);
  RCO_CHECK_EQUAL(read.energy_tolerance, 0.01);
  RCO_CHECK_EQUAL(read.maximum_running_time, 12.5);
  RCO_CHECK(read.allow_creases && read.allow_self_intersections);
  RCO_CHECK(!standard.allow_creases && !standard.allow_self_intersections);
  const internal::Loop_parameters of_cgal =
    internal::read_loop_parameters(internal::cgal_parameters(params::random_seed(3)));
  RCO_CHECK_EQUAL(of_cgal.random_seed, 3u);
}

struct Patch_sizes : RCO::Default_visitor
{
  std::size_t largest = 0, patches = 0;
  void on_patch_end(const RCO::Patch_report& r)
  {
    ++patches;
    largest = (std::max)(largest, r.number_of_faces);
  }
};

void test_calls()
{
  const Shape regular = icosphere(2), rough = scrambled(regular, 0.3, 1, onto_sphere);
  const Mesh reference = mesh_of(regular), start = mesh_of(rough);
  const RCO::Minimum_angle_energy energy;

  Mesh mesh = start;
  const RCO::Result plain = CGAL::reference_constrained_optimize(mesh, reference, energy);
  const Shape expected = make_shape(mesh);
  const auto same = [&](const Mesh& m) { return make_shape(m).points == expected.points; };
  RCO_CHECK_LESS(plain.final_energy, plain.initial_energy);

  // the default, said aloud; a single name of CGAL's; for the reference, too
  const auto gives_the_same = [&](const auto&... np) {
    mesh = start;
    CGAL::reference_constrained_optimize<CGAL::Sequential_tag>(mesh, reference, energy, np...);
    return same(mesh);
  };
  RCO_CHECK(gives_the_same(params::default_values()));
  RCO_CHECK(gives_the_same(params::random_seed(0), params::default_values()));
  RCO_CHECK(gives_the_same(
    params::developability_threshold(0.25).geom_traits(Kernel()).number_of_iterations(30),
    params::vertex_point_map(get(CGAL::vertex_point, reference))));

  // points kept elsewhere: those of the mesh itself neither matter nor change
  mesh = start;
  Mesh shifted = mesh_of(rough), shifted_reference = mesh_of(regular);
  auto points = shifted.add_property_map<Vertex, Point>("v:elsewhere").first;
  auto reference_points = shifted_reference.add_property_map<Vertex, Point>("v:elsewhere").first;
  for(const Vertex v : shifted.vertices())
  {
    points[v] = shifted.point(v);
    reference_points[v] = shifted_reference.point(v);
    shifted.point(v) = shifted_reference.point(v) = Point(1, 2, 3);
  }
  CGAL::reference_constrained_optimize(shifted, shifted_reference, energy,
                                       params::vertex_point_map(points),
                                       params::vertex_point_map(reference_points));
  for(const Vertex v : shifted.vertices())
  {
    RCO_CHECK(shifted.point(v) == Point(1, 2, 3));
    mesh.point(v) = points[v];
  }
  RCO_CHECK(same(mesh));

  // a visitor by value and by reference, small patches, few iterations
  RCO_CHECK(gives_the_same(params::visitor(Patch_sizes())));
  const auto optimized = [&](const auto& np) {
    mesh = start;
    return improve_angles(mesh, reference, np);
  };
  Patch_sizes sizes;
  const RCO::Result small =
    optimized(params::maximum_patch_size(25).number_of_iterations(2).visitor(std::ref(sizes)));
  RCO_CHECK_LESS_EQUAL(sizes.largest, 25u);
  RCO_CHECK_EQUAL(sizes.patches, small.number_of_patches);
  RCO_CHECK_LESS_EQUAL(small.number_of_iterations, 2u);
  RCO_CHECK_LESS(10., double(small.number_of_patches));
  RCO_CHECK_LESS_EQUAL(optimized(params::energy_tolerance(0.9)).number_of_iterations,
                       plain.number_of_iterations);

  // all patches flattened, or only those of trouble, of which this mesh may have none
  const RCO::Result flattened = optimized(params::use_on_surface_steps(false));
  RCO_CHECK_EQUAL(flattened.number_of_flattened_patches, flattened.number_of_accepted_patches);
  RCO_CHECK_LESS(plain.number_of_flattened_patches, plain.number_of_accepted_patches);
  RCO_CHECK_LESS(0u, flattened.number_of_flattened_patches);
  // without the last stage and without the bound it still works
  const RCO::Result bare = optimized(params::use_finishing_stage(false).drift_bound(infinity));
  RCO_CHECK_LESS(bare.final_energy, bare.initial_energy);
  // a bound of nothing holds every vertex of the reference where the mesh is
  RCO_CHECK_LESS_EQUAL(plain.final_energy, optimized(params::drift_bound(0.)).final_energy);
}

// the call throws Invalid_input with `text` in its message, and leaves every bit of the mesh alone
template <typename M, typename R, typename Energy, typename NamedParameters>
void refuses(M& mesh,
             const R& reference,
             const Energy& energy,
             const NamedParameters& np,
             const std::string& text)
{
  const Shape before = make_shape(mesh);
  RCO_CHECK_THROWS(CGAL::reference_constrained_optimize(mesh, reference, energy, np),
                   RCO::Invalid_input, text);
  RCO_CHECK(same_bits(before, make_shape(mesh)));
}

template <typename M>
void test_bad_meshes()
{
  const RCO::Minimum_angle_energy energy;
  const auto np = params::default_values();
  const Shape sphere = icosphere(1);
  const Shape rough = scrambled(sphere, 0.2, 2, onto_sphere);
  const M reference = make_mesh<M>(sphere);
  {
    const Scope scope("empty meshes");
    M mesh;
    refuses(mesh, reference, energy, np, "mesh: the mesh has no face");
    Shape isolated;
    isolated.add(1, 2, 3);
    mesh = make_mesh<M>(isolated);
    refuses(mesh, reference, energy, np, "mesh: the mesh has no face");
    mesh = make_mesh<M>(rough);
    refuses(mesh, M(), energy, np, "reference: the mesh has no face");
  }
  for(const double value : {not_a_number, infinity, -infinity})
    for(const int coordinate : {0, 1, 2})
    {
      const Scope scope("not finite");
      Shape bad = rough;
      bad.points[17](coordinate) = value;
      M mesh = make_mesh<M>(bad);
      refuses(mesh, reference, energy, np, "mesh: vertex 17 ");
      M good = make_mesh<M>(rough);
      refuses(good, mesh, energy, np, "reference: vertex 17 ");
    }
  {
    const Scope scope("faces that are not triangles");
    Shape mixed = plane_grid(3, 3);
    const int top = mixed.add(1. / 3, 2, 0), right = mixed.add(2. / 3, 2, 0);
    mixed.faces.push_back({13, 14, right, top}); // a quad, on the upper border
    M mesh = make_mesh<M>(mixed);
    refuses(mesh, mesh, energy, np, "face 18 has 4 vertices");
    const int far = mixed.add(0.5, 2.5, 0);
    mixed.faces.back() = {13, 14, right, far, top};
    mesh = make_mesh<M>(mixed);
    refuses(mesh, mesh, energy, np, "face 18 has 5 vertices");
    M good = make_mesh<M>(plane_grid(3, 3));
    refuses(good, mesh, energy, np, "reference: face 18 has 5 vertices");
  }
  {
    const Scope scope("far from the reference");
    Shape bad = rough;
    bad.points[23] *= 2;
    M mesh = make_mesh<M>(bad);
    refuses(mesh, reference, energy, np, "mesh: vertex 23 is 1.0");
    refuses(mesh, reference, energy, np, "at most 0.34");
    // vertices without faces do not make the reference larger
    Shape with = sphere;
    with.add(1000, 0, 0);
    refuses(mesh, make_mesh<M>(with), energy, np, "at most 0.34");
    // small numbers are told as well
    mesh = make_mesh<M>(scaled(bad, 1e-9));
    refuses(mesh, make_mesh<M>(scaled(sphere, 1e-9)), energy, np, "at most 3.4");
    // a little is fine, and is told
    bad = rough;
    bad.points[23] *= 1.05;
    mesh = make_mesh<M>(bad);
    const RCO::Result r = CGAL::reference_constrained_optimize(mesh, reference, energy);
    RCO_CHECK(r.largest_initial_distance > 0.05 && r.largest_initial_distance < 0.2);
  }
  {
    const Scope scope("a reference without area");
    const Shape flat{{Vector_3(0, 0, 0), Vector_3(1, 0, 0), Vector_3(2, 0, 0)}, {{0, 1, 2}}};
    M mesh = make_mesh<M>(rough);
    refuses(mesh, make_mesh<M>(flat), energy, np, "reference: every face has zero area");
    refuses(mesh, make_mesh<M>(scaled(sphere, 1e200)), energy, np,
            "reference: its diagonal is not between");
  }
  {
    const Scope scope("energies for other faces");
    M quads = make_mesh<M>(cube(2, true));
    refuses(quads, quads, energy, np, "face 0 has 4 vertices");
    typedef typename boost::graph_traits<M>::face_descriptor Face;
    typedef std::pair<Face, std::array<double, 3>> Location;
    auto location = get(CGAL::dynamic_vertex_property_t<Location>(), quads);
    refuses(quads, quads, RCO::Quad_angle_energy(), params::vertex_location_map(location),
            "reference: face 0 is a quad");
  }
}

// two fans that share their middle, as a Surface_mesh can hold them
Mesh two_fans(bool closed)
{
  Mesh mesh;
  std::vector<Vertex> middles, all;
  for(const double z : {1., -1.})
  {
    if(closed || z > 0)
      middles.push_back(mesh.add_vertex(Point(0, 0, 0)));
    all.clear();
    for(int i = 0; i < 4; ++i)
      all.push_back(mesh.add_vertex(Point(std::cos(pi * i / 2), std::sin(pi * i / 2), z)));
    for(int i = 0; i < (closed ? 4 : 3); ++i)
      if(z > 0)
        mesh.add_face(middles.back(), all[i], all[(i + 1) % 4]);
      else
        mesh.add_face(middles.back(), all[(i + 1) % 4], all[i]);
  }
  if(closed)
  {
    std::vector<Mesh::Halfedge_index> to_second;
    for(const Mesh::Halfedge_index h : CGAL::halfedges_around_target(middles[1], mesh))
      to_second.push_back(h);
    for(const Mesh::Halfedge_index h : to_second)
      mesh.set_target(h, middles[0]);
    mesh.set_halfedge(middles[1], Mesh::null_halfedge());
  }
  return mesh;
}

struct Bad_energy
{
  typedef RCO::Exponential_MIPS_density Density;
  explicit Bad_energy(int w) : what(w) {}
  int what;
  Density m_density;
  const Density& density() const { return m_density; }
  void append_elements(const RCO::Energy_context&,
                       std::size_t f,
                       std::vector<RCO::Energy_element>& elements) const
  {
    RCO::Energy_element e;
    if(f == 5 && what == 1)
      e.rest << 1, 2, 2, 4;
    if(f == 5 && what == 2)
      e.rest << 0, 1, 1, 0;
    if(f == 5 && what == 3)
      e.rest(0, 0) = not_a_number;
    if(f == 5 && what == 4)
      e.corners[1] = 3;
    if(what != 5)
      elements.push_back(e);
  }
};

void test_bad_data()
{
  test_bad_meshes<Mesh>();
  test_bad_meshes<CGAL::Polyhedron_3<Kernel>>();

  const RCO::Minimum_angle_energy energy;
  const Mesh reference = mesh_of(icosphere(1));
  Mesh mesh = mesh_of(icosphere(1));
  const auto np = params::default_values();
  {
    const Scope scope("not manifold");
    for(const bool closed : {false, true})
    {
      Mesh fans = two_fans(closed);
      RCO_CHECK_EQUAL(fans.number_of_faces(), Mesh::size_type(closed ? 8 : 6));
      refuses(fans, fans, energy, np, "mesh: vertex 0 is not manifold");
      Mesh good = mesh_of(cone(8, 2, 0.5));
      refuses(good, fans, energy, np, "reference: vertex 0 is not manifold");
    }
  }
  {
    const Scope scope("bad energies");
    for(const int what : {1, 2, 3, 4})
      refuses(mesh, reference, Bad_energy(what), np, "face 5");
    refuses(mesh, reference, Bad_energy(5), np, "no element");
    for(const double factor : {0., -1., not_a_number, infinity})
      RCO_CHECK_THROWS(RCO::Minimum_angle_energy{factor}, RCO::Invalid_input, "exponent factor");
  }
  {
    const Scope scope("bad parameters");
    for(const double value : {-0.1, 0., not_a_number})
    {
      refuses(mesh, reference, energy, params::developability_threshold(value),
              "developability_threshold");
      refuses(mesh, reference, energy, params::maximum_running_time(value), "maximum_running_time");
    }
    for(const double value : {-1e-9, not_a_number})
      refuses(mesh, reference, energy, params::energy_tolerance(value), "energy_tolerance");
    refuses(mesh, reference, energy, params::maximum_patch_size(-1), "maximum_patch_size");
    refuses(mesh, reference, energy, params::number_of_iterations(-1), "number_of_iterations");
    for(const double value : {-1., not_a_number, 1e300, 0.5})
    {
      refuses(mesh, reference, energy, params::maximum_patch_size(value), "maximum_patch_size");
      refuses(mesh, reference, energy, params::number_of_iterations(value), "number_of_iterations");
    }
    for(const double value : {-1e-9, not_a_number})
      refuses(mesh, reference, energy, params::drift_bound(value), "drift_bound");
    refuses(mesh, reference, energy, params::energy_tolerance(-1e-9), "-1e-09");
  }
  {
    const Scope scope("edges that are not manifold");
    // four triangles around an edge that is in fact two
    Mesh four;
    std::vector<Vertex> v;
    for(const Point& p : {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(0, -1, 0),
                          Point(0, 0, 1), Point(0, 0, -1), Point(0, 0, 0), Point(1, 0, 0)})
      v.push_back(four.add_vertex(p));
    four.add_face(v[0], v[1], v[2]);
    four.add_face(v[1], v[0], v[3]);
    four.add_face(v[6], v[7], v[4]);
    four.add_face(v[7], v[6], v[5]);
    for(const Mesh::Halfedge_index h : four.halfedges())
      for(const int i : {0, 1})
        if(four.target(h) == v[6 + i])
          four.set_target(h, v[i]);
    for(const int i : {6, 7})
      four.set_halfedge(v[i], Mesh::null_halfedge());
    refuses(four, four, energy, np, "mesh: the edge between vertices 0 and 1");
    Mesh good = mesh_of(plane_grid(2, 2));
    refuses(good, four, energy, np, "reference: the edge between vertices 0 and 1");
  }
  // an error is an std::invalid_argument, too
  const std::invalid_argument& as_standard = RCO::Invalid_input("text");
  RCO_CHECK_EQUAL(std::string(as_standard.what()), std::string("text"));
}

// what is unusual, but no error
void test_odd_data()
{
  const Shape sphere = icosphere(2), rough = scrambled(sphere, 0.3, 1, onto_sphere);
  const Mesh start = mesh_of(rough);
  Mesh plain = start;
  const RCO::Result expected = improve_angles(plain, mesh_of(sphere));
  // no defects, and an energy like that
  const auto as_well = [&](Mesh& mesh, const Shape& reference) {
    const RCO::Result r = improve_angles(mesh, mesh_of(reference));
    RCO_CHECK_EQUAL(r.number_of_flips + r.number_of_fold_edges, 0u);
    RCO_CHECK_NEAR(r.final_energy, expected.final_energy, 0.02 * expected.final_energy);
    return r;
  };
  const Shape turned = turned_round(sphere);
  {
    const Scope scope("a reference oriented the other way");
    Mesh mesh = start;
    RCO_CHECK_EQUAL(as_well(mesh, turned).initial_number_of_flips,
                    expected.initial_number_of_flips);
    // the mesh inside out
    mesh = mesh_of(turned_round(rough));
    as_well(mesh, sphere);
  }
  for(const bool first : {false, true})
  {
    const Scope scope("one component of two oriented the other way");
    const Vector_3 shift(3, 0, 0);
    Mesh mesh = mesh_of(joined(rough, rough, shift));
    const RCO::Result r =
      as_well(mesh, first ? joined(turned, sphere, shift) : joined(sphere, turned, shift));
    RCO_CHECK_EQUAL(r.initial_number_of_flips, 2 * expected.initial_number_of_flips);
  }
  {
    const Scope scope("isolated vertices");
    Shape with = rough, reference = sphere;
    with.add(1e6, 0, 0);
    reference.add(0, -1e6, 3);
    Mesh mesh = mesh_of(with);
    as_well(mesh, reference);
    RCO_CHECK_EQUAL(mesh.number_of_vertices(), Mesh::size_type(with.points.size()));
    RCO_CHECK(mesh.point(Vertex(int(rough.points.size()))) == Point(1e6, 0, 0));
  }
}

int main()
{
  run_test("chains of named parameters", test_chains);
  run_test("calls", test_calls);
  run_test("bad data", test_bad_data);
  run_test("odd data", test_odd_data);
  return report();
}
