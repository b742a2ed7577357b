// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FOR_EACH_PATCH_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FOR_EACH_PATCH_H

#include <CGAL/tags.h>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#endif

#include <atomic>
#include <cstddef>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Calls work(workspace, i) for i in [0, n), each thread with a workspace of its own made by
// `make_workspace`. The calls must not depend on one another. They begin in the order of i: with the
// longest first no thread is left with a long one in the end.
template <typename ConcurrencyTag, typename Workspace>
class For_each_patch
{
public:
  template <typename MakeWorkspace>
  explicit For_each_patch(const MakeWorkspace& make_workspace) : m_workspace(make_workspace())
  {}

  template <typename Work>
  void operator()(std::size_t n, const Work& work)
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

  template <typename Work>
  void operator()(std::size_t n, const Work& work)
  {
    std::atomic<std::size_t> next(0);
    tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, n, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for(std::size_t i = range.begin(); i < range.end(); ++i)
          work(m_workspaces.local(), next++);
      },
      tbb::simple_partitioner());
  }

private:
  tbb::enumerable_thread_specific<Workspace> m_workspaces;
};
#endif

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_FOR_EACH_PATCH_H
