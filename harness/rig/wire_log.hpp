// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/report/output_file.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// A `golden-trace/1` file that grows line by line with what passes, and what it means: a key
/// `messages` has those that ended in the line. `armjig decode` reads it back. Lines are in the
/// file as they are made, so that nothing is missing after a crash. A file that cannot be written
/// any more ends with its last whole line, and tells why (`OutputFile::failure`). Not in it: what a
/// write that failed may have sent in part, and the stops of the supervisor, which come when we are
/// gone.
class WireLog {
 public:
  using MakeDissector = std::unique_ptr<Dissector> (*)();

  /// A key of a line and its value.
  struct Key {
    std::string_view name;
    std::variant<bool, std::int64_t, std::string> value;
  };
  using Keys = std::vector<Key>;

  /// What was said on one byte stream, connection or bus.
  class Talk {
   public:
    explicit Talk(std::shared_ptr<WireLog> log);
    /// A line with `keys` after the time. `bytes` are what they tell.
    void add(Instant time, const Keys& keys, Direction direction, Bytes bytes);
    /// A line `to_device` or `from_device`, with `keys` between direction and bytes.
    void add_bytes(Instant time, const Keys& keys, Direction direction, Bytes bytes);
    [[nodiscard]] WireLog& log() noexcept { return *log_; }

   private:
    std::shared_ptr<WireLog> log_;
    std::unique_ptr<Dissector> dissector_;
  };

  /// Begins `file`, of the growing kind. Problems: it cannot be written.
  [[nodiscard]] static Outcome<std::shared_ptr<WireLog>> create(std::shared_ptr<OutputFile> file,
                                                                std::string_view device,
                                                                MakeDissector make_dissector);

  /// A line with `keys` after the time. A time before the last one, as clocks that were read one
  /// after the other may have it, is taken for that.
  void add(Instant time, const Keys& keys, std::span<const Message> messages = {});

  /// What somebody did at the device; `kind` is `dir` or `op`.
  void add_input(Instant time, std::string_view kind, std::string_view name, std::int64_t value);

  /// Numbers connections in the order of their beginnings.
  [[nodiscard]] int next_connection() noexcept { return connections_++; }

 private:
  WireLog(std::shared_ptr<OutputFile> file, MakeDissector make_dissector);

  std::shared_ptr<OutputFile> file_;
  MakeDissector make_dissector_;
  Instant last_{};
  int connections_ = 0;
};

}  // namespace armjig
