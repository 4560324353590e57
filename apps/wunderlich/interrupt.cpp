#include "interrupt.hpp"

#include <csignal>

namespace wunderlich::app {

namespace {

volatile std::sig_atomic_t requested = 0;

extern "C" void request_interrupt(int) { requested = 1; }

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = request_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupt_requested() { return requested != 0; }

}  // namespace wunderlich::app
