// SPDX-License-Identifier: Apache-2.0
#include "rtu.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

namespace gripper {

using namespace armjig;

namespace {

constexpr std::size_t kHead = 2;  ///< address and function
constexpr std::size_t kCrc = 2;

constexpr std::array<NamedValue, 3> kFunctions{{{3, "read"}, {6, "write"}, {16, "write_many"}}};
constexpr std::array<NamedValue, 4> kExceptions{
    {{1, "illegal_function"}, {2, "illegal_address"}, {3, "illegal_value"}, {4, "device_failure"}}};
constexpr std::array<NamedValue, 4> kStatuses{
    {{0, "stopped"}, {1, "moving"}, {2, "arrived"}, {3, "holding"}}};

using enum Encoding;
constexpr Field kUnit{"address", 0, 1, kUnsigned, "", "of the device, 0 for all"};
constexpr Field kFunction{"function", 0, 1, kCode, "", "what to do", {}, kFunctions};
constexpr Field kException{"exception", 0, 1, kCode, "", "why not", {}, kExceptions};
constexpr Field kFirst{"register", 0, 2, kUnsigned, "", "the first of them"};
constexpr Field kCount{"count", 0, 2, kUnsigned, "", "of registers"};
constexpr Field kBytes{"bytes", 0, 1, kUnsigned, "", "of the registers that follow"};
constexpr Field kCheck{"crc", 0, 2, kUnsignedLittle, "", "of all before it"};
constexpr Field kOther{"value", 0, 2, kUnsigned, "", "of a register that there is not"};
constexpr std::array<Field, kRegisters> kRegisterFields{
    {{"control", 0, 2, kUnsigned, "", "0 stops, anything else moves"},
     {"target", 0, 2, kUnsigned, "0.1 mm", "where to move"},
     {"speed", 0, 2, kUnsigned, "0.1 mm/s", "of the move"},
     {"force", 0, 2, kUnsigned, "N", "with which to hold"},
     {"status", 0, 2, kCode, "", "of the move", {}, kStatuses},
     {"position", 0, 2, kUnsigned, "0.1 mm", "where the jaws are"},
     {"grip_force", 0, 2, kUnsigned, "N", "that the jaws exert"},
     {"model", 0, 2, kUnsigned, "", "always 0x4752"}}};

/// What stands in a frame with its CRC. `first` is the register with which registers begin.
std::vector<Field> lay_out(std::initializer_list<Field> head, unsigned first, unsigned registers) {
  std::vector<Field> fields{kUnit, kFunction};
  fields.insert(fields.end(), head);
  for (unsigned i = first; i < first + registers; ++i) {
    fields.push_back(i < kRegisters ? kRegisterFields[i] : kOther);
  }
  fields.push_back(kCheck);
  std::uint16_t end = 0;
  for (auto& field : fields) end = static_cast<std::uint16_t>((field.offset = end) + field.width);
  return fields;
}

/// That of a whole frame; a reply to a reading begins with the register `asked`.
std::vector<Field> lay_out(Direction direction, Bytes frame, unsigned asked) {
  const auto byte = [&](std::size_t place) { return std::to_integer<unsigned>(frame[place]); };
  if ((frame[1] & kExceptionBit) != std::byte{}) return lay_out({kException}, 0, 0);
  const bool is_request = direction == Direction::kToDevice;
  const auto function = Function{static_cast<std::uint8_t>(frame[1])};
  if (function == Function::kRead && !is_request) return lay_out({kBytes}, asked, byte(2) / 2);
  const auto first = byte(2) << 8 | byte(3);
  if (function == Function::kWrite) return lay_out({kFirst}, first, 1);
  if (function == Function::kRead || !is_request) return lay_out({kFirst, kCount}, 0, 0);
  return lay_out({kFirst, kCount, kBytes}, first, byte(6) / 2);
}

/// The same, to be kept for as long as anybody may look at it.
std::span<const Field> fields_of(Direction direction, Bytes frame, unsigned asked) {
  auto fields = lay_out(direction, frame, asked);
  std::vector<std::string_view> names;
  for (const auto& field : fields) names.push_back(field.name);
  static std::mutex mutex;
  static std::map<std::vector<std::string_view>, std::vector<Field>> known;
  const std::scoped_lock lock{mutex};
  return known.emplace(std::move(names), std::move(fields)).first->second;
}

class RtuDissector final : public Dissector {
 public:
  void feed(Direction direction, Instant time, Bytes bytes, std::vector<Message>& out) override {
    auto& lane = direction == Direction::kToDevice ? requests_ : replies_;
    auto& other = direction == Direction::kToDevice ? replies_ : requests_;
    if (!bytes.empty()) other.over = other.bytes.size();  // one speaks at a time
    emit_noise(lane, time, std::exchange(lane.over, 0), out);
    lane.bytes.insert(lane.bytes.end(), bytes.begin(), bytes.end());
    while (take_frame(lane, time, out)) {
    }
  }
  void finish(std::vector<Message>& out) override {
    for (auto* lane : {&requests_, &replies_}) emit_noise(*lane, {}, lane->bytes.size(), out);
  }

 private:
  struct Lane {
    Direction direction;
    Frame bytes{};
    std::size_t over = 0;  ///< so many of them do not go on

    Frame take(std::size_t size) {
      const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(size);
      Frame taken{bytes.begin(), end};
      bytes.erase(bytes.begin(), end);
      return taken;
    }
  };

  /// The first whole frame, and what is noise before it. False: there is none yet.
  bool take_frame(Lane& lane, Instant time, std::vector<Message>& out) {
    auto hope = lane.bytes.size();  // where a frame may have begun that is not whole yet
    for (std::size_t i = 0; i < lane.bytes.size(); ++i) {
      const auto rest = Bytes{lane.bytes}.subspan(i);
      const auto size = size_of(lane.direction, rest);
      const bool needs_more = !size || *size > rest.size();
      if (needs_more) hope = std::min(hope, i);
      if (needs_more || *size == 0 || !has_good_crc(rest.first(*size))) continue;
      emit_noise(lane, time, i, out);
      emit_frame(lane, time, *size, out);
      return true;
    }
    emit_noise(lane, time, hope, out);
    return false;
  }

  void emit_frame(Lane& lane, Instant time, std::size_t size, std::vector<Message>& out) {
    auto frame = lane.take(size);
    const auto function =
        std::ranges::find(kFunctions, std::to_integer<int>(frame[1]), &NamedValue::value);
    const auto name = function == kFunctions.end() ? "exception" : function->name;
    const auto fields = fields_of(lane.direction, frame, asked_);
    if (lane.direction == Direction::kToDevice) asked_ = load_u16_be(slice<2>(Bytes{frame}, kHead));
    out.push_back({lane.direction, time, name, std::move(frame), fields, {}});
  }

  static void emit_noise(Lane& lane, Instant time, std::size_t size, std::vector<Message>& out) {
    if (size == 0) return;
    out.push_back({lane.direction, time, "noise", lane.take(size), {}, "no frame with a good CRC"});
  }

  Lane requests_{Direction::kToDevice};
  Lane replies_{Direction::kFromDevice};
  unsigned asked_ = 0;  ///< the register of the last request
};

}  // namespace

std::uint16_t crc16(Bytes bytes) noexcept {
  unsigned crc = 0xFFFF;
  for (const auto byte : bytes) {
    crc ^= std::to_integer<unsigned>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? crc >> 1 ^ 0xA001 : crc >> 1;
  }
  return static_cast<std::uint16_t>(crc);
}

void append(Frame& frame, unsigned word) {
  frame.push_back(static_cast<std::byte>(word >> 8));
  frame.push_back(static_cast<std::byte>(word));
}

void append_crc(Frame& frame) {
  const unsigned crc = crc16(frame);
  append(frame, (crc & 0xFF) << 8 | crc >> 8);
}

bool has_good_crc(Bytes frame) noexcept {
  return frame.size() >= kHead + kCrc && crc16(frame) == 0;  // over itself a CRC comes to nothing
}

Frame request(std::uint8_t unit, std::initializer_list<unsigned> bytes) {
  Frame frame{std::byte{unit}};
  for (const auto byte : bytes) frame.push_back(static_cast<std::byte>(byte));
  append_crc(frame);
  return frame;
}

Frame read_request(std::uint8_t unit, unsigned first, unsigned count) {
  return request(unit, {3, first >> 8, first & 0xFF, count >> 8, count & 0xFF});
}

Frame write_request(std::uint8_t unit, unsigned place, unsigned value) {
  return request(unit, {6, place >> 8, place & 0xFF, value >> 8, value & 0xFF});
}

Frame write_many_request(std::uint8_t unit, unsigned first,
                         std::initializer_list<unsigned> values) {
  Frame frame{std::byte{unit}, std::byte{16}};
  append(frame, first);
  append(frame, static_cast<unsigned>(values.size()));
  frame.push_back(static_cast<std::byte>(2 * values.size()));
  for (const auto value : values) append(frame, value);
  append_crc(frame);
  return frame;
}

std::optional<std::size_t> size_of(Direction direction, Bytes begin) noexcept {
  constexpr std::size_t kPlain = 8;    // address, function, two words, CRC
  constexpr std::size_t kRefusal = 5;  // address, function, exception, CRC
  if (begin.size() < kHead) return std::nullopt;
  const bool is_request = direction == Direction::kToDevice;
  const auto plus_bytes_at = [&](std::size_t place) -> std::optional<std::size_t> {
    if (begin.size() <= place) return std::nullopt;
    return place + 1 + std::to_integer<std::size_t>(begin[place]) + kCrc;
  };
  switch (std::to_integer<unsigned>(begin[1])) {
    case 0x03:
      return is_request ? kPlain : plus_bytes_at(2);
    case 0x06:
      return kPlain;
    case 0x10:
      return is_request ? plus_bytes_at(6) : kPlain;
    default:
      return is_request || (begin[1] & kExceptionBit) == std::byte{} ? 0 : kRefusal;
  }
}

Silence Silence::at(unsigned baud) noexcept {
  constexpr unsigned kBits = 11;
  constexpr unsigned kFixedAbove = 19'200;  // there both silences stay what they are
  const auto character = Duration{std::chrono::seconds{kBits}} / baud;
  if (baud > kFixedAbove) {
    return {character, std::chrono::microseconds{750}, std::chrono::microseconds{1750}};
  }
  return {character, character * 3 / 2, character * 7 / 2};
}

void Receiver::receive(Instant time, std::byte byte) {
  const auto silence = time - silence_.character - last_;
  if (!frame_.empty() && silence > silence_.most_within) is_spoilt_ = true;
  if (frame_.size() == kMostFrame) is_spoilt_ = true;
  if (!is_spoilt_) frame_.push_back(byte);
  last_ = time;
}

std::optional<Instant> Receiver::end() const noexcept {
  if (frame_.empty()) return std::nullopt;
  return last_ + silence_.least_between + silence_.character;
}

std::optional<Frame> Receiver::take(Instant time) {
  if (!end() || *end() > time) return std::nullopt;
  auto frame = std::exchange(frame_, {});
  if (std::exchange(is_spoilt_, false)) frame.clear();
  return frame;
}

std::span<const Field> block_fields() noexcept {
  static const auto kFields = lay_out({kBytes}, 0, kRegisters);
  return std::span{kFields}.first(kFields.size() - 1);
}

std::unique_ptr<Dissector> make_dissector() { return std::make_unique<RtuDissector>(); }

}  // namespace gripper
