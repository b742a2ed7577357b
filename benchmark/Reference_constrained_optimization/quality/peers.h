#pragma once

// The optimizers that are compared, each moving a mesh along its own initial shape with its border
// fixed.

#include "../driver.h"
#include "Mesh_on_reference.h"
#include "Peer_result.h"
#include "Soft_constraint_optimizer.h"
#include "Star_smoother.h"
#include "cgal_peers.h"

#include <CGAL/Reference_constrained_optimization/Minimum_angle_energy.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>
#include <CGAL/reference_constrained_optimize.h>

#include <functional>
#include <map>
#include <string>

// what it makes of a mesh, in so many seconds
typedef std::function<Peer_result(const Mesh& input, double time_limit)> Peer;

namespace peers {

template <typename Named_parameters>
Peer_result optimize(const Mesh& input, const Named_parameters& np)
{
  return timed(input, [&](Mesh& mesh) {
    const auto r =
      CGAL::reference_constrained_optimize(mesh, mesh, RCO::Minimum_angle_energy(), np);
    return ::name(r.status) + ", " + iterations_text(r.number_of_iterations);
  });
}

inline Peer_result smooth_stars(const Mesh& input, double exponent_factor)
{
  return timed(input, [&](Mesh& mesh) {
    const int number_of_sweeps = 50;
    Mesh_on_reference on_reference(mesh);
    Star_smoother(on_reference, exponent_factor).run(number_of_sweeps);
    on_reference.give(mesh);
    return std::to_string(number_of_sweeps) + " sweeps";
  });
}

inline Peer_result constrain_softly(const Mesh& input)
{
  return timed(input, [](Mesh& mesh) {
    Mesh_on_reference on_reference(mesh);
    const int iterations = Soft_constraint_optimizer(on_reference).run({});
    on_reference.give(mesh);
    return iterations_text(iterations);
  });
}

} // namespace peers

inline std::map<std::string, Peer> all_peers()
{
  return {
    {"input",
     [](const Mesh& m, double) {
       return Peer_result{m, 0, ""};
     }},
    {"package",
     [](const Mesh& m, double limit) {
       return peers::optimize(m, CGAL::parameters::maximum_running_time(limit));
     }},
    {"plain",
     [](const Mesh& m, double limit) {
       return peers::optimize(
         m, CGAL::parameters::use_on_surface_steps(false).maximum_running_time(limit));
     }},
    {"stars1", [](const Mesh& m, double) { return peers::smooth_stars(m, 1); }},
    {"stars10", [](const Mesh& m, double) { return peers::smooth_stars(m, 10); }},
    {"soft", [](const Mesh& m, double) { return peers::constrain_softly(m); }},
    {"angles", [](const Mesh& m, double limit) { return smooth_angles(m, false, limit); }},
    {"angles_safe", [](const Mesh& m, double limit) { return smooth_angles(m, true, limit); }},
    {"relax", [](const Mesh& m, double limit) { return relax(m, false, limit); }},
    {"relax_guarded", [](const Mesh& m, double limit) { return relax(m, true, limit); }},
    {"remesh", [](const Mesh& m, double) { return remesh(m); }}};
}
