// SPDX-License-Identifier: Apache-2.0
#include "cli/outputs.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <new>
#include <optional>
#include <utility>
#include <vector>

namespace armjig::cli {
namespace {

constexpr auto kStandardOutput = "standard output";

struct Opened {
  std::string what;  ///< the option, and its path
  Output file;
};

/// Standard descriptors that nobody opened. Not writable, so that what is lost is noticed.
int open_missing_descriptors() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) >= 0) continue;
    (void)::open("/dev/null", descriptor == STDOUT_FILENO ? O_RDONLY : O_RDWR);
  }
  return 0;
}

struct State {
  int descriptors = open_missing_descriptors();
  StandardStream output{stdout, STDOUT_FILENO};
  StandardStream errors{stderr, STDERR_FILENO};
  std::vector<Opened> opened;
  std::string owner;  ///< of standard output
};
std::optional<State> state;

Problem second_of(std::string what, std::string_view first) {
  return {ErrorCode::kBadValue, std::move(what), fmt::format("{} goes there already", first)};
}

}  // namespace

Outcome<Output> open_output(std::string_view option, const std::string& path,
                            OutputFile::Kind kind) {
  if (path.empty()) return nullptr;
  auto what = fmt::format("{} {}", option, path);
  auto file = OutputFile::open(path, kind);
  if (!file) {
    file.error().where = std::move(what);
    return file;
  }
  for (const auto& other : state->opened) {
    if ((*file)->is_same_place(*other.file)) return tl::unexpected{second_of(what, other.what)};
  }
  if ((*file)->is_standard_output()) {
    if (!state->owner.empty()) return tl::unexpected{second_of(what, state->owner)};
    state->output.lead_to(STDERR_FILENO);
  } else if (const auto printed = OutputFile::open("-");
             printed && (*file)->is_same_place(**printed)) {
    return tl::unexpected{second_of(what, kStandardOutput)};
  }
  state->opened.push_back({std::move(what), *file});
  return file;
}

Outcome<void> claim_standard_output(std::string_view option) {
  if (option.empty()) return {};
  for (const auto& other : state->opened) {
    if (!other.file->is_standard_output()) continue;
    return tl::unexpected{second_of(std::string{option}, other.what)};
  }
  state->owner = option;
  return {};
}

bool is_standard_output_lost() noexcept { return state->output.error() != 0; }

StandardStream::StandardStream(std::FILE*& stream, int descriptor)
    : stream_{stream}, before_{stream}, descriptor_{descriptor} {
  ours_ =
      ::fopencookie(this, "w", {.read = nullptr, .write = put, .seek = nullptr, .close = nullptr});
  if (ours_ == nullptr) throw std::bad_alloc{};
  const int mode = descriptor == STDERR_FILENO ? _IONBF
                   : ::isatty(descriptor) == 1 ? _IOLBF
                                               : _IOFBF;
  std::setvbuf(ours_, nullptr, mode, BUFSIZ);
  std::fflush(before_);
  stream_ = ours_;
}

StandardStream::~StandardStream() {
  std::fclose(ours_);
  stream_ = before_;
}

void StandardStream::lead_to(int descriptor) {
  std::fflush(ours_);
  descriptor_ = descriptor;
}

ssize_t StandardStream::put(void* self, const char* text, std::size_t size) {
  auto& stream = *static_cast<StandardStream*>(self);
  std::string_view rest{text, size};
  if (stream.error_ == 0) stream.error_ = write_all(stream.descriptor_, rest);
  return static_cast<ssize_t>(size);
}

Outputs::Outputs() {
  assert(!state);
  state.emplace();
  struct sigaction ignored{};
  ignored.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &ignored, &before_);
}

Outputs::~Outputs() {
  state.reset();
  ::sigaction(SIGPIPE, &before_, nullptr);
}

Exit Outputs::finish(Exit exit) {
  std::fflush(stdout);
  std::vector<Problem> problems;
  bool has_lost_reader = false;
  if (const int error = state->output.error(); error == EPIPE) {
    has_lost_reader = true;
  } else if (error != 0) {
    problems.push_back(problem_of_writing(kStandardOutput, error));
  }
  for (const auto& [what, file] : state->opened) {
    if (!file->failure()) continue;
    if (file->is_standard_output() && file->failure()->code == ErrorCode::kDisconnected) {
      has_lost_reader = true;  // as it is with a broken pipe: nobody wants to know
    } else {
      problems.push_back(*file->failure());
      problems.back().where = what;
    }
  }
  for (const auto& problem : problems) (void)report(problem);
  if (exit == Exit::kUsage || exit == Exit::kBug) return exit;
  if (!problems.empty()) return Exit::kRig;
  return has_lost_reader ? Exit::kReaderGone : exit;
}

}  // namespace armjig::cli
