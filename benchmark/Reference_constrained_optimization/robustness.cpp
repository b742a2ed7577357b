// Runs the package on all meshes of a folder and on small inputs with something wrong, each in other
// units, far away and with noise, and tells how every run ended. --help tells the rest.

#include "Soup.h"
#include "bounded_processes.h"
#include "checked_run.h"
#include "nasty_inputs.h"
#include "outcome.h"
#include "settings.h"
#include "variants.h"

#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

const char* const usage =
  R"(usage: robustness [options] [folder or mesh]...

Optimizes every mesh (OFF, OBJ, PLY, STL; by default those of CGAL) and small generated inputs with
something wrong: as they are, times 2^-20, 2^20, 1e-6 and 1e6, translated by 1e6 diagonals, with another
random seed, and with random noise of up to 0.3 mean edges against the mesh without it. Each run has a process of its own. How it ended is
compared with what is expected, and what the package promises is verified. Times a power of two all
digits of the smallest angles must be the same. How far they change in other units and far away is told,
beside what another random seed does. Markdown tables and a list of all that is not as expected go to the
standard output.

Options:
  --generated            only the generated inputs
  --files                only meshes from files
  --filter TEXT          only inputs whose name contains TEXT
  --variants LIST        of: as is, times 2^-20, times 2^20, times 1e-6, times 1e6,
                         1e6 diagonals away, another seed, noise
  --max-faces N          leave larger meshes out (default 30000)
  --time-limit S         seconds of processor time of a run (default 120)
  --memory-limit MB      address space of a run (default 4096)
  --processes N          runs at once (default 1)
  --flattened            without on-surface steps and finishing stage
  --relax-constraints    vertices slide along borders
  --list                 a row for each run, too
  -h, --help             this text

Exit code: 0, 1 if a run was not as expected, 2 if an option could not be used.
)";

struct Robustness_options
{
  std::vector<std::string> paths, variant_names;
  std::string filter;
  bool generated = true, files = true, lists = false;
  std::size_t max_faces = 30000;
  Process_bounds bounds;
  int processes = 1;
  Run_settings settings;
};

Robustness_options parse(int argc, char* argv[])
{
  Robustness_options o;
  for(int i = 1; i < argc; ++i)
  {
    const std::string option = argv[i];
    const auto value = [&]() -> std::string {
      if(i + 1 >= argc)
        throw std::invalid_argument(option + " needs a value");
      return argv[++i];
    };
    const auto positive = [&]() {
      const double x = to_number(option, value());
      if(!(x >= 1 && x < 1e9))
        throw std::invalid_argument(option + " must be between 1 and 1e9");
      return x;
    };
    if(option == "-h" || option == "--help")
    {
      std::cout << usage;
      std::exit(EXIT_SUCCESS);
    }
    else if(option == "--generated")
      o.files = false;
    else if(option == "--files")
      o.generated = false;
    else if(option == "--filter")
      o.filter = value();
    else if(option == "--variants")
      o.variant_names = split_list(value());
    else if(option == "--max-faces")
      o.max_faces = std::size_t(positive());
    else if(option == "--time-limit")
      o.bounds.seconds = positive();
    else if(option == "--memory-limit")
      o.bounds.megabytes = positive();
    else if(option == "--processes")
      o.processes = int(positive());
    else if(option == "--flattened")
      o.settings.on_surface = o.settings.finishing = false;
    else if(option == "--relax-constraints")
      o.settings.relax_constraints = true;
    else if(option == "--list")
      o.lists = true;
    else if(option[0] == '-')
      throw std::invalid_argument("unknown option " + option);
    else
      o.paths.push_back(option);
  }
  for(const std::string& wanted : o.variant_names)
    if(std::none_of(variants.begin(), variants.end(),
                    [&](const Variant& v) { return v.name == wanted; }))
      throw std::invalid_argument("--variants: there is no '" + wanted + "'");
  if(o.paths.empty())
    o.paths.push_back(RCO_DATA_DIR);
  return o;
}

#ifdef RCO_HAS_POSIX

// a mesh from a file
struct File_input
{
  std::string path, name;
  bool is_triangulated = false; // its polygons are split before the run
};

// one run
struct Job
{
  const Nasty_input* nasty; // or, if null, a file
  File_input file;
  Variant variant;
  std::string name() const { return nasty ? nasty->name : file.name; }
};

struct Job_figures : Run_figures
{
  bool is_expected = false;
};

struct Finished_job
{
  Outcome outcome = Outcome::crash;
  Job_figures figures;
  std::string text;
};

struct Survey
{
  std::size_t number_of_faces = 0;
  bool is_readable = false, is_repaired = false, has_polygons = false;
};

// Files that hold no half-edge mesh as they stand get their faces oriented and vertices and edges that
// are not manifold split, as CGAL's reader of polygon soups does.
bool read_or_repair(const std::string& path, Mesh& mesh, bool& is_repaired)
{
  is_repaired = !CGAL::IO::read_polygon_mesh(path, mesh);
  if(!is_repaired)
    return true;
  mesh.clear();
  return CGAL::Polygon_mesh_processing::IO::read_polygon_mesh(path, mesh);
}

Mesh read(const File_input& file)
{
  Mesh mesh;
  bool is_repaired = false;
  if(!read_or_repair(file.path, mesh, is_repaired))
    throw std::runtime_error("cannot be read as a mesh");
  if(file.is_triangulated && !CGAL::Polygon_mesh_processing::triangulate_faces(mesh))
    throw std::runtime_error("cannot be triangulated");
  return mesh;
}

// by other means than the package's own
Expectation expected_of_file(const Mesh& mesh)
{
  namespace PMP = CGAL::Polygon_mesh_processing;
  if(mesh.number_of_faces() == 0)
    return is_refused("mesh: the mesh has no face");
  for(const Mesh::Face_index f : mesh.faces())
    if(mesh.degree(f) > 4)
      return is_refused("mesh: face " + std::to_string(f) + " has ");
  std::vector<Mesh::Halfedge_index> nonmanifold;
  PMP::non_manifold_vertices(mesh, std::back_inserter(nonmanifold));
  if(!nonmanifold.empty())
    return is_refused("mesh: vertex ");
  if(!CGAL::is_triangle_mesh(mesh))
    return is_refused("Minimum_angle_energy: face ");
  if(!(PMP::area(mesh) > 0))
    return is_refused("reference: every face has zero area");
  return is_optimized();
}

// in a process of its own
int run(const Job& job, const Robustness_options& o, Job_figures& figures, std::string& text)
{
  Mesh mesh, reference;
  bool has_reference = job.variant.noise > 0;
  Expectation expected;
  try
  {
    if(job.nasty)
    {
      expected = has_reference ? job.nasty->expected_with_noise : job.nasty->expected;
      mesh = to_mesh(job.nasty->mesh);
      reference = job.nasty->has_reference ? to_mesh(job.nasty->reference) : mesh;
      has_reference = has_reference || job.nasty->has_reference;
    }
    else
    {
      expected = is(Outcome::no_mesh);
      mesh = reference = read(job.file);
      expected = expected_of_file(mesh);
    }
  }
  catch(const std::exception& e)
  {
    text = e.what();
    figures.is_expected = expected.is_met(Outcome::no_mesh, text);
    return int(Outcome::no_mesh);
  }
  if(o.settings.relax_constraints &&
     expected.outcomes == std::vector<Outcome>{Outcome::nothing_to_do})
    expected = is_optimized(); // borders may have something to do
  const double size = diagonal(reference);
  apply(job.variant, size, mesh, !has_reference, 1);
  apply(job.variant, size, reference, true, 1);
  Run_settings settings = o.settings;
  settings.seed = job.variant.seed;
  const Outcome outcome =
    checked_run(mesh, has_reference ? &reference : nullptr,
                job.nasty ? job.nasty->is_constrained : std::function<bool(std::size_t)>(),
                settings, figures, text);
  figures.is_expected = expected.is_met(outcome, text);
  if(!figures.is_expected)
    text += (text.empty() ? "expected: " : "; expected: ") + expected.text();
  return int(outcome);
}

bool is_wanted(const Robustness_options& o, const std::string& name)
{
  return name.find(o.filter) != std::string::npos;
}

std::vector<File_input> find_files(const Robustness_options& o)
{
  namespace fs = std::filesystem;
  const std::vector<std::string> extensions = {".off", ".obj", ".ply", ".stl", ".OFF"};
  std::vector<File_input> files;
  const auto add = [&](const fs::path& path) {
    const std::string name = path.filename().string();
    if(std::find(extensions.begin(), extensions.end(), path.extension().string()) !=
         extensions.end() &&
       is_wanted(o, name))
      files.push_back({path.string(), name});
  };
  for(const std::string& path : o.paths)
    if(fs::is_directory(path))
      for(const fs::directory_entry& entry : fs::recursive_directory_iterator(path))
        add(entry.path());
    else if(fs::exists(path))
      add(path);
    else
      throw std::invalid_argument("there is no " + path);
  std::sort(files.begin(), files.end(),
            [](const File_input& a, const File_input& b) { return a.path < b.path; });
  return files;
}

// how runs ended, for the reader
class Outcome_table
{
public:
  void add(const Job& job, const Finished_job& f)
  {
    ++m_counts[job.nasty != nullptr][job.variant.name][f.outcome];
    if(f.outcome == Outcome::refused)
      ++m_refusals[reason(f.text)];
  }
  void print(std::ostream& out) const
  {
    for(const auto& kind : m_counts)
    {
      out << "\n" << (kind.first ? "Generated inputs" : "Meshes from files");
      for(const Named_outcome& n : all_outcomes)
        out << " | " << n.name;
      out << "\n---";
      for(std::size_t i = 0; i < all_outcomes.size(); ++i)
        out << "|--:";
      out << "\n";
      for(const Variant& v : variants)
      {
        const auto row = kind.second.find(v.name);
        if(row == kind.second.end())
          continue;
        out << v.name;
        for(const Named_outcome& n : all_outcomes)
        {
          const auto count = row->second.find(n.outcome);
          out << " | " << (count == row->second.end() ? 0 : count->second);
        }
        out << "\n";
      }
    }
    if(m_refusals.empty())
      return;
    out << "\nRefused because | runs\n---|--:\n";
    for(const auto& r : m_refusals)
      out << r.first << " | " << r.second << "\n";
  }

private:
  // the message without its numbers and details
  static std::string reason(const std::string& text)
  {
    std::string words;
    for(const char c : text.substr(0, text.find_first_of(",;(")))
      if(!std::isdigit((unsigned char)c))
        words += c;
      else if(words.empty() || words.back() != 'N')
        words += 'N';
    for(std::size_t i = 0; (i = words.find("N.N")) != std::string::npos;)
      words.erase(i, 2);
    return words;
  }

  std::map<bool, std::map<std::string, std::map<Outcome, int>>> m_counts; // by kind and variant
  std::map<std::string, int> m_refusals;
};

// Smallest angles of the faces beside those of the run of the same input as it is.
class Angle_table
{
public:
  void add(const Variant& variant, const Run_figures& as_is, const Run_figures& f)
  {
    Line& line = m_lines[variant.name];
    ++line.runs;
    line.minimum_changed += std::abs(f.angle_minimum_out - as_is.angle_minimum_out) >= 0.1;
    line.mean_changed += std::abs(f.angle_mean_out - as_is.angle_mean_out) >= 0.1;
    line.changes.push_back((std::max)(std::abs(as_is.angle_minimum_out - f.angle_minimum_out),
                                      std::abs(as_is.angle_mean_out - f.angle_mean_out)));
    line.minimum += f.angle_minimum_out - as_is.angle_minimum_out;
    line.mean += f.angle_mean_out - as_is.angle_mean_out;
  }
  void print(std::ostream& out) const
  {
    if(m_lines.empty())
      return;
    out
      << "\nAngles against the run as is | runs | minimum changed by 0.1 degrees | mean changed | "
         "median change | largest | minimum gains on average | mean gains on average\n"
         "---|--:|--:|--:|--:|--:|--:|--:\n";
    for(const Variant& v : variants)
    {
      const auto found = m_lines.find(v.name);
      if(found == m_lines.end())
        continue;
      const Line& line = found->second;
      std::vector<double> changes = line.changes;
      std::sort(changes.begin(), changes.end());
      char text[200];
      std::snprintf(text, sizeof text, " | %d | %d | %d | %.3f | %.2f | %.2f | %.2f\n", line.runs,
                    line.minimum_changed, line.mean_changed, changes[changes.size() / 2],
                    changes.back(), line.minimum / line.runs, line.mean / line.runs);
      out << v.name << text;
    }
  }

private:
  struct Line
  {
    int runs = 0, minimum_changed = 0, mean_changed = 0;
    std::vector<double> changes;
    double minimum = 0, mean = 0;
  };
  std::map<std::string, Line> m_lines;
};

int run_all(const Robustness_options& o)
{
  std::vector<Job> jobs;
  std::vector<std::string> left_out, repaired;
  const auto add_variants = [&](const Nasty_input* nasty, const File_input& file) {
    for(const Variant& v : variants)
      if(o.variant_names.empty() ||
         std::find(o.variant_names.begin(), o.variant_names.end(), v.name) != o.variant_names.end())
        jobs.push_back({nasty, file, v});
  };

  const std::vector<Nasty_input> nasty = o.generated ? nasty_inputs() : std::vector<Nasty_input>();
  for(const Nasty_input& input : nasty)
    if(is_wanted(o, input.name))
      add_variants(&input, {});

  if(o.files)
  {
    const std::vector<File_input> files = find_files(o);
    std::vector<Survey> surveys(files.size());
    run_bounded<Survey>(
      int(files.size()), o.processes, o.bounds,
      [&](int i, Survey& survey, std::string&) {
        Mesh mesh;
        survey.is_readable = read_or_repair(files[i].path, mesh, survey.is_repaired);
        survey.number_of_faces = mesh.number_of_faces();
        survey.has_polygons = !CGAL::is_triangle_mesh(mesh);
        return int(ok);
      },
      [&](int i, const Ended_process<Survey>& ended) { surveys[i] = ended.value; });
    std::vector<std::size_t> order;
    for(std::size_t i = 0; i < files.size(); ++i)
      if(surveys[i].is_repaired && surveys[i].is_readable)
        repaired.push_back(files[i].name);
    for(std::size_t i = 0; i < files.size(); ++i)
      if(surveys[i].number_of_faces > o.max_faces)
        left_out.push_back(files[i].name + " (" + std::to_string(surveys[i].number_of_faces) +
                           " faces)");
      else
        order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return surveys[a].number_of_faces < surveys[b].number_of_faces;
    });
    for(const std::size_t i : order)
    {
      File_input file = files[i];
      add_variants(nullptr, file);
      if(surveys[i].is_readable && surveys[i].number_of_faces > 0 && surveys[i].has_polygons)
      {
        file.is_triangulated = true;
        file.name += ", triangulated";
        add_variants(nullptr, file);
      }
    }
  }

  std::vector<Finished_job> finished(jobs.size());
  Outcome_table outcomes;
  std::vector<std::string> unexpected;
  const auto where = [&](std::size_t i) {
    return jobs[i].name() + " (" + jobs[i].variant.name + ")";
  };
  if(o.lists)
    std::cout << "input | variant | faces | outcome | min, mean angle before | after | s |\n"
              << "---|---|--:|---|---|---|--:|---\n";
  run_bounded<Job_figures>(
    int(jobs.size()), o.processes, o.bounds,
    [&](int i, Job_figures& figures, std::string& text) { return run(jobs[i], o, figures, text); },
    [&](int i, const Ended_process<Job_figures>& ended) {
      Finished_job& f = finished[i];
      f.figures = ended.value;
      f.text = ended.text;
      if(ended.signal == 0 && is_outcome(ended.exit_code))
        f.outcome = Outcome(ended.exit_code);
      else
      {
        f.figures.is_expected = false;
        f.outcome = is_time_out(ended.signal) ? Outcome::time_out : Outcome::crash;
        f.text = ended.signal != 0 ? "signal " + std::to_string(ended.signal)
                                   : "exit code " + std::to_string(ended.exit_code);
      }
      outcomes.add(jobs[i], f);
      if(!f.figures.is_expected)
        unexpected.push_back(where(i) + ": " + name(f.outcome) + ": " + f.text);
      if(o.lists)
      {
        char figures[200];
        std::snprintf(figures, sizeof figures, "%.2f %.2f | %.2f %.2f | %.2f",
                      f.figures.angle_minimum_in, f.figures.angle_mean_in,
                      f.figures.angle_minimum_out, f.figures.angle_mean_out, f.figures.seconds);
        std::cout << jobs[i].name() << " | " << jobs[i].variant.name << " | "
                  << f.figures.number_of_faces << " | " << name(f.outcome) << " | " << figures
                  << " | " << f.text << std::endl;
      }
    });

  const auto has_angles = [](const Finished_job& f) {
    return f.outcome == Outcome::improved || f.outcome == Outcome::nothing_to_do;
  };
  Angle_table angles;
  int fallen = 0;
  std::size_t as_is = jobs.size(); // the last run of an input as it is
  for(std::size_t i = 0; i < jobs.size(); ++i)
  {
    if(is_as_is(jobs[i].variant))
      as_is = i;
    if(!has_angles(finished[i]))
      continue;
    const Job_figures& f = finished[i].figures;
    fallen += f.angle_mean_out < f.angle_mean_in - 1;
    if(as_is >= i || jobs[as_is].name() != jobs[i].name() || jobs[i].variant.noise > 0 ||
       !has_angles(finished[as_is]))
      continue;
    const Run_figures& first = finished[as_is].figures;
    angles.add(jobs[i].variant, first, f);
    if(is_exact(jobs[i].variant) &&
       (f.angle_minimum_out != first.angle_minimum_out || f.angle_mean_out != first.angle_mean_out))
      unexpected.push_back(where(i) + ": other angles than as is");
  }

  outcomes.print(std::cout);
  angles.print(std::cout);
  std::cout << "\nThe mean of the smallest angles fell by more than a degree, for the sake of the "
               "worst, in "
            << fallen << " runs.\n";
  const auto print = [](const std::string& what, const std::vector<std::string>& list) {
    if(list.empty())
      return;
    std::cout << "\n" << what << ": " << list.size() << "\n";
    for(const std::string& s : list)
      std::cout << "- " << s << "\n";
  };
  print("Oriented and split where they are not manifold, to be read at all", repaired);
  print("Left out, more than " + std::to_string(o.max_faces) + " faces", left_out);
  print("Not as expected", unexpected);
  if(unexpected.empty())
    std::cout << "\nAll is as expected.\n";
  std::cout << std::flush;
  return unexpected.empty() ? ok : violation;
}

#else

int run_all(const Robustness_options&)
{
  throw std::invalid_argument("this program needs a system with fork()");
}

#endif

int main(int argc, char* argv[])
{
  try
  {
    return run_all(parse(argc, argv));
  }
  catch(const std::exception& e)
  {
    std::cerr << "robustness: " << e.what() << std::endl;
    return failure;
  }
}
