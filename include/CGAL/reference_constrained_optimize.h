// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZE_H

#include <CGAL/Reference_constrained_optimization/Attraction_energy.h>
#include <CGAL/Reference_constrained_optimization/Compatible_remeshing_energy.h>
#include <CGAL/Reference_constrained_optimization/Default_visitor.h>
#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/Quad_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/Quad_regularity_energy.h>
#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/Sum_energy.h>
#include <CGAL/Reference_constrained_optimization/detect_features.h>
#include <CGAL/Reference_constrained_optimization/internal/optimize.h>
#include <CGAL/Reference_constrained_optimization/internal/read_parameters.h>
#include <CGAL/Reference_constrained_optimization/internal/reading/face_range.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

#include <CGAL/tags.h>

#include <type_traits>

namespace CGAL {

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * moves the vertices of a mesh along a reference surface so that an energy falls; the connectivity
 * does not change.
 *
 * Nearly developable disks of faces are flattened, locally injectively, the energy is minimized in the
 * plane, in the metric of the surface and with the disk's boundary fixed, and the vertices are
 * mapped back onto the reference. Where nothing is folded, regions are optimized in the tangent
 * planes of their vertices instead, and for single vertices that are left behind a better place is
 * searched. New positions are kept only if, measured on the reference, the number of flipped faces,
 * folded edges and non-convex quads falls, or does not change while the energy falls (in the
 * finishing stage, the energy with a barrier on small angles: see `use_finishing_stage`).
 * Border vertices and constrained vertices do not move, not by a bit (unless `relax_constraints` lets
 * them slide along their lines). All other vertices of the result lie on the reference. The same input
 * and seed give the same bits for any number of threads, and in units of length that are powers of two of
 * each other. In other units, and at other places, the result differs as with another seed.
 *
 * \tparam ConcurrencyTag `CGAL::Sequential_tag` (default) or `CGAL::Parallel_tag` (needs TBB).
 * \tparam PolygonMesh a model of `FaceListGraph` and `HalfedgeListGraph`, with triangles, or quads
 *         where the energy is made for them.
 * \tparam ReferenceMesh a model of `FaceListGraph` and `HalfedgeListGraph`; quads are split.
 * \tparam Energy a model of `ReferenceConstrainedEnergy`.
 * \tparam NamedParameters a sequence of \ref bgl_namedparameters "Named Parameters"
 * \tparam NamedParametersReference the same, for the reference
 *
 * \param mesh the mesh. Vertices off the reference are moved onto it first, unless constrained.
 * \param reference the surface \f$ R \f$. It may be the same object as `mesh`: then the mesh's
 *        initial shape is the reference.
 * \param energy the energy, for example `Reference_constrained_optimization::Minimum_angle_energy`.
 * \param np optional parameters of the package (first in a chain) and of CGAL (after them):
 *
 * \cgalNamedParamsBegin
 *   \cgalParamNBegin{vertex_point_map}
 *     \cgalParamDescription{a property map from the vertices of `mesh` to points. Where its numbers are
 *                           not `double`, "on the reference" means as close to it as they can be}
 *     \cgalParamType{a model of `ReadWritePropertyMap`}
 *     \cgalParamDefault{`boost::get(CGAL::vertex_point, mesh)`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{geom_traits}
 *     \cgalParamDescription{accepted as everywhere in %CGAL and not used: computations are made with
 *                           `double`, whatever the number type of the points}
 *     \cgalParamType{a model of `Kernel`}
 *     \cgalParamDefault{unused}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{number_of_iterations}
 *     \cgalParamDescription{the largest number of outer iterations; each visits every face that
 *                           may still gain}
 *     \cgalParamType{`unsigned int`}
 *     \cgalParamDefault{`100`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{random_seed}
 *     \cgalParamDescription{the seed of the draws that decide where patches start}
 *     \cgalParamType{`unsigned int`}
 *     \cgalParamDefault{`0`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{visitor}
 *     \cgalParamDescription{is told of iterations, rounds and patches, and can stop them; pass it
 *                           by `std::ref` to keep its state}
 *     \cgalParamType{a model of `ReferenceConstrainedOptimizationVisitor`}
 *     \cgalParamDefault{`Reference_constrained_optimization::Default_visitor`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{maximum_running_time}
 *     \cgalParamDescription{the time in seconds after which work that is under way is given up. The mesh holds
                           the last accepted state then, or is untouched if setup was not over}
 *     \cgalParamType{`double`}
 *     \cgalParamDefault{unlimited}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{vertex_is_constrained_map}
 *     \cgalParamDescription{tells the vertices that must not move}
 *     \cgalParamType{a model of `ReadablePropertyMap` with the vertex descriptor as key type and
 *                    `bool` as value type}
 *     \cgalParamDefault{no vertex is constrained}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{edge_is_constrained_map}
 *     \cgalParamDescription{tells the edges whose two vertices must not move}
 *     \cgalParamType{a model of `ReadablePropertyMap` with the edge descriptor as key type and
 *                    `bool` as value type}
 *     \cgalParamDefault{no edge is constrained}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{detect_features}
 *     \cgalParamDescription{whether the feature edges of the reference are detected, see
 *                           `Reference_constrained_optimization::detect_features()`, and kept. Vertices of
 *                           edges of `mesh` that lie along them slide along them; ends, junctions,
 *                           turns of a line by more than 19 degrees, and tips stay. On components of the reference
 *                           that are mechanical parts faces are kept from turning away from it by more
 *                           than 20 degrees, edges that turn by less than 20 degrees from turning by more
 *                           than 38, the volume from changing by more than 0.8 percent (unless there is a border), and the drift
 *                           bound is a fifth of what it is elsewhere. No feature is detected where `edge_is_constrained_map` is given, for
 *                           `mesh` or for `reference`}
 *     \cgalParamType{`bool`}
 *     \cgalParamDefault{`true`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{developability_threshold}
 *     \cgalParamDescription{\f$ \epsilon_d \f$: a face joins a patch only if its cost
 *                           \f$ (\langle n_p, n_t \rangle - \cos\theta_p)^2 \f$ in the patch's cone
 *                           proxy is below it (without unit)}
 *     \cgalParamType{`double`}
 *     \cgalParamDefault{`0.25`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{drift_bound}
 *     \cgalParamDescription{how far mesh and reference may be apart, in units of length: a smooth
 *                           barrier \f$ w\,u^2 / (1 - u) \f$ on the distances of the middles of edges
 *                           and faces from the reference, and of the reference's vertices and the
 *                           middles of its creases (by more than 25 degrees) from the mesh, is added
 *                           to the energy, and no step may take one of them beyond 1.1 times the
 *                           bound. What is further away on input may not become worse.
 *                           Infinity switches the barrier off}
 *     \cgalParamType{`double`}
 *     \cgalParamDefault{a quarter of the reference's mean edge length, or, if that is larger, what
 *                       allows as much as the input has (`Result::drift_bound` tells), but less where the
 *                       reference is finer: 0.35 of the longest edge within two rings, and, on
 *                       mechanical parts (see `detect_features`), a fifth of the bound and half
 *                       the shortest edge there; infinity if `use_on_surface_steps` is `false`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{energy_tolerance}
 *     \cgalParamDescription{the optimization comes to rest when an outer iteration lowers the energy by
 *                           less than this part of what it has above the energy of elements that
 *                           all have the shape they have at rest, scaled to the area of the mesh,
 *                           both with single elements capped and without; it ends there, or, for
 *                           energies that judge elements by their angles, once starting again with larger patches has
 *                           gained less, too}
 *     \cgalParamType{`double`}
 *     \cgalParamDefault{`4e-3`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{maximum_patch_size}
 *     \cgalParamDescription{the largest number of faces of a patch}
 *     \cgalParamType{`int`}
 *     \cgalParamDefault{`0`: patches that are flattened hold 4.5 times the square root of the mesh's
 *                       number of triangles, between 400 and 4000, but 1.2 times, 150 at least, for
 *                       energies that judge elements by their angles unless `use_on_surface_steps` is `false`; the
 *                       others hold an eighth of the mesh, between 4000 and 20000 triangles, a quarter
 *                       of that (again and again, 1000 at least) once they are held up, and four
 *                       times as much where iterations start again; a quad counts as two triangles}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{relax_constraints}
 *     \cgalParamDescription{whether vertices on lines slide along them: border vertices that are
 *                           within a tenth of the mean edge length of the reference's border along
 *                           that, vertices of constrained edges likewise along the reference's
 *                           feature lines (see the parameter `edge_is_constrained_map` of
 *                           `np_reference`), or along the line that they form at the start if its
 *                           edges are parts of edges of the reference or if no feature line is near.
 *                           Ends, junctions and turns of a line by more than 60 degrees stay, and so
 *                           do vertices constrained by `vertex_is_constrained_map`. With `false` all
 *                           of them stay}
 *     \cgalParamType{`bool`}
 *     \cgalParamDefault{`false`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{use_on_surface_steps}
 *     \cgalParamDescription{whether only the surroundings of flips, folds, non-convex quads and
 *                           regions of bad elements are flattened, and everything is optimized
 *                           directly on the reference, in the tangent planes of the vertices:
 *                           faster, and more accurate. At the end a better place is then searched
 *                           for each vertex around the worst elements. With `false` every patch is
 *                           flattened, as in the paper}
 *     \cgalParamType{`bool`}
 *     \cgalParamDefault{`true`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{use_finishing_stage}
 *     \cgalParamDescription{whether, in the end, the smallest angles are raised by a barrier on
 *                           angles below a rising target, at a small cost to the energy and of at
 *                           most 0.2 degrees in the mean over the faces of their smallest angle. It
 *                           applies to energies whose rest triangles are all equilateral. With
 *                           `use_on_surface_steps(false)` the worst elements are visited once more
 *                           in small flattened patches instead}
 *     \cgalParamType{`bool`}
 *     \cgalParamDefault{`true`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{vertex_location_map}
 *     \cgalParamDescription{receives for every vertex that is not isolated where it lies on the
 *                           reference: a face and the barycentric coordinates with respect to the
 *                           vertices of that face, the first being `source(halfedge(f, reference))`
 *                           as in `Polygon_mesh_processing::locate()`. They are not negative and add
 *                           up to 1, and `Polygon_mesh_processing::construct_point()` gives the
 *                           vertex' position but for rounding (of vertices that may not move: the
 *                           point of the reference closest to it). The reference must be a triangle
 *                           mesh. Nothing is written if the optimization is stopped during setup}
 *     \cgalParamType{a model of `WritablePropertyMap` with the vertex descriptor of `mesh` as key
 *                    type and `std::pair<face_descriptor, std::array<double, 3>>` as value type}
 *     \cgalParamDefault{unused}
 *   \cgalParamNEnd
 * \cgalNamedParamsEnd
 *
 * \param np_reference optional parameters of the reference:
 *
 * \cgalNamedParamsBegin
 *   \cgalParamNBegin{vertex_point_map}
 *     \cgalParamDescription{a property map from the vertices of `reference` to points}
 *     \cgalParamType{a model of `ReadablePropertyMap`}
 *     \cgalParamDefault{`boost::get(CGAL::vertex_point, reference)`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{edge_is_constrained_map}
 *     \cgalParamDescription{tells the feature lines of the reference, along which vertices of
 *                           constrained edges of `mesh` slide with `relax_constraints(true)`}
 *     \cgalParamType{a model of `ReadablePropertyMap` with the edge descriptor of `reference` as key
 *                    type and `bool` as value type}
 *     \cgalParamDefault{the edges where it turns by more than 25 degrees; used only where the edges
 *                       of a line of `mesh` are no parts of edges of the reference}
 *   \cgalParamNEnd
 * \cgalNamedParamsEnd
 *
 * \return what was done and reached.
 *
 * \throws Reference_constrained_optimization::Invalid_input if a mesh is empty, not manifold, without
 *         area, has a coordinate that is not finite or a face that the energy cannot use, if a vertex is
 *         further from the reference than a tenth of the reference's diagonal, if that diagonal is not
 *         between 1e-60 and 1e60, or if a parameter makes no sense. The mesh is then untouched. If a visitor throws, the mesh holds the last
 *         accepted state.
 *
 * Isolated vertices and faces without area are no errors: the former are kept and ignored, the latter
 * are improved where their vertices may move. A component of the reference that is oriented against
 * the mesh is taken as if it were oriented like the mesh.
 */
template <
  typename ConcurrencyTag = CGAL::Sequential_tag,
  typename PolygonMesh,
  typename ReferenceMesh,
  typename Energy,
  typename NamedParameters = parameters::Default_named_parameters,
  typename NamedParametersReference = parameters::Default_named_parameters
#ifndef DOXYGEN_RUNNING
  ,
  std::enable_if_t<
    !Reference_constrained_optimization::internal::Is_face_range<PolygonMesh, ReferenceMesh>::value,
    int> = 0
#endif
  >
Reference_constrained_optimization::Result reference_constrained_optimize(
  PolygonMesh& mesh,
  const ReferenceMesh& reference,
  const Energy& energy,
  const NamedParameters& np = parameters::default_values(),
  const NamedParametersReference& np_reference = parameters::default_values())
{
  namespace internal = Reference_constrained_optimization::internal;
  return internal::optimize<ConcurrencyTag>(
    mesh, reference, energy, internal::read_loop_parameters(internal::cgal_parameters(np)), np,
    np_reference);
}

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * does the same for a part of a mesh.
 *
 * Vertices that have a face outside the range do not move, not by a bit. The energies of the result
 * are means over the elements of the range's faces, its drift is that of these faces, and the number
 * of free vertices is counted among them; flips, fold edges and non-convex quads are counted in the
 * whole mesh. Nothing is asked of the faces outside but that the mesh is one of triangles and quads:
 * the energy need not be defined on them, and they may be far from the reference. What an energy
 * derives from the mesh, such as its mean edge length and area, is that of the whole mesh.
 *
 * An empty range is nothing to do.
 *
 * \tparam FaceRange a model of `ConstRange` with the face descriptor of `PolygonMesh` as value type
 *
 * \param face_range the faces to be optimized; one that is named twice counts once.
 * \param mesh the mesh, of which the faces are a part
 * \param reference as for a whole mesh
 * \param energy as for a whole mesh
 * \param np as for a whole mesh
 * \param np_reference as for a whole mesh
 *
 * \return what was done and reached, see above.
 *
 * \throws Reference_constrained_optimization::Invalid_input as for a whole mesh.
 */
template <
  typename ConcurrencyTag = CGAL::Sequential_tag,
  typename FaceRange,
  typename PolygonMesh,
  typename ReferenceMesh,
  typename Energy,
  typename NamedParameters = parameters::Default_named_parameters,
  typename NamedParametersReference = parameters::Default_named_parameters
#ifndef DOXYGEN_RUNNING
  ,
  std::enable_if_t<
    Reference_constrained_optimization::internal::Is_face_range<FaceRange, PolygonMesh>::value,
    int> = 0
#endif
  >
Reference_constrained_optimization::Result reference_constrained_optimize(
  const FaceRange& face_range,
  PolygonMesh& mesh,
  const ReferenceMesh& reference,
  const Energy& energy,
  const NamedParameters& np = parameters::default_values(),
  const NamedParametersReference& np_reference = parameters::default_values())
{
  namespace internal = Reference_constrained_optimization::internal;
  return internal::optimize<ConcurrencyTag>(
    mesh, reference, energy, internal::read_loop_parameters(internal::cgal_parameters(np)), np,
    np_reference, face_range);
}

} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZE_H
