// An optimization that shows how far it is, ends after a given time, and can be stopped by Ctrl-C.
// Whatever ends it, the mesh reached by then is good, and is saved.
//
//   interruptible_optimization [mesh [result.off [seconds]]]

#include "input_mesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Reference_constrained_optimization/quality_measures.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/reference_constrained_optimize.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

namespace RCO = CGAL::Reference_constrained_optimization;
typedef CGAL::Exact_predicates_inexact_constructions_kernel Kernel;
typedef CGAL::Surface_mesh<Kernel::Point_3> Mesh;

// a signal handler may do little more than set this
volatile std::sig_atomic_t interrupted = 0;

extern "C" void interrupt(int)
{
  interrupted = 1;
  std::signal(SIGINT, SIG_DFL); // a second Ctrl-C ends the program at once
}

bool is_terminal()
{
#if defined(__unix__) || defined(__APPLE__)
  return isatty(STDERR_FILENO) != 0;
#else
  return false;
#endif
}

// Draws a bar on a terminal; elsewhere it writes a line for each iteration. How many iterations there
// will be is not known beforehand: the bar shows the time that may pass at most.
class Progress_bar : public RCO::Default_visitor
{
  typedef std::chrono::steady_clock Clock;

public:
  explicit Progress_bar(double seconds) : m_seconds(seconds) {}

  void on_iteration_end(std::size_t i, double energy)
  {
    m_iterations = i + 1;
    m_energy = energy;
    if(!m_is_terminal)
      std::cerr << "iteration " << i + 1 << ": mean energy " << energy << std::endl;
  }
  void on_patch_end(const RCO::Patch_report& report) { m_is_finishing = report.is_finishing; }

  // is asked more than ten times per second
  bool go_further()
  {
    const Clock::time_point now = Clock::now();
    if(m_is_terminal && now - m_last_drawn > std::chrono::milliseconds(100))
    {
      m_last_drawn = now;
      draw(std::chrono::duration<double>(now - m_start).count() / m_seconds);
    }
    return !interrupted;
  }

  void end()
  {
    if(m_is_terminal)
    {
      draw(1);
      std::cerr << std::endl;
    }
  }

private:
  void draw(double part) const
  {
    const int width = 40, filled = int(width * (std::min)(1., part));
    std::cerr << "\r[" << std::string(filled, '#') << std::string(width - filled, ' ') << "] ";
    if(m_iterations == 0)
      std::cerr << "begins";
    else
      std::cerr << m_iterations << " iterations, mean energy " << m_energy
                << (m_is_finishing ? ", raises the smallest angles" : "");
    std::cerr << "\033[K" << std::flush; // clears the rest of the line
  }

  double m_seconds;
  bool m_is_terminal = is_terminal(), m_is_finishing = false;
  Clock::time_point m_start = Clock::now(), m_last_drawn = m_start;
  std::size_t m_iterations = 0;
  double m_energy = 0;
};

const char* reason(RCO::Status status)
{
  switch(status)
  {
  case RCO::Status::converged:
    return "converged";
  case RCO::Status::iteration_limit:
    return "all iterations were made";
  case RCO::Status::time_limit:
    return "the time is up";
  case RCO::Status::interrupted:
    return "interrupted";
  case RCO::Status::nothing_to_do:
    return "nothing to do";
  }
  return "";
}

int main(int argc, char* argv[])
try
{
  const double seconds = argc > 3 ? std::stod(argv[3]) : 20;
  Mesh mesh;
  read_or_make(argc > 1 ? argv[1] : "", mesh);
  const Mesh reference = mesh;

  std::signal(SIGINT, interrupt);
  Progress_bar bar(seconds);
  const RCO::Result result = CGAL::reference_constrained_optimize(
    mesh, reference, RCO::Minimum_angle_energy(),
    CGAL::parameters::maximum_running_time(seconds).visitor(std::ref(bar)));
  bar.end();
  std::signal(SIGINT, SIG_DFL);

  const RCO::Angle_statistics before = RCO::angle_statistics(reference),
                              after = RCO::angle_statistics(mesh);
  std::cout << reason(result.status) << " after " << result.running_time << " s: smallest angle "
            << before.minimum << " -> " << after.minimum << ", mean " << before.mean << " -> "
            << after.mean << std::endl;

  const std::string name = argc > 2 ? argv[2] : "interruptible_optimization.off";
  std::ofstream out(name);
  out.precision(17);
  if(!out || !CGAL::IO::write_OFF(out, mesh))
    throw std::runtime_error("cannot write " + name);
  std::cout << "result: " << name << std::endl;
  return EXIT_SUCCESS;
}
catch(const std::exception& e)
{
  std::cerr << "Error: " << e.what() << std::endl;
  return EXIT_FAILURE;
}
