// Landmarks that are pulled towards their counterparts, and how far away from them they are.

#ifndef RCO_PROGRAM_SOFT_LANDMARKS_H
#define RCO_PROGRAM_SOFT_LANDMARKS_H

#include "landmarks.h"
#include "mesh.h"

#include <CGAL/Reference_constrained_optimization/Attraction_energy.h>
#include <CGAL/Reference_constrained_optimization/Energy_element.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

// Adds the squared distances over the area of the reference to the mean distortion of a map, so that the
// pull of a landmark depends neither on the fineness of meshes nor on other landmarks.
class Landmark_attraction : public RCO::Attraction_energy
{
public:
  Landmark_attraction(const Landmarks& landmarks, const Mesh& reference)
    : Attraction_energy(targets(landmarks, reference))
  {}

  void append_stencils(const RCO::Energy_context& context,
                       std::vector<RCO::Energy_stencil<1>>& stencils) const
  {
    std::size_t triangles = 0;
    for(std::size_t f = 0; f < context.number_of_faces(); ++f)
      triangles += std::size_t(context.degree(f) - 2);
    // the energy of a map is the sum of its triangles' densities, each twice the distortion
    const double scale = 2 * double(triangles) / context.reference_area();
    const double h = context.mean_edge_length();
    Attraction_energy::append_stencils(context, stencils);
    for(RCO::Energy_stencil<1>& stencil : stencils)
      stencil.weight *= scale * h * h;
  }

private:
  static std::vector<Target> targets(const Landmarks& landmarks, const Mesh& reference)
  {
    std::vector<Target> result;
    for(const auto& [v, w] : landmarks)
    {
      const Mesh::Point& p = reference.point(w);
      result.push_back({std::size_t(v), {p.x(), p.y(), p.z()}});
    }
    return result;
  }
};

struct Landmark_distances
{
  double mean = 0, maximum = 0;
};

inline Landmark_distances
landmark_distances(const Mesh& mesh, const Mesh& reference, const Landmarks& landmarks)
{
  Landmark_distances result;
  for(const auto& [v, w] : landmarks)
  {
    const double d = std::sqrt(CGAL::squared_distance(mesh.point(v), reference.point(w)));
    result.mean += d / double(landmarks.size());
    result.maximum = (std::max)(result.maximum, d);
  }
  return result;
}

#endif // RCO_PROGRAM_SOFT_LANDMARKS_H
