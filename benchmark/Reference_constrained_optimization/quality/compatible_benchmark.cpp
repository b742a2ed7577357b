// Lowers the distortion of a map between two surfaces and prints a row of figures. --help tells the rest.

#include "../library_call.h"
#include "../result_columns.h"
#include "arap_baseline.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Reference_constrained_optimization/Compatible_remeshing_energy.h>
#include <CGAL/Reference_constrained_optimization/compatible_initial_mesh.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <algorithm>
#include <utility>

const std::string usage =
  R"(usage: compatible_benchmark pair [options]

Lowers the distortion of the map from a mesh Q to a mesh of the same connectivity on a reference R, and
prints a row of figures as a line of JSON. run.py does so for many pairs and settings. A pair is a folder
with Q.off, R.off, and M.off (the mesh to start from) or landmarks.txt (pairs of vertices of Q and R, one
a line, from which a start is made) or both.

  --start NAME           'landmarks', or a mesh, looked for in the pair's folder first (default:
                         M.off, or else landmarks); a start made from landmarks is written, too
  --drift-bound B        in mean edges of R; inf: none; a negative number: the default
  --method arap          runs an as-rigid-as-possible deformation with a soft constraint to R, without
                         settings, time limit and check
)" +
  common_usage +
  R"(
distortion: of the triangles, half the sum of the squared norms of the Jacobian and of its inverse, Q
scaled to R's area (2 is isometric). flips, folds: faces inverted with respect to the reference, and edges folded
by more than 120 degrees. drift: largest distance of samples from the mesh to the reference and back (how
much of R is covered), in mean edges of the reference. n_out, n_in: outer iterations and patches per
iteration. map_s: seconds of the making of the start from landmarks. factorization_ms: time of one
factorization of the whole mesh' system, a unit of time; left out above 200000 vertices.
)";

const char* const landmarks_start = "landmarks";

bool exists(const std::string& file) { return bool(std::ifstream(file)); }

std::string default_start(const std::string& folder)
{
  return exists(folder + "/M.off") || !exists(folder + "/landmarks.txt") ? "M.off"
                                                                         : landmarks_start;
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

Pair read_pair(const std::string& folder, const std::string& start)
{
  Pair pair;
  pair.source = read(folder + "/Q.off");
  pair.reference = read(folder + "/R.off");
  if(start == landmarks_start)
  {
    const auto landmarks = read_landmarks(folder + "/landmarks.txt", pair.source, pair.reference);
    CGAL::Real_timer timer;
    timer.start();
    RCO::compatible_initial_mesh(pair.source, pair.reference, landmarks, pair.start);
    pair.map_seconds = timer.time();
  }
  else
    pair.start = read(exists(folder + "/" + start) ? folder + "/" + start : start);
  return pair;
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

// the guarantees that are violated, in words
std::string violated_guarantees(const Pair& pair,
                                const Mesh& output,
                                const Defects_in_and_out& defects,
                                std::size_t monotonicity_violations)
{
  const Mesh& input = pair.start;
  Violated_guarantees broken;
  const auto is_free = [&](Mesh::Vertex_index v) { return !input.is_border(v); };
  broken.check_run(input, output, pair.reference, defects, monotonicity_violations, is_free,
                   is_free);
  broken.add_if(output.number_of_vertices() != pair.source.number_of_vertices() ||
                  faces_of(output) != faces_of(pair.source),
                "connectivity differs from that of Q");
  return broken.text();
}

bool run(const Command_line& arguments, Row& row)
{
  const std::string folder = arguments.name(0, ""),
                    start = arguments.text("--start", default_start(folder));
  const Common_settings s(arguments);
  const Pair pair = read_pair(folder, start);
  const RCO::Drift drift_in = RCO::drift(pair.start, pair.reference);
  Mesh mesh = pair.start;
  Monotonicity_visitor visitor;
  RCO::Result r;
  if(s.method == "arap")
  {
    CGAL::Real_timer timer;
    timer.start();
    r.number_of_iterations = std::size_t(arap_baseline(pair.source, pair.reference, mesh));
    r.running_time = timer.time();
    r.status = RCO::Status::iteration_limit;
  }
  else
  {
    const auto optimize_with = [&](const auto& own) {
      return optimize(mesh, pair.reference, RCO::Compatible_remeshing_energy(pair.source),
                      with_common_settings(own, s, visitor), s);
    };
    const auto own = CGAL::parameters::developability_threshold(s.developability);
    const double bound = relative_drift_bound(arguments);
    r = bound < 0 ? optimize_with(own)
                  : optimize_with(own.drift_bound(bound * drift_in.reference_mean_edge_length));
  }
  const double memory = peak_memory();

  const std::string base = base_name(folder), start_name = base_name(start);
  row.add("pair", base);
  row.add("start", start_name);
  add_size(row, mesh);
  const auto np = CGAL::parameters::default_values();
  const RCO::internal::Mesh_copy reference =
    RCO::internal::read_measured_mesh(pair.reference, np, "reference");
  const double area = RCO::internal::surface_area(reference.mesh, reference.points);
  const auto distortion = [&](const Mesh& m) {
    return RCO::distortion_statistics(pair.source, m, np, np, area);
  };
  const RCO::Distortion_statistics out = distortion(mesh);
  row.add("distortion_mean_in", distortion(pair.start).mean);
  row.add("distortion_mean_out", out.mean);
  row.add("distortion_median", out.median);
  row.add("distortion_p99", out.percentile_99);
  row.add("distortion_max", out.maximum);
  const Defects_in_and_out defects = {RCO::orientation_defects(pair.start, pair.reference),
                                      RCO::orientation_defects(mesh, pair.reference)};
  add_flips_and_folds(row, defects);
  add_drift(row, drift_in, "_in");
  add_drift(row, RCO::drift(mesh, pair.reference), "_out");
  add_iterations(row, r);
  add_times(row, mesh, r.running_time);
  row.add("map_s", pair.map_seconds);
  row.add("peak_memory_mb", memory);

  write(mesh, s.output_folder, base + "_" + start_name);
  if(start == landmarks_start)
    write(pair.start, s.output_folder, base + "_start");
  return !s.check || add_check(row, s.method, [&]() {
    return violated_guarantees(pair, mesh, defects, visitor.violations);
  });
}

int main(int argc, char* argv[])
{
  return drive(argc, argv, usage, with_common_options({{"--start", true}, {"--drift-bound", true}}),
               run);
}
