// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CLOSED_CURVES_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CLOSED_CURVES_H

#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>

#include <CGAL/Union_find.h>
#include <CGAL/boost/graph/iterator.h>

#include <queue>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The edges that a closed curve crosses, per edge.
typedef std::vector<char> Crossed_edges;

// A basis of the closed curves on a surface with one boundary, modulo 2: a path between points of the boundary
// separates the surface if, and only if, it crosses each of them an even number of times. (Tree-cotree
// decomposition: Eppstein, Dynamic generators of topologically embedded graphs, 2003.)
inline std::vector<Crossed_edges> closed_curves(const Cut_surface& surface)
{
  typedef Cut_surface::Mesh Mesh;
  const Mesh& mesh = surface.mesh();
  const auto is_crossable = [&](Mesh::Edge_index e) {
    return !surface.is_cut()[e] && !mesh.is_border(e);
  };
  // a spanning tree of the faces
  std::vector<Mesh::Halfedge_index> to_parent(mesh.number_of_faces(), Mesh::null_halfedge());
  std::vector<char> is_reached(mesh.number_of_faces(), 0), is_in_tree(mesh.number_of_edges(), 0);
  std::queue<Mesh::Face_index> queue;
  queue.push(*mesh.faces().begin());
  is_reached[queue.front()] = 1;
  for(; !queue.empty(); queue.pop())
    for(const Mesh::Halfedge_index h :
        CGAL::halfedges_around_face(mesh.halfedge(queue.front()), mesh))
      if(is_crossable(mesh.edge(h)) && !is_reached[mesh.face(mesh.opposite(h))])
      {
        const Mesh::Face_index f = mesh.face(mesh.opposite(h));
        is_reached[f] = 1;
        is_in_tree[mesh.edge(h)] = 1;
        to_parent[f] = mesh.opposite(h);
        queue.push(f);
      }
  // a spanning tree of the vertices, those of the boundary being one; the edges in neither tree close curves
  CGAL::Union_find<Mesh::Vertex_index> sets;
  std::vector<CGAL::Union_find<Mesh::Vertex_index>::handle> set_of;
  for(const Mesh::Vertex_index v : mesh.vertices())
    set_of.push_back(sets.make_set(v));
  for(const Mesh::Vertex_index v : mesh.vertices())
    if(surface.is_taken(v))
      sets.unify_sets(set_of[v], set_of[surface.landmarks().front()]);
  std::vector<Crossed_edges> curves;
  for(const Mesh::Edge_index e : mesh.edges())
  {
    if(!is_crossable(e) || is_in_tree[e])
      continue;
    const auto a = set_of[mesh.vertex(e, 0)], b = set_of[mesh.vertex(e, 1)];
    if(!sets.same_set(a, b))
    {
      sets.unify_sets(a, b);
      continue;
    }
    Crossed_edges crossed(mesh.number_of_edges(), 0);
    crossed[e] = 1;
    for(const int side : {0, 1})
    {
      Mesh::Face_index f = mesh.face(mesh.halfedge(e, side));
      for(; to_parent[f] != Mesh::null_halfedge(); f = mesh.face(mesh.opposite(to_parent[f])))
        crossed[mesh.edge(to_parent[f])] ^= 1;
    }
    curves.push_back(std::move(crossed));
  }
  return curves;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_CLOSED_CURVES_H
