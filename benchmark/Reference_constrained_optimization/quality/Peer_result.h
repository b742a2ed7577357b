#pragma once

// What an optimizer hands back, and the clock that all are timed with.

#include "../meshes.h"

#include <ctime>
#include <string>

// processor time: all optimizers use one thread, and other load on the machine must not count
class Stopwatch
{
public:
  double seconds() const { return double(std::clock() - m_start) / CLOCKS_PER_SEC; }

private:
  std::clock_t m_start = std::clock();
};

struct Peer_result
{
  Mesh mesh;
  double seconds = 0;
  std::string note; // what else should be known of the run
};

// what `improve(mesh)`, which returns the note, makes of the input
template <typename Improve>
Peer_result timed(const Mesh& input, const Improve& improve)
{
  Peer_result result;
  result.mesh = input;
  const Stopwatch watch;
  result.note = improve(result.mesh);
  result.seconds = watch.seconds();
  return result;
}
