// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/dissector.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/parol6/splitter.hpp"

namespace armjig::parol6 {
namespace {

std::string describe(const Splitter::Fault& fault, std::size_t payload_size) {
  switch (fault.kind) {
    case Splitter::FaultKind::kWrongLength:
      return fmt::format("length byte {} where {} is due", fault.value, payload_size);
    case Splitter::FaultKind::kWrongCheck:
      return fmt::format("check byte 0x{:02X}", fault.value);
    case Splitter::FaultKind::kWrongEnd:
      return fmt::format("0x{:02X} in place of the end bytes 01 02", fault.value);
  }
  return {};
}

/// One direction of the link. Noise comes out in pieces of `kNoisePiece`, so that a stream without
/// frames does not fill the memory; where the pieces end depends on the stream alone.
class Lane {
 public:
  Lane(Direction direction, std::string_view name, std::size_t payload_size,
       std::span<const Field> fields)
      : splitter_{payload_size},
        payload_size_{payload_size},
        direction_{direction},
        name_{name},
        fields_{fields} {}

  void feed(Instant time, Bytes bytes, std::vector<Message>& out) {
    time_ = time;
    while (!bytes.empty()) {
      const auto step = splitter_.step(bytes.first(std::min(bytes.size(), kNoisePiece)));
      pending_.insert(pending_.end(), bytes.begin(),
                      bytes.begin() + static_cast<std::ptrdiff_t>(step.used));
      bytes = bytes.subspan(step.used);
      if (std::holds_alternative<Splitter::Frame>(step.found)) {
        emit_frame(out);
        continue;
      }
      if (const auto* fault = std::get_if<Splitter::Fault>(&step.found)) {
        // It belongs to the piece with its last byte.
        emit_pieces(certain_noise() - 1, out);
        if (fault_.empty()) fault_ = describe(*fault, payload_size_);
      }
      emit_pieces(certain_noise(), out);
    }
  }

  void finish(std::vector<Message>& out) {
    if (fault_.empty() && certain_noise() == 0) fault_ = "the frame is cut short";
    emit_noise(pending_.size(), out);
    splitter_ = Splitter{payload_size_};
  }

 private:
  static constexpr std::size_t kNoisePiece = 4096;

  void emit_frame(std::vector<Message>& out) {
    const auto noise = pending_.size() - (kHeaderSize + payload_size_);
    if (noise > 0 || !fault_.empty()) {
      emit_pieces(noise, out);
      emit_noise(noise % kNoisePiece, out);
    }
    out.push_back({direction_, time_, name_, std::exchange(pending_, {}), fields_, {}});
  }

  /// How many of the pending bytes cannot become part of a frame any more.
  [[nodiscard]] std::size_t certain_noise() const noexcept {
    return pending_.size() - splitter_.held();
  }

  void emit_pieces(std::size_t noise, std::vector<Message>& out) {
    for (; noise >= kNoisePiece; noise -= kNoisePiece) emit_noise(kNoisePiece, out);
  }

  void emit_noise(std::size_t size, std::vector<Message>& out) {
    auto fault = std::exchange(fault_, {});
    if (size == 0) return;
    if (fault.empty()) fault = "no start of a frame";
    const auto end = pending_.begin() + static_cast<std::ptrdiff_t>(size);
    out.push_back({direction_, time_, "noise", {pending_.begin(), end}, {}, std::move(fault)});
    pending_.erase(pending_.begin(), end);
  }

  Splitter splitter_;
  std::size_t payload_size_;
  Direction direction_;
  std::string_view name_;
  std::span<const Field> fields_;
  Instant time_{};
  std::vector<std::byte> pending_;  ///< seen, but not yet in a message
  std::string fault_;
};

class FrameDissector final : public Dissector {
 public:
  void feed(Direction direction, Instant time, Bytes bytes, std::vector<Message>& out) override {
    (direction == Direction::kToDevice ? commands_ : telemetry_).feed(time, bytes, out);
  }
  void finish(std::vector<Message>& out) override {
    commands_.finish(out);
    telemetry_.finish(out);
  }

 private:
  Lane commands_{Direction::kToDevice, "command", kCommandPayloadSize, command_fields()};
  Lane telemetry_{Direction::kFromDevice, "telemetry", kTelemetryPayloadSize, telemetry_fields()};
};

}  // namespace

std::unique_ptr<Dissector> make_dissector() { return std::make_unique<FrameDissector>(); }

Dissection dissection() {
  return {.messages = {{"command", Direction::kToDevice, command_fields()},
                       {"telemetry", Direction::kFromDevice, telemetry_fields()}}};
}

}  // namespace armjig::parol6
