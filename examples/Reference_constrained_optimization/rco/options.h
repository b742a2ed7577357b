// What the command line says. Nothing here needs CGAL, so that it compiles fast.

#ifndef RCO_PROGRAM_OPTIONS_H
#define RCO_PROGRAM_OPTIONS_H

#include <limits>
#include <string>

enum class Application { angle, quad, map };

const char* name(Application application);

// a length, or a number of mean edges of the reference; the library's default if it is negative
struct Drift_bound
{
  double value = -1;
  bool is_in_mean_edges = false;
};

struct Options
{
  Application application = Application::angle;
  std::string input;     // the source in a map
  std::string reference; // empty: the input's own shape
  std::string landmarks, initial, output;

  unsigned int number_of_iterations = 100;
  unsigned int random_seed = 0;
  double maximum_running_time = std::numeric_limits<double>::infinity();
  double energy_tolerance = 4e-3;
  double developability_threshold = 0.25;
  int maximum_patch_size = 0;
  Drift_bound drift_bound;
  bool use_on_surface_steps = true, use_finishing_stage = true;
  bool allow_creases = false, allow_self_intersections = false;

  bool detects_features = true; // those of mechanical parts; else
  double sharp_edges = 180;     // edges that turn by more degrees are constrained
  bool relax_constraints = false;

  double exponent_factor = 1;     // angle
  bool uses_angle_energy = false; // quad
  double leg_length_factor = 5;   // quad
  bool use_equal_areas = true;    // map
  bool has_soft_landmarks = false;
  double soft_landmarks = 0; // weight of their distances

  int threads = 0; // 0: as many as the machine runs at once
  bool prints_json = false, is_quiet = false, shows_progress = false;
};

// Returns whether there is something to do: help and version are printed here. Throws Failure.
bool read_options(int argc, char* argv[], Options& options);

#endif // RCO_PROGRAM_OPTIONS_H
