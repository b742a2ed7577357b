#ifndef RCO_BENCHMARK_REPORT_H
#define RCO_BENCHMARK_REPORT_H

// The rows that the drivers print, as a table, as CSV and as JSON.

#include <CGAL/Reference_constrained_optimization/Result.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

// A value of a row. The table shows the values of successive fields with the same heading together.
struct Field
{
  std::string key, heading, text;
  bool is_number;
  double number = 0;
};

class Row
{
public:
  void add(const std::string& key, const std::string& heading, const std::string& text)
  {
    m_fields.push_back({key, heading, text, false, 0});
  }
  void add(const std::string& key, const std::string& heading, double x, int digits = 0)
  {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, x);
    m_fields.push_back({key, heading, std::isfinite(x) ? text : "-", true, x});
  }
  // a number of any order of magnitude
  void add_small(const std::string& key, const std::string& heading, double x)
  {
    char text[64];
    std::snprintf(text, sizeof text, "%.0e", x);
    m_fields.push_back({key, heading, std::isfinite(x) ? text : "-", true, x});
  }

  void print_table(std::ostream& out, bool with_heading) const
  {
    std::string headings, values;
    for(std::size_t i = 0; i < m_fields.size();)
    {
      const std::string& heading = m_fields[i].heading;
      std::string value = m_fields[i].text;
      for(++i; i < m_fields.size() && m_fields[i].heading == heading; ++i)
        value += "/" + m_fields[i].text;
      append(headings, values, heading, value);
    }
    if(with_heading)
      out << headings << '\n';
    out << values << std::endl;
  }

  void print_csv(std::ostream& out, bool with_heading) const
  {
    if(with_heading)
      for(std::size_t i = 0; i < m_fields.size(); ++i)
        out << m_fields[i].key << (i + 1 < m_fields.size() ? "," : "\n");
    for(std::size_t i = 0; i < m_fields.size(); ++i)
      out << full(m_fields[i], "\"\"", "") << (i + 1 < m_fields.size() ? "," : "");
    out << std::endl;
  }

  void print_json(std::ostream& out) const
  {
    out << "  {";
    for(std::size_t i = 0; i < m_fields.size(); ++i)
      out << (i > 0 ? ", " : "") << '"' << m_fields[i].key
          << "\": " << full(m_fields[i], "\\\"", "null");
    out << "}" << std::flush;
  }

private:
  // columns start where those of the first row do, as far as the values allow
  static void append(std::string& headings,
                     std::string& values,
                     const std::string& heading,
                     const std::string& value)
  {
    struct Width
    {
      std::size_t width;
      std::vector<std::string> headings;
    };
    static const std::vector<Width> widths = {
      {5, {"N_out", "SD", "MB", "off R", "bound"}},
      {6, {"method", "V", "F", "median", "p99", "off", "N_in", "faces", "us/V"}},
      {7, {"better", "max", "flips", "folds", "s", "T_F ms", "threads"}},
      {8, {"time/T_F", "speed-up"}},
      {9, {"nonconvex", "drift in", "drift out"}},
      {10, {"settings", "accepted %"}},
      {11, {"start", "mean", "drift"}},
      {12, {"planarity in", "planarity out"}},
      {14, {"stages %"}},
      {15, {"theta", "theta in", "theta out", "edges in", "edges out", "status", "drift, rms"}},
      {17, {"energy"}},
      {18, {"pair", "flattening %", "below 10..40"}},
      {20, {"mesh"}},
      {22, {"angles in", "angles out"}},
      {27, {"optimized by"}},
      {34, {"run"}}};
    std::size_t width = heading.size();
    for(const Width& w : widths)
      if(std::find(w.headings.begin(), w.headings.end(), heading) != w.headings.end())
        width = (std::max)(width, w.width);
    // numbers to the right; a value that is too long pushes the rest of its row
    const bool is_left = values.empty() || heading == "status" || heading == "settings" ||
                         heading == "start" || heading == "method" || heading == "optimized by" ||
                         heading == "run" || heading == "better" || heading == "wins";
    const auto padded = [&](const std::string& s) {
      const std::string fill(s.size() < width ? width - s.size() : 0, ' ');
      return is_left ? s + fill : fill + s;
    };
    headings += (headings.empty() ? "" : "  ") + padded(heading);
    values += (values.empty() ? "" : "  ") + padded(value);
  }

  // with all digits, for programs
  static std::string full(const Field& f, const std::string& escaped_quote, const std::string& none)
  {
    if(f.is_number)
    {
      char text[64];
      std::snprintf(text, sizeof text, "%.12g", f.number);
      return std::isfinite(f.number) ? text : none;
    }
    std::string quoted = "\"";
    for(const char c : f.text)
      if(c == '"')
        quoted += escaped_quote;
      else
        quoted += c;
    return quoted + "\"";
  }

  std::vector<Field> m_fields;
};

// its name in a row
inline const char* name(CGAL::Reference_constrained_optimization::Status status)
{
  switch(status)
  {
  case CGAL::Reference_constrained_optimization::Status::converged:
    return "converged";
  case CGAL::Reference_constrained_optimization::Status::iteration_limit:
    return "iteration limit";
  case CGAL::Reference_constrained_optimization::Status::time_limit:
    return "time limit";
  case CGAL::Reference_constrained_optimization::Status::interrupted:
    return "interrupted";
  case CGAL::Reference_constrained_optimization::Status::nothing_to_do:
    return "nothing to do";
  }
  return "";
}

#endif // RCO_BENCHMARK_REPORT_H
