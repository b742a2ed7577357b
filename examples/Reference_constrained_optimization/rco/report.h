// What a run prints: a table for people, or one JSON object for programs.

#ifndef RCO_PROGRAM_REPORT_H
#define RCO_PROGRAM_REPORT_H

#include "measures.h"
#include "options.h"
#include "outcome.h"
#include "verdict.h"

#include <CGAL/Reference_constrained_optimization/Result.h>
#include <CGAL/Reference_constrained_optimization/compatible_initial_mesh.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <iomanip>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

struct Report
{
  std::size_t number_of_vertices = 0, number_of_faces = 0;
  std::vector<Measure> before, after;
  RCO::Initial_mesh_report initial; // of a map from landmarks
  RCO::Result result;
  Verdict verdict;
};

inline const char* name(RCO::Status status)
{
  switch(status)
  {
  case RCO::Status::converged:
    return "converged";
  case RCO::Status::iteration_limit:
    return "iteration limit";
  case RCO::Status::time_limit:
    return "time limit";
  case RCO::Status::interrupted:
    return "interrupted";
  case RCO::Status::nothing_to_do:
    return "nothing to do";
  }
  return "";
}

inline std::string json_text(const std::string& text)
{
  std::string quoted = "\"";
  for(const char c : text)
  {
    if(c == '"' || c == '\\')
      quoted += '\\';
    if((unsigned char)c >= 0x20)
      quoted += c;
    else
    {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", unsigned(c));
      quoted += code;
    }
  }
  return quoted + '"';
}

// JSON knows no infinity
inline std::string json_number(double x)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", x);
  return std::isfinite(x) ? text : "null";
}

inline std::string json_object(const std::vector<Measure>& measures)
{
  std::string object;
  for(const Measure& m : measures)
    object += (object.empty() ? "" : ", ") + json_text(m.key) + ": " + json_number(m.value);
  return "{" + object + "}";
}

inline std::string json_outcome(Outcome outcome)
{
  return "  \"outcome\": " + json_text(name(outcome)) +
         ",\n  \"exit_code\": " + std::to_string(int(outcome));
}

inline std::string json_list(const std::vector<std::string>& texts)
{
  std::string list;
  for(const std::string& text : texts)
    list += (list.empty() ? "" : ", ") + json_text(text);
  return "[" + list + "]";
}

inline std::string joined(const std::vector<int>& vertices)
{
  std::string list;
  for(const int v : vertices)
    list += (list.empty() ? "" : ", ") + std::to_string(v);
  return list;
}

inline std::string joined(const std::vector<std::pair<int, int>>& pairs)
{
  std::string list;
  for(const std::pair<int, int>& p : pairs)
    list += (list.empty() ? "[" : ", [") + joined({p.first, p.second}) + ']';
  return list;
}

inline void print_json(std::ostream& out, const Options& options, const Report& report)
{
  const RCO::Result& r = report.result;
  const auto file = [](const std::string& name) { return name.empty() ? "null" : json_text(name); };
  out << "{\n  \"command\": " << json_text(name(options.application))
      << ",\n  \"input\": " << json_text(options.input)
      << ",\n  \"reference\": " << file(options.reference)
      << ",\n  \"output\": " << file(options.output) << ",\n"
      << json_outcome(report.verdict.outcome)
      << ",\n  \"flaws\": " << json_list(report.verdict.flaw_keys)
      << ",\n  \"worse\": " << json_list(report.verdict.worse_keys)
      << ",\n  \"status\": " << json_text(name(r.status))
      << ",\n  \"number_of_vertices\": " << report.number_of_vertices
      << ",\n  \"number_of_faces\": " << report.number_of_faces
      << ",\n  \"number_of_free_vertices\": " << r.number_of_free_vertices
      << ",\n  \"number_of_feature_edges\": " << r.number_of_feature_edges
      << ",\n  \"added_landmarks\": [" << joined(report.initial.added_landmarks)
      << "],\n  \"unpaired_in_source\": [" << joined(report.initial.unpaired_in_source)
      << "],\n  \"unpaired_in_reference\": [" << joined(report.initial.unpaired_in_reference)
      << "],\n  \"before\": " << json_object(report.before)
      << ",\n  \"after\": " << json_object(report.after)
      << ",\n  \"initial_number_of_creases\": " << r.initial_number_of_creases
      << ",\n  \"number_of_creases\": " << r.number_of_creases
      << ",\n  \"initial_number_of_self_intersections\": " << r.initial_number_of_self_intersections
      << ",\n  \"number_of_self_intersections\": " << r.number_of_self_intersections
      << ",\n  \"initial_energy\": " << json_number(r.initial_energy)
      << ",\n  \"final_energy\": " << json_number(r.final_energy)
      << ",\n  \"drift_bound\": " << json_number(r.drift_bound)
      << ",\n  \"number_of_iterations\": " << r.number_of_iterations
      << ",\n  \"number_of_patches\": " << r.number_of_patches
      << ",\n  \"running_time\": " << json_number(r.running_time) << "\n}" << std::endl;
}

inline void print_json(std::ostream& out, const std::string& error, Outcome outcome)
{
  out << "{\n"
      << json_outcome(outcome) << ",\n  \"error\": " << json_text(error) << "\n}" << std::endl;
}

// "improved, but: flipped faces 0 -> 2; left: flipped faces 2"
inline std::string text_of(const Verdict& verdict)
{
  std::string text = name(verdict.outcome);
  if(verdict.outcome == Outcome::not_usable)
    text += ": " + verdict.flaws;
  if(!verdict.worse.empty())
    text += (verdict.outcome == Outcome::improved     ? ", but: "
             : verdict.outcome == Outcome::not_usable ? "; worse: "
                                                      : ": ") +
            verdict.worse;
  if(!verdict.left.empty())
    text += "; left: " + verdict.left;
  return text;
}

inline std::string table_cell(const Measure& measure)
{
  const double largest_fixed = 1e8;
  char text[32];
  if(std::abs(measure.value) < largest_fixed)
    std::snprintf(text, sizeof text, "%.*f", measure.digits, measure.value);
  else
    std::snprintf(text, sizeof text, "%.3e", measure.value);
  return text;
}

inline void print_table(std::ostream& out, const Options& options, const Report& report)
{
  const int label = 50, column = 12;
  const RCO::Result& r = report.result;
  out << options.input << ": " << report.number_of_vertices << " vertices, "
      << report.number_of_faces << " faces\n"
      << std::fixed << std::setw(label + column) << "before" << std::setw(column) << "after\n";
  for(std::size_t i = 0; i < report.before.size(); ++i)
  {
    const Measure &a = report.before[i], &b = report.after[i];
    out << std::left << std::setw(label) << a.label << std::right << std::setw(column)
        << table_cell(a) << std::setw(column) << table_cell(b) << '\n';
  }
  const auto print_counts = [&](const char* text, std::size_t before, std::size_t after) {
    out << std::left << std::setw(label) << text << std::right << std::setw(column) << before
        << std::setw(column) << after << '\n';
  };
  print_counts("creases: edges beyond 90 degrees but feature edges", r.initial_number_of_creases,
               r.number_of_creases);
  print_counts("self-intersecting pairs of faces", r.initial_number_of_self_intersections,
               r.number_of_self_intersections);
  if(options.detects_features)
    out << std::left << std::setw(label) << "feature edges detected" << std::right
        << std::setw(column) << r.number_of_feature_edges << '\n';
  const RCO::Initial_mesh_report& initial = report.initial;
  if(!initial.added_landmarks.empty())
    out << "landmarks added at extremities, of source and reference: "
        << joined(initial.added_landmarks) << '\n';
  for(const bool is_source : {true, false})
    if(const auto& v = is_source ? initial.unpaired_in_source : initial.unpaired_in_reference;
       !v.empty())
      out << "extremities of the " << (is_source ? "source" : "reference")
          << " without a counterpart; set landmarks at these vertices: " << joined(v) << '\n';
  out << std::setprecision(2) << text_of(report.verdict) << " (" << name(r.status)
      << "): " << r.number_of_iterations << " iterations, " << r.running_time << " seconds";
  if(!options.output.empty())
    out << "; result: " << options.output;
  out << std::endl;
}

#endif // RCO_PROGRAM_REPORT_H
