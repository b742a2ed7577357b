// The mesh that the program works on.

#ifndef RCO_PROGRAM_MESH_H
#define RCO_PROGRAM_MESH_H

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

// the namespace exists only if one of the library headers is included
namespace CGAL {
namespace Reference_constrained_optimization {}
} // namespace CGAL
namespace RCO = CGAL::Reference_constrained_optimization;

typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

#endif // RCO_PROGRAM_MESH_H
