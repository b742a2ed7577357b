#pragma once

// Choices and numbers from the bytes that a fuzzer hands out. After the last byte all are 0.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

class Byte_reader
{
public:
  Byte_reader(const std::uint8_t* data, std::size_t size) : m_data(data), m_end(data + size) {}

  unsigned byte() { return m_data == m_end ? 0 : *m_data++; }
  // in {0, ..., n - 1}
  unsigned below(unsigned n) { return n > 0 ? byte() % n : 0; }
  bool flag() { return byte() % 2 == 1; }

  std::uint64_t word()
  {
    std::uint64_t w = 0;
    for(int i = 0; i < 8; ++i)
      w |= std::uint64_t(byte()) << (8 * i);
    return w;
  }

  // mostly on a coarse grid, where points and lines fall together
  double number()
  {
    typedef std::numeric_limits<double> Limits;
    const double nan = Limits::quiet_NaN(), infinity = Limits::infinity(), largest = Limits::max(),
                 smallest = Limits::min(), denormal = Limits::denorm_min();
    const std::array<double, 20> special = {
      {nan,  infinity, -infinity, largest, smallest, denormal, -0.,  1e160,  -1e100, 1e61,
       1e50, 1e16,     -1e6,      1e3,     1e-3,     1e-6,     1e-9, -1e-16, 1e-61,  1e-160}};
    const unsigned kind = byte();
    if(kind < 200)
      return (kind < 100 ? int(kind) : 99 - int(kind)) / 8.;
    if(kind < 250)
      return special[kind % special.size()];
    const std::uint64_t w = word();
    double x;
    std::memcpy(&x, &w, sizeof x);
    return x;
  }

private:
  const std::uint8_t *m_data, *m_end;
};
