#ifndef RCO_BENCHMARK_SETTINGS_H
#define RCO_BENCHMARK_SETTINGS_H

// Settings and options that the drivers have in common, and the lists of values that make several
// runs.

#include "method.h"

#include <CGAL/Reference_constrained_optimization/internal/rounds/Loop_parameters.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

// of one run; the defaults are those of the library
struct Common_settings
{
  typedef CGAL::Reference_constrained_optimization::internal::Loop_parameters Defaults;

  double developability = Defaults().selection.developability_threshold;
  int patch_size = Defaults().selection.maximum_patch_size;
  unsigned int iterations = unsigned(Defaults().number_of_iterations);
  double tolerance = Defaults().energy_tolerance;
  unsigned int seed = 0;
  std::string method = method_names[0];
  double time_limit = std::numeric_limits<double>::infinity();
};

// of one call of a driver
template <typename Settings>
struct Common_options
{
  std::vector<Settings> runs{Settings()};
  std::vector<std::string> files;
  std::string format = "table", output_folder;
  bool parallel = false, check = false;
};

inline std::vector<std::string> split_list(const std::string& text)
{
  std::vector<std::string> items(1);
  for(const char c : text)
    if(c == ',')
      items.emplace_back();
    else
      items.back() += c;
  return items;
}

inline double to_number(const std::string& option, const std::string& text)
{
  std::size_t used = 0;
  double value = 0;
  try
  {
    value = std::stod(text, &used);
  }
  catch(const std::logic_error&)
  {}
  if(used == 0 || used != text.size())
    throw std::invalid_argument(option + ": '" + text + "' is not a number");
  return value;
}

// replaces every run by one run for each value of the list
template <typename Settings, typename Base, typename T>
void expand(std::vector<Settings>& runs,
            T Base::*member,
            const std::string& option,
            const std::string& list,
            bool may_be_infinite = false)
{
  std::vector<Settings> expanded;
  for(const Settings& run : runs)
    for(const std::string& item : split_list(list))
    {
      const double value = to_number(option, item);
      const bool is_infinite = may_be_infinite && value == std::numeric_limits<double>::infinity();
      if(!is_infinite && (!(value >= double(std::numeric_limits<T>::lowest()) &&
                            value <= double((std::numeric_limits<T>::max)())) ||
                          double(T(value)) != value))
        throw std::invalid_argument(option + ": '" + item + "' is out of range or not whole");
      expanded.push_back(run);
      expanded.back().*member = T(value);
    }
  runs = expanded;
}

// the same for the method
template <typename Settings>
void expand_methods(std::vector<Settings>& runs, const std::string& option, const std::string& list)
{
  std::vector<Settings> expanded;
  for(const Settings& run : runs)
    for(const std::string& item : split_list(list))
    {
      if(std::find(method_names.begin(), method_names.end(), item) == method_names.end())
        throw std::invalid_argument(option + ": there is no method '" + item + "'");
      expanded.push_back(run);
      expanded.back().method = item;
    }
  runs = expanded;
}

// takes an option that all drivers have; `value` returns the option's argument
template <typename Options, typename Value>
bool take_common_option(Options& o, const std::string& option, const Value& value)
{
  if(option == "--developability")
    expand(o.runs, &Common_settings::developability, option, value());
  else if(option == "--patch-size")
    expand(o.runs, &Common_settings::patch_size, option, value());
  else if(option == "--iterations")
    expand(o.runs, &Common_settings::iterations, option, value());
  else if(option == "--tolerance")
    expand(o.runs, &Common_settings::tolerance, option, value());
  else if(option == "--seed")
    expand(o.runs, &Common_settings::seed, option, value());
  else if(option == "--time-limit")
    expand(o.runs, &Common_settings::time_limit, option, value());
  else if(option == "--format")
    o.format = value();
  else if(option == "-o" || option == "--output")
    o.output_folder = value();
  else if(option == "--parallel")
    o.parallel = true;
  else if(option == "--method")
    expand_methods(o.runs, option, value());
  else if(option == "--check")
    o.check = true;
  else
    return false;
  return true;
}

template <typename Options>
void check_common_options(const Options& o)
{
  if(o.format != "table" && o.format != "csv" && o.format != "json")
    throw std::invalid_argument("--format must be table, csv or json");
#ifndef CGAL_LINKED_WITH_TBB
  if(o.parallel)
    throw std::invalid_argument("--parallel: this program was built without TBB");
#endif
}

// Reads the command line; `take_own(options, option, value)` takes what is the driver's own, and
// returns false for what is not. `input` is what the driver calls its files, `default_file` the one
// to take if none is given, if there is such a thing.
template <typename Options, typename Take_own>
Options parse_options(int argc,
                      char* argv[],
                      const char* usage,
                      const std::string& input,
                      const Take_own& take_own,
                      const std::string& default_file = "")
{
  Options o;
  for(int i = 1; i < argc; ++i)
  {
    const std::string option = argv[i];
    const auto value = [&]() -> std::string {
      if(i + 1 == argc)
        throw std::invalid_argument(option + " needs a value");
      return argv[++i];
    };
    if(option == "-h" || option == "--help")
    {
      std::cout << usage;
      std::exit(EXIT_SUCCESS);
    }
    else if(take_common_option(o, option, value) || take_own(o, option, value))
      continue;
    else if(option[0] == '-')
      throw std::invalid_argument("unknown option " + option);
    else
      o.files.push_back(option);
  }
  if(o.files.empty() && !default_file.empty())
    o.files.push_back(default_file);
  if(o.files.empty())
    throw std::invalid_argument("no " + input + " given (--help tells more)");
  check_common_options(o);
  return o;
}

// what tells one run from the others: the settings that are not the same in all
template <typename Settings>
class Settings_text
{
public:
  Settings_text(const std::vector<Settings>& runs, const Settings& run) : m_runs(runs), m_run(run)
  {}

  template <typename Member>
  Settings_text& add(const char* key, Member member)
  {
    for(const Settings& other : m_runs)
      if(other.*member != m_runs.front().*member)
      {
        m_text << (m_text.tellp() > 0 ? " " : "") << key << '=' << m_run.*member;
        break;
      }
    return *this;
  }

  std::string text() const { return m_text.str(); }

private:
  const std::vector<Settings>& m_runs;
  const Settings& m_run;
  std::ostringstream m_text;
};

#endif // RCO_BENCHMARK_SETTINGS_H
