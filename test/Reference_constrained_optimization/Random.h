// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Random numbers that are the same everywhere, and matrices made of them.

#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>

namespace rco_test {

typedef Eigen::Matrix2d Matrix_2;
typedef Eigen::Vector2d Vector_2;
typedef Eigen::Vector3d Vector_3;

const double pi = 3.14159265358979323846;

class Random
{
public:
  explicit Random(std::uint64_t seed) : m_state(seed * 2862933555777941757ull + 3037000493ull)
  {
    bits();
    bits();
  }

  // uniform in [0, 1)
  double operator()() { return double(bits()) / 4294967296.; }
  double operator()(double low, double high) { return low + (high - low) * (*this)(); }
  // uniform in {0, ..., n - 1}
  int index(int n) { return int((*this)() * n); }

  Vector_3 in_cube(double half)
  {
    const double x = (*this)(-half, half), y = (*this)(-half, half), z = (*this)(-half, half);
    return Vector_3(x, y, z);
  }
  // inside a triangle, uniformly
  Vector_3 barycentric()
  {
    double a = (*this)(), b = (*this)();
    if(a + b > 1)
    {
      a = 1 - a;
      b = 1 - b;
    }
    return Vector_3(1 - a - b, a, b);
  }

private:
  std::uint64_t bits()
  {
    m_state = m_state * 6364136223846793005ull + 1442695040888963407ull;
    return m_state >> 32;
  }

  std::uint64_t m_state;
};

inline Matrix_2 rotation(double angle)
{
  Matrix_2 r;
  r << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return r;
}

inline Matrix_2 with_singular_values(double s1, double s2, Random& random)
{
  const Matrix_2 u = rotation(random(0, 2 * pi)), v = rotation(random(0, 2 * pi));
  return u * Vector_2(s1, s2).asDiagonal() * v;
}

} // namespace rco_test
