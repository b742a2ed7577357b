#pragma once

// Small inputs, each with one thing wrong, and what has to become of them.

#include "../guarantees.h"
#include "Soup.h"
#include "outcome.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

struct Stress_input
{
  std::string name;
  Soup mesh;
  Expectation expected, expected_with_noise;
  bool has_reference = false; // otherwise the mesh is its own
  Soup reference;
  std::function<bool(std::size_t)> is_constrained; // vertices; none if empty

  Stress_input(const std::string& name, const Soup& mesh, const Expectation& expected)
    : name(name),
      mesh(mesh),
      expected(expected),
      expected_with_noise(expected)
  {}
  Stress_input& against(const Soup& r)
  {
    has_reference = true;
    reference = r;
    return *this;
  }
  Stress_input& constrained(const std::function<bool(std::size_t)>& is)
  {
    is_constrained = is;
    return *this;
  }
  Stress_input& with_noise(const Expectation& e)
  {
    expected_with_noise = e;
    return *this;
  }
};

// the vertex moved
inline Soup with_point(Soup s, std::size_t v, double x, double y, double z)
{
  s.points[v] = Vector_3(x, y, z);
  return s;
}

// Faces around points of faces; these are lifted by `height` along the face's normal. Every `step`-th
// face gets one.
inline Soup with_spikes(Soup s, std::size_t step, double height)
{
  const std::size_t n = s.faces.size();
  for(std::size_t f = 0; f < n; f += step)
  {
    const std::vector<int> face = s.faces[f];
    const Vector_3 a = s.points[face[0]], b = s.points[face[1]], c = s.points[face[2]];
    const int top = int(s.points.size());
    s.points.push_back((a + b + c) / 3 + height * (b - a).cross(c - a).normalized());
    s.faces[f] = {face[0], face[1], top};
    s.triangle(face[1], face[2], top);
    s.triangle(face[2], face[0], top);
  }
  return s;
}

// a disk around one vertex
inline Soup fan(int n, double x, double y, double z)
{
  Soup s;
  s.add(x, y, z);
  for(int i = 0; i < n; ++i)
    s.add(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), 0);
  for(int i = 0; i < n; ++i)
    s.triangle(0, i + 1, (i + 1) % n + 1);
  return s;
}

// a band with half a twist; closed, it cannot be oriented
inline Soup moebius(int n, int rows, bool closed)
{
  Soup s = deformed(plane(n, rows), [](const Vector_3& p) {
    const double u = 2 * pi * p.x(), w = 0.6 * (p.y() - 0.5);
    const double r = 1 + w * std::cos(u / 2);
    return Vector_3(r * std::cos(u), r * std::sin(u), w * std::sin(u / 2));
  });
  if(closed)
    for(std::vector<int>& f : s.faces)
      for(int& v : f)
        if(v % (n + 1) == n) // the end is the start, upside down
          v = (rows - v / (n + 1)) * (n + 1);
  return s;
}

// two sheets in the same place, joined at the rim
inline Soup pillow(int n)
{
  Soup s = plane(n, n);
  const int w = n + 1, inner = int(s.points.size());
  std::vector<int> back(inner);
  for(int v = 0; v < inner; ++v)
  {
    const int i = v % w, j = v / w;
    const bool is_rim = i == 0 || j == 0 || i + 1 == w || j + 1 == w;
    back[v] = is_rim ? v : s.add(s.points[v].x(), s.points[v].y(), 0);
  }
  // along the other diagonals: the corners' would be edges of four faces
  for(int v = 0; v + w + 1 < inner; ++v)
    if(v % w + 1 < w)
      s.quad(back[v + 1], back[v], back[v + w], back[v + w + 1]);
  return s;
}

inline Soup shuffled(Soup s, unsigned seed)
{
  std::mt19937 random(seed);
  for(std::size_t i = s.points.size(); i > 1; --i)
    std::swap(s.points[i - 1], s.points[random() % i]);
  return s;
}

inline std::vector<Stress_input> stress_inputs()
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Soup ball = sphere(3), coarse = sphere(1), square = plane(6, 6);
  const Expectation improves = is(Outcome::improved), nothing = is(Outcome::nothing_to_do);
  const Expectation optimized = is_optimized();
  const Expectation no_area = is_refused("reference: every face has zero area");
  const auto skewed = [](const Vector_3& p) { // of the unit square
    return Vector_3(p.x() * p.x(), p.y() * (0.6 + 0.4 * p.x() * p.y()), p.z());
  };
  std::vector<Stress_input> all;
  const auto add = [&](const std::string& name, const Soup& mesh,
                       const Expectation& expected) -> Stress_input& {
    all.emplace_back(name, mesh, expected);
    return all.back();
  };

  // hardly a mesh
  add("empty mesh", Soup(), is_refused("mesh: the mesh has no face"));
  Soup points = ball;
  points.faces.clear();
  add("points alone", points, is_refused("mesh: the mesh has no face"));
  add("empty reference", ball, is_refused("reference: the mesh has no face")).against(Soup());
  const Soup triangle{{Vector_3(0, 0, 0), Vector_3(3, 0, 0), Vector_3(0, 1, 0)}, {{0, 1, 2}}};
  add("triangle", triangle, nothing);
  Soup two_sided = triangle;
  two_sided.triangle(2, 1, 0);
  add("two triangles back to back", two_sided, optimized);
  add("regular tetrahedron", tetrahedron(), nothing).with_noise(optimized);
  add("pointed tetrahedron", scaled(tetrahedron(), 1, 1, 9), optimized);

  // who may move
  add("strip of two rows of vertices", plane(9, 1), nothing);
  add("band of two rows of vertices", cylinder(9, 1), nothing);
  add("strip of three rows of vertices", deformed(plane(9, 2), skewed), improves);
  // the few free vertices have nothing to gain with some noises, of which three tenths of an edge are many
  add("band of three rows of vertices", scaled(cylinder(9, 2), 1, 2, 0.5), improves)
    .with_noise(optimized);
  add("all vertices constrained", ball, nothing).constrained([](std::size_t) { return true; });
  add("every other vertex constrained", ball, optimized).constrained([](std::size_t v) {
    return v % 2 == 0;
  });
  add("one vertex free", ball, optimized).constrained([](std::size_t v) { return v != 40; });

  // connectivity
  Soup lonely = ball;
  for(int i = 0; i < 5; ++i)
    lonely.add(9 * i, 7, i);
  add("isolated vertices", lonely, improves);
  add("several components",
      joined(joined(ball, scaled(sphere(2), .1), Vector_3(3, 0, 0)), deformed(square, skewed),
             Vector_3(0, 5, 1)),
      improves);
  add("two components in the same place", joined(ball, ball), improves);
  Soup bow_tie = triangle;
  bow_tie.add(-3, 0, 0);
  bow_tie.add(0, -1, 0);
  bow_tie.triangle(0, 3, 4);
  add("vertex that is not manifold", bow_tie, is_refused("mesh: vertex 0 is not manifold"));
  add("vertex of the reference that is not manifold", triangle,
      is_refused("reference: vertex 0 is not manifold"))
    .against(bow_tie);
  Soup book = triangle;
  book.add(0, 0, 1);
  book.add(0, 0, -1);
  book.triangle(1, 0, 3);
  book.triangle(0, 1, 4);
  add("edge that is not manifold", book, is(Outcome::no_mesh));
  add("Moebius band", moebius(24, 4, true), is(Outcome::no_mesh));
  add("Moebius band, cut", moebius(24, 4, false), improves);
  add("fan of 400 needles", fan(400, 0.4, 0.3, 0), optimized);
  add("high fan of 400 needles", fan(400, 0.4, 0.3, 20), optimized);
  const Soup quads = rco_test::plane_grid(2, 2, 1, true);
  add("quads", quads, is_refused("Minimum_angle_energy: face 0 has 4 vertices"));
  add("quads as the reference", deformed(plane(5, 5), skewed), improves).against(quads);
  Soup pentagon = fan(5, 0, 0, 0);
  pentagon.faces = {{1, 2, 3, 4, 5}};
  add("pentagon", pentagon, is_refused("mesh: face 0 has 5 vertices"));

  // coordinates
  add("NaN", with_point(ball, 7, 0, nan, 0), is_refused("mesh: vertex 7 has a coordinate"));
  add("infinite coordinate", with_point(ball, 9, 0, 0, -infinity),
      is_refused("mesh: vertex 9 has a coordinate"));
  add("NaN in the reference", ball, is_refused("reference: vertex 7 has a coordinate"))
    .against(with_point(ball, 7, nan, 0, 0));
  Soup lonely_nan = ball;
  lonely_nan.add(nan, 0, 0);
  add("isolated vertex with NaN", lonely_nan,
      is_refused("mesh: vertex " + std::to_string(ball.points.size()) + " has a coordinate"));
  // squares of areas of these leave the range of double
  for(const double size : {1e160, 1e100, 1e-100})
    add("coordinates of " + in_short(size), scaled(ball, size),
        is_refused("reference: its diagonal is not between"));
  add("coordinates of 1e-170", scaled(ball, 1e-170), is_refused("reference: "));
  add("coordinates of 1e50", scaled(ball, 1e50), improves);
  add("coordinates of 1e-50", scaled(ball, 1e-50), improves);

  // no area
  Soup twins = ball;
  twins.points[20] = twins.points[ball.faces[150][0]];
  for(const int v : ball.faces[90])
    twins.points[v] = ball.points[ball.faces[90][0]];
  Soup slit = with_spikes(ball, 10, 0); // a point of a side instead of the middle
  for(std::size_t v = ball.points.size(), f = 0; v < slit.points.size(); ++v, f += 10)
    slit.points[v] = 0.5 * (ball.points[ball.faces[f][0]] + ball.points[ball.faces[f][1]]);
  add("duplicated points", twins, optimized);
  add("duplicated points, good reference", twins, improves).against(ball);
  add("duplicated points in the reference", ball, improves).against(twins);
  add("faces without area", slit, optimized);
  add("faces without area, good reference", slit, improves).against(ball);
  add("faces without area in the reference", ball, improves).against(slit);
  add("sphere as a line", scaled(ball, 1, 0, 0), no_area);
  add("sphere as a point", scaled(ball, 0), no_area);
  // here rounding leaves some
  const auto slanted = [](const Vector_3& p) {
    const double t = p.x() + 0.1 * p.y();
    return Vector_3(t, 0.1 + 0.3 * t, 0.7 * t);
  };
  add("sphere as a slanted line", deformed(ball, slanted), no_area);
  add("reference that is a line", triangle, no_area).against(scaled(ball, 1, 0, 0));
  const Expectation mesh_without_area = is_refused("mesh: every face has zero area");
  add("all vertices in one point of the reference", shifted(scaled(ball, 0), Vector_3(1, 0, 0)),
      mesh_without_area)
    .against(ball);
  add("all vertices on one line of the reference",
      shifted(scaled(square, 1, 0, 0), Vector_3(0, 0.5, 0)), mesh_without_area)
    .against(square)
    .with_noise(optimized);
  add("all vertices on a slanted line of the reference",
      deformed(square, [](const Vector_3& p) { return Vector_3(p.x(), 0.1 + 0.7 * p.x(), 0); }),
      {{Outcome::improved, Outcome::nothing_to_do, Outcome::refused},
       "mesh: every face has zero area"})
    .against(square);
  const auto upright = [](const Vector_3& p) { return Vector_3(p.x(), 0.5, 0.1 * p.y()); };
  add("mesh upright on the reference", deformed(square, upright), optimized).against(square);
  add("pillow upright on the reference", deformed(pillow(6), upright), mesh_without_area)
    .against(square)
    .with_noise(optimized);

  // bad shape
  add("sphere flattened to 1e-3", scaled(ball, 1, 1, 1e-3), optimized);
  add("sphere flattened to 1e-9", scaled(ball, 1, 1, 1e-9), optimized);
  add("sphere flattened to nothing", scaled(ball, 1, 1, 0), optimized);
  add("sphere drawn out to 1e6", scaled(ball, 1, 1, 1e6), optimized);
  add("square drawn out to 1e4", scaled(deformed(square, skewed), 1e4, 1, 1), improves);
  add("spikes of valence 3", with_spikes(ball, 7, 0.5), improves);
  add("spikes of valence 3, 1e4 high", with_spikes(ball, 7, 1e4), optimized);
  add("spikes inwards", with_spikes(ball, 7, -0.3), optimized);
  add("one vertex 1e6 away", with_point(ball, 30, 1e6, 2e5, 0), optimized);
  add("pillow without thickness", pillow(6), optimized);
  // coarse enough to be taken for a part, whose sharp edges hold it
  add("torus through itself", torus(24, 11, 0.5, 1), optimized);
  add("torus through itself, 48 vertices nearly in one point", torus(24, 12, 0.5, 1), optimized);
  add("sphere turned inside out in part",
      deformed(ball,
               [](const Vector_3& p) {
                 return p.z() > 0.6 ? Vector_3(p.x(), p.y(), 1.2 - 3 * p.z()) : p;
               }),
      optimized);
  add("vertices shuffled", shuffled(ball, 1), optimized);
  // a quarter of a million pairs of faces intersect, and what lowers the energy adds some
  add("vertices shuffled, good reference", shuffled(ball, 1), optimized).against(ball);

  // close sheets
  add("sheets a tenth of an edge apart", rco_test::double_sheet(16, 0.1 / 16, 0.1), optimized);
  add("blade", rco_test::double_sheet(16, 1. / 16, 0.04, 0.98), optimized);
  add("pleats of 173 degrees", rco_test::pleats(4, 6, 173), optimized);
  add("fins",
      deformed(rco_test::pleats(4, 6, 160),
               [](const Vector_3& p) { return Vector_3(p.x(), p.y(), (std::max)(p.z(), 0.5)); }),
      optimized);
  const Soup finger = scaled(ball, 0.3, 0.3, 1);
  add("fingers that nearly touch", joined(finger, finger, Vector_3(0.605, 0.01, 0.02)), optimized);
  add("fingers that touch", joined(finger, finger, Vector_3(0.6, 0, 0)), optimized);

  // mesh and reference
  add("mesh far from the reference", shifted(ball, Vector_3(3, 0, 0)),
      is_refused("mesh: vertex 0 is "))
    .against(ball);
  add("mesh of another size than the reference", scaled(ball, 9), is_refused("mesh: vertex 0 is "))
    .against(ball);
  add("reference oriented the other way", ball, improves).against(turned_round(ball));
  // a square with a fold that is opened, beside a ball
  const auto folded = [](const Vector_3& p) {
    return Vector_3(p.x() + 1.6 * p.y() * (1 - p.y()) * std::sin(6.283185307179586 * p.x()), p.y(),
                    p.z());
  };
  const Vector_3 beside(3, 0, 0);
  add("part of the reference oriented the other way",
      joined(ball, deformed(plane(20, 20), folded), beside), improves)
    .against(joined(ball, turned_round(plane(20, 20)), beside));
  add("mesh finer than the reference", scaled(sphere(4), 0.9), improves).against(sphere(1));
  add("mesh coarser than the reference", coarse, optimized).against(sphere(4));
  add("sphere onto half a sphere", ball, is_refused("mesh: vertex"))
    .against(shifted(scaled(square, 2), Vector_3(-1, -1, 0)));
  add("part of the reference", deformed(square, skewed), improves)
    .against(shifted(scaled(plane(7, 7), 3, 3, 1), Vector_3(-1, -1, 0)));
  add("regular triangles",
      deformed(square,
               [](const Vector_3& p) {
                 return Vector_3(p.x() - 0.5 * p.y(), std::sqrt(0.75) * p.y(), 0);
               }),
      nothing)
    .with_noise(improves);
  return all;
}
