// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/pseudo_terminal.hpp"

#include <fcntl.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): POSIX, posix_openpt
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

namespace armjig {
namespace {

auto problem_of(int error_number) {
  return problem(error_from_errno(error_number).code, "/dev/ptmx",
                 "no pseudo-terminal to be had: " + std::generic_category().message(error_number));
}

bool set_non_blocking(const Descriptor& descriptor) noexcept {
  const auto flags = ::fcntl(descriptor.value(), F_GETFL);
  return flags >= 0 && ::fcntl(descriptor.value(), F_SETFL, flags | O_NONBLOCK) == 0;
}

}  // namespace

PseudoTerminal::PseudoTerminal(Descriptor master, std::string path)
    : master_{std::move(master)}, path_{std::move(path)} {}

Outcome<PseudoTerminal> PseudoTerminal::open() {
  Descriptor master{::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)};
  std::array<char, 128> path{};
  if (!master.is_open() || ::grantpt(master.value()) != 0 || ::unlockpt(master.value()) != 0 ||
      !set_non_blocking(master)) {
    return problem_of(errno);
  }
  if (const auto error_number = ::ptsname_r(master.value(), path.data(), path.size())) {
    return problem_of(error_number);
  }
  PseudoTerminal terminal{std::move(master), path.data()};
  terminal.reset();  // also makes the master report that nobody is there
  return terminal;
}

void PseudoTerminal::reset() const noexcept {
  // The master can neither empty the client's queue nor let stopped output go on.
  const Descriptor slave{::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  termios mode{};
  if (!slave.is_open() || ::tcgetattr(slave.value(), &mode) != 0) return;
  ::cfmakeraw(&mode);
  mode.c_cflag |= CREAD | CLOCAL;
  ::tcflow(slave.value(), TCOON);
  ::tcflush(slave.value(), TCIFLUSH);
  ::tcsetattr(slave.value(), TCSANOW, &mode);
}

}  // namespace armjig
