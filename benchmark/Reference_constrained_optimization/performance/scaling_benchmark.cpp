// Optimizes a mesh, decimated or split into more triangles, with a number of threads, and prints a row of
// figures. --help tells the rest.

#include "../library_call.h"
#include "../result_columns.h"
#include "../shape.h"

#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/global_control.h>
#endif

const std::string usage =
  R"(usage: scaling_benchmark mesh [options]

Improves the minimum angle of a shape (triangles) and prints a row of figures as a line of JSON. With
run.py a shape is done at several sizes, each against its own shape:

  run.py --format json scaling_benchmark armadillo.off -- --level -1,0,1,2,3 --threads 1,2

  --level K              -1: decimated to 10000 vertices; 0 (default): as it is; K: every triangle
                         split into four K times
  --threads N            number of threads (default 1, which is CGAL's sequential tag)
)" +
  common_usage +
  R"(
theta: smallest angle per face, in degrees. n_out, n_in: outer iterations and patches per iteration.
Percentages of the stages: those of patches are summed over the threads.
)";

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
  const double part = 10000 / double(mesh.number_of_vertices());
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

bool run(const Command_line& arguments, Row& row)
{
  Common_settings s(arguments);
  if(s.parallel || s.check || !s.output_folder.empty())
    throw std::invalid_argument("--parallel, --check and --output have no meaning here");
  const int level = arguments.number("--level", 0), threads = arguments.number("--threads", 1);
  s.parallel = threads > 1;
#ifdef CGAL_LINKED_WITH_TBB
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  std::size_t(threads));
#else
  if(threads > 1)
    throw std::invalid_argument("--threads: this program was built without TBB");
#endif
  Mesh mesh = read(arguments.name(0, ""));
  if(!CGAL::is_triangle_mesh(mesh))
    throw std::invalid_argument("the mesh is not made of triangles");
  if(level < 0)
    mesh = decimated(mesh);
  for(int i = 0; i < level; ++i)
    mesh = split_in_four(mesh);

  row.add("mesh", base_name(arguments.name(0, "")));
  add_size(row, mesh);
  row.add("threads", threads);
  add_angles(row, mesh, "_in");
  Monotonicity_visitor visitor;
  const RCO::Result r = optimize(
    mesh, mesh, RCO::Minimum_angle_energy(),
    with_common_settings(CGAL::parameters::developability_threshold(s.developability), s, visitor),
    s);
  const double memory = peak_memory();
  add_angles(row, mesh, "_out");
  add_iterations(row, r);
  add_stages(row, r.times);
  row.add("time_s", r.running_time);
  row.add("us_per_vertex", 1e6 * r.running_time / double(mesh.number_of_vertices()));
  row.add("peak_memory_mb", memory);
  return true;
}

int main(int argc, char* argv[])
{
  return drive(argc, argv, usage, with_common_options({{"--level", true}, {"--threads", true}}),
               run);
}
