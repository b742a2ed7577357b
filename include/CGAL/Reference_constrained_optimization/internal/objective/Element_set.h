// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ELEMENT_SET_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ELEMENT_SET_H

#include <CGAL/Reference_constrained_optimization/Energy_element.h>
#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <array>
#include <cmath>
#include <string>
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
    bool is_in_quad;                                            // its face has more corners than it
    Eigen::Matrix<double, 2, 2, Eigen::DontAlign> rest_inverse; // packed: there are many
  };

  // of the faces that are marked; of all if there are no marks. Lengths of rest triangles are told in
  // another unit: `unit` of these make one of the mesh.
  template <typename Energy>
  Element_set(const Energy& energy,
              const Energy_context& context,
              const std::vector<char>& is_in_range = std::vector<char>(),
              double unit = 1)
  {
    const std::size_t n = context.number_of_faces();
    m_begin.reserve(n + 1);
    m_begin.push_back(0);
    std::vector<Energy_element> elements;
    for(std::size_t f = 0; f < n; ++f)
    {
      elements.clear();
      if(!is_in_range.empty() && !is_in_range[f])
      {
        m_begin.push_back(int(m_elements.size()));
        continue;
      }
      energy.append_elements(context, f, elements);
      for(const Energy_element& e : elements)
      {
        const double det = e.rest.determinant();
        if(!(det > 0) || !std::isfinite(det))
          throw Invalid_input("energy: the rest triangle of an element of face " +
                              std::to_string(f) + " does not have a positive area");
        Element element;
        for(int i = 0; i < 3; ++i)
        {
          if(e.corners[i] < 0 || e.corners[i] >= context.degree(f))
            throw Invalid_input("energy: an element of face " + std::to_string(f) +
                                " names a corner that the face does not have");
          element.vertices[i] = context.vertex(f, e.corners[i]);
        }
        element.rest_inverse = (e.rest / unit).inverse();
        element.is_in_quad = context.degree(f) > 3;
        m_elements.push_back(element);
      }
      m_begin.push_back(int(m_elements.size()));
    }
    if(m_elements.empty() && is_in_range.empty())
      throw Invalid_input("energy: the mesh has no element");
  }

  int begin(int f) const { return m_begin[f]; }
  int end(int f) const { return m_begin[f + 1]; }
  const Element& operator[](int e) const { return m_elements[e]; }
  int size() const { return int(m_elements.size()); }

private:
  std::vector<int> m_begin;
  std::vector<Element> m_elements;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_OBJECTIVE_ELEMENT_SET_H
