#pragma once

// The shape of a triangle in space, the exponent of the paper's equation (8): |J|^2 / det J for the
// map J from an equilateral triangle. It is 2 at best and infinite for a triangle without area.

#include "../meshes.h"

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>

typedef RCO::internal::Vector_3 Vector;

// the shape with its derivatives by one of the vertices
struct Triangle_shape_jet
{
  double value;
  Vector gradient;
  Eigen::Matrix3d hessian;
};

inline double triangle_shape(const Vector& a, const Vector& b, const Vector& c)
{
  const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  const double twice_area = (b - a).cross(c - a).norm();
  return twice_area > 0 ? squares / (std::sqrt(3.) * twice_area)
                        : std::numeric_limits<double>::infinity();
}

// with derivatives by vertex a; the triangle must have an area
inline Triangle_shape_jet triangle_shape_jet(const Vector& a, const Vector& b, const Vector& c)
{
  const Vector side = c - b, normal = (b - a).cross(c - a);
  const double twice_area = normal.norm(), root = std::sqrt(3.);
  const Vector unit = normal / twice_area;
  const double denominator = root * twice_area;
  // of the denominator; as a leaves the plane, the triangle turns about the side and grows
  const Vector slope = root * unit.cross(side);
  const double bend = root * side.squaredNorm() / twice_area;

  Triangle_shape_jet jet;
  jet.value = triangle_shape(a, b, c);
  jet.gradient = (2 * (2 * a - b - c) - jet.value * slope) / denominator;
  const Eigen::Matrix3d mixed = jet.gradient * slope.transpose();
  jet.hessian = (4 * Eigen::Matrix3d::Identity() - mixed - mixed.transpose() -
                 (jet.value * bend * unit) * unit.transpose()) /
                denominator;
  return jet;
}
