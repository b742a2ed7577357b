// Optimizes a quad mesh and prints a row of figures. --help tells the rest.

#include "../library_call.h"
#include "../result_columns.h"
#include "../shape.h"

#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Reference_constrained_optimization/Quad_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/Quad_regularity_energy.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/subdivision_method_3.h>

const std::string usage =
  R"(usage: quad_benchmark mesh[:reference] [options]

Makes the quads of a mesh regular (OFF, OBJ, PLY, STL) and prints a row of figures as a line of JSON.
run.py does so for many meshes and settings. The mesh is optimized against the reference after the colon,
which may be of triangles or quads, or else against its own shape.

  --energy NAME          regularity (default) or angle
  --leg-length L         of the regularity energy's rest triangles, in mean edges (default 5)
  --exponent K           factor in the exponent of the angle energy (default 1)
  --reference FILE       the reference, if none is given after a colon
  --subdivide N          start from N steps of Catmull-Clark subdivision, put onto the reference;
                         makes quads of triangles, too
  --relax-borders        let vertices at the border slide along it
)" +
  common_usage +
  R"(
in: the mesh that the run starts from; out: what it makes of it. edge: length over mean length. angle: at
all corners, in degrees. planarity: distance of a quad's diagonals over their mean length (0 is planar).
nonconvex: quads that are not convex as seen along the reference's normals. flips, folds: faces inverted with respect to the reference, and edges folded by more than 120 degrees. drift: largest distance of samples from
the mesh to the reference and back; distance_to_reference_in: largest distance of a vertex; all in mean
edges of the reference. energy: mean over the elements. n_out, n_in: outer iterations and patches per
iteration. flattened_percent: accepted patches that went through the plane. factorization_ms: time of one
factorization of the whole mesh' system, a unit of time; left out above 200000 vertices.
)";

struct Files
{
  std::string mesh, reference; // the latter may be empty
};

Files split_at_colon(const std::string& argument, const std::string& default_reference)
{
  const std::size_t colon = argument.find(':', 2); // not at that of a drive
  if(colon == std::string::npos)
    return {argument, default_reference};
  return {argument.substr(0, colon), argument.substr(colon + 1)};
}

// `steps` steps of Catmull-Clark subdivision. After each the vertices are put onto the reference,
// but for those at the border: they stay, or halve its edges.
Mesh subdivided(Mesh mesh, const Mesh& reference, int steps)
{
  if(steps == 0)
    return mesh;
  const Shape shape(reference);
  CGAL::Polygon_mesh_processing::remove_isolated_vertices(mesh);
  mesh.collect_garbage();
  for(int i = 0; i < steps; ++i)
  {
    const Mesh coarse = mesh;
    CGAL::Subdivision_method_3::CatmullClark_subdivision(mesh,
                                                         CGAL::parameters::number_of_iterations(1));
    for(const Mesh::Vertex_index v : mesh.vertices())
    {
      Kernel::Point_3& p = mesh.point(v);
      if(!mesh.is_border(v))
        p = shape.project(p);
      else if(coarse.has_valid_index(v))
        p = coarse.point(v);
    }
  }
  return mesh;
}

RCO::Result optimize_quads(Mesh& mesh,
                           const Mesh& reference,
                           const Command_line& arguments,
                           const Common_settings& s,
                           Monotonicity_visitor& visitor)
{
  const auto np =
    with_common_settings(CGAL::parameters::developability_threshold(s.developability), s, visitor)
      .relax_constraints(arguments.has("--relax-borders"));
  const auto optimize_for = [&](const auto& energy) {
    return optimize(mesh, reference, energy, np, s);
  };
  const std::string energy = arguments.text("--energy", "regularity");
  const bool is_regularity = energy == "regularity";
  if(!is_regularity && energy != "angle")
    throw std::invalid_argument("--energy must be regularity or angle");
  const std::string unused = is_regularity ? "--exponent" : "--leg-length";
  if(arguments.has(unused))
    throw std::invalid_argument(unused + " has no meaning for this energy");
  return is_regularity
           ? optimize_for(RCO::Quad_regularity_energy(arguments.number("--leg-length", 5.)))
           : optimize_for(RCO::Quad_angle_energy(arguments.number("--exponent", 1.)));
}

// what is measured before and after
struct Figures
{
  RCO::Edge_statistics edges;
  RCO::Corner_angle_statistics angles;
  RCO::Planarity planarity;
  std::size_t nonconvex_quads;
  RCO::Orientation_defects defects;
  RCO::Drift drift;

  Figures(const Mesh& mesh, const Mesh& reference)
    : edges(RCO::edge_statistics(mesh)),
      angles(RCO::corner_angle_statistics(mesh)),
      planarity(RCO::planarity(mesh)),
      nonconvex_quads(RCO::number_of_nonconvex_quads(mesh, reference)),
      defects(RCO::orientation_defects(mesh, reference)),
      drift(RCO::drift(mesh, reference))
  {}
};

void add_shapes(Row& row, const Figures& figures, const std::string& when)
{
  row.add("edge_min" + when, figures.edges.minimum);
  row.add("edge_max" + when, figures.edges.maximum);
  row.add("edge_std" + when, figures.edges.standard_deviation);
  row.add("angle_min" + when, figures.angles.minimum);
  row.add("angle_max" + when, figures.angles.maximum);
  row.add("angle_mean" + when, figures.angles.mean);
  row.add("angle_std" + when, figures.angles.standard_deviation);
  row.add("planarity_max" + when, figures.planarity.maximum);
  row.add("planarity_mean" + when, figures.planarity.mean);
}

// the guarantees that are violated, in words
std::string violated_guarantees(const Mesh& input,
                                const Mesh& output,
                                const Mesh& reference,
                                const Figures& in,
                                const Figures& out,
                                std::size_t monotonicity_violations,
                                bool relax_borders)
{
  // where borders are relaxed, vertices of theirs that did not move may be corners, which stay
  const auto is_free = [&](Mesh::Vertex_index v) {
    return !input.is_border(v) ||
           (relax_borders && !input.is_isolated(v) && input.point(v) != output.point(v));
  };
  Violated_guarantees broken;
  broken.check_run(input, output, reference, {in.defects, out.defects}, monotonicity_violations,
                   is_free, is_free);
  broken.add_if(out.nonconvex_quads > in.nonconvex_quads, "non-convex quads rose");
  return broken.text();
}

bool run(const Command_line& arguments, Row& row)
{
  const Common_settings s(arguments);
  const Files files = split_at_colon(arguments.name(0, ""), arguments.text("--reference", ""));
  const Mesh original = read(files.mesh);
  const Mesh reference = files.reference.empty() ? original : read(files.reference);
  const Mesh input = subdivided(original, reference, arguments.number("--subdivide", 0));
  Mesh mesh = input;
  Monotonicity_visitor visitor;
  const RCO::Result r = optimize_quads(mesh, reference, arguments, s, visitor);
  const double memory = peak_memory();
  const Figures in(input, reference), out(mesh, reference);

  row.add("mesh", base_name(files.mesh));
  add_size(row, mesh);
  add_shapes(row, in, "_in");
  add_shapes(row, out, "_out");
  row.add("nonconvex_in", double(in.nonconvex_quads));
  row.add("nonconvex_out", double(out.nonconvex_quads));
  add_flips_and_folds(row, {in.defects, out.defects});
  add_drift(row, in.drift, "_in");
  add_drift(row, out.drift, "_out");
  row.add("distance_to_reference_in", RCO::distance_to_reference(input, reference).maximum /
                                        in.drift.reference_mean_edge_length);
  row.add("energy_in", r.initial_energy);
  row.add("energy_out", r.final_energy);
  add_iterations(row, r);
  add_accepted(row, r);
  row.add("flattened_percent",
          percentage(double(r.number_of_flattened_patches), double(r.number_of_accepted_patches)));
  add_stages(row, r.times);
  add_times(row, mesh, r.running_time);
  row.add("peak_memory_mb", memory);

  write(mesh, s.output_folder, base_name(files.mesh));
  return !s.check || add_check(row, s.method, [&]() {
    return violated_guarantees(input, mesh, reference, in, out, visitor.violations,
                               arguments.has("--relax-borders"));
  });
}

int main(int argc, char* argv[])
{
  return drive(argc, argv, usage,
               with_common_options({{"--energy", true},
                                    {"--leg-length", true},
                                    {"--exponent", true},
                                    {"--reference", true},
                                    {"--subdivide", true},
                                    {"--relax-borders", false}}),
               run);
}
