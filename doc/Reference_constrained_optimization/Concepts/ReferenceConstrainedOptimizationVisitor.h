/*!
\ingroup PkgReferenceConstrainedOptimizationConcepts
\cgalConcept

The concept `ReferenceConstrainedOptimizationVisitor` describes an object that watches an
optimization and may stop it. It is handed over with the named parameter `visitor`, by `std::ref`
if the caller wants to read from it afterwards. All calls come from the thread that called
`CGAL::reference_constrained_optimize()`.

\cgalHasModel{CGAL::Reference_constrained_optimization::Default_visitor}
*/
class ReferenceConstrainedOptimizationVisitor
{
public:
  /// is called before the outer iteration `iteration`, counted from 0.
  void on_iteration_begin(std::size_t iteration);

  /// is called after that iteration with the mean density of the mesh.
  void on_iteration_end(std::size_t iteration, double energy);

  /// is called before a round of patches that share no face.
  void on_round_begin(std::size_t number_of_patches);

  /// is called after that round.
  void on_round_end();

  /// is called for every patch of the round when it has been decided whether to keep its result.
  void on_patch_end(const CGAL::Reference_constrained_optimization::Patch_report& report);

  /// returns `false` to end the optimization; the mesh then holds the last accepted state.
  bool go_further();
};
