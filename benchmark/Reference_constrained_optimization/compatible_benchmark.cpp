// Lowers the distortion of maps between two surfaces and prints one row of figures for every pair,
// start and combination of settings, and if so wanted for a baseline. --help tells the rest.

#include "Monotonicity_visitor.h"
#include "arap_baseline.h"
#include "library_call.h"
#include "meshes.h"
#include "promises.h"
#include "report.h"
#include "result_columns.h"
#include "run_apart.h"
#include "settings.h"

#include <CGAL/Reference_constrained_optimization/Compatible_remeshing_energy.h>
#include <CGAL/Reference_constrained_optimization/compatible_initial_mesh.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace RCO = CGAL::Reference_constrained_optimization;

struct Settings : Common_settings
{
  double drift_bound = -1; // in mean edges of the reference; negative: the library's default
};

struct Options : Common_options<Settings>
{
  std::vector<std::string> starts; // empty: what each folder has
  bool baseline = false;
};

const char* const usage =
  R"(usage: compatible_benchmark [options] pair...

Lowers the distortion of the map from a mesh Q to a mesh of the same connectivity on a reference R,
and prints one row for each pair, each start and each combination of settings. A pair is a folder
with Q.off, R.off, and M.off (the mesh to start from) or landmarks.txt (pairs of vertices of Q and
R, one a line, from which a start is made) or both.

Settings; each takes a value or a list such as 0.1,0.25,0.6:
  --developability E     threshold for a face to join a patch
  --patch-size N         largest number of faces of a patch; 0: by the size of the mesh
  --iterations N         largest number of outer iterations
  --tolerance T          relative decrease of the energy per iteration that ends the run
  --seed N               random seed
  --drift-bound B        in mean edges of R; inf: none; a negative number: the default
  --time-limit S         seconds
  --method LIST          ours; plain: without on-surface steps and finishing; paper: as the paper
                         describes it, every patch flattened from Tutte's embedding, optimized to
                         the end in the plane, and kept whatever comes back
Options:
  --start LIST           starts, such as M.off,landmarks: 'landmarks', or a mesh, looked for in the
                         pair's folder first (default: M.off, or else landmarks)
  --baseline             also run an as-rigid-as-possible deformation with a soft constraint to R,
                         once for each start; settings, time limit and --check are not for it
  --parallel             use all threads (if built with TBB)
  --check                verify what is promised (by ours and plain); exit code 1 if it does not
                         hold
  --format F             table, csv or json
  -o, --output DIR       write the resulting meshes, and those that were made from landmarks to
                         start from, into this folder (OFF)
  -h, --help             this text

Exit code: 0, 1 if a check failed, 2 if a pair or an option could not be used.

Columns. mean (in/out), median, p99, max (out): distortion of the triangles, half the sum of the
squared norms of the Jacobian and of its inverse, Q scaled to R's area (2 is isometric). flips,
folds: faces turned against the reference, and edges folded by more than 120 degrees. drift: largest
distance of samples from the mesh to the reference and back (how much of R is covered), in mean
edges of the reference. N_out, N_in: outer iterations and patches per iteration. s: seconds of the
optimization; map s: of the making of the start from landmarks. T_F: time of one factorization of
the whole mesh' system, a yardstick for the time; left out above 200000 vertices. MB: peak memory of
the run (every run has a process of its own where the system has fork).
)";

Options parse(int argc, char* argv[])
{
  return parse_options<Options>(argc, argv, usage, "pair",
                                [](Options& o, const std::string& option, const auto& value) {
                                  if(option == "--drift-bound")
                                    expand(o.runs, &Settings::drift_bound, option, value(), true);
                                  else if(option == "--start")
                                    o.starts = split_list(value());
                                  else if(option == "--baseline")
                                    o.baseline = true;
                                  else
                                    return false;
                                  return true;
                                });
}

// ---- starts ------------------------------------------------------------------------------------

const char* const landmarks_start = "landmarks";

bool exists(const std::string& file) { return bool(std::ifstream(file)); }

std::vector<std::string> starts_of(const std::string& folder, const Options& o)
{
  if(!o.starts.empty())
    return o.starts;
  return {exists(folder + "/M.off") || !exists(folder + "/landmarks.txt") ? "M.off"
                                                                          : landmarks_start};
}

typedef std::pair<Mesh::Vertex_index, Mesh::Vertex_index> Landmark;

std::vector<Landmark>
read_landmarks(const std::string& file, const Mesh& source, const Mesh& target)
{
  std::ifstream in(file);
  if(!in)
    throw std::runtime_error("landmarks.txt cannot be read");
  std::vector<Landmark> landmarks;
  std::size_t v, w;
  while(in >> v >> w)
  {
    if(v >= source.number_of_vertices() || w >= target.number_of_vertices())
      throw std::runtime_error("landmarks.txt names a vertex that Q or R does not have");
    landmarks.emplace_back(Mesh::Vertex_index(Mesh::size_type(v)),
                           Mesh::Vertex_index(Mesh::size_type(w)));
  }
  if(!in.eof())
    throw std::runtime_error("landmarks.txt is not made of pairs of numbers");
  return landmarks;
}

struct Pair
{
  Mesh source, reference, start;
  double map_seconds = std::numeric_limits<double>::quiet_NaN(); // if made from landmarks
};

double seconds_since(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Pair read_pair(const std::string& folder, const std::string& start)
{
  Pair pair;
  pair.source = read_or_name(folder + "/Q.off");
  pair.reference = read_or_name(folder + "/R.off");
  if(start == landmarks_start)
  {
    const auto landmarks = read_landmarks(folder + "/landmarks.txt", pair.source, pair.reference);
    const auto begin = std::chrono::steady_clock::now();
    RCO::compatible_initial_mesh(pair.source, pair.reference, landmarks, pair.start);
    pair.map_seconds = seconds_since(begin);
  }
  else
    pair.start = read_or_name(exists(folder + "/" + start) ? folder + "/" + start : start);
  return pair;
}

// ---- one run -----------------------------------------------------------------------------------

RCO::Result optimize_map(Mesh& mesh,
                         const Pair& pair,
                         double edge_length,
                         const Settings& s,
                         const Options& o,
                         Monotonicity_visitor& visitor)
{
  const RCO::Compatible_remeshing_energy energy(pair.source);
  const auto optimize_with = [&](const auto& own) {
    return optimize(mesh, pair.reference, energy, with_common_settings(own, s, visitor), s.method,
                    o.parallel);
  };
  const auto own = CGAL::parameters::developability_threshold(s.developability);
  return s.drift_bound < 0 ? optimize_with(own)
                           : optimize_with(own.drift_bound(s.drift_bound * edge_length));
}

// the vertices of every face, starting with the smallest
std::vector<std::vector<std::size_t>> faces_of(const Mesh& mesh)
{
  std::vector<std::vector<std::size_t>> result;
  for(const Mesh::Face_index f : mesh.faces())
  {
    result.emplace_back();
    for(const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f)))
      result.back().push_back(v);
    std::rotate(result.back().begin(), std::min_element(result.back().begin(), result.back().end()),
                result.back().end());
  }
  return result;
}

// what does not hold of the promises, in words
std::string broken_promises(const Pair& pair,
                            const Mesh& output,
                            const Defects_in_and_out& defects,
                            std::size_t monotonicity_violations)
{
  const Mesh& input = pair.start;
  Broken_promises broken;
  broken.check_run(input, output, pair.reference, defects, monotonicity_violations,
                   [&](Mesh::Vertex_index v) { return !input.is_border(v); });
  broken.add_if(output.number_of_vertices() != pair.source.number_of_vertices() ||
                  faces_of(output) != faces_of(pair.source),
                "connectivity differs from that of Q");
  return broken.text();
}

std::string describe(const Settings& s, const Options& o)
{
  return Settings_text<Settings>(o.runs, s)
    .add("e_d", &Settings::developability)
    .add("size", &Settings::patch_size)
    .add("it", &Settings::iterations)
    .add("tol", &Settings::tolerance)
    .add("seed", &Settings::seed)
    .add("drift", &Settings::drift_bound)
    .add("limit", &Settings::time_limit)
    .add("method", &Settings::method)
    .text();
}

// Optimizes one pair and makes its row; `holds` tells whether all checks held. Without settings it
// is the baseline that runs.
Row run(const std::string& folder,
        const std::string& start,
        const Settings* s,
        const Options& o,
        bool& holds)
{
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const Pair pair = read_pair(folder, start);
  const RCO::Drift drift_in = RCO::drift(pair.start, pair.reference);
  Mesh mesh = pair.start;
  Monotonicity_visitor visitor;
  double iterations = 0, patches_per_iteration = unknown, seconds = 0;
  std::string status = "-";
  if(s)
  {
    const RCO::Result r =
      optimize_map(mesh, pair, drift_in.reference_mean_edge_length, *s, o, visitor);
    iterations = double(r.number_of_iterations);
    patches_per_iteration = iterations > 0 ? double(r.number_of_patches) / iterations : 0;
    seconds = r.running_time;
    status = name(r.status);
  }
  else
  {
    const auto begin = std::chrono::steady_clock::now();
    iterations = double(arap_baseline(pair.source, pair.reference, mesh));
    seconds = seconds_since(begin);
  }
  const double memory = peak_memory();

  const std::string base = base_name(folder), start_name = base_name(start);
  const std::string settings = s ? describe(*s, o) : "";
  const std::string method = s ? s->method : "arap";
  Row row;
  row.add("pair", "pair", base);
  row.add("start", "start", start_name);
  if(o.baseline)
    row.add("method", "method", method);
  if(o.runs.size() > 1)
    row.add("settings", "settings", settings);
  row.add("vertices", "V", double(mesh.number_of_vertices()));
  const auto np = CGAL::parameters::default_values();
  const RCO::internal::Mesh_copy reference =
    RCO::internal::read_measured_mesh(pair.reference, np, "reference");
  const double area = RCO::internal::surface_area(reference.mesh, reference.points);
  const auto distortion = [&](const Mesh& m) {
    return RCO::distortion_statistics(pair.source, m, np, np, area);
  };
  const RCO::Distortion_statistics out = distortion(mesh);
  row.add("distortion_mean_in", "mean", distortion(pair.start).mean, 3);
  row.add("distortion_mean_out", "mean", out.mean, 3);
  row.add("distortion_median", "median", out.median, 3);
  row.add("distortion_p99", "p99", out.percentile_99, 2);
  row.add("distortion_max", "max", out.maximum, 1);
  const Defects_in_and_out defects = {RCO::orientation_defects(pair.start, pair.reference),
                                      RCO::orientation_defects(mesh, pair.reference)};
  add_flips_and_folds(row, defects);
  add_drift(row, drift_in, "in");
  add_drift(row, RCO::drift(mesh, pair.reference), "out");
  row.add("status", "status", status);
  row.add("n_out", "N_out", iterations);
  row.add("n_in", "N_in", patches_per_iteration, 1);
  row.add("time_s", "s", seconds, 2);
  row.add("map_s", "map s", pair.map_seconds, 2);
  add_factorization(row, mesh, seconds);
  row.add("peak_memory_mb", "MB", memory, 0);

  if(o.check)
    add_check(
      row, method, [&]() { return broken_promises(pair, mesh, defects, visitor.violations); },
      holds);
  if(!o.output_folder.empty())
  {
    write(mesh, o.output_folder,
          base + "_" + start_name + (s ? "" : "_arap") + (settings.empty() ? "" : "_" + settings));
    if(start == landmarks_start)
      write(pair.start, o.output_folder, base + "_start");
  }
  return row;
}

std::string without_trailing_slashes(std::string folder)
{
  while(folder.size() > 1 && (folder.back() == '/' || folder.back() == '\\'))
    folder.pop_back();
  return folder;
}

int main(int argc, char* argv[])
{
  try
  {
    const Options options = parse(argc, argv);
    std::vector<Task> tasks;
    for(const std::string& file : options.files)
    {
      const std::string folder = without_trailing_slashes(file);
      for(const std::string& start : starts_of(folder, options))
      {
        const auto add = [&](const Settings* settings) {
          tasks.push_back({folder + ", " + start, [=, &options](bool& holds) {
                             return run(folder, start, settings, options, holds);
                           }});
        };
        for(const Settings& settings : options.runs)
          add(&settings);
        if(options.baseline)
          add(nullptr);
      }
    }
    return run_all(tasks, options.format);
  }
  catch(const std::invalid_argument& e)
  {
    std::cerr << "compatible_benchmark: " << e.what() << std::endl;
    return failure;
  }
}
