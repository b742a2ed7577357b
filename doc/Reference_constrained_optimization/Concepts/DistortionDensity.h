/*!
\ingroup PkgReferenceConstrainedOptimizationConcepts
\cgalConcept

The concept `DistortionDensity` describes a function of the 2x2 Jacobian \f$ J \f$ of the affine map
from an element's rest triangle to the element as it lies on the reference. A positive determinant
means that the element agrees with the orientation of the reference, a negative one that it is
turned over.

The function must be finite and twice differentiable for *every* Jacobian, those with
\f$ \det J \le 0 \f$ included: a density with a barrier is continued smoothly behind a cap, so that
a mesh that starts badly can be compared with itself and repaired. It should not change if a
rotation is applied after \f$ J \f$.

All functions are called from several threads at a time and must not change the object.

\cgalHasModel{CGAL::Reference_constrained_optimization::Exponential_MIPS_density}
\cgalHasModel{CGAL::Reference_constrained_optimization::Symmetric_Dirichlet_density}
*/
class DistortionDensity
{
public:
  /// returns the value at `J`.
  double value(const Eigen::Matrix2d& J) const;

  /// returns the derivatives of the value with respect to the entries of `J`.
  Eigen::Matrix2d gradient(const Eigen::Matrix2d& J) const;

  /// returns the second derivatives, with the entries of `J` in column-major order.
  Eigen::Matrix4d hessian(const Eigen::Matrix2d& J) const;

  /*!
  writes the gradient, in column-major order, and the nearest positive semi-definite matrix to the
  Hessian, and returns the value.

  This function is optional: without it the Hessian is projected by a numerical
  eigen-decomposition. A closed formula is faster.
  */
  double projected_derivatives(const Eigen::Matrix2d& J,
                               Eigen::Vector4d& gradient,
                               Eigen::Matrix4d& hessian) const;
};
