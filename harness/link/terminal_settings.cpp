// SPDX-License-Identifier: Apache-2.0
#include "harness/link/terminal_settings.hpp"

#include <fmt/core.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <sstream>

namespace armjig {
namespace {

/// A signal handler looks at these, so they have a place that never moves.
struct Kept {
  volatile std::sig_atomic_t terminal = -1;
  termios settings{};
};
constexpr std::size_t kMostKept = 16;
std::array<Kept, kMostKept> all_kept;
std::mutex all_kept_mutex;

void put_back(const Kept& kept) noexcept {
  if (kept.terminal >= 0) ::tcsetattr(kept.terminal, TCSANOW, &kept.settings);
}

extern "C" void put_back_and_end(int signal) {
  const int error_number = errno;
  for (const auto& kept : all_kept) put_back(kept);
  errno = error_number;
  ::signal(signal, SIG_DFL);
  ::raise(signal);  // delivered when this handler is left
}

void handle_ends() noexcept {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action{};
    ::sigaction(signal, nullptr, &action);
    if (action.sa_handler != SIG_DFL) continue;
    action.sa_handler = put_back_and_end;
    ::sigaction(signal, &action, nullptr);
  }
}

/// The number of the terminal in /proc/PID/stat, and the session.
struct OnTerminal {
  pid_t session{};
  unsigned terminal{};
};

std::optional<OnTerminal> read_stat(const std::filesystem::path& folder) {
  std::ifstream file{folder / "stat"};
  std::string line;
  std::getline(file, line);
  const auto end_of_name = line.rfind(')');
  if (end_of_name == std::string::npos) return std::nullopt;
  std::istringstream rest{line.substr(end_of_name + 1)};
  char state{};
  pid_t parent{};
  pid_t group{};
  OnTerminal found;
  rest >> state >> parent >> group >> found.session >> found.terminal;
  return rest ? std::optional{found} : std::nullopt;
}

/// As /proc writes it.
unsigned number_of(dev_t device) noexcept {
  const auto low = minor(device);
  return (low & 0xFFU) | (major(device) << 8U) | ((low & ~0xFFU) << 12U);
}

}  // namespace

Result<TerminalSettings> TerminalSettings::keep(int terminal) noexcept {
  const std::scoped_lock lock{all_kept_mutex};
  const auto place = std::ranges::find(
      all_kept, -1, [](const Kept& kept) { return static_cast<int>(kept.terminal); });
  if (place == all_kept.end()) return fail(ErrorCode::kBusy);
  if (::tcgetattr(terminal, &place->settings) != 0) return tl::unexpected{error_from_errno(errno)};
  place->terminal = terminal;
  handle_ends();
  return TerminalSettings{static_cast<int>(place - all_kept.begin())};
}

TerminalSettings::~TerminalSettings() {
  if (place_ < 0) return;
  const std::scoped_lock lock{all_kept_mutex};
  auto& kept = all_kept[static_cast<std::size_t>(place_)];
  put_back(kept);
  kept.terminal = -1;
}

pid_t session_on(int terminal) {
  if (const auto session = ::tcgetsid(terminal); session > 0) return session;  // our own
  struct stat status{};
  if (::fstat(terminal, &status) != 0) return 0;
  std::error_code error;
  for (std::filesystem::directory_iterator it{"/proc", error}, end; !error && it != end;
       it.increment(error)) {
    const auto name = it->path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const auto found = read_stat(it->path());
    if (found && found->terminal == number_of(status.st_rdev)) return found->session;
  }
  return 0;
}

std::string describe_session(pid_t session) {
  return fmt::format("it is the terminal of process {}", session);
}

}  // namespace armjig
