// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/capture/capture.hpp"
#include "harness/compare/rules.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// A message of a recording, or a record beside the messages: an event, a CAN frame, a transaction
/// that nobody answered, bytes of a device that nobody knows.
struct RecordedMessage {
  Message message;
  std::string note;  ///< what bytes do not say, members of a JSON object: acknowledgements, events
  std::vector<std::byte>
      rest{};  ///< of a session: what came with it and is in no message, line ends
  /// When the parts of it came that came before its last one.
  std::vector<Instant> earlier{};
};

/// The messages of a recording, by direction and connection, address or identifier.
class RecordedMessages {
 public:
  /// More than that are refused, so that memory has a bound.
  static constexpr std::size_t kMost = 2'000'000;
  using Lanes = std::map<std::string, std::vector<RecordedMessage>>;

  /// `find_dissector` answers nullptr for a device that nobody knows.
  explicit RecordedMessages(std::function<MakeDissector(std::string_view device)> find_dissector)
      : find_dissector_{std::move(find_dissector)} {}

  /// Problems: `kUnsupported` if there are too many.
  [[nodiscard]] Outcome<void> add(const CaptureRecord& record);
  /// After the last record.
  void finish();

  [[nodiscard]] const Lanes& lanes() const noexcept { return lanes_; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

 private:
  /// What was said in one direction and has ended no message yet.
  struct Pending {
    std::vector<std::byte> bytes;
    std::vector<Instant> times;
  };
  struct Talk {
    std::unique_ptr<Dissector> dissector;
    std::string name;
    std::map<Direction, Pending> pending;
  };
  void keep(const std::string& lane, RecordedMessage message);
  void keep_all(Talk& talk, std::vector<Message>& messages, const std::string& note,
                const std::vector<std::byte>& rest = {});

  std::function<MakeDissector(std::string_view)> find_dissector_;
  std::map<std::pair<const CaptureLink*, std::uint32_t>, Talk> talks_;
  Lanes lanes_;
  std::size_t count_ = 0;
};

enum class Change : std::uint8_t { kChanged, kMissing, kExtra, kMoved };

[[nodiscard]] std::string_view to_string(Change change) noexcept;

/// One difference. The messages belong to the recordings.
struct RecordingDifference {
  Change change{};
  std::string lane;
  const RecordedMessage* before{};  ///< nullptr: it is extra
  const RecordedMessage* after{};   ///< nullptr: it is missing
  std::vector<std::string> what{};  ///< fields, time or bytes, `NAME: BEFORE, AFTER`

  [[nodiscard]] Instant time() const noexcept {
    return (before != nullptr ? before : after)->message.time;
  }
};

/// Aligns two recordings and answers what differs under the rules, in order of time. Within a lane
/// messages are matched by content and time, what is left by content, then by kind. Time grows with
/// the number of messages, times 1024 at most where nothing matches. `aligning` are the rules for
/// matching alone: fields that they ignore differ, but are no sign of which message is which.
[[nodiscard]] std::vector<RecordingDifference> diff(const RecordedMessages& before,
                                                    const RecordedMessages& after,
                                                    const ComparisonRules& rules,
                                                    const ComparisonRules& aligning);
[[nodiscard]] std::vector<RecordingDifference> diff(const RecordedMessages& before,
                                                    const RecordedMessages& after,
                                                    const ComparisonRules& rules);

}  // namespace armjig
