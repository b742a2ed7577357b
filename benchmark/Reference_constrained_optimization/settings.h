#pragma once

// Settings that the drivers have in common.

#include "driver.h"

#include <CGAL/Reference_constrained_optimization/internal/rounds/Loop_parameters.h>

#include <limits>
#include <map>
#include <stdexcept>
#include <string>

const std::string common_usage = R"(  --developability E     threshold for a face to join a patch
  --patch-size N         largest number of faces of a patch; 0: by the size of the mesh
  --iterations N         largest number of outer iterations
  --tolerance T          relative decrease of the energy per iteration that ends the run
  --seed N               random seed
  --time-limit S         seconds
  --method NAME          ours (default); plain: every patch is flattened, and no more; paper: as the
                         paper describes it, one patch after the other, flattened from Tutte's
                         embedding, optimized to the end in the plane, and kept whatever comes back
  --parallel             use all threads (if built with TBB)
  --check                verify what is promised (by ours and plain)
  --output DIR           write the resulting mesh into this folder (OFF)

Exit code: 0, 1 if a check failed, 2 if an input or an option could not be used.
)";

inline std::map<std::string, bool> with_common_options(std::map<std::string, bool> own)
{
  own.insert({{"--developability", true},
              {"--patch-size", true},
              {"--iterations", true},
              {"--tolerance", true},
              {"--seed", true},
              {"--time-limit", true},
              {"--method", true},
              {"--parallel", false},
              {"--check", false},
              {"--output", true}});
  return own;
}

// the defaults are those of the library
struct Common_settings
{
  typedef RCO::internal::Loop_parameters Defaults;

  double developability, tolerance, time_limit;
  int patch_size;
  unsigned int iterations, seed;
  std::string method, output_folder;
  bool parallel, check;

  explicit Common_settings(const Command_line& a)
    : developability(a.number("--developability", Defaults().selection.developability_threshold)),
      tolerance(a.number("--tolerance", double(Defaults().energy_tolerance))),
      time_limit(a.number("--time-limit", std::numeric_limits<double>::infinity())),
      patch_size(a.number("--patch-size", int(Defaults().selection.maximum_patch_size))),
      iterations(a.number("--iterations", unsigned(Defaults().number_of_iterations))),
      seed(a.number("--seed", 0u)),
      method(a.text("--method", "ours")),
      output_folder(a.text("--output", "")),
      parallel(a.has("--parallel")),
      check(a.has("--check"))
  {
#ifndef CGAL_LINKED_WITH_TBB
    if(parallel)
      throw std::runtime_error("--parallel: this program was built without TBB");
#endif
  }
};

// in mean edges of the reference; negative: the library's default
inline double relative_drift_bound(const Command_line& a)
{
  return a.text("--drift-bound", "") == "inf" ? std::numeric_limits<double>::infinity()
                                              : a.number("--drift-bound", -1.);
}
