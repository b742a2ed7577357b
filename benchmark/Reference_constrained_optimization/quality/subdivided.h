#pragma once

// Finer quad meshes of a surface.

#include "../meshes.h"
#include "../shape.h"

#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/subdivision_method_3.h>

// `steps` steps of Catmull-Clark subdivision. After each the vertices are put onto the reference,
// but for those at the border: they stay, or halve its edges.
inline Mesh subdivided(Mesh mesh, const Mesh& reference, int steps)
{
  if(steps == 0)
    return mesh;
  const Shape shape(reference);
  CGAL::Polygon_mesh_processing::remove_isolated_vertices(mesh);
  mesh.collect_garbage();
  for(int i = 0; i < steps; ++i)
  {
    const Mesh coarse = mesh;
    CGAL::Subdivision_method_3::CatmullClark_subdivision(mesh,
                                                         CGAL::parameters::number_of_iterations(1));
    for(const Mesh::Vertex_index v : mesh.vertices())
    {
      Kernel::Point_3& p = mesh.point(v);
      if(!mesh.is_border(v))
        p = shape.project(p);
      else if(coarse.has_valid_index(v))
        p = coarse.point(v);
    }
  }
  return mesh;
}
