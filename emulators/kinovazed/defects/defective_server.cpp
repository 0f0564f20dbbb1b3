// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/defects/defective_server.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace armjig::kinovazed::emulation {
namespace {

constexpr std::string_view kFail = "arm.fail.";
constexpr std::string_view kJoystick = "arm.joystick.";
constexpr std::string_view kPlace = "arm.at.";
/// Translation first, then the wrist.
constexpr std::array<std::string_view, 6> kAxisNames{"x",       "y",       "z",
                                                     "wrist-x", "wrist-y", "wrist-z"};
constexpr std::array<std::string_view, 6> kComponentNames{"x", "y", "z", "pitch", "yaw", "roll"};
constexpr std::array kComponents{&Pose::x,     &Pose::y,   &Pose::z,
                                 &Pose::pitch, &Pose::yaw, &Pose::roll};

/// A hand that is put somewhere, by one component in millionths.
template <class Arm>
bool put(Arm& arm, std::string_view component, std::int64_t value) {
  const auto place = find_word<std::size_t>(kComponentNames, component);
  if (!place) return false;
  constexpr double kMillion = 1e6;
  auto pose = arm.pose();
  pose.*kComponents[*place] = static_cast<float>(static_cast<double>(value) / kMillion);
  arm.set_pose(pose);
  return true;
}

constexpr std::array kInputs{
    DeviceInput{"restart", "any: a new process, and an arm that was just switched on"},
    DeviceInput{"arm.plugged", "0 or 1: its USB cable"},
    DeviceInput{"arm.fail.CALL", "so many of the next calls fail; -1: all, 0: none"},
    DeviceInput{"arm.mode", "what the arm says that it does, as a number of Kinova's"},
    DeviceInput{"arm.current", "of all joints together, in milliampere"},
    DeviceInput{"arm.held", "1: somebody holds its hand where it is, 0: it is let go"},
    DeviceInput{"arm.at.x", "puts its hand there, in micrometres"},
    DeviceInput{"arm.at.y", "micrometres"},
    DeviceInput{"arm.at.z", "micrometres"},
    DeviceInput{"arm.at.pitch", "microradians"},
    DeviceInput{"arm.at.yaw", "microradians"},
    DeviceInput{"arm.at.roll", "microradians"},
    DeviceInput{"arm.joystick.x", "its own joystick, -1000 to 1000: left and right"},
    DeviceInput{"arm.joystick.y", "-1000 to 1000: to the front and back"},
    DeviceInput{"arm.joystick.z", "-1000 to 1000: twisted, up and down"},
    DeviceInput{"arm.joystick.wrist-x", "-1000 to 1000: the same for the wrist"},
    DeviceInput{"arm.joystick.wrist-y", "-1000 to 1000"},
    DeviceInput{"arm.joystick.wrist-z", "-1000 to 1000"},
    DeviceInput{"arm.joystick.home", "1: its home button is held, 0: all of it is let go"},
};

}  // namespace

std::span<const DeviceInput> server_inputs() noexcept { return kInputs; }

DefectiveServer::DefectiveServer(Server server, std::vector<Quirk> quirks, Instant start)
    : fresh_{server},
      server_{std::move(server)},
      quirks_{std::move(quirks)},
      memories_(quirks_.size()),
      epoch_{start} {}

bool DefectiveServer::is_listening() const noexcept {
  return server_.life() == Server::Life::kRunning || server_.life() == Server::Life::kHung;
}

std::optional<ConnectionId> DefectiveServer::connect(Instant time) {
  if (!server_.connect(inner(time))) return std::nullopt;
  const auto id = next_id_++;
  open_.insert(id);
  for (std::size_t i = 0; i < quirks_.size(); ++i) {
    std::string greeting;
    if (quirks_[i].come) quirks_[i].come(greeting, memories_[i], open_.size());
    say(time, id, greeting);
  }
  return id;
}

void DefectiveServer::receive(Instant time, ConnectionId id, Bytes segment) {
  if (!is_known(id)) return;
  if (quirks_.empty()) return server_.receive(inner(time), id - first_id_, segment);
  std::string heard{as_text(segment)};
  for (std::size_t i = 0; i < quirks_.size(); ++i) {
    if (quirks_[i].hear) quirks_[i].hear(heard, memories_[i], server_.state());
  }
  server_.receive(inner(time), id - first_id_, std::as_bytes(std::span{heard}));
}

/// False: the process has never seen the client.
bool DefectiveServer::leave(Instant time, ConnectionId id) {
  if (!is_known(id)) return false;
  for (std::size_t i = 0; i < quirks_.size(); ++i) {
    std::string last_words;
    if (quirks_[i].leave) quirks_[i].leave(last_words, memories_[i]);
    if (last_words.empty()) continue;
    server_.receive(inner(time), id - first_id_, std::as_bytes(std::span{last_words}));
  }
  return true;
}

void DefectiveServer::half_close(Instant time, ConnectionId id) {
  if (leave(time, id)) server_.half_close(inner(time), id - first_id_);
}

void DefectiveServer::close(Instant time, ConnectionId id) {
  open_.erase(id);
  if (leave(time, id)) server_.close(inner(time), id - first_id_);
}

void DefectiveServer::reset(Instant time, ConnectionId id) {
  open_.erase(id);
  if (leave(time, id)) server_.reset(inner(time), id - first_id_);
}

std::size_t DefectiveServer::unread(ConnectionId id) const noexcept {
  return is_known(id) ? server_.unread(id - first_id_) : 0;
}

void DefectiveServer::advance_to(Instant time) {
  server_.advance_to(inner(time));
  take_sent(time);
}

std::optional<Instant> DefectiveServer::next_event() const noexcept {
  auto next = server_.next_event();
  if (next) *next += epoch_.time_since_epoch();
  if (!later_.empty() && (!next || later_.front().time < *next)) next = later_.front().time;
  return next;
}

void DefectiveServer::take_sent(Instant time) {
  for (const auto& event : server_.sent()) take(event);
  server_.clear_sent();
  const auto due = std::ranges::upper_bound(later_, time, {}, &ServerEvent::time);
  std::move(later_.begin(), due, std::back_inserter(sent_));
  later_.erase(later_.begin(), due);
}

void DefectiveServer::take(ServerEvent event) {
  event.time += epoch_.time_since_epoch();
  event.connection += first_id_;
  if (event.kind != SessionEvent::Kind::kData) {
    open_.erase(event.connection);
    later_.insert(std::ranges::upper_bound(later_, event.time, {}, &ServerEvent::time), event);
    return;
  }
  Saying saying{.text = std::string{as_text(event.bytes)}, .time = event.time};
  for (std::size_t i = 0; i < quirks_.size(); ++i) {
    if (quirks_[i].say) quirks_[i].say(saying, memories_[i], server_.state());
  }
  say(event.time + saying.delay, event.connection, saying.text);
}

void DefectiveServer::say(Instant time, ConnectionId id, std::string_view text) {
  if (text.empty()) return;
  const auto bytes = std::as_bytes(std::span{text});
  later_.insert(std::ranges::upper_bound(later_, time, {}, &ServerEvent::time),
                {time, id, SessionEvent::Kind::kData, {bytes.begin(), bytes.end()}});
}

bool DefectiveServer::set_input(Instant time, std::string_view name, std::int64_t value) {
  if (name == "restart") {
    restart(time);
    return true;
  }
  bool is_known = false;
  server_.touch(inner(time), [&](ArmPort& arm) { is_known = set_arm(arm, name, value); });
  take_sent(time);
  return is_known;
}

std::vector<std::string> DefectiveServer::take_log() {
  std::vector<std::string> lines;
  for (const auto& line : server_.log()) lines.push_back(line.text);
  server_.clear_log();
  return lines;
}

void DefectiveServer::restart(Instant time) {
  for (const auto id : open_) later_.push_back({time, id, SessionEvent::Kind::kReset, {}});
  open_.clear();
  server_ = fresh_;
  memories_.assign(quirks_.size(), {});
  by_hand_ = {};
  epoch_ = time;
  first_id_ = next_id_;
}

bool DefectiveServer::set_arm(ArmPort& arm, std::string_view name, std::int64_t value) {
  if (name.starts_with(kFail)) {
    const auto call = find_word<ArmCall>(kArmCallNames, name.substr(kFail.size()));
    if (!call) return false;
    arm.fail(*call, {.skip = 0, .count = static_cast<int>(value)});
    return true;
  }
  if (name == "arm.plugged") {
    value == 0 ? arm.unplug() : arm.plug();
    return true;
  }
  if (name.starts_with(kJoystick)) {
    return set_joystick(arm.plant(), name.substr(kJoystick.size()), value);
  }
  return std::visit(
      [&](auto& plant) {
        if (name == "arm.mode") plant.set_mode(static_cast<ArmMode>(value));
        if (name == "arm.current") plant.set_current_sum(static_cast<float>(value) / 1000);
        if (name == "arm.held") plant.hold(value != 0);
        if (name.starts_with(kPlace)) return put(plant, name.substr(kPlace.size()), value);
        return name == "arm.mode" || name == "arm.current" || name == "arm.held";
      },
      arm.plant());
}

bool DefectiveServer::set_joystick(Plant& plant, std::string_view name, std::int64_t value) {
  auto* const arm = std::get_if<JacoArm>(&plant);
  if (arm == nullptr) return false;
  if (name == "home") {
    by_hand_ = {};
    value == 0 ? arm->let_go_by_hand() : arm->press_home_by_hand();
    return true;
  }
  const auto axis = find_word<std::size_t>(kAxisNames, name);
  if (!axis) return false;
  constexpr std::int64_t kFull = 1000;
  const auto deflection =
      static_cast<float>(std::clamp(value, -kFull, kFull)) / static_cast<float>(kFull);
  (*axis < 3 ? by_hand_.translation[*axis] : by_hand_.wrist[*axis - 3]) = deflection;
  arm->move_by_hand(by_hand_);
  return true;
}

}  // namespace armjig::kinovazed::emulation
