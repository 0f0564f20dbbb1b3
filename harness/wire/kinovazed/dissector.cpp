// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/kinovazed/dissector.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/wire/kinovazed/fields.hpp"
#include "harness/wire/kinovazed/line.hpp"
#include "harness/wire/kinovazed/line_splitter.hpp"

namespace armjig::kinovazed {
namespace {

/// What a line is: its name and fields, or what is wrong with it.
struct Reading {
  std::string_view name = "line";
  std::span<const Field> fields;
  std::string fault;
};

Reading faulty(LineFault fault) { return {.fault = std::string{describe(fault)}}; }

Reading read_command(std::string_view line) {
  const auto command = decode_command(line, Profile::kFirmware);
  if (!command) return faulty(command.error());
  return {to_string(command->verb), command_fields(command->verb), {}};
}

Reading read_message(std::string_view line) {
  const auto message = decode_message(line);
  if (!message) return faulty(message.error());
  if (const auto* event = std::get_if<Event>(&*message)) {
    return {to_string(*event), event_fields(), {}};
  }
  return {kHeartbeatName, heartbeat_fields(), {}};
}

class LineDissector final : public Dissector {
 public:
  void feed(Direction direction, Instant time, Bytes bytes, std::vector<Message>& out) override {
    auto& lane = lane_of(direction);
    lane.time = time;
    while (!bytes.empty()) {
      const auto step = lane.splitter.step(bytes);
      bytes = bytes.subspan(step.used);
      if (step.found == LineSplitter::Found::kNothing) continue;
      out.push_back(
          message(direction, time, step, std::exchange(lane.is_inside_long_line, is_piece(step))));
    }
  }

  void finish(std::vector<Message>& out) override {
    for (const auto direction : {Direction::kToDevice, Direction::kFromDevice}) {
      const auto& lane = lane_of(direction);
      if (lane.splitter.held().empty()) continue;
      out.push_back(
          {direction, lane.time, "rest", raw(lane.splitter.held()), {}, "a line without an end"});
    }
  }

 private:
  struct Lane {
    LineSplitter splitter;
    bool is_inside_long_line = false;
    Instant time{};
  };

  static bool is_piece(const LineSplitter::Step& step) {
    return step.found == LineSplitter::Found::kPieceOfLine;
  }

  static std::vector<std::byte> raw(std::string_view text) {
    const auto bytes = std::as_bytes(std::span{text});
    return {bytes.begin(), bytes.end()};
  }

  static Message message(Direction direction, Instant time, const LineSplitter::Step& step,
                         bool goes_on) {
    const bool is_long = goes_on || is_piece(step);
    const auto reading = is_long                             ? faulty(LineFault::kTooLong)
                         : direction == Direction::kToDevice ? read_command(step.line)
                                                             : read_message(step.line);
    auto bytes = raw(step.line);
    if (!is_piece(step)) bytes.push_back(std::byte{'\n'});
    return {direction, time, reading.name, std::move(bytes), reading.fields, reading.fault};
  }

  Lane& lane_of(Direction direction) {
    return direction == Direction::kToDevice ? to_device_ : from_device_;
  }

  Lane to_device_;
  Lane from_device_;
};

}  // namespace

std::unique_ptr<Dissector> make_dissector() { return std::make_unique<LineDissector>(); }

Dissection dissection() {
  using enum LineFault;
  std::vector<MessageKind> kinds;
  for (std::size_t i = 0; i < kVerbNames.size(); ++i) {
    const auto verb = static_cast<Verb>(i);
    kinds.push_back({.name = to_string(verb),
                     .direction = Direction::kToDevice,
                     .fields = command_fields(verb),
                     .bad_word = describe(names_objective(verb) ? kNotAnObjective : kNotAMode)});
  }
  for (const auto name : kEventNames) {
    kinds.push_back({.name = name, .direction = Direction::kFromDevice, .fields = event_fields()});
  }
  kinds.push_back(
      {.name = kHeartbeatName, .direction = Direction::kFromDevice, .fields = heartbeat_fields()});
  return {.messages = std::move(kinds),
          .framing = Framing::kLines,
          .lines = {LineSplitter::kLongest, describe(kEmpty), describe(kUnknownWord),
                    describe(kArgumentCount), describe(kNotANumber), describe(kNumberTooLarge),
                    describe(kNoCarriageReturn), describe(kTooLong)}};
}

}  // namespace armjig::kinovazed
