/*!
\ingroup PkgReferenceConstrainedOptimizationConcepts
\cgalConcept

The concept `ReferenceConstrainedEnergy` says what `CGAL::reference_constrained_optimize()` asks of
an energy. An energy splits every face of the mesh into *elements*, each a triangle of three
vertices of the mesh together with the shape that this triangle would like to have, its rest
triangle. What deviation from that shape costs is up to the density. The energy of the mesh is the
sum over all elements; results report the mean.

A triangle has usually one element, a quadrilateral four, one per corner, which overlap.

\cgalHasModel{CGAL::Reference_constrained_optimization::Minimum_angle_energy}
*/
class ReferenceConstrainedEnergy
{
public:
  /// model of `DistortionDensity`.
  typedef unspecified_type Density;

  /// returns the density, which all elements share.
  const Density& density() const;

  /*!
  appends the elements of face `f` to `elements`, in an order that depends on the input alone.

  It is called once for every face, before any vertex has moved.

  \throws CGAL::Reference_constrained_optimization::Invalid_input if the energy is not for faces
  like this one.
  */
  void append_elements(
    const CGAL::Reference_constrained_optimization::Energy_context& context,
    std::size_t f,
    std::vector<CGAL::Reference_constrained_optimization::Energy_element>& elements) const;
};
