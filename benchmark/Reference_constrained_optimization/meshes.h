#ifndef RCO_BENCHMARK_MESHES_H
#define RCO_BENCHMARK_MESHES_H

// The drivers' mesh type, reading and writing.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Surface_mesh.h>

#include <cstddef>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

inline Mesh read(const std::string& file)
{
  Mesh mesh;
  if(!CGAL::IO::read_polygon_mesh(file, mesh))
    throw std::runtime_error("cannot be read as a polygon mesh");
  return mesh;
}

// the same for one of several files of a run: the message names it
inline Mesh read_or_name(const std::string& file)
{
  try
  {
    return read(file);
  }
  catch(const std::exception& e)
  {
    throw std::runtime_error(file + " " + e.what());
  }
}

// writes <folder>/<name>.off with all digits; blanks in the name become underscores
inline void write(const Mesh& mesh, const std::string& folder, std::string name)
{
  for(char& c : name)
    c = c == ' ' ? '_' : c;
  const std::string path = folder + "/" + name + ".off";
  std::ofstream out(path);
  out.precision(17);
  if(!out || !CGAL::IO::write_OFF(out, mesh))
    throw std::runtime_error("cannot write " + path);
}

// a file's name without folder and extension
inline std::string base_name(const std::string& file)
{
  const std::size_t slash = file.find_last_of("/\\"), start = slash + 1; // npos + 1 is 0
  const std::size_t dot = file.find_last_of('.');
  return file.substr(start, dot != std::string::npos && dot > start ? dot - start : dot);
}

#endif // RCO_BENCHMARK_MESHES_H
