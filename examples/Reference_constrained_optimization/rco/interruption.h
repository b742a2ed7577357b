// While it lives, Ctrl-C and SIGTERM ask for an early end instead of ending the program; a second
// one ends it at once.

#ifndef RCO_PROGRAM_INTERRUPTION_H
#define RCO_PROGRAM_INTERRUPTION_H

#include <csignal>

// a signal handler may do little more than set this
inline volatile std::sig_atomic_t interruption_is_wanted = 0;

extern "C" inline void want_interruption(int)
{
  interruption_is_wanted = 1;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

class Interruptible
{
  struct Handler
  {
    int number;
    void (*previous)(int);
    explicit Handler(int n) : number(n), previous(std::signal(n, want_interruption))
    {
      if(previous == SIG_IGN) // whoever started the program wants it so
        std::signal(n, SIG_IGN);
    }
    ~Handler() { std::signal(number, previous == SIG_ERR ? SIG_DFL : previous); }
  };
  Handler m_interrupt{SIGINT}, m_terminate{SIGTERM};

public:
  Interruptible() = default;
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
};

#endif // RCO_PROGRAM_INTERRUPTION_H
