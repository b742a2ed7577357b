// Reads and writes meshes. What a file says comes through unchanged: vertices and faces keep their
// order, because landmarks and maps go by it, and nothing is repaired in silence.

#ifndef RCO_PROGRAM_MESH_FILES_H
#define RCO_PROGRAM_MESH_FILES_H

#include "mesh.h"
#include "outcome.h"

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>
#include <CGAL/boost/graph/helpers.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

inline std::string lower_case_extension(const std::string& file)
{
  std::string extension = std::filesystem::path(file).extension().string();
  for(char& c : extension)
    c = char(std::tolower((unsigned char)c));
  return extension;
}

inline bool has_mesh_extension(const std::string& file)
{
  const std::string extension = lower_case_extension(file);
  return extension == ".off" || extension == ".obj" || extension == ".ply" || extension == ".stl";
}

inline Mesh read_mesh(const std::string& file)
{
  namespace PMP = CGAL::Polygon_mesh_processing;
  if(!has_mesh_extension(file))
    throw Failure(Outcome::unreadable_file,
                  file + ": the name must end in .off, .obj, .ply or .stl");
  std::error_code error;
  if(std::filesystem::is_directory(file, error) || !std::ifstream(file))
    throw Failure(Outcome::unreadable_file, file + " cannot be opened");
  std::vector<Mesh::Point> points;
  std::vector<std::vector<std::size_t>> faces;
  bool is_read = false;
  try
  {
    const std::string extension = lower_case_extension(file);
    std::ifstream in(file, std::ios::binary);
    is_read = extension == ".off"   ? CGAL::IO::read_OFF(in, points, faces)
              : extension == ".obj" ? CGAL::IO::read_OBJ(in, points, faces)
              : extension == ".ply" ? CGAL::IO::read_PLY(in, points, faces)
                                    : CGAL::IO::read_STL(in, points, faces);
  }
  catch(const std::exception&) // a number of vertices that no memory could hold
  {}
  if(!is_read)
    throw Failure(Outcome::unreadable_file, file + " cannot be read as a mesh");
  if(faces.empty())
    throw Failure(Outcome::unreadable_file, file + " has no faces");
  for(std::size_t f = 0; f < faces.size(); ++f)
    for(const std::size_t v : faces[f])
      if(v >= points.size())
        throw Failure(Outcome::unreadable_file,
                      file + ": face " + std::to_string(f) + " names a vertex that is not there");
  if(!PMP::is_polygon_soup_a_polygon_mesh(faces))
    throw Failure(Outcome::refused_input,
                  file + " is not manifold, or its faces are not oriented alike");
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(points, faces, mesh);
  return mesh;
}

// what can be known before the work begins
inline void check_output(const std::string& file, const Mesh& mesh)
{
  if(!has_mesh_extension(file))
    throw Failure(Outcome::unwritable_file,
                  file + ": the name must end in .off, .obj, .ply or .stl");
  if(lower_case_extension(file) == ".stl" && !CGAL::is_triangle_mesh(mesh))
    throw Failure(Outcome::unwritable_file, file + ": STL has no faces but triangles");
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  std::error_code error;
  if(!std::filesystem::is_directory(folder, error))
    throw Failure(Outcome::unwritable_file, file + ": there is no folder " + folder.string());
}

inline void write_mesh(const std::string& file, const Mesh& mesh)
{
  const std::string extension = lower_case_extension(file);
  std::ofstream out(file, std::ios::binary);
  out.precision(17); // positions come back as they were
  bool is_written = bool(out);
  if(is_written && extension == ".off")
    is_written = CGAL::IO::write_OFF(out, mesh);
  else if(is_written && extension == ".obj")
    is_written = CGAL::IO::write_OBJ(out, mesh);
  else if(is_written && extension == ".ply")
  {
    CGAL::IO::set_binary_mode(out);
    is_written = CGAL::IO::write_PLY(out, mesh);
  }
  else if(is_written) // as text: binary STL has single precision only
    is_written = CGAL::IO::write_STL(out, mesh);
  out.close();
  if(!is_written || !out)
    throw Failure(Outcome::unwritable_file, file + " cannot be written");
}

#endif // RCO_PROGRAM_MESH_FILES_H
