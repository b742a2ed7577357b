// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_FOR_EACH_BLOCK_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_FOR_EACH_BLOCK_H

#include <CGAL/tags.h>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#endif

#include <type_traits>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// Blocks of successive indices in [0, n). They do not depend on the number of threads: sums that are
// computed block by block, and then over the blocks in their order, have the same bits for any number.
inline int number_of_blocks(int n)
{
  const int size = 4096;
  return (n + size - 1) / size;
}

// calls work(begin, end, block) for all blocks of [0, n); the calls must not depend on one another
template <typename ConcurrencyTag, typename Work>
void for_each_block(int n, const Work& work)
{
  const int blocks = number_of_blocks(n);
  const auto run = [&](int block) {
    work(int((long long)(n)*block / blocks), int((long long)(n) * (block + 1) / blocks), block);
  };
#ifdef CGAL_LINKED_WITH_TBB
  if(std::is_convertible<ConcurrencyTag, CGAL::Parallel_tag>::value)
  {
    tbb::parallel_for(0, blocks, run);
    return;
  }
#endif
  for(int block = 0; block < blocks; ++block)
    run(block);
}

// calls both; they must not depend on one another
template <typename ConcurrencyTag, typename First, typename Second>
void call_both(const First& first, const Second& second)
{
#ifdef CGAL_LINKED_WITH_TBB
  if(std::is_convertible<ConcurrencyTag, CGAL::Parallel_tag>::value)
  {
    tbb::parallel_invoke(first, second);
    return;
  }
#endif
  first();
  second();
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_SUPPORT_FOR_EACH_BLOCK_H
