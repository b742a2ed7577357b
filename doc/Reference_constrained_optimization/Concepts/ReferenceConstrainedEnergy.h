/*!
\ingroup PkgReferenceConstrainedOptimizationConcepts
\cgalConcept

The concept `ReferenceConstrainedEnergy` says what `CGAL::reference_constrained_optimize()` asks of
an energy. An energy splits every face of the mesh into *elements*, each a triangle of three
vertices of that face together with the shape that this triangle would like to have, its rest
triangle. What deviation from that shape costs is up to the density, which is evaluated at the
Jacobian of the affine map from the rest triangle to the element as it lies on the reference. The
energy of the mesh is the sum over all elements; results report the mean.

A triangle has usually one element, a quadrilateral four, one per corner, which overlap. A face may
have none, but the mesh must have one.

The object is only read, and must live until the function returns.

\cgalHasModel{CGAL::Reference_constrained_optimization::Minimum_angle_energy}
\cgalHasModel{CGAL::Reference_constrained_optimization::Quad_regularity_energy}
\cgalHasModel{CGAL::Reference_constrained_optimization::Quad_angle_energy}
\cgalHasModel{CGAL::Reference_constrained_optimization::Compatible_remeshing_energy}

\sa `DistortionDensity`
*/
class ReferenceConstrainedEnergy
{
public:
  /// model of `DistortionDensity`.
  typedef unspecified_type Density;

  /// returns the density, which all elements share.
  const Density& density() const;

  /*!
  appends the elements of face `f` to `elements`.

  Within an element, `Energy_element::corners` are three different positions from 0 to
  `context.degree(f)` exclusively, in the cyclic order of the face; `Energy_element::rest` has the
  unit of length of the mesh, and a positive determinant. `context` knows the connectivity, the mean
  edge length and the areas of mesh and reference, but no positions: an energy whose rest triangles
  depend on the face, for example on a second mesh, keeps them itself, by the position of the face in
  `faces(mesh)`.

  It is called once for every face that is to be optimized (all, or those of the range of faces), in
  the order of `faces(mesh)`, from the thread that called `CGAL::reference_constrained_optimize()`,
  before any vertex has moved. What it appends must depend on the input alone.

  \throws CGAL::Reference_constrained_optimization::Invalid_input if the energy is not for faces
  like this one. The mesh is then left as it was.
  */
  void append_elements(
    const CGAL::Reference_constrained_optimization::Energy_context& context,
    std::size_t f,
    std::vector<CGAL::Reference_constrained_optimization::Energy_element>& elements) const;
};
