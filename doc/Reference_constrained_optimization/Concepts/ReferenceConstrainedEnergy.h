/*!
\ingroup PkgReferenceConstrainedOptimizationConcepts
\cgalConcept

The concept `ReferenceConstrainedEnergy` describes an energy for `CGAL::reference_constrained_optimize()`.
An energy has *elements*, *stencils*, or both; `CGAL::Reference_constrained_optimization::sum()` makes
weighted sums of energies.

An *element* is a triangle of three vertices of a face together with its shape at rest, the rest triangle.
The cost of a deviation from that shape is given by the density, which is evaluated at the Jacobian of the
affine map from the rest triangle to the element as it lies on the reference, and multiplied by the
element's weight. A triangle has usually one element, a quadrilateral four, one per corner, which overlap. A
face may have none, but the mesh must have one. An energy without elements is therefore a summand only.

A *stencil* is a list of vertices, anywhere in the mesh, whose positions in space the energy is a function of. An
energy with stencils defines `stencil_size`, `append_stencils()` and `value()`; one without leaves them out.

The energy of the mesh is the sum over all elements and stencils; results report it over the number of elements.

The object is only read, from several threads at a time, and must live until the function returns.

\cgalHasModel{CGAL::Reference_constrained_optimization::Minimum_angle_energy}
\cgalHasModel{CGAL::Reference_constrained_optimization::Quad_regularity_energy}
\cgalHasModel{CGAL::Reference_constrained_optimization::Quad_angle_energy}
\cgalHasModel{CGAL::Reference_constrained_optimization::Compatible_remeshing_energy}
\cgalHasModel{CGAL::Reference_constrained_optimization::Attraction_energy}
\cgalHasModel{CGAL::Reference_constrained_optimization::Sum_energy}

\sa `DistortionDensity`
*/
class ReferenceConstrainedEnergy
{
public:
  /// model of `DistortionDensity`; of an energy with elements.
  typedef unspecified_type Density;

  /// the criterion for the worst elements. *Optional*; without it only the sum matters.
  static constexpr CGAL::Reference_constrained_optimization::Element_criterion element_criterion;

  /// returns the density, which all elements share.
  const Density& density() const;

  /*!
  appends the elements of face `f` to `elements`.

  Within an element, `Energy_element::corners` are three different positions from 0 to
  `context.degree(f)` exclusively, in the cyclic order of the face; `Energy_element::rest` has the
  unit of length of the mesh, and a positive determinant; `Energy_element::weight` is positive. `context`
  provides the connectivity, the mean edge length and the areas of mesh and reference; the object that is
  handed over is a `CGAL::Reference_constrained_optimization::Mesh_energy_context`, which also has the mesh,
  its point map and its descriptors: an energy that asks for them, for example to read a property map, is a
  template of the context's type.

  It is called once for every face that is to be optimized (all, or those of the range of faces), in
  the order of `faces(mesh)`, from the thread that called `CGAL::reference_constrained_optimize()`,
  before any vertex has moved. What it appends must depend on the input alone.

  \throws CGAL::Reference_constrained_optimization::Invalid_input if the energy does not support this face.
  The mesh is then left as it was.
  */
  void append_elements(
    const CGAL::Reference_constrained_optimization::Energy_context& context,
    std::size_t f,
    std::vector<CGAL::Reference_constrained_optimization::Energy_element>& elements) const;

  /// the number of vertices of a stencil, 1 to 6; of an energy with stencils.
  static constexpr int stencil_size;

  /*!
  appends the stencils, before any vertex has moved. `context` is as for elements.

  \throws CGAL::Reference_constrained_optimization::Invalid_input if the energy does not fit the mesh.
  */
  template <typename Context>
  void append_stencils(
    const Context& context,
    std::vector<CGAL::Reference_constrained_optimization::Energy_stencil<stencil_size>>& stencils)
    const;

  /// returns the value of the stencil with number `stencil`, in the order in which they were appended, with its
  /// vertices at `points`. It must be finite everywhere, twice differentiable, and not negative.
  double value(std::size_t stencil,
               const std::array<Eigen::Vector3d, stencil_size>& points) const;

  /*!
  writes the gradient by the coordinates of the points, one after the other, and a positive semi-definite
  matrix in place of the Hessian, and returns the value.

  This function is *optional*. Where it is missing, derivatives are computed from differences of `value()`,
  a ten-thousandth of a mean edge apart, and negative eigenvalues are set to zero.
  */
  double projected_derivatives(
    std::size_t stencil,
    const std::array<Eigen::Vector3d, stencil_size>& points,
    Eigen::Matrix<double, 3 * stencil_size, 1>& gradient,
    Eigen::Matrix<double, 3 * stencil_size, 3 * stencil_size>& hessian) const;
};
