// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/fields.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::parol6 {
namespace {

using Members = std::map<std::string, std::int64_t>;

template <class Joints>
void add_joints(Members& members, const std::string& name, const Joints& joints) {
  int number = 0;
  for (const auto& joint : joints) members[name + ".j" + std::to_string(++number)] = joint.value;
}

// Every member of a frame under the name of its field. A member that is added to the struct breaks
// these bindings, so it cannot be forgotten here.
Members members_of(const CommandFrame& frame) {
  const auto& [position, speed, command, affected_joints, in_out, timeout, gripper, check] = frame;
  const auto& [grip, grip_speed, current, grip_command, mode, id] = gripper;
  Members members{{"command", static_cast<int>(command)},
                  {"affected_joints", affected_joints},
                  {"in_out", in_out},
                  {"timeout", timeout},
                  {"gripper.position", grip},
                  {"gripper.speed", grip_speed},
                  {"gripper.current", current.value},
                  {"gripper.command", grip_command},
                  {"gripper.mode", mode},
                  {"gripper.id", id},
                  {"check", check}};
  add_joints(members, "position", position);
  add_joints(members, "speed", speed);
  return members;
}

Members members_of(const TelemetryFrame& frame) {
  const auto& [position, speed, homed, io, temperature_error, position_error, timing, timeout_error,
               echo, gripper, check] = frame;
  const auto& [id, grip, grip_speed, current, status, object_detection] = gripper;
  Members members{{"homed", homed},
                  {"io", io},
                  {"temperature_error", temperature_error},
                  {"position_error", position_error},
                  {"timing", timing},
                  {"timeout_error", timeout_error},
                  {"echo", static_cast<int>(echo)},
                  {"gripper.id", id},
                  {"gripper.position", grip},
                  {"gripper.speed", grip_speed},
                  {"gripper.current", current.value},
                  {"gripper.status", status},
                  {"gripper.object", object_detection},
                  {"check", check}};
  add_joints(members, "position", position);
  add_joints(members, "speed", speed);
  return members;
}

struct CommandKind {
  static constexpr std::size_t kSize = kCommandFrameSize;
  static auto fields() { return command_fields(); }
  static auto decode(std::span<const std::byte, kSize> frame) {
    return decode_command(body_of(frame));
  }
};
struct TelemetryKind {
  static constexpr std::size_t kSize = kTelemetryFrameSize;
  static auto fields() { return telemetry_fields(); }
  static auto decode(std::span<const std::byte, kSize> frame) {
    return decode_telemetry(body_of(frame));
  }
};

template <class Kind>
class Fields : public testing::Test {
 protected:
  using Frame = std::array<std::byte, Kind::kSize>;

  /// Noise in which every literal is right.
  static Frame random_frame(test::Dice& dice) {
    Frame frame{};
    for (auto& byte : frame) byte = dice.byte();
    for (const auto& field : Kind::fields()) {
      if (field.encoding == Encoding::kLiteral) set_field_value(field, frame, field.literal);
    }
    return frame;
  }
};
using Kinds = testing::Types<CommandKind, TelemetryKind>;
TYPED_TEST_SUITE(Fields, Kinds);

TYPED_TEST(Fields, TileTheFrameInOrder) {
  std::size_t end = 0;
  for (const auto& field : TypeParam::fields()) {
    EXPECT_EQ(field.offset, end) << field.name;
    EXPECT_GE(field.width, 1) << field.name;
    EXPECT_LE(field.width, 4) << field.name;
    end = std::size_t{field.offset} + field.width;
  }
  EXPECT_EQ(end, TypeParam::kSize);
}

TYPED_TEST(Fields, AreNamedOnceAndExplained) {
  std::set<std::string_view> names;
  for (const auto& field : TypeParam::fields()) {
    EXPECT_TRUE(names.insert(field.name).second) << field.name;
    EXPECT_FALSE(field.meaning.empty()) << field.name;
    if (field.encoding == Encoding::kBits) {
      EXPECT_EQ(field.bits.size(), 8U) << field.name;
      EXPECT_EQ(field.width, 1) << field.name;
    }
    if (field.encoding == Encoding::kCode) {
      EXPECT_FALSE(field.values.empty()) << field.name;
    }
  }
}

TYPED_TEST(Fields, AreTheMembersOfTheFrameAndNoOthers) {
  test::Dice dice{6};
  const auto members = members_of(TypeParam::decode(this->random_frame(dice)));
  std::set<std::string> listed;
  for (const auto& field : TypeParam::fields()) {
    if (field.encoding != Encoding::kLiteral) listed.emplace(field.name);
  }
  std::set<std::string> decoded;
  for (const auto& [name, value] : members) decoded.insert(name);
  EXPECT_EQ(listed, decoded);
}

TYPED_TEST(Fields, SayWhatTheCodecSays) {
  test::Dice dice{7};
  for (int round = 0; round < 100; ++round) {
    const auto frame = this->random_frame(dice);
    const auto members = members_of(TypeParam::decode(frame));
    for (const auto& [name, value] : members) {
      const auto* field = find_field(TypeParam::fields(), name);
      ASSERT_NE(field, nullptr) << name;
      EXPECT_EQ(field_value(*field, frame), value) << name;
    }
  }
}

TYPED_TEST(Fields, SetThroughTheListComeBackFromTheCodec) {
  test::Dice dice{8};
  for (const auto& field : TypeParam::fields()) {
    if (field.encoding == Encoding::kLiteral) continue;
    const std::int64_t choices = std::int64_t{1} << (8 * field.width);
    const bool is_signed = field.encoding == Encoding::kSigned;
    const auto least = is_signed ? -choices / 2 : 0;
    for (const auto value : {least, least + 1, std::int64_t{0}, std::int64_t{1},
                             least + choices / 2, least + choices - 1}) {
      auto frame = this->random_frame(dice);
      set_field_value(field, frame, value);
      const auto encoded = encode(TypeParam::decode(frame));
      EXPECT_EQ(field_value(field, encoded), value) << field.name;
      EXPECT_EQ(test::as_vector(encoded), test::as_vector(frame)) << field.name;
    }
  }
}

TYPED_TEST(Fields, HaveTheLiteralsThatTheCodecWrites) {
  const auto encoded = encode(TypeParam::decode(std::array<std::byte, TypeParam::kSize>{}));
  for (const auto& field : TypeParam::fields()) {
    if (field.encoding != Encoding::kLiteral) continue;
    EXPECT_EQ(field_value(field, encoded), field.literal) << field.name;
  }
}

}  // namespace
}  // namespace armjig::parol6
