// SPDX-License-Identifier: Apache-2.0
#include "emulators/lab/run_program.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>

namespace armjig {
namespace {

constexpr int kKilledBySignal = 128;  // as shells say it

std::atomic<pid_t> child{0};
std::atomic<int> early{0};  ///< a signal that came before the child was known
static_assert(std::atomic<pid_t>::is_always_lock_free);

void hand_on(int signal) {
  early = signal;
  if (const pid_t pid = child.load(); pid > 0) ::kill(pid, signal);
}

/// Our signals while a program runs: those of the terminal reach it by themselves.
class SignalsOfProgram {
 public:
  SignalsOfProgram() {
    early = 0;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      struct sigaction action{};
      action.sa_handler = i < kFromTerminal ? SIG_IGN : hand_on;
      ::sigaction(kSignals[i], &action, &before_[i]);
    }
  }
  SignalsOfProgram(const SignalsOfProgram&) = delete;
  SignalsOfProgram& operator=(const SignalsOfProgram&) = delete;
  ~SignalsOfProgram() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], &before_[i], nullptr);
    }
  }

  /// What the program shall have as if nothing was here.
  [[nodiscard]] static sigset_t set() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : kSignals) sigaddset(&signals, signal);
    sigaddset(&signals, SIGPIPE);
    return signals;
  }

 private:
  static constexpr std::array kSignals{SIGINT, SIGQUIT, SIGTERM, SIGHUP};
  static constexpr std::size_t kFromTerminal = 2;

  std::array<struct sigaction, kSignals.size()> before_{};
};

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (auto& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Our environment with other values for the names in `changes`.
std::vector<std::string> changed_environment(const std::vector<std::string>& changes) {
  std::vector<std::string> all = changes;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const auto name = text.substr(0, text.find('=') + 1);
    const bool is_changed = std::ranges::any_of(
        changes, [&name](const std::string& change) { return change.starts_with(name); });
    if (!is_changed) all.push_back(text);
  }
  return all;
}

int spawn(std::vector<std::string> arguments, std::vector<std::string> environment) {
  const auto argv = pointers_to(arguments);
  const auto envp = pointers_to(environment);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  const auto signals = SignalsOfProgram::set();
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  pid_t pid = 0;
  const int error = ::posix_spawnp(&pid, argv[0], nullptr, &attributes, argv.data(), envp.data());
  if (error == 0) child = pid;
  if (const int signal = early.exchange(0); signal != 0) hand_on(signal);
  posix_spawnattr_destroy(&attributes);
  return error;
}

}  // namespace

Outcome<int> run_program(const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment) {
  const SignalsOfProgram signals;
  if (const int error = spawn(arguments, changed_environment(environment)); error != 0) {
    return problem(error_from_errno(error).code, arguments.front(),
                   "is it the name of a program, or the path of one?");
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  child = 0;
  return WIFEXITED(status) ? WEXITSTATUS(status) : kKilledBySignal + WTERMSIG(status);
}

}  // namespace armjig
