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

// thrown where unfinished work is abandoned
struct Interrupted
{};

// Whether the optimization has to stop. Any thread may query it, often; only the thread that made the
// object calls the visitor and reads the clock.
class Interruption
{
public:
  template <typename Visitor>
  Interruption(Visitor& visitor,
               const std::chrono::steady_clock::time_point& start,
               double maximum_running_time)
    : m_go_further([&visitor]() { return visitor.go_further(); }),
      m_start(start),
      m_maximum_running_time(maximum_running_time),
      m_owner(std::this_thread::get_id())
  {}

  bool should_stop()
  {
    if(!m_has_stopped && std::this_thread::get_id() == m_owner)
      poll();
    return m_has_stopped;
  }
  // a point at which work may be abandoned
  void check()
  {
    if(should_stop())
      throw Interrupted();
  }

  bool has_stopped() const { return m_has_stopped; }
  // why, if it has stopped
  Status status() const { return m_status; }

private:
  void poll()
  {
    if(seconds_since(m_start) > m_maximum_running_time)
      m_status = Status::time_limit;
    else
    {
      bool may_continue = false;
      try
      {
        may_continue = m_go_further();
      }
      catch(...)
      {
        m_has_stopped = true; // the other threads stop, too
        throw;
      }
      if(may_continue)
        return;
    }
    m_has_stopped = true;
  }

  std::function<bool()> m_go_further;
  std::chrono::steady_clock::time_point m_start;
  double m_maximum_running_time;
  std::thread::id m_owner;
  Status m_status = Status::interrupted;
  std::atomic<bool> m_has_stopped{false};
};

// for an interruption that may be null
inline void check(Interruption* interruption)
{
  if(interruption != nullptr)
    interruption->check();
}

// the same, in a loop of short iterations
inline void check_periodically(Interruption* interruption, int i)
{
  if(i % 256 == 0)
    check(interruption);
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_INTERRUPTION_H
