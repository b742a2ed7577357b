#ifndef RCO_BENCHMARK_SVG_LOG_CHART_H
#define RCO_BENCHMARK_SVG_LOG_CHART_H

// Draws figures over sizes as an SVG image, with logarithmic axes and a line for each series: one
// panel for every figure, beside one another.

#include "../../examples/Reference_constrained_optimization/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

class Svg_log_chart
{
public:
  struct Point
  {
    double x, y; // positive
  };
  struct Panel
  {
    std::string label;                      // along the vertical axis
    std::vector<std::vector<Point>> series; // one for each name
    bool has_linear_guide;                  // whether proportionality is drawn, through one point
  };

  Svg_log_chart(const std::string& title,
                const std::string& horizontal_label,
                const std::vector<std::string>& names)
    : m_title(title),
      m_label(horizontal_label),
      m_names(names)
  {}

  void add(const Panel& panel) { m_panels.push_back(panel); }

  void write(const std::string& file) const
  {
    std::ofstream out(file);
    const double width = panel_width * double(m_panels.size());
    svg::begin(out, width, height);
    svg::title(out, 0.5 * width, 24, m_title);
    bool has_guide = false;
    for(std::size_t i = 0; i < m_panels.size(); ++i)
    {
      write_panel(out, m_panels[i], panel_width * double(i));
      has_guide = has_guide || m_panels[i].has_linear_guide;
    }
    write_legend(out, width, has_guide);
    svg::end(out, file);
  }

private:
  // a panel in points, and the plot in it
  static constexpr double panel_width = 340, height = 330;
  static constexpr double left = 60, right = panel_width - 16, top = 62, bottom = height - 46;

  std::string m_title, m_label;
  std::vector<std::string> m_names;
  std::vector<Panel> m_panels;

  // 1, 2 and 5 times the powers of ten, numbered
  static double tick(int i)
  {
    const int digit = (i % 3 + 3) % 3;
    return (digit == 0 ? 1 : digit == 1 ? 2 : 5) * std::pow(10., (i - digit) / 3);
  }
  static int last_tick_up_to(double value)
  {
    int i = 3 * int(std::floor(std::log10(value)) + 1);
    while(tick(i) > value * (1 + 1e-9))
      --i;
    return i;
  }

  static std::string label(double value)
  {
    const char* const unit = value >= 1e6 ? "M" : value >= 1e3 ? "k" : "";
    const double number = value / (value >= 1e6 ? 1e6 : value >= 1e3 ? 1e3 : 1);
    const int digits = number < 1 ? int(std::ceil(-std::log10(number) - 1e-9)) : 0;
    return svg::number(number, digits) + unit;
  }

  // from one tick to another, around the values
  struct Axis
  {
    int first, last;
    double begin, end; // in points

    Axis(double smallest, double largest, double begin, double end)
      : first(last_tick_up_to(smallest)),
        last((std::max)(first, last_tick_up_to(largest * (1 - 1e-6))) + 1),
        begin(begin),
        end(end)
    {}
    double operator()(double value) const
    {
      const double low = std::log(tick(first)), high = std::log(tick(last));
      return begin + (end - begin) * (std::log(value) - low) / (high - low);
    }
    // calls visit(value, label) for what is marked: more on short axes, and powers of ten only get
    // labels on long ones
    template <typename Visit>
    void for_each_mark(const Visit& visit) const
    {
      for(int i = first; i <= last; ++i)
      {
        const double value = tick(i);
        visit(value, last - first <= 10 || i % 3 == 0 ? label(value) : "");
        if(last - first > 3 || i == last)
          continue;
        const double unit = tick(i - (i % 3 + 3) % 3);
        for(double between = value + unit; between < 0.99 * tick(i + 1); between += unit)
          visit(between, last - first == 1 ? label(between) : "");
      }
    }
  };

  static const char* colour(std::size_t series)
  {
    static const std::array<const char*, 6> colours = {
      {"#1d4f8c", "#d9822b", "#3c8d5a", "#8a4fa3", "#b33a3a", "#555555"}};
    return colours[series % colours.size()];
  }

  static void
  write_axes(std::ostream& out, const Axis& x, const Axis& y, const std::string& vertical_label)
  {
    x.for_each_mark([&](double value, const std::string& label) {
      svg::line(out, x(value), y.begin, x(value), y.end, svg::grid);
      svg::text(out, x(value), y.begin + 15, "middle", label);
    });
    y.for_each_mark([&](double value, const std::string& label) {
      svg::line(out, x.begin, y(value), x.end, y(value), svg::grid);
      svg::text(out, x.begin - 6, y(value) + 3.5, "end", label);
    });
    svg::line(out, x.begin, y.begin, x.end, y.begin, svg::axis);
    svg::line(out, x.begin, y.begin, x.begin, y.end, svg::axis);
    svg::vertical_text(out, x.begin - 40, 0.5 * (y.begin + y.end), vertical_label);
  }

  void write_panel(std::ostream& out, const Panel& panel, double offset) const
  {
    const double infinity = std::numeric_limits<double>::infinity();
    Point smallest{infinity, infinity}, largest{0, 0};
    for(const std::vector<Point>& series : panel.series)
      for(const Point& p : series)
      {
        smallest = {(std::min)(smallest.x, p.x), (std::min)(smallest.y, p.y)};
        largest = {(std::max)(largest.x, p.x), (std::max)(largest.y, p.y)};
      }
    if(!(largest.x > 0))
      return; // nothing to draw
    const Axis x(smallest.x, largest.x, offset + left, offset + right);
    const Axis y(smallest.y, largest.y, bottom, top);
    write_axes(out, x, y, panel.label);
    svg::text(out, 0.5 * (x.begin + x.end), bottom + 32, "middle", m_label);
    if(panel.has_linear_guide)
      write_guide(out, panel, x, y);
    for(std::size_t s = 0; s < panel.series.size(); ++s)
    {
      out << "<polyline fill=\"none\" stroke=\"" << colour(s)
          << "\" stroke-width=\"1.6\" points=\"";
      for(const Point& p : panel.series[s])
        out << x(p.x) << ',' << y(p.y) << ' ';
      out << "\"/>\n";
      for(const Point& p : panel.series[s])
        out << "<circle cx=\"" << x(p.x) << "\" cy=\"" << y(p.y) << "\" r=\"2.6\" fill=\""
            << colour(s) << "\"/>\n";
    }
  }

  // through the first point of the first series, as far as there is room
  static void write_guide(std::ostream& out, const Panel& panel, const Axis& x, const Axis& y)
  {
    for(const std::vector<Point>& series : panel.series)
      if(!series.empty())
      {
        const double slope = series.front().y / series.front().x;
        const double from = (std::max)(tick(x.first), tick(y.first) / slope);
        const double to = (std::min)(tick(x.last), tick(y.last) / slope);
        svg::line(out, x(from), y(slope * from), x(to), y(slope * to), svg::dashes);
        return;
      }
  }

  void write_legend(std::ostream& out, double width, bool has_guide) const
  {
    const double entry = 100, y = 46;
    double x = 0.5 * (width - entry * double(m_names.size() + has_guide)) + 10;
    for(std::size_t s = 0; s < m_names.size(); ++s, x += entry)
    {
      svg::line(out, x, y - 3, x + 20, y - 3,
                std::string("stroke=\"") + colour(s) + "\" stroke-width=\"1.6\"");
      svg::text(out, x + 26, y, "start", m_names[s]);
    }
    if(has_guide)
    {
      svg::line(out, x, y - 3, x + 20, y - 3, svg::dashes);
      svg::text(out, x + 26, y, "start", "proportional");
    }
  }
};

#endif // RCO_BENCHMARK_SVG_LOG_CHART_H
