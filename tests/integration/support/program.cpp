// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/support/program.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace armjig::testing {
namespace {

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error{"pipe2 failed"};
    reading = Descriptor{ends[0]};
    writing = Descriptor{ends[1]};
  }
  Descriptor reading;
  Descriptor writing;
};

/// One byte; false at the end of the output, or of patience.
bool read_byte(const Descriptor& from, Stopwatch clock, Instant deadline, char& byte) {
  const auto is_ready = wait_for(from, Readiness::kReadable, clock, deadline);
  return is_ready && *is_ready && ::read(from.value(), &byte, 1) == 1;
}

}  // namespace

Program::Program(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), ARMJIG_PROGRAM);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (auto& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  Pipe output;
  Pipe errors;
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, output.writing.value(), STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, errors.writing.value(), STDERR_FILENO);
  const auto error = ::posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error{"cannot run " + arguments.front()};
  output_ = std::move(output.reading);
  errors_ = std::move(errors.reading);
}

Program::~Program() {
  if (pid_ < 0) return;
  signal(SIGKILL);
  (void)wait();
}

std::string Program::read_line() {
  const Stopwatch clock;
  std::string line;
  char byte{};
  while (read_byte(output_, clock, at(kPatience), byte) && byte != '\n') line += byte;
  return line;
}

std::string Program::read_errors() {
  const Stopwatch clock;
  std::string text;
  char byte{};
  while (read_byte(errors_, clock, at(kPatience), byte)) text += byte;
  return text;
}

void Program::signal(int number) const { ::kill(pid_, number); }

int Program::wait() {
  int status = 0;
  ::waitpid(std::exchange(pid_, -1), &status, 0);
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

long resident_kib(pid_t pid) {
  std::ifstream status{fmt::format("/proc/{}/status", pid)};
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
  }
  return 0;
}

Ended run_armjig(std::vector<std::string> arguments) {
  Program program{std::move(arguments)};
  auto errors = program.read_errors();
  return {program.wait(), std::move(errors)};
}

}  // namespace armjig::testing
