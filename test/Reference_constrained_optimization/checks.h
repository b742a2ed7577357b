// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Checks that do not depend on NDEBUG, and the exit code of a test.

#pragma once

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace rco_test {

struct Counts
{
  long checks = 0, failures = 0;
  std::vector<std::string> scopes; // what is being tested, innermost last
};

inline Counts& counts()
{
  static Counts c;
  return c;
}

// names what is being tested for as long as it lives
class Scope
{
public:
  explicit Scope(const std::string& name) { counts().scopes.push_back(name); }
  ~Scope() { counts().scopes.pop_back(); }
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;
};

inline bool
check(bool holds, const char* expression, const std::string& values, const char* file, int line)
{
  Counts& c = counts();
  ++c.checks;
  if(holds)
    return true;
  // a loop that fails everywhere need not fill the screen
  if(++c.failures <= 20)
  {
    std::cerr << file << ":" << line << ": FAILED " << expression;
    if(!values.empty())
      std::cerr << "  [" << values << "]";
    for(const std::string& s : c.scopes)
      std::cerr << "  in " << s;
    std::cerr << std::endl;
  }
  return false;
}

template <typename A, typename B>
std::string values(const A& a, const B& b)
{
  std::ostringstream out;
  out.precision(17);
  out << a << " and " << b;
  return out.str();
}

// runs a test in the scope of its name, and prints how much time has passed since the first one began
template <typename Test>
void run_test(const std::string& name, const Test& test)
{
  static const auto start = std::chrono::steady_clock::now();
  const Scope scope(name);
  test();
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  std::cout << "[" << passed.count() << " s] " << name << std::endl;
}

// the exit code of a test
inline int report()
{
  std::cout << counts().checks << " checks, " << counts().failures << " failures" << std::endl;
  return counts().failures == 0 && counts().checks > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

#define RCO_CHECK(condition)                                                                       \
  ::rco_test::check(static_cast<bool>(condition), #condition, std::string(), __FILE__, __LINE__)

#define RCO_CHECK_BINARY(a, b, op)                                                                 \
  [&](const auto& rco_a, const auto& rco_b) {                                                      \
    const bool rco_holds = rco_a op rco_b;                                                         \
    return ::rco_test::check(rco_holds, #a " " #op " " #b,                                         \
                             rco_holds ? std::string() : ::rco_test::values(rco_a, rco_b),         \
                             __FILE__, __LINE__);                                                  \
  }((a), (b))
#define RCO_CHECK_EQUAL(a, b) RCO_CHECK_BINARY(a, b, ==)
#define RCO_CHECK_LESS(a, b) RCO_CHECK_BINARY(a, b, <)
#define RCO_CHECK_LESS_EQUAL(a, b) RCO_CHECK_BINARY(a, b, <=)

// false for NaN, too
#define RCO_CHECK_NEAR(a, b, tolerance)                                                            \
  [&](double rco_a, double rco_b) {                                                                \
    return ::rco_test::check(std::abs(rco_a - rco_b) <= (tolerance), #a " near " #b,               \
                             ::rco_test::values(rco_a, rco_b), __FILE__, __LINE__);                \
  }((a), (b))

// `statement` throws `Exception`, and the message contains `text`
#define RCO_CHECK_THROWS(statement, Exception, text)                                               \
  do                                                                                               \
  {                                                                                                \
    std::string rco_message = "nothing was thrown";                                                \
    bool rco_thrown = false;                                                                       \
    try                                                                                            \
    {                                                                                              \
      statement;                                                                                   \
    }                                                                                              \
    catch(const Exception& rco_e)                                                                  \
    {                                                                                              \
      rco_thrown = true;                                                                           \
      rco_message = rco_e.what();                                                                  \
    }                                                                                              \
    catch(const std::exception& rco_e)                                                             \
    {                                                                                              \
      rco_message = std::string("another type was thrown: ") + rco_e.what();                       \
    }                                                                                              \
    ::rco_test::check(rco_thrown&& rco_message.find(text) != std::string::npos,                    \
                      #statement " throws " #Exception " about " #text, rco_message, __FILE__,     \
                      __LINE__);                                                                   \
  } while(false)

} // namespace rco_test
