// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/host/check.hpp"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "conformance/morap/host/occasions.hpp"
#include "harness/core/hex.hpp"
#include "harness/wire/morap/figures.hpp"
#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::morap::programs {
namespace {

using enum CommandId;

/// What a master has told one node.
struct Told {
  bool is_calibrated = false;
  bool is_enabled = false;
  bool is_unverified = false;  ///< programmed, and the status was not read since
  CommandId selected = kReadAngle;
  std::optional<Instant> programmed{};
};

class HostChecker final : public ProgramChecker {
 public:
  explicit HostChecker(const LinkNoise& noise) : noise_{noise.most} {}

  void to_device(Instant time, Bytes transaction) override {
    now_ = time;
    if (transaction.empty()) return;
    const auto address = address_of(transaction);
    const auto data = transaction.subspan(1);
    if (data.empty()) return;  // a poke
    ++messages_;
    if (address == pen::kAddress) return judge_pen(data);
    if (!is_node_address(address)) return;  // somebody else
    if (address > node_address(kLastDocumentedNode)) {
      complain("addresses", fmt::format("address {:02X}", address));
    }
    complain_.occasion(occasion::kNode);
    judge_command(nodes_[address], data);
  }

  void from_device(Instant time, Bytes transaction) override {
    now_ = time;
    if (transaction.empty()) return;
    const auto address = address_of(transaction);
    if (address == pen::kAddress) {
      complain_.occasion(occasion::kPen);
      return complain("pen-read", "a read of the pen");
    }
    const auto node = nodes_.find(address);
    if (node == nodes_.end()) return;
    complain_.occasion(occasion::kRead);
    judge_read(node->second, transaction.subspan(1));
  }

  void finish(Instant time) override {
    now_ = time;
    for (const auto& [address, told] : nodes_) {
      if (told.is_enabled) complain("ends-disabled", fmt::format("node {:02X} is", address));
    }
  }

  [[nodiscard]] std::size_t messages() const noexcept override { return messages_; }

 private:
  static std::uint8_t address_of(Bytes transaction) noexcept {
    return static_cast<std::uint8_t>(std::to_integer<unsigned>(transaction[0]) >> 1U);
  }

  /// `name` is what stands behind `morap.host.`.
  void complain(std::string_view name, std::string what) {
    for (const auto& requirement : host_requirements()) {
      if (requirement.id.substr(kPrefix.size()) != name) continue;
      return complain_(requirement.id, std::move(what));
    }
  }

  void judge_command(Told& told, Bytes data) {
    const CommandId id{std::to_integer<std::uint8_t>(data[0])};
    if (has_number(id)) complain_.occasion(occasion::kNumber);
    if (id == kProgram) complain_.occasion(occasion::kSet);
    if (id == kTune) complain_.occasion(occasion::kTuning);
    const auto decoded = decode_command(data);
    if (const auto* fault = std::get_if<CommandFault>(&decoded)) return judge_fault(*fault, data);
    const auto& [command, size] = std::get<DecodedCommand>(decoded);
    if (data.size() > size) {
      complain(has_number(id) ? "overlong-number" : "surplus",
               fmt::format("{} bytes after {}", data.size() - size, static_cast<int>(id)));
    }
    if (find_reading(id) != nullptr) told.selected = id;
    judge_payload(command);
    judge_order(told, id);
  }

  void judge_fault(const CommandFault& fault, Bytes data) {
    switch (fault.kind) {
      case CommandFault::Kind::kUnknownId:
        return complain("known-ids", to_hex_dump(data.first(1)));
      case CommandFault::Kind::kTooShort:
        return complain("whole-command", to_hex_dump(data));
      case CommandFault::Kind::kBadSet:
        return complain(fault.set.kind == SetFault::Kind::kCountAboveFour ? "counts" : "checksum",
                        fmt::format("byte {} of the parameters", fault.set.offset));
      case CommandFault::Kind::kEmpty:
        break;
    }
  }

  void judge_payload(const Command& command) {
    if (const auto* number = std::get_if<float>(&command.payload)) {
      judge_number(command.id, *number);
    } else if (const auto* set = std::get_if<ControllerSet>(&command.payload)) {
      judge_set(*set);
    } else if (const auto* request = std::get_if<TuneRequest>(&command.payload)) {
      judge_tuning(*request);
    }
    if (command.id == kBrake14 || command.id == kBrake15) {
      complain("no-brake", fmt::format("identifier {}", static_cast<int>(command.id)));
    }
  }

  void judge_number(CommandId id, float number) {
    if (!std::isfinite(number)) return complain("finite", fmt::format("{}", number));
    if (id == kDirectVoltage) complain("no-direct-voltage", fmt::format("{} V", number));
    const bool is_voltage = id == kVoltage || id == kDirectVoltage;
    if (is_voltage && std::fabs(number) > kVoltageLimit) {
      complain("voltage", fmt::format("{} V", number));
    }
  }

  void judge_set(const ControllerSet& set) {
    if (set.kind > ControllerKind::kSpeed) {
      complain("kind", fmt::format("kind {}", static_cast<int>(set.kind)));
    }
    if (set.rate_hz == 0 || set.rate_hz > kHighestRateHz) {
      complain("rate", fmt::format("{} Hz", set.rate_hz));
    }
    bool are_numbers = std::isfinite(set.integral);
    for (const auto* filter : {&set.d, &set.c, &set.f}) {
      if (filter->count == 0) complain("counts", "a filter without coefficients");
      for (std::size_t i = 0; i < filter->count; ++i) {
        are_numbers = are_numbers && std::isfinite(filter->values[i]);
      }
    }
    if (!are_numbers) complain("coefficients", "one is none");
  }

  void judge_tuning(const TuneRequest& request) {
    if (request.kind > TuneKind::kPiSpeed) {
      complain("tune-kind", fmt::format("kind {}", static_cast<int>(request.kind)));
    }
    if (!(request.inertia > 0.0F && request.inertia <= kLargestInertia)) {
      complain("tune-inertia", fmt::format("{}", request.inertia));
    }
    if (!(request.pole >= kFastestPole && request.pole < 0.0F)) {
      complain("tune-pole", fmt::format("{}", request.pole));
    }
  }

  void judge_order(Told& told, CommandId id) {
    if (is_reference(id)) {
      complain_.occasion(occasion::kReference);
      if (!told.is_calibrated) {
        complain("calibrates-first", fmt::format("reference {}", static_cast<int>(id)));
      }
      if (std::exchange(told.is_unverified, false)) {
        complain("program-status", "it was not read");
      }
      told.is_enabled = true;
    }
    if (is_calibration(id)) {
      complain_.occasion(occasion::kCalibration);
      if (told.is_calibrated && told.is_enabled) {
        complain("calibrates-disabled", fmt::format("identifier {}", static_cast<int>(id)));
      }
      told.is_calibrated = true;
    }
    if (id == kDisable || id == kCalibrationUnknown) told.is_enabled = false;
    if (id == kCalibrationUnknown) told.is_calibrated = false;
    if (is_programming(id)) judge_pause(told, id);
  }

  void judge_pause(Told& told, CommandId id) {
    complain_.occasion(occasion::kProgram);
    if (told.programmed) complain_.occasion(occasion::kTwoPrograms);
    if (told.programmed && now_ - *told.programmed + noise_ < kProgrammingPause) {
      complain("program-pause", fmt::format("{:.1f} ms", milliseconds(now_ - *told.programmed)));
    }
    told.programmed = now_;
    told.is_unverified = id != kDefaultControllers;
  }

  void judge_read(Told& told, Bytes data) {
    if (told.selected == kReadProgrammingStatus) told.is_unverified = false;
    const auto most = most_bytes(told.selected);
    if (data.size() > most) {
      complain("read-size", fmt::format("{} bytes of {}", data.size(), most));
    }
  }

  static std::size_t most_bytes(CommandId selected) noexcept {
    switch (find_reading(selected)->kind) {
      case ReadKind::kFloat:
        return sizeof(float);
      case ReadKind::kByte:
        return 1;
      case ReadKind::kControllerSet:
        break;
    }
    return kLargestSetSize;
  }

  void judge_pen(Bytes data) {
    complain_.occasion(occasion::kPen);
    if (pen_) complain_.occasion(occasion::kTwoPens);
    const pen::CommandId id{std::to_integer<std::uint8_t>(data[0])};
    const bool has_position = id == pen::CommandId::kSetPosition;
    if (!has_position && id != pen::CommandId::kDeploy && id != pen::CommandId::kRetract) {
      complain("pen-commands", to_hex_dump(data.first(1)));
    }
    if (data.size() > (has_position ? 2U : 1U)) complain("pen-surplus", to_hex_dump(data));
    if (pen_ && now_ - *pen_ + noise_ < pen::kPause) {
      complain("pen-pause", fmt::format("{:.1f} ms", milliseconds(now_ - *pen_)));
    }
    pen_ = now_;
  }

  static constexpr std::string_view kPrefix = "morap.host.";

  Duration noise_;
  std::size_t messages_ = 0;
  std::map<std::uint8_t, Told> nodes_;  ///< by address
  std::optional<Instant> pen_{};        ///< when it was last told something
};

}  // namespace

ProgramCheckEntry program_check() noexcept {
  return {"morap", host_requirements, make_checker<HostChecker>,
          shipped_document("docs/spec/morap.md")};
}

}  // namespace armjig::morap::programs
