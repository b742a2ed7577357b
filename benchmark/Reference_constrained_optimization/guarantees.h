#pragma once

// What --check verifies in all drivers.

#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/Default_visitor.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>

#include <cstddef>
#include <cstdio>
#include <string>

inline std::string in_short(double x)
{
  char text[64];
  std::snprintf(text, sizeof text, "%.2g", x);
  return text;
}

// counts accepted patches that do not lower (defects, energy) in lexicographic order
struct Monotonicity_visitor : RCO::Default_visitor
{
  std::size_t violations = 0;

  void on_patch_end(const RCO::Patch_report& r)
  {
    if(r.accepted && r.defects_after >= r.defects_before &&
       !(r.defects_after == r.defects_before && r.energy_after < r.energy_before))
      ++violations;
  }
};

struct Defects_in_and_out
{
  RCO::Orientation_defects in, out;
};

// the guarantees that are violated, in words
class Violated_guarantees
{
public:
  void add_if(bool is_broken, const std::string& words)
  {
    if(is_broken)
      m_text += (m_text.empty() ? "" : "; ") + words;
  }

  // The guarantees of every run. Not all vertices that may move need be on the reference, as those of borders
  // that slide.
  template <typename May_move, typename Is_on_reference>
  void check_run(const Mesh& input,
                 const Mesh& output,
                 const Mesh& reference,
                 const Defects_in_and_out& defects,
                 std::size_t monotonicity_violations,
                 const May_move& may_move,
                 const Is_on_reference& is_on_reference)
  {
    std::size_t moved = 0;
    for(const Mesh::Vertex_index v : input.vertices())
      moved += !may_move(v) && input.point(v) != output.point(v);
    const auto none = CGAL::parameters::default_values();
    const auto distance =
      RCO::distance_to_reference(output, reference, none, none, is_on_reference);
    add_if(monotonicity_violations > 0,
           std::to_string(monotonicity_violations) + " patches not monotone");
    add_if(!distance.is_on_reference(), "vertex " + std::to_string(distance.vertex) +
                                          " off the reference by " + in_short(distance.maximum) +
                                          " (tolerance " + in_short(distance.tolerance) + ")");
    add_if(moved > 0, std::to_string(moved) + " fixed vertices moved");
    add_if(defects.out.total() > defects.in.total(), "flips and folds rose from " +
                                                       std::to_string(defects.in.total()) + " to " +
                                                       std::to_string(defects.out.total()));
  }

  const std::string& text() const { return m_text; }

private:
  std::string m_text;
};
