// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

void first_mode(NodeBench& node) {
  node.turn(1000);
  const auto unchosen = node.read_on(4);
  node.expect_same(unchosen, node.read(kReadAngle, 4));
}

template <CommandId selector>
void zero_at_boot(NodeBench& node) {
  node.expect_bytes(selector, "00 00 00 00");
}

void address(NodeBench& node) {
  node.expect_same(node.read(kReadAddress, 1), std::vector{std::byte{node.address().value}});
}

void keeps_mode(NodeBench& node) {
  node.send(kSpeed, 0.75F);
  node.send(kReadSpeedReference);
  for (int i = 0; i < 4; ++i) node.expect_read_on("00 00 40 3F");
}

void mode_over_commands(NodeBench& node) {
  node.send(kReadMotorStatus);
  node.send(kPosition, 0.5F);
  node.send(kSpeed, 0.5F);
  node.send(kDisable);
  node.send(kCalibrationUnknown);
  node.expect_read_on("03");
}

void mode_over_brake(NodeBench& node) {
  node.send(kReadMotorStatus);
  node.send(kBrake14);
  node.send(kBrake15);
  node.expect_read_on("03");
}

void mode_over_unknown(NodeBench& node) {
  node.send(kReadMotorStatus);
  for (const auto* const id : {"06", "23", "87", "8C", "FF"}) {
    node.about(fmt::format("behind {}", id));
    node.send_bytes(id);
    node.expect_read_on("03");
  }
}

void surplus(NodeBench& node) {
  node.send(kSpeed, 0.75F);
  node.send_bytes("82 81");
  node.expect_read_on("00 00 40 3F");
}

void short_read(NodeBench& node) {
  node.send(kSpeed, 0.2F);
  node.send(kReadSpeedReference);
  node.expect_read_on("CD CC");
  node.expect_read_on("CD");
  node.expect_read_on("CD CC 4C 3E");
}

void little_endian(NodeBench& node) { expect_turned(node); }

void snapshot(NodeBench& node) {
  node.turn(1000);
  node.send(kReadAngle);
  const auto before = node.read_on(4);
  node.expect_same(node.read_around(node.address(), 4, [&] { node.turn(5000); }), before);
}

void wrap(NodeBench& node) {
  node.turn(1000);
  node.send(kReadAngle);
  const auto first = node.read_on(4);
  const auto bytes = node.read_around(node.address(), 260, [&] { node.turn(1000); });
  node.about("the first four of 260 bytes");
  node.expect_same(Bytes{bytes}.first(std::min<std::size_t>(bytes.size(), 4)), first);
  const auto second = node.read_on(4);
  node.about("the last four, behind a turn of the shaft");
  node.expect_same(Bytes{bytes}.subspan(bytes.size() < 260 ? 0 : 256), second);
}

void byte_again(NodeBench& node) { node.expect_bytes(kReadMotorStatus, "03 03 03 03"); }

void set_filled(NodeBench& node) {
  const auto bytes = node.read(kReadPositionSet, 64);
  const auto set = decode_set(bytes);
  const auto* good = std::get_if<ControllerSet>(&set);
  node.expect_true(good != nullptr, "a controller set", "none");
  const auto size = good == nullptr ? 0 : wire_size(*good);
  node.expect_same(Bytes{bytes}.subspan(size), std::vector<std::byte>(bytes.size() - size));
}

void set_wrap(NodeBench& node) {
  const auto set = node.read(kReadPositionSet, 31);
  const auto bytes = node.read_on(256 + 31);
  node.expect_same(Bytes{bytes}.subspan(256), set);
}

void set_checksum(NodeBench& node) {
  for (const auto selector : {kReadPositionSet, kReadSpeedSet}) {
    const auto bytes = node.read(selector, kLargestSetSize);
    const auto set = decode_set(bytes);
    node.expect_true(std::holds_alternative<ControllerSet>(set), "a set with its checksum",
                     "another checksum");
  }
}

void position_default(NodeBench& node) {
  node.expect_bytes(kReadPositionSet, node.motor().position_set);
}

void speed_default(NodeBench& node) { node.expect_bytes(kReadSpeedSet, node.motor().speed_set); }

constexpr Case kCases[] = {
    from(kFresh, Hazard::kState, "morap.read.first-mode",
         "A turned shaft is read without a choice and with one.", on<first_mode>),
    from(kFresh, Hazard::kState, "morap.read.angle-at-boot", "It is read first.",
         on<zero_at_boot<kReadAngle>>),
    from(kFresh, Hazard::kState, "morap.read.voltage-at-boot", "It is read first.",
         on<zero_at_boot<kReadVoltage>>),
    from(kFresh, Hazard::kState, "morap.read.position-at-boot", "It is read first.",
         on<zero_at_boot<kReadPositionReference>>),
    from(kFresh, Hazard::kState, "morap.read.speed-at-boot", "It is read first.",
         on<zero_at_boot<kReadSpeedReference>>),
    {.requirement = "morap.read.address", .rule = "It is read.", .run = on<address>},
    from(kUncalibrated, Hazard::kState, "morap.read.keeps-mode", "One choice, four reads.",
         on<keeps_mode>),
    from(kUncalibrated, Hazard::kState, "morap.read.mode-over-commands",
         "The status is chosen, then commands of all sorts.", on<mode_over_commands>),
    from(kUncalibrated, Hazard::kState, "morap.read.mode-over-brake",
         "The status is chosen, then 14 and 15.", on<mode_over_brake>),
    from(kUncalibrated, Hazard::kState, "morap.read.mode-over-unknown",
         "The status is chosen, then identifiers without a meaning.", on<mode_over_unknown>),
    from(kUncalibrated, Hazard::kState, "morap.read.surplus",
         "The speed reference is chosen, with another choice behind it.", on<surplus>),
    from(kUncalibrated, Hazard::kState, "morap.read.short", "Two bytes, one byte, all four.",
         on<short_read>),
    from(kFresh, Hazard::kState, "morap.read.little-endian", "A thousand counts, not calibrated.",
         on<little_endian>),
    from(kFresh, Hazard::kState, "morap.read.snapshot", "The shaft turns behind the first byte.",
         on<snapshot>),
    from(kFresh, Hazard::kState, "morap.read.wrap", "260 bytes, and the shaft turns between.",
         on<wrap>),
    from(kUncalibrated, Hazard::kState, "morap.read.byte-again",
         "The status, four times in one read.", on<byte_again>),
    {.requirement = "morap.read.set-filled", .rule = "64 bytes are read.", .run = on<set_filled>},
    {.requirement = "morap.read.set-wrap", .rule = "287 bytes are read.", .run = on<set_wrap>},
    {.requirement = "morap.read.set-checksum",
     .rule = "Both sets are read.",
     .run = on<set_checksum>},
    from(kProgrammable, Hazard::kProgram, "morap.read.position-default", "It is loaded and read.",
         on<position_default>),
    from(kProgrammable, Hazard::kProgram, "morap.read.speed-default", "It is loaded and read.",
         on<speed_default>),
};

}  // namespace

std::span<const Case> reading_cases() noexcept { return kCases; }

}  // namespace armjig::morap::conformance
