#pragma once

// Columns that the drivers have in common.

#include "driver.h"
#include "guarantees.h"
#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <limits>
#include <string>

inline double percentage(double part, double all) { return all > 0 ? 100 * part / all : 0; }

inline void add_size(Row& row, const Mesh& mesh)
{
  row.add("vertices", double(mesh.number_of_vertices()));
  row.add("faces", double(mesh.number_of_faces()));
}

inline void add_flips_and_folds(Row& row, const Defects_in_and_out& defects)
{
  row.add("flips_in", double(defects.in.number_of_flips));
  row.add("flips_out", double(defects.out.number_of_flips));
  row.add("folds_in", double(defects.in.number_of_fold_edges));
  row.add("folds_out", double(defects.out.number_of_fold_edges));
}

// smallest angles of the faces; `when` is _in, _out, or nothing
inline RCO::Angle_statistics add_angles(Row& row, const Mesh& mesh, const std::string& when)
{
  const RCO::Angle_statistics a = RCO::angle_statistics(mesh);
  row.add("theta_min" + when, a.minimum);
  row.add("theta_mean" + when, a.mean);
  row.add("theta_std" + when, a.standard_deviation);
  return a;
}

// both ways
inline void add_drift(Row& row, const RCO::Drift& drift, const std::string& when)
{
  row.add("drift_mesh_to_reference" + when, drift.relative_mesh_to_reference());
  row.add("drift_reference_to_mesh" + when, drift.relative_reference_to_mesh());
}

inline void add_iterations(Row& row, const RCO::Result& r)
{
  const double iterations = double(r.number_of_iterations);
  row.add("status", name(r.status));
  row.add("n_out", iterations);
  row.add("n_in", iterations > 0 ? double(r.number_of_patches) / iterations : 0);
}

inline void add_accepted(Row& row, const RCO::Result& r)
{
  row.add("accepted_percent",
          percentage(double(r.number_of_accepted_patches), double(r.number_of_patches)));
}

inline void add_stages(Row& row, const RCO::Stage_times& t)
{
  const double all = t.setup + t.selection + t.flattening + t.optimization + t.acceptance;
  row.add("setup_percent", percentage(t.setup, all));
  row.add("selection_percent", percentage(t.selection, all));
  row.add("flattening_percent", percentage(t.flattening, all));
  row.add("optimization_percent", percentage(t.optimization, all));
  row.add("acceptance_percent", percentage(t.acceptance, all));
}

// The time of a run and a reference for it, the time of one factorization of the whole mesh' system;
// that is left out for large meshes.
inline void add_times(Row& row, const Mesh& mesh, double seconds)
{
  const double factorization = mesh.number_of_vertices() <= RCO::factorization_time_vertex_limit
                                 ? RCO::factorization_time(mesh)
                                 : std::numeric_limits<double>::quiet_NaN();
  row.add("time_s", seconds);
  row.add("factorization_ms", 1e3 * factorization);
  row.add("time_over_factorization", seconds / factorization);
  row.add("us_per_vertex", 1e6 * seconds / double(mesh.number_of_vertices()));
}

// What --check finds, if the method guarantees anything: `violated_guarantees()` returns it, in words.
// Returns whether all holds.
template <typename Violated_guarantees_function>
bool add_check(Row& row,
               const std::string& method,
               const Violated_guarantees_function& violated_guarantees)
{
  const bool has_guarantees = method == "ours" || method == "plain";
  const std::string broken = has_guarantees ? violated_guarantees() : "";
  row.add("violations", !has_guarantees ? "-" : broken.empty() ? "none" : broken);
  return broken.empty();
}
