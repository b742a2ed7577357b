// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_MEASURING_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_MEASURING_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/build_indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/named_parameters.h>

#include <CGAL/boost/graph/named_params_helper.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Shared by the quality measures: reading a mesh with its named parameters, and moments.

template <typename FaceGraph, typename NamedParameters>
auto measured_vertex_point_map(const FaceGraph& g, const NamedParameters& np)
{
  return parameters::choose_parameter(
    parameters::get_parameter(cgal_parameters(np), CGAL::internal_np::vertex_point),
    CGAL::get_const_property_map(CGAL::vertex_point, g));
}

template <typename FaceGraph, typename NamedParameters>
Mesh_copy read_measured_mesh(const FaceGraph& g, const NamedParameters& np, const std::string& name)
{
  return read_face_graph(g, measured_vertex_point_map(g, np), name);
}

// extrema, mean and standard deviation of a population
class Moments
{
public:
  void add(double x)
  {
    ++m_count;
    const double d = x - m_mean;
    m_mean += d / double(m_count);
    m_squares += d * (x - m_mean);
    m_minimum = (std::min)(m_minimum, x);
    m_maximum = (std::max)(m_maximum, x);
  }
  std::size_t count() const { return m_count; }
  double minimum() const { return m_count > 0 ? m_minimum : 0; }
  double maximum() const { return m_count > 0 ? m_maximum : 0; }
  double mean() const { return m_mean; }
  double standard_deviation() const
  {
    return m_count > 0 ? std::sqrt(m_squares / double(m_count)) : 0;
  }

private:
  std::size_t m_count = 0;
  double m_minimum = std::numeric_limits<double>::infinity();
  double m_maximum = -std::numeric_limits<double>::infinity();
  double m_mean = 0, m_squares = 0;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_MEASURING_H
