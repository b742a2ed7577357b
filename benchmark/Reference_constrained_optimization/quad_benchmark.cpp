// Optimizes quad meshes and prints one row of figures for every mesh and every combination of
// settings. --help tells the rest.

#include "Monotonicity_visitor.h"
#include "library_call.h"
#include "meshes.h"
#include "promises.h"
#include "report.h"
#include "result_columns.h"
#include "run_apart.h"
#include "settings.h"
#include "subdivided.h"

#include <CGAL/Reference_constrained_optimization/Quad_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/Quad_regularity_energy.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <cstddef>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace RCO = CGAL::Reference_constrained_optimization;

struct Settings : Common_settings
{
  double leg_length = 5; // of the regularity energy, in mean edges
  double exponent = 1;   // of the angle energy
};

struct Options : Common_options<Settings>
{
  std::string energy = "regularity", reference;
  int subdivisions = 0;
  bool relax_borders = false;
};

const char* const usage =
  R"(usage: quad_benchmark [options] mesh[:reference]...

Makes the quads of every mesh regular (OFF, OBJ, PLY, STL) and prints one row for each mesh and each
combination of settings. A mesh is optimized against the reference after the colon, which may be of
triangles or quads, or else against its own shape.

Settings; each takes a value or a list such as 0.2,1,5:
  --leg-length L         of the regularity energy's rest triangles, in mean edges (default 5)
  --exponent K           factor in the exponent of the angle energy (default 1)
  --developability E     threshold for a face to join a patch
  --patch-size N         largest number of faces of a patch; 0: by the size of the mesh
  --iterations N         largest number of outer iterations
  --tolerance T          relative decrease of the energy per iteration that ends the run
  --seed N               random seed
  --time-limit S         seconds
  --method LIST          ours; plain: without on-surface steps and finishing; paper: as the paper
                         describes it, every patch flattened from Tutte's embedding, optimized to
                         the end in the plane, and kept whatever comes back
Options:
  --energy NAME          regularity (default) or angle
  --reference FILE       the reference of meshes that are given without one
  --subdivide N          start from N steps of Catmull-Clark subdivision, put onto the reference;
                         makes quads of triangles, too
  --relax-borders        let vertices at the border slide along it
  --parallel             use all threads (if built with TBB)
  --check                verify what is promised (by ours and plain); exit code 1 if it does not
                         hold
  --format F             table, csv or json
  -o, --output DIR       write the resulting meshes into this folder (OFF)
  -h, --help             this text

Exit code: 0, 1 if a check failed, 2 if a mesh or an option could not be used.

Columns. in: the mesh that the run starts from; out: what it makes of it. edges: length over mean
length (min/max/std). angles: at all corners, in degrees (min/max/mean/std). planarity: distance of
a quad's diagonals over their mean length (max/mean; 0 is planar). nonconvex: quads that are not
convex as seen along the reference's normals. flips, folds: faces turned against the reference, and
edges folded by more than 120 degrees. drift: largest distance of samples from the mesh to the
reference and back; off: largest distance of a vertex to the reference at the start; all in mean
edges of the reference. energy: mean over the elements. N_out, N_in: outer iterations and patches
per iteration. flattened %: accepted patches that went through the plane. stages %: setup /
selection / flattening / optimization / acceptance. T_F: time of one factorization of the whole
mesh' system, a yardstick for the time; left out above 200000 vertices. MB: peak memory of the run
(every run has a process of its own where the system has fork).
)";

Options parse(int argc, char* argv[])
{
  bool has_leg_length = false, has_exponent = false;
  const Options options = parse_options<Options>(
    argc, argv, usage, "mesh", [&](Options& o, const std::string& option, const auto& value) {
      if(option == "--leg-length")
      {
        expand(o.runs, &Settings::leg_length, option, value());
        has_leg_length = true;
      }
      else if(option == "--exponent")
      {
        expand(o.runs, &Settings::exponent, option, value());
        has_exponent = true;
      }
      else if(option == "--energy")
        o.energy = value();
      else if(option == "--reference")
        o.reference = value();
      else if(option == "--subdivide")
      {
        const std::string text = value();
        const double number = to_number(option, text);
        if(!(number >= 0 && number <= 10 && number == int(number)))
          throw std::invalid_argument(option + ": '" + text + "' is not a whole number up to 10");
        o.subdivisions = int(number);
      }
      else if(option == "--relax-borders")
        o.relax_borders = true;
      else
        return false;
      return true;
    });
  if(options.energy != "regularity" && options.energy != "angle")
    throw std::invalid_argument("--energy must be regularity or angle");
  if(has_leg_length && options.energy != "regularity")
    throw std::invalid_argument("--leg-length has no meaning for the angle energy");
  if(has_exponent && options.energy != "angle")
    throw std::invalid_argument("--exponent has no meaning for the regularity energy");
  return options;
}

struct Files
{
  std::string mesh, reference; // the latter may be empty
};

Files split_at_colon(const std::string& argument, const std::string& default_reference)
{
  std::size_t colon = argument.find(':');
  // not at that of a drive
  while(colon != std::string::npos && argument[colon + 1] == '\\')
    colon = argument.find(':', colon + 1);
  if(colon == std::string::npos)
    return {argument, default_reference};
  return {argument.substr(0, colon), argument.substr(colon + 1)};
}

RCO::Result optimize_quads(Mesh& mesh,
                           const Mesh& reference,
                           const Settings& s,
                           const Options& o,
                           Monotonicity_visitor& visitor)
{
  const auto np =
    with_common_settings(CGAL::parameters::developability_threshold(s.developability), s, visitor)
      .relax_constraints(o.relax_borders);
  if(o.energy == "angle")
    return optimize(mesh, reference, RCO::Quad_angle_energy(s.exponent), np, s.method, o.parallel);
  return optimize(mesh, reference, RCO::Quad_regularity_energy(s.leg_length), np, s.method,
                  o.parallel);
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
  row.add("edge_min_" + when, "edges " + when, figures.edges.minimum, 2);
  row.add("edge_max_" + when, "edges " + when, figures.edges.maximum, 2);
  row.add("edge_std_" + when, "edges " + when, figures.edges.standard_deviation, 3);
  row.add("angle_min_" + when, "angles " + when, figures.angles.minimum, 1);
  row.add("angle_max_" + when, "angles " + when, figures.angles.maximum, 1);
  row.add("angle_mean_" + when, "angles " + when, figures.angles.mean, 2);
  row.add("angle_std_" + when, "angles " + when, figures.angles.standard_deviation, 2);
  row.add("planarity_max_" + when, "planarity " + when, figures.planarity.maximum, 3);
  row.add("planarity_mean_" + when, "planarity " + when, figures.planarity.mean, 4);
}

// what does not hold of the promises, in words
std::string broken_promises(const Mesh& input,
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
  Broken_promises broken;
  broken.check_run(input, output, reference, {in.defects, out.defects}, monotonicity_violations,
                   is_free);
  broken.add_if(out.nonconvex_quads > in.nonconvex_quads, "non-convex quads rose");
  return broken.text();
}

std::string describe(const Settings& s, const Options& o)
{
  return Settings_text<Settings>(o.runs, s)
    .add("l", &Settings::leg_length)
    .add("k", &Settings::exponent)
    .add("e_d", &Settings::developability)
    .add("size", &Settings::patch_size)
    .add("it", &Settings::iterations)
    .add("tol", &Settings::tolerance)
    .add("seed", &Settings::seed)
    .add("limit", &Settings::time_limit)
    .add("method", &Settings::method)
    .text();
}

// optimizes one mesh and makes its row; `holds` tells whether all checks held
Row run(const Files& files, const Settings& s, const Options& o, bool& holds)
{
  const Mesh original = read(files.mesh);
  const Mesh reference = files.reference.empty() ? original : read_or_name(files.reference);
  const Mesh input = subdivided(original, reference, o.subdivisions);
  Mesh mesh = input;
  Monotonicity_visitor visitor;
  const RCO::Result r = optimize_quads(mesh, reference, s, o, visitor);
  const double memory = peak_memory();
  const Figures in(input, reference), out(mesh, reference);

  const std::string base = base_name(files.mesh);
  const std::string settings = describe(s, o);
  Row row;
  row.add("mesh", "mesh", base);
  if(o.runs.size() > 1)
    row.add("settings", "settings", settings);
  row.add("vertices", "V", double(mesh.number_of_vertices()));
  row.add("faces", "F", double(mesh.number_of_faces()));
  add_shapes(row, in, "in");
  add_shapes(row, out, "out");
  row.add("nonconvex_in", "nonconvex", double(in.nonconvex_quads));
  row.add("nonconvex_out", "nonconvex", double(out.nonconvex_quads));
  add_flips_and_folds(row, {in.defects, out.defects});
  add_drift(row, in.drift, "in");
  add_drift(row, out.drift, "out");
  row.add("distance_to_reference_in", "off",
          r.largest_initial_distance / in.drift.reference_mean_edge_length, 3);
  row.add("energy_in", "energy", r.initial_energy, 3);
  row.add("energy_out", "energy", r.final_energy, 3);
  add_iterations(row, r);
  add_accepted(row, r);
  row.add("flattened_percent", "flattened %",
          percentage(double(r.number_of_flattened_patches), double(r.number_of_accepted_patches)),
          1);
  add_stages(row, r.times);
  add_times(row, mesh, r.running_time);
  row.add("peak_memory_mb", "MB", memory, 0);

  if(o.check)
    add_check(
      row, s.method,
      [&]() {
        return broken_promises(input, mesh, reference, in, out, visitor.violations,
                               o.relax_borders);
      },
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
    for(const std::string& argument : options.files)
    {
      const Files files = split_at_colon(argument, options.reference);
      for(const Settings& settings : options.runs)
        tasks.push_back({files.mesh, [=, &settings, &options](bool& holds) {
                           return run(files, settings, options, holds);
                         }});
    }
    return run_all(tasks, options.format);
  }
  catch(const std::invalid_argument& e)
  {
    std::cerr << "quad_benchmark: " << e.what() << std::endl;
    return failure;
  }
}
