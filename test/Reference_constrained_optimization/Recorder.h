// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// A visitor that tests and adds up what it is told.

#pragma once

#include "checks.h"

#include <CGAL/Reference_constrained_optimization/Default_visitor.h>
#include <CGAL/Reference_constrained_optimization/Result.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace rco_test {

namespace RCO = CGAL::Reference_constrained_optimization;

struct Stopped : std::runtime_error
{
  Stopped() : std::runtime_error("the visitor stops") {}
};

// the tolerance for the rounding of sums in the energies that a visitor receives
const double on_the_way = 1e-8;

// Tests every patch and adds up what it is told; stops when told to.
struct Recorder : RCO::Default_visitor
{
  long questions_until_stop = -1, patches_until_throw = -1;
  long questions = 0, questions_of_setup = 0, questions_of_iterations = 0;

  std::size_t iterations = 0, rounds = 0, patches = 0, accepted = 0, faces = 0, open_rounds = 0;
  std::size_t announced = 0;
  double energy_change = 0;
  std::size_t finishing = 0; // accepted patches of the finishing stage
  long defect_change = 0;
  std::vector<double> energies, changes; // at the end of each iteration, the latter from the start

  void on_iteration_begin(std::size_t i)
  {
    RCO_CHECK_EQUAL(i, iterations);
    if(i == 0)
      questions_of_setup = questions;
  }
  void on_iteration_end(std::size_t i, double energy)
  {
    RCO_CHECK_EQUAL(i, iterations);
    RCO_CHECK(std::isfinite(energy));
    ++iterations;
    questions_of_iterations = questions;
    energies.push_back(energy);
    changes.push_back(energy_change);
  }
  void on_round_begin(std::size_t n)
  {
    ++rounds;
    ++open_rounds;
    announced += n;
  }
  void on_round_end() { --open_rounds; }
  void on_patch_end(const RCO::Patch_report& r)
  {
    ++patches;
    faces += r.number_of_faces;
    if(r.accepted)
    {
      ++accepted;
      RCO_CHECK(r.defects_after < r.defects_before ||
                (r.defects_after == r.defects_before && r.energy_after < r.energy_before));
      // in the finishing stage energies have a barrier, and steps may be taken back
      finishing += r.is_finishing;
      energy_change += r.energy_after - r.energy_before;
      defect_change += long(r.defects_after) - long(r.defects_before);
    }
    else
    {
      RCO_CHECK_EQUAL(r.defects_after, r.defects_before);
      RCO_CHECK_EQUAL(r.energy_after, r.energy_before);
    }
    if(patches_until_throw >= 0 && patches_until_throw-- == 0)
      throw Stopped();
  }
  bool go_further()
  {
    ++questions;
    return questions_until_stop < 0 || questions_until_stop-- > 0;
  }

  // what was told adds up to the result; sums are rounded on the way
  void check_sums(const RCO::Result& r, double number_of_elements) const
  {
    RCO_CHECK_EQUAL(r.number_of_patches, patches);
    RCO_CHECK_EQUAL(r.number_of_accepted_patches, accepted);
    if(finishing > 0)
      return;
    RCO_CHECK_EQUAL(long(r.number_of_flips + r.number_of_fold_edges + r.number_of_nonconvex_quads) -
                      long(r.initial_number_of_flips + r.initial_number_of_fold_edges +
                           r.initial_number_of_nonconvex_quads),
                    defect_change);
    if(!(r.initial_energy < 1e6))
      return;
    const double rounding = on_the_way * r.initial_energy * number_of_elements;
    for(std::size_t i = 1; i < energies.size(); ++i)
      RCO_CHECK_NEAR((energies[i] - energies[i - 1]) * number_of_elements,
                     changes[i] - changes[i - 1], rounding);
    RCO_CHECK_NEAR((r.final_energy - r.initial_energy) * number_of_elements, energy_change,
                   rounding);
  }
};

} // namespace rco_test
