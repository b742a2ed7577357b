// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_POLYLINE_SET_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_POLYLINE_SET_H

#include <CGAL/Reference_constrained_optimization/internal/mesh/Indexed_mesh.h>

#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// a point of a polyline: a segment and the fraction of its length; segment -1: on no polyline
struct Polyline_point
{
  int segment = -1;
  double fraction = 0;
};

// Polylines on R along which vertices slide: its border, and lines of constrained edges.
class Polyline_set
{
public:
  struct Segment
  {
    Vector_3 from, to;
    int face;                     // of R, at it; -1 if not known
    int next = -1, previous = -1; // the neighbouring segments, if there are any
  };

  int add(const Vector_3& from, const Vector_3& to, int face)
  {
    m_segments.push_back({from, to, face});
    return int(m_segments.size()) - 1;
  }
  void connect(int segment, int next)
  {
    m_segments[segment].next = next;
    m_segments[next].previous = segment;
  }

  const std::vector<Segment>& segments() const { return m_segments; }
  const Segment& operator[](int segment) const { return m_segments[segment]; }

  Vector_3 position(const Polyline_point& p) const
  {
    const Segment& s = m_segments[p.segment];
    return s.from + p.fraction * (s.to - s.from);
  }

  // of unit length, forward; between two segments the mean of theirs
  Vector_3 tangent(const Polyline_point& p) const
  {
    const Segment& s = m_segments[p.segment];
    Vector_3 t = direction(s);
    const double at_end = 1e-9;
    if(p.fraction <= at_end && s.previous >= 0)
      t += direction(m_segments[s.previous]);
    else if(p.fraction >= 1 - at_end && s.next >= 0)
      t += direction(m_segments[s.next]);
    return t.normalized();
  }

  // moves by a length, forward or (if it is negative) backward; false if the line ends before
  bool advance(Polyline_point& p, double length) const
  {
    // bounds the number of steps on a closed line of tiny segments
    for(std::size_t step = 0; step <= m_segments.size(); ++step)
    {
      const Segment& s = m_segments[p.segment];
      const double segment_length = (s.to - s.from).norm();
      const double reached = p.fraction * segment_length + length;
      if(reached >= 0 && reached <= segment_length)
      {
        p.fraction = segment_length > 0 ? reached / segment_length : 0;
        return true;
      }
      const int other = reached < 0 ? s.previous : s.next;
      if(other < 0)
        return false;
      length = reached < 0 ? reached : reached - segment_length;
      p.segment = other;
      p.fraction = reached < 0 ? 1 : 0;
    }
    return false;
  }

private:
  static Vector_3 direction(const Segment& s) { return (s.to - s.from).normalized(); }

  std::vector<Segment> m_segments;
};

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_REFERENCE_POLYLINE_SET_H
