#pragma once

// Small meshes and parameters out of bytes: a shape, connectivity that is damaged, points that are
// moved to bad places, a reference.

#include "Byte_reader.h"
#include "Soup.h"
#include "stress_inputs.h"
#include "variants.h"

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <vector>

// tells elements of a range by their positions
struct Fuzz_pattern
{
  bool is_used = false;
  std::uint64_t bits = 0;

  bool operator()(std::size_t i) const { return is_used && (bits >> (i % 61)) % 2 == 1; }
};

enum class Fuzz_energy { minimum_angle, compatible_remeshing, quad_regularity, quad_angle };

struct Fuzz_input
{
  Mesh mesh, reference, source;
  bool has_reference = false; // otherwise the mesh is its own
  Fuzz_energy energy = Fuzz_energy::minimum_angle;
  bool on_surface = true, finishing = true, relax_constraints = false, twice = false;
  unsigned iterations = 0, seed = 0;
  int patch_size = 0;
  double developability_threshold = 0, energy_tolerance = 0, drift_bound = 0;
  std::size_t stop_after = 0; // questions to the visitor; 0: never
  Fuzz_pattern vertices, edges, reference_edges, faces;
};

class Fuzz_decoder
{
public:
  Fuzz_decoder(const std::uint8_t* data, std::size_t size) : m_bytes(data, size) {}

  Fuzz_input decode()
  {
    Fuzz_input in;
    in.energy = Fuzz_energy(m_bytes.below(4));
    const unsigned switches = m_bytes.byte();
    in.on_surface = switches % 2 == 0;
    in.finishing = switches / 2 % 2 == 0;
    in.relax_constraints = switches / 4 % 2 == 1;
    in.twice = switches / 8 % 4 == 3;
    in.seed = switches / 32;
    in.iterations = (m_bytes.byte() + 2) % 6;
    in.patch_size = m_bytes.flag() ? int(m_bytes.byte()) : 0;
    in.developability_threshold = m_bytes.flag() ? std::abs(m_bytes.number()) : 0.25;
    in.energy_tolerance = m_bytes.flag() ? std::abs(m_bytes.number()) : 3e-3;
    const unsigned drift = m_bytes.below(4);
    in.drift_bound = drift == 3 ? m_bytes.number() : std::numeric_limits<double>::infinity();
    in.stop_after = m_bytes.flag() ? 1 + 4 * m_bytes.byte() : 0;
    in.vertices = pattern();
    in.edges = pattern();
    in.reference_edges = pattern();
    in.faces = pattern();

    const Soup start = damaged(shape());
    Soup mesh = misplaced(noisy(start));
    Soup reference = mesh, source = m_bytes.flag() ? mesh : start;
    const unsigned kind = m_bytes.below(8);
    in.has_reference = kind > 0;
    if(kind == 1)
      reference = start;
    else if(kind == 2)
      reference = turned_round(start);
    else if(kind == 3)
      reference = damaged(shape());
    else if(kind == 4)
      reference = misplaced(start);
    else if(kind == 5)
      reference = noisy(start);
    else if(kind == 6)
      source = damaged(source);
    const unsigned size = m_bytes.below(16);
    in.mesh = built(in_other_units(mesh, size));
    in.reference = built(in_other_units(reference, size));
    in.source = built(in_other_units(source, m_bytes.below(16)));
    if(drift < 2) // as by default
      in.drift_bound = 0.25 * mean_edge(in.reference);
    return in;
  }

private:
  Fuzz_pattern pattern()
  {
    Fuzz_pattern p;
    p.is_used = m_bytes.flag();
    if(p.is_used)
      p.bits = m_bytes.word();
    return p;
  }

  // at most some tens of faces
  Soup shape()
  {
    const unsigned kind = m_bytes.below(12);
    const int a = 1 + int((m_bytes.byte() + 3) % 5), b = 1 + int((m_bytes.byte() + 3) % 5);
    Soup s = kind == 0    ? plane(a, b)
             : kind == 1  ? sphere(a % 2)
             : kind == 2  ? torus(a + 2, 3 + b % 3, 1, 0.25 * b)
             : kind == 3  ? cylinder(a + 2, b)
             : kind == 4  ? tetrahedron()
             : kind == 5  ? fan(a + 2, 0.1 * b, 0, b - 3)
             : kind == 6  ? pillow(a)
             : kind == 7  ? moebius(a + 3, (b + 1) / 2, b % 2 == 0)
             : kind == 8  ? joined(sphere(a % 2), scaled(sphere(0), .1), Vector_3(b, 0, 0))
             : kind == 9  ? with_spikes(plane(1 + a / 2, 1 + b / 2), 2, 0.25 * (b - 3))
             : kind == 10 ? shuffled(sphere(1), unsigned(a + 5 * b))
                          : Soup();
    if(m_bytes.flag())
      s = with_quads(s, m_bytes.word());
    return s;
  }

  // pairs of triangles that come from a quad become one again
  static Soup with_quads(const Soup& s, std::uint64_t unless)
  {
    Soup result;
    result.points = s.points;
    for(std::size_t f = 0; f < s.faces.size(); ++f)
    {
      const std::vector<int>& t = s.faces[f];
      const bool has_next = f + 1 < s.faces.size() && s.faces[f + 1].size() == 3;
      if(has_next && s.faces[f + 1][0] == t[0] && s.faces[f + 1][1] == t[2] &&
         (unless >> (f % 64)) % 2 == 0)
        result.faces.push_back({t[0], t[1], t[2], s.faces[++f][2]});
      else
        result.faces.push_back(t);
    }
    return result;
  }

  int vertex(const Soup& s) { return int(m_bytes.below(unsigned(s.points.size()))); }

  Soup damaged(Soup s)
  {
    for(unsigned n = m_bytes.below(8); n > 0; --n)
    {
      const unsigned kind = m_bytes.below(6);
      if(s.points.empty() || kind == 0)
      {
        const double x = m_bytes.number(), y = m_bytes.number(), z = m_bytes.number();
        s.add(x, y, z);
      }
      else if(kind == 1 || s.faces.empty())
      {
        std::vector<int> face(3 + m_bytes.below(2) + m_bytes.below(32) / 31);
        for(int& v : face)
          v = vertex(s);
        s.faces.push_back(face);
      }
      else if(kind == 2)
        s.faces.erase(s.faces.begin() + std::ptrdiff_t(m_bytes.below(unsigned(s.faces.size()))));
      else if(kind == 3)
      {
        std::vector<int>& face = s.faces[m_bytes.below(unsigned(s.faces.size()))];
        std::reverse(face.begin(), face.end());
      }
      else if(kind == 4)
      {
        const int v = vertex(s), w = vertex(s);
        for(std::vector<int>& face : s.faces)
          std::replace(face.begin(), face.end(), v, w);
      }
      else
      {
        const std::vector<int> face = s.faces[m_bytes.below(unsigned(s.faces.size()))];
        s.faces.push_back(face);
      }
    }
    s.faces.erase(std::remove_if(s.faces.begin(), s.faces.end(),
                                 [](const std::vector<int>& f) {
                                   return std::set<int>(f.begin(), f.end()).size() < f.size();
                                 }),
                  s.faces.end());
    if(m_bytes.flag())
      CGAL::Polygon_mesh_processing::orient_polygon_soup(s.points, s.faces);
    return s;
  }

  Soup noisy(const Soup& s)
  {
    const double amount = m_bytes.byte() / 400.;
    const bool is_flat = m_bytes.flag();
    std::mt19937 random(m_bytes.byte());
    const auto draw = [&]() { return amount * (double(random()) / 2147483648. - 1); };
    return deformed(s, [&](const Vector_3& p) -> Vector_3 {
      const double x = draw(), y = draw(), z = is_flat ? 0 : draw();
      return p + Vector_3(x, y, z);
    });
  }

  Soup misplaced(Soup s)
  {
    for(unsigned n = m_bytes.below(8); n > 0 && !s.points.empty(); --n)
    {
      const int v = vertex(s);
      const unsigned kind = m_bytes.below(6);
      Vector_3& p = s.points[v];
      if(kind == 0)
        p = s.points[vertex(s)];
      else if(kind == 1)
      {
        const Vector_3 a = s.points[vertex(s)], b = s.points[vertex(s)];
        p = 0.5 * (a + b);
      }
      else if(kind == 2)
        for(int i = 0; i < 3; ++i)
          p[i] = m_bytes.number();
      else
        p[int(kind) - 3] = m_bytes.number();
    }
    return s;
  }

  static Soup in_other_units(const Soup& s, unsigned kind)
  {
    const double factors[] = {1e6, 1e-6, 1e55, 1e-55};
    return kind < 8     ? s
           : kind < 12  ? scaled(s, factors[kind - 8])
           : kind == 12 ? scaled(s, 1, 1, 0)
           : kind == 13 ? scaled(s, 1e5, 1, 1)
           : kind == 14 ? shifted(s, Vector_3(1e6, -2e6, 7e5))
                        : scaled(s, 1, 1, 1e-9);
  }

  static Mesh built(const Soup& s)
  {
    std::size_t left_out = 0;
    return to_mesh(s, left_out);
  }

  Byte_reader m_bytes;
};
