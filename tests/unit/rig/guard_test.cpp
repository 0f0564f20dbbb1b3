// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/guarded_ports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <ranges>

#include "emulators/parol6/arm.hpp"
#include "harness/link/memory_stream.hpp"
#include "harness/rig/parol6_judge.hpp"
#include "harness/wire/parol6/splitter.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using parol6::Command;
using parol6::CommandFrame;
using parol6::TelemetryFrame;
using ::testing::HasSubstr;

// Permissions.

TEST(Permissions, AreReadFromWords) {
  const auto permissions = parse_permissions("home,state").value();
  EXPECT_TRUE(permissions.allow(Hazard::kHome));
  EXPECT_TRUE(permissions.allow(Hazard::kState));
  EXPECT_FALSE(permissions.allow(Hazard::kMove));
  EXPECT_FALSE(permissions.allow(Hazard::kGrip));
}

TEST(Permissions, ObservingIsAlwaysAllowed) {
  EXPECT_TRUE(Permissions{}.allow(Hazard::kObserve));
  EXPECT_TRUE(parse_permissions("")->allow(Hazard::kObserve));
  EXPECT_FALSE(parse_permissions("")->allow_motion());
}

TEST(Permissions, AllIsEverything) {
  const auto permissions = parse_permissions("all").value();
  for (std::size_t i = 0; i < kHazardCount; ++i) {
    EXPECT_TRUE(permissions.allow(static_cast<Hazard>(i)));
  }
}

TEST(Permissions, WhatIsNoPermissionIsNamed) {
  for (const auto* text : {"mov", "MOVE", "move;home", "move,,home", " move", "all,move"}) {
    const auto permissions = parse_permissions(text);
    ASSERT_FALSE(permissions) << text;
    EXPECT_EQ(permissions.error().code, ErrorCode::kBadValue);
    EXPECT_THAT(describe(permissions.error()),
                HasSubstr("state, move, home, grip, program, crash"));
  }
}

TEST(Permissions, WithoutMotionTheRestStays) {
  auto permissions = Permissions::all();
  permissions.withdraw_motion();
  EXPECT_FALSE(permissions.allow_motion());
  EXPECT_TRUE(permissions.allow(Hazard::kState));
  EXPECT_TRUE(permissions.allow(Hazard::kGrip));
}

// The stream, on a port that does as it is told.

/// What the port is made to do and what it saw; outlives the port.
struct Line {
  test::ByteVector written;
  std::deque<test::ByteVector> arriving;  ///< a read each
  std::optional<Error> write_error;
  std::optional<Error> read_error;
  Duration longest_wait{};
  Instant now{};
};

class ScriptedPort final : public StreamPort {
 public:
  explicit ScriptedPort(Line& line) : line_{line} {}

  Result<void> write(Bytes bytes) override {
    if (line_.write_error) return tl::unexpected{*line_.write_error};
    line_.written.insert(line_.written.end(), bytes.begin(), bytes.end());
    return {};
  }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    if (line_.arriving.empty()) {
      if (line_.read_error) return tl::unexpected{*line_.read_error};
      line_.longest_wait = std::max(line_.longest_wait, deadline - line_.now);
      line_.now = std::max(line_.now, deadline);
      return 0;
    }
    const auto bytes = std::exchange(line_.arriving.front(), {});
    line_.arriving.pop_front();
    std::ranges::copy(bytes, into.begin());
    return bytes.size();
  }
  [[nodiscard]] Instant now() const override { return line_.now; }

 private:
  Line& line_;
};

std::unique_ptr<GuardedStream> guard(std::unique_ptr<StreamPort> port, Permissions permissions) {
  auto guarded = GuardedStream::guard(std::move(port), parol6::rig::make_judge(), permissions);
  return std::move(guarded.value());
}

std::unique_ptr<GuardedStream> guard(Line& line, Permissions permissions) {
  return guard(std::make_unique<ScriptedPort>(line), permissions);
}

test::ByteVector frame(Command command) {
  return test::as_vector(encode(CommandFrame{.command = command}));
}
test::ByteVector telemetry(Command echo, std::uint8_t io = parol6::io_flag::kEstopReleased) {
  return test::as_vector(encode(TelemetryFrame{.homed = 0xFF, .io = io, .echo = echo}));
}
test::ByteVector estop_pressed(Command echo) { return telemetry(echo, 0); }

/// The commands that a receiver with the shipped board's eyes found on the line.
std::vector<Command> commands(const test::ByteVector& written) {
  std::vector<Command> found;
  parol6::Splitter splitter{parol6::kCommandPayloadSize};
  for (Bytes rest = written; !rest.empty();) {
    const auto step = splitter.step(rest);
    rest = rest.subspan(step.used);
    if (const auto* bytes = std::get_if<parol6::Splitter::Frame>(&step.found)) {
      const auto body = parol6::body_of(bytes->bytes.first<parol6::kCommandFrameSize>());
      found.push_back(parol6::decode_command(body).command);
    }
  }
  return found;
}

test::ByteVector read_all(GuardedStream& stream) {
  std::array<std::byte, 7> buffer;
  test::ByteVector all;
  while (const auto size = stream.read(buffer, stream.now()).value_or(0)) {
    all.insert(all.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size));
  }
  return all;
}

TEST(GuardedStream, BeginsWithTheOpeningBytes) {
  Line line;
  const auto stream = guard(line, {});
  EXPECT_TRUE(test::same_bytes(line.written, parol6::rig::make_judge()->opening_bytes()));
}

TEST(GuardedStream, APortThatTakesNothingCannotBeGuarded) {
  Line line;
  line.write_error = Error{ErrorCode::kTimedOut};
  const auto guarded =
      GuardedStream::guard(std::make_unique<ScriptedPort>(line), parol6::rig::make_judge(), {});
  ASSERT_FALSE(guarded);
  EXPECT_EQ(guarded.error().code, ErrorCode::kTimedOut);
}

TEST(GuardedStream, WhatIsAllowedPassesUnchanged) {
  Line line;
  const auto stream = guard(line, {});
  line.written.clear();
  ASSERT_TRUE(stream->write(frame(Command::kIdle)));
  EXPECT_TRUE(test::same_bytes(line.written, frame(Command::kIdle)));
  EXPECT_FALSE(stream->last_refusal());
}

TEST(GuardedStream, OfWhatIsRefusedNothingPasses) {
  Line line;
  const auto stream = guard(line, {});
  line.written.clear();
  const auto written = stream->write(test::joined(frame(Command::kIdle), frame(Command::kJog)));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kForbidden);
  EXPECT_TRUE(line.written.empty());
  EXPECT_EQ(stream->last_refusal()->reason, "jog needs --allow move");
  EXPECT_EQ(stream->last_refusal()->cause, Refusal::Cause::kRequest);
}

TEST(GuardedStream, WhatArrivesPassesUnchangedAlsoThroughWrites) {
  Line line;
  const auto stream = guard(line, {});
  line.arriving = {test::hex("01 02 03"), test::hex("04"), test::hex("05 06 07 08 09 0A 0B 0C")};
  ASSERT_TRUE(stream->write(frame(Command::kIdle)));
  ASSERT_TRUE(stream->write(frame(Command::kIdle)));
  EXPECT_TRUE(
      test::same_bytes(read_all(*stream), test::hex("01 02 03 04 05 06 07 08 09 0A 0B 0C")));
}

TEST(GuardedStream, ReadingWaitsUntilTheDeadlineIfNothingCame) {
  Line line;
  const auto stream = guard(line, {});
  std::array<std::byte, 4> buffer;
  EXPECT_EQ(stream->read(buffer, at(30ms)).value(), 0U);
  EXPECT_EQ(stream->now(), at(30ms));
}

/// Its supervisor stops an arm after half a second without a sign of life.
TEST(GuardedStream, ReadingGivesSignsOfLifeUntilTheDeadline) {
  Line line;
  const auto stream = guard(line, {});
  std::array<std::byte, 4> buffer;
  EXPECT_EQ(stream->read(buffer, at(10s)).value(), 0U);
  EXPECT_EQ(stream->now(), at(10s));
  EXPECT_LT(line.longest_wait, 500ms);
}

TEST(GuardedStream, TheEmergencyStopStopsTheArmAlsoIfNobodyReads) {
  Line line;
  const auto stream = guard(line, Permissions::all());
  ASSERT_TRUE(stream->write(frame(Command::kJog)));
  line.written.clear();
  line.arriving = {estop_pressed(Command::kJog), estop_pressed(Command::kDisable)};
  EXPECT_FALSE(stream->write(frame(Command::kJog)));
  EXPECT_EQ(commands(line.written), std::vector{Command::kDisable});
  EXPECT_EQ(stream->last_refusal()->reason, "the emergency stop is pressed");
}

TEST(GuardedStream, StopsUntilTheDeviceSaysThatItHeard) {
  Line line;
  const auto stream = guard(line, Permissions::all());
  ASSERT_TRUE(stream->write(frame(Command::kJog)));
  line.written.clear();
  line.arriving = {estop_pressed(Command::kJog), estop_pressed(Command::kJog),
                   estop_pressed(Command::kJog), estop_pressed(Command::kDisable)};
  (void)read_all(*stream);
  EXPECT_EQ(commands(line.written), std::vector(3, Command::kDisable));
  EXPECT_EQ(stream->last_refusal()->reason, "the emergency stop was pressed");
  EXPECT_EQ(stream->last_refusal()->cause, Refusal::Cause::kDevice);
}

TEST(GuardedStream, AStopInTheMiddleOfAMessageIsHeard) {
  Line line;
  const auto stream = guard(line, Permissions::all());
  ASSERT_TRUE(stream->write(frame(Command::kJog)));
  ASSERT_TRUE(stream->write(Bytes{frame(Command::kJog)}.first(30)));
  const auto before = line.written.size();
  line.arriving = {estop_pressed(Command::kJog)};
  (void)read_all(*stream);
  const test::ByteVector stops{line.written.begin() + static_cast<std::ptrdiff_t>(before),
                               line.written.end()};
  // The shipped board takes what follows for the rest of the frame that was begun.
  parol6::emulation::FirmwareReceiver board;
  EXPECT_FALSE(board.step(Bytes{frame(Command::kJog)}.first(30)).accepted);
  const auto step = board.step(stops);
  EXPECT_TRUE(step.accepted);
  EXPECT_EQ(parol6::decode_command(board.body()).command, Command::kDisable);
}

TEST(GuardedStream, AWriteThatIsRefusedWhileTheArmMovesStopsIt) {
  Line line;
  const auto stream = guard(line, Permissions::all());
  ASSERT_TRUE(stream->write(frame(Command::kJog)));
  line.written.clear();
  line.arriving = {telemetry(Command::kJog)};
  ASSERT_FALSE(stream->write(parol6::encode(
      parol6::CommandFrame{.position = {Steps{100'000}}, .command = Command::kGoTo})));
  EXPECT_THAT(commands(line.written), testing::Contains(Command::kDisable));
  EXPECT_THAT(stream->last_refusal()->reason, HasSubstr("j1 may go from"));
}

TEST(GuardedStream, TheDestructorStopsAnArmThatMayBeMoving) {
  Line line;
  auto stream = guard(line, Permissions::all());
  ASSERT_TRUE(stream->write(frame(Command::kJog)));
  line.written.clear();
  stream.reset();
  EXPECT_EQ(commands(line.written), std::vector(8, Command::kDisable)) << "nobody answers";
}

TEST(GuardedStream, TheDestructorStopsAnArmWhoseStopNobodyHeard) {
  Line line;
  auto stream = guard(line, Permissions::all());
  ASSERT_TRUE(stream->write(frame(Command::kJog)));
  ASSERT_TRUE(stream->write(frame(Command::kIdle)));
  line.written.clear();
  stream.reset();
  EXPECT_THAT(commands(line.written), testing::Contains(Command::kDisable));
}

TEST(GuardedStream, TheDestructorLeavesAnArmThatStandsAlone) {
  Line line;
  auto stream = guard(line, Permissions::all());
  ASSERT_TRUE(stream->write(frame(Command::kJog)));
  ASSERT_TRUE(stream->write(frame(Command::kIdle)));
  line.arriving = {telemetry(Command::kIdle)};
  (void)read_all(*stream);
  line.written.clear();
  stream.reset();
  EXPECT_TRUE(line.written.empty());
}

TEST(GuardedStream, AWriteThatFailsHalfWayIsFollowedByTheOpeningBytes) {
  Line line;
  const auto stream = guard(line, {});
  line.write_error = Error{ErrorCode::kTimedOut};
  ASSERT_FALSE(stream->write(frame(Command::kIdle)));
  line.write_error.reset();
  line.written.clear();
  ASSERT_TRUE(stream->write(frame(Command::kIdle)));
  const auto opening = test::as_vector(parol6::rig::make_judge()->opening_bytes());
  EXPECT_TRUE(test::same_bytes(line.written, test::joined(opening, frame(Command::kIdle))));
}

TEST(GuardedStream, AnArmThatGoesOutOfSightWhileItMovesIsStopped) {
  Line line;
  const auto stream = guard(line, Permissions::all());
  ASSERT_TRUE(stream->write(frame(Command::kJog)));
  line.written.clear();
  line.read_error = Error{ErrorCode::kDisconnected};
  std::array<std::byte, 4> buffer;
  EXPECT_EQ(stream->read(buffer, at(1s)).error().code, ErrorCode::kDisconnected);
  EXPECT_EQ(commands(line.written), std::vector{Command::kDisable});
}

// The stream, with an emulated arm behind it.

/// A port to an arm that lives longer than the port.
class Borrowed final : public StreamPort {
 public:
  explicit Borrowed(MemoryStream<parol6::emulation::Arm>& arm) : arm_{arm} {}
  Result<void> write(Bytes bytes) override { return arm_.write(bytes); }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    return arm_.read(into, deadline);
  }
  [[nodiscard]] Instant now() const override { return arm_.now(); }

 private:
  MemoryStream<parol6::emulation::Arm>& arm_;
};

std::array<std::int32_t, parol6::kJointCount> positions(
    MemoryStream<parol6::emulation::Arm>& line) {
  std::array<std::int32_t, parol6::kJointCount> all{};
  const auto joints = line.device().board().joints();
  for (std::size_t j = 0; j < all.size(); ++j) all[j] = joints[j].position().value;
  return all;
}

void let_pass(StreamPort& port, Duration duration) {
  std::array<std::byte, 256> buffer;
  const auto end = port.now() + duration;
  while (port.now() < end) (void)port.read(buffer, end);
}

CommandFrame jog_all(std::int32_t speed) {
  CommandFrame frame{.command = Command::kJog};
  frame.speed.fill(StepsPerSecond{speed});
  return frame;
}

TEST(GuardedStream, AnEmulatedArmStopsWhenItsPortGoesAway) {
  MemoryStream line{parol6::emulation::Arm{}};
  auto stream = guard(std::make_unique<Borrowed>(line), Permissions::all());
  ASSERT_TRUE(stream->write(encode(jog_all(1000))));
  let_pass(*stream, 100ms);
  const auto before = positions(line);
  let_pass(*stream, 100ms);
  ASSERT_NE(positions(line), before);
  stream.reset();
  const auto stopped = positions(line);
  let_pass(line, 1s);
  EXPECT_EQ(positions(line), stopped);
  EXPECT_FALSE(line.device().board().is_enabled());
}

TEST(GuardedStream, AnEmulatedArmInTheMiddleOfHomingStopsWhenItsPortGoesAway) {
  MemoryStream line{parol6::emulation::Arm{}};
  auto stream = guard(std::make_unique<Borrowed>(line), Permissions::all());
  ASSERT_TRUE(stream->write(frame(Command::kHome)));
  let_pass(*stream, 10ms);
  ASSERT_TRUE(stream->write(frame(Command::kIdle)));
  let_pass(*stream, 1s);
  stream.reset();
  const auto stopped = positions(line);
  let_pass(line, 1s);
  EXPECT_EQ(positions(line), stopped);
}

TEST(GuardedStream, AHomedArmThatJogsAtItsBoundIsStoppedThere) {
  MemoryStream line{parol6::emulation::Arm{}};
  const auto stream = guard(std::make_unique<Borrowed>(line), Permissions::all());
  ASSERT_TRUE(stream->write(frame(Command::kHome)));
  let_pass(*stream, 10ms);
  for (int i = 0; i < 400; ++i) {
    ASSERT_TRUE(stream->write(frame(Command::kIdle)));
    let_pass(*stream, 100ms);
  }
  CommandFrame jog{.command = Command::kJog};
  jog.speed[0] = parol6::kJoints[0].max_jog;
  const auto bound = parol6::kJointBounds[0].upper.value;
  int frames = 0;
  while (stream->write(encode(jog))) {
    let_pass(*stream, 10ms);
    ASSERT_LT(++frames, 1000);
  }
  EXPECT_THAT(stream->last_refusal()->reason, HasSubstr("j1"));
  EXPECT_EQ(stream->last_refusal()->cause, Refusal::Cause::kDevice);
  EXPECT_GE(positions(line)[0], bound);
  EXPECT_LE(positions(line)[0], bound + 16) << "10 ms at 1500 steps/s, and a pass";
}

// Whatever is written without permission to move, nothing moves.

/// A piece of traffic that a number stands for: frames of all sorts, cut ones, header runs, noise.
test::ByteVector piece(std::uint64_t number) {
  test::Dice dice{number};
  constexpr std::array kCodes{0, 69, 100, 101, 102, 103, 123, 156, 255};
  CommandFrame content;
  content.command = static_cast<Command>(kCodes.at(static_cast<std::size_t>(dice.between(0, 8))));
  for (auto& speed : content.speed) {
    speed = StepsPerSecond{static_cast<std::int32_t>(dice.between(-9000, 9000))};
  }
  for (auto& position : content.position) {
    position = Steps{static_cast<std::int32_t>(dice.between(-90'000, 90'000))};
  }
  auto bytes = test::as_vector(encode(content));
  switch (dice.between(0, 6)) {
    case 0:  // the frame as it is
      break;
    case 1:  // only its head
      bytes.resize(static_cast<std::size_t>(dice.between(1, 55)));
      break;
    case 2:  // it ends badly, so it is stored and not accepted
      bytes.back() = dice.byte();
      break;
    case 3: {  // shorter or longer than it should be
      const auto length = dice.between(0, 255);
      bytes[3] = static_cast<std::byte>(length);
      bytes.resize(static_cast<std::size_t>(4 + length));
      if (length >= 2) std::ranges::copy(parol6::kEndBytes, bytes.end() - 2);
      break;
    }
    case 4:  // behind start bytes
      bytes.insert(bytes.begin(), static_cast<std::size_t>(dice.between(1, 6)), parol6::kStartByte);
      break;
    case 5:  // a short one, that uncovers what the store holds
      bytes = test::hex("FF FF FF 02 01 02");
      break;
    default:
      std::ranges::generate(bytes, [&] { return dice.byte(); });
  }
  return bytes;
}

/// Gives the arm a history that ends with the arm standing, a jog in its store that was not
/// accepted, and its receiver in the middle of something. Homing is left out: see parol6_judge.hpp.
void give_a_past(MemoryStream<parol6::emulation::Arm>& line,
                 const std::vector<std::uint64_t>& numbers) {
  for (const auto number : numbers) {
    const auto bytes = piece(number);
    const bool may_home = std::ranges::any_of(
        bytes, [](std::byte byte) { return byte == std::byte{100} || byte == std::byte{69}; });
    if (may_home) continue;
    (void)line.write(bytes);
    let_pass(line, 5ms);
  }
  (void)line.write(test::joined(test::ByteVector(512, std::byte{0x55}), frame(Command::kIdle)));
  auto unended = test::as_vector(encode(jog_all(2000)));
  unended.back() = std::byte{0x03};
  (void)line.write(unended);
  if (!numbers.empty()) (void)line.write(Bytes{piece(numbers.front())}.first(5));
  let_pass(line, 5ms);
}

/// Writes the pieces joined, but cut somewhere else.
void write_in_pieces(StreamPort& stream, const std::vector<std::uint64_t>& numbers) {
  test::ByteVector all;
  for (const auto number : numbers) all = test::joined(std::move(all), piece(number));
  test::Dice dice{numbers.size()};
  for (Bytes rest = all; !rest.empty();) {
    const auto size = std::min(rest.size(), static_cast<std::size_t>(dice.between(1, 90)));
    (void)stream.write(rest.first(size));
    rest = rest.subspan(size);
    let_pass(stream, std::chrono::microseconds{dice.between(0, 3000)});
  }
}

TEST(GuardedStream, WhateverIsWrittenWithoutPermissionNoJointMoves) {
  test::for_all([](const std::vector<std::uint64_t>& past, const std::vector<std::uint64_t>& now) {
    MemoryStream line{parol6::emulation::Arm{}};
    give_a_past(line, past);
    const auto before = positions(line);
    auto permissions = Permissions::all();
    permissions.withdraw_motion();
    const auto stream = guard(std::make_unique<Borrowed>(line), permissions);
    write_in_pieces(*stream, now);
    let_pass(*stream, 50ms);
    RC_ASSERT(positions(line) == before);
  });
}

TEST(GuardedStream, WhateverIsWrittenWithoutPermissionABoardThatKeepsToTheDocumentFindsNoMotion) {
  test::for_all([](const std::vector<std::uint64_t>& numbers) {
    Line line;
    const auto stream = guard(line, {});
    write_in_pieces(*stream, numbers);
    for (const auto policy : {parol6::CheckPolicy::kIgnore, parol6::CheckPolicy::kBoardOnly}) {
      parol6::Splitter splitter{parol6::kCommandPayloadSize, policy};
      for (Bytes rest = line.written; !rest.empty();) {
        const auto step = splitter.step(rest);
        rest = rest.subspan(step.used);
        const auto* found = std::get_if<parol6::Splitter::Frame>(&step.found);
        if (found == nullptr) continue;
        const auto body = parol6::body_of(found->bytes.first<parol6::kCommandFrameSize>());
        const auto command = parol6::decode_command(body).command;
        RC_ASSERT(command != Command::kJog && command != Command::kGoTo);
        RC_ASSERT(command != Command::kHome && command != Command::kDemo);
      }
    }
  });
}

}  // namespace
}  // namespace armjig
