// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/files/user_file.hpp"
#include "harness/wire/dissector.hpp"

/// A recording, whatever its file format: a timed sequence of records on links.
namespace armjig {

enum class LinkKind : std::uint8_t {
  kStream,
  kSession,  ///< a server; `id` of a record is the number of the connection
  kBus,      ///< I2C; `id` is the address
  kCan,      ///< frames beside the device's own link; `id` is the identifier
  kEvents,   ///< what happened beside all links: hand inputs, connections that begin and end
};

[[nodiscard]] std::string_view to_string(LinkKind kind) noexcept;

/// Where records come from.
struct CaptureLink {
  std::string name;    ///< the device's, if only one of them is recorded
  std::string device;  ///< empty: nobody said
  LinkKind kind{};

  friend bool operator==(const CaptureLink&, const CaptureLink&) = default;
};

/// What happened once. What it refers to belongs to whoever made it; of a reader it is valid until
/// the next one is read.
struct CaptureRecord {
  Instant time{};  ///< since the start of the recording; never decreases
  const CaptureLink* link{};
  Direction direction{};
  std::uint32_t id{};
  Bytes bytes;
  /// What else is known of it, members of a JSON object with commas between. Of an event it is all,
  /// and begins with `"dir"` or `"op"`. A time in milliseconds, as the recordings of a server have
  /// it, comes before everything else: `"t_ms":7`.
  std::string_view details;
};

/// How many bytes of that direction are missing before the record: `"lost":N` in its details. What
/// came before it belongs to no message with it.
[[nodiscard]] std::uint64_t lost_before(const CaptureRecord& record) noexcept;

/// What a recording says of itself: the header line of a `golden-trace/1` file.
struct CaptureHeader {
  std::string json;
  std::string device;
  std::int64_t epoch_ns{};  ///< the start, since 1970; 0: unknown, or virtual time

  /// From the line itself. Problems: `kMalformed`, with `where`.
  [[nodiscard]] static Outcome<CaptureHeader> parse(std::string_view line,
                                                    const std::string& where);
  /// The same without what may tell who recorded it and where: user, host, serial number, target.
  [[nodiscard]] CaptureHeader redacted() const;
};

enum class CaptureFormat : std::uint8_t {
  kLines,   ///< `golden-trace/1`
  kPcapng,  ///< docs/captures.md
};

/// By the ending of the name: `.pcapng`, or `.jsonl`; a name without an ending, and `-`, is
/// `kLines`. Problems: `kBadValue` for others, with the name.
[[nodiscard]] Outcome<CaptureFormat> capture_format_of(const std::string& path);

/// Reads records one by one, in memory that does not grow with the file.
class CaptureReader {
 public:
  /// The format is seen from the content; `path` is for messages. Problems: those of the file, and
  /// `kMalformed`.
  [[nodiscard]] static Outcome<std::unique_ptr<CaptureReader>> open(UserFile file,
                                                                    const std::string& path);

  CaptureReader() = default;
  CaptureReader(const CaptureReader&) = delete;
  CaptureReader& operator=(const CaptureReader&) = delete;
  virtual ~CaptureReader() = default;

  [[nodiscard]] const CaptureHeader& header() const noexcept { return header_; }
  /// What the file is, for people: `pcapng`, `golden-trace/1`, or what others write.
  [[nodiscard]] virtual std::string_view format() const noexcept = 0;
  /// The next record; false at the end. After a problem nothing more can be read.
  [[nodiscard]] virtual Outcome<bool> next(CaptureRecord& record) = 0;
  /// What is missing or was not understood, when all is read; empty: nothing.
  [[nodiscard]] virtual std::string warning() const { return {}; }

 protected:
  /// The link that is like this; the same object for the life of the reader.
  [[nodiscard]] const CaptureLink& link(std::string_view name, std::string_view device,
                                        LinkKind kind);

  CaptureHeader header_;

 private:
  std::deque<CaptureLink> links_;
};

/// All that are left, one after the other. If `use` answers an `Outcome<void>`, that may end it.
/// Problems: those of `use`, and of the file, after what could be read of it.
template <class Use>
[[nodiscard]] Outcome<void> for_each_record(CaptureReader& reader, Use use) {
  CaptureRecord record;
  Outcome<bool> has_record = true;
  while ((has_record = reader.next(record)) && *has_record) {
    if constexpr (std::is_void_v<std::invoke_result_t<Use, const CaptureRecord&>>) {
      use(std::as_const(record));
    } else if (auto used = use(std::as_const(record)); !used) {
      return used;
    }
  }
  if (!has_record) return tl::unexpected{std::move(has_record.error())};
  return {};
}

/// Turns records into the bytes of a file. Each call appends what is a whole file with all before.
class CaptureWriter {
 public:
  CaptureWriter() = default;
  CaptureWriter(const CaptureWriter&) = delete;
  CaptureWriter& operator=(const CaptureWriter&) = delete;
  virtual ~CaptureWriter() = default;

  /// Comes first, and once more for each file that goes on where another one ended.
  virtual Outcome<void> begin(const CaptureHeader& header, std::string& out) = 0;
  /// `messages`, which ended in the bytes, go only into a text. Problems: `kUnsupported` for what
  /// the format cannot hold; nothing is appended then.
  virtual Outcome<void> add(const CaptureRecord& record, std::span<const Message> messages,
                            std::string& out) = 0;
};

[[nodiscard]] std::unique_ptr<CaptureWriter> make_capture_writer(CaptureFormat format);

}  // namespace armjig
