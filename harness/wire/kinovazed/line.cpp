// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/kinovazed/line.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>

namespace armjig::kinovazed {
namespace {

constexpr std::string_view kLineEnd = "\r\n";

/// isspace of the C locale.
constexpr bool is_blank(char c) noexcept { return c == ' ' || (c >= '\t' && c <= '\r'); }
constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
constexpr bool is_printable(char c) noexcept { return c >= ' ' && c <= '~'; }

constexpr std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Cuts off what stands before the next colon; the colon goes with it.
std::string_view next_piece(std::string_view& rest) noexcept {
  const auto* const colon =
      rest.empty() ? nullptr : static_cast<const char*>(std::memchr(rest.data(), ':', rest.size()));
  const auto size = colon == nullptr ? rest.size() : static_cast<std::size_t>(colon - rest.data());
  const auto piece = rest.substr(0, size);
  rest.remove_prefix(std::min(size + 1, rest.size()));
  return piece;
}

/// What stands behind the name. A line that ends with a colon has one more, empty argument for the
/// document and not for the shipped server (kinovazed.line.trailing-colon).
struct Arguments {
  std::array<std::string_view, 3> values;
  std::size_t count = 0;
};

Arguments split_arguments(std::string_view rest, bool has_colon, Profile profile) noexcept {
  Arguments arguments;
  bool is_open = has_colon && (profile == Profile::kDocumented || !rest.empty());
  while (is_open) {
    const bool has_more = rest.find(':') != std::string_view::npos;
    const auto piece = next_piece(rest);
    if (arguments.count < arguments.values.size()) arguments.values[arguments.count] = piece;
    ++arguments.count;
    is_open = has_more && (profile == Profile::kDocumented || !rest.empty());
  }
  return arguments;
}

constexpr std::size_t argument_count(Verb verb) noexcept {
  switch (verb) {
    case Verb::kSetJoystickMode:
    case Verb::kRunObjective:
    case Verb::kSetActiveObjective:
      return 1;
    case Verb::kMoveJoystick:
      return 3;
    default:
      return 0;
  }
}

/// As strtol would: blanks, one sign, digits, and then whatever may follow.
tl::expected<std::int32_t, LineFault> read_number(std::string_view text, Profile profile) noexcept {
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end && is_blank(*at)) ++at;
  const bool is_negative = at != end && *at == '-';
  if (at != end && (*at == '-' || *at == '+')) ++at;
  if (at == end || !is_digit(*at)) return tl::unexpected{LineFault::kNotANumber};
  constexpr std::int64_t kMagnitude = INT64_C(1) << 31;
  std::int64_t value = 0;
  for (; at != end && is_digit(*at); ++at) {
    value = std::min(value * 10 + (*at - '0'), kMagnitude + 1);
  }
  if (at != end && profile == Profile::kDocumented) return tl::unexpected{LineFault::kNotANumber};
  if (value > kMagnitude - (is_negative ? 0 : 1)) return tl::unexpected{LineFault::kNumberTooLarge};
  return static_cast<std::int32_t>(is_negative ? -value : value);
}

std::optional<LineFault> read_deflection(const Arguments& arguments, Profile profile,
                                         Deflection& deflection) noexcept {
  const std::array<std::int32_t*, 3> axes{&deflection.x, &deflection.y, &deflection.z};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto number = read_number(arguments.values[i], profile);
    if (!number) return number.error();
    *axes[i] = *number;
  }
  return std::nullopt;
}

std::optional<LineFault> read_arguments(const Arguments& arguments, Profile profile,
                                        Command& command) noexcept {
  switch (command.verb) {
    case Verb::kMoveJoystick:
      return read_deflection(arguments, profile, command.deflection);
    case Verb::kSetJoystickMode: {
      const auto mode = find_word<Mode>(kModeNames, arguments.values[0]);
      if (!mode) return LineFault::kNotAMode;
      command.mode = *mode;
      return std::nullopt;
    }
    case Verb::kRunObjective:
    case Verb::kSetActiveObjective: {
      const auto objective = find_word<Objective>(kObjectiveNames, arguments.values[0]);
      if (!objective) return LineFault::kNotAnObjective;
      command.objective = *objective;
      return std::nullopt;
    }
    default:
      return std::nullopt;
  }
}

/// What the document forbids in any line.
std::optional<LineFault> strict_fault(std::string_view line) noexcept {
  if (!std::ranges::all_of(line, is_printable)) return LineFault::kNotAscii;
  if (line.find(' ') != std::string_view::npos) return LineFault::kBlank;
  return std::nullopt;
}

void append_number(EncodedLine& line, std::int32_t value) noexcept {
  std::array<char, 11> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  line.append({digits.data(), static_cast<std::size_t>(end - digits.data())});
}

EncodedLine encode_word(std::string_view word) noexcept {
  EncodedLine line;
  line.append(word);
  line.append(kLineEnd);
  return line;
}

tl::expected<ServerMessage, LineFault> read_heartbeat(std::string_view number) noexcept {
  std::uint8_t flags{};
  const auto* const end = number.data() + number.size();
  const auto [stop, error] = std::from_chars(number.data(), end, flags);
  if (error == std::errc::result_out_of_range) return tl::unexpected{LineFault::kNumberTooLarge};
  const bool is_padded = number.size() > 1 && number.front() == '0';
  if (error != std::errc{} || stop != end || is_padded) {
    return tl::unexpected{LineFault::kNotANumber};
  }
  return Heartbeat{flags};
}

}  // namespace

std::string_view describe(LineFault fault) noexcept {
  constexpr std::array<std::string_view, kLineFaultCount> kTexts{
      "an empty line",
      "a word that nobody knows",
      "too few or too many arguments",
      "not a joystick mode",
      "not an objective",
      "not a number",
      "a number that is too large",
      "a blank where none belongs",
      "a byte that is not printable ASCII",
      "no CR before the LF",
      "a line that is too long"};
  return kTexts[static_cast<std::size_t>(fault)];
}

EncodedLine encode(const Command& command) noexcept {
  EncodedLine line;
  line.append(to_string(command.verb));
  switch (command.verb) {
    case Verb::kSetJoystickMode:
      line.append(":");
      line.append(to_string(command.mode));
      break;
    case Verb::kRunObjective:
    case Verb::kSetActiveObjective:
      line.append(":");
      line.append(to_string(command.objective));
      break;
    case Verb::kMoveJoystick:
      for (const auto value : {command.deflection.x, command.deflection.y, command.deflection.z}) {
        line.append(":");
        append_number(line, value);
      }
      break;
    default:
      break;
  }
  line.append(kLineEnd);
  return line;
}

EncodedLine encode(Event event) noexcept { return encode_word(to_string(event)); }

EncodedLine encode(Heartbeat heartbeat) noexcept {
  EncodedLine line;
  line.append(kHeartbeatName);
  line.append(":");
  append_number(line, heartbeat.flags);
  line.append(kLineEnd);
  return line;
}

EncodedLine encode(const ServerMessage& message) noexcept {
  return std::visit([](const auto& what) { return encode(what); }, message);
}

tl::expected<Command, LineFault> decode_command(std::string_view line, Profile profile) noexcept {
  if (profile == Profile::kFirmware) {
    line = trimmed(line);
  } else {
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (const auto fault = strict_fault(line)) return tl::unexpected{*fault};
  }
  if (line.empty()) return tl::unexpected{LineFault::kEmpty};
  auto rest = line;
  const auto piece = next_piece(rest);
  const bool has_colon = piece.size() < line.size();
  const auto name = profile == Profile::kFirmware ? trimmed(piece) : piece;
  const auto verb = find_word<Verb>(kVerbNames, name);
  if (!verb) return tl::unexpected{LineFault::kUnknownWord};
  const auto arguments = split_arguments(rest, has_colon, profile);
  if (arguments.count != argument_count(*verb)) return tl::unexpected{LineFault::kArgumentCount};
  Command command{.verb = *verb};
  if (const auto fault = read_arguments(arguments, profile, command)) return tl::unexpected{*fault};
  return command;
}

tl::expected<ServerMessage, LineFault> decode_message(std::string_view line) noexcept {
  if (!line.ends_with('\r')) {
    return tl::unexpected{line.empty() ? LineFault::kEmpty : LineFault::kNoCarriageReturn};
  }
  line.remove_suffix(1);
  if (line.empty()) return tl::unexpected{LineFault::kEmpty};
  auto rest = line;
  const auto name = next_piece(rest);
  if (name == kHeartbeatName) {
    if (name.size() == line.size()) return tl::unexpected{LineFault::kArgumentCount};
    return read_heartbeat(rest);
  }
  const auto event = find_word<Event>(kEventNames, name);
  if (!event) return tl::unexpected{LineFault::kUnknownWord};
  if (name.size() != line.size()) return tl::unexpected{LineFault::kArgumentCount};
  return *event;
}

}  // namespace armjig::kinovazed
