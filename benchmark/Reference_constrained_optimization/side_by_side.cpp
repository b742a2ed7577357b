// Runs the package and its peers on the same meshes, prints a row of figures for each, and draws
// charts. --help tells the rest.

#include "Figures.h"
#include "meshes.h"
#include "peers.h"
#include "report.h"
#include "result_apart.h"
#include "run_apart.h"
#include "settings.h"
#include "svg_scatter.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

const char* const usage =
  R"(usage: side_by_side [options] mesh...

Improves the minimum angle of every mesh (triangles; OFF, OBJ, PLY, STL) against its own shape, border
fixed, by the package and by other methods, and prints one row for each mesh and method.

Options:
  --methods LIST         of those below; the input and the package are always there (default: all)
  --time-limit S         seconds for each method on each mesh (default 600); a method that has not
                         ended by itself a while after that is ended
  --format F             table, csv or json
  -o, --output DIR       also write the rows (side_by_side.csv, side_by_side.json) and the charts
                         (angles.svg, drift.svg) into this folder, which must exist
  --meshes               with -o: and the resulting meshes (OFF)
  --check                exit code 1 if a peer is better than the package
  -h, --help             this text

Methods:
  plain          the paper's pipeline: flattened patches alone, drift not limited
  stars1         vertex by vertex, a Newton step in the tangent plane on the logarithm of the star's
                 energy (Gauss-Seidel, 50 sweeps), the paper's exponent
  stars10        the same with ten times the exponent
  soft           distances to the reference as a penalty with a rising weight (L-BFGS)
  angles         CGAL's angle smoothing
  angles_safe    the same with its safety constraints
  relax          CGAL's tangential relaxation, projected after each iteration
  relax_guarded  the same; no move may lower the smallest angle of a star or turn a face of it
  remesh         CGAL's isotropic remeshing: it changes the connectivity
Angle smoothing and relaxation are run for 1, 5, 10, 20 and 50 iterations; the row is that with the
largest minimum angle (of equals, with the largest mean), and its time alone counts.

Exit code: 0, 1 if a check failed, 2 if a mesh or an option could not be used.

Columns. theta: smallest angle per face, in degrees (min/mean/std). below 10..40: faces whose smallest
angle is. drift: largest distance of samples from the mesh to the reference and back, and the larger
root mean square, in mean edges of the reference. turn: by how much faces are turned against the
reference, in degrees (mean over the area), and percent of the area in faces turned by more than 20 and
45. kept, added: sharp edges that are left, and new ones, over the length that there was. flips, folds: faces turned against the reference,
and edges folded by more than 120 degrees. crossings: pairs of faces that intersect. off R: largest
distance of a vertex from the reference over the diagonal. bound: estimate of the largest minimum angle
that the connectivity allows. run: how it ended; CGAL's safe angle smoothing may stop off the
reference, and is projected then. s: processor time. T_F: time of one factorization of the whole mesh'
system, a yardstick for the time; left out above 200000 vertices. better: who is better, that is, not
worse in theta (min and mean), drift, flips and folds, better in one of them, at no more time; methods
that change the connectivity are exempt. wins: the columns in which the method is ahead of the package.
)";

struct Options
{
  std::vector<std::string> files, methods;
  std::string format = "table", folder;
  double time_limit = 600;
  bool writes_meshes = false, checks = false;
};

Options parse(int argc, char* argv[], const std::vector<Peer>& peers)
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
      std::exit(EXIT_SUCCESS);
    }
    else if(option == "--methods")
      o.methods = split_list(value());
    else if(option == "--time-limit")
      o.time_limit = to_number(option, value());
    else if(option == "--format")
      o.format = value();
    else if(option == "-o" || option == "--output")
      o.folder = value();
    else if(option == "--meshes")
      o.writes_meshes = true;
    else if(option == "--check")
      o.checks = true;
    else if(option[0] == '-')
      throw std::invalid_argument("unknown option " + option);
    else
      o.files.push_back(option);
  }
  if(o.files.empty())
    throw std::invalid_argument("no mesh given (--help tells more)");
  if(o.format != "table" && o.format != "csv" && o.format != "json")
    throw std::invalid_argument("--format must be table, csv or json");
  if(!(o.time_limit > 0))
    throw std::invalid_argument("--time-limit must be positive");
  if(o.writes_meshes && o.folder.empty())
    throw std::invalid_argument("--meshes needs a folder (--output)");
  for(const std::string& method : o.methods)
    if(std::none_of(peers.begin(), peers.end(), [&](const Peer& p) { return p.key == method; }))
      throw std::invalid_argument("--methods: there is no " + method);
  return o;
}

// a method's figures on a mesh; `text` says how the run went
Result_apart<Figures> run(const std::string& file, const Peer& peer, const Options& o)
{
  return call_apart<Figures>([&](std::string& text) {
    const Mesh input = read(file);
    const double grace = 10;
    set_alarm(1.5 * o.time_limit + grace);
    const Peer_result result = peer.run(input, o.time_limit);
    set_alarm(std::numeric_limits<double>::infinity());
    Figures figures = measure(result.mesh, input);
    figures.seconds = result.seconds;
    text = result.note;
    if(o.writes_meshes)
      write(result.mesh, o.folder, base_name(file) + "_" + peer.key);
    return figures;
  });
}

struct Verdict
{
  std::string better, wins;
};

Verdict compare(const Peer& peer, const Figures& figures, const Figures& package)
{
  const Comparison to_package(figures, package), to_peer(package, figures);
  if(!peer.keeps_connectivity)
    return {"exempt", to_package.wins()};
  return {to_package.is_better() ? "peer"
          : to_peer.is_better()  ? "package"
                                 : "neither",
          to_package.wins()};
}

Row make_row(const std::string& file,
             const Peer& peer,
             const Result_apart<Figures>& result,
             const Verdict& verdict)
{
  const Figures& f = result.value;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto known = [&](double x) { return result.has_value ? x : nan; };
  Row row;
  row.add("mesh", "mesh", base_name(file));
  row.add("vertices", "V", known(f.number_of_vertices));
  row.add("method", "optimized by", peer.name);
  row.add("theta_min", "theta", known(f.angles.minimum), 2);
  row.add("theta_mean", "theta", known(f.angles.mean), 2);
  row.add("theta_std", "theta", known(f.angles.standard_deviation), 2);
  row.add("below_10", "below 10..40", known(double(f.angles.number_below_10)));
  row.add("below_20", "below 10..40", known(double(f.angles.number_below_20)));
  row.add("below_30", "below 10..40", known(double(f.angles.number_below_30)));
  row.add("below_40", "below 10..40", known(double(f.angles.number_below_40)));
  row.add("drift_mesh_to_reference", "drift, rms", known(f.drift.relative_mesh_to_reference()), 2);
  row.add("drift_reference_to_mesh", "drift, rms", known(f.drift.relative_reference_to_mesh()), 2);
  row.add("drift_rms", "drift, rms", known(f.drift.relative_root_mean_square()), 3);
  row.add("turn_mean", "turn, >20, >45 %", known(f.turn.mean), 2);
  row.add("turned_above_20", "turn, >20, >45 %", known(100 * f.turn.share_above_20), 2);
  row.add("turned_above_45", "turn, >20, >45 %", known(100 * f.turn.share_above_45), 2);
  row.add("sharp_edges_kept", "kept, added", known(f.features.kept), 3);
  row.add("sharp_edges_added", "kept, added", known(f.features.added), 3);
  row.add("flips", "flips", known(double(f.defects.number_of_flips)));
  row.add("folds", "folds", known(double(f.defects.number_of_fold_edges)));
  row.add("self_intersecting_pairs", "crossings", known(f.self_intersecting_pairs));
  row.add_small("off_reference", "off R", known(f.off_reference));
  row.add("bound", "bound", known(f.largest_minimum_angle), 1);
  row.add("time_s", "s", known(f.seconds), 2);
  row.add("factorization_ms", "T_F ms", known(1e3 * f.factorization), 1);
  row.add("time_over_factorization", "time/T_F", known(f.seconds / f.factorization), 1);
  row.add("note", "run", result.text);
  row.add("better", "better", verdict.better);
  row.add("wins", "wins", verdict.wins);
  return row;
}

void print(std::ostream& out, const std::string& format, const Row& row, bool is_first)
{
  if(format == "json")
  {
    out << (is_first ? "[\n" : ",\n");
    row.print_json(out);
  }
  else if(format == "csv")
    row.print_csv(out, is_first);
  else
    row.print_table(out, is_first);
}

// how the methods look in the charts
std::vector<Svg_scatter::Series> chart_series(const std::vector<Peer>& peers)
{
  struct Look
  {
    const char *key, *color;
    char mark;
    bool is_filled;
  };
  const Look looks[] = {{"input", "#888888", 'x', false},  {"package", "#d1202f", 'o', true},
                        {"plain", "#d1202f", 'o', false},  {"stars1", "#1f5fb4", 's', false},
                        {"stars10", "#1f5fb4", 's', true}, {"soft", "#2a8f4f", 'd', true},
                        {"angles", "#e08214", '^', false}, {"angles_safe", "#e08214", '^', true},
                        {"relax", "#7b4ba0", 'v', false},  {"relax_guarded", "#7b4ba0", 'v', true},
                        {"remesh", "#00a0a8", '+', false}};
  std::vector<Svg_scatter::Series> series;
  for(const Peer& peer : peers)
    for(const Look& look : looks)
      if(look.key == peer.key)
        series.push_back(
          {peer.name, look.color, look.mark, look.is_filled, peer.key == "package" ? 5.0 : 3.2});
  return series;
}

class Charts
{
public:
  explicit Charts(const std::vector<Peer>& peers) : m_peers(peers) {}

  void start_mesh(const std::string& name)
  {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    m_angles.push_back({name, {}, nan});
    m_drift.push_back({name, {}, nan});
  }

  void add(std::size_t peer, const Figures& f)
  {
    if(m_peers[peer].keeps_connectivity)
      m_angles.back().line = m_drift.back().line = f.largest_minimum_angle;
    m_angles.back().points.push_back({peer, f.angles.mean, f.angles.minimum});
    // drift says nothing of the mesh as it was
    if(m_peers[peer].key != "input")
      m_drift.back().points.push_back({peer, f.drift.relative_maximum(), f.angles.minimum});
  }

  void write(const std::string& folder) const
  {
    const std::vector<Svg_scatter::Series> series = chart_series(m_peers);
    const std::string smallest = "smallest angle (degrees)";
    const std::string bound = "estimate of the connectivity's bound";
    Svg_scatter({"Smallest angle against mean: up and right is better",
                 "mean over the faces (degrees)", smallest, bound},
                series, package_first(m_angles))
      .write(folder + "/angles.svg");
    const double floor = 0.05;
    Svg_scatter({"Smallest angle against drift: up and left is better", "drift (mean edges)",
                 smallest, bound},
                series, package_first(m_drift), floor)
      .write(folder + "/drift.svg");
  }

private:
  // its large mark is drawn below all others
  std::vector<Svg_scatter::Panel> package_first(std::vector<Svg_scatter::Panel> panels) const
  {
    for(Svg_scatter::Panel& panel : panels)
      std::stable_partition(
        panel.points.begin(), panel.points.end(),
        [&](const Svg_scatter::Point& p) { return m_peers[p.series].key == "package"; });
    return panels;
  }

  const std::vector<Peer>& m_peers;
  std::vector<Svg_scatter::Panel> m_angles, m_drift;
};

// where all rows go
class Output
{
public:
  explicit Output(const Options& o) : m_format(o.format)
  {
    if(o.folder.empty())
      return;
    for(const char* format : {"csv", "json"})
    {
      const std::string path = o.folder + "/side_by_side." + format;
      m_files.push_back({format, std::make_unique<std::ofstream>(path)});
      if(!*m_files.back().out)
        throw std::invalid_argument("cannot write " + path);
    }
  }

  void add(const Row& row)
  {
    print(std::cout, m_format, row, m_is_first);
    for(File& file : m_files)
      print(*file.out, file.format, row, m_is_first);
    m_is_first = false;
  }

  void finish()
  {
    const char* const end = m_is_first ? "[\n]\n" : "\n]\n";
    if(m_format == "json")
      std::cout << end << std::flush;
    for(File& file : m_files)
      if(file.format == "json")
        *file.out << end << std::flush;
  }

private:
  struct File
  {
    std::string format;
    std::unique_ptr<std::ofstream> out;
  };

  std::string m_format;
  std::vector<File> m_files;
  bool m_is_first = true;
};

std::vector<Peer> chosen_peers(const std::vector<Peer>& all, const Options& o)
{
  std::vector<Peer> chosen;
  for(const Peer& peer : all)
    if(o.methods.empty() || peer.key == "input" || peer.key == "package" ||
       std::find(o.methods.begin(), o.methods.end(), peer.key) != o.methods.end())
      chosen.push_back(peer);
  return chosen;
}

int compare_all(const std::vector<Peer>& peers, const Options& o)
{
  int worst = ok;
  Output output(o);
  Charts charts(peers);
  for(const std::string& file : o.files)
  {
    charts.start_mesh(base_name(file));
    Result_apart<Figures> package;
    for(std::size_t i = 0; i < peers.size(); ++i)
    {
      const bool is_package = peers[i].key == "package", is_input = peers[i].key == "input";
      const Result_apart<Figures> result = run(file, peers[i], o);
      if(!result.has_value && is_input)
      {
        std::cerr << file << ": " << result.text << std::endl;
        worst = failure;
        break;
      }
      if(is_package)
        package = result;
      Verdict verdict;
      if(result.has_value)
      {
        charts.add(i, result.value);
        if(!is_input && !is_package && package.has_value)
          verdict = compare(peers[i], result.value, package.value);
      }
      if(o.checks && (verdict.better == "peer" || (is_package && !result.has_value)))
        worst = (std::max)(worst, int(violation));
      output.add(make_row(file, peers[i], result, verdict));
    }
  }
  output.finish();
  if(!o.folder.empty())
    charts.write(o.folder);
  return worst;
}

} // namespace

int main(int argc, char* argv[])
{
  try
  {
    const std::vector<Peer> all = all_peers();
    const Options options = parse(argc, argv, all);
    return compare_all(chosen_peers(all, options), options);
  }
  catch(const std::exception& e)
  {
    std::cerr << "side_by_side: " << e.what() << std::endl;
    return failure;
  }
}
