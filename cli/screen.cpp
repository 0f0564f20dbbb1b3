// SPDX-License-Identifier: Apache-2.0
#include "cli/screen.hpp"

#include <fmt/core.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <string>

#include "cli/environment.hpp"

namespace armjig::cli {
namespace {

constexpr auto kBegin = "\033[?1049h\033[?25l";  // other screen, no cursor
constexpr auto kEnd = "\033[?25h\033[?1049l";
constexpr auto kHome = "\033[H";
constexpr auto kClearLine = "\033[K";
constexpr auto kClearRest = "\033[J";

struct Size {
  std::size_t rows = 24;
  std::size_t columns = 80;
};

Size terminal_size() {
  winsize size{};
  const bool is_known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0;
  return is_known ? Size{size.ws_row, size.ws_col} : Size{};
}

}  // namespace

bool has_screen() {
  const auto terminal = environment("TERM");
  return ::isatty(STDOUT_FILENO) == 1 && !terminal.empty() && terminal != "dumb";
}

Screen::Screen() {
  termios now{};
  if (::tcgetattr(STDIN_FILENO, &now) == 0) {
    before_ = now;
    now.c_lflag &= ~static_cast<tcflag_t>(ECHO | ICANON);
    ::tcsetattr(STDIN_FILENO, TCSANOW, &now);
  }
  fmt::print("{}", kBegin);
}

Screen::~Screen() {
  std::fputs(kEnd, stdout);
  std::fflush(stdout);
  if (before_) ::tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
}

void Screen::draw(std::string_view text) {
  const auto size = terminal_size();
  std::string page = kHome;
  for (std::size_t row = 0; row < size.rows && !text.empty(); ++row) {
    const auto end = text.find('\n');
    if (row > 0) page += "\r\n";
    page += text.substr(0, std::min(end, size.columns));
    page += kClearLine;
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  fmt::print("{}{}", page, kClearRest);
  std::fflush(stdout);
}

bool Screen::wants_to_quit() const {
  if (!before_) return false;
  for (;;) {
    pollfd ready{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    char key{};
    if (::poll(&ready, 1, 0) != 1 || ::read(STDIN_FILENO, &key, 1) != 1) return false;
    if (key == 'q' || key == 'Q') return true;
  }
}

}  // namespace armjig::cli
