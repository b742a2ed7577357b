// Optimizes meshes against their own shape and prints one row of figures for every mesh and every
// combination of settings. --help tells the rest.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/reference_constrained_optimize.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#if defined(__unix__) || defined(__APPLE__)
#define RCO_HAS_POSIX
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace RCO = CGAL::Reference_constrained_optimization;
typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;
typedef Mesh::Property_map<Mesh::Edge_index, bool> Edge_map;

enum Exit_code { ok = 0, violation = 1, failure = 2 };

// ---- settings ----------------------------------------------------------------------------------

struct Settings
{
  double exponent = 1;
  double developability = RCO::internal::Loop_parameters().selection.developability_threshold;
  int patch_size = RCO::internal::Loop_parameters().selection.maximum_patch_size;
  unsigned int iterations = unsigned(RCO::internal::Loop_parameters().number_of_iterations);
  double tolerance = RCO::internal::Loop_parameters().energy_tolerance;
  unsigned int seed = 0;
  double sharp_edges = 0; // degrees, 0 is off
  double time_limit = std::numeric_limits<double>::infinity();
};

struct Options
{
  std::vector<Settings> runs{Settings()};
  std::vector<std::string> files;
  std::string reference, format = "table", output_folder;
  bool parallel = false, plain = false, check = false;
};

const char* const usage =
  R"(usage: rco_benchmark [options] mesh...

Improves the minimum angle of every mesh (triangles; OFF, OBJ, PLY, STL) and prints one row for each
mesh and each combination of settings.

Settings; each takes a number or a list such as 0.1,0.25,0.6:
  --exponent S           factor in the exponent of the energy (default 1)
  --developability E     threshold for a face to join a patch
  --patch-size N         largest number of faces of a patch; 0: by the size of the mesh
  --iterations N         largest number of outer iterations
  --tolerance T          relative decrease of the energy per iteration that ends the run
  --seed N               random seed
  --sharp-edges ANGLE    fix edges whose normals differ by more than ANGLE degrees; 0 is off
  --time-limit S         seconds
Options:
  --reference FILE       optimize against this mesh instead of the mesh's own shape
  --parallel             use all threads (if built with TBB)
  --plain                the paper's method alone
  --check                verify what is promised; exit code 1 if it does not hold
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

std::vector<std::string> split_list(const std::string& text)
{
  std::vector<std::string> items(1);
  for(const char c : text)
    if(c == ',')
      items.emplace_back();
    else
      items.back() += c;
  return items;
}

double to_number(const std::string& option, const std::string& text)
{
  std::size_t used = 0;
  double value = 0;
  try
  {
    value = std::stod(text, &used);
  }
  catch(const std::logic_error&)
  {}
  if(used == 0 || used != text.size())
    throw std::invalid_argument(option + ": '" + text + "' is not a number");
  return value;
}

// replaces every run by one run for each value of the list
template <typename T>
void expand(std::vector<Settings>& runs,
            T Settings::*member,
            const std::string& option,
            const std::string& list)
{
  std::vector<Settings> expanded;
  for(const Settings& run : runs)
    for(const std::string& item : split_list(list))
    {
      const double value = to_number(option, item);
      if(!(value >= double(std::numeric_limits<T>::lowest()) &&
           value <= double((std::numeric_limits<T>::max)())) ||
         double(T(value)) != value)
        throw std::invalid_argument(option + ": '" + item + "' is out of range or not whole");
      expanded.push_back(run);
      expanded.back().*member = T(value);
    }
  runs = expanded;
}

Options parse(int argc, char* argv[])
{
  Options o;
  for(int i = 1; i < argc; ++i)
  {
    const std::string option = argv[i];
    const auto value = [&]() -> std::string {
      if(i + 1 == argc)
        throw std::invalid_argument(option + " needs a value");
      return argv[++i];
    };
    if(option == "-h" || option == "--help")
    {
      std::cout << usage;
      std::exit(ok);
    }
    else if(option == "--exponent")
      expand(o.runs, &Settings::exponent, option, value());
    else if(option == "--developability")
      expand(o.runs, &Settings::developability, option, value());
    else if(option == "--patch-size")
      expand(o.runs, &Settings::patch_size, option, value());
    else if(option == "--iterations")
      expand(o.runs, &Settings::iterations, option, value());
    else if(option == "--tolerance")
      expand(o.runs, &Settings::tolerance, option, value());
    else if(option == "--seed")
      expand(o.runs, &Settings::seed, option, value());
    else if(option == "--sharp-edges")
      expand(o.runs, &Settings::sharp_edges, option, value());
    else if(option == "--time-limit")
      expand(o.runs, &Settings::time_limit, option, value());
    else if(option == "--reference")
      o.reference = value();
    else if(option == "--format")
      o.format = value();
    else if(option == "-o" || option == "--output")
      o.output_folder = value();
    else if(option == "--parallel")
      o.parallel = true;
    else if(option == "--plain")
      o.plain = true;
    else if(option == "--check")
      o.check = true;
    else if(option[0] == '-')
      throw std::invalid_argument("unknown option " + option);
    else
      o.files.push_back(option);
  }
  if(o.files.empty())
    throw std::invalid_argument("no mesh given (--help tells more)");
  if(o.format != "table" && o.format != "csv" && o.format != "json")
    throw std::invalid_argument("--format must be table, csv or json");
#ifndef CGAL_LINKED_WITH_TBB
  if(o.parallel)
    throw std::invalid_argument("--parallel: this program was built without TBB");
#endif
  return o;
}

// ---- rows --------------------------------------------------------------------------------------

// A value of a row. The table shows the values of successive fields with the same heading together.
struct Field
{
  std::string key, heading, text;
  bool is_number;
  double number = 0;
};

class Row
{
public:
  void add(const std::string& key, const std::string& heading, const std::string& text)
  {
    m_fields.push_back({key, heading, text, false, 0});
  }
  void add(const std::string& key, const std::string& heading, double x, int digits = 0)
  {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, x);
    m_fields.push_back({key, heading, std::isfinite(x) ? text : "-", true, x});
  }

  void print_table(std::ostream& out, bool with_heading) const
  {
    std::string headings, values;
    for(std::size_t i = 0; i < m_fields.size();)
    {
      const std::string& heading = m_fields[i].heading;
      std::string value = m_fields[i].text;
      for(++i; i < m_fields.size() && m_fields[i].heading == heading; ++i)
        value += "/" + m_fields[i].text;
      append(headings, values, heading, value);
    }
    if(with_heading)
      out << headings << '\n';
    out << values << std::endl;
  }

  void print_csv(std::ostream& out, bool with_heading) const
  {
    if(with_heading)
      for(std::size_t i = 0; i < m_fields.size(); ++i)
        out << m_fields[i].key << (i + 1 < m_fields.size() ? "," : "\n");
    for(std::size_t i = 0; i < m_fields.size(); ++i)
      out << full(m_fields[i], "\"\"", "") << (i + 1 < m_fields.size() ? "," : "");
    out << std::endl;
  }

  void print_json(std::ostream& out) const
  {
    out << "  {";
    for(std::size_t i = 0; i < m_fields.size(); ++i)
      out << (i > 0 ? ", " : "") << '"' << m_fields[i].key
          << "\": " << full(m_fields[i], "\\\"", "null");
    out << "}" << std::flush;
  }

private:
  // columns start where those of the first row do, as far as the values allow
  static void append(std::string& headings,
                     std::string& values,
                     const std::string& heading,
                     const std::string& value)
  {
    static const std::vector<std::pair<std::string, std::size_t>> widths = {
      {"mesh", 20},         {"settings", 10}, {"V", 6},     {"F", 6},           {"theta in", 15},
      {"theta out", 15},    {"drift", 11},    {"flips", 7}, {"folds", 7},       {"status", 15},
      {"N_out", 5},         {"N_in", 6},      {"faces", 6}, {"accepted %", 10}, {"SD", 5},
      {"flattening %", 18}, {"stages %", 14}, {"s", 7},     {"T_F ms", 7},      {"time/T_F", 8},
      {"us/V", 6},          {"MB", 5}};
    std::size_t width = heading.size();
    for(const auto& w : widths)
      if(w.first == heading)
        width = w.second;
    width = (std::max)(width, heading.size());
    // numbers to the right; a value that is too long pushes the rest of its row
    const bool is_left = values.empty() || heading == "status" || heading == "settings";
    const auto padded = [&](const std::string& s) {
      const std::string fill(s.size() < width ? width - s.size() : 0, ' ');
      return is_left ? s + fill : fill + s;
    };
    headings += (headings.empty() ? "" : "  ") + padded(heading);
    values += (values.empty() ? "" : "  ") + padded(value);
  }

  // with all digits, for programs
  static std::string full(const Field& f, const std::string& escaped_quote, const std::string& none)
  {
    if(f.is_number)
    {
      char text[64];
      std::snprintf(text, sizeof text, "%.12g", f.number);
      return std::isfinite(f.number) ? text : none;
    }
    std::string quoted = "\"";
    for(const char c : f.text)
      if(c == '"')
        quoted += escaped_quote;
      else
        quoted += c;
    return quoted + "\"";
  }

  std::vector<Field> m_fields;
};

// ---- one run -----------------------------------------------------------------------------------

// counts accepted patches that do not lower (defects, energy) in lexicographic order
struct Monotonicity_visitor : RCO::Default_visitor
{
  std::size_t violations = 0;

  void on_patch_end(const RCO::Patch_report& r)
  {
    if(r.accepted && r.defects_after >= r.defects_before &&
       !(r.defects_after == r.defects_before && r.energy_after < r.energy_before))
      ++violations;
  }
};

double peak_memory() // in megabytes, of this process so far
{
#ifdef RCO_HAS_POSIX
  struct rusage r;
  getrusage(RUSAGE_SELF, &r);
#ifdef __APPLE__
  return double(r.ru_maxrss) / (1024 * 1024);
#else
  return double(r.ru_maxrss) / 1024;
#endif
#else
  return std::numeric_limits<double>::quiet_NaN();
#endif
}

Mesh read(const std::string& file)
{
  Mesh mesh;
  if(!CGAL::IO::read_polygon_mesh(file, mesh))
    throw std::runtime_error("cannot be read as a polygon mesh");
  return mesh;
}

std::string base_name(const std::string& file)
{
  const std::size_t slash = file.find_last_of("/\\"), start = slash + 1; // npos + 1 is 0
  const std::size_t dot = file.find_last_of('.');
  return file.substr(start, dot != std::string::npos && dot > start ? dot - start : dot);
}

const char* name(RCO::Status status)
{
  switch(status)
  {
  case RCO::Status::converged:
    return "converged";
  case RCO::Status::iteration_limit:
    return "iteration limit";
  case RCO::Status::time_limit:
    return "time limit";
  case RCO::Status::interrupted:
    return "interrupted";
  case RCO::Status::nothing_to_do:
    return "nothing to do";
  }
  return "";
}

RCO::Result optimize(Mesh& mesh,
                     const Mesh& reference,
                     const Edge_map& is_constrained,
                     const Settings& s,
                     const Options& o,
                     Monotonicity_visitor& visitor)
{
  namespace parameters = CGAL::parameters;
  const auto np = parameters::developability_threshold(s.developability)
                    .energy_tolerance(s.tolerance)
                    .maximum_patch_size(s.patch_size)
                    .use_on_surface_steps(!o.plain)
                    .use_finishing_stage(!o.plain)
                    .number_of_iterations(s.iterations)
                    .random_seed(s.seed)
                    .maximum_running_time(s.time_limit)
                    .edge_is_constrained_map(is_constrained)
                    .visitor(std::ref(visitor));
  const RCO::Minimum_angle_energy energy(s.exponent);
#ifdef CGAL_LINKED_WITH_TBB
  if(o.parallel)
    return CGAL::reference_constrained_optimize<CGAL::Parallel_tag>(mesh, reference, energy, np);
#endif
  return CGAL::reference_constrained_optimize(mesh, reference, energy, np);
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
  std::size_t moved = 0;
  for(const Mesh::Vertex_index v : input.vertices())
    moved += (is_fixed[v] || input.is_isolated(v)) && input.point(v) != output.point(v);
  const auto distance = RCO::distance_to_reference(
    output, reference, CGAL::parameters::default_values(), CGAL::parameters::default_values(),
    [&](Mesh::Vertex_index v) { return !is_fixed[v]; });

  std::vector<std::string> broken;
  if(monotonicity_violations > 0)
    broken.push_back(std::to_string(monotonicity_violations) + " patches not monotone");
  if(!distance.is_on_reference())
    broken.push_back("vertex " + std::to_string(distance.vertex) + " off the reference");
  if(moved > 0)
    broken.push_back(std::to_string(moved) + " fixed vertices moved");
  if(RCO::angle_statistics(output).minimum < RCO::angle_statistics(input).minimum)
    broken.push_back("minimum angle fell");
  if(RCO::orientation_defects(output, reference).total() >
     RCO::orientation_defects(input, reference).total())
    broken.push_back("flips and folds rose");
  std::string text;
  for(const std::string& b : broken)
    text += (text.empty() ? "" : "; ") + b;
  return text;
}

std::string describe(const Settings& s, const Options& o)
{
  const auto differs = [&](auto member) {
    for(const Settings& other : o.runs)
      if(other.*member != o.runs.front().*member)
        return true;
    return false;
  };
  std::ostringstream text;
  const auto add = [&](const char* key, auto member) {
    if(differs(member))
      text << (text.tellp() > 0 ? " " : "") << key << '=' << s.*member;
  };
  add("s", &Settings::exponent);
  add("e_d", &Settings::developability);
  add("size", &Settings::patch_size);
  add("it", &Settings::iterations);
  add("tol", &Settings::tolerance);
  add("seed", &Settings::seed);
  add("sharp", &Settings::sharp_edges);
  add("limit", &Settings::time_limit);
  return text.str();
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
  const RCO::Result r = optimize(mesh, reference, is_constrained, s, o, visitor);
  const double memory = peak_memory();
  double factorization = std::numeric_limits<double>::quiet_NaN();
  if(mesh.number_of_vertices() <= RCO::factorization_time_vertex_limit)
    factorization = RCO::factorization_time(mesh);

  std::string base = base_name(file);
  const std::string settings = describe(s, o);
  Row row;
  row.add("mesh", "mesh", base);
  if(o.runs.size() > 1)
    row.add("settings", "settings", settings);
  row.add("vertices", "V", double(mesh.number_of_vertices()));
  row.add("faces", "F", double(mesh.number_of_faces()));
  const auto add_angles = [&](const Mesh& m, const std::string& when) {
    const RCO::Angle_statistics a = RCO::angle_statistics(m);
    row.add("theta_min_" + when, "theta " + when, a.minimum, 2);
    row.add("theta_mean_" + when, "theta " + when, a.mean, 2);
    row.add("theta_std_" + when, "theta " + when, a.standard_deviation, 2);
  };
  add_angles(input, "in");
  add_angles(mesh, "out");
  const RCO::Drift drift = RCO::drift(mesh, reference);
  row.add("drift_mesh_to_reference", "drift", drift.relative_mesh_to_reference(), 3);
  row.add("drift_reference_to_mesh", "drift", drift.relative_reference_to_mesh(), 3);
  row.add("flips_in", "flips", double(r.initial_number_of_flips));
  row.add("flips_out", "flips", double(r.number_of_flips));
  row.add("folds_in", "folds", double(r.initial_number_of_fold_edges));
  row.add("folds_out", "folds", double(r.number_of_fold_edges));
  row.add("status", "status", name(r.status));

  const auto share = [](double part, double all) { return all > 0 ? 100 * part / all : 0; };
  const double patches = double(r.number_of_patches);
  const double flattened = double(r.conformal_flattenings + r.convex_border_flattenings);
  const double tried = flattened + double(r.failed_flattenings);
  row.add("n_out", "N_out", double(r.number_of_iterations));
  row.add("n_in", "N_in", r.number_of_iterations > 0 ? patches / double(r.number_of_iterations) : 0,
          1);
  row.add("mean_patch_size", "faces", patches > 0 ? r.sum_of_patch_sizes / patches : 0, 1);
  row.add("accepted_percent", "accepted %", share(double(r.number_of_accepted_patches), patches),
          1);
  row.add("conformal_percent", "flattening %", share(double(r.conformal_flattenings), tried), 1);
  row.add("convex_border_percent", "flattening %",
          share(double(r.convex_border_flattenings), tried), 1);
  row.add("failed_percent", "flattening %", share(double(r.failed_flattenings), tried), 1);
  row.add("overlapping_percent", "flattening %", share(double(r.overlapping_flattenings), tried),
          1);
  row.add("mean_flattening_distortion", "SD",
          flattened > 0 ? r.sum_of_flattening_distortion / flattened : 0, 2);
  const RCO::Stage_times& t = r.times;
  const double all = t.setup + t.selection + t.flattening + t.optimization + t.acceptance;
  row.add("setup_percent", "stages %", share(t.setup, all));
  row.add("selection_percent", "stages %", share(t.selection, all));
  row.add("flattening_percent", "stages %", share(t.flattening, all));
  row.add("optimization_percent", "stages %", share(t.optimization, all));
  row.add("acceptance_percent", "stages %", share(t.acceptance, all));
  row.add("time_s", "s", r.running_time, 2);
  row.add("factorization_ms", "T_F ms", 1e3 * factorization, 1);
  row.add("time_over_factorization", "time/T_F", r.running_time / factorization, 1);
  row.add("us_per_vertex", "us/V", 1e6 * r.running_time / double(mesh.number_of_vertices()), 1);
  row.add("peak_memory_mb", "MB", memory, 0);

  if(o.check)
  {
    const std::string broken =
      broken_promises(input, mesh, reference, is_constrained, visitor.violations);
    holds = broken.empty();
    row.add("violations", "violations", holds ? "none" : broken);
  }
  if(!o.output_folder.empty())
  {
    if(!settings.empty())
      base += "_" + settings;
    for(char& c : base)
      c = c == ' ' ? '_' : c;
    const std::string path = o.output_folder + "/" + base + ".off";
    std::ofstream out(path);
    out.precision(17);
    if(!out || !CGAL::IO::write_OFF(out, mesh))
      throw std::runtime_error("cannot write " + path);
  }
  return row;
}

// runs, prints and says how it went
Exit_code run_and_print(const std::string& file, const Settings& s, const Options& o, bool is_first)
{
  try
  {
    bool holds = true;
    const Row row = run(file, s, o, holds);
    if(o.format == "json")
    {
      std::cout << (is_first ? "" : ",\n");
      row.print_json(std::cout);
    }
    else if(o.format == "csv")
      row.print_csv(std::cout, is_first);
    else
      row.print_table(std::cout, is_first);
    return holds ? ok : violation;
  }
  catch(const std::exception& e)
  {
    std::cerr << file << ": " << e.what() << std::endl;
    return failure;
  }
}

// in a process of its own where that is possible: memory is that of the run, and a crash costs no
// more than its row
Exit_code run_apart(const std::string& file, const Settings& s, const Options& o, bool is_first)
{
#ifdef RCO_HAS_POSIX
  std::cout << std::flush;
  const pid_t child = fork();
  if(child == 0)
    std::_Exit(run_and_print(file, s, o, is_first));
  int state = 0;
  if(child > 0 && waitpid(child, &state, 0) == child)
  {
    if(WIFEXITED(state))
      return Exit_code(WEXITSTATUS(state));
    std::cerr << file << ": ended by signal " << WTERMSIG(state) << std::endl;
    return failure;
  }
#endif
  return run_and_print(file, s, o, is_first);
}

int main(int argc, char* argv[])
{
  try
  {
    const Options options = parse(argc, argv);
    int worst = ok;
    bool is_first = true;
    if(options.format == "json")
      std::cout << "[\n";
    for(const std::string& file : options.files)
      for(const Settings& settings : options.runs)
      {
        const Exit_code code = run_apart(file, settings, options, is_first);
        is_first = is_first && code == failure;
        worst = (std::max)(worst, int(code));
      }
    if(options.format == "json")
      std::cout << "\n]" << std::endl;
    return worst;
  }
  catch(const std::invalid_argument& e)
  {
    std::cerr << "rco_benchmark: " << e.what() << std::endl;
    return failure;
  }
}
