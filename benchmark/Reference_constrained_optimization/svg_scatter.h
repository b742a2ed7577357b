#ifndef RCO_BENCHMARK_SVG_SCATTER_H
#define RCO_BENCHMARK_SVG_SCATTER_H

// Draws points of several series, joined by lines on demand, as an SVG image: in small panels with
// axes of their own and one legend for all.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <iomanip>
#include <limits>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

class Svg_scatter
{
public:
  struct Series
  {
    std::string name, color;
    char mark; // o circle, s square, d diamond, ^ and v triangles, x and + crosses
    bool is_filled;
    double size = 3.6;      // half the width of the mark
    bool is_joined = false; // by lines, from each point to the next
  };
  struct Point
  {
    std::size_t series;
    double x, y;
  };
  struct Panel
  {
    std::string title;
    std::vector<Point> points;
    double line; // a dashed horizontal line, where it is within the points' range
  };
  struct Text
  {
    std::string title, x_label, y_label, line_label;
  };

  // With a floor above zero the horizontal axis is logarithmic, and what is below the floor is
  // drawn there.
  Svg_scatter(const Text& text,
              const std::vector<Series>& series,
              const std::vector<Panel>& panels,
              double floor = 0)
    : m_text(text),
      m_series(series),
      m_panels(panels),
      m_floor(floor)
  {}

  void write(const std::string& file) const
  {
    std::ofstream out(file);
    const int rows = (int(m_panels.size()) + columns() - 1) / columns();
    const double width = (std::max)(columns() * panel_width + 20, 2 * panel_width + 20);
    const double legend_top = head + rows * panel_height + 18;
    const int entries_per_row = (std::max)(1, int((width - 30) / legend_width));
    const std::vector<Series> shown = shown_series();
    const int entries = int(shown.size()) + !m_text.line_label.empty();
    const double height =
      legend_top + legend_step * ((entries + entries_per_row - 1) / entries_per_row) + 6;
    out << std::setprecision(6) << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width
        << "pt\" height=\"" << height << "pt\" viewBox=\"0 0 " << width << ' ' << height
        << "\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"9\" fill=\"#222\">\n"
        << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    write_text(out, 0.5 * width, 22, "middle", m_text.title,
               " font-size=\"13\" font-weight=\"bold\"");
    for(std::size_t i = 0; i < m_panels.size(); ++i)
      write_panel(out, m_panels[i], 10 + panel_width * double(i % columns()),
                  head + panel_height * double(i / columns()));
    for(int i = 0; i < entries; ++i)
    {
      const double x = 30 + legend_width * (i % entries_per_row);
      const double y = legend_top + legend_step * (i / entries_per_row);
      if(i < int(shown.size()))
        write_mark(out, shown[i], x, y);
      else
        write_line(out, x - 9, y, x + 7, y, dashes);
      write_text(out, x + 12, y + 3.2, "start",
                 i < int(shown.size()) ? shown[i].name : m_text.line_label);
    }
    out << "</svg>\n";
    if(!out.flush())
      throw std::runtime_error(file + " cannot be written");
  }

private:
  // of the image, in points
  static constexpr double head = 34, panel_width = 236, panel_height = 196;
  static constexpr double legend_width = 170, legend_step = 15;
  static constexpr const char* dashes =
    "stroke=\"#555\" stroke-width=\"0.8\" stroke-dasharray=\"3 3\"";

  // where a range of numbers is drawn
  struct Axis
  {
    double low, high, begin, end;
    std::vector<double> ticks;
    bool is_logarithmic;

    double at(double value) const
    {
      const double share = is_logarithmic
                             ? std::log((std::max)(value, low) / low) / std::log(high / low)
                             : (value - low) / (high - low);
      return begin + share * (end - begin);
    }
  };

  std::vector<Series> shown_series() const
  {
    std::vector<Series> shown;
    for(std::size_t i = 0; i < m_series.size(); ++i)
      if(std::any_of(m_panels.begin(), m_panels.end(), [&](const Panel& panel) {
           return std::any_of(panel.points.begin(), panel.points.end(),
                              [&](const Point& p) { return p.series == i; });
         }))
        shown.push_back(m_series[i]);
    return shown;
  }

  // as few gaps as may be
  int columns() const
  {
    const int n = int(m_panels.size());
    if(n <= 5)
      return (std::max)(1, n);
    const auto gaps = [n](int columns) { return (columns - n % columns) % columns; };
    return gaps(4) <= gaps(5) ? 4 : 5;
  }

  static Axis linear_axis(double low, double high, double begin, double end)
  {
    const double span = (std::max)(high - low, 1e-3 * (std::max)(std::abs(high), 1e-3));
    low -= 0.06 * span;
    high += 0.06 * span;
    const double rough = span / 6, power = std::pow(10, std::floor(std::log10(rough)));
    const double mantissa = rough / power;
    const double tick = power * (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10);
    Axis axis{low, high, begin, end, {}, false};
    for(double i = std::ceil(low / tick); i * tick <= high; ++i)
      axis.ticks.push_back(i * tick);
    return axis;
  }

  static Axis logarithmic_axis(double floor, double high, double begin, double end)
  {
    high = 1.15 * (std::max)(high, 2 * floor);
    Axis axis{floor, high, begin, end, {}, true};
    const bool is_long = high > 200 * floor;
    for(double power = std::pow(10, std::floor(std::log10(floor))); power <= high; power *= 10)
      for(const double mantissa : {1, 2, 5})
        if(mantissa * power >= 0.999 * floor && mantissa * power <= high &&
           (!is_long || mantissa == 1))
          axis.ticks.push_back(mantissa * power);
    return axis;
  }

  static void write_text(std::ostream& out,
                         double x,
                         double y,
                         const char* anchor,
                         const std::string& text,
                         const std::string& more = "")
  {
    out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\"" << more
        << ">";
    for(const char c : text)
      if(c == '<')
        out << "&lt;";
      else if(c == '&')
        out << "&amp;";
      else
        out << c;
    out << "</text>\n";
  }

  static void
  write_line(std::ostream& out, double x0, double y0, double x1, double y1, const std::string& more)
  {
    out << "<line x1=\"" << x0 << "\" y1=\"" << y0 << "\" x2=\"" << x1 << "\" y2=\"" << y1 << "\" "
        << more << "/>\n";
  }

  static std::string to_string(double value)
  {
    std::ostringstream out;
    out << std::setprecision(4) << (std::abs(value) < 1e-9 ? 0 : value);
    return out.str();
  }

  static void write_mark(std::ostream& out, const Series& s, double x, double y)
  {
    const std::string style = "stroke=\"" + s.color + "\" stroke-width=\"1.2\" fill=\"" +
                              (s.is_filled ? s.color : "none") + "\" fill-opacity=\"0.75\"";
    const double r = s.size;
    if(s.mark == 'o')
    {
      out << "<circle cx=\"" << x << "\" cy=\"" << y << "\" r=\"" << r << "\" " << style << "/>\n";
      return;
    }
    std::vector<std::pair<double, double>> outline;
    switch(s.mark)
    {
    case 's':
      outline = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
      break;
    case 'd':
      outline = {{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}};
      break;
    case '^':
      outline = {{0, -1.2}, {1.1, 0.9}, {-1.1, 0.9}};
      break;
    case '+':
      outline = {{-1.2, 0}, {1.2, 0}, {0, 0}, {0, 1.2}, {0, -1.2}, {0, 0}};
      break;
    case 'v':
      outline = {{0, 1.2}, {1.1, -0.9}, {-1.1, -0.9}};
      break;
    default:
      outline = {{-1, -1}, {1, 1}, {0, 0}, {1, -1}, {-1, 1}, {0, 0}};
    }
    out << "<path " << style << " d=\"";
    for(std::size_t i = 0; i < outline.size(); ++i)
      out << (i == 0 ? 'M' : 'L') << x + r * outline[i].first << ' ' << y + r * outline[i].second;
    out << "Z\"/>\n";
  }

  void write_joined(
    std::ostream& out, const Panel& panel, std::size_t series, const Axis& x, const Axis& y) const
  {
    out << "<polyline fill=\"none\" stroke=\"" << m_series[series].color
        << "\" stroke-width=\"1.2\""
        << (m_series[series].is_filled ? "" : " stroke-dasharray=\"4 3\"") << " points=\"";
    for(const Point& p : panel.points)
      if(p.series == series)
        out << x.at(p.x) << ',' << y.at(p.y) << ' ';
    out << "\"/>\n";
  }

  void write_panel(std::ostream& out, const Panel& panel, double left, double top) const
  {
    const double infinity = std::numeric_limits<double>::infinity();
    double low_x = infinity, high_x = -infinity, low_y = infinity, high_y = -infinity;
    for(const Point& p : panel.points)
    {
      low_x = (std::min)(low_x, p.x);
      high_x = (std::max)(high_x, p.x);
      low_y = (std::min)(low_y, p.y);
      high_y = (std::max)(high_y, p.y);
    }
    const double begin = left + 38, end = left + panel_width - 10;
    const double bottom = top + panel_height - 34, ceiling = top + 16;
    write_text(out, 0.5 * (begin + end), top + 10, "middle", panel.title, " font-weight=\"bold\"");
    if(panel.points.empty())
      return;
    if(panel.line <= high_y + 0.3 * (high_y - low_y))
      high_y = (std::max)(high_y, panel.line);
    const Axis y = linear_axis(low_y, high_y, bottom, ceiling);
    const Axis x = m_floor > 0 ? logarithmic_axis(m_floor, high_x, begin, end)
                               : linear_axis(low_x, high_x, begin, end);

    const char* const grid = "stroke=\"#e6e6e6\" stroke-width=\"0.6\"";
    for(const double tick : x.ticks)
    {
      write_line(out, x.at(tick), ceiling, x.at(tick), bottom, grid);
      write_text(out, x.at(tick), bottom + 11, "middle", to_string(tick));
    }
    for(const double tick : y.ticks)
    {
      write_line(out, begin, y.at(tick), end, y.at(tick), grid);
      write_text(out, begin - 4, y.at(tick) + 3, "end", to_string(tick));
    }
    out << "<rect x=\"" << begin << "\" y=\"" << ceiling << "\" width=\"" << end - begin
        << "\" height=\"" << bottom - ceiling
        << "\" fill=\"none\" stroke=\"#777\" stroke-width=\"0.7\"/>\n";
    write_text(out, 0.5 * (begin + end), bottom + 23, "middle", m_text.x_label);
    std::ostringstream turned;
    turned << " transform=\"translate(" << left + 12 << ' ' << 0.5 * (ceiling + bottom)
           << ") rotate(-90)\"";
    write_text(out, 0, 0, "middle", m_text.y_label, turned.str());
    if(panel.line >= y.low && panel.line <= y.high)
      write_line(out, begin, y.at(panel.line), end, y.at(panel.line), dashes);
    for(std::size_t i = 0; i < m_series.size(); ++i)
      if(m_series[i].is_joined)
        write_joined(out, panel, i, x, y);
    for(const Point& p : panel.points)
      write_mark(out, m_series[p.series], x.at(p.x), y.at(p.y));
  }

  Text m_text;
  std::vector<Series> m_series;
  std::vector<Panel> m_panels;
  double m_floor;
};

#endif // RCO_BENCHMARK_SVG_SCATTER_H
