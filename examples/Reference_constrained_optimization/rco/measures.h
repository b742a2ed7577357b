// The measures of a mesh, by application: a list of numbers with their names, the same list before
// and after.

#ifndef RCO_PROGRAM_MEASURES_H
#define RCO_PROGRAM_MEASURES_H

#include "mesh.h"
#include "options.h"

#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/angles.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/distortion.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/drift.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/orientation.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/quads.h>

#include <string>
#include <vector>

struct Measure
{
  std::string key, label; // for programs and for people
  int digits;
  double value;
};

// The reference is null if it is the mesh itself: nothing has drifted then.
inline std::vector<Measure>
measure(const Mesh& mesh, const Mesh* other_reference, const Mesh& source, Application application)
{
  const Mesh& reference = other_reference != nullptr ? *other_reference : mesh;
  std::vector<Measure> measures;
  const auto add = [&](const char* key, const char* label, int digits, double value) {
    measures.push_back({key, label, digits, value});
  };
  if(application == Application::angle)
  {
    const RCO::Angle_statistics a = RCO::angle_statistics(mesh);
    add("minimum_angle", "smallest angle of a face (degrees), minimum", 2, a.minimum);
    add("mean_minimum_angle", "  mean", 2, a.mean);
    add("standard_deviation_of_minimum_angle", "  standard deviation", 2, a.standard_deviation);
    add("faces_below_10", "  faces below 10", 0, double(a.number_below_10));
    add("faces_below_20", "  faces below 20", 0, double(a.number_below_20));
    add("faces_below_30", "  faces below 30", 0, double(a.number_below_30));
  }
  if(application == Application::quad)
  {
    const RCO::Edge_statistics e = RCO::edge_statistics(mesh);
    add("minimum_edge", "edge length over mean, minimum", 3, e.minimum);
    add("maximum_edge", "  maximum", 3, e.maximum);
    add("standard_deviation_of_edge", "  standard deviation", 3, e.standard_deviation);
    const RCO::Corner_angle_statistics a = RCO::corner_angle_statistics(mesh);
    add("minimum_corner_angle", "corner angle (degrees), minimum", 2, a.minimum);
    add("maximum_corner_angle", "  maximum", 2, a.maximum);
    add("standard_deviation_of_corner_angle", "  standard deviation", 2, a.standard_deviation);
    const RCO::Planarity p = RCO::planarity(mesh);
    add("maximum_planarity", "planarity (0: planar), maximum", 4, p.maximum);
    add("mean_planarity", "  mean", 4, p.mean);
    add("nonconvex_quads", "non-convex quads", 0,
        double(RCO::number_of_nonconvex_quads(mesh, reference)));
  }
  if(application == Application::map)
  {
    const auto none = CGAL::parameters::default_values();
    // a map that misses a part of the reference is not let off for it
    const double area = CGAL::to_double(CGAL::Polygon_mesh_processing::area(reference));
    const RCO::Distortion_statistics d = RCO::distortion_statistics(source, mesh, none, none, area);
    add("mean_distortion", "distortion (2: isometric), mean", 3, d.mean);
    add("median_distortion", "  median", 3, d.median);
    add("percentile_99_of_distortion", "  99 %", 3, d.percentile_99);
    add("maximum_distortion", "  maximum", 2, d.maximum);
  }
  const RCO::Orientation_defects defects = RCO::orientation_defects(mesh, reference);
  add("flipped_faces", "flipped faces", 0, double(defects.number_of_flips));
  add("folded_edges", "folded edges", 0, double(defects.number_of_fold_edges));
  const RCO::Drift drift = other_reference != nullptr ? RCO::drift(mesh, reference) : RCO::Drift();
  const double unit = other_reference != nullptr ? drift.reference_mean_edge_length : 1;
  add("mesh_to_reference", "drift (mean edges of the reference), of the mesh", 3,
      drift.mesh_to_reference.maximum / unit);
  add("reference_to_mesh", "  of the reference", 3, drift.reference_to_mesh.maximum / unit);
  add("root_mean_square_drift", "  root mean square", 3, drift.root_mean_square() / unit);
  return measures;
}

#endif // RCO_PROGRAM_MEASURES_H
