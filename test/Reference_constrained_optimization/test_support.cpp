// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Work in blocks and by patches on several threads, and how it is interrupted.

#include "checks.h"

#include <CGAL/Reference_constrained_optimization/internal/support/for_each_block.h>
#include <CGAL/Reference_constrained_optimization/internal/support/for_each_patch.h>
#include <CGAL/Reference_constrained_optimization/internal/support/interruption.h>
#include <CGAL/Reference_constrained_optimization/internal/support/text_of.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

namespace RCO = CGAL::Reference_constrained_optimization;
namespace internal = RCO::internal;

template <typename Tag>
void test_blocks()
{
  for(const int n : {0, 1, 4096, 4097, 100000})
  {
    std::vector<int> times(n, 0), blocks(internal::number_of_blocks(n), 0);
    internal::for_each_block<Tag>(n, [&](int begin, int end, int block) {
      ++blocks[block];
      for(int i = begin; i < end; ++i)
        ++times[i];
    });
    RCO_CHECK(times == std::vector<int>(n, 1));
    RCO_CHECK(blocks == std::vector<int>(blocks.size(), 1));
  }
  bool first = false, second = false;
  internal::call_both<Tag>([&]() { first = true; }, [&]() { second = true; });
  RCO_CHECK(first && second);
}

struct Workspace
{
  std::thread::id owner; // the first thread that uses it
};

template <typename Tag>
void test_patches()
{
  internal::For_each_patch<Tag, Workspace> for_each([]() { return Workspace(); });
  const auto nothing = []() {};
  for(const int n : {0, 1, 7, 5000})
  {
    std::vector<int> times(n, 0);
    std::atomic<int> shared(0);
    for_each(
      n,
      [&](Workspace& workspace, std::size_t i) {
        if(workspace.owner == std::thread::id())
          workspace.owner = std::this_thread::get_id();
        shared += workspace.owner != std::this_thread::get_id();
        ++times[i];
      },
      nothing);
    RCO_CHECK(times == std::vector<int>(n, 1));
    RCO_CHECK_EQUAL(int(shared), 0);
  }
  // an exception of any thread ends the work of all, and reaches the caller
  const bool is_sequential = std::is_same<Tag, CGAL::Sequential_tag>::value;
  const std::size_t n = 20000, last = is_sequential ? 10 : n - 1;
  std::atomic<std::size_t> started(0), started_at_throw(n);
  const auto run = [&]() {
    for_each(
      n,
      [&, caller = std::this_thread::get_id()](Workspace&, std::size_t i) {
        ++started;
        std::this_thread::sleep_for(std::chrono::microseconds(is_sequential ? 0 : 100));
        if(std::this_thread::get_id() == caller && i != last)
          return;
        started_at_throw = (std::min)(std::size_t(started_at_throw), std::size_t(started));
        throw std::runtime_error("an item");
      },
      nothing);
  };
  RCO_CHECK_THROWS(run(), std::runtime_error, "an item");
  if(is_sequential)
    RCO_CHECK_EQUAL(std::size_t(started), last + 1);
  else // whenever the first of the others began
    RCO_CHECK_LESS(std::size_t(started), std::size_t(started_at_throw) + n / 2);
}

// Who waits for the others is told so again and again, and may end the work.
template <typename Tag>
void test_waiting()
{
  internal::For_each_patch<Tag, Workspace> for_each([]() { return Workspace(); });
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> has_other_begun(false);
  std::atomic<int> number_of_waits(0);
  const auto wait_for = [](const auto& condition) {
    for(int i = 0; i < 2000 && !condition(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  const auto run = [&]() {
    for_each(
      2,
      [&](Workspace&, std::size_t) {
        if(std::this_thread::get_id() == caller)
          return wait_for([&]() { return bool(has_other_begun); });
        has_other_begun = true;
        wait_for([&]() { return number_of_waits == 3; });
      },
      [&]() {
        RCO_CHECK(std::this_thread::get_id() == caller);
        if(++number_of_waits == 3)
          throw std::runtime_error("enough");
      });
    if(!has_other_begun) // a machine may have no second thread
      throw std::runtime_error("enough");
  };
  RCO_CHECK_THROWS(run(), std::runtime_error, "enough");
}

struct Visitor
{
  int questions = 0, answers = 3;
  bool throws = false;
  bool go_further()
  {
    if(++questions > answers && throws)
      throw std::runtime_error("no");
    return questions <= answers;
  }
};

void test_interruption()
{
  const auto now = std::chrono::steady_clock::now();
  const double infinity = std::numeric_limits<double>::infinity();
  for(const bool throws : {false, true})
  {
    Visitor visitor;
    visitor.throws = throws;
    internal::Interruption interruption(visitor, now, infinity);
    for(int i = 0; i < 3; ++i)
      RCO_CHECK(!interruption.should_stop());
    // other threads do not ask
    bool other = true;
    std::thread([&]() { other = interruption.should_stop(); }).join();
    RCO_CHECK(!other && visitor.questions == 3);
    for(int i = 1; i < 256; ++i)
      internal::check_periodically(&interruption, i);
    RCO_CHECK_EQUAL(visitor.questions, 3);
    bool thrown = false;
    try
    {
      internal::check_periodically(&interruption, 256);
    }
    catch(const internal::Interrupted&)
    {
      thrown = !throws;
    }
    catch(const std::runtime_error&)
    {
      thrown = throws;
    }
    RCO_CHECK(thrown && interruption.has_stopped());
    RCO_CHECK(interruption.status() == RCO::Status::interrupted);
    // no is no, for all
    RCO_CHECK(interruption.should_stop());
    std::thread([&]() { other = interruption.should_stop(); }).join();
    RCO_CHECK(other && visitor.questions == 4);
  }
  Visitor visitor;
  internal::Interruption late(visitor, now - std::chrono::seconds(2), 1);
  RCO_CHECK(late.should_stop() && late.status() == RCO::Status::time_limit);
  RCO_CHECK_EQUAL(visitor.questions, 0);
  internal::check(nullptr);
}

int main()
{
  test_blocks<CGAL::Sequential_tag>();
  test_patches<CGAL::Sequential_tag>();
#ifdef CGAL_LINKED_WITH_TBB
  test_blocks<CGAL::Parallel_tag>();
  test_patches<CGAL::Parallel_tag>();
  test_waiting<CGAL::Parallel_tag>();
#endif
  rco_test::run_test("interruption", test_interruption);
  RCO_CHECK_EQUAL(internal::text_of(1e-9), std::string("1e-09"));
  return rco_test::report();
}
