// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/support/hosted_replay.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "cli/device.hpp"
#include "cli/devices/devices.hpp"
#include "emulators/host/host.hpp"
#include "emulators/lab/i2c_adapter.hpp"
#include "emulators/memory/clocked.hpp"
#include "emulators/memory/in_memory.hpp"
#include "emulators/replay/host_role.hpp"
#include "emulators/sessions/dice.hpp"
#include "harness/capture/trace.hpp"
#include "harness/compare/likeness.hpp"
#include "harness/compare/recording_diff.hpp"
#include "harness/link/port_around.hpp"
#include "harness/link/real_streams.hpp"
#include "harness/link/tcp_session.hpp"
#include "harness/link/transaction_bus.hpp"

namespace armjig::testing {
namespace {

using Records = std::vector<KeptRecord>;

/// Beyond what the device's rules for live ones forgive: this machine may be busy.
constexpr Duration kTimes = std::chrono::milliseconds{250};
/// A host that is not late by more is in time.
constexpr Duration kLate = std::chrono::milliseconds{3};
/// In steps/s: what a ramp does meanwhile.
constexpr double kSpeeds = 1500;

/// What the hand does goes to the host, everything else over the link.
template <class Around>
class Touched final : public Around {
 public:
  template <class... Arguments>
  explicit Touched(Host& host, Arguments&&... arguments)
      : Around{std::forward<Arguments>(arguments)...}, host_{host} {}

  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override {
    std::promise<bool> told;
    host_.set_input(std::string{input}, value,
                    [&told](bool is_taken) { told.set_value(is_taken); });
    return told.get_future().get();
  }

 private:
  Host& host_;
};

class StreamOnLink : public StreamAround {
 public:
  using StreamAround::StreamAround;
  Result<std::size_t> read(std::span<std::byte> buffer, Instant deadline) override {
    return inner().read(buffer, deadline);
  }
  Result<void> write(Bytes bytes) override { return inner().write(bytes); }
};

class ServerOnLink : public SourceAround {
 public:
  explicit ServerOnLink(std::unique_ptr<SessionSource> inner)
      : SourceAround{std::move(inner), [](auto port) { return port; }} {}
};

class BusOnAdapter : public RealBus {
 public:
  explicit BusOnAdapter(I2cAdapter& adapter) : adapter_{adapter} {}
  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    const auto error = adapter_.transfer(messages);
    if (error == ENXIO) return Transfer::kAddressRefused;
    if (error == EIO) return Transfer::kByteRefused;
    if (error != 0) return tl::unexpected{error_from_errno(error)};
    return Transfer::kDone;
  }

 private:
  I2cAdapter& adapter_;
};

/// Runs until its owner goes.
class RunningHost {
 public:
  explicit RunningHost(Host host) : host_{std::move(host)}, thread_{[this] { host_.run(); }} {}
  RunningHost(const RunningHost&) = delete;
  RunningHost& operator=(const RunningHost&) = delete;
  ~RunningHost() {
    host_.stop();
    thread_.join();
  }
  [[nodiscard]] Host& host() noexcept { return host_; }
  /// Where it is, without the scheme.
  [[nodiscard]] std::string address() const {
    const auto target = host_.targets().front();
    return target.substr(target.find(':') + 1);
  }

 private:
  Host host_;
  std::thread thread_;
};

/// Over a pseudo-terminal.
Outcome<Played> play_to(std::unique_ptr<HostedStream> device, const Records& records,
                        const PlayHow& how) {
  HostOptions options;
  options.pty.emplace();
  auto host = Host::open(std::move(device), std::move(options));
  if (!host) return tl::unexpected{host.error()};
  RunningHost running{*std::move(host)};
  auto port = open_pty(running.address(), {});
  if (!port) return tl::unexpected{port.error()};
  Touched<StreamOnLink> touched{running.host(), *std::move(port)};
  return play_host(touched, records, how);
}

/// Over TCP.
Outcome<Played> play_to(std::unique_ptr<HostedServer> device, const Records& records,
                        const PlayHow& how) {
  const auto listening = wait_until_listening(*device);
  HostOptions options;
  options.tcp.emplace();
  auto host = Host::open(put_on_clock(std::move(device), {.begin = listening}), std::move(options));
  if (!host) return tl::unexpected{host.error()};
  RunningHost running{*std::move(host)};
  auto source = open_tcp_server(running.address());
  if (!source) return tl::unexpected{source.error()};
  Touched<ServerOnLink> touched{running.host(), *std::move(source)};
  return play_host(touched, records, how);
}

/// Over an adapter that does whole transactions, as the kernel shows it.
Outcome<Played> play_to(std::unique_ptr<HostedBus> device, const Records& records,
                        const PlayHow& how) {
  auto host = Host::open(std::move(device), {});
  if (!host) return tl::unexpected{host.error()};
  RunningHost running{*std::move(host)};
  I2cAdapter adapter{running.host()};
  Touched<BusOnAdapter> touched{running.host(), adapter};
  return play_host(touched, records, how);
}

/// A bus in memory that does as the adapter does.
class BusInMemory final : public TransactionBus {
 public:
  explicit BusInMemory(std::unique_ptr<BusPort> bus) : bus_{std::move(bus)} {}
  [[nodiscard]] Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    return bus_->transfer(messages);
  }
  Result<void> recover() override { return bus_->recover(); }
  void wait_until(Instant time) override { bus_->wait_until(time); }
  [[nodiscard]] Instant now() const override { return bus_->now(); }
  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override {
    return bus_->touch(input, value);
  }

 private:
  std::unique_ptr<BusPort> bus_;
};

Outcome<Played> play_in_memory(std::unique_ptr<HostedStream> device, const Records& records,
                               const PlayHow& how) {
  return play_host(*open_in_memory(std::move(device)), records, how);
}

Outcome<Played> play_in_memory(std::unique_ptr<HostedServer> device, const Records& records,
                               const PlayHow& how) {
  const auto listening = wait_until_listening(*device);
  return play_host(*open_in_memory(put_on_clock(std::move(device), {.begin = listening})), records,
                   how);
}

Outcome<Played> play_in_memory(std::unique_ptr<HostedBus> device, const Records& records,
                               const PlayHow& how) {
  BusInMemory bus{open_in_memory(std::move(device))};
  return play_host(bus, records, how);
}

template <class Play>
Outcome<Played> play(const cli::Device& device, const Trace& trace, Play play) {
  return std::visit(
      [&](const auto& kind) -> Outcome<Played> {
        auto hosted = kind.set_up(trace);
        if (!hosted) return tl::unexpected{hosted.error()};
        return play(*std::move(hosted));
      },
      device.port);
}

/// What the host does, each thing later by up to `most`; the parts of a transaction stay together.
Records delayed(Records records, Duration most, sessions::Dice& dice) {
  Duration delay{};
  Instant last{};
  bool is_within = false;
  for (auto& record : records) {
    if (!is_within) delay = Duration{dice.between(0, most.count())};
    is_within = record.kind == LinkKind::kBus && !has_stop(record);
    record.time = std::max(last, record.time + delay);
    last = record.time;
  }
  return records;
}

/// Of the link and beside it, and the links themselves.
struct Talk {
  std::optional<CaptureLink> link;
  CaptureLink events{.name = "events", .device = {}, .kind = LinkKind::kEvents};
  Records records;
};

bool is_of_the_link(LinkKind kind) { return kind != LinkKind::kEvents && kind != LinkKind::kCan; }

Outcome<Talk> read_talk(const std::string& path) {
  auto file = UserFile::open(path);
  if (!file) return tl::unexpected{file.error()};
  const auto reader = CaptureReader::open(*std::move(file), path);
  if (!reader) return tl::unexpected{reader.error()};
  Talk talk;
  const auto read = for_each_record(**reader, [&](const CaptureRecord& record) -> Outcome<void> {
    if (is_of_the_link(record.link->kind)) talk.link = *record.link;
    talk.records.push_back(KeptRecord::from(record));
    return {};
  });
  if (!read) return tl::unexpected{read.error()};
  return talk;
}

RecordedMessages messages_of(const Talk& talk, const cli::Device& device, const Records& records) {
  RecordedMessages messages{[&device](std::string_view) { return device.make_dissector; }};
  for (const auto& record : records) {
    (void)messages.add(record.on(record.kind == LinkKind::kEvents ? talk.events : *talk.link));
  }
  messages.finish();
  return messages;
}

/// Whether the other side says what it should, too, a little earlier or later: between two frames a
/// stage may end once before and once after one of them.
bool is_said_nearby(const RecordedMessage* said, const std::vector<RecordedMessage>& others,
                    const Likeness& likeness) {
  return said == nullptr || std::ranges::any_of(others, [&](const RecordedMessage& other) {
           return likeness.is_in_time(*said, other) && likeness.has_same_content(*said, other);
         });
}

bool is_only_a_frame_off(const RecordingDifference& one, const RecordedMessages& before,
                         const RecordedMessages& after, const Likeness& likeness) {
  const auto recorded = before.lanes().find(one.lane);
  const auto heard = after.lanes().find(one.lane);
  return recorded != before.lanes().end() && heard != after.lanes().end() &&
         is_said_nearby(one.before, heard->second, likeness) &&
         is_said_nearby(one.after, recorded->second, likeness);
}

/// A message of a recording: its lane, and how many came before it there.
using Place = std::pair<std::string, std::size_t>;

Place place_of(const RecordingDifference& one, const RecordedMessages& recorded) {
  const auto& lane = recorded.lanes().at(one.lane);
  return {one.lane, static_cast<std::size_t>(one.before - lane.data())};
}

/// What comes after the end is in no recording, and a host that ends a connection hears no more.
bool is_at_an_end(const RecordingDifference& one, const Played& played, Instant end,
                  Duration tolerance) {
  if (one.change == Change::kExtra) return one.time() + tolerance > end;
  return one.change == Change::kMissing && std::ranges::any_of(played.ends, [&](const auto& ended) {
           return one.time() <= ended.second && ended.second <= one.time() + tolerance;
         });
}

std::string text_of(const RecordingDifference& one) {
  std::string text = fmt::format("{} us {} {}", microseconds(one.time()), to_string(one.change),
                                 (one.before != nullptr ? one.before : one.after)->message.name);
  for (const auto& what : one.what) text += "; " + what;
  return text;
}

/// What a host that is a little late leaves open.
struct Open {
  std::set<Place> places;  ///< the device says something else there, or nothing
  std::map<std::string, std::set<Instant>> extra;  ///< what it may say besides, by lane and name

  void add(const RecordingDifference& one, const RecordedMessages& recorded) {
    if (one.before != nullptr) {
      places.insert(place_of(one, recorded));
    } else {
      extra[name_of(one)].insert(one.time());
    }
  }
  [[nodiscard]] bool has(const RecordingDifference& one, const RecordedMessages& recorded) const {
    if (one.before != nullptr) return places.contains(place_of(one, recorded));
    const auto found = extra.find(name_of(one));
    if (found == extra.end()) return false;
    const auto next = found->second.lower_bound(one.time() - kTimes);
    return next != found->second.end() && *next <= one.time() + kTimes;
  }

 private:
  static std::string name_of(const RecordingDifference& one) {
    return fmt::format("{} {}", one.lane, one.after->message.name);
  }
};

/// Found out in virtual time, since on a real link a host always is a little late.
Outcome<Open> left_open(const cli::Device& device, const Trace& trace, const Talk& talk,
                        const ComparisonRules& rules, const PlayHow& how) {
  constexpr std::uint64_t kTries = 200;
  Open open;
  for (std::uint64_t seed = 1; seed <= kTries; ++seed) {
    sessions::Dice dice{seed};
    const auto records = delayed(talk.records, kLate, dice);
    const auto played = play(device, trace, [&](auto hosted) {
      return play_in_memory(std::move(hosted), records, how);
    });
    if (!played) return tl::unexpected{played.error()};
    const auto before = messages_of(talk, device, played->expected);
    const auto after = messages_of(talk, device, played->actual);
    for (const auto& one : diff(before, after, rules)) open.add(one, before);
  }
  return open;
}

Outcome<HostedReplay> replay_once(std::string_view name, const std::string& file) {
  const auto& device = **cli::find_device(cli::shipped_devices(), name);
  const auto trace = read_trace(file);
  if (!trace) return tl::unexpected{trace.error()};
  const auto talk = read_talk(file);
  if (!talk) return tl::unexpected{talk.error()};
  auto rules = ComparisonRules::parse(device.live_rules, "live rules");
  if (!rules) return tl::unexpected{rules.error()};
  rules->time_tolerance = kTimes;
  rules->ignored_messages.emplace_back("events");
  for (const auto name_of_joint :
       {"speed.j1", "speed.j2", "speed.j3", "speed.j4", "speed.j5", "speed.j6"}) {
    rules->fields.push_back({.message = {}, .name = name_of_joint, .tolerance = kSpeeds});
  }
  if (!talk->link) return HostedReplay{};
  const PlayHow how{.touches_of = device.replay.touches_of, .trailing = kTimes};
  const auto played = play(
      device, *trace, [&](auto hosted) { return play_to(std::move(hosted), talk->records, how); });
  if (!played) return tl::unexpected{played.error()};
  const auto before = messages_of(*talk, device, played->expected);
  const auto after = messages_of(*talk, device, played->actual);
  auto found = diff(before, after, *rules);
  const auto end = talk->records.back().time;
  const Likeness likeness{*rules};
  std::erase_if(found, [&](const RecordingDifference& one) {
    return is_at_an_end(one, *played, end, kTimes) ||
           is_only_a_frame_off(one, before, after, likeness);
  });
  if (!found.empty()) {
    const auto open = left_open(device, *trace, *talk, *rules, how);
    if (!open) return tl::unexpected{open.error()};
    std::erase_if(found, [&](const RecordingDifference& one) { return open->has(one, before); });
  }
  return HostedReplay{before.count(), found.size(), found.empty() ? "" : text_of(found.front())};
}

}  // namespace

const std::vector<std::string_view>& recorded_devices() {
  static const std::vector<std::string_view> kNames{"parol6", "kinovazed", "morap"};
  return kNames;
}

Outcome<HostedReplay> replay_hosted(std::string_view device, const std::string& file) {
  auto best = replay_once(device, file);
  for (int i = 0; i < 2 && best && best->differences > 0; ++i) {
    auto again = replay_once(device, file);
    if (!again || again->differences < best->differences) best = std::move(again);
  }
  return best;
}

}  // namespace armjig::testing
