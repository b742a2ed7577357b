// Runs the package or one of its peers on a mesh and prints a row of figures. --help tells the rest.

#include "../result_columns.h"
#include "peers.h"

#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

const std::string usage =
  R"(usage: side_by_side mesh --method NAME [options]

Improves the minimum angle of a mesh (triangles; OFF, OBJ, PLY, STL) against its own shape, border fixed,
by the package or by another method, and prints a row of figures as a line of JSON. side_by_side.py does so
for many meshes and methods, and compares them.

  --method NAME          of those below
  --time-limit S         seconds (default 600)
  --output DIR           write the resulting mesh into this folder (OFF)

Methods:
  input          the mesh as it is
  package        the package, all defaults
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

theta: smallest angle per face, in degrees. below: faces whose smallest angle is. drift: largest distance
of samples from the mesh to the reference and back, the larger of both, and the larger root mean square,
in mean edges of the reference. turn: by how much faces are inverted with respect to the reference, in degrees (mean
over the area), and percent of the area in faces turned by more than 20 and 45. sharp edges: those that
are left, and new ones, over the length that there was. flips, folds: faces inverted with respect to the reference,
and edges folded by more than 120 degrees. off_reference: largest distance of a vertex from the reference
over the diagonal. bound: estimate of the largest minimum angle that the connectivity allows. note: how
the run ended; CGAL's safe angle smoothing may stop off the reference, and is projected then. time_s:
processor time. factorization_ms: time of one factorization of the whole mesh' system, a unit of time; left out above 200000 vertices.
)";

void add_figures(Row& row, const Mesh& mesh, const Mesh& reference)
{
  const RCO::Angle_statistics angles = add_angles(row, mesh, "");
  row.add("below_10", double(angles.number_below_10));
  row.add("below_20", double(angles.number_below_20));
  row.add("below_30", double(angles.number_below_30));
  row.add("below_40", double(angles.number_below_40));
  const RCO::Drift drift = RCO::drift(mesh, reference);
  add_drift(row, drift, "");
  row.add("drift", drift.relative_maximum());
  row.add("drift_rms", drift.relative_root_mean_square());
  const RCO::Normal_deviation turn = RCO::normal_deviation(mesh, reference);
  row.add("turn_mean", turn.mean);
  row.add("turned_above_20", 100 * turn.share_above_20);
  row.add("turned_above_45", 100 * turn.share_above_45);
  const RCO::Feature_deviation features = RCO::feature_deviation(reference, mesh);
  row.add("sharp_edges_kept", features.kept);
  row.add("sharp_edges_added", features.added);
  const RCO::Orientation_defects defects = RCO::orientation_defects(mesh, reference);
  row.add("flips", double(defects.number_of_flips));
  row.add("folds", double(defects.number_of_fold_edges));
  row.add("self_intersecting_pairs", double(RCO::number_of_self_intersecting_pairs(mesh)));
  const CGAL::Bbox_3 box = CGAL::Polygon_mesh_processing::bbox(reference);
  row.add("off_reference", RCO::distance_to_reference(mesh, reference).maximum /
                             std::hypot(box.x_span(), box.y_span(), box.z_span()));
  row.add("bound", RCO::minimum_angle_estimate(reference).minimum());
}

bool run(const Command_line& arguments, Row& row)
{
  const std::string file = arguments.name(0, ""), method = arguments.text("--method", "");
  const std::map<std::string, Peer> peers = all_peers();
  if(peers.count(method) == 0)
    throw std::runtime_error("there is no method '" + method + "'");
  const Mesh input = read(file);
  const Peer_result result = peers.at(method)(input, arguments.number("--time-limit", 600.));

  row.add("mesh", base_name(file));
  add_size(row, input);
  row.add("method", method);
  add_figures(row, result.mesh, input);
  add_times(row, input, result.seconds);
  row.add("note", result.note);
  write(result.mesh, arguments.text("--output", ""), base_name(file) + "_" + method);
  return true;
}

int main(int argc, char* argv[])
{
  return drive(argc, argv, usage, {{"--method", true}, {"--time-limit", true}, {"--output", true}},
               run);
}
