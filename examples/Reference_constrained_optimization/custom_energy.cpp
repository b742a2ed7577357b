// An energy of one's own: triangles of even size and good shape.
//
//   custom_energy [mesh [result.off]]

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/reference_constrained_optimize.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace RCO = CGAL::Reference_constrained_optimization;
typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

// model of DistortionDensity: D(J) = |J|^2 / 2 + b(det J). The first term favours small triangles, the
// barrier b(t) = 1 / t large ones; the minimum D = 2 is at rotations. Below t = 0.1 the barrier is
// continued by a parabola with the same first and second derivative, so that D is finite everywhere.
class Area_and_shape_density
{
  typedef Eigen::Matrix2d Matrix;
  struct Barrier
  {
    double value, slope, bend;
    explicit Barrier(double t)
    {
      const double s = (std::max)(t, 0.1), h = t - s; // h is 0 above the threshold
      bend = 2 / (s * s * s);
      slope = -1 / (s * s) + h * bend;
      value = 1 / s - h / (s * s) + 0.5 * h * h * bend;
    }
  };
  static Barrier barrier(const Matrix& J) { return Barrier(J.determinant()); }

public:
  double value(const Matrix& J) const { return 0.5 * J.squaredNorm() + barrier(J).value; }
  Matrix gradient(const Matrix& J) const
  {
    return J + barrier(J).slope * (J.trace() * Matrix::Identity() - J.transpose());
  }
  // by entries of J in column-major order; the library makes it positive semi-definite
  Eigen::Matrix4d hessian(const Matrix& J) const
  {
    const Barrier b = barrier(J);
    const Eigen::Vector4d first(J(1, 1), -J(0, 1), -J(1, 0), J(0, 0)); // derivatives of det J
    Eigen::Matrix4d second;
    second << 0, 0, 0, 1, 0, 0, -1, 0, 0, -1, 0, 0, 1, 0, 0, 0;
    return Eigen::Matrix4d::Identity() + b.bend * first * first.transpose() + b.slope * second;
  }
};

// model of ReferenceConstrainedEnergy: one element per face, at rest an equilateral triangle with
// the mean area of the mesh's faces
struct Area_and_shape_energy
{
  typedef Area_and_shape_density Density;
  Density shared;
  const Density& density() const { return shared; }

  void append_elements(const RCO::Energy_context& mesh,
                       std::size_t f,
                       std::vector<RCO::Energy_element>& elements) const
  {
    if(mesh.degree(f) != 3)
      throw RCO::Invalid_input("face " + std::to_string(f) + " is not a triangle");
    const double area = mesh.mesh_area() / double(mesh.number_of_faces());
    RCO::Energy_element element;
    element.rest = RCO::equilateral_rest_triangle(std::sqrt(4 * area / std::sqrt(3.)));
    elements.push_back(element);
  }
};

int main(int argc, char* argv[])
{
  const std::string file = argc > 1 ? argv[1] : CGAL::data_file_path("meshes/blobby.off");
  try
  {
    Mesh mesh;
    if(!CGAL::IO::read_polygon_mesh(file, mesh))
      throw std::runtime_error("cannot be read as a polygon mesh");
    const RCO::Result r = CGAL::reference_constrained_optimize(mesh, mesh, Area_and_shape_energy());
    std::cout << "mean energy: " << r.initial_energy << " before, " << r.final_energy << " after\n";
    if(argc > 2 && !CGAL::IO::write_polygon_mesh(argv[2], mesh))
      throw std::runtime_error(std::string("cannot write ") + argv[2]);
  }
  catch(const std::exception& e)
  {
    std::cerr << "Error: " << file << ": " << e.what() << std::endl;
    return 1;
  }
}
