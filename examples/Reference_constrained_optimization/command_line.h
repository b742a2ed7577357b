// Reads a command line of names and of options, which begin with two dashes.

#ifndef RCO_EXAMPLE_COMMAND_LINE_H
#define RCO_EXAMPLE_COMMAND_LINE_H

#include <cstddef>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

class Command_line
{
  std::vector<std::string> m_names;
  std::map<std::string, std::string> m_values;

public:
  // has_value tells all options there are, and whether a value follows
  Command_line(int argc,
               char* argv[],
               const std::string& usage,
               std::size_t largest_number_of_names,
               const std::map<std::string, bool>& has_value)
  {
    for(int i = 1; i < argc; ++i)
    {
      const std::string word = argv[i];
      if(word.compare(0, 2, "--") != 0)
      {
        m_names.push_back(word);
        continue;
      }
      const auto option = has_value.find(word);
      if(option == has_value.end())
        throw std::runtime_error(word + " is not an option\n" + usage);
      if(option->second && ++i == argc)
        throw std::runtime_error(word + " wants a value\n" + usage);
      m_values[word] = option->second ? argv[i] : "";
    }
    if(m_names.size() > largest_number_of_names)
      throw std::runtime_error(m_names[largest_number_of_names] + " is one name too many\n" +
                               usage);
  }

  bool has(const std::string& option) const { return m_values.count(option) > 0; }
  std::string name(std::size_t i, const std::string& otherwise) const
  {
    return i < m_names.size() ? m_names[i] : otherwise;
  }
  std::string text(const std::string& option, const std::string& otherwise) const
  {
    return has(option) ? m_values.at(option) : otherwise;
  }
  template <typename Number>
  Number number(const std::string& option, Number otherwise) const
  {
    if(!has(option))
      return otherwise;
    std::istringstream in(m_values.at(option));
    Number result;
    if(!(in >> result) || in.peek() != std::istringstream::traits_type::eof())
      throw std::runtime_error(option + " wants a number, not " + m_values.at(option));
    return result;
  }
};

#endif // RCO_EXAMPLE_COMMAND_LINE_H
