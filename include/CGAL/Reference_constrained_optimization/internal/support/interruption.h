// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_INTERRUPTION_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_INTERRUPTION_H

#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/internal/support/seconds_since.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// thrown where work under way is given up
struct Interrupted
{};

// Whether to go on. Any thread may ask, often; the visitor and the clock are asked by the thread that
// made the object alone, the others learn from it.
class Interruption
{
public:
  template <typename Visitor>
  Interruption(Visitor& visitor,
               const std::chrono::steady_clock::time_point& start,
               double maximum_running_time)
    : m_goes_on([&visitor]() { return visitor.go_further(); }),
      m_start(start),
      m_maximum_running_time(maximum_running_time),
      m_owner(std::this_thread::get_id())
  {}

  bool stops()
  {
    if(!m_has_stopped && std::this_thread::get_id() == m_owner)
      ask();
    return m_has_stopped;
  }
  // a place where work may be given up
  void check()
  {
    if(stops())
      throw Interrupted();
  }

  bool has_stopped() const { return m_has_stopped; }
  // why, if it has stopped
  Status status() const { return m_status; }

private:
  void ask()
  {
    if(seconds_since(m_start) > m_maximum_running_time)
      m_status = Status::time_limit;
    else
    {
      bool goes_on = false;
      try
      {
        goes_on = m_goes_on();
      }
      catch(...)
      {
        m_has_stopped = true; // the other threads need not go on, either
        throw;
      }
      if(goes_on)
        return;
    }
    m_has_stopped = true;
  }

  std::function<bool()> m_goes_on;
  std::chrono::steady_clock::time_point m_start;
  double m_maximum_running_time;
  std::thread::id m_owner;
  Status m_status = Status::interrupted;
  std::atomic<bool> m_has_stopped{false};
};

// where there may be nobody to ask
inline void check(Interruption* interruption)
{
  if(interruption != nullptr)
    interruption->check();
}

// the same, in a loop over cheap things
inline void check_now_and_then(Interruption* interruption, int i)
{
  if(i % 256 == 0)
    check(interruption);
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_INTERRUPTION_H
