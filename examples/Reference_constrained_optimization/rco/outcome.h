// How a run of rco ended: the program's exit codes, and the exception that carries one.

#ifndef RCO_PROGRAM_OUTCOME_H
#define RCO_PROGRAM_OUTCOME_H

#include <stdexcept>
#include <string>

// options.cpp lists them for the user
enum class Outcome {
  improved = 0,
  failure = 1,
  bad_usage = 2,
  unreadable_file = 3,
  unwritable_file = 4,
  refused_input = 5,
  nothing_to_do = 10,
  out_of_time = 11,
  interrupted = 12,
  not_usable = 13,
  not_better = 14
};

inline const char* name(Outcome outcome)
{
  switch(outcome)
  {
  case Outcome::improved:
    return "improved";
  case Outcome::failure:
    return "failure";
  case Outcome::bad_usage:
    return "bad usage";
  case Outcome::unreadable_file:
    return "unreadable file";
  case Outcome::unwritable_file:
    return "unwritable file";
  case Outcome::refused_input:
    return "refused input";
  case Outcome::nothing_to_do:
    return "nothing to do";
  case Outcome::out_of_time:
    return "out of time";
  case Outcome::interrupted:
    return "interrupted";
  case Outcome::not_usable:
    return "no usable map";
  case Outcome::not_better:
    return "not better";
  }
  return "";
}

class Failure : public std::runtime_error
{
  Outcome m_outcome;

public:
  Failure(Outcome outcome, const std::string& message)
    : std::runtime_error(message),
      m_outcome(outcome)
  {}
  Outcome outcome() const { return m_outcome; }
};

#endif // RCO_PROGRAM_OUTCOME_H
