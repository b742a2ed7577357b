// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_FOR_EACH_PATCH_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_FOR_EACH_PATCH_H

#include <CGAL/tags.h>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#endif

#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Calls work(workspace, i) for i in [0, n), each thread with a workspace of its own made by
// `make_workspace`. The calls must not depend on one another. They begin in the order of i; if the longest
// comes first, the load is balanced best. While the calling thread waits for others it calls `idle`
// repeatedly.
template <typename ConcurrencyTag, typename Workspace>
class For_each_patch
{
public:
  template <typename MakeWorkspace>
  explicit For_each_patch(const MakeWorkspace& make_workspace) : m_workspace(make_workspace())
  {}

  template <typename Work, typename Idle>
  void operator()(std::size_t n, const Work& work, const Idle&)
  {
    for(std::size_t i = 0; i < n; ++i)
      work(m_workspace, i);
  }

private:
  Workspace m_workspace;
};

#ifdef CGAL_LINKED_WITH_TBB
template <typename Workspace>
class For_each_patch<CGAL::Parallel_tag, Workspace>
{
public:
  template <typename MakeWorkspace>
  explicit For_each_patch(const MakeWorkspace& make_workspace) : m_workspaces(make_workspace)
  {}

  template <typename Work, typename Idle>
  void operator()(std::size_t n, const Work& work, const Idle& idle)
  {
    std::atomic<std::size_t> next(0);
    const auto run_items = [&]() {
      try
      {
        for(std::size_t i = next++; i < n; i = next++)
          work(m_workspaces.local(), i);
      }
      catch(...)
      {
        next = n; // no further item is started
        throw;
      }
    };
    std::atomic<std::size_t> number_of_workers(0); // at work
    std::mutex mutex;
    std::condition_variable has_ended;
    const auto run_worker = [&]() {
      ++number_of_workers;
      std::exception_ptr error;
      try
      {
        run_items();
      }
      catch(...)
      {
        error = std::current_exception();
      }
      {
        const std::lock_guard<std::mutex> lock(mutex);
        --number_of_workers;
      }
      has_ended.notify_all();
      if(error)
        std::rethrow_exception(error);
    };

    tbb::task_group group;
    const std::size_t threads =
      (std::min)(n, std::size_t((std::max)(1, tbb::this_task_arena::max_concurrency())));
    for(std::size_t i = 1; i < threads; ++i)
      group.run(run_worker);
    std::exception_ptr error;
    try
    {
      run_items();
      // workers that begin later find no item left
      std::unique_lock<std::mutex> lock(mutex);
      while(number_of_workers > 0)
        if(has_ended.wait_for(lock, std::chrono::milliseconds(20)) == std::cv_status::timeout)
        {
          lock.unlock();
          idle();
          lock.lock();
        }
    }
    catch(...)
    {
      next = n;
      error = std::current_exception();
    }
    try
    {
      group.wait();
    }
    catch(...)
    {
      if(!error)
        error = std::current_exception();
    }
    if(error)
      std::rethrow_exception(error);
  }

private:
  tbb::enumerable_thread_specific<Workspace> m_workspaces;
};
#endif

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_FOR_EACH_PATCH_H
