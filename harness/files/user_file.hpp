// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "harness/core/error.hpp"

namespace armjig {

/// What is read as a whole may have so many bytes if nothing else is said: settings, reports,
/// robot descriptions.
inline constexpr std::size_t kMostFileBytes = std::size_t{16} << 20U;
/// What is read by lines: recordings.
inline constexpr std::size_t kMostLineBytes = std::size_t{1} << 20U;
inline constexpr std::size_t kMostBytesInLines = std::size_t{1} << 30U;

/// A file that a user has named, open for reading. Problems of all functions are `kCannotRead`;
/// they name the file, the line if there is one, and what to do.
class UserFile {
 public:
  /// A file or a pipe. Not a folder, nor a device, which may have no end. A pipe that nobody has
  /// opened for writing within a second is given up; one that has a writer is waited for.
  [[nodiscard]] static Outcome<UserFile> open(std::string path);
  [[nodiscard]] static UserFile standard_input();
  /// Text in memory as if it were a file of that name, for what reads files only.
  [[nodiscard]] static UserFile of_text(std::string_view text, std::string name);

  /// What has not been read yet, or a problem if that is more than `most` bytes.
  [[nodiscard]] Outcome<std::string> rest(std::size_t most = kMostFileBytes);

  /// The next line without `\n` or `\r\n`; none at the end. Valid until the next call.
  [[nodiscard]] Outcome<std::optional<std::string_view>> next_line();
  /// Of the line that was read last, from 1.
  [[nodiscard]] std::size_t line_number() const noexcept { return line_number_; }

  /// As many of the next bytes as there are in the file; none at its end. For what is no text.
  [[nodiscard]] Outcome<std::size_t> read(std::span<std::byte> into);

  /// The next byte, which is still there afterwards; none at the end.
  [[nodiscard]] std::optional<char> peek();
  /// Whether the next bytes are these, which are still there afterwards.
  [[nodiscard]] bool starts_with(std::string_view bytes);

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept;
  };
  UserFile(std::FILE* file, std::string name) : file_{file}, name_{std::move(name)} {}
  [[nodiscard]] tl::unexpected<Problem> refuse(std::string hint) const;
  [[nodiscard]] Outcome<void> check() const;

  std::unique_ptr<std::string> text_;  ///< that it reads, if it is in memory; outlives the file
  std::unique_ptr<std::FILE, Close> file_;
  std::string name_;
  std::string line_;
  std::size_t line_number_ = 0;
  std::size_t read_ = 0;
};

/// All of a file.
[[nodiscard]] Outcome<std::string> read_user_file(const std::string& path,
                                                  std::size_t most = kMostFileBytes);

}  // namespace armjig
