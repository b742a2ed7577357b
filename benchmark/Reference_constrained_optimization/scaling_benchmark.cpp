// Optimizes one shape at growing numbers of vertices and with several numbers of threads, and prints
// one row of figures for each. --help tells the rest.

#include "library_call.h"
#include "meshes.h"
#include "report.h"
#include "result_columns.h"
#include "run_apart.h"
#include "settings.h"
#include "shape.h"
#include "svg_log_chart.h"

#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/global_control.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace RCO = CGAL::Reference_constrained_optimization;

struct Options : Common_options<Common_settings>
{
#ifdef CGAL_LINKED_WITH_TBB
  std::vector<int> threads{1, 2};
#else
  std::vector<int> threads{1};
#endif
  double maximum_vertices = 2e6;
  std::string chart;
};

const char* const usage =
  R"(usage: scaling_benchmark [options] [mesh]

Improves the minimum angle of one shape (triangles; CGAL's armadillo by default) at several sizes:
decimated to 10000 vertices if it has twice as many, as it is, and split one into four again and
again, each against its own shape. Prints one row for each size and number of threads, and in the
end the exponent p for which the time grows with the number n of vertices as n^p, by least squares
over the sizes of 100000 vertices and more (on standard error, unless a table is printed).

Options:
  --threads LIST         numbers of threads (default 1,2); 1 is CGAL's sequential tag
  --max-vertices N       no sizes beyond (default 2000000)
  --chart FILE           write a chart of the times and the times per vertex (SVG)
  --format F             table, csv or json
  -h, --help             this text
Settings; each takes one value:
  --developability E     threshold for a face to join a patch
  --patch-size N         largest number of faces of a patch; 0: by the size of the mesh
  --iterations N         largest number of outer iterations
  --tolerance T          relative decrease of the energy per iteration that ends the run
  --seed N               random seed
  --time-limit S         seconds for a run; those it cuts short count neither for p nor in the chart
  --method NAME          ours, plain or paper, as for rco_benchmark

Exit code: 0, 2 if a run failed or an option could not be used.

Columns. theta: smallest angle per face, in degrees (min/mean/std). N_out, N_in: outer iterations and
patches per iteration. stages %: setup / selection / flattening / optimization / acceptance, those of
patches summed over the threads. us/V: microseconds per vertex. speed-up: against one thread. MB:
peak memory of the run (every run has a process of its own where the system has fork).
)";

int whole_number(const std::string& option, const std::string& text)
{
  const double value = to_number(option, text);
  if(!(value >= 1 && value <= 1e9 && value == std::floor(value)))
    throw std::invalid_argument(option + ": '" + text + "' is not a positive whole number");
  return int(value);
}

Options parse(int argc, char* argv[])
{
  const Options options = parse_options<Options>(
    argc, argv, usage, "mesh",
    [](Options& o, const std::string& option, const auto& value) {
      if(option == "--threads")
      {
        o.threads.clear();
        for(const std::string& item : split_list(value()))
          o.threads.push_back(whole_number(option, item));
      }
      else if(option == "--max-vertices")
        o.maximum_vertices = whole_number(option, value());
      else if(option == "--chart")
        o.chart = value();
      else
        return false;
      return true;
    },
    RCO_DATA_DIR "/armadillo.off");
  if(options.files.size() > 1)
    throw std::invalid_argument("one mesh only");
  if(options.runs.size() > 1)
    throw std::invalid_argument("one value only for each setting");
  if(options.parallel || options.check || !options.output_folder.empty())
    throw std::invalid_argument("--parallel, --check and --output have no meaning here");
#ifndef CGAL_LINKED_WITH_TBB
  if(options.threads != std::vector<int>{1})
    throw std::invalid_argument("--threads: this program was built without TBB");
#endif
  return options;
}

// ---- sizes -------------------------------------------------------------------------------------

struct Size
{
  int subdivisions; // -1: decimated
  double vertices;  // about
};

const double decimated_size = 10000;

std::vector<Size> sizes_of(const Mesh& mesh, double maximum)
{
  std::vector<Size> sizes;
  double v = double(mesh.number_of_vertices()), e = double(mesh.number_of_edges()),
         f = double(mesh.number_of_faces());
  if(v >= 2 * decimated_size && decimated_size <= maximum)
    sizes.push_back({-1, decimated_size});
  for(int i = 0; v <= maximum; ++i)
  {
    sizes.push_back({i, v});
    v += e;
    e = 2 * e + 3 * f;
    f *= 4;
  }
  return sizes;
}

struct Stops_at
{
  double number_of_edges;

  template <typename Cost, typename Profile>
  bool operator()(const Cost&, const Profile&, std::size_t, std::size_t current) const
  {
    return double(current) <= number_of_edges;
  }
};

// by edge collapses; the vertices are put back onto the surface
Mesh decimated(const Mesh& original)
{
  Mesh mesh = original;
  const double part = decimated_size / double(mesh.number_of_vertices());
  CGAL::Surface_mesh_simplification::edge_collapse(mesh,
                                                   Stops_at{part * double(mesh.number_of_edges())});
  mesh.collect_garbage();
  const Shape shape(original);
  for(const Mesh::Vertex_index v : mesh.vertices())
    mesh.point(v) = shape.project(mesh.point(v));
  return mesh;
}

// Splits every face into four at the midpoints of its edges, which are on the surface already: shape
// and angles stay what they are.
Mesh split_in_four(const Mesh& coarse)
{
  typedef Mesh::Vertex_index Vertex;
  Mesh mesh;
  const Mesh::size_type n = Mesh::size_type(coarse.number_of_vertices());
  mesh.reserve(n + Mesh::size_type(coarse.number_of_edges()),
               2 * Mesh::size_type(coarse.number_of_edges()) +
                 3 * Mesh::size_type(coarse.number_of_faces()),
               4 * Mesh::size_type(coarse.number_of_faces()));
  for(const Vertex v : coarse.vertices())
    mesh.add_vertex(coarse.point(v));
  for(const Mesh::Edge_index e : coarse.edges())
    mesh.add_vertex(
      CGAL::midpoint(coarse.point(coarse.vertex(e, 0)), coarse.point(coarse.vertex(e, 1))));
  for(const Mesh::Face_index f : coarse.faces())
  {
    Vertex corner[3], middle[3]; // middle[i] is before corner[i]
    Mesh::Halfedge_index h = coarse.halfedge(f);
    for(int i = 0; i < 3; ++i, h = coarse.next(h))
    {
      corner[i] = coarse.target(h);
      middle[i] = Vertex(n + Mesh::size_type(coarse.edge(h)));
    }
    for(int i = 0; i < 3; ++i)
      mesh.add_face(middle[i], corner[i], middle[(i + 1) % 3]);
    mesh.add_face(middle[0], middle[1], middle[2]);
  }
  return mesh;
}

Mesh mesh_of_size(const Mesh& original, const Size& size)
{
  if(size.subdivisions < 0)
    return decimated(original);
  Mesh mesh = original;
  for(int i = 0; i < size.subdivisions; ++i)
    mesh = split_in_four(mesh);
  return mesh;
}

// ---- runs --------------------------------------------------------------------------------------

// what the runs leave behind: their numbers of vertices and their seconds
class Timings
{
public:
  Timings(std::size_t number_of_sizes, const std::vector<int>& threads)
    : m_sizes(number_of_sizes),
      m_threads(threads),
      m_numbers(2 * number_of_sizes * threads.size())
  {}

  void set(std::size_t size, std::size_t t, double vertices, double seconds)
  {
    m_numbers[slot(size, t)] = vertices;
    m_numbers[slot(size, t) + 1] = seconds;
  }
  // NaN if there is none
  double seconds(std::size_t size, std::size_t t) { return m_numbers[slot(size, t) + 1]; }
  double seconds_of_one_thread(std::size_t size)
  {
    const auto one = std::find(m_threads.begin(), m_threads.end(), 1);
    return one == m_threads.end() ? std::numeric_limits<double>::quiet_NaN()
                                  : seconds(size, std::size_t(one - m_threads.begin()));
  }

  // seconds over vertices, of the runs with the t-th number of threads
  std::vector<Svg_log_chart::Point> points(std::size_t t)
  {
    std::vector<Svg_log_chart::Point> result;
    for(std::size_t i = 0; i < m_sizes; ++i)
      if(seconds(i, t) > 0)
        result.push_back({m_numbers[slot(i, t)], seconds(i, t)});
    return result;
  }

private:
  std::size_t slot(std::size_t size, std::size_t t) const
  {
    return 2 * (size * m_threads.size() + t);
  }

  std::size_t m_sizes;
  const std::vector<int>& m_threads;
  Shared_numbers m_numbers;
};

// optimizes a mesh with the t-th number of threads and makes its row
Row run(const Options& o, Mesh mesh, std::size_t size, std::size_t t, Timings& timings)
{
  const int threads = o.threads[t];
#ifdef CGAL_LINKED_WITH_TBB
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  std::size_t(threads));
#endif
  const Common_settings& s = o.runs.front();
  const double n = double(mesh.number_of_vertices());
  Row row;
  row.add("mesh", "mesh", base_name(o.files.front()));
  row.add("vertices", "V", n);
  row.add("threads", "threads", threads);
  add_angles(row, mesh, "in");
  Monotonicity_visitor visitor;
  const auto np =
    with_common_settings(CGAL::parameters::developability_threshold(s.developability), s, visitor);
  const RCO::Result r =
    optimize(mesh, mesh, RCO::Minimum_angle_energy(), np, s.method, threads > 1);
  const double memory = peak_memory();
  if(r.status != RCO::Status::time_limit)
    timings.set(size, t, n, r.running_time);
  add_angles(row, mesh, "out");
  add_iterations(row, r);
  add_stages(row, r.times);
  row.add("time_s", "s", r.running_time, 2);
  row.add("us_per_vertex", "us/V", 1e6 * r.running_time / n, 1);
  row.add("speed_up", "speed-up", timings.seconds_of_one_thread(size) / timings.seconds(size, t),
          2);
  row.add("peak_memory_mb", "MB", memory, 0);
  return row;
}

// ---- what follows from all runs ----------------------------------------------------------------

std::string in_words(int threads)
{
  return std::to_string(threads) + (threads == 1 ? " thread" : " threads");
}

// the slope of the line through the logarithms, by least squares
double exponent(const std::vector<Svg_log_chart::Point>& points)
{
  double x = 0, y = 0, xx = 0, xy = 0;
  for(const Svg_log_chart::Point& p : points)
  {
    x += std::log(p.x);
    y += std::log(p.y);
    xx += std::log(p.x) * std::log(p.x);
    xy += std::log(p.x) * std::log(p.y);
  }
  const double k = double(points.size());
  return (k * xy - x * y) / (k * xx - x * x);
}

void print_exponents(std::ostream& out, const Options& o, Timings& timings)
{
  const double smallest = 1e5;
  for(std::size_t t = 0; t < o.threads.size(); ++t)
  {
    std::vector<Svg_log_chart::Point> points;
    for(const Svg_log_chart::Point& p : timings.points(t))
      if(p.x >= smallest)
        points.push_back(p);
    out << in_words(o.threads[t]) << ": ";
    if(points.size() < 2)
      out << "too few sizes of 100000 vertices and more for an exponent" << std::endl;
    else
      out << "time ~ n^" << svg::number(exponent(points), 3) << " (" << points.size()
          << " sizes of 100000 vertices and more)" << std::endl;
  }
}

void write_chart(const Options& o, Timings& timings)
{
  std::vector<std::string> names;
  Svg_log_chart::Panel times{"time (s)", {}, true},
    per_vertex{"time per vertex (&#181;s)", {}, false};
  for(std::size_t t = 0; t < o.threads.size(); ++t)
  {
    names.push_back(in_words(o.threads[t]));
    times.series.push_back(timings.points(t));
    per_vertex.series.push_back(timings.points(t));
    for(Svg_log_chart::Point& p : per_vertex.series.back())
      p.y *= 1e6 / p.x;
  }
  Svg_log_chart chart(base_name(o.files.front()), "vertices", names);
  chart.add(times);
  chart.add(per_vertex);
  chart.write(o.chart);
}

int main(int argc, char* argv[])
{
  try
  {
    const Options o = parse(argc, argv);
    const Mesh original = read_or_name(o.files.front());
    if(!CGAL::is_triangle_mesh(original))
      throw std::invalid_argument(o.files.front() + " is not made of triangles");
    const std::vector<Size> sizes = sizes_of(original, o.maximum_vertices);
    if(sizes.empty())
      throw std::invalid_argument("--max-vertices: the mesh is larger");
    Timings timings(sizes.size(), o.threads);
    std::vector<Task> tasks;
    for(std::size_t i = 0; i < sizes.size(); ++i)
      for(std::size_t t = 0; t < o.threads.size(); ++t)
        tasks.push_back({o.files.front() + ", " + in_words(o.threads[t]), [&, i, t](bool&) {
                           return run(o, mesh_of_size(original, sizes[i]), i, t, timings);
                         }});
    const int code = run_all(tasks, o.format);
    print_exponents(o.format == "table" ? std::cout : std::cerr, o, timings);
    if(!o.chart.empty())
      write_chart(o, timings);
    return code;
  }
  catch(const std::exception& e)
  {
    std::cerr << "scaling_benchmark: " << e.what() << std::endl;
    return failure;
  }
}
