// The call of the library, with what the command line says.

#ifndef RCO_PROGRAM_OPTIMIZATION_H
#define RCO_PROGRAM_OPTIMIZATION_H

#include "landmarks.h"
#include "mesh.h"
#include "options.h"

#include <CGAL/Reference_constrained_optimization/Result.h>

// Mesh and reference may be one object; so may source and mesh. drift_bound is a length, negative
// for the library's default; source and landmarks serve maps only.
RCO::Result optimize(Mesh& mesh,
                     const Mesh& reference,
                     const Mesh& source,
                     const Landmarks& landmarks,
                     double drift_bound,
                     const Options& options);

// whether the program was built with TBB
bool can_use_threads();

#endif // RCO_PROGRAM_OPTIMIZATION_H
