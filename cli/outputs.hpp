// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <memory>

#include "cli/command.hpp"
#include "harness/core/error.hpp"
#include "harness/report/output_file.hpp"

namespace armjig::cli {

using Output = std::shared_ptr<OutputFile>;

/// Opens what an option says, before the subcommand begins; none for an empty path. `-` is standard
/// output: whatever else is printed there goes to standard error from then on. What fails to be
/// written later is said by `run_program` at the end. Problems: those of `OutputFile::open`, and
/// `kBadValue` if something else goes to the same place.
[[nodiscard]] Outcome<Output> open_output(std::string_view option, const std::string& path,
                                          OutputFile::Kind kind = OutputFile::Kind::kWhole);

struct NamedPath {
  std::string_view option;
  std::string path;
};

/// The same for several.
template <std::size_t count>
[[nodiscard]] Outcome<std::array<Output, count>> open_outputs(const NamedPath (&paths)[count]) {
  std::array<Output, count> outputs;
  for (std::size_t i = 0; i < count; ++i) {
    auto opened = open_output(paths[i].option, paths[i].path);
    if (!opened) return tl::unexpected{opened.error()};
    outputs[i] = *std::move(opened);
  }
  return outputs;
}

/// For an option whose results are printed and may not be mixed with others: no file may be `-`.
/// Does nothing for an empty one. Problems: `kBadValue`.
[[nodiscard]] Outcome<void> claim_standard_output(std::string_view option);

/// Whether what is printed arrives nowhere: a full disk, or a reader that has gone.
[[nodiscard]] bool is_standard_output_lost() noexcept;

/// A standard stream for those who print. They never see it fail: what could not be written is
/// known to whoever asks.
class StandardStream {
 public:
  /// Takes the place of `stream`, as `stdout`, for as long as it lives.
  StandardStream(std::FILE*& stream, int descriptor);
  StandardStream(const StandardStream&) = delete;
  StandardStream& operator=(const StandardStream&) = delete;
  ~StandardStream();

  /// What is printed from now on goes there.
  void lead_to(int descriptor);
  /// The first error, an errno; 0: none. Nothing was written after it.
  [[nodiscard]] int error() const noexcept { return error_; }

 private:
  static ssize_t put(void* self, const char* text, std::size_t size);

  std::FILE*& stream_;
  std::FILE* before_;
  std::FILE* ours_;
  int descriptor_;
  std::atomic<int> error_{0};
};

/// All that a run of the program writes. One at a time.
class Outputs {
 public:
  /// A standard descriptor that is closed leads to nowhere, so that no port gets its number.
  Outputs();
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;
  ~Outputs();

  /// After everything else: says in one line each what could not be written. Answers the exit code
  /// of a run that came to `exit`.
  [[nodiscard]] Exit finish(Exit exit);

 private:
  struct sigaction before_{};  ///< of a broken pipe
};

}  // namespace armjig::cli
