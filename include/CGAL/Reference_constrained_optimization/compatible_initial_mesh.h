// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_COMPATIBLE_INITIAL_MESH_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_COMPATIBLE_INITIAL_MESH_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Landmark_map.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/measuring.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/boost/graph/named_params_helper.h>

#include <boost/graph/graph_traits.hpp>
#include <boost/property_map/property_map.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * reports on a call of `compatible_initial_mesh()`.
 */
struct Initial_mesh_report
{
  /// trees of landmarks along which the surfaces were cut, of those with the same landmarks as the best.
  std::size_t number_of_trees = 0;
  /// trees for which both surfaces were flattened to the same convex polygon, with every triangle
  /// positively oriented and a simple boundary by exact predicates: their maps are bijective.
  std::size_t number_of_bijective_maps = 0;
  /// the tree of the best map: pairs of positions in the range of landmarks, which is continued by
  /// `added_landmarks` and, where a border has less than three, by points of it.
  std::vector<std::pair<int, int>> landmark_tree;
  /// extremities without a landmark that were paired, with one another or with the vertex that is most similar:
  /// positions in `vertices(source)` and in `vertices(reference)`.
  std::vector<std::pair<int, int>> added_landmarks;
  /// extremities without a landmark and without a counterpart, which need a landmark: positions in
  /// `vertices(source)` and in `vertices(reference)`.
  std::vector<int> unpaired_in_source, unpaired_in_reference;
  /// mean of the symmetric Dirichlet density of the best map (4: isometric), the areas equal, each
  /// triangle capped at 100.
  double capped_energy = 0;
};

namespace internal {

// positions of the landmarks' vertices in vertices(g), checked
template <typename FaceGraph, typename Vertices>
std::vector<int> landmark_positions(const FaceGraph& g,
                                    const Vertices& landmarks,
                                    const Mesh_copy& copy,
                                    const std::string& name)
{
  typedef typename boost::graph_traits<FaceGraph>::vertex_descriptor vertex_descriptor;
  std::unordered_map<vertex_descriptor, int> position;
  for(const vertex_descriptor v : vertices(g))
    position.emplace(v, int(position.size()));
  std::vector<int> result, pair_of(copy.points.size(), -1);
  for(const vertex_descriptor v : landmarks)
  {
    const std::string pair = std::to_string(result.size());
    const auto found = position.find(v);
    if(found == position.end())
      throw Invalid_input("landmarks: pair " + pair + " names a vertex that the " + name +
                          " does not have");
    const int i = found->second;
    if(copy.mesh.is_isolated(i))
      throw Invalid_input("landmarks: vertex " + std::to_string(i) + " of the " + name + " (pair " +
                          pair + ") has no face");
    if(pair_of[i] >= 0)
      throw Invalid_input("landmarks: vertex " + std::to_string(i) + " of the " + name +
                          " is in two pairs, " + std::to_string(pair_of[i]) + " and " + pair);
    pair_of[i] = int(result.size());
    result.push_back(i);
  }
  if(result.size() < 3)
    throw Invalid_input("landmarks: at least three pairs are needed, but there are " +
                        std::to_string(result.size()));
  return result;
}

// " 3, 17 of the source", or nothing
inline std::string list_of(const std::vector<int>& vertices, const std::string& name)
{
  std::string text;
  for(const int v : vertices)
    text += (text.empty() ? " " : ", ") + std::to_string(v);
  return text.empty() ? text : text + " of the " + name;
}

// The best map by landmarks and by pairs of extremities that have none, which are added until none is left.
inline std::vector<Vector_3> map_with_extremities(const Mesh_copy& source,
                                                  const Mesh_copy& reference,
                                                  std::vector<int> source_landmarks,
                                                  std::vector<int> reference_landmarks,
                                                  int number_of_trees,
                                                  unsigned int seed,
                                                  Initial_mesh_report& report)
{
  const int largest_number_of_rounds = 4;
  const std::size_t number_of_landmarks = source_landmarks.size();
  std::size_t number_of_trees_tried = 0;
  std::vector<Vector_3> best;
  report.capped_energy = std::numeric_limits<double>::infinity();
  std::vector<int> unpaired_in_source, unpaired_in_reference; // but with another vertex
  bool is_new = true;
  for(int round = 0; round < largest_number_of_rounds && is_new; ++round)
  {
    is_new = false;
    Landmark_map map(source, reference);
    map.set_landmarks(source_landmarks, reference_landmarks);
    std::vector<Landmark_map::Tried_tree> tried;
    std::vector<Vector_3> points = map.map(number_of_trees, seed, tried);
    const Landmark_map::Extremities found = map.extremities();
    number_of_trees_tried += tried.size();
    const auto least =
      std::min_element(tried.begin(), tried.end(),
                       [](const auto& a, const auto& b) { return a.distortion < b.distortion; });
    const bool is_best = least->distortion < report.capped_energy;
    if(is_best)
    {
      best = std::move(points);
      report.landmark_tree = least->edges;
      report.capped_energy = least->distortion;
      report.number_of_trees = tried.size();
      report.number_of_bijective_maps = std::size_t(
        std::count_if(tried.begin(), tried.end(), [](const auto& t) { return t.is_bijective; }));
      report.added_landmarks.clear();
      for(std::size_t i = number_of_landmarks; i < source_landmarks.size(); ++i)
        report.added_landmarks.emplace_back(source_landmarks[i], reference_landmarks[i]);
    }
    if(is_best || best.empty())
    {
      report.unpaired_in_source = unpaired_in_source;
      report.unpaired_in_reference = unpaired_in_reference;
      for(const std::pair<int, int>& p : found.without_counterpart_in_reference)
        report.unpaired_in_source.push_back(p.first);
      for(const std::pair<int, int>& p : found.without_counterpart_in_source)
        report.unpaired_in_reference.push_back(p.second);
    }
    std::vector<std::pair<int, int>> added = found.pairs;
    if(added.empty()) // even another vertex as counterpart keeps an extremity from shrinking
    {
      for(const std::pair<int, int>& p : found.without_counterpart_in_reference)
      {
        unpaired_in_source.push_back(p.first);
        added.push_back(p);
      }
      for(const std::pair<int, int>& p : found.without_counterpart_in_source)
      {
        unpaired_in_reference.push_back(p.second);
        added.push_back(p);
      }
    }
    for(const std::pair<int, int>& p : added)
      if(p.first >= 0 && p.second >= 0 &&
         std::find(source_landmarks.begin(), source_landmarks.end(), p.first) ==
           source_landmarks.end() &&
         std::find(reference_landmarks.begin(), reference_landmarks.end(), p.second) ==
           reference_landmarks.end())
      {
        source_landmarks.push_back(p.first);
        reference_landmarks.push_back(p.second);
        is_new = true;
      }
  }
  if(best.empty())
  {
    std::string ends = list_of(report.unpaired_in_source, "source"),
                others = list_of(report.unpaired_in_reference, "reference");
    ends += ends.empty() || others.empty() ? others : " and" + others;
    throw Invalid_input("landmarks: none of " + std::to_string(number_of_trees_tried) +
                        " trees led to a bijective map; more landmarks, above all at the ends of "
                        "long parts, may help" +
                        (ends.empty() ? "" : ", as at the vertices" + ends));
  }
  return best;
}

// Surface_mesh::clear() removes property maps, including the user's point map
template <typename Mesh>
auto remove_elements(Mesh& mesh, int) -> decltype(mesh.clear_without_removing_property_maps())
{
  mesh.clear_without_removing_property_maps();
}

template <typename Mesh>
void remove_elements(Mesh& mesh, long)
{
  CGAL::clear(mesh);
}

} // namespace internal

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * makes a mesh with the connectivity of a source and its vertices on a reference from a few pairs
 * of corresponding vertices: a start for `reference_constrained_optimize()` with
 * `Compatible_remeshing_energy`.
 *
 * Both surfaces are cut along a tree of shortest paths between landmarks and borders, and along two further paths
 * for each handle, in the same order around each landmark, and flattened to the same convex polygon by mean value
 * coordinates (Floater, \e Mean \e value \e coordinates, 2003). Each vertex of the source is then located in the
 * reference's triangles in the plane. That both maps are bijective is checked by exact predicates. Since the
 * distortion depends much on the tree, several are tried, those with the shortest detours on both surfaces, and the
 * map of least distortion is kept.
 *
 * The two surfaces must be connected, and have the same genus and number of borders. Borders are mapped onto each
 * other: those with the same landmarks, and others by their distances from the landmarks. A closed reference of
 * opposite orientation is reversed first.
 *
 * An extremity (a limb, an ear) without a landmark shrinks exponentially in the plane. Extremities of both
 * surfaces whose distances from the landmarks are alike get a pair of landmarks if the map is better for it;
 * those that have no counterpart are in the report: set a landmark at the end of each.
 *
 * \tparam SourceMesh a model of `FaceListGraph` and `HalfedgeListGraph`, of triangles and quads
 * \tparam ReferenceMesh the same; quads are split
 * \tparam LandmarkRange a model of `ConstRange` with value type
 *         `std::pair<boost::graph_traits<SourceMesh>::vertex_descriptor,
 *         boost::graph_traits<ReferenceMesh>::vertex_descriptor>`
 * \tparam OutputMesh a model of `MutableFaceGraph`
 * \tparam NamedParameters a sequence of \ref bgl_namedparameters "Named Parameters"
 * \tparam NamedParametersReference the same, for the reference
 * \tparam NamedParametersOutput the same, for the output
 *
 * \param source the mesh whose connectivity the output gets: vertices and faces in the same order,
 *        landmarks at the points of their counterparts. Vertices without faces keep their points.
 * \param reference the surface on which the output's vertices lie
 * \param landmarks three or more pairs. A vertex is in one pair at most; the two of a pair are both
 *        on the border or both not.
 * \param output_mesh receives the mesh; its previous elements are removed
 * \param np optional parameters of the source and of the search:
 *
 * \cgalNamedParamsBegin
 *   \cgalParamNBegin{vertex_point_map}
 *     \cgalParamDescription{a property map from the vertices of `source` to points}
 *     \cgalParamType{a model of `ReadablePropertyMap`}
 *     \cgalParamDefault{`boost::get(CGAL::vertex_point, source)`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{number_of_iterations}
 *     \cgalParamDescription{the number of trees that are tried; fewer if there are not so many}
 *     \cgalParamType{`unsigned int`}
 *     \cgalParamDefault{`6`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{random_seed}
 *     \cgalParamDescription{the seed of all trees but the first three}
 *     \cgalParamType{`unsigned int`}
 *     \cgalParamDefault{`0`}
 *   \cgalParamNEnd
 * \cgalNamedParamsEnd
 *
 * \param np_reference the parameter `vertex_point_map` of `reference`
 * \param np_output the parameter `vertex_point_map` of `output_mesh`
 *
 * \return statistics of the trees that were tried.
 *
 * \throws Invalid_input if a mesh cannot be read (see `reference_constrained_optimize()`), has
 *         several components, if genus or number of borders differ, if a landmark is not a
 *         vertex with faces or is in two pairs, if there are fewer than three, if landmarks on the
 *         borders are not in the same order or not on corresponding borders, or if no bijective map was
 *         found. `output_mesh` is then untouched.
 */
template <typename SourceMesh,
          typename ReferenceMesh,
          typename LandmarkRange,
          typename OutputMesh,
          typename NamedParameters = parameters::Default_named_parameters,
          typename NamedParametersReference = parameters::Default_named_parameters,
          typename NamedParametersOutput = parameters::Default_named_parameters>
Initial_mesh_report
compatible_initial_mesh(const SourceMesh& source,
                        const ReferenceMesh& reference,
                        const LandmarkRange& landmarks,
                        OutputMesh& output_mesh,
                        const NamedParameters& np = parameters::default_values(),
                        const NamedParametersReference& np_reference = parameters::default_values(),
                        const NamedParametersOutput& np_output = parameters::default_values())
{
  using parameters::choose_parameter;
  using parameters::get_parameter;
  const auto& own_np = internal::cgal_parameters(np);
  const std::size_t number_of_trees = choose_parameter(
    get_parameter(own_np, CGAL::internal_np::number_of_iterations), std::size_t(6));
  const unsigned int seed =
    choose_parameter(get_parameter(own_np, CGAL::internal_np::random_seed), 0u);
  if(number_of_trees == 0)
    throw Invalid_input("number_of_iterations: at least one tree has to be tried");

  const internal::Mesh_copy from = internal::read_measured_mesh(source, np, "source");
  const internal::Mesh_copy to = internal::read_measured_mesh(reference, np_reference, "reference");
  std::vector<typename boost::graph_traits<SourceMesh>::vertex_descriptor> source_vertices;
  std::vector<typename boost::graph_traits<ReferenceMesh>::vertex_descriptor> reference_vertices;
  for(const auto& pair : landmarks)
  {
    source_vertices.push_back(pair.first);
    reference_vertices.push_back(pair.second);
  }
  const std::vector<int> source_positions =
    internal::landmark_positions(source, source_vertices, from, "source");
  const std::vector<int> reference_positions =
    internal::landmark_positions(reference, reference_vertices, to, "reference");

  Initial_mesh_report report;
  const std::vector<internal::Vector_3> points = internal::map_with_extremities(
    from, to, source_positions, reference_positions, int(number_of_trees), seed, report);

  auto vpm = choose_parameter(
    get_parameter(internal::cgal_parameters(np_output), CGAL::internal_np::vertex_point),
    CGAL::get_property_map(CGAL::vertex_point, output_mesh));
  typedef typename boost::property_traits<decltype(vpm)>::value_type Point;
  std::vector<Point> soup_points;
  for(std::size_t v = 0; v < points.size(); ++v)
  {
    const bool is_isolated = from.mesh.is_isolated(v);
    const internal::Vector_3& p = is_isolated ? from.points[v] : points[v];
    soup_points.emplace_back(p.x(), p.y(), p.z());
  }
  std::vector<std::vector<std::size_t>> soup_faces(from.mesh.number_of_faces());
  for(int c = 0; c < from.mesh.number_of_corners(); ++c)
    soup_faces[from.mesh.corner_face[c]].push_back(std::size_t(from.mesh.corner_vertex[c]));
  internal::remove_elements(output_mesh, 0);
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(
    soup_points, soup_faces, output_mesh, CGAL::parameters::default_values(),
    CGAL::parameters::vertex_point_map(vpm));
  return report;
}

} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_COMPATIBLE_INITIAL_MESH_H
