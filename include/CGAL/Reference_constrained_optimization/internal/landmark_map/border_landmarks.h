// Copyright (c) 2026 The Reference_constrained_optimization developers.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_BORDER_LANDMARKS_H
#define CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_BORDER_LANDMARKS_H

#include <CGAL/Reference_constrained_optimization/Invalid_input.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/Cut_surface.h>
#include <CGAL/Reference_constrained_optimization/internal/landmark_map/counterparts.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace CGAL {
namespace Reference_constrained_optimization {
namespace internal {

// The border of the reference for each of the source: that with the same landmarks, and for borders without
// landmarks that at the most similar distances from all landmarks. Throws Invalid_input if landmarks contradict
// one another.
inline std::vector<int> corresponding_borders(const Cut_surface& source,
                                              const Cut_surface& reference)
{
  const int n = source.number_of_borders();
  std::vector<int> result(n, -1), pair_of(n, -1);
  for(int i = 0; i < int(source.landmarks().size()); ++i)
  {
    const int a = source.border_of(i), b = reference.border_of(i);
    if((a < 0) != (b < 0))
      throw Invalid_input("landmarks: of pair " + std::to_string(i) +
                          " only one vertex is on the border");
    if(a < 0)
      continue;
    const auto same = std::find(result.begin(), result.end(), b);
    const int other = same != result.end() ? int(same - result.begin()) : a;
    if((other != a || result[a] != b) && pair_of[other] >= 0)
      throw Invalid_input("landmarks: pairs " + std::to_string(pair_of[other]) + " and " +
                          std::to_string(i) +
                          " are on the same border of one of the meshes, and on two of the other");
    result[a] = b;
    pair_of[a] = i;
  }
  const auto distances = [](const Cut_surface& surface, const std::vector<int>& borders) {
    std::vector<std::vector<double>> from_landmarks(borders.size());
    for(int i = 0; i < int(surface.landmarks().size()); ++i)
    {
      const std::vector<double> d = surface.distances_from(surface.landmarks()[i]);
      for(std::size_t k = 0; k < borders.size(); ++k)
        from_landmarks[k].push_back(surface.closest_on_border(borders[k], d).first);
    }
    return from_landmarks;
  };
  std::vector<int> free_source, free_reference;
  for(int i = 0; i < n; ++i)
  {
    if(result[i] < 0)
      free_source.push_back(i);
    if(std::find(result.begin(), result.end(), i) == result.end())
      free_reference.push_back(i);
  }
  const double any_difference = 1000; // all of them are paired
  for(const std::pair<int, int>& p : counterparts(
        distances(source, free_source), distances(reference, free_reference), any_difference))
    result[free_source[p.first]] = free_reference[p.second];
  return result;
}

// Gives borders landmarks up to three, so that they are sides of a polygon: a border without any is connected to
// the landmark that is closest to it on both surfaces; parts between landmarks are divided into equal lengths.
// Returns the landmarks of each border, in the order of the source's. Throws Invalid_input if their order on the
// reference is another.
inline std::vector<std::vector<int>> set_border_landmarks(Cut_surface& source,
                                                          Cut_surface& reference)
{
  const std::vector<int> corresponding = corresponding_borders(source, reference);
  const int n = int(source.landmarks().size());
  std::vector<std::vector<int>> result;
  for(int border = 0; border < int(corresponding.size()); ++border)
  {
    const int other_border = corresponding[border];
    if(source.border_landmarks(border).empty())
    {
      double least = std::numeric_limits<double>::infinity();
      std::pair<Cut_surface::Vertex, Cut_surface::Vertex> best;
      for(int i = 0; i < n; ++i)
      {
        const auto a =
          source.closest_on_border(border, source.distances_from(source.landmarks()[i]));
        const auto b = reference.closest_on_border(
          other_border, reference.distances_from(reference.landmarks()[i]));
        if(a.first + b.first < least)
        {
          least = a.first + b.first;
          best = {a.second, b.second};
        }
      }
      source.add_landmark(best.first);
      reference.add_landmark(best.second);
    }
    std::vector<int> order = source.border_landmarks(border);
    if(order.size() < 3)
    {
      const int parts = order.size() == 1 ? 3 : 2;
      std::vector<double> lengths[2];
      for(std::size_t i = 0; i < order.size(); ++i)
      {
        const int next = order[(i + 1) % order.size()];
        lengths[0].push_back(source.border_length(order[i], next));
        lengths[1].push_back(reference.border_length(order[i], next));
      }
      for(std::size_t i = 0; i < order.size(); ++i)
        for(int part = 1; part < parts; ++part)
        {
          source.add_border_landmark(order[i], lengths[0][i] * part / parts);
          reference.add_border_landmark(order[i], lengths[1][i] * part / parts);
        }
    }
    order = source.border_landmarks(border);
    std::vector<int> other = reference.border_landmarks(other_border);
    std::rotate(other.begin(), std::find(other.begin(), other.end(), order.front()), other.end());
    if(other != order)
    {
      std::reverse(other.begin() + 1, other.end());
      throw Invalid_input(std::string("landmarks: those on the borders are not in the same order") +
                          (other == order ? ", but in the opposite one: is one of the surfaces "
                                            "oriented the other way round?"
                                          : ""));
    }
    result.push_back(std::move(order));
  }
  return result;
}

} // namespace internal
} // namespace Reference_constrained_optimization
} // namespace CGAL

#endif // CGAL_REFERENCE_CONSTRAINED_OPTIMIZATION_INTERNAL_LANDMARK_MAP_BORDER_LANDMARKS_H
