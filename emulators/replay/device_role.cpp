// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/device_role.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "emulators/i2c/bus.hpp"

namespace armjig {
namespace {

constexpr std::byte kNothingDriven{0xFF};

bool is_by_device(const KeptRecord& record) {
  if (record.kind != LinkKind::kEvents) return record.direction == Direction::kFromDevice;
  return what_of(record) == "disconnect" && text_in(record, "text").starts_with("device-");
}

/// What a host did beside its bytes: it connected, or ended a connection.
bool is_border(const KeptRecord& record) {
  if (record.kind != LinkKind::kEvents) return false;
  const auto what = what_of(record);
  return what == "connect" || what == "disconnect";
}

/// Not what else was done to the device.
bool is_on_the_link(const KeptRecord& record) {
  return record.kind == LinkKind::kEvents ? is_border(record) : record.kind != LinkKind::kCan;
}

KeptRecord border(Instant time, std::uint32_t id, std::string_view what, std::string_view text) {
  return {.time = time,
          .kind = LinkKind::kEvents,
          .details = fmt::format(R"("dir":"{}","conn":{},"text":"{}")", what, id, text)};
}

/// Counts whole messages of one connection.
class Counter {
 public:
  explicit Counter(MakeDissector make) : dissector_{make()} {}
  /// Those that these bytes complete.
  std::size_t add(Instant time, Bytes bytes) {
    std::vector<Message> messages;
    dissector_->feed(Direction::kToDevice, time, bytes, messages);
    return static_cast<std::size_t>(
        std::ranges::count_if(messages, [](const Message& one) { return one.fault.empty(); }));
  }

 private:
  std::unique_ptr<Dissector> dissector_;
};

std::uint32_t connection_of(const KeptRecord& record) {
  return record.kind == LinkKind::kEvents ? static_cast<std::uint32_t>(number_in(record, "conn", 0))
                                          : record.id;
}

/// A record to play, or to wait for.
struct TalkStep {
  KeptRecord record;
  std::size_t awaited{};        ///< of the host: so many messages and borders of its connection
  std::size_t awaited_bytes{};  ///< so many bytes, too, if no message ends with it
};

/// How much the host of a recording has said by each of its records.
class HostWords {
 public:
  explicit HostWords(MakeDissector make_dissector) : make_dissector_{make_dissector} {}

  void count(TalkStep& step) {
    const auto& record = step.record;
    auto& [counter, messages, bytes] =
        said_.try_emplace(connection_of(record), Said{Counter{make_dissector_}}).first->second;
    if (is_border(record)) {
      ++messages;
    } else {
      const auto whole = counter.add(record.time, record.bytes);
      messages += whole;
      bytes += record.bytes.size();
      if (whole == 0) step.awaited_bytes = bytes;
    }
    step.awaited = messages;
  }

 private:
  struct Said {
    Counter counter;
    std::size_t messages{};
    std::size_t bytes{};
  };

  MakeDissector make_dissector_;
  std::map<std::uint32_t, Said> said_;  ///< by connection
};

/// The recording on its way: what is said next, and what is waited for before.
class Talk {
 public:
  Talk(std::vector<KeptRecord> records, const DeviceRole& role) : role_{role} {
    HostWords words{role.make_dissector};
    for (auto& record : records) {
      if (!is_on_the_link(record)) {
        leave_out(record);
        continue;
      }
      TalkStep step{std::move(record)};
      if (!is_by_device(step.record)) {
        words.count(step);
        expect(step.record);
      }
      steps_.push_back(std::move(step));
    }
    if (!steps_.empty()) recorded_anchor_ = steps_.front().record.time;
  }

  [[nodiscard]] std::shared_ptr<const HostSaid> said() const { return said_; }

  /// The host has said these bytes on that connection.
  void hear(Instant now, KeptRecord like, Bytes bytes) {
    const auto whole =
        counters_.try_emplace(like.id, role_.make_dissector).first->second.add(now, bytes);
    auto& [moments, marks] = heard_[like.id];
    moments.insert(moments.end(), whole, now);
    marks.emplace_back((marks.empty() ? 0 : marks.back().first) + bytes.size(), now);
    has_heard_ = has_heard_ || whole > 0;
    like.bytes.assign(bytes.begin(), bytes.end());
    keep(now, std::move(like));
  }
  /// It has begun or ended that connection.
  void note_border(Instant now, std::uint32_t id, std::string_view what, std::string_view text) {
    const bool is_counted = what != "connect" || recorded_begins_.contains(id);
    if (is_counted) heard_[id].moments.push_back(now);
    has_heard_ = true;
    keep(now, border({}, id, what, text));
  }

  /// Everything up to that time.
  template <class Speak>
  void advance_to(Instant now, Speak speak) {
    if (!has_begun_) {
      has_begun_ = true;
      anchor_ = now;
    }
    while (next_ < steps_.size()) {
      const auto& step = steps_[next_];
      const auto due = due_of(step);
      if (is_by_device(step.record)) {
        if (due > now) return;
        spoken_ = std::max(spoken_, due);
        speak(spoken_, step.record);
      } else if (const auto came = arrival_of(step)) {
        set_anchor(*came, step);
      } else if (has_heard_ && due + role_.patience <= now) {
        ++said_->not_awaited;
        set_anchor(due + role_.patience, step);
      } else {
        return;
      }
      ++next_;
    }
  }

  [[nodiscard]] std::optional<Instant> next_event() const {
    if (!has_begun_) return std::nullopt;
    if (next_ == steps_.size()) return end();
    const auto& step = steps_[next_];
    if (is_by_device(step.record)) return due_of(step);
    if (const auto came = arrival_of(step)) return std::max(*came, anchor_);
    if (!has_heard_) return std::nullopt;  // its first word may come at any time
    return due_of(step) + role_.patience;
  }
  [[nodiscard]] bool is_over(Instant now) const {
    return has_begun_ && next_ == steps_.size() && now >= end();
  }
  /// Whether the recording's connection of that number began or ended so: `refused`.
  [[nodiscard]] bool has_end(std::uint32_t id, std::string_view how) const {
    return std::ranges::any_of(steps_, [&](const TalkStep& step) {
      return is_border(step.record) && connection_of(step.record) == id &&
             text_in(step.record, "text") == how;
    });
  }

 private:
  struct Heard {
    std::vector<Instant> moments;                        ///< of messages and borders
    std::vector<std::pair<std::size_t, Instant>> bytes;  ///< so many bytes by then
  };

  /// Of the host, in the words in which it is heard.
  void expect(const KeptRecord& record) {
    if (!is_border(record)) {
      said_->expected.push_back(record);
      return;
    }
    const auto id = connection_of(record);
    const auto what = what_of(record);
    if (what == "connect") recorded_begins_.insert(id);
    said_->expected.push_back(border(record.time, id, what, text_in(record, "text")));
  }
  [[nodiscard]] Duration scaled(Duration recorded) const {
    if (role_.speed == 1) return recorded;
    return std::chrono::duration_cast<Duration>(std::chrono::duration<double>{recorded} /
                                                role_.speed);
  }
  [[nodiscard]] Instant due_of(const TalkStep& step) const {
    return anchor_ + scaled(step.record.time - recorded_anchor_);
  }
  [[nodiscard]] Instant end() const { return std::max(spoken_, anchor_) + scaled(role_.trailing); }

  /// When all of it had come.
  [[nodiscard]] std::optional<Instant> arrival_of(const TalkStep& step) const {
    const auto heard = heard_.find(connection_of(step.record));
    if (heard == heard_.end()) return std::nullopt;
    const auto& [moments, bytes] = heard->second;
    if (moments.size() < step.awaited) return std::nullopt;
    const auto came = std::ranges::lower_bound(bytes, step.awaited_bytes, {},
                                               [](const auto& mark) { return mark.first; });
    if (step.awaited_bytes > 0 && came == bytes.end()) return std::nullopt;
    auto arrival = anchor_;
    if (step.awaited > 0) arrival = std::max(arrival, moments[step.awaited - 1]);
    return step.awaited_bytes > 0 ? std::max(arrival, came->second) : arrival;
  }
  void set_anchor(Instant time, const TalkStep& step) {
    anchor_ = std::max(anchor_, time);
    recorded_anchor_ = step.record.time;
    has_heard_ = true;
  }

  /// Times are told as if what came before had come when it was recorded.
  void keep(Instant now, KeptRecord record) {
    if (next_ == 0 && said_->actual.empty() && !steps_.empty()) anchor_ = now;
    const auto since = std::chrono::duration<double>{now - anchor_} * role_.speed;
    record.time = recorded_anchor_ +
                  (role_.speed == 1 ? now - anchor_ : std::chrono::duration_cast<Duration>(since));
    said_->actual.push_back(std::move(record));
  }
  void leave_out(const KeptRecord& record) { ++said_->left_out[label_of(record)]; }

  DeviceRole role_;
  std::vector<TalkStep> steps_;
  std::size_t next_ = 0;
  bool has_begun_ = false;
  bool has_heard_ = false;                   ///< anything of the host
  Instant anchor_{};                         ///< when the last thing of the host came
  Instant recorded_anchor_{};                ///< the same in the recording
  Instant spoken_{};                         ///< when the device said something last
  std::set<std::uint32_t> recorded_begins_;  ///< connections that are recorded from their beginning
  std::map<std::uint32_t, Counter> counters_;
  std::map<std::uint32_t, Heard> heard_;  ///< by connection
  std::shared_ptr<HostSaid> said_ = std::make_shared<HostSaid>();
};

/// What speaks of its own accord: a device on a stream, or a server. `Said` is a thing that it
/// sends.
template <class Kind, class Said>
class SpeakingAs : public Kind {
 public:
  explicit SpeakingAs(Talk talk) : talk_{std::move(talk)} {}

  void advance_to(Instant time) final {
    now_ = time;
    talk_.advance_to(time, [this](Instant at, const KeptRecord& record) { say(at, record); });
  }
  [[nodiscard]] std::optional<Instant> next_event() const final { return talk_.next_event(); }
  [[nodiscard]] bool set_input(Instant, std::string_view, std::int64_t) final { return false; }
  [[nodiscard]] std::span<const Said> sent() const final { return sent_; }
  void clear_sent() final { sent_.clear(); }
  [[nodiscard]] bool is_gone() const final { return sent_.empty() && talk_.is_over(now_); }

 protected:
  virtual void say(Instant time, const KeptRecord& record) = 0;

  Talk talk_;
  std::vector<Said> sent_;

 private:
  Instant now_{};
};

class PlayedStream final : public SpeakingAs<HostedStream, SentBytes> {
 public:
  using SpeakingAs::SpeakingAs;

  void receive(Instant time, Bytes bytes) override {
    advance_to(time);
    talk_.hear(time, {.kind = LinkKind::kStream, .direction = Direction::kToDevice}, bytes);
  }

 private:
  void say(Instant time, const KeptRecord& record) override {
    sent_.push_back({time, record.bytes});
  }
};

class PlayedServer final : public SpeakingAs<HostedServer, ServerEvent> {
 public:
  PlayedServer(Talk talk, std::vector<std::uint32_t> connections)
      : SpeakingAs{std::move(talk)}, connections_{std::move(connections)} {}

  [[nodiscard]] bool is_listening() const override { return true; }
  [[nodiscard]] std::optional<ConnectionId> connect(Instant time) override {
    advance_to(time);
    const auto number = connected_++;
    const bool is_known = number < connections_.size();
    const auto id = is_known ? connections_[number] : number;
    const bool is_refused = !is_known || talk_.has_end(id, "refused");
    talk_.note_border(time, id, "connect", is_refused ? "refused" : "ok");
    if (is_refused) return std::nullopt;
    numbers_[id] = next_;
    ids_[next_] = id;
    return next_++;
  }
  void receive(Instant time, ConnectionId number, Bytes segment) override {
    advance_to(time);
    talk_.hear(time,
               {.kind = LinkKind::kSession, .direction = Direction::kToDevice, .id = ids_[number]},
               segment);
  }
  /// A socket does not tell which of both it was until something is written to it.
  void half_close(Instant time, ConnectionId number) override {
    const bool is_whole = talk_.has_end(ids_[number], "client-close");
    end(time, number, is_whole ? "client-close" : "client-half-close");
    if (is_whole) ended_.insert(number);
  }
  void close(Instant time, ConnectionId number) override { end(time, number, "client-close"); }
  void reset(Instant time, ConnectionId number) override { end(time, number, "client-reset"); }
  [[nodiscard]] std::size_t unread(ConnectionId) const override { return 0; }

 private:
  void end(Instant time, ConnectionId number, std::string_view how) {
    advance_to(time);
    if (ended_.contains(number)) return;
    talk_.note_border(time, ids_[number], "disconnect", how);
  }
  void say(Instant time, const KeptRecord& record) override {
    const bool is_end = record.kind == LinkKind::kEvents;
    const auto id = is_end ? static_cast<std::uint32_t>(number_in(record, "conn", 0)) : record.id;
    const auto number = numbers_.find(id);
    if (number == numbers_.end()) return;  // the host has not connected so often
    const auto kind = !is_end                                     ? SessionEvent::Kind::kData
                      : text_in(record, "text") == "device-reset" ? SessionEvent::Kind::kReset
                                                                  : SessionEvent::Kind::kEnd;
    if (is_end) ended_.insert(number->second);
    sent_.push_back({time, number->second, kind, is_end ? std::vector<std::byte>{} : record.bytes});
  }

  std::vector<std::uint32_t> connections_;  ///< of the recording, in the order in which they began
  std::uint32_t connected_ = 0;
  ConnectionId next_ = 0;
  std::map<std::uint32_t, ConnectionId> numbers_;
  std::map<ConnectionId, std::uint32_t> ids_;
  std::set<ConnectionId> ended_;
};

/// All addresses of a recorded bus. Copies play the same recording on.
class PlayedNodes {
 public:
  PlayedNodes(std::vector<KeptRecord> records, std::shared_ptr<HostSaid> said)
      : play_{std::make_shared<Play>()} {
    play_->said = std::move(said);
    for (auto& record : records) {
      if (record.kind == LinkKind::kEvents) continue;
      auto& queue = play_->left[{record.id, record.direction == Direction::kFromDevice}];
      play_->said->expected.push_back(record);
      queue.push_back(std::move(record));
    }
  }

  /// As the next operation on it that is recorded was.
  [[nodiscard]] bool acknowledges(std::uint8_t address) {
    address_ = address;
    auto* const queue = next_of(address);
    if (queue != nullptr && !text_in(queue->front(), "ack").starts_with('N')) return true;
    note_refusal(queue);
    return false;
  }
  void start(Instant time, bool is_read) {
    auto& queue = play_->left[{address_, is_read}];
    current_ = KeptRecord{.time = time,
                          .kind = LinkKind::kBus,
                          .direction = is_read ? Direction::kFromDevice : Direction::kToDevice,
                          .id = address_};
    recorded_.reset();
    if (queue.empty()) return;
    recorded_ = std::move(queue.front());
    queue.erase(queue.begin());
    current_->time = recorded_->time;
    current_->details = recorded_->details;
  }
  [[nodiscard]] bool write(Instant /*time*/, std::byte byte) {
    const auto place = current_->bytes.size();
    current_->bytes.push_back(byte);
    const auto acks = recorded_ ? text_in(*recorded_, "ack") : std::string{};
    return place + 1 >= acks.size() || acks[place + 1] == 'A';
  }
  [[nodiscard]] std::byte read(Instant /*time*/) {
    const auto place = current_->bytes.size();
    const bool is_there = recorded_ && place < recorded_->bytes.size();
    current_->bytes.push_back(is_there ? recorded_->bytes[place] : kNothingDriven);
    return current_->bytes.back();
  }
  void stop(Instant /*time*/) {
    if (current_) play_->said->actual.push_back(*std::exchange(current_, std::nullopt));
  }

 private:
  struct Play {
    std::map<std::pair<std::uint32_t, bool>, std::vector<KeptRecord>> left;  ///< true: to be read
    std::shared_ptr<HostSaid> said;
  };

  using Queue = std::vector<KeptRecord>;

  /// The one in which the address comes first; nullptr: it does not come any more.
  [[nodiscard]] Queue* next_of(std::uint8_t address) {
    Queue* first = nullptr;
    for (auto& [place, queue] : play_->left) {
      if (place.first != address || queue.empty()) continue;
      if (first == nullptr || queue.front().time < first->front().time) first = &queue;
    }
    return first;
  }
  /// nullptr: nobody recorded that.
  void note_refusal(Queue* queue) {
    if (queue == nullptr) {
      play_->said->actual.push_back(
          {.kind = LinkKind::kBus, .id = address_, .details = R"("ack":"N")"});
      return;
    }
    play_->said->actual.push_back(std::move(queue->front()));
    queue->erase(queue->begin());
  }

  std::shared_ptr<Play> play_;
  std::uint8_t address_ = 0;
  std::optional<KeptRecord> current_;   ///< what the host does
  std::optional<KeptRecord> recorded_;  ///< what it did
};
static_assert(EmulatedBusDevice<PlayedNodes>);

std::vector<std::uint32_t> connections_in(const std::vector<KeptRecord>& records) {
  std::vector<std::uint32_t> connections;
  for (const auto& record : records) {
    if (record.kind == LinkKind::kEvents && what_of(record) != "connect") continue;
    const auto id = record.kind == LinkKind::kEvents
                        ? static_cast<std::uint32_t>(number_in(record, "conn", 0))
                        : record.id;
    if (std::ranges::count(connections, id) == 0) connections.push_back(id);
  }
  return connections;
}

}  // namespace

PlayedDevice play_device(LinkKind kind, std::vector<KeptRecord> records, const DeviceRole& role) {
  if (kind == LinkKind::kBus) {
    auto said = std::make_shared<HostSaid>();
    i2c::Bus bus;
    bus.attach(PlayedNodes{std::move(records), said});
    return {make_hosted(std::move(bus)), said};
  }
  auto connections = connections_in(records);
  Talk talk{std::move(records), role};
  auto said = talk.said();
  if (kind == LinkKind::kStream) {
    return {std::make_unique<PlayedStream>(std::move(talk)), std::move(said)};
  }
  return {std::make_unique<PlayedServer>(std::move(talk), std::move(connections)), std::move(said)};
}

}  // namespace armjig
