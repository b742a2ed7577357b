// Writes the stages of the method on one mesh, for scripts/make_figures.sh to draw: a patch, its
// flattening, what is made of it there and on the surface, and a partition.

#include "../meshes.h"

#include <CGAL/Random.h>
#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/internal/flattening/Flattened_mover.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/Located_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/backtracking.h>
#include <CGAL/Reference_constrained_optimization/internal/rounds/patch_solver.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_partition.h>
#include <CGAL/Reference_constrained_optimization/internal/selection/patch_selection.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Patch.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <cstddef>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

using namespace RCO::internal;

namespace {

const char* const usage =
  R"(usage: method_pictures mesh folder seed patch-size partition-size

Writes into the folder, as OFF files (patch*.off have the faces of the patch, in one order):
  patch.off           the patch around the face `seed`, as it lies on the surface
  patch_flat.off      the same flattened
  patch_optimized.off the same after Newton steps in the plane
  patch_mapped.off    the same mapped back onto the surface
and, with a number for every face, one a line:
  regions.txt         of the mesh: 0: not in the patch, 1: in the two rings along its boundary,
                      2: done with, 3: the seed
  patch_regions.txt   the same for the faces of the patch
  partition.txt       of the mesh: the number of its patch for steps on the surface
)";

std::ofstream open(const std::string& file)
{
  std::ofstream out(file);
  if(!out)
    throw std::runtime_error("cannot write " + file);
  out.precision(17);
  return out;
}

void write(const std::string& file, const Indexed_mesh& mesh, const std::vector<Vector_3>& points)
{
  std::ofstream out = open(file);
  out << "OFF\n" << points.size() << ' ' << mesh.number_of_faces() << " 0\n";
  for(const Vector_3& p : points)
    out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for(int f = 0; f < mesh.number_of_faces(); ++f)
  {
    out << mesh.degree(f);
    for(int c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      out << ' ' << mesh.corner_vertex[c];
    out << '\n';
  }
}

void write(const std::string& file, const std::vector<int>& numbers)
{
  std::ofstream out = open(file);
  for(const int n : numbers)
    out << n << '\n';
}

std::vector<Vector_3> in_space(const std::vector<Vector_2>& u)
{
  std::vector<Vector_3> points;
  for(const Vector_2& p : u)
    points.emplace_back(p.x(), p.y(), 0);
  return points;
}

// Takes the patch through flattening, Newton steps and acceptance, as often as a visit does. Returns
// where its vertices end in the plane.
std::vector<Vector_2> visit(Patch& patch,
                            const Optimization_state& state,
                            const RCO::Minimum_angle_energy& energy,
                            Flattened_mover& mover)
{
  Backtracking backtracking;
  Step_limits limits;
  limits.density = std::numeric_limits<double>::infinity();
  std::vector<Vector_2> u = mover.flattening().positions;
  bool proposes = true;
  for(int pass = 0; proposes && pass < Patch_solver::flattened_proposals; ++pass)
  {
    if(!backtracking
          .decide(patch, Patch_samples(), state, mover, energy.density(), limits, pass == 0)
          .accepted)
      break;
    patch.located = backtracking.candidate();
    const std::vector<double>& steps = backtracking.steps();
    for(std::size_t v = 0; v < u.size(); ++v)
      u[v] += steps[v] * (mover.target()[v] - u[v]);
    proposes = mover.propose_again(patch, Patch_samples(), steps, energy.density());
  }
  return u;
}

void write_stages(const std::string& mesh_file,
                  const std::string& folder,
                  int seed,
                  int patch_size,
                  int partition_size)
{
  const Mesh_copy copy =
    read_measured_mesh(read(mesh_file), CGAL::parameters::default_values(), "mesh");
  if(seed < 0 || seed >= copy.mesh.number_of_faces())
    throw std::runtime_error("there is no face " + std::to_string(seed));
  const RCO::Minimum_angle_energy energy;
  Located_mesh located(copy, copy, energy, std::vector<char>(copy.points.size(), 1));
  const Optimization_state& state = located.state();

  Face_geometry geometry;
  geometry.update(copy.mesh, copy.points);
  Selection_parameters parameters;
  parameters.maximum_patch_size = patch_size;
  Patch_selection selection(copy.mesh, parameters);
  const std::vector<int> faces = selection.grow(seed, geometry, [](int) { return false; });
  std::vector<int> region(copy.mesh.number_of_faces(), 0);
  for(const int f : faces)
    region[f] = 1;
  for(const int f : selection.touched(faces))
    region[f] = 2;
  region[seed] = 3;
  write(folder + "/regions.txt", region);
  std::vector<int> patch_region;
  for(const int f : faces)
    patch_region.push_back(region[f]);
  write(folder + "/patch_regions.txt", patch_region);

  Patch patch = Patch_builder(copy.mesh).build(faces, state);
  write(folder + "/patch.off", patch.polygons, patch.positions());
  Flattened_mover mover(state.reference);
  if(!mover.propose(patch, Patch_samples(), energy.density()))
    throw std::runtime_error("nothing can be made of the patch around this seed");
  write(folder + "/patch_flat.off", patch.polygons, in_space(mover.flattening().positions));
  write(folder + "/patch_optimized.off", patch.polygons,
        in_space(visit(patch, state, energy, mover)));
  write(folder + "/patch_mapped.off", patch.polygons, patch.positions());
  std::cout << faces.size() << " faces, flattened with a mean density of "
            << mover.flattening().distortion << " (4: isometric)" << std::endl;

  CGAL::Random random(0);
  const std::vector<std::vector<int>> patches =
    Patch_partition(copy.mesh, partition_size)
      .divide(std::vector<char>(copy.mesh.number_of_faces(), 1), random);
  std::vector<int> cell(copy.mesh.number_of_faces(), -1);
  for(std::size_t i = 0; i < patches.size(); ++i)
    for(const int f : patches[i])
      cell[f] = int(i);
  write(folder + "/partition.txt", cell);
  std::cout << patches.size() << " patches on the surface" << std::endl;
}

} // namespace

int main(int argc, char* argv[])
{
  if(argc != 6)
  {
    std::cerr << usage;
    return EXIT_FAILURE;
  }
  try
  {
    write_stages(argv[1], argv[2], std::stoi(argv[3]), std::stoi(argv[4]), std::stoi(argv[5]));
  }
  catch(const std::exception& e)
  {
    std::cerr << "method_pictures: " << e.what() << std::endl;
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
