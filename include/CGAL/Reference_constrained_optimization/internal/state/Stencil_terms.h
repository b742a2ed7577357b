// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_STENCIL_TERMS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_STENCIL_TERMS_H

#include <CGAL/Reference_constrained_optimization/internal/reference/tangent_frame.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Patch.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The stencils of a patch for Newton's method: vertices move in space by their frames.
class Stencil_terms
{
public:
  typedef Stencil_gradient Gradient;
  typedef Stencil_hessian Hessian;

  struct Term
  {
    int stencil; // of the mesh
    int size;
    std::array<int, largest_stencil> vertices; // local; negative if it is outside the patch
    Stencil_points points;
    std::array<Tangent_frame, largest_stencil> frames;
  };

  // `frame(v)` is the matrix (3x2) by which vertex v moves in space when its coordinates do
  template <typename Frame>
  void collect(const Patch& patch, const Frame& frame)
  {
    m_stencils = patch.all_stencils;
    m_terms.clear();
    for(const Patch::Stencil& stencil : patch.stencils)
    {
      Term term{stencil.number, stencil.size, stencil.vertices, {}, {}};
      for(int i = 0; i < stencil.size; ++i)
      {
        const int v = stencil.vertices[i];
        term.points[i] = patch.position(v, patch.located);
        if(v >= 0)
          term.frames[i] = frame(v);
      }
      m_terms.push_back(term);
    }
  }

  const std::vector<Term>& terms() const { return m_terms; }

  // `displacement(v)`: of a vertex, in its frame
  template <typename Displacement>
  double value(const Term& term, const Displacement& displacement) const
  {
    return m_stencils->value(term.stencil, moved(term, displacement));
  }

  // by the coordinates of the term's vertices, two each
  template <typename Displacement>
  double derivatives(const Term& term,
                     const Displacement& displacement,
                     Stencil_gradient& gradient,
                     Stencil_hessian& hessian) const
  {
    Stencil_gradient g;
    Stencil_hessian h;
    const double value =
      m_stencils->projected_derivatives(term.stencil, moved(term, displacement), g, h);
    gradient.setZero(2 * term.size);
    hessian.setZero(2 * term.size, 2 * term.size);
    for(int i = 0; i < term.size; ++i)
    {
      if(term.vertices[i] < 0)
        continue;
      gradient.segment<2>(2 * i) = term.frames[i].transpose() * g.segment<3>(3 * i);
      for(int j = 0; j < term.size; ++j)
        if(term.vertices[j] >= 0)
          hessian.block<2, 2>(2 * i, 2 * j) =
            term.frames[i].transpose() * h.block<3, 3>(3 * i, 3 * j) * term.frames[j];
    }
    return value;
  }

  // the negative gradient in space
  void add_descent(std::vector<Vector_3>& descent) const
  {
    Stencil_gradient gradient;
    Stencil_hessian unused;
    for(const Term& term : m_terms)
    {
      m_stencils->projected_derivatives(term.stencil, term.points, gradient, unused);
      for(int i = 0; i < term.size; ++i)
        if(term.vertices[i] >= 0)
          descent[term.vertices[i]] -= gradient.segment<3>(3 * i);
    }
  }

private:
  template <typename Displacement>
  static Stencil_points moved(const Term& term, const Displacement& displacement)
  {
    Stencil_points points = term.points;
    for(int i = 0; i < term.size; ++i)
      if(term.vertices[i] >= 0)
        points[i] += term.frames[i] * displacement(term.vertices[i]);
    return points;
  }

  const Stencil_set* m_stencils = nullptr;
  std::vector<Term> m_terms;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_STATE_STENCIL_TERMS_H
