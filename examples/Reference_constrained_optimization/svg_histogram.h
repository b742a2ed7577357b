// Draws the histograms of two series of numbers, before and after, over each other as an SVG image.

#ifndef RCO_EXAMPLE_SVG_HISTOGRAM_H
#define RCO_EXAMPLE_SVG_HISTOGRAM_H

#include "svg.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

class Svg_histogram
{
public:
  struct Axis
  {
    std::string title, label, share; // label: below the axis; share: along the vertical one
    std::string unit;                // follows the figures of the caption
    double end, bin, tick;           // from 0 to the end
    double ideal;                    // marked by a line
    bool is_open;                    // whether one more bin holds what is beyond the end
    int digits;                      // after the decimal point, in the caption
  };

private:
  // the image in points, and the plot in it; y points down
  static constexpr double width = 480, height = 320;
  static constexpr double left = 56, right = width - 20, top = 52, bottom = height - 86;

  struct Series
  {
    std::string name, filling, outline; // filling and outline: attributes of SVG
    std::vector<double> percent;        // by bin
    std::vector<std::string> figures;   // minimum, maximum, standard deviation
  };

  Axis m_axis;
  Series m_series[2];
  double m_percent_tick, m_largest_percent; // of the vertical axis

  int number_of_bins() const { return int(std::round(m_axis.end / m_axis.bin)) + m_axis.is_open; }
  double x(double bin) const { return left + (right - left) * bin / number_of_bins(); }
  double y(double percent) const { return bottom - (bottom - top) * percent / m_largest_percent; }

  // as many as a step from tick to tick needs
  static int digits_of_tick(double tick)
  {
    return (std::max)(0, int(std::ceil(-std::log10(tick) - 1e-9)));
  }

  Series make_series(const char* name,
                     const char* filling,
                     const char* outline,
                     const std::vector<double>& values) const
  {
    Series result{name, filling, outline, std::vector<double>(number_of_bins(), 0), {}};
    const double n = double(values.size());
    double minimum = std::numeric_limits<double>::infinity(), maximum = -minimum;
    double sum = 0, sum_of_squares = 0;
    for(const double value : values)
    {
      const double bin = (std::min)(value / m_axis.bin, double(number_of_bins() - 1));
      result.percent[std::size_t((std::max)(bin, 0.))] += 100 / n;
      minimum = (std::min)(minimum, value);
      maximum = (std::max)(maximum, value);
      sum += value;
    }
    for(const double value : values)
      sum_of_squares += (value - sum / n) * (value - sum / n);
    for(const double figure : {minimum, maximum, std::sqrt(sum_of_squares / n)})
      result.figures.push_back(svg::number(figure, m_axis.digits) + m_axis.unit);
    return result;
  }

  // the vertical axis ends above the highest bar, at a tick; there are at most seven above zero
  void scale_vertical_axis()
  {
    double highest = 0;
    for(const Series& s : m_series)
      highest = (std::max)(highest, *std::max_element(s.percent.begin(), s.percent.end()));
    const double power = std::pow(10, std::floor(std::log10(highest / 6)));
    const double mantissa = highest / 6 / power;
    m_percent_tick = power * (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10);
    m_largest_percent = m_percent_tick * std::ceil(1.04 * highest / m_percent_tick);
  }

  void write_grid(std::ostream& out) const
  {
    for(int i = 1; i * m_percent_tick <= m_largest_percent * 1.001; ++i)
      svg::line(out, left, y(i * m_percent_tick), right, y(i * m_percent_tick), svg::grid);
  }

  void write_axes(std::ostream& out) const
  {
    svg::line(out, left, bottom, right, bottom, svg::axis);
    for(int i = 0; i * m_percent_tick <= m_largest_percent * 1.001; ++i)
    {
      const double percent = i * m_percent_tick;
      svg::text(out, left - 6, y(percent) + 3.5, "end",
                svg::number(percent, digits_of_tick(m_percent_tick)));
    }
    svg::vertical_text(out, 20, 0.5 * (top + bottom), m_axis.share + " (%)");
    for(int i = 0; i * m_axis.tick <= m_axis.end * 1.001; ++i)
    {
      const double value = i * m_axis.tick;
      const bool is_open = m_axis.is_open && value + m_axis.tick > m_axis.end * 1.001;
      const double position = x(value / m_axis.bin + (is_open ? 0.5 : 0)); // the bin's middle
      svg::line(out, position, bottom, position, bottom + 4, svg::axis);
      svg::text(out, position, bottom + 15, "middle",
                (is_open ? "&#8805;&#8201;" : "") +
                  svg::number(value, digits_of_tick(m_axis.tick)));
    }
    svg::text(out, 0.5 * (left + right), bottom + 31, "middle", m_axis.label);
    const double ideal = x(m_axis.ideal / m_axis.bin);
    svg::line(out, ideal, top, ideal, bottom, svg::dashes);
    svg::text(out, ideal, top - 5, "middle", "ideal", " font-style=\"italic\"");
  }

  // the outlines are drawn above both fillings
  void write_series(std::ostream& out, const Series& s, bool is_outline) const
  {
    out << "<path " << (is_outline ? "fill=\"none\" " + s.outline : s.filling)
        << " stroke-linejoin=\"round\" d=\"M" << x(0) << ' ' << y(0);
    for(int bin = 0; bin < number_of_bins(); ++bin)
      out << 'V' << y(s.percent[bin]) << 'H' << x(bin + 1);
    out << 'V' << y(0) << "\"/>\n";
  }

  // a line of the table below the plot, which is the legend, too
  void write_caption(std::ostream& out, const Series& s, double y) const
  {
    out << "<rect x=\"" << left << "\" y=\"" << y - 8 << "\" width=\"14\" height=\"9\" "
        << s.filling << ' ' << s.outline << "/>\n";
    svg::text(out, left + 21, y, "start", s.name);
    const char* const names[3] = {"min", "max", "std"};
    for(int i = 0; i < 3; ++i)
    {
      svg::text(out, left + 96 + 100 * i, y, "start", names[i]);
      svg::text(out, left + 164 + 100 * i, y, "end", s.figures[i]);
    }
  }

public:
  Svg_histogram(const Axis& axis,
                const std::vector<double>& before,
                const std::vector<double>& after)
    : m_axis(axis)
  {
    m_series[0] = make_series("before", "fill=\"#d9d4cb\"", "stroke=\"#8f877a\"", before);
    m_series[1] =
      make_series("after", "fill=\"#2f6db5\" fill-opacity=\"0.45\"", "stroke=\"#1d4f8c\"", after);
    scale_vertical_axis();
  }

  void write(const std::string& file) const
  {
    std::ofstream out(file);
    svg::begin(out, width, height);
    svg::title(out, 0.5 * (left + right), 24, m_axis.title);
    write_grid(out);
    for(const bool is_outline : {false, true})
      for(const Series& s : m_series)
        write_series(out, s, is_outline);
    write_axes(out);
    write_caption(out, m_series[0], bottom + 54);
    write_caption(out, m_series[1], bottom + 70);
    svg::end(out, file);
  }
};

#endif // RCO_EXAMPLE_SVG_HISTOGRAM_H
