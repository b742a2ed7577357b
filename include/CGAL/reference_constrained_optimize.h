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
 * mapped back onto the reference. Where nothing is folded, regions are optimized in the tangent planes of
 * their vertices instead, and single vertices that remain bad by a pattern search. New positions are kept
 * only if, measured on the reference, the number of flipped faces, folded edges and non-convex quads falls,
 * or does not change while the energy falls (in the finishing stage, the energy with a barrier on small
 * angles: see `use_finishing_stage`). Border vertices and constrained vertices are unchanged, bit for bit
 * (unless `relax_constraints` lets them slide along their lines). All other vertices of the result lie on
 * the reference. The same input and seed give the same bits for any number of threads, and in units of
 * length that are powers of two of each other. In other units, and at other places, the result differs as
 * with another seed.
 *
 * \tparam ConcurrencyTag `CGAL::Sequential_tag` (default) or `CGAL::Parallel_tag` (needs TBB).
 * \tparam PolygonMesh a model of `FaceListGraph` and `HalfedgeListGraph`, with triangles, or quads if the
 *         energy supports them.
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
 *     \cgalParamDescription{a property map from the vertices of `mesh` to points. If its number type is not
 *                           `double`, vertices are on the reference up to its rounding}
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
 *     \cgalParamDescription{the largest number of iterations}
 *     \cgalParamType{`unsigned int`}
 *     \cgalParamDefault{`100`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{random_seed}
 *     \cgalParamDescription{the seed of the random choice of patches}
 *     \cgalParamType{`unsigned int`}
 *     \cgalParamDefault{`0`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{visitor}
 *     \cgalParamDescription{a visitor that is notified of iterations, rounds and patches, and can stop the
 *                           optimization; it is passed by `std::ref` to keep its state}
 *     \cgalParamType{a model of `ReferenceConstrainedOptimizationVisitor`}
 *     \cgalParamDefault{`Reference_constrained_optimization::Default_visitor`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{maximum_running_time}
 *     \cgalParamDescription{the time in seconds after which the optimization stops. The mesh then holds the
 *                           last accepted state}
 *     \cgalParamType{`double`}
 *     \cgalParamDefault{unlimited}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{vertex_is_constrained_map}
 *     \cgalParamDescription{the vertices that do not move}
 *     \cgalParamType{a model of `ReadablePropertyMap` with the vertex descriptor as key type and
 *                    `bool` as value type}
 *     \cgalParamDefault{no vertex is constrained}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{edge_is_constrained_map}
 *     \cgalParamDescription{the edges whose two vertices do not move}
 *     \cgalParamType{a model of `ReadablePropertyMap` with the edge descriptor as key type and
 *                    `bool` as value type}
 *     \cgalParamDefault{no edge is constrained}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{detect_features}
 *     \cgalParamDescription{whether the sharp edges of mechanical parts are detected, by
 *                           `Reference_constrained_optimization::detect_features()`, and kept. No feature
 *                           is detected if `edge_is_constrained_map` is given, for `mesh` or for
 *                           `reference`. Section \ref rco_features tells what is kept}
 *     \cgalParamType{`bool`}
 *     \cgalParamDefault{`true`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{developability_threshold}
 *     \cgalParamDescription{\f$ \epsilon_d \f$, the bound on the cost of the faces of a flattened patch in
 *                           its cone proxy, a number without unit: the larger it is, the larger are
 *                           patches, and the less developable}
 *     \cgalParamType{`double`}
 *     \cgalParamDefault{`0.25`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{drift_bound}
 *     \cgalParamDescription{the largest distance between mesh and reference in both directions, measured at
 *                           samples of both; distances of the input that exceed it may not increase, and
 *                           infinity turns the bound off. Section \ref rco_drift tells how it is enforced}
 *     \cgalParamType{`double`}
 *     \cgalParamDefault{a quarter of the reference's mean edge length, or the distance of the input if that
 *                       is larger, but three mean edges at most (`Result::drift_bound` holds it), and less
 *                       where the reference has smaller faces, and on mechanical parts; infinity if
 *                       `use_on_surface_steps` is `false`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{energy_tolerance}
 *     \cgalParamDescription{the relative decrease of the energy below which the optimization stops}
 *     \cgalParamType{`double`}
 *     \cgalParamDefault{`4e-3`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{maximum_patch_size}
 *     \cgalParamDescription{the largest number of faces of a patch}
 *     \cgalParamType{`int`}
 *     \cgalParamDefault{`0`: chosen by the size of the mesh}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{relax_constraints}
 *     \cgalParamDescription{whether border vertices slide along the reference's border, and vertices of
 *                           constrained edges along its feature lines (see the parameter
 *                           `edge_is_constrained_map` of `np_reference`) or, if there are none, along their
 *                           own; corners of lines, and vertices constrained by `vertex_is_constrained_map`,
 *                           do not move}
 *     \cgalParamType{`bool`}
 *     \cgalParamDefault{`false`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{allow_creases}
 *     \cgalParamDescription{whether creases, edges beyond 90 degrees that are neither constrained nor feature
 *                           edges, may become more}
 *     \cgalParamType{`bool`}
 *     \cgalParamDefault{`false`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{allow_self_intersections}
 *     \cgalParamDescription{whether pairs of faces that intersect may become more}
 *     \cgalParamType{`bool`}
 *     \cgalParamDefault{`false`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{use_on_surface_steps}
 *     \cgalParamDescription{whether patches are optimized directly on the reference, and only defects and
 *                           regions of bad elements are flattened: faster, and more accurate. With `false`
 *                           every patch is flattened, as in the paper}
 *     \cgalParamType{`bool`}
 *     \cgalParamDefault{`true`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{use_finishing_stage}
 *     \cgalParamDescription{whether a last stage raises the smallest angle, at a small cost to the energy
 *                           and of at most 0.2 degrees in the mean over the faces of their smallest angle.
 *                           It applies to energies whose `element_criterion` is `smallest_angle`}
 *     \cgalParamType{`bool`}
 *     \cgalParamDefault{`true`}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{vertex_location_map}
 *     \cgalParamDescription{receives the location of every non-isolated vertex on the reference, which must
 *                           be a triangle mesh: a face and barycentric coordinates, as in
 *                           `Polygon_mesh_processing::locate()`. For vertices that do not move it is that
 *                           of the closest point. Nothing is written if the optimization is stopped during
 *                           setup}
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
 *     \cgalParamDescription{the feature lines of the reference, along which vertices of constrained edges
 *                           of `mesh` slide with `relax_constraints(true)`}
 *     \cgalParamType{a model of `ReadablePropertyMap` with the edge descriptor of `reference` as key
 *                    type and `bool` as value type}
 *     \cgalParamDefault{the edges with a dihedral angle above 25 degrees; used only if the edges of a line
 *                       of `mesh` are no parts of edges of the reference}
 *   \cgalParamNEnd
 * \cgalNamedParamsEnd
 *
 * \return statistics of the optimization.
 *
 * \throws Reference_constrained_optimization::Invalid_input if a mesh is empty, not manifold, without
 *         area, has a coordinate that is not finite or a face that the energy cannot use, if a vertex is
 *         further from the reference than a tenth of the reference's diagonal, if that diagonal is not
 *         between 1e-60 and 1e60, or if a parameter is out of range. The mesh is then untouched. If a
 *         visitor throws, the mesh holds the last accepted state.
 *
 * Isolated vertices and faces without area are no errors: the former are kept and ignored, the latter are
 * improved if their vertices may move. A component of the reference that is oriented against the mesh is
 * treated as if it were oriented like the mesh.
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
  return internal::optimize<ConcurrencyTag>(mesh, reference, energy, np, np_reference);
}

/*!
 * \ingroup PkgReferenceConstrainedOptimizationRef
 *
 * does the same for a range of faces of a mesh.
 *
 * Vertices that have a face outside the range are unchanged, bit for bit. The energies of the result are
 * means over the elements of the range's faces, its drift is that of these faces, and the number of free
 * vertices is counted among them; flips, fold edges and non-convex quads are counted in the whole mesh. The
 * faces outside must be triangles or quads, but the energy need not be defined on them, and they may be far
 * from the reference. Values that an energy derives from the mesh, such as its mean edge length and area,
 * are those of the whole mesh.
 *
 * With an empty range the mesh is not changed.
 *
 * \tparam FaceRange a model of `ConstRange` with the face descriptor of `PolygonMesh` as value type
 *
 * \param face_range the faces to be optimized; duplicates are ignored.
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
  return internal::optimize<ConcurrencyTag>(mesh, reference, energy, np, np_reference, face_range);
}

} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZE_H
