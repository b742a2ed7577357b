/*!
\ingroup PkgReferenceConstrainedOptimizationConcepts
\cgalConcept

The concept `ReferenceConstrainedOptimizationVisitor` describes an object that observes an optimization and
may stop it. It is passed with the named parameter `visitor`, by `std::ref` if the caller wants to read from
it afterwards; otherwise a copy is used.

All calls come from the thread that called `CGAL::reference_constrained_optimize()`. If one of them
throws, the mesh holds the last accepted state and the exception reaches the caller. Rounds follow
each other within an iteration; those that visit the worst elements at the end come after the last
iteration and belong to none. If no vertex is free to move, `go_further()` is all that is called.

\cgalHasModel{CGAL::Reference_constrained_optimization::Default_visitor}
*/
class ReferenceConstrainedOptimizationVisitor
{
public:
  /// is called before the outer iteration `iteration`, counted from 0.
  void on_iteration_begin(std::size_t iteration);

  /// is called after that iteration, also if it was cut short, with the mean density of the mesh.
  void on_iteration_end(std::size_t iteration, double energy);

  /// is called before a round of patches that share no face.
  void on_round_begin(std::size_t number_of_patches);

  /// is called after that round.
  void on_round_end();

  /// is called for every patch of the round, in a fixed order, when it has been decided whether to
  /// keep its result. Patches that were not visited because the round was cut short are left out.
  void on_patch_end(const CGAL::Reference_constrained_optimization::Patch_report& report);

  /// Returns `false` to end the optimization. It is called often, also within patches and while the calling
  /// thread waits for others; on a mesh of 50000 vertices more than ten times per second. It should be
  /// fast, and is not called again after it returned `false`. Unfinished patches are abandoned, and the
  /// mesh holds the last accepted state. During setup, which precedes the first iteration, the mesh is left
  /// as it was.
  bool go_further();
};
