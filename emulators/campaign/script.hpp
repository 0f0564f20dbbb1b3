// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/replay/kept_record.hpp"
#include "harness/core/error.hpp"
#include "harness/wire/dissector.hpp"

/// Cases drawn at random, played to a device and to a model of it, and what they show.
namespace armjig::campaign {

/// What is done to a device and when, since the case began: bytes, connections, transactions and
/// inputs, in order of time. Nothing of what the device does.
using Script = std::vector<KeptRecord>;

/// What was done in a recording, its first deed at 0. CAN frames are left out, for no link carries
/// them.
[[nodiscard]] Script script_of(const std::vector<KeptRecord>& recording);
/// The same of any text that `CaptureReader` takes; `where` is for messages. Problems: those of the
/// reader.
[[nodiscard]] Outcome<Script> read_script(std::string_view recording, const std::string& where);

/// When its last record is; 0 for none.
[[nodiscard]] Duration length_of(const Script& script) noexcept;

/// Between two things that are done one after the other.
inline constexpr Duration kStep = std::chrono::milliseconds{3};

/// At the end of a script that is written record by record; the first is at its beginning.
void add(Script& script, KeptRecord record, Duration pause = kStep);
void add(Script& script, const Script& more);

/// The same, all of it to the device there.
[[nodiscard]] Script to(std::uint32_t address, Script script);

/// `more` after `script`, `pause` later.
[[nodiscard]] Script joined(Script script, const Script& more, Duration pause);

/// How a connection begins or ends: `dir` and `how` as recordings have them.
[[nodiscard]] KeptRecord border(std::string_view dir, std::uint32_t connection,
                                std::string_view how);

/// Whether it ends a connection, or the half of it.
[[nodiscard]] bool is_end(const KeptRecord& record);

/// If it is a client that closes its connection: now that client says nothing more, and hears on.
void leave_half_open(KeptRecord& record);

/// The script with an end to each connection that it leaves open.
[[nodiscard]] Script with_ends(Script script);

/// How far apart things are done at least where nobody can tell what a device makes of two that are
/// closer together.
struct Spacing {
  Duration least{};        ///< between any two
  Duration around_ends{};  ///< before a connection ends, and after it
  /// After a message, as long as the device works on it if what comes meanwhile is another thing
  /// than what comes later; nullptr: no longer.
  Duration (*works_on)(Bytes message){};
};

/// The script with that much time between its records, or as much as it has, if that is more.
[[nodiscard]] Script spaced(Script script, const Spacing& spacing);

/// From `place` on everything is later, or earlier as far as nothing overtakes.
void shift_from(Script& script, std::size_t place, Duration by);

/// Bytes that go to the device, as opposed to what is read or done beside the link.
[[nodiscard]] bool is_sent(const KeptRecord& record) noexcept;

/// A record that sets an input of the device or does something else beside its link; not one that
/// begins or ends a connection.
[[nodiscard]] bool is_by_hand(const KeptRecord& record);

/// What the record sends, as the device's dissector names it; of a bus with the byte of the
/// address. Of no bytes: nothing.
[[nodiscard]] std::vector<Message> messages_in(const KeptRecord& record, Dissector& dissector);

/// The code that says most of a message, as that of a command; nullptr: it has none.
[[nodiscard]] const Field* code_in(const Message& message);
/// What that code is called; nullptr: it has none, or nobody has named it.
[[nodiscard]] const NamedValue* name_of_code(const Message& message);

/// The record in a few words, as in `command jog`.
[[nodiscard]] std::string words_of(const KeptRecord& record, MakeDissector make_dissector);

/// The script and what was said to it as a recording that `armjig replay` takes. `device` is its
/// name, `target` where it was, `source` who asks.
struct RecordingFacts {
  std::string device;
  std::string target;
  std::string source;
};
[[nodiscard]] std::string to_recording(const RecordingFacts& facts, const Script& script,
                                       const std::vector<KeptRecord>& answers);

}  // namespace armjig::campaign
