#ifndef RCO_BENCHMARK_RESULT_COLUMNS_H
#define RCO_BENCHMARK_RESULT_COLUMNS_H

// Columns that the drivers have in common.

#include "meshes.h"
#include "method.h"
#include "promises.h"
#include "report.h"

#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <limits>
#include <string>

inline double percentage(double part, double all) { return all > 0 ? 100 * part / all : 0; }

inline void add_flips_and_folds(Row& row, const Defects_in_and_out& defects)
{
  row.add("flips_in", "flips", double(defects.in.number_of_flips));
  row.add("flips_out", "flips", double(defects.out.number_of_flips));
  row.add("folds_in", "folds", double(defects.in.number_of_fold_edges));
  row.add("folds_out", "folds", double(defects.out.number_of_fold_edges));
}

// smallest angles of the faces; `when` is in or out
inline void add_angles(Row& row, const Mesh& mesh, const std::string& when)
{
  const CGAL::Reference_constrained_optimization::Angle_statistics a =
    CGAL::Reference_constrained_optimization::angle_statistics(mesh);
  row.add("theta_min_" + when, "theta " + when, a.minimum, 2);
  row.add("theta_mean_" + when, "theta " + when, a.mean, 2);
  row.add("theta_std_" + when, "theta " + when, a.standard_deviation, 2);
}

// both ways
inline void add_drift(Row& row,
                      const CGAL::Reference_constrained_optimization::Drift& drift,
                      const std::string& when)
{
  row.add("drift_mesh_to_reference_" + when, "drift " + when, drift.relative_mesh_to_reference(),
          2);
  row.add("drift_reference_to_mesh_" + when, "drift " + when, drift.relative_reference_to_mesh(),
          2);
}

inline void add_iterations(Row& row, const CGAL::Reference_constrained_optimization::Result& r)
{
  const double iterations = double(r.number_of_iterations);
  row.add("status", "status", name(r.status));
  row.add("n_out", "N_out", iterations);
  row.add("n_in", "N_in", iterations > 0 ? double(r.number_of_patches) / iterations : 0, 1);
}

inline void add_accepted(Row& row, const CGAL::Reference_constrained_optimization::Result& r)
{
  row.add("accepted_percent", "accepted %",
          percentage(double(r.number_of_accepted_patches), double(r.number_of_patches)), 1);
}

inline void add_stages(Row& row, const CGAL::Reference_constrained_optimization::Stage_times& t)
{
  const double all = t.setup + t.selection + t.flattening + t.optimization + t.acceptance;
  row.add("setup_percent", "stages %", percentage(t.setup, all));
  row.add("selection_percent", "stages %", percentage(t.selection, all));
  row.add("flattening_percent", "stages %", percentage(t.flattening, all));
  row.add("optimization_percent", "stages %", percentage(t.optimization, all));
  row.add("acceptance_percent", "stages %", percentage(t.acceptance, all));
}

// the yardstick and the time measured with it; left out for large meshes
inline void add_factorization(Row& row, const Mesh& mesh, double seconds)
{
  namespace RCO = CGAL::Reference_constrained_optimization;
  double factorization = std::numeric_limits<double>::quiet_NaN();
  if(mesh.number_of_vertices() <= RCO::factorization_time_vertex_limit)
    factorization = RCO::factorization_time(mesh);
  row.add("factorization_ms", "T_F ms", 1e3 * factorization, 1);
  row.add("time_over_factorization", "time/T_F", seconds / factorization, 1);
}

// the time of a run in several units
inline void add_times(Row& row, const Mesh& mesh, double seconds)
{
  row.add("time_s", "s", seconds, 2);
  add_factorization(row, mesh, seconds);
  row.add("us_per_vertex", "us/V", 1e6 * seconds / double(mesh.number_of_vertices()), 1);
}

// what --check finds; `broken_promises()` returns it, in words
template <typename Broken_promises_function>
void add_check(Row& row,
               const std::string& method,
               const Broken_promises_function& broken_promises,
               bool& holds)
{
  const std::string broken = keeps_promises(method) ? broken_promises() : "";
  holds = broken.empty();
  row.add("violations", "violations", !keeps_promises(method) ? "-" : holds ? "none" : broken);
}

#endif // RCO_BENCHMARK_RESULT_COLUMNS_H
