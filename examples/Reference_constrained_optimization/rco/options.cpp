#include "options.h"

#include "outcome.h"

#include <boost/program_options.hpp>

#include <cmath>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace po = boost::program_options;

namespace {

const char* const general_usage =
  R"(rco moves the vertices of a mesh along a reference surface so that its faces get better.
The connectivity does not change; the shape is kept.

Usage:
  rco angle IN [-o OUT]                 larger angles for a triangle mesh
  rco quad IN [--reference R] [-o OUT]  regular quads: even edges, right angles
  rco map SOURCE REFERENCE [--landmarks F | --initial M] [-o OUT]
                                        the mesh of SOURCE mapped onto REFERENCE with little distortion
  rco COMMAND --help                    the options of a command
  rco --help | --version

Files are OFF, OBJ, PLY or STL; the ending of the name tells which.
)";

const char* const exit_codes = R"(Exit codes:
   0  improved: an objective of the energy is better (what got worse is in the same line); help and version, too
   1  something failed that should not: a bug, or no memory
   2  bad usage: the command line makes no sense
   3  unreadable file: not there, or no polygon mesh, or bad landmarks
   4  unwritable file: there is no such folder, the ending is unknown, the disk is full
   5  refused input: read, but not usable (the message names the face or the vertex)
  10  nothing to do: no vertex may move, or none finds a better place (OUT is written)
  11  out of time before anything was improved (OUT is written)
  12  interrupted by Ctrl-C or SIGTERM: what was reached by then is in OUT; a second
      Ctrl-C ends the program at once, and so does one while it measures
  13  no usable map: its mean distortion is above 100, or more than a thousandth of the area of REFERENCE is
      covered more than once, or is a region that is not covered: further than three mean edges from OUT (OUT
      is written)
  14  not better: no objective of the energy is, and something is worse (OUT is written)
)";

const char* const angle_usage = R"(Usage: rco angle IN [-o OUT] [options]

Raises the angles of a triangle mesh, the smallest ones first. Vertices stay on the surface of IN,
or on that of the mesh given by --reference.

Examples:
  rco angle elephant.off -o better.off
  rco angle part.stl -o better.stl
  rco angle part.stl -o better.stl --sharp-edges 40 --relax-constraints
  rco angle scan.ply -o better.ply --drift-bound 0.1e --maximum-running-time 60 --json
)";

const char* const quad_usage = R"(Usage: rco quad IN [--reference R] [-o OUT] [options]

Makes the quads of a mesh regular: edges of one length and right angles, or, with --energy angle,
right angles alone. Vertices stay on the surface of IN, or on that of R.

Examples:
  rco quad quads.obj -o regular.obj
  rco quad quads.obj --reference scan.ply -o regular.obj --leg-length-factor 1
  rco quad quads.obj -o regular.obj --energy angle --relax-constraints
)";

const char* const map_usage =
  R"(Usage: rco map SOURCE REFERENCE [--landmarks F | --initial M] [-o OUT] [options]

Maps the mesh of one shape onto another with little distortion. It starts
from landmarks; or from M, a mesh with the faces of SOURCE on the surface of REFERENCE; or, with
neither, from SOURCE itself, which must then lie close to REFERENCE everywhere.

F is a text of lines with two whole numbers, a vertex of SOURCE and its counterpart on REFERENCE,
counted from 0 in the order of the files; what follows a # is a comment. Three pairs are needed, and
one at each end of the shape is wise. They are let go then, unless --soft-landmarks pulls them to their
counterparts; with that option, F may be given beside M, too, with any number of pairs.

Examples:
  rco map cat.off horse.off --landmarks cat_horse.txt -o cat_on_horse.off
  rco map cat.off horse.off --initial cat_on_horse.off -o better.off
  rco map cat.off horse.off --landmarks cat_horse.txt --soft-landmarks 10 -o cat_on_horse.off
)";

// a switch with a value: "true" and "false", "on" and "off", "yes" and "no", "1" and "0"
po::typed_value<bool>* yes_or_no(bool& variable)
{
  return po::value<bool>(&variable)->value_name("BOOL");
}

po::typed_value<double>* number(double& variable)
{
  return po::value<double>(&variable)->value_name("X");
}

po::typed_value<std::string>* text(std::string& variable, const char* what)
{
  return po::value<std::string>(&variable)->value_name(what);
}

// Whole numbers are read as such only after a look at their range: a conversion would wrap around.
struct Whole_numbers
{
  double number_of_iterations = 100, random_seed = 0, maximum_patch_size = 0, threads = 0;
};

[[noreturn]] void refuse(const std::string& message) { throw Failure(Outcome::bad_usage, message); }

template <typename Integer>
Integer whole(double value, const char* option)
{
  if(!(value >= 0 && value <= double((std::numeric_limits<Integer>::max)())) ||
     value != std::floor(value))
    refuse(std::string(option) + " must be a whole number that is not negative");
  return Integer(value);
}

void check(bool holds, const char* option, const char* condition)
{
  if(!holds)
    refuse(std::string(option) + " must be " + condition);
}

void read_sharp_edges(const std::string& text, Options& options)
{
  options.detects_features = text == "auto";
  options.sharp_edges = 180;
  if(text == "auto" || text == "none")
    return;
  std::size_t used = 0;
  double degrees = -1;
  try
  {
    degrees = std::stod(text, &used);
  }
  catch(const std::logic_error&)
  {}
  if(used == 0 || used != text.size() || !(degrees >= 0 && degrees <= 180))
    refuse("--sharp-edges must be auto, none or an angle from 0 to 180 degrees, not '" + text +
           "'");
  options.sharp_edges = degrees;
}

Drift_bound read_drift_bound(std::string text)
{
  const std::string given = text;
  Drift_bound bound;
  bound.is_in_mean_edges = !text.empty() && text.back() == 'e';
  if(bound.is_in_mean_edges)
    text.pop_back();
  std::size_t used = 0;
  try
  {
    bound.value = std::stod(text, &used);
  }
  catch(const std::logic_error&)
  {}
  if(used == 0 || used != text.size() || !(bound.value >= 0))
    refuse("--drift-bound must be a length, a number of mean edges such as 0.5e, or inf, not '" +
           given + "'");
  return bound;
}

class Option_reader
{
  Options& m_options;
  Whole_numbers m_whole;
  std::string m_drift_bound, m_sharp_edges = "auto", m_energy = "regularity";
  std::vector<std::string> m_files;
  po::options_description m_own, m_common{"Parameters, named as in the library", 100, 50},
    m_output{"Output", 100, 50}, m_hidden;

  void describe_own()
  {
    Options& o = m_options;
    auto add = m_own.add_options();
    switch(o.application)
    {
    case Application::angle:
      add("reference", text(o.reference, "R"), "the surface to stay on; default: that of IN");
      add("exponent-factor", number(o.exponent_factor),
          "of the energy: a larger one raises the smallest angles at the cost of the others; "
          "default: 1");
      break;
    case Application::quad:
      add("reference", text(o.reference, "R"), "the surface to stay on; default: that of IN");
      add("energy", text(m_energy, "NAME"), "regularity (default) or angle");
      add("leg-length-factor", number(o.leg_length_factor),
          "of the regularity energy: a large one avoids short edges and flat corners most, 1 "
          "treats long and short edges alike; default: 5");
      break;
    case Application::map:
      add("landmarks", text(o.landmarks, "F"), "pairs of vertices to start from");
      add("initial", text(o.initial, "M"), "a mesh to start from");
      add("soft-landmarks", po::value<double>(&o.soft_landmarks)->value_name("W"),
          "landmarks are pulled towards their counterparts: minimized is the mean distortion (2: "
          "isometric), plus W times the sum of the squared distances of landmarks from their "
          "counterparts over the area of REFERENCE; weak at 1, strong at 100; the table tells "
          "these distances; default: landmarks are let go");
      add("use-equal-areas", yes_or_no(o.use_equal_areas),
          "whether SOURCE is scaled to the area of REFERENCE first; default: true");
      break;
    }
  }

  void describe_common()
  {
    Options& o = m_options;
    const auto count = [](double& variable) {
      return po::value<double>(&variable)->value_name("N");
    };
    auto add = m_common.add_options();
    add("drift-bound", text(m_drift_bound, "B"),
        "how far mesh and reference may be apart: a length in the units of the files, a number of "
        "mean edges of the reference if an e follows (0.5e), or inf; default: 0.25e, or what the "
        "input has, up to 3e, and less where the reference is finer and on mechanical parts");
    add("number-of-iterations", count(m_whole.number_of_iterations), "at most; default: 100");
    add("maximum-running-time", number(o.maximum_running_time), "seconds; default: no limit");
    add("energy-tolerance", number(o.energy_tolerance),
        "the relative decrease of the energy below which the optimization stops; default: 0.004");
    add("random-seed", count(m_whole.random_seed), "default: 0");
    add(
      "sharp-edges", text(m_sharp_edges, "S"),
      "auto: those of mechanical parts are detected, and vertices slide along them; none: none "
      "are kept; X: edges where the surface turns by more than X degrees are constrained instead, "
      "and their vertices do not move, without the limits that auto sets to parts; default: auto");
    add("relax-constraints", po::bool_switch(&o.relax_constraints),
        "vertices on borders, and on edges constrained by an angle, slide along them");
    add("allow-creases", po::bool_switch(&o.allow_creases),
        "edges beyond 90 degrees may become more");
    add("allow-self-intersections", po::bool_switch(&o.allow_self_intersections),
        "pairs of faces that intersect may become more");
    add("use-finishing-stage", yes_or_no(o.use_finishing_stage),
        "whether the smallest angles are raised in the end; default: true");
    add("use-on-surface-steps", yes_or_no(o.use_on_surface_steps),
        "false: every patch is flattened, as in the paper; default: true");
    add("developability-threshold", number(o.developability_threshold),
        "of patches that are flattened; default: 0.25");
    add("maximum-patch-size", count(m_whole.maximum_patch_size), "faces; default: 0, automatic");
    add("threads", count(m_whole.threads),
        "at most; the result does not depend on it; default: 0, all that the machine has");
  }

  void describe_output()
  {
    Options& o = m_options;
    auto add = m_output.add_options();
    add("output,o", text(o.output, "OUT"), "the result; without it, there are measures only");
    add("json", po::bool_switch(&o.prints_json), "measures as JSON instead of a table");
    add("progress", po::bool_switch(&o.shows_progress),
        "a line for each iteration if there is no terminal for a bar");
    add("quiet,q", po::bool_switch(&o.is_quiet), "no bar and no table");
    add("help,h", "this text");
  }

  void take_files()
  {
    Options& o = m_options;
    const std::size_t wanted = o.application == Application::map ? 2 : 1;
    if(m_files.size() < wanted)
      refuse(wanted == 2 ? "SOURCE and REFERENCE are needed" : "a mesh IN is needed");
    if(m_files.size() > wanted)
      refuse("'" + m_files[wanted] + "' is one file too many (the result goes to -o OUT)");
    o.input = m_files[0];
    if(wanted == 2)
      o.reference = m_files[1];
    if(o.has_soft_landmarks && o.landmarks.empty())
      refuse("--soft-landmarks needs --landmarks");
    if(!o.landmarks.empty() && !o.initial.empty() && !o.has_soft_landmarks)
      refuse("--landmarks and --initial exclude each other without --soft-landmarks");
  }

  void take_numbers(bool has_drift_bound, bool has_leg_length)
  {
    Options& o = m_options;
    o.number_of_iterations =
      whole<unsigned int>(m_whole.number_of_iterations, "--number-of-iterations");
    o.random_seed = whole<unsigned int>(m_whole.random_seed, "--random-seed");
    o.maximum_patch_size = whole<int>(m_whole.maximum_patch_size, "--maximum-patch-size");
    o.threads = whole<int>(m_whole.threads, "--threads");
    if(has_drift_bound)
      o.drift_bound = read_drift_bound(m_drift_bound);
    check(o.maximum_running_time > 0, "--maximum-running-time", "positive");
    check(o.energy_tolerance >= 0, "--energy-tolerance", "zero or more");
    check(o.developability_threshold > 0, "--developability-threshold", "positive");
    read_sharp_edges(m_sharp_edges, o);
    check(o.exponent_factor > 0 && std::isfinite(o.exponent_factor), "--exponent-factor",
          "positive");
    check(o.leg_length_factor > 0 && std::isfinite(o.leg_length_factor), "--leg-length-factor",
          "positive");
    check(o.soft_landmarks >= 0 && std::isfinite(o.soft_landmarks), "--soft-landmarks",
          "zero or more");
    check(m_energy == "regularity" || m_energy == "angle", "--energy", "regularity or angle");
    o.uses_angle_energy = m_energy == "angle";
    if(o.uses_angle_energy && has_leg_length)
      refuse("--leg-length-factor has no meaning for the energy angle");
  }

public:
  explicit Option_reader(Options& options)
    : m_options(options),
      m_own(std::string("Options of rco ") + name(options.application), 100, 50)
  {
    describe_own();
    describe_common();
    describe_output();
    m_hidden.add_options()("file", po::value<std::vector<std::string>>(&m_files));
  }

  // false: help was wanted
  bool read(const std::vector<std::string>& words, const char* usage)
  {
    po::options_description all;
    all.add(m_own).add(m_common).add(m_output).add(m_hidden);
    po::positional_options_description files;
    files.add("file", -1);
    // abbreviations would mean something else as soon as there is another option
    const int style =
      po::command_line_style::default_style & ~int(po::command_line_style::allow_guessing);
    po::variables_map given;
    try
    {
      po::store(po::command_line_parser(words).options(all).positional(files).style(style).run(),
                given);
      if(given.count("help") > 0)
      {
        std::cout << usage << '\n'
                  << m_own << '\n'
                  << m_common << '\n'
                  << m_output << '\n'
                  << exit_codes;
        return false;
      }
      po::notify(given);
    }
    catch(const po::error& e)
    {
      refuse(e.what());
    }
    m_options.has_soft_landmarks = given.count("soft-landmarks") > 0;
    take_files();
    take_numbers(given.count("drift-bound") > 0, given.count("leg-length-factor") > 0);
    return true;
  }
};

} // namespace

const char* name(Application application)
{
  switch(application)
  {
  case Application::angle:
    return "angle";
  case Application::quad:
    return "quad";
  case Application::map:
    return "map";
  }
  return "";
}

bool read_options(int argc, char* argv[], Options& options)
{
  std::vector<std::string> words(argv + (argc > 0 ? 1 : 0), argv + argc);
  if(words.empty())
    refuse(std::string("a command is needed\n\n") + general_usage);
  const std::string command = words.front();
  words.erase(words.begin());
  if(command == "--help" || command == "-h" || command == "help")
  {
    std::cout << general_usage << '\n' << exit_codes;
    return false;
  }
  if(command == "--version")
  {
    std::cout << "rco " << RCO_VERSION << std::endl;
    return false;
  }
  const char* usage = nullptr;
  if(command == "angle")
  {
    options.application = Application::angle;
    usage = angle_usage;
  }
  else if(command == "quad")
  {
    options.application = Application::quad;
    usage = quad_usage;
  }
  else if(command == "map")
  {
    options.application = Application::map;
    usage = map_usage;
  }
  else
    refuse("'" + command + "' is no command; there are angle, quad and map (rco --help)");
  return Option_reader(options).read(words, usage);
}
