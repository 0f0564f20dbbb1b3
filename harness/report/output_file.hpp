// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "harness/core/error.hpp"

namespace armjig {

/// Where results go: a file, a device, a pipe, or standard output. Whether it can be written is
/// found out at once, long before there is something to write; until then nothing is changed.
///
/// A path is followed through its symbolic links, so a link stays one. `-`, /dev/stdout and the
/// like are the descriptors of this process; devices and FIFOs are written in place.
class OutputFile {
 public:
  enum class Kind : std::uint8_t {
    kWhole,    ///< all at once, beside the old file, which it replaces when it is complete
    kGrowing,  ///< piece by piece in place, each there for others when the call returns
  };

  /// A FIFO waits for its reader. Problems: `kCannotWrite` for what cannot be written; of `kWhole`,
  /// also for a folder that takes no new file.
  [[nodiscard]] static Outcome<std::shared_ptr<OutputFile>> open(const std::string& path,
                                                                 Kind kind = Kind::kWhole);

  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// The whole content, or the next piece. After a problem a file of `kWhole` is what it was, one
  /// of `kGrowing` ends with its last complete piece, and nothing more is written. Problems:
  /// `kDisconnected` if the reader has gone, or else `kCannotWrite`.
  Outcome<void> put(std::string_view content);

  /// Begins a new file at the same path; the one that was there is kept beside it, as
  /// NAME.1.ENDING, the one before as NAME.2.ENDING, and so on, `files` with the new one. Requires
  /// `can_rotate` and `files > 0`. Problems: as for `put`.
  Outcome<void> rotate(int files);
  /// Whether it is a file that grows, and has a name of its own.
  [[nodiscard]] bool can_rotate() const noexcept { return is_regular_ && kind_ == Kind::kGrowing; }

  /// The first problem of `put`; none so far.
  [[nodiscard]] const std::optional<Problem>& failure() const noexcept { return failure_; }
  [[nodiscard]] bool is_standard_output() const noexcept;
  /// Whether one of them would overwrite what the other one writes, or come in between, whatever
  /// their paths look like. Of devices such as /dev/null never.
  [[nodiscard]] bool is_same_place(const OutputFile& other) const noexcept;

 private:
  OutputFile(std::string path, Kind kind) : path_{std::move(path)}, kind_{kind} {}

  [[nodiscard]] int resolve();
  [[nodiscard]] int probe();
  [[nodiscard]] int write_whole(std::string_view content);
  [[nodiscard]] int append(std::string_view content);
  [[nodiscard]] int move_aside(int files);
  /// Does what answers an errno, unless that has failed before.
  template <class Work>
  Outcome<void> unless_failed(Work work);

  std::string path_;    ///< as it was said
  std::string target_;  ///< after all links
  Kind kind_;
  int descriptor_ = -1;     ///< written in place
  int own_ = -1;            ///< the number that this process calls it by, as 1; -1: a path
  bool is_regular_ = true;  ///< a file, there or not yet
  bool is_new_ = false;
  struct stat there_{};  ///< of what was there, or of the folder of a new file
  std::string name_;     ///< of a new file in the folder
  std::optional<Problem> failure_;
};

/// Writes all of it to a descriptor, however slowly it is taken; what is written is taken off
/// `content`. Answers 0 or the errno.
[[nodiscard]] int write_all(int descriptor, std::string_view& content) noexcept;

/// Problems: as for `OutputFile`.
[[nodiscard]] Problem problem_of_writing(std::string where, int error_number);

}  // namespace armjig
