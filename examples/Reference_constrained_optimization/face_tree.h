// The search tree over the faces of a triangle mesh, by the name that the version of CGAL has for it.

#ifndef RCO_EXAMPLE_FACE_TREE_H
#define RCO_EXAMPLE_FACE_TREE_H

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/version.h>
#if CGAL_VERSION_NR >= 1060000000
#include <CGAL/AABB_traits_3.h>
#else
#include <CGAL/AABB_traits.h>
#endif

#if CGAL_VERSION_NR >= 1060000000
template <typename Kernel, typename Mesh>
using Face_tree =
  CGAL::AABB_tree<CGAL::AABB_traits_3<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;
#else
template <typename Kernel, typename Mesh>
using Face_tree =
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;
#endif

#endif // RCO_EXAMPLE_FACE_TREE_H
