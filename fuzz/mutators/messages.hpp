// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "emulators/sessions/dice.hpp"
#include "emulators/sessions/odd_fields.hpp"
#include "harness/core/bytes.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig::fuzz {

/// Changes a few bytes somehow, within `most`; the new size. The engine's own mutator.
using MutateBytes =
    std::function<std::size_t(std::uint8_t* data, std::size_t size, std::size_t most)>;

/// What an input is: so many bytes of choices, then what the dissector of a device reads.
struct InputForm {
  MakeDissector make_dissector{};
  std::size_t choices{};
};

/// Mutates messages and not bytes: puts odd numbers into fields, which leaves lengths and checks
/// right or, if it is one of theirs, breaks just that; drops, doubles and moves whole messages; or
/// leaves the inside of one to the engine. The same for the same seed and engine.
class MessageMutator {
 public:
  MessageMutator(const InputForm& form, MutateBytes mutate_bytes)
      : form_{form}, mutate_bytes_{std::move(mutate_bytes)} {}

  /// Changes the input in `data`, of which `most` bytes are there; the new size.
  [[nodiscard]] std::size_t mutate(std::uint8_t* data, std::size_t size, std::size_t most,
                                   std::uint64_t seed) const {
    sessions::Dice dice{seed};
    auto messages = messages_in({data, size});
    if (messages.empty() || dice.one_in(4)) return mutate_bytes_(data, size, most);
    for (auto changes = dice.between(1, 3); changes > 0 && !messages.empty(); --changes) {
      change(dice, messages);
    }
    return write(messages, {data, most});
  }

 private:
  using Messages = std::vector<Message>;

  [[nodiscard]] Messages messages_in(std::span<const std::uint8_t> input) const {
    Messages messages;
    if (input.size() <= form_.choices) return messages;
    const auto dissector = form_.make_dissector();
    dissector->feed(Direction::kToDevice, {}, std::as_bytes(input.subspan(form_.choices)),
                    messages);
    dissector->finish(messages);
    return messages;
  }

  void change(sessions::Dice& dice, Messages& messages) const {
    const auto at = messages.begin() + dice.between(0, std::ssize(messages) - 1);
    const auto other = messages.begin() + dice.between(0, std::ssize(messages) - 1);
    switch (dice.between(0, 7)) {
      case 0:
        messages.erase(at);
        return;
      case 1: {
        const auto copy = *at;
        messages.insert(other, copy);
        return;
      }
      case 2:
        std::iter_swap(at, other);
        return;
      case 3:
        return change_inside(*at);
      default:
        return change_field(dice, *at);
    }
  }

  void change_inside(Message& message) const {
    constexpr std::size_t kRoom = 16;
    const auto size = message.raw.size();
    message.raw.resize(size + kRoom);
    auto* const bytes = reinterpret_cast<std::uint8_t*>(message.raw.data());
    message.raw.resize(mutate_bytes_(bytes, size, message.raw.size()));
  }

  static void change_field(sessions::Dice& dice, Message& message) {
    if (message.fields.empty()) return;
    const bool is_line = message.fields.back().place != Place::kBytes;
    if (!is_line) return sessions::spoil_a_field(dice, message.fields, message.raw);
    change_piece(dice, message.raw);
  }

  /// One of the pieces of a line that colons part becomes an odd number.
  static void change_piece(sessions::Dice& dice, std::vector<std::byte>& line) {
    std::string text{as_text(line)};
    const auto end = std::min(text.find_first_of("\r\n"), text.size());
    const auto colons =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), ':');
    std::size_t begin = 0;
    for (auto piece = dice.between(0, colons); piece > 0; --piece)
      begin = text.find(':', begin) + 1;
    const auto length = std::min(text.find(':', begin), end) - begin;
    text.replace(begin, length, std::to_string(sessions::odd_number(dice)));
    const auto bytes = std::as_bytes(std::span{text});
    line.assign(bytes.begin(), bytes.end());
  }

  /// The choices stay as they are.
  [[nodiscard]] std::size_t write(const Messages& messages, std::span<std::uint8_t> out) const {
    auto size = form_.choices;
    for (const auto& message : messages) {
      const auto room = std::min(message.raw.size(), out.size() - size);
      std::copy_n(reinterpret_cast<const std::uint8_t*>(message.raw.data()), room, &out[0] + size);
      size += room;
    }
    return size;
  }

  InputForm form_;
  MutateBytes mutate_bytes_;
};

}  // namespace armjig::fuzz
