/*!
\ingroup PkgReferenceConstrainedOptimizationConcepts
\cgalConcept

The concept `DistortionDensity` describes a function of the 2x2 Jacobian \f$ J \f$ of the affine map
from an element's rest triangle to the element as it lies on the reference. A positive determinant
means that the element agrees with the orientation of the reference, a negative one that it is inverted.

The function must

- be finite and twice differentiable for *every* Jacobian, those with \f$ \det J \le 0 \f$ and
  \f$ J = 0 \f$ included: a density with a barrier is continued smoothly behind a cap, so that the energy of
  a mesh with inverted elements is defined, and they can be repaired;
- be positive, since tolerances are relative and elements are compared by ratios;
- not change if a rotation is applied after \f$ J \f$, since the frame of an element rotates with it.

It need not be convex. All functions are called from several threads at a time and must not change
the object.

A symmetric function of the signed singular values is best derived from
`CGAL::Reference_constrained_optimization::Isotropic_density`, which provides all of this concept.

\cgalHasModel{CGAL::Reference_constrained_optimization::Exponential_MIPS_density}
\cgalHasModel{CGAL::Reference_constrained_optimization::Symmetric_Dirichlet_density}
\cgalHasModel{CGAL::Reference_constrained_optimization::Isotropic_density}

\sa `ReferenceConstrainedEnergy`
*/
class DistortionDensity
{
public:
  /// returns the value at `J`.
  double value(const Eigen::Matrix2d& J) const;

  /// returns the derivatives of the value with respect to the entries of `J`, each at the position of its
  /// entry.
  Eigen::Matrix2d gradient(const Eigen::Matrix2d& J) const;

  /// returns the second derivatives, with the entries of `J` in column-major order: (0, 0), (1, 0),
  /// (0, 1), (1, 1). The matrix is symmetric; it need not be positive semi-definite.
  Eigen::Matrix4d hessian(const Eigen::Matrix2d& J) const;

  /*!
  writes the gradient, with the entries in column-major order, and a positive semi-definite matrix
  in place of the Hessian, the nearest one by choice, and returns the value.

  This function is *optional*. Where it is missing, `value()`, `gradient()` and `hessian()` are
  called, and negative eigenvalues of the Hessian are set to zero by a numerical
  eigen-decomposition. Where it exists, it is called in place of `gradient()` and `hessian()`; a
  closed formula is faster.
  */
  double projected_derivatives(const Eigen::Matrix2d& J,
                               Eigen::Vector4d& gradient,
                               Eigen::Matrix4d& hessian) const;
};
