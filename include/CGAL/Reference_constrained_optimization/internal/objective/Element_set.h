// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ELEMENT_SET_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ELEMENT_SET_H

#include <CGAL/Reference_constrained_optimization/Energy_element.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>
#include <CGAL/Reference_constrained_optimization/internal/numerics/projected_derivatives.h>
#include <CGAL/Reference_constrained_optimization/internal/objective/summands.h>

#include <array>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// All elements of an energy on a mesh; the elements of a face are consecutive.
class Element_set
{
public:
  struct Element
  {
    std::array<int, 3> vertices;
    bool has_criterion; // the energy has a criterion for elements
    bool is_in_quad;    // its face has more corners than it
    short term = 0;     // the summand of the energy
    double weight = 1;
    Eigen::Matrix<double, 2, 2, Eigen::DontAlign> rest_inverse; // packed: there are many
  };

  // of the marked faces; of all if none is marked. Lengths of rest triangles are divided by `unit`.
  template <typename Energy, typename Context>
  Element_set(const Energy& energy,
              const Context& context,
              const std::vector<char>& is_in_range = std::vector<char>(),
              double unit = 1)
  {
    // calls visit(summand, term, weight) for each that has elements and a positive weight
    const auto for_each_term = [&](const auto& visit) {
      short term = 0;
      for_each_summand(energy, 1, [&](const auto& summand, double weight) {
        if constexpr(Has_elements<std::decay_t<decltype(summand)>>::value)
        {
          if(weight > 0)
            visit(summand, term, weight);
          ++term;
        }
      });
    };
    m_criterion = criterion_of(energy);
    const std::size_t n = context.number_of_faces();
    m_begin.reserve(n + 1);
    m_begin.push_back(0);
    std::vector<Energy_element> elements;
    for(std::size_t f = 0; f < n; ++f)
    {
      if(!is_in_range.empty() && !is_in_range[f])
      {
        m_begin.push_back(int(m_elements.size()));
        continue;
      }
      for_each_term([&](const auto& summand, short term, double weight) {
        elements.clear();
        summand.append_elements(context, f, elements);
        for(const Energy_element& e : elements)
          append(e, Criterion_of<std::decay_t<decltype(summand)>>::value, term, weight, context, f,
                 unit);
      });
      m_begin.push_back(int(m_elements.size()));
    }
    if(m_elements.empty() && is_in_range.empty())
      throw Invalid_input(
        "energy: the mesh has no element; stencils alone do not keep faces in shape");
  }

  // the criterion for the worst elements
  Element_criterion criterion() const { return m_criterion; }

  // the sum of the weights of the elements of a term
  double weight_of_term(int term) const
  {
    double sum = 0;
    for(const Element& e : m_elements)
      sum += e.term == term ? e.weight : 0;
    return sum;
  }

  int begin(int f) const { return m_begin[f]; }
  int end(int f) const { return m_begin[f + 1]; }
  const Element& operator[](int e) const { return m_elements[e]; }
  int size() const { return int(m_elements.size()); }

private:
  void append(const Energy_element& e,
              Element_criterion criterion,
              short term,
              double weight,
              const Energy_context& context,
              std::size_t f,
              double unit)
  {
    const std::string name = " of an element of face " + std::to_string(f);
    const double det = e.rest.determinant();
    if(!(det > 0) || !std::isfinite(det))
      throw Invalid_input("energy: the rest triangle" + name + " does not have a positive area");
    if(!(e.weight > 0) || !std::isfinite(e.weight))
      throw Invalid_input("energy: the weight" + name + " is not positive and finite");
    Element element;
    for(int i = 0; i < 3; ++i)
    {
      if(e.corners[i] < 0 || e.corners[i] >= context.degree(f))
        throw Invalid_input("energy: an element of face " + std::to_string(f) +
                            " names a corner that the face does not have");
      element.vertices[i] = context.vertex(f, e.corners[i]);
    }
    element.rest_inverse = (e.rest / unit).inverse();
    element.has_criterion = criterion != Element_criterion::none;
    element.is_in_quad = context.degree(f) > 3;
    element.term = term;
    element.weight = weight * e.weight;
    m_elements.push_back(element);
  }

  Element_criterion m_criterion = Element_criterion::none;
  std::vector<int> m_begin;
  std::vector<Element> m_elements;
};

// The density of an element at a Jacobian, and its derivatives: of densities that depend on the element, and
// of those that do not.
template <typename Density>
auto element_value(const Density& density,
                   const Element_set::Element& element,
                   const Eigen::Matrix2d& J,
                   int) -> decltype(density.value(element, J))
{
  return density.value(element, J);
}
template <typename Density>
double
element_value(const Density& density, const Element_set::Element&, const Eigen::Matrix2d& J, long)
{
  return density.value(J);
}
template <typename Density>
auto element_derivatives(const Density& density,
                         const Element_set::Element& element,
                         const Eigen::Matrix2d& J,
                         Eigen::Vector4d& gradient,
                         Eigen::Matrix4d& hessian,
                         int) -> decltype(density.value(element, J))
{
  return density.projected_derivatives(element, J, gradient, hessian);
}
template <typename Density>
double element_derivatives(const Density& density,
                           const Element_set::Element&,
                           const Eigen::Matrix2d& J,
                           Eigen::Vector4d& gradient,
                           Eigen::Matrix4d& hessian,
                           long)
{
  return projected_derivatives(density, J, gradient, hessian, 0);
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ELEMENT_SET_H
