// SPDX-License-Identifier: Apache-2.0
#include "cli/signals.hpp"

#include <cstddef>

namespace armjig::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;
volatile std::sig_atomic_t ended = 0;
volatile std::sig_atomic_t last_number = 0;

extern "C" void on_signal(int number) {
  last_number = number;
  if (number == SIGINT) {
    interrupted = 1;
  } else {
    ended = 1;
  }
}

}  // namespace

Signals::Signals() {
  interrupted = 0;
  ended = 0;
  last_number = 0;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction action{};
    action.sa_handler = kSignals[i] == SIGTSTP ? SIG_IGN : on_signal;
    ::sigaction(kSignals[i], &action, &before_[i]);
  }
}

Signals::~Signals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
}

bool Signals::take_interrupt() noexcept {
  const bool was_interrupted = interrupted != 0;
  interrupted = 0;
  return was_interrupted;
}

bool Signals::must_end() const noexcept { return ended != 0; }

bool Signals::has_come() const noexcept { return last_number != 0; }

Exit Signals::exit() const noexcept { return static_cast<Exit>(128 + last_number); }

}  // namespace armjig::cli
