// SPDX-License-Identifier: Apache-2.0
#include "gripper.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace gripper {

using namespace armjig;

namespace {

constexpr auto kDefects = std::to_array<Named<std::string_view>>({
    {"crc-order", "Framing"},
    {"crc-ignored", "Framing"},
    {"gap-ignored", "Framing"},
    {"gap-fatal", "Framing"},
    {"no-silence", "Framing"},
    {"short-silence", "Framing"},
    {"long-silence", "Framing"},
    {"answers-others", "Addressing"},
    {"obeys-others", "Addressing"},
    {"answers-broadcast", "Addressing"},
    {"ignores-broadcast", "Addressing"},
    {"register-off-by-one", "Functions"},
    {"register-more", "Functions"},
    {"register-less", "Functions"},
    {"write-lost", "Functions"},
    {"first-only", "Functions"},
    {"writes-part", "Exceptions"},
    {"writes-status", "Exceptions"},
    {"reads-126", "Exceptions"},
    {"count-zero", "Exceptions"},
    {"byte-count", "Exceptions"},
    {"length", "Exceptions"},
    {"no-exception", "Exceptions"},
    {"no-exception-bit", "Exceptions"},
    {"wrong-exception", "Exceptions"},
    {"address-first", "Exceptions"},
    {"checks-values", "Exceptions"},
    {"no-failure", "Exceptions"},
    {"control-first", "Motion"},
    {"stuck-jaws", "Motion"},
    {"half-speed", "Motion"},
    {"no-arrival", "Motion"},
    {"no-stop", "Motion"},
    {"no-object", "Motion"},
    {"no-force", "Motion"},
});

constexpr std::array kInputs{DeviceInput{"object", "its width in 0.1 mm, up to 1000; 0: none"},
                             DeviceInput{"jam", "0 or 1: whether the jaws cannot move"}};

constexpr std::size_t kPlain = 6;  ///< address, function and two words
constexpr std::size_t kMany = 7;   ///< the same and the number of bytes that follow
constexpr std::size_t kCrc = 2;

unsigned word(Bytes request, std::size_t place) { return load_u16_be(slice<2>(request, place)); }

Silence with(const Defects& defects, Silence silence) {
  const auto has = [&](std::string_view defect) { return defects.contains(defect); };
  if (has("gap-ignored") || has("no-silence")) silence.most_within = silence.least_between;
  if (has("gap-fatal")) silence.most_within = silence.character / 2;
  if (has("short-silence")) silence.least_between = silence.most_within;
  if (has("long-silence")) silence.least_between *= 3;
  return silence;
}

struct Settings {
  bool is_documented{};
  Defects defects;
  std::vector<Fault> faults;
};

constexpr std::array kTable{
    DeviceOption<Settings>{{"profile", "firmware|documented", "there is one device: both are it"},
                           [](Settings& settings, const OptionValue& value) {
                             return value.choose(settings.is_documented, {false, true});
                           }},
    DeviceOption<Settings>{
        {"fault", "FAULT,...", "names of `conformance mutants --list`, or KIND:FIELD of replies"},
        [](Settings& settings, const OptionValue& value) {
          return value.take_each([&](std::string_view text) -> Outcome<void> {
            if (find_named(defects(), text) != nullptr) {
              settings.defects.emplace(text);
              return {};
            }
            return parse_fault(text, block_fields()).map([&](const Fault& fault) {
              settings.faults.push_back(fault);
            });
          });
        }},
};
constexpr auto kRows = rows_of(kTable);

}  // namespace

std::span<const Named<std::string_view>> defects() noexcept { return kDefects; }
std::span<const DeviceInput> Gripper::inputs() noexcept { return kInputs; }

void Gripper::receive(Instant time, Bytes request) {
  const bool is_broadcast = request[0] == std::byte{kBroadcast};
  if (is_broadcast && has("ignores-broadcast")) return;
  Frame reply{request[0], request[1]};
  auto exception = act(time, request, reply);
  if (is_broadcast && !has("answers-broadcast")) return;
  if (exception != Exception::kNone) {
    if (has("no-exception")) return;
    const bool is_wrong = has("wrong-exception") && exception == Exception::kAddress;
    if (is_wrong) exception = Exception::kValue;
    const auto bit = has("no-exception-bit") ? std::byte{} : kExceptionBit;
    reply = {request[0], request[1] | bit, static_cast<std::byte>(exception)};
  }
  due_.push_back({time + kReplyDelay, std::move(reply)});
}

void Gripper::advance_to(Instant time) {
  for (; !due_.empty() && due_.front().time <= time; due_.pop_front()) {
    sent_.push_back(std::move(due_.front()));
  }
}

std::optional<Instant> Gripper::next_event() const noexcept {
  return due_.empty() ? std::nullopt : std::optional{due_.front().time};
}

bool Gripper::set_input(Instant /*time*/, std::string_view name, std::int64_t value) {
  const bool is_object = name == "object" && value >= 0 && value <= kWidest;
  const bool is_jam = name == "jam" && (value == 0 || value == 1);
  if (is_object) object_ = static_cast<unsigned>(value);
  if (is_jam) is_jammed_ = value == 1;
  return is_object || is_jam;
}

Exception Gripper::act(Instant time, Bytes request, Frame& reply) {
  const auto has_size = [&](std::size_t size) {
    return request.size() == size || (request.size() > size && has("length"));
  };
  switch (static_cast<Function>(request[1])) {
    case Function::kRead:
      return has_size(kPlain) ? read(time, request, reply) : Exception::kValue;
    case Function::kWrite:
      if (!has_size(kPlain)) return Exception::kValue;
      reply.assign(request.begin(), request.end());  // an echo
      return has("write-lost") ? Exception::kNone
                               : store(time, word(request, 2), request.subspan(4));
    case Function::kWriteMany: {
      if (request.size() < kMany) return Exception::kValue;
      const auto count = word(request, 4);
      const auto bytes = std::to_integer<std::size_t>(request[kMany - 1]);
      const bool fits = bytes == std::size_t{2} * count || has("byte-count");
      const bool has_some = count > 0 || has("count-zero");
      if (!fits || !has_some || count > kMostWritten || !has_size(kMany + bytes))
        return Exception::kValue;
      reply.assign(request.begin(), request.begin() + kPlain);
      return store(time, word(request, 2), request.subspan(kMany, bytes));
    }
  }
  return Exception::kFunction;
}

Exception Gripper::read(Instant time, Bytes request, Frame& reply) const {
  const auto first = word(request, 2) + one("register-off-by-one");
  const auto count = word(request, 4);
  const bool is_there = first + count <= kRegisters + one("register-more") - one("register-less");
  const bool has_some = count > 0 || has("count-zero");
  if (has("address-first") && !is_there) return Exception::kAddress;
  if (!has_some || count > kMostRead + one("reads-126")) return Exception::kValue;
  if (!is_there) return Exception::kAddress;
  reply.push_back(static_cast<std::byte>(2 * count));
  for (auto i = first; i < first + count; ++i) append(reply, value(i, time));
  return Exception::kNone;
}

Exception Gripper::store(Instant time, unsigned first, Bytes words) {
  first += one("register-off-by-one");
  const auto end = first + words.size() / 2;
  const bool is_allowed = end <= kStatus || (has("writes-status") && end <= kRegisters);
  if (!is_allowed && !has("writes-part")) return Exception::kAddress;
  bool is_control_written = false;
  for (auto i = first; i < std::min<std::size_t>(end, kStatus); ++i) {
    const auto value = word(words, std::size_t{2} * (i - first));
    if (i == kTarget && value > kWidest && has("checks-values")) return Exception::kValue;
    if (i == kControl && value != 0 && is_jammed_ && !has("no-failure")) return Exception::kFailure;
    settings_[i] = value;
    is_control_written = is_control_written || i == kControl;
    if (i == kControl && has("control-first")) control(time);
    if (has("first-only")) break;
  }
  if (is_control_written && !has("control-first")) control(time);
  return is_allowed ? Exception::kNone : Exception::kAddress;
}

/// Does what the registers say now.
void Gripper::control(Instant time) {
  const auto here = position(time);
  if (settings_[kControl] == 0) {
    if (!has("no-stop")) move_ = {here, here, 1, time, Status::kStopped};
    return;
  }
  const auto target = std::min(settings_[kTarget], kWidest);
  const bool holds = object_ > target && object_ <= here && !has("no-object");
  move_ = {here, holds ? object_ : target, std::max(settings_[kSpeed], 1U), time,
           holds ? Status::kHolding : Status::kArrived};
}

unsigned Gripper::position(Instant time) const {
  if (has("stuck-jaws")) return move_.from;
  constexpr Duration kLongest = std::chrono::seconds{kWidest};  // at the speed 1
  const auto speed = has("half-speed") ? move_.speed / 2 : move_.speed;
  const auto elapsed = std::min(time - move_.start, kLongest);
  const auto way = static_cast<unsigned>(speed * elapsed / std::chrono::seconds{1});
  if (move_.to < move_.from) return move_.from - std::min(way, move_.from - move_.to);
  return move_.from + std::min(way, move_.to - move_.from);
}

Status Gripper::status(Instant time) const {
  if (has("no-arrival") && move_.end == Status::kArrived) return Status::kMoving;
  return position(time) == move_.to ? move_.end : Status::kMoving;
}

unsigned Gripper::value(unsigned place, Instant time) const {
  const bool holds = status(time) == Status::kHolding && !has("no-force");
  if (place < kStatus) return settings_[place];
  if (place == kStatus) return static_cast<unsigned>(status(time));
  if (place == kPosition) return position(time);
  if (place == kGripForce) return holds ? settings_[kForce] : 0;
  return kModelNumber;
}

Unit::Unit(std::uint8_t address, unsigned baud, Defects defects, std::vector<Fault> faults)
    : gripper_{Gripper{defects}, std::move(faults), 1},
      address_{address},
      defects_{std::move(defects)},
      receiver_{with(defects_, Silence::at(baud))} {}

void Unit::receive(Instant time, Bytes bytes) {
  for (const auto byte : bytes) {
    advance_to(time);
    receiver_.receive(time, byte);
    const auto frame = receiver_.pending();
    const bool is_whole = size_of(Direction::kToDevice, frame) == frame.size();
    if (has("no-silence") && is_whole) take(time, *receiver_.take(Instant::max()));
  }
}

void Unit::advance_to(Instant time) {
  const auto end = receiver_.end();
  if (const auto frame = receiver_.take(time)) take(*end, *frame);
  gripper_.advance_to(time);
  for (auto [when, bytes] : gripper_.sent()) {
    append_crc(bytes);
    if (has("crc-order")) std::swap(bytes.end()[-1], bytes.end()[-2]);
    sent_.push_back({when, std::move(bytes)});
  }
  gripper_.clear_sent();
}

std::optional<Instant> Unit::next_event() const {
  const auto end = receiver_.end();
  const auto reply = gripper_.next_event();
  return end && reply ? std::min(end, reply) : std::max(end, reply);
}

void Unit::take(Instant time, Frame frame) {
  const bool is_good = has_good_crc(frame) || (frame.size() > kCrc + 1 && has("crc-ignored"));
  if (!is_good) return;
  const auto unit = std::to_integer<std::uint8_t>(frame[0]);
  const bool is_for_other = unit != address_ && unit != kBroadcast;
  if (is_for_other && has("obeys-others")) frame[0] = std::byte{kBroadcast};
  if (is_for_other && !has("obeys-others") && !has("answers-others")) return;
  gripper_.receive(time, Bytes{frame}.first(frame.size() - kCrc));
}

std::span<const OptionRow> options() noexcept { return kRows; }

Outcome<Unit> make(const DeviceOptions& options, const std::string& where, unsigned baud) {
  return read_options("gripper", kTable, options, where, Settings{}).map([&](Settings settings) {
    return Unit{kUnit, baud, std::move(settings.defects), std::move(settings.faults)};
  });
}

Outcome<Replayed> replay(const Trace& trace) {
  Replayed replayed;
  Unit unit{kUnit, kUsualBaud};
  for (const auto& event : trace.events) {
    unit.advance_to(event.time);
    if (event.dir == "to_device") unit.receive(event.time, event.bytes);
    if (event.dir == "from_device") replayed.recorded.push_back(event);
  }
  for (const auto& reply : unit.sent()) {
    TraceEvent event;
    event.time = at(std::chrono::microseconds{microseconds(reply.time)});  // as recordings have it
    event.dir = "from_device";
    event.bytes = reply.bytes;
    replayed.actual.push_back(std::move(event));
  }
  return replayed;
}

}  // namespace gripper
