// Reads pairs of vertices: lines of two numbers, with comments after a #.

#ifndef RCO_PROGRAM_LANDMARKS_H
#define RCO_PROGRAM_LANDMARKS_H

#include "mesh.h"
#include "outcome.h"

#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

typedef std::vector<std::pair<Mesh::Vertex_index, Mesh::Vertex_index>> Landmarks;

inline Landmarks read_landmarks(const std::string& file, const Mesh& source, const Mesh& reference)
{
  std::ifstream in(file);
  if(!in)
    throw Failure(Outcome::unreadable_file, file + " cannot be opened");
  Landmarks landmarks;
  std::string line, rest;
  for(int number = 1; std::getline(in, line); ++number)
  {
    const auto refuse = [&](const std::string& what) {
      throw Failure(Outcome::unreadable_file,
                    file + ", line " + std::to_string(number) + ": " + what);
    };
    std::istringstream words(line.substr(0, line.find('#')));
    long long v, w;
    if(!(words >> std::ws) || words.eof())
      continue;
    if(!(words >> v >> w) || words >> rest)
      refuse("two whole numbers are expected");
    if(v < 0 || v >= (long long)source.number_of_vertices())
      refuse("the source has no vertex " + std::to_string(v));
    if(w < 0 || w >= (long long)reference.number_of_vertices())
      refuse("the reference has no vertex " + std::to_string(w));
    landmarks.emplace_back(Mesh::Vertex_index(Mesh::size_type(v)),
                           Mesh::Vertex_index(Mesh::size_type(w)));
  }
  if(landmarks.empty())
    throw Failure(Outcome::unreadable_file, file + " has no landmark");
  return landmarks;
}

#endif // RCO_PROGRAM_LANDMARKS_H
