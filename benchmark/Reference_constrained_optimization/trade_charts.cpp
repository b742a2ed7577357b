// Draws what the parameters of the angle energy trade against each other, and how the energy falls
// while time passes. --help tells the rest.

#include "../../examples/Reference_constrained_optimization/svg_histogram.h"
#include "meshes.h"
#include "svg_log_chart.h"
#include "svg_scatter.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Reference_constrained_optimization/Default_visitor.h>
#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/reference_constrained_optimize.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

namespace RCO = CGAL::Reference_constrained_optimization;

namespace {

const char* const usage =
  R"(usage: trade_charts folder mesh...

Optimizes triangle meshes (OFF, OBJ, PLY, STL) against their own shape and writes charts into the
folder:
  trade_drift_bound.svg  angles and drift against the bound on the drift
  trade_exponent.svg     angles against the factor in the exponent, with and without finishing stage
  energy.svg             energy against time, with and without steps on the surface; no finishing
                         stage and no bound on the drift
  angles_MESH.svg        of each mesh a histogram of its angles before and after
)";

// one thread, so that times can be compared
struct Run
{
  Mesh mesh;
  RCO::Result result;
  RCO::Angle_statistics angles;
  double drift; // the larger direction, in mean edges of the reference
};

template <typename Named_parameters>
Run run(const Mesh& input, double exponent, const Named_parameters& np)
{
  Run r;
  r.mesh = input;
  r.result =
    CGAL::reference_constrained_optimize(r.mesh, input, RCO::Minimum_angle_energy(exponent), np);
  r.angles = RCO::angle_statistics(r.mesh);
  const RCO::Drift drift = RCO::drift(r.mesh, input);
  r.drift = (std::max)(drift.relative_mesh_to_reference(), drift.relative_reference_to_mesh());
  return r;
}

struct Named_mesh
{
  std::string name;
  Mesh mesh;
};

const std::array<const char*, 6> series_colours = {
  {"#1d4f8c", "#d9822b", "#3c8d5a", "#8a4fa3", "#b33a3a", "#555555"}};
const std::string series_marks = "osd^v+";

Svg_scatter::Series series(std::size_t i, const std::string& name, bool is_filled)
{
  return {name,
          series_colours[i % series_colours.size()],
          series_marks[i % series_marks.size()],
          is_filled,
          2.8,
          true};
}

const double infinity = std::numeric_limits<double>::infinity(), no_line = infinity;

void draw_drift_bound(const std::vector<Named_mesh>& meshes, const std::string& file)
{
  std::vector<Svg_scatter::Series> names;
  std::vector<Svg_scatter::Panel> panels = {{"smallest angle (degrees)", {}, no_line},
                                            {"mean angle, against no bound (degrees)", {}, no_line},
                                            {"drift (mean edges)", {}, no_line}};
  for(std::size_t i = 0; i < meshes.size(); ++i)
  {
    const Mesh& mesh = meshes[i].mesh;
    names.push_back(series(i, meshes[i].name, true));
    const double edge = RCO::drift(mesh, mesh).reference_mean_edge_length;
    const Run free = run(mesh, 1, CGAL::parameters::drift_bound(infinity));
    for(const double bound : {0.1, 0.15, 0.25, 0.5, 1.})
    {
      const Run r = run(mesh, 1, CGAL::parameters::drift_bound(bound * edge));
      panels[0].points.push_back({i, bound, r.angles.minimum});
      panels[1].points.push_back({i, bound, r.angles.mean - free.angles.mean});
      panels[2].points.push_back({i, bound, r.drift});
    }
  }
  Svg_scatter({"What the bound on the drift costs and buys", "drift bound (mean edges)", "", ""},
              names, panels, 0.09)
    .write(file);
}

void draw_exponent(const std::vector<Named_mesh>& meshes, const std::string& file)
{
  std::vector<Svg_scatter::Series> names;
  std::vector<Svg_scatter::Panel> panels = {{"smallest angle (degrees)", {}, no_line},
                                            {"mean angle (degrees)", {}, no_line}};
  for(std::size_t i = 0; i < meshes.size(); ++i)
    for(const bool finishes : {true, false})
    {
      for(const double factor : {1, 2, 5})
      {
        const Run r = run(meshes[i].mesh, factor, CGAL::parameters::use_finishing_stage(finishes));
        panels[0].points.push_back({names.size(), factor, r.angles.minimum});
        panels[1].points.push_back({names.size(), factor, r.angles.mean});
      }
      names.push_back(series(i, meshes[i].name + (finishes ? "" : ", no finishing"), finishes));
    }
  Svg_scatter(
    {"A larger exponent is no substitute for the finishing stage", "exponent factor", "", ""},
    names, panels, 0.9)
    .write(file);
}

// the energy at the start and at the end of each iteration
struct Watch : public RCO::Default_visitor
{
  CGAL::Real_timer timer;
  std::vector<Svg_log_chart::Point> history; // seconds and energy

  Watch() { timer.start(); }
  void on_iteration_begin(std::size_t iteration)
  {
    if(iteration == 0)
      history.push_back({timer.time(), 0}); // the energy is known when the run has ended
  }
  void on_iteration_end(std::size_t, double energy) { history.push_back({timer.time(), energy}); }
};

// Without a bound on the drift, which flattened patches feel too late.
void draw_energy(const std::vector<Named_mesh>& meshes, const std::string& file)
{
  const double at_rest = RCO::Minimum_angle_energy().density().value(Eigen::Matrix2d::Identity());
  Svg_log_chart chart("What is left of the energy while time passes", "seconds",
                      {"default", "flattened alone"});
  for(const Named_mesh& m : meshes)
  {
    Svg_log_chart::Panel panel{m.name + ": mean density above that at rest", {}, false};
    for(const bool on_surface : {true, false})
    {
      Watch watch;
      const Run r = run(m.mesh, 1,
                        CGAL::parameters::use_on_surface_steps(on_surface)
                          .use_finishing_stage(false)
                          .drift_bound(infinity)
                          .visitor(std::ref(watch)));
      watch.history.front().y = r.result.initial_energy;
      for(Svg_log_chart::Point& p : watch.history)
        p.y -= at_rest;
      panel.series.push_back(watch.history);
    }
    chart.add(panel);
  }
  chart.write(file);
}

std::vector<double> angles(const Mesh& mesh)
{
  std::vector<double> result;
  for(const Mesh::Halfedge_index h : mesh.halfedges())
    if(!mesh.is_border(h))
      result.push_back(CGAL::approximate_angle(mesh.point(mesh.source(h)),
                                               mesh.point(mesh.target(h)),
                                               mesh.point(mesh.target(mesh.next(h)))));
  return result;
}

void draw_angles(const Named_mesh& m, const std::string& file)
{
  const Svg_histogram::Axis axis = {"Angles of " + m.name,
                                    "angle (degrees)",
                                    "share of angles",
                                    "&#176;",
                                    180,
                                    2,
                                    30,
                                    60,
                                    false,
                                    1};
  const Run r = run(m.mesh, 1, CGAL::parameters::default_values());
  Svg_histogram(axis, angles(m.mesh), angles(r.mesh)).write(file);
}

} // namespace

int main(int argc, char* argv[])
{
  if(argc < 3 || std::string(argv[1]) == "--help")
  {
    std::cerr << usage;
    return EXIT_FAILURE;
  }
  try
  {
    const std::string folder = std::string(argv[1]) + "/";
    std::vector<Named_mesh> meshes;
    for(int i = 2; i < argc; ++i)
      meshes.push_back({base_name(argv[i]), read_or_name(argv[i])});
    draw_energy(meshes, folder + "energy.svg");
    draw_drift_bound(meshes, folder + "trade_drift_bound.svg");
    draw_exponent(meshes, folder + "trade_exponent.svg");
    for(const Named_mesh& m : meshes)
      draw_angles(m, folder + "angles_" + m.name + ".svg");
  }
  catch(const std::exception& e)
  {
    std::cerr << "trade_charts: " << e.what() << std::endl;
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
