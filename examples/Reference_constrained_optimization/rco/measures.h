// The measures of a mesh, by application: a list of numbers with their names, the same list before
// and after.

#ifndef RCO_PROGRAM_MEASURES_H
#define RCO_PROGRAM_MEASURES_H

#include "mesh.h"
#include "options.h"
#include "soft_landmarks.h"

#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/angles.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/drift.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/feature_deviation.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/map_statistics.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/normal_deviation.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/orientation.h>
#include <CGAL/Reference_constrained_optimization/quality_measures/quads.h>

#include <limits>
#include <string>
#include <vector>

// the role of a measure in the outcome of a run
enum class Role {
  figure,    // nothing
  condition, // reported if it got worse
  aim        // objective of the energy: the mesh is improved if one of these is better
};

struct Measure
{
  std::string key, label; // for programs and for people
  int digits;
  double value;
  Role role = Role::figure;
  bool is_better_if_larger = false;
  double tolerance = 0;                                   // what is no change
  double limit = std::numeric_limits<double>::infinity(); // the mesh cannot be used beyond it
  bool is_of_defects = false;                             // there should be none

  double gain(const Measure& before) const
  {
    return is_better_if_larger ? value - before.value : before.value - value;
  }
};

// collects them
class Measures
{
  std::vector<Measure> m_all;

public:
  void figure(const char* key, const char* label, int digits, double value)
  {
    m_all.push_back({key, label, digits, value});
  }
  void smaller_is_better(Role role, const char* key, const char* label, int digits, double value)
  {
    m_all.push_back({key, label, digits, value, role, false});
  }
  void larger_is_better(Role role, const char* key, const char* label, int digits, double value)
  {
    m_all.push_back({key, label, digits, value, role, true});
  }
  void let_pass(double tolerance) { m_all.back().tolerance = tolerance; }
  void limit(double value) { m_all.back().limit = value; }
  void of_defects() { m_all.back().is_of_defects = true; }
  const std::vector<Measure>& all() const { return m_all; }
};

inline void add_angles(Measures& m, const Mesh& mesh)
{
  const RCO::Angle_statistics a = RCO::angle_statistics(mesh);
  m.larger_is_better(Role::aim, "minimum_angle", "smallest angle of a face (degrees), minimum", 2,
                     a.minimum);
  m.larger_is_better(Role::aim, "mean_minimum_angle", "  mean", 2, a.mean);
  m.figure("standard_deviation_of_minimum_angle", "  standard deviation", 2, a.standard_deviation);
  m.smaller_is_better(Role::aim, "faces_below_10", "  faces below 10", 0,
                      double(a.number_below_10));
  m.smaller_is_better(Role::aim, "faces_below_20", "  faces below 20", 0,
                      double(a.number_below_20));
  m.smaller_is_better(Role::aim, "faces_below_30", "  faces below 30", 0,
                      double(a.number_below_30));
}

inline void add_quads(Measures& m, const Mesh& mesh, const Mesh& reference, bool uses_angle_energy)
{
  const RCO::Edge_statistics e = RCO::edge_statistics(mesh);
  const Role edges = uses_angle_energy ? Role::figure : Role::condition;
  m.larger_is_better(edges, "minimum_edge", "edge length over mean, minimum", 3, e.minimum);
  m.smaller_is_better(edges, "maximum_edge", "  maximum", 3, e.maximum);
  m.smaller_is_better(uses_angle_energy ? Role::figure : Role::aim, "standard_deviation_of_edge",
                      "  standard deviation", 3, e.standard_deviation);
  const RCO::Corner_angle_statistics a = RCO::corner_angle_statistics(mesh);
  m.larger_is_better(Role::condition, "minimum_corner_angle", "corner angle (degrees), minimum", 2,
                     a.minimum);
  m.smaller_is_better(Role::condition, "maximum_corner_angle", "  maximum", 2, a.maximum);
  m.smaller_is_better(Role::aim, "standard_deviation_of_corner_angle", "  standard deviation", 2,
                      a.standard_deviation);
  const RCO::Planarity p = RCO::planarity(mesh);
  m.figure("maximum_planarity", "planarity (0: planar), maximum", 4, p.maximum);
  m.figure("mean_planarity", "  mean", 4, p.mean);
  m.smaller_is_better(Role::condition, "nonconvex_quads", "non-convex quads", 0,
                      double(RCO::number_of_nonconvex_quads(mesh, reference)));
  m.of_defects();
}

inline void add_map(Measures& m, const RCO::Map_statistics& map)
{
  const RCO::Distortion_statistics& d = map.distortion;
  m.smaller_is_better(Role::aim, "mean_distortion", "distortion (2: isometric), mean", 3, d.mean);
  m.limit(map.largest_mean_distortion);
  m.figure("median_distortion", "  median", 3, d.median);
  m.figure("percentile_99_of_distortion", "  99 %", 3, d.percentile_99);
  m.smaller_is_better(Role::condition, "maximum_distortion", "  maximum", 2, d.maximum);
  m.figure("area_covered_more_than_once", "reference, part covered more than once", 5,
           map.area_hit_more_than_once);
  m.limit(map.largest_flawed_area);
  m.figure("area_not_covered", "  part not covered", 5, map.area_not_hit);
  m.figure("largest_uncovered_region", "  largest region further than 3 mean edges, part", 5,
           map.largest_uncovered_region);
  m.limit(map.largest_flawed_area);
  m.figure("collapsed_area", "source, part that shrinks below a thousandth", 5, map.collapsed_area);
}

// of landmarks from their counterparts; an objective if they are pulled at all
inline void
add_landmarks(Measures& m, const Landmark_distances& distances, double unit, double weight)
{
  m.smaller_is_better(weight > 0 ? Role::aim : Role::figure, "mean_landmark_distance",
                      "distance of landmarks (edges of reference), mean", 3, distances.mean / unit);
  m.figure("maximum_landmark_distance", "  maximum", 3, distances.maximum / unit);
}

// the relative change of the volume that is enclosed; 0 for surfaces with a border and for polygons
inline double volume_change(const Mesh& mesh, const Mesh& reference)
{
  namespace PMP = CGAL::Polygon_mesh_processing;
  for(const Mesh* m : {&mesh, &reference})
    if(!CGAL::is_triangle_mesh(*m) || !CGAL::is_closed(*m))
      return 0;
  const double before = std::abs(CGAL::to_double(PMP::volume(reference)));
  const double after = std::abs(CGAL::to_double(PMP::volume(mesh)));
  return before > 0 ? std::abs(after / before - 1) : 0;
}

inline void add_orientation(Measures& m, const RCO::Orientation_defects& defects)
{
  m.smaller_is_better(Role::condition, "flipped_faces", "flipped faces", 0,
                      double(defects.number_of_flips));
  m.of_defects();
  m.smaller_is_better(Role::condition, "folded_edges", "folded edges (beyond 120 degrees)", 0,
                      double(defects.number_of_fold_edges));
}

// The reference is null if it is the mesh itself: deviations are zero then.
inline void add_shape(Measures& m, const Mesh& mesh, const Mesh* reference, const RCO::Drift& drift)
{
  const bool is_itself = reference == nullptr;
  const double unit = is_itself ? 1 : drift.reference_mean_edge_length;
  m.figure("mesh_to_reference", "drift (mean edges of the reference), of the mesh", 3,
           drift.mesh_to_reference.maximum / unit);
  m.figure("reference_to_mesh", "  of the reference", 3, drift.reference_to_mesh.maximum / unit);
  m.figure("root_mean_square_drift", "  root mean square", 3, drift.root_mean_square() / unit);
  const RCO::Normal_deviation n =
    is_itself ? RCO::Normal_deviation() : RCO::normal_deviation(mesh, *reference);
  m.figure("mean_normal_deviation", "normal deviation of faces (degrees), mean", 2, n.mean);
  m.figure("maximum_normal_deviation", "  maximum", 2, n.maximum);
  m.figure("area_turned_above_10", "  part of the area above 10", 4, n.share_above_10);
  m.figure("area_turned_above_20", "  part of the area above 20", 4, n.share_above_20);
  m.figure("area_turned_above_45", "  part of the area above 45", 4, n.share_above_45);
  const RCO::Feature_deviation f =
    is_itself ? RCO::Feature_deviation() : RCO::feature_deviation(*reference, mesh);
  const double small_part = 0.02;
  m.larger_is_better(Role::condition, "sharp_edges_kept", "sharp edges, part kept", 3, f.kept);
  m.let_pass(small_part);
  m.smaller_is_better(Role::condition, "sharp_edges_added", "  added", 3, f.added);
  m.let_pass(small_part);
  m.smaller_is_better(Role::condition, "volume_change", "volume, part of it lost or added", 4,
                      is_itself ? 0 : volume_change(mesh, *reference));
  m.let_pass(small_part);
}

// Measures a mesh against its reference, null if that is the mesh itself; source and landmarks serve maps only.
// Measures that decide on the outcome are fast; those of the shape may be left out.
inline std::vector<Measure> measure(const Mesh& mesh,
                                    const Mesh* other_reference,
                                    const Mesh& source,
                                    const Landmarks& landmarks,
                                    const Options& options,
                                    bool has_shape)
{
  const Mesh& reference = other_reference != nullptr ? *other_reference : mesh;
  Measures m;
  if(options.application == Application::map)
  {
    const RCO::Map_statistics map = RCO::map_statistics(source, mesh, reference);
    add_map(m, map);
    if(options.has_soft_landmarks)
      add_landmarks(m, landmark_distances(mesh, reference, landmarks),
                    map.drift.reference_mean_edge_length, options.soft_landmarks);
    add_orientation(m, map.defects);
    if(has_shape)
      add_shape(m, mesh, &reference, map.drift);
    return m.all();
  }
  if(options.application == Application::angle)
    add_angles(m, mesh);
  else
    add_quads(m, mesh, reference, options.uses_angle_energy);
  add_orientation(m, RCO::orientation_defects(mesh, reference));
  if(has_shape)
    add_shape(m, mesh, other_reference,
              other_reference == nullptr ? RCO::Drift() : RCO::drift(mesh, reference));
  return m.all();
}

#endif // RCO_PROGRAM_MEASURES_H
