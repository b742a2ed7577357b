// Shows a map between meshes of one connectivity: vertex by vertex, all of them get the colours and
// the texture coordinates of the first. In a viewer, the same colour is the same place.

#ifndef RCO_EXAMPLE_CHECKER_H
#define RCO_EXAMPLE_CHECKER_H

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/Color.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh/IO/PLY.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

class Checker
{
  static constexpr int number_of_cells = 10; // along the longest side
  std::string m_prefix;
  std::vector<CGAL::IO::Color> m_color;
  std::vector<std::pair<double, double>> m_texture; // in the unit square

  // s in the unit cube: position becomes colour, and every other cell is darker
  static CGAL::IO::Color color(const double (&s)[3], bool is_dark)
  {
    const double shade = is_dark ? 0.45 : 1;
    unsigned char rgb[3];
    for(int i = 0; i < 3; ++i)
      rgb[i] = (unsigned char)(shade * (60 + 195 * s[i]));
    return CGAL::IO::Color(rgb[0], rgb[1], rgb[2]);
  }

  std::ofstream open(const std::string& name) const
  {
    const std::string file = m_prefix + name;
    std::ofstream out(file, std::ios::binary);
    if(!out)
      throw std::runtime_error(file + " cannot be written");
    out.precision(17);
    return out;
  }

  // without the folder: files that refer to each other lie side by side
  std::string file_name(const std::string& name) const
  {
    return std::filesystem::path(m_prefix + name).filename().string();
  }

public:
  // Colours are a checker in space. Texture coordinates are a projection along the shortest side of
  // the source's bounding box: without a seam, but opposite sides look alike.
  Checker(const Mesh& source, const std::string& prefix) : m_prefix(prefix)
  {
    const CGAL::Bbox_3 box = CGAL::Polygon_mesh_processing::bbox(source);
    const auto side = [&](int i) { return box.max(i) - box.min(i); };
    int axis[3] = {0, 1, 2};
    std::sort(axis, axis + 3, [&](int i, int j) { return side(i) > side(j); });
    const double longest = side(axis[0]);
    for(const Mesh::Vertex_index v : source.vertices())
    {
      double s[3], t[3];
      int cells = 0;
      for(int i = 0; i < 3; ++i)
      {
        t[i] = (source.point(v)[i] - box.min(i)) / longest;
        s[i] = side(i) > 0 ? t[i] * longest / side(i) : 0;
        cells += int(number_of_cells * t[i]);
      }
      m_color.push_back(color(s, cells % 2 == 1));
      m_texture.emplace_back(t[axis[0]], t[axis[1]]);
    }
  }

  // writes the image <prefix>_checker.bmp, which all .mtl files name
  void write_image() const
  {
    // 512 times 512 pixels of 24 bits, without compression
    const unsigned char header[54] = {'B', 'M', 54, 0, 12, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40,
                                      0,   0,   0,  0, 2,  0, 0, 0, 2, 0, 0,  1, 0, 24};
    std::ofstream image = open("_checker.bmp");
    image.write(reinterpret_cast<const char*>(header), sizeof(header));
    for(int y = 0; y < 512; ++y)
      for(int x = 0; x < 512; ++x)
      {
        const double s[3] = {x / 512., y / 512., 1 - x / 512.};
        const int cells = x * number_of_cells / 512 + y * number_of_cells / 512;
        const CGAL::IO::Color c = color(s, cells % 2 == 1);
        image << c.blue() << c.green() << c.red();
      }
  }

  // writes <prefix>_<name>.ply with colours, and .obj and .mtl with the texture
  void write_mesh(Mesh mesh, const std::string& name) const
  {
    mesh.remove_all_property_maps(); // colours that came with the input
    auto colors = mesh.add_property_map<Mesh::Vertex_index, CGAL::IO::Color>("v:color").first;
    for(const Mesh::Vertex_index v : mesh.vertices())
      colors[v] = m_color[v];
    std::ofstream ply = open("_" + name + ".ply");
    CGAL::IO::set_binary_mode(ply);
    CGAL::IO::write_PLY(ply, mesh);

    // a file for each mesh, because some viewers do not read "mtllib" but guess the name
    open("_" + name + ".mtl") << "newmtl checker\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nmap_Kd "
                              << file_name("_checker.bmp") << '\n';
    std::ofstream obj = open("_" + name + ".obj");
    obj << "mtllib " << file_name("_" + name + ".mtl") << '\n';
    for(const Kernel::Point_3& p : mesh.points())
      obj << "v " << p << '\n';
    for(const auto& t : m_texture)
      obj << "vt " << t.first << ' ' << t.second << '\n';
    obj << "usemtl checker\n";
    for(const Mesh::Face_index f : mesh.faces())
    {
      obj << 'f';
      for(const Mesh::Vertex_index v : vertices_around_face(mesh.halfedge(f), mesh))
        obj << ' ' << v.idx() + 1 << '/' << v.idx() + 1;
      obj << '\n';
    }
  }
};

#endif // RCO_EXAMPLE_CHECKER_H
