#ifndef RCO_BENCHMARK_FIGURES_H
#define RCO_BENCHMARK_FIGURES_H

// The figures of a mesh against its reference, and which of two sets of them is better.

#include "meshes.h"

#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

struct Figures
{
  CGAL::Reference_constrained_optimization::Angle_statistics angles;
  CGAL::Reference_constrained_optimization::Drift drift;
  CGAL::Reference_constrained_optimization::Orientation_defects defects;
  CGAL::Reference_constrained_optimization::Normal_deviation turn;
  CGAL::Reference_constrained_optimization::Feature_deviation features;
  double number_of_vertices = 0;
  double self_intersecting_pairs = 0;
  double off_reference = 0;         // largest distance of a vertex over the reference's diagonal
  double largest_minimum_angle = 0; // what the reference's connectivity allows, an estimate
  double seconds = 0, factorization = 0;
};

inline Figures measure(const Mesh& mesh, const Mesh& reference)
{
  namespace RCO = CGAL::Reference_constrained_optimization;
  Figures f;
  f.angles = RCO::angle_statistics(mesh);
  f.drift = RCO::drift(mesh, reference);
  f.defects = RCO::orientation_defects(mesh, reference);
  f.turn = RCO::normal_deviation(mesh, reference);
  f.features = RCO::feature_deviation(reference, mesh);
  f.number_of_vertices = double(mesh.number_of_vertices());
  f.self_intersecting_pairs = double(RCO::number_of_self_intersecting_pairs(mesh));
  const CGAL::Bbox_3 box = CGAL::Polygon_mesh_processing::bbox(reference);
  const double x = box.xmax() - box.xmin(), y = box.ymax() - box.ymin(),
               z = box.zmax() - box.zmin();
  f.off_reference =
    RCO::distance_to_reference(mesh, reference).maximum / std::sqrt(x * x + y * y + z * z);
  f.largest_minimum_angle = RCO::minimum_angle_estimate(reference).minimum();
  f.factorization = reference.number_of_vertices() <= RCO::factorization_time_vertex_limit
                      ? RCO::factorization_time(reference)
                      : std::numeric_limits<double>::quiet_NaN();
  return f;
}

// a's figures against b's, in the columns that decide who is better
class Comparison
{
public:
  Comparison(const Figures& a, const Figures& b)
  {
    compare("theta_min", -a.angles.minimum, -b.angles.minimum);
    compare("theta_mean", -a.angles.mean, -b.angles.mean);
    compare("drift", a.drift.relative_maximum(), b.drift.relative_maximum());
    compare("flips", double(a.defects.number_of_flips), double(b.defects.number_of_flips));
    compare("folds", double(a.defects.number_of_fold_edges),
            double(b.defects.number_of_fold_edges));
    m_is_better = m_loses == 0 && !m_wins.empty() && a.seconds <= b.seconds;
    if(a.seconds < b.seconds)
      m_wins.push_back("time");
  }

  // not worse in any column and better in one, at no more time
  bool is_better() const { return m_is_better; }

  // the columns that a wins, time being one of them
  std::string wins() const
  {
    std::string text;
    for(const std::string& name : m_wins)
      text += (text.empty() ? "" : " ") + name;
    return text;
  }

private:
  // less is better; what rounding explains is equal
  void compare(const std::string& name, double a, double b)
  {
    const double rounding = 1e-9 * (std::max)(1., std::abs(b));
    if(a < b - rounding)
      m_wins.push_back(name);
    else if(!(a <= b + rounding))
      ++m_loses;
  }

  std::vector<std::string> m_wins;
  int m_loses = 0;
  bool m_is_better = false;
};

#endif // RCO_BENCHMARK_FIGURES_H
