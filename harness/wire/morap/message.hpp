// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <variant>

#include "harness/core/bytes.hpp"
#include "harness/wire/field.hpp"
#include "harness/wire/morap/controller_set.hpp"

/// What a master writes to a MORAP motor node and what it reads from it. A write begins with an
/// identifier; identifiers from 128 on choose what the next reads answer. Source:
/// docs/spec/morap.md.
namespace armjig::morap {

/// The first byte of a write. A value without a name keeps its number.
enum class CommandId : std::uint8_t {
  kDisable = 0,
  kPosition = 1,
  kSpeed = 2,
  kVoltage = 3,
  kDirectVoltage = 4,
  kTorque = 5,
  kTrajectory = 7,
  kBrake14 = 14,  ///< on in firmware and library, off in the public document
  kBrake15 = 15,  ///< the other
  kCalibrateZero = 16,
  kCalibrateAngle = 17,
  kCalibrationUnknown = 31,
  kProgram = 32,
  kDefaultControllers = 33,
  kTune = 34,
  kReadAngle = 128,
  kReadPositionReference = 129,
  kReadSpeedReference = 130,
  kReadMotorStatus = 131,
  kReadProgrammingStatus = 132,
  kReadVoltage = 133,
  kReadCurrent = 134,
  kReadAddress = 136,
  kReadPositionSet = 138,
  kReadSpeedSet = 139,
  kLedOn = 252,
  kLedOff = 253,
  kLedToggle = 254,
};

/// What follows the identifier of a write.
enum class Payload : std::uint8_t { kNone, kFloat, kControllerSet, kTuneRequest };

struct CommandInfo {
  CommandId id{};
  std::string_view name;
  Payload payload{};
  std::string_view unit;  ///< of a float
  std::string_view meaning;
  bool is_documented{};  ///< in the public document
};

/// All commands that are no choice of what to read.
[[nodiscard]] std::span<const CommandInfo> commands() noexcept;

/// What a read answers.
enum class ReadKind : std::uint8_t { kFloat, kByte, kControllerSet };

struct ReadInfo {
  CommandId selector{};
  std::string_view selector_name;
  std::string_view name;
  ReadKind kind{};
  std::string_view unit;
  std::string_view meaning;
  bool is_documented{};
};

/// Everything that can be read.
[[nodiscard]] std::span<const ReadInfo> readings() noexcept;

/// nullptr if there is none.
[[nodiscard]] const CommandInfo* find_command(CommandId id) noexcept;
[[nodiscard]] const ReadInfo* find_reading(CommandId selector) noexcept;

/// The names of all identifiers, those of readings with `read_` before them.
inline constexpr std::size_t kIdentifierCount = 28;
extern const std::array<NamedValue, kIdentifierCount> kIdentifierNames;

// Sorts of identifiers.
[[nodiscard]] inline bool is_known(CommandId id) noexcept {
  return find_command(id) != nullptr || find_reading(id) != nullptr;
}
[[nodiscard]] constexpr bool is_reference(CommandId id) noexcept {
  return id >= CommandId::kPosition && id <= CommandId::kTorque;
}
[[nodiscard]] constexpr bool is_calibration(CommandId id) noexcept {
  return id == CommandId::kCalibrateZero || id == CommandId::kCalibrateAngle;
}
/// Those that change parameters.
[[nodiscard]] constexpr bool is_programming(CommandId id) noexcept {
  return id >= CommandId::kProgram && id <= CommandId::kTune;
}
/// Whether a number follows it.
[[nodiscard]] constexpr bool has_number(CommandId id) noexcept {
  return is_reference(id) || id == CommandId::kCalibrateAngle;
}

/// Answer to `kReadMotorStatus`.
enum class MotorStatus : std::uint8_t { kEnabled = 1, kDisabled = 2, kNeedsCalibration = 3 };

/// Answer to `kReadProgrammingStatus`. It stays until the next outcome; success means accepted, not
/// yet active.
enum class ProgrammingStatus : std::uint8_t { kNothing = 1, kSuccess = 2, kFailure = 3 };

/// Other values keep their number.
enum class TuneKind : std::uint8_t { kPdPosition = 0, kPidPosition = 1, kPiSpeed = 2 };

struct TuneRequest {
  TuneKind kind{};
  float inertia{};  ///< kg m^2 at the output shaft
  float pole{};     ///< of the closed loop, 1/s, negative
};

/// Which controller a request is about.
[[nodiscard]] constexpr ControllerKind kind_of(TuneKind kind) noexcept {
  return kind == TuneKind::kPiSpeed ? ControllerKind::kSpeed : ControllerKind::kPosition;
}
/// How it is read back.
[[nodiscard]] constexpr CommandId selector_of(ControllerKind kind) noexcept {
  return kind == ControllerKind::kSpeed ? CommandId::kReadSpeedSet : CommandId::kReadPositionSet;
}

/// One write. Floats are bit-exact. The payload is the one that the identifier asks for.
struct Command {
  CommandId id{};
  std::variant<std::monostate, float, ControllerSet, TuneRequest> payload;
};

inline constexpr std::size_t kFloatCommandSize = 5;
inline constexpr std::size_t kTuneCommandSize = 10;
inline constexpr std::size_t kLargestWriteSize = 1 + kLargestSetSize;
using WriteBytes = BoundedBytes<kLargestWriteSize>;

/// The data bytes of the write, identifier first.
[[nodiscard]] WriteBytes encode(const Command& command) noexcept;

/// Why data bytes are no command.
struct CommandFault {
  enum class Kind : std::uint8_t {
    kEmpty,  ///< a write of no byte: only asks who is there
    kUnknownId,
    kTooShort,
    kBadSet,  ///< `set` says why
  };
  Kind kind{};
  SetFault set{};

  friend bool operator==(const CommandFault&, const CommandFault&) = default;
};

struct DecodedCommand {
  Command command;
  std::size_t size{};  ///< data bytes that it needs; what follows is surplus
};

/// Reads the data bytes of a write.
[[nodiscard]] std::variant<DecodedCommand, CommandFault> decode_command(Bytes data) noexcept;

/// The answer to a read of `ReadKind::kFloat`.
using FloatBytes = std::array<std::byte, 4>;
[[nodiscard]] FloatBytes encode(float value) noexcept;
[[nodiscard]] inline float decode_float(std::span<const std::byte, 4> bytes) noexcept {
  return load_f32_le(bytes);
}

inline constexpr std::uint8_t kNodeBaseAddress = 0x10;
/// The largest identifier of the public document, and the largest with which a node starts.
inline constexpr std::uint8_t kLastDocumentedNode = 7;
inline constexpr std::uint8_t kLastNode = 16;

/// The seven-bit address of a node. 16 is 0 again.
[[nodiscard]] constexpr std::uint8_t node_address(std::uint8_t node) noexcept {
  return static_cast<std::uint8_t>(kNodeBaseAddress | node);
}
/// The other way round; 16 or more if the address is not that of a node.
[[nodiscard]] constexpr std::uint8_t node_of(std::uint8_t address) noexcept {
  return static_cast<std::uint8_t>(address ^ kNodeBaseAddress);
}
[[nodiscard]] constexpr bool is_node_address(std::uint8_t address) noexcept {
  return node_of(address) < kLastNode;
}

}  // namespace armjig::morap
