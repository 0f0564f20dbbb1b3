// SPDX-License-Identifier: Apache-2.0
#include "emulators/lab/run_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <climits>
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

/// Answers the errno, and the child. `files`: nullptr for ours.
int spawn(std::vector<std::string> arguments, std::vector<std::string> environment,
          const posix_spawn_file_actions_t* files, pid_t& pid) {
  const auto argv = pointers_to(arguments);
  const auto envp = pointers_to(environment);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  const auto signals = SignalsOfProgram::set();
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  const int error = ::posix_spawnp(&pid, argv[0], files, &attributes, argv.data(), envp.data());
  posix_spawnattr_destroy(&attributes);
  return error;
}

/// Whose signals are handed on.
int spawn_known(const std::vector<std::string>& arguments,
                const std::vector<std::string>& environment) {
  pid_t pid = 0;
  const int error = spawn(arguments, environment, nullptr, pid);
  if (error == 0) child = pid;
  if (const int signal = early.exchange(0); signal != 0) hand_on(signal);
  return error;
}

int spawn_silently(const std::vector<std::string>& arguments,
                   const std::vector<std::string>& environment, pid_t& pid) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  const int error = spawn(arguments, environment, &files, pid);
  posix_spawn_file_actions_destroy(&files);
  return error;
}

tl::unexpected<Problem> not_started(const std::string& program, int error) {
  return problem(error_from_errno(error).code, program,
                 "is it the name of a program, or the path of one?");
}

int wait_for(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kKilledBySignal + WTERMSIG(status);
}

/// Whether it does so in that time.
bool ends_within(pid_t pid, Duration patience) {
  const auto file = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
  if (file < 0) return false;
  pollfd ended{file, POLLIN, 0};
  const auto end = std::chrono::steady_clock::now() + patience;
  int ready = 0;
  do {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(
        std::max(end - std::chrono::steady_clock::now(), Duration{}));
    ready = ::poll(&ended, 1, static_cast<int>(std::min<std::int64_t>(left.count(), INT_MAX)));
  } while (ready < 0 && errno == EINTR);
  ::close(file);
  return ready > 0;
}

}  // namespace

Outcome<int> run_program(const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment) {
  const SignalsOfProgram signals;
  const int error = spawn_known(arguments, changed_environment(environment));
  if (error != 0) return not_started(arguments.front(), error);
  const auto code = wait_for(child);
  child = 0;
  return code;
}

Outcome<std::optional<int>> run_program_silently(const std::vector<std::string>& arguments,
                                                 const std::vector<std::string>& environment,
                                                 Duration patience) {
  pid_t pid = 0;
  const int error = spawn_silently(arguments, changed_environment(environment), pid);
  if (error != 0) return not_started(arguments.front(), error);
  const bool has_ended = ends_within(pid, patience);
  if (!has_ended) ::kill(pid, SIGKILL);
  const auto code = wait_for(pid);
  return has_ended ? std::optional{code} : std::nullopt;
}

}  // namespace armjig
