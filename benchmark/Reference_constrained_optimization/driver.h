#pragma once

// What the programs have in common: each makes one run and prints its figures as a line of JSON. run.py
// makes many runs.

#include "../../examples/Reference_constrained_optimization/command_line.h"
#include "meshes.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <limits>
#include <map>
#include <string>
#include <vector>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#endif

enum Exit_code { ok = 0, violation = 1, failure = 2 };

// figures and texts by name
class Row
{
public:
  void add(const std::string& key, const std::string& text)
  {
    std::string quoted;
    for(const char c : text)
      if(c == '"' || c == '\\')
        quoted += {'\\', c};
      else
        quoted += (unsigned char)(c) < ' ' ? ' ' : c;
    add_json(key, '"' + quoted + '"');
  }
  void add(const std::string& key, double x) { add_json(key, to_json(x)); }
  void add(const std::string& key, const std::vector<double>& numbers)
  {
    std::string list;
    for(const double x : numbers)
      list += (list.empty() ? "" : ", ") + to_json(x);
    add_json(key, '[' + list + ']');
  }

  std::string text() const { return '{' + m_text + '}'; }

private:
  void add_json(const std::string& key, const std::string& value)
  {
    m_text += (m_text.empty() ? "\"" : ", \"") + key + "\": " + value;
  }
  // all digits
  static std::string to_json(double x)
  {
    char text[64];
    std::snprintf(text, sizeof text, "%.17g", x);
    return std::isfinite(x) ? text : "null";
  }

  std::string m_text;
};

// Reads the command line, calls run(arguments, row), which returns whether all checks held, and prints
// the row.
template <typename Run>
int drive(int argc,
          char* argv[],
          const std::string& usage,
          std::map<std::string, bool> has_value,
          const Run& run)
{
  try
  {
    has_value["--help"] = false;
    const Command_line arguments(argc, argv, usage, 1, has_value);
    if(arguments.has("--help"))
    {
      std::cout << usage;
      return ok;
    }
    Row row;
    const bool holds = run(arguments, row);
    std::cout << row.text() << std::endl;
    return holds ? ok : violation;
  }
  catch(const std::exception& e)
  {
    std::cerr << argv[0] << ": " << e.what() << std::endl;
    return failure;
  }
}

inline double peak_memory() // in megabytes, of this process so far
{
#if defined(__unix__) || defined(__APPLE__)
  struct rusage r;
  getrusage(RUSAGE_SELF, &r);
#ifdef __APPLE__
  return double(r.ru_maxrss) / (1024 * 1024);
#else
  return double(r.ru_maxrss) / 1024;
#endif
#else
  return std::numeric_limits<double>::quiet_NaN();
#endif
}

inline std::string name(RCO::Status status)
{
  static const std::map<RCO::Status, std::string> names = {
    {RCO::Status::converged, "converged"},
    {RCO::Status::iteration_limit, "iteration limit"},
    {RCO::Status::time_limit, "time limit"},
    {RCO::Status::interrupted, "interrupted"},
    {RCO::Status::nothing_to_do, "nothing to do"}};
  return names.at(status);
}
