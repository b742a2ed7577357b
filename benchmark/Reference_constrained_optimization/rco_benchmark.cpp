// Optimizes meshes against their own shape and prints one row of figures for every mesh and every
// combination of settings. --help tells the rest.

#include "Monotonicity_visitor.h"
#include "library_call.h"
#include "meshes.h"
#include "promises.h"
#include "report.h"
#include "result_columns.h"
#include "run_apart.h"
#include "settings.h"

#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/certified_drift.h>

#include <cstddef>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace RCO = CGAL::Reference_constrained_optimization;
typedef Mesh::Property_map<Mesh::Edge_index, bool> Edge_map;

struct Settings : Common_settings
{
  double exponent = 1;
  double sharp_edges = 0;  // degrees, 0 is off
  double drift_bound = -1; // in mean edges of the reference; negative: the library's default
  int finishing = 1;
};

struct Options : Common_options<Settings>
{
  std::string reference;
  bool certifies = false;
};

const char* const usage =
  R"(usage: rco_benchmark [options] mesh...

Improves the minimum angle of every mesh (triangles; OFF, OBJ, PLY, STL) and prints one row for each
mesh and each combination of settings.

Settings; each takes a value or a list such as 0.1,0.25,0.6:
  --exponent S           factor in the exponent of the energy (default 1)
  --developability E     threshold for a face to join a patch
  --patch-size N         largest number of faces of a patch; 0: by the size of the mesh
  --iterations N         largest number of outer iterations
  --tolerance T          relative decrease of the energy per iteration that ends the run
  --seed N               random seed
  --sharp-edges ANGLE    fix edges whose normals differ by more than ANGLE degrees; 0 is off
  --drift-bound B        in mean edges of the reference; inf: none; a negative number: the default
  --finishing B          0: without the finishing stage (default 1)
  --time-limit S         seconds
  --method LIST          ours; plain: without on-surface steps and finishing; paper: as the paper
                         describes it, every patch flattened from Tutte's embedding, optimized to
                         the end in the plane, and kept whatever comes back
Options:
  --reference FILE       optimize against this mesh instead of the mesh's own shape
  --certify              bound the distance of the surfaces from above, to a fiftieth of the mean edge
                         of the reference (slow)
  --parallel             use all threads (if built with TBB)
  --check                verify what is promised (by ours and plain); exit code 1 if it does not
                         hold
  --format F             table, csv or json
  -o, --output DIR       write the resulting meshes into this folder (OFF)
  -h, --help             this text

Exit code: 0, 1 if a check failed, 2 if a mesh or an option could not be used.

Columns. theta: smallest angle per face, in degrees (min/mean/std). drift: largest distance of
samples from the mesh to the reference and back, in mean edges of the reference. flips, folds: faces
turned against the reference, and edges folded by more than 120 degrees. N_out, N_in: outer
iterations and patches per iteration. flattening %: patches flattened conformally / from a convex
border / not at all / with an overlapping border. SD: mean symmetric Dirichlet energy of the
flattenings (4 is isometric). stages %: setup / selection / flattening / optimization / acceptance.
T_F: time of one factorization of the whole mesh' system, a yardstick for the time; left out above
200000 vertices. MB: peak memory of the run (every run has a process of its own where the system
has fork).
)";

Options parse(int argc, char* argv[])
{
  return parse_options<Options>(argc, argv, usage, "mesh",
                                [](Options& o, const std::string& option, const auto& value) {
                                  if(option == "--exponent")
                                    expand(o.runs, &Settings::exponent, option, value());
                                  else if(option == "--sharp-edges")
                                    expand(o.runs, &Settings::sharp_edges, option, value());
                                  else if(option == "--drift-bound")
                                    expand(o.runs, &Settings::drift_bound, option, value(), true);
                                  else if(option == "--finishing")
                                    expand(o.runs, &Settings::finishing, option, value());
                                  else if(option == "--certify")
                                    o.certifies = true;
                                  else if(option == "--reference")
                                    o.reference = value();
                                  else
                                    return false;
                                  return true;
                                });
}

// what does not hold of the promises, in words
std::string broken_promises(const Mesh& input,
                            const Mesh& output,
                            const Mesh& reference,
                            const Edge_map& is_constrained,
                            std::size_t monotonicity_violations)
{
  std::vector<char> is_fixed(input.number_of_vertices(), 0);
  for(const Mesh::Edge_index e : input.edges())
    if(input.is_border(e) || is_constrained[e])
      is_fixed[input.vertex(e, 0)] = is_fixed[input.vertex(e, 1)] = 1;
  const Defects_in_and_out defects = {RCO::orientation_defects(input, reference),
                                      RCO::orientation_defects(output, reference)};
  Broken_promises broken;
  broken.check_run(input, output, reference, defects, monotonicity_violations,
                   [&](Mesh::Vertex_index v) { return !is_fixed[v] && !input.is_isolated(v); });
  broken.add_if(RCO::angle_statistics(output).minimum < RCO::angle_statistics(input).minimum,
                "minimum angle fell");
  return broken.text();
}

std::string describe(const Settings& s, const Options& o)
{
  return Settings_text<Settings>(o.runs, s)
    .add("s", &Settings::exponent)
    .add("e_d", &Settings::developability)
    .add("size", &Settings::patch_size)
    .add("it", &Settings::iterations)
    .add("tol", &Settings::tolerance)
    .add("seed", &Settings::seed)
    .add("sharp", &Settings::sharp_edges)
    .add("limit", &Settings::time_limit)
    .add("drift", &Settings::drift_bound)
    .add("finishing", &Settings::finishing)
    .add("method", &Settings::method)
    .text();
}

double mean_edge_length(const Mesh& mesh)
{
  const RCO::internal::Mesh_copy copy =
    RCO::internal::read_measured_mesh(mesh, CGAL::parameters::default_values(), "mesh");
  return RCO::internal::mean_edge_length(copy.mesh, copy.points);
}

// optimizes one mesh and makes its row; `holds` tells whether all checks held
Row run(const std::string& file, const Settings& s, const Options& o, bool& holds)
{
  const Mesh input = read(file);
  const Mesh reference = o.reference.empty() ? input : read(o.reference);
  Mesh mesh = input;
  Edge_map is_constrained = mesh.add_property_map<Mesh::Edge_index, bool>("is_constrained").first;
  if(s.sharp_edges > 0)
    CGAL::Polygon_mesh_processing::detect_sharp_edges(mesh, s.sharp_edges, is_constrained);

  Monotonicity_visitor visitor;
  const auto optimize_with = [&](const auto& own) {
    return optimize(mesh, reference, RCO::Minimum_angle_energy(s.exponent),
                    with_common_settings(own, s, visitor).edge_is_constrained_map(is_constrained),
                    s.method, o.parallel);
  };
  const auto own = CGAL::parameters::developability_threshold(s.developability)
                     .use_finishing_stage(s.finishing != 0);
  const RCO::Result r =
    s.drift_bound < 0 ? optimize_with(own)
                      : optimize_with(own.drift_bound(s.drift_bound * mean_edge_length(reference)));
  const double memory = peak_memory();

  const std::string base = base_name(file);
  const std::string settings = describe(s, o);
  Row row;
  row.add("mesh", "mesh", base);
  if(o.runs.size() > 1)
    row.add("settings", "settings", settings);
  row.add("vertices", "V", double(mesh.number_of_vertices()));
  row.add("faces", "F", double(mesh.number_of_faces()));
  add_angles(row, input, "in");
  add_angles(row, mesh, "out");
  const RCO::Drift drift = RCO::drift(mesh, reference);
  row.add("drift_mesh_to_reference", "drift", drift.relative_mesh_to_reference(), 3);
  row.add("drift_reference_to_mesh", "drift", drift.relative_reference_to_mesh(), 3);
  if(o.certifies)
    row.add(
      "certified_drift", "drift",
      RCO::certified_drift(mesh, reference, 0.02 * drift.reference_mean_edge_length).upper_bound() /
        drift.reference_mean_edge_length,
      3);
  add_flips_and_folds(row, {{r.initial_number_of_flips, r.initial_number_of_fold_edges},
                            {r.number_of_flips, r.number_of_fold_edges}});
  add_iterations(row, r);

  const double patches = double(r.number_of_patches);
  const double flattened = double(r.conformal_flattenings + r.convex_border_flattenings);
  const double tried = flattened + double(r.failed_flattenings);
  row.add("mean_patch_size", "faces", patches > 0 ? r.sum_of_patch_sizes / patches : 0, 1);
  add_accepted(row, r);
  row.add("conformal_percent", "flattening %", percentage(double(r.conformal_flattenings), tried),
          1);
  row.add("convex_border_percent", "flattening %",
          percentage(double(r.convex_border_flattenings), tried), 1);
  row.add("failed_percent", "flattening %", percentage(double(r.failed_flattenings), tried), 1);
  row.add("overlapping_percent", "flattening %",
          percentage(double(r.overlapping_flattenings), tried), 1);
  row.add("mean_flattening_distortion", "SD",
          flattened > 0 ? r.sum_of_flattening_distortion / flattened : 0, 2);
  add_stages(row, r.times);
  add_times(row, mesh, r.running_time);
  row.add("peak_memory_mb", "MB", memory, 0);

  if(o.check)
    add_check(
      row, s.method,
      [&]() { return broken_promises(input, mesh, reference, is_constrained, visitor.violations); },
      holds);
  if(!o.output_folder.empty())
    write(mesh, o.output_folder, settings.empty() ? base : base + "_" + settings);
  return row;
}

int main(int argc, char* argv[])
{
  try
  {
    const Options options = parse(argc, argv);
    std::vector<Task> tasks;
    for(const std::string& file : options.files)
      for(const Settings& settings : options.runs)
        tasks.push_back({file, [&](bool& holds) { return run(file, settings, options, holds); }});
    return run_all(tasks, options.format);
  }
  catch(const std::invalid_argument& e)
  {
    std::cerr << "rco_benchmark: " << e.what() << std::endl;
    return failure;
  }
}
