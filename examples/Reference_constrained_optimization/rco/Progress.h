// Shows how far an optimization is, and lets it be interrupted.

#ifndef RCO_PROGRAM_PROGRESS_H
#define RCO_PROGRAM_PROGRESS_H

#include "interruption.h"
#include "options.h"

#include <CGAL/Reference_constrained_optimization/Default_visitor.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iostream>
#include <string>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

// Draws a bar on a terminal, or writes a line for each iteration if that is wanted. The bar fills
// with the iterations or with the time, whichever is nearer to its limit; most runs end before.
class Progress : public CGAL::Reference_constrained_optimization::Default_visitor
{
  typedef std::chrono::steady_clock Clock;

public:
  explicit Progress(const Options& options)
    : m_largest_number_of_iterations((std::max)(1u, options.number_of_iterations)),
      m_seconds(options.maximum_running_time),
      m_has_bar(!options.is_quiet && is_terminal()),
      m_has_lines(!m_has_bar && options.shows_progress)
  {}
  ~Progress()
  {
    if(m_has_bar)
      std::cerr << "\r\033[K" << std::flush;
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void on_iteration_end(std::size_t i, double energy)
  {
    m_iterations = i + 1;
    m_energy = energy;
    if(m_has_lines)
      std::cerr << "iteration " << i + 1 << ": mean energy " << energy << std::endl;
  }
  void on_patch_end(const CGAL::Reference_constrained_optimization::Patch_report& report)
  {
    m_is_finishing = report.is_finishing;
  }

  // is asked more than ten times per second
  bool go_further()
  {
    const Clock::time_point now = Clock::now();
    if(m_has_bar && now - m_last_drawn > std::chrono::milliseconds(100))
    {
      m_last_drawn = now;
      draw(std::chrono::duration<double>(now - m_start).count() / m_seconds);
    }
    return !interruption_is_wanted;
  }

private:
  static bool is_terminal()
  {
#if defined(__unix__) || defined(__APPLE__)
    return isatty(STDERR_FILENO) != 0;
#else
    return false;
#endif
  }

  void draw(double part_of_time) const
  {
    const double part =
      (std::max)(part_of_time, double(m_iterations) / double(m_largest_number_of_iterations));
    const int width = 40, filled = int(width * (std::min)(1., part));
    std::cerr << "\r[" << std::string(filled, '#') << std::string(width - filled, ' ') << "] ";
    if(m_iterations == 0)
      std::cerr << "begins";
    else
      std::cerr << "iteration " << m_iterations << ", mean energy " << m_energy
                << (m_is_finishing ? ", raises the smallest angles" : "");
    std::cerr << "\033[K" << std::flush; // clears the rest of the line
  }

  std::size_t m_largest_number_of_iterations;
  double m_seconds;
  bool m_has_bar, m_has_lines, m_is_finishing = false;
  Clock::time_point m_start = Clock::now(), m_last_drawn = m_start;
  std::size_t m_iterations = 0;
  double m_energy = 0;
};

#endif // RCO_PROGRAM_PROGRESS_H
