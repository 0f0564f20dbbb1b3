// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/capture/capture.hpp"
#include "harness/core/error.hpp"
#include "harness/core/overhearer.hpp"
#include "harness/core/time.hpp"
#include "harness/report/output_file.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// Where a recording goes, and how.
struct CaptureFile {
  /// A file that is full is kept, and another one begun.
  struct Rotation {
    std::uint64_t bytes{};  ///< of a file, unless one record is longer
    int files{};            ///< that are kept, the newest among them
  };

  std::shared_ptr<OutputFile> file{};  ///< of the growing kind; none: nothing is written
  /// Is told each record, too; nobody is if empty.
  std::function<void(const CaptureRecord&)> listener{};
  CaptureFormat format{};
  std::optional<Rotation> rotation{};
  bool is_redacted = false;  ///< leaves out of the header who recorded it and where

  /// Whether anything has to be recorded.
  [[nodiscard]] bool is_wanted() const { return file != nullptr || listener; }
};

/// What a recording says of itself.
struct CaptureSubject {
  std::string_view device;
  MakeDissector make_dissector{};
  std::string target{};     ///< as it was written, or would be
  std::int64_t epoch_ns{};  ///< its start, since 1970; 0: virtual time
};

/// The moment, for a recording whose time is `since_start` now.
[[nodiscard]] std::int64_t epoch_of(Instant since_start);

/// A recording that grows record by record with what passes. In a text it also says what that
/// means: a key `messages` has those that ended in the line. Records are in the file as they are
/// made, so that nothing is missing after a crash. A file that cannot be written any more ends with
/// its last whole record, and tells why (`OutputFile::failure`). Not in it: what a write that
/// failed may have sent in part, and the stops of the supervisor, which come when we are gone.
class WireLog {
 public:
  /// Something more that is known of a record.
  struct Key {
    std::string_view name;
    std::variant<bool, std::int64_t, std::string> value;
  };
  using Keys = std::vector<Key>;

  /// What was said on one byte stream, connection or bus.
  class Talk {
   public:
    /// `id` is the number of a connection.
    Talk(std::shared_ptr<WireLog> log, LinkKind kind, std::uint32_t id = 0);
    void add(Instant time, Direction direction, Bytes bytes);
    void add(const BusPart& part, const Keys& more = {});
    [[nodiscard]] WireLog& log() noexcept { return *log_; }

   private:
    void add(CaptureRecord record, Bytes dissected);

    std::shared_ptr<WireLog> log_;
    const CaptureLink* link_;
    std::uint32_t id_;
    std::unique_ptr<Dissector> dissector_;
    std::vector<Message> messages_;
  };

  /// Begins the file. Problems: it cannot be written.
  [[nodiscard]] static Outcome<std::shared_ptr<WireLog>> create(const CaptureFile& file,
                                                                const CaptureSubject& subject);

  /// An event with `keys` after the time, the first of them `dir` or `op`. A time before the last
  /// one, as clocks that were read one after the other may have it, is taken for that.
  void add_event(Instant time, const Keys& keys);

  /// What somebody did at the device; `kind` is `dir` or `op`.
  void add_input(Instant time, std::string_view kind, std::string_view name, std::int64_t value);

  /// How a connection began (`connect`) or ended (`disconnect`).
  void add_border(Instant time, std::uint32_t connection, std::string_view direction,
                  std::string_view how);

  /// Numbers connections in the order of their beginnings.
  [[nodiscard]] std::uint32_t next_connection() noexcept { return connections_++; }

 private:
  WireLog(const CaptureFile& file, const CaptureSubject& subject);

  void add(CaptureRecord record, std::span<const Message> messages);
  [[nodiscard]] bool is_full() const noexcept;
  [[nodiscard]] const CaptureLink* link_of(LinkKind kind) const noexcept;

  CaptureFile file_;
  CaptureHeader header_;
  MakeDissector make_dissector_;
  std::unique_ptr<CaptureWriter> writer_;
  std::vector<CaptureLink> links_;  ///< by kind
  std::string text_;
  std::uint64_t size_ = 0;        ///< of the file
  std::uint64_t least_size_ = 0;  ///< of one with nothing but the header
  Instant last_{};
  std::uint32_t connections_ = 0;
};

/// Writes down what it overhears on that kind of link.
[[nodiscard]] std::unique_ptr<Overhearer> write_overheard(std::shared_ptr<WireLog> log,
                                                          LinkKind kind);

}  // namespace armjig
