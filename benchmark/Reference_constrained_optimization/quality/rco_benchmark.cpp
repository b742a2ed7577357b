// Optimizes a mesh against its own shape and prints a row of figures. --help tells the rest.

#include "../library_call.h"
#include "../result_columns.h"

#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Real_timer.h>
#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/certified_drift.h>

typedef Mesh::Property_map<Mesh::Edge_index, bool> Edge_map;

const std::string usage =
  R"(usage: rco_benchmark mesh [options]

Improves the minimum angle of a mesh (triangles; OFF, OBJ, PLY, STL) and prints a row of figures as a line
of JSON. run.py does so for many meshes and settings.

  --exponent S           factor in the exponent of the energy (default 1)
  --sharp-edges ANGLE    fix edges whose normals differ by more than ANGLE degrees
  --drift-bound B        in mean edges of the reference; inf: none; a negative number: the default
  --finishing B          0: without the finishing stage (default 1)
  --reference FILE       optimize against this mesh instead of the mesh's own shape
  --certify              bound the distance of the surfaces from above, to a fiftieth of the mean edge
                         of the reference (slow)
  --history              tell the energy at the start and at the end of each iteration, too
)" +
  common_usage +
  R"(
theta: smallest angle per face, in degrees. drift: largest distance of samples from the mesh to the
reference and back, in mean edges of the reference. flips, folds: faces inverted with respect to the reference,
and edges folded by more than 120 degrees. n_out, n_in: outer iterations and patches per iteration.
conformal, convex border, failed, overlapping: how patches were flattened. mean_flattening_distortion:
mean symmetric Dirichlet energy of the flattenings (4 is isometric). factorization_ms: time of one
factorization of the whole mesh' system, a unit of time; left out above 200000 vertices.
)";

struct Visitor : Monotonicity_visitor
{
  CGAL::Real_timer timer;
  std::vector<double> seconds, energies;

  Visitor() { timer.start(); }
  void on_iteration_begin(std::size_t iteration)
  {
    if(iteration > 0)
      return;
    seconds.push_back(timer.time());
    energies.push_back(0); // known when the run has ended
  }
  void on_iteration_end(std::size_t, double energy)
  {
    seconds.push_back(timer.time());
    energies.push_back(energy);
  }
};

// the guarantees that are violated, in words
std::string violated_guarantees(const Mesh& input,
                                const Mesh& output,
                                const Mesh& reference,
                                const Edge_map& is_constrained,
                                const Defects_in_and_out& defects,
                                std::size_t monotonicity_violations)
{
  std::vector<char> is_fixed(input.number_of_vertices(), 0);
  for(const Mesh::Edge_index e : input.edges())
    if(input.is_border(e) || is_constrained[e])
      is_fixed[input.vertex(e, 0)] = is_fixed[input.vertex(e, 1)] = 1;
  Violated_guarantees broken;
  const auto is_free = [&](Mesh::Vertex_index v) { return !is_fixed[v] && !input.is_isolated(v); };
  broken.check_run(input, output, reference, defects, monotonicity_violations, is_free, is_free);
  broken.add_if(RCO::angle_statistics(output).minimum < RCO::angle_statistics(input).minimum,
                "minimum angle fell");
  return broken.text();
}

bool run(const Command_line& arguments, Row& row)
{
  const std::string file = arguments.name(0, "");
  const Common_settings s(arguments);
  const Mesh input = read(file);
  const Mesh reference =
    arguments.has("--reference") ? read(arguments.text("--reference", "")) : input;
  Mesh mesh = input;
  Edge_map is_constrained = mesh.add_property_map<Mesh::Edge_index, bool>("is_constrained").first;
  if(arguments.number("--sharp-edges", 0.) > 0)
    CGAL::Polygon_mesh_processing::detect_sharp_edges(mesh, arguments.number("--sharp-edges", 0.),
                                                      is_constrained);

  Visitor visitor;
  const auto optimize_with = [&](const auto& own) {
    return optimize(mesh, reference, RCO::Minimum_angle_energy(arguments.number("--exponent", 1.)),
                    with_common_settings(own, s, visitor).edge_is_constrained_map(is_constrained),
                    s);
  };
  const auto own = CGAL::parameters::developability_threshold(s.developability)
                     .use_finishing_stage(arguments.number("--finishing", 1) != 0);
  const double bound = relative_drift_bound(arguments);
  const RCO::Result r =
    bound < 0 ? optimize_with(own)
              : optimize_with(own.drift_bound(bound * RCO::edge_statistics(reference).mean));
  const double memory = peak_memory();

  row.add("mesh", base_name(file));
  add_size(row, mesh);
  add_angles(row, input, "_in");
  add_angles(row, mesh, "_out");
  const RCO::Drift drift = RCO::drift(mesh, reference);
  add_drift(row, drift, "");
  if(arguments.has("--certify"))
    row.add(
      "certified_drift",
      RCO::certified_drift(mesh, reference, 0.02 * drift.reference_mean_edge_length).upper_bound() /
        drift.reference_mean_edge_length);
  const Defects_in_and_out defects = {RCO::orientation_defects(input, reference),
                                      RCO::orientation_defects(mesh, reference)};
  add_flips_and_folds(row, defects);
  add_iterations(row, r);

  const double patches = double(r.number_of_patches);
  const double flattened = double(r.conformal_flattenings + r.convex_border_flattenings);
  const double tried = flattened + double(r.failed_flattenings);
  row.add("mean_patch_size", patches > 0 ? r.sum_of_patch_sizes / patches : 0);
  add_accepted(row, r);
  row.add("conformal_percent", percentage(double(r.conformal_flattenings), tried));
  row.add("convex_border_percent", percentage(double(r.convex_border_flattenings), tried));
  row.add("failed_percent", percentage(double(r.failed_flattenings), tried));
  row.add("overlapping_percent", percentage(double(r.overlapping_flattenings), tried));
  row.add("mean_flattening_distortion",
          flattened > 0 ? r.sum_of_flattening_distortion / flattened : 0);
  add_stages(row, r.times);
  add_times(row, mesh, r.running_time);
  row.add("peak_memory_mb", memory);
  if(arguments.has("--history") && !visitor.energies.empty())
  {
    visitor.energies.front() = r.initial_energy;
    row.add("history_seconds", visitor.seconds);
    row.add("history_energies", visitor.energies);
  }

  write(mesh, s.output_folder, base_name(file));
  return !s.check || add_check(row, s.method, [&]() {
    return violated_guarantees(input, mesh, reference, is_constrained, defects, visitor.violations);
  });
}

int main(int argc, char* argv[])
{
  return drive(argc, argv, usage,
               with_common_options({{"--exponent", true},
                                    {"--sharp-edges", true},
                                    {"--drift-bound", true},
                                    {"--finishing", true},
                                    {"--reference", true},
                                    {"--certify", false},
                                    {"--history", false}}),
               run);
}
