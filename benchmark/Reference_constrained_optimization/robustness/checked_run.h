#pragma once

// One call of the package, with all of its guarantees checked.

#include "../guarantees.h"
#include "Locations.h"
#include "outcome.h"

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/reference_constrained_optimize.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <new>
#include <string>
#include <vector>

struct Run_figures
{
  std::size_t number_of_faces = 0;
  double angle_minimum_in = 0, angle_mean_in = 0; // smallest angles of the faces
  double angle_minimum_out = 0, angle_mean_out = 0;
  double seconds = 0;
};

struct Run_settings
{
  bool on_surface = true, finishing = true, relax_constraints = false;
  unsigned int seed = 0;
};

typedef Mesh::Property_map<Mesh::Vertex_index, bool> Vertex_map;

inline bool same_bits(const Mesh& a, const Mesh& b)
{
  for(const Mesh::Vertex_index v : a.vertices())
    for(int i = 0; i < 3; ++i)
    {
      const double x = a.point(v)[i], y = b.point(v)[i];
      if(std::memcmp(&x, &y, sizeof x) != 0)
        return false;
    }
  return true;
}

// vertices, half-edges and faces are in the same places
inline bool same_connectivity(const Mesh& a, const Mesh& b)
{
  if(a.number_of_vertices() != b.number_of_vertices() ||
     a.number_of_halfedges() != b.number_of_halfedges() ||
     a.number_of_faces() != b.number_of_faces())
    return false;
  for(const Mesh::Halfedge_index h : a.halfedges())
    if(a.target(h) != b.target(h) || a.next(h) != b.next(h) || a.face(h) != b.face(h))
      return false;
  return true;
}

// A copy of the input that is optimized, and where the package says that its vertices lie.
struct Run
{
  Mesh mesh;
  Vertex_map is_constrained;
  Locations locations;
  RCO::Result result;

  Run(const Mesh& input, const Mesh& reference, const std::function<bool(std::size_t)>& is)
    : mesh(input),
      is_constrained(mesh.add_property_map<Mesh::Vertex_index, bool>("is_constrained").first),
      locations(mesh, reference)
  {
    for(const Mesh::Vertex_index v : mesh.vertices())
      is_constrained[v] = is && is(std::size_t(v));
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
};

// without a reference that is the mesh itself
inline void call(Run& run,
                 const Mesh* reference,
                 const Run_settings& s,
                 unsigned int iterations,
                 Monotonicity_visitor& visitor)
{
  const Mesh& surface = reference ? *reference : run.mesh;
  const auto call_with = [&](const auto& own) {
    run.result =
      CGAL::reference_constrained_optimize(run.mesh, surface, RCO::Minimum_angle_energy(),
                                           own.random_seed(s.seed)
                                             .number_of_iterations(iterations)
                                             .vertex_is_constrained_map(run.is_constrained)
                                             .relax_constraints(s.relax_constraints)
                                             .visitor(std::ref(visitor)));
  };
  const auto own =
    CGAL::parameters::use_on_surface_steps(s.on_surface).use_finishing_stage(s.finishing);
  // there are no locations on quads
  if(CGAL::is_triangle_mesh(surface))
    call_with(own.vertex_location_map(run.locations.map()));
  else
    call_with(own);
}

inline std::size_t number_of_initial_defects(const RCO::Result& r)
{
  return r.initial_number_of_flips + r.initial_number_of_fold_edges +
         r.initial_number_of_nonconvex_quads;
}

inline std::size_t number_of_defects(const RCO::Result& r)
{
  return r.number_of_flips + r.number_of_fold_edges + r.number_of_nonconvex_quads;
}

// what a vertex may do
enum class Vertex_freedom : char { fixed, on_reference, on_line };

// What the result breaks, whatever the energy. `placed` is the input with its free vertices put onto the
// reference: that is what must not become worse. `is_optimized` tells the faces that are.
template <typename Is_optimized>
Violated_guarantees violated_guarantees(const Mesh& input,
                                        const Run& placed,
                                        const Run& output,
                                        const Mesh& reference,
                                        const std::vector<Vertex_freedom>& freedom,
                                        const Is_optimized& is_optimized,
                                        std::size_t monotonicity_violations)
{
  const RCO::Result& r = output.result;
  Violated_guarantees broken;
  broken.add_if(!same_connectivity(input, output.mesh), "connectivity changed");
  std::size_t bad = 0, moved = 0;
  for(const Mesh::Vertex_index v : input.vertices())
  {
    const Kernel::Point_3& p = output.mesh.point(v);
    bad += !(std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()));
    moved += freedom[v] == Vertex_freedom::fixed && input.point(v) != p;
  }
  broken.add_if(bad > 0, std::to_string(bad) + " vertices without finite coordinates");
  if(bad > 0)
    return broken;
  broken.add_if(moved > 0, std::to_string(moved) + " vertices moved that are fixed on input");
  broken.add_if(!std::isfinite(r.initial_energy) || !std::isfinite(r.final_energy),
                "energy not finite");
  const std::size_t defects_in = number_of_initial_defects(r), defects_out = number_of_defects(r);
  broken.add_if(defects_out > defects_in, "reported defects rose from " +
                                            std::to_string(defects_in) + " to " +
                                            std::to_string(defects_out));
  broken.add_if(r.number_of_creases > r.initial_number_of_creases, "creases were added");
  broken.add_if(r.number_of_self_intersections > r.initial_number_of_self_intersections,
                "self-intersections were added");
  broken.add_if(defects_out == defects_in && r.final_energy > r.initial_energy,
                "energy rose from " + in_short(r.initial_energy) + " by " +
                  in_short(r.final_energy - r.initial_energy));
  // a vertex that slides may not find a line of the reference
  const auto may_move = [&](Mesh::Vertex_index v) { return freedom[v] != Vertex_freedom::fixed; };
  const auto is_on = [&](Mesh::Vertex_index v) {
    return freedom[v] == Vertex_freedom::on_reference;
  };
  Defects_in_and_out defects;
  const bool has_triangles = CGAL::is_triangle_mesh(input);
  // distances of quads are computed again at the end, and may be too large in a soup of sheets
  const double allowed = (std::max)(1.1 * r.drift_bound, r.initial_drift);
  broken.add_if(has_triangles && r.drift > allowed * (1 + 1e-9),
                "drift of " + in_short(r.drift) + " where no more than " + in_short(allowed) +
                  " is guaranteed");
  if(CGAL::is_triangle_mesh(reference))
  {
    if(has_triangles)
    {
      // one orientation for both, or a change of it could hide defects or feign them
      const std::vector<Kernel::Vector_3> normals = placed.locations.oriented_normals(is_optimized);
      defects = {placed.locations.orientation_defects(normals, true),
                 output.locations.orientation_defects(normals, false)};
    }
    const double distance = output.locations.largest_distance(is_on);
    broken.add_if(distance >
                    8 * std::numeric_limits<double>::epsilon() * largest_coordinate(reference),
                  "a vertex is " + in_short(distance) + " away from its location");
  }
  else if(has_triangles) // there are no locations
    defects = {RCO::orientation_defects(placed.mesh, reference),
               RCO::orientation_defects(output.mesh, reference)};
  broken.check_run(placed.mesh, output.mesh, reference, defects, monotonicity_violations, may_move,
                   is_on);
  return broken;
}

// what `Minimum_angle_energy` is for
inline void check_angles(const RCO::Angle_statistics& before,
                         const RCO::Angle_statistics& after,
                         const RCO::Result& r,
                         Violated_guarantees& broken)
{
  const double rounding = 1e-6; // of a small angle that is found by its cosine
  const bool repairs = number_of_defects(r) < number_of_initial_defects(r); // that may cost
  broken.add_if(!repairs && after.minimum < before.minimum - rounding,
                "minimum angle fell from " + in_short(before.minimum) + " degrees by " +
                  in_short(before.minimum - after.minimum));
  const double little = 0.05;
  broken.add_if(!repairs && after.mean < before.mean - little,
                "mean angle fell from " + in_short(before.mean) + " degrees by " +
                  in_short(before.mean - after.mean));
}

// what is kept of a mechanical part that is its own reference
inline void check_shape(const Mesh& input,
                        const Mesh& output,
                        const RCO::Result& r,
                        Violated_guarantees& broken)
{
  // where defects are repaired faces have to turn
  if(r.number_of_feature_edges == 0 || r.initial_drift > 0 || number_of_initial_defects(r) > 0 ||
     !CGAL::is_triangle_mesh(input))
    return;
  const RCO::Normal_deviation turn = RCO::normal_deviation(output, input);
  const RCO::Feature_deviation lines = RCO::feature_deviation(input, output);
  broken.add_if(turn.share_above_20 > 0.005 || turn.share_above_45 > 0.002,
                "turned by more than 20 and 45 degrees: " + in_short(turn.share_above_20) +
                  " and " + in_short(turn.share_above_45) + " of the area");
  broken.add_if(lines.kept < 0.95 || lines.added > 0.06, "sharp edges: " + in_short(lines.kept) +
                                                           " kept, " + in_short(lines.added) +
                                                           " added");
  const std::size_t before = RCO::number_of_self_intersecting_pairs(input),
                    after = RCO::number_of_self_intersecting_pairs(output);
  broken.add_if(after > before, "intersecting pairs rose from " + std::to_string(before) + " to " +
                                  std::to_string(after));
}

inline Outcome checked_run(const Mesh& input,
                           const Mesh* reference,
                           const std::function<bool(std::size_t)>& is_constrained,
                           const Run_settings& settings,
                           Run_figures& figures,
                           std::string& text)
{
  const Mesh& surface = reference ? *reference : input;
  Run run(input, surface, is_constrained), placed(input, surface, is_constrained);
  figures.number_of_faces = input.number_of_faces();
  try
  {
    Monotonicity_visitor visitor, unused;
    try
    {
      call(run, reference, settings, 30, visitor);
    }
    catch(const RCO::Invalid_input& e)
    {
      text = e.what();
      if(same_bits(run.mesh, input))
        return Outcome::refused;
      text = "mesh touched in spite of the refusal: " + text;
      return Outcome::violated_guarantee;
    }
    const RCO::Result& r = run.result;
    figures.seconds = r.running_time;
    call(placed, reference, settings, 0, unused);

    // borders slide if constraints are relaxed: then only what the map constrains must stay
    std::vector<Vertex_freedom> freedom(input.number_of_vertices(), Vertex_freedom::on_reference);
    for(const Mesh::Vertex_index v : input.vertices())
      if(run.is_constrained[v] || input.is_isolated(v))
        freedom[v] = Vertex_freedom::fixed;
      else if(input.is_border(v))
        freedom[v] = settings.relax_constraints ? Vertex_freedom::on_line : Vertex_freedom::fixed;
    Violated_guarantees broken = violated_guarantees(
      input, placed, run, surface, freedom, [](Mesh::Face_index) { return true; },
      visitor.violations);
    const RCO::Angle_statistics in = RCO::angle_statistics(placed.mesh),
                                out = RCO::angle_statistics(run.mesh);
    check_angles(in, out, r, broken);
    if(!reference)
      check_shape(input, run.mesh, r, broken);
    text = broken.text();
    figures.angle_minimum_in = in.minimum;
    figures.angle_mean_in = in.mean;
    figures.angle_minimum_out = out.minimum;
    figures.angle_mean_out = out.mean;
    if(!text.empty())
      return Outcome::violated_guarantee;
    const bool repairs = number_of_defects(r) < number_of_initial_defects(r);
    // less is rounding
    const bool gains = r.final_energy < r.initial_energy * (1 - 1e-9);
    return repairs || gains ? Outcome::improved : Outcome::nothing_to_do;
  }
  catch(const std::bad_alloc&)
  {
    text = "no memory left";
    return Outcome::out_of_memory;
  }
  catch(const std::exception& e)
  {
    text = e.what();
    return Outcome::exception;
  }
}
