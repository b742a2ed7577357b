// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_FACE_RANGE_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_FACE_RANGE_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/state/Optimization_state.h>

#include <CGAL/boost/graph/properties.h>

#include <boost/graph/graph_traits.hpp>

#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Whether Range is a range of face descriptors of Graph. Graph's traits are only instantiated if Range is a
// range.
template <typename Range, typename Graph, typename = void>
struct Is_face_range : std::false_type
{};
template <typename Range, typename Graph>
struct Is_face_range<Range,
                     Graph,
                     std::void_t<decltype(*std::begin(std::declval<const Range&>())),
                                 typename boost::graph_traits<Graph>::face_descriptor>>
  : std::is_convertible<decltype(*std::begin(std::declval<const Range&>())),
                        typename boost::graph_traits<Graph>::face_descriptor>
{};

// the range of all faces
struct All_faces
{};

// per face, in the graph's order, whether it is in the range; empty if all are
template <typename FaceGraph>
std::vector<char> mark_faces(const FaceGraph&, const All_faces&)
{
  return std::vector<char>();
}
template <typename FaceGraph, typename FaceRange>
std::vector<char> mark_faces(const FaceGraph& g, const FaceRange& range)
{
  typedef boost::graph_traits<FaceGraph> Graph_traits;
  typedef typename Graph_traits::face_descriptor face_descriptor;
  auto mark = get(CGAL::dynamic_face_property_t<char>(), g);
  for(const face_descriptor f : faces(g))
    put(mark, f, char(0));
  for(const face_descriptor f : range)
  {
    if(f == Graph_traits::null_face())
      throw Invalid_input("faces: the range holds a face that is none");
    put(mark, f, char(1));
  }
  std::vector<char> result;
  for(const face_descriptor f : faces(g))
    result.push_back(get(mark, f));
  return result;
}

// vertices with a face outside the range stay
inline void constrain_outside(const Indexed_mesh& mesh,
                              const std::vector<char>& is_in_range,
                              Constraints& constraints)
{
  if(is_in_range.empty())
    return;
  for(int c = 0; c < mesh.number_of_corners(); ++c)
    if(!is_in_range[mesh.corner_face[c]])
      constraints.is_constrained[mesh.corner_vertex[c]] = 1;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_READING_FACE_RANGE_H
