#pragma once

// The drivers' mesh type, reading and writing.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Surface_mesh.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace RCO = CGAL::Reference_constrained_optimization;
typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

inline Mesh read(const std::string& file)
{
  Mesh mesh;
  if(!CGAL::IO::read_polygon_mesh(file, mesh))
    throw std::runtime_error(file + " cannot be read as a polygon mesh");
  return mesh;
}

// writes <folder>/<name>.off with all digits; does nothing without a folder
inline void write(const Mesh& mesh, const std::string& folder, const std::string& name)
{
  if(folder.empty())
    return;
  const std::string path = folder + "/" + name + ".off";
  std::ofstream out(path);
  out.precision(17);
  if(!out || !CGAL::IO::write_OFF(out, mesh))
    throw std::runtime_error("cannot write " + path);
}

// a file's or folder's name without what is around it
inline std::string base_name(const std::string& file)
{
  const std::filesystem::path path(file);
  return (path.has_filename() ? path : path.parent_path()).stem().string();
}
