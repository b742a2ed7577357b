// Lets Ctrl-C end work that does not ask for it.

#ifndef RCO_PROGRAM_RUN_UNLESS_INTERRUPTED_H
#define RCO_PROGRAM_RUN_UNLESS_INTERRUPTED_H

#include "interruption.h"

#include <chrono>
#include <future>
#include <thread>
#include <utility>

// Returns false as soon as Ctrl-C is pressed, or at once if it was and nobody has heeded it. The work goes on then with all that it uses: the caller must
// end the program.
template <typename Work>
bool run_unless_interrupted(const Work& work)
{
  const Interruptible interruptible;
  std::packaged_task<void()> task(work);
  std::future<void> end = task.get_future();
  std::thread thread(std::move(task));
  while(end.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
    if(interruption_is_wanted)
    {
      thread.detach();
      return false;
    }
  thread.join();
  end.get(); // throws what the work has thrown
  return true;
}

#endif // RCO_PROGRAM_RUN_UNLESS_INTERRUPTED_H
