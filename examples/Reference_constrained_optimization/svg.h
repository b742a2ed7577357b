// What charts in SVG are made of. Lengths are in points, and y points down.

#ifndef RCO_EXAMPLE_SVG_H
#define RCO_EXAMPLE_SVG_H

#include <fstream>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace svg {

inline std::string number(double value, int digits)
{
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

inline void begin(std::ostream& out, double width, double height)
{
  out << std::setprecision(6) << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width
      << "pt\" height=\"" << height << "pt\" viewBox=\"0 0 " << width << ' ' << height
      << "\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"10\" fill=\"#222\">\n"
      << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
}

inline void end(std::ofstream& out, const std::string& file)
{
  out << "</svg>\n";
  if(!out.flush())
    throw std::runtime_error(file + " cannot be written");
}

// `more` are further attributes
inline void text(std::ostream& out,
                 double x,
                 double y,
                 const char* anchor,
                 const std::string& text,
                 const std::string& more = "")
{
  out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\"" << more << ">"
      << text << "</text>\n";
}

inline void title(std::ostream& out, double x, double y, const std::string& title)
{
  text(out, x, y, "middle", title, " font-size=\"13\" font-weight=\"bold\"");
}

// upwards, centred at (x, y)
inline void vertical_text(std::ostream& out, double x, double y, const std::string& label)
{
  text(out, 0, 0, "middle", label,
       " transform=\"translate(" + number(x, 1) + " " + number(y, 1) + ") rotate(-90)\"");
}

inline void
line(std::ostream& out, double x0, double y0, double x1, double y1, const std::string& more)
{
  out << "<line x1=\"" << x0 << "\" y1=\"" << y0 << "\" x2=\"" << x1 << "\" y2=\"" << y1 << "\" "
      << more << "/>\n";
}

// attributes of lines
const char* const axis = "stroke=\"#333\" stroke-width=\"0.8\"";
const char* const grid = "stroke=\"#e3e3e3\" stroke-width=\"0.6\"";
const char* const dashes = "stroke=\"#222\" stroke-width=\"0.8\" stroke-dasharray=\"3 3\"";

} // namespace svg

#endif // RCO_EXAMPLE_SVG_H
