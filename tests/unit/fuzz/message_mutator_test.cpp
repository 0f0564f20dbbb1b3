// SPDX-License-Identifier: Apache-2.0
// The mutator of messages changes inputs, keeps them within bounds, mostly leaves frames whole, and
// now and then breaks a length or a check.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "fuzz/mutators/forms.hpp"
#include "harness/wire/kinovazed/line.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::fuzz::mutating {
namespace {

using RawInput = std::vector<std::uint8_t>;

constexpr std::size_t kMost = 1024;

RawInput input_of(Bytes stream) {
  RawInput input{0};
  for (const auto byte : stream) input.push_back(std::to_integer<std::uint8_t>(byte));
  return input;
}

RawInput some_frames() {
  std::vector<std::byte> stream;
  for (const auto code : {parol6::Command::kIdle, parol6::Command::kJog, parol6::Command::kGoTo}) {
    const auto frame = encode(parol6::CommandFrame{.command = code});
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  return input_of(stream);
}

RawInput some_lines() {
  constexpr std::string_view kLines = "EStop\r\nMoveJoystick:1:2:3\r\n";
  return input_of(std::as_bytes(std::span{kLines}));
}

/// Leaves it as it is.
std::size_t nothing(std::uint8_t* /*data*/, std::size_t size, std::size_t /*most*/) { return size; }

RawInput mutated(const InputForm& form, RawInput input, std::uint64_t seed) {
  const auto size = input.size();
  input.resize(kMost);
  input.resize(MessageMutator{form, nothing}.mutate(input.data(), size, kMost, seed));
  return input;
}

std::vector<Message> messages_of(const InputForm& form, const RawInput& input) {
  std::vector<Message> messages;
  const auto dissector = form.make_dissector();
  dissector->feed(Direction::kToDevice, {}, std::as_bytes(std::span{input}.subspan(1)), messages);
  dissector->finish(messages);
  return messages;
}

struct Tally {
  int changed{};
  int whole{};
  int broken{};
};

Tally tally_of(const InputForm& form, const RawInput& input) {
  Tally tally;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto one = mutated(form, input, seed);
    if (one != input) ++tally.changed;
    const auto messages = messages_of(form, one);
    const bool is_broken = std::ranges::any_of(
        messages, [](const Message& message) { return !message.fault.empty(); });
    ++(is_broken ? tally.broken : tally.whole);
  }
  return tally;
}

TEST(MessageMutator, GivesTheSameForTheSameSeed) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(mutated(forms::parol6_splitter, some_frames(), seed),
              mutated(forms::parol6_splitter, some_frames(), seed));
  }
}

TEST(MessageMutator, MostlyLeavesFramesWholeAndSometimesBreaksOne) {
  const auto tally = tally_of(forms::parol6_splitter, some_frames());
  EXPECT_GT(tally.changed, 100);
  EXPECT_GT(tally.whole, 100);
  EXPECT_GT(tally.broken, 5);
}

TEST(MessageMutator, PutsOddNumbersIntoLines) {
  int with_odd_argument = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    for (const auto& message : messages_of(forms::kinovazed_server,
                                           mutated(forms::kinovazed_server, some_lines(), seed))) {
      const auto text = as_text(message.raw);
      if (message.fault.empty() && text.starts_with("MoveJoystick") &&
          text != "MoveJoystick:1:2:3\r\n") {
        ++with_odd_argument;
      }
    }
  }
  EXPECT_GT(with_odd_argument, 20);
}

TEST(MessageMutator, KeepsWithinTheRoomThatThereIs) {
  auto input = some_frames();
  const auto size = input.size();
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    auto copy = input;
    EXPECT_LE(MessageMutator(forms::parol6_splitter, nothing).mutate(copy.data(), size, size, seed),
              size);
  }
}

}  // namespace
}  // namespace armjig::fuzz::mutating
