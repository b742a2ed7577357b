#pragma once

#include "meshes.h"

#include <CGAL/Reference_constrained_optimization/Default_visitor.h>

#include <cstddef>

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
