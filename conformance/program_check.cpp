// SPDX-License-Identifier: Apache-2.0
#include "conformance/program_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "harness/core/version.hpp"

namespace armjig {
namespace {

constexpr std::size_t kRemembered = 3;

double seconds(Instant time) {
  return std::chrono::duration<double>{time.time_since_epoch()}.count();
}

using Kind = ConnectionEvent::Kind;

// What a device sent, as its checker is shown it.
void show(ProgramChecker& checker, const SentBytes& sent) {
  checker.from_device(sent.time, sent.bytes);
}
void show(ProgramChecker& checker, const ServerEvent& sent) {
  const bool is_data = sent.kind == SessionEvent::Kind::kData;
  checker.on_connection(
      {sent.time, sent.connection, is_data ? Kind::kFromServer : Kind::kDropped, sent.bytes});
}

}  // namespace

/// The one way by which the checker is shown anything.
template <class Show>
void ProgramCheck::hear(Show show) {
  const std::lock_guard lock{guard_};
  show(*checker_);
  take_offences();
}

/// A device whose traffic is shown to the checker, in the order of time.
template <class Hosted>
class ProgramCheck::Overheard : public Hosted {
 public:
  Overheard(ProgramCheck& check, std::unique_ptr<Hosted> device)
      : check_{check}, device_{std::move(device)} {}

  void advance_to(Instant time) override {
    do_and_hear([&] { device_->advance_to(time); });
    hear(time, [&](ProgramChecker& checker) { checker.wait_until(time); });
  }
  [[nodiscard]] std::optional<Instant> next_event() const override { return device_->next_event(); }
  void overlook(Instant from, Instant to) override {
    check_.hear([&](ProgramChecker& checker) { checker.overlook(from, to); });
    device_->overlook(from, to);
  }
  [[nodiscard]] std::span<const DeviceInput> inputs() const override { return device_->inputs(); }
  [[nodiscard]] std::vector<std::string> take_log() override { return device_->take_log(); }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
    bool is_taken = false;
    do_and_hear([&] { is_taken = device_->set_input(time, name, value); });
    return is_taken;
  }

 protected:
  [[nodiscard]] Hosted& device() noexcept { return *device_; }
  [[nodiscard]] const Hosted& device() const noexcept { return *device_; }

  /// Shows it what passes at that time.
  template <class Show>
  void hear(Instant time, Show show_it) {
    check_.hear([&](ProgramChecker& checker) {
      check_.now_ = time;
      show_it(checker);
    });
  }

  /// What the program does, as the checker is shown it and as the device gets it.
  template <class Show, class Do>
  void pass(Instant time, Show show_it, Do do_it) {
    hear(time, show_it);
    do_and_hear(do_it);
  }

  void forget_heard() noexcept { heard_ = 0; }

 private:
  template <class Do>
  void do_and_hear(Do do_it) {
    do_it();
    if constexpr (requires { device_->sent(); }) {
      const auto sent = device_->sent();
      check_.hear([&](ProgramChecker& checker) {
        for (const auto& one : sent.subspan(heard_)) show(checker, one);
      });
      heard_ = sent.size();
    }
  }

  ProgramCheck& check_;
  std::unique_ptr<Hosted> device_;
  std::size_t heard_ = 0;  ///< of what was sent and not cleared
};

/// One that sends by itself.
template <class Hosted>
class ProgramCheck::OverheardSender : public Overheard<Hosted> {
 public:
  using Overheard<Hosted>::Overheard;

  [[nodiscard]] auto sent() const -> decltype(std::declval<const Hosted&>().sent()) override {
    return this->device().sent();
  }
  void clear_sent() override {
    this->device().clear_sent();
    this->forget_heard();
  }
};

class ProgramCheck::OverheardStream final : public OverheardSender<HostedStream> {
 public:
  using OverheardSender::OverheardSender;

  void receive(Instant time, Bytes bytes) override {
    pass(
        time, [&](ProgramChecker& checker) { checker.to_device(time, bytes); },
        [&] { device().receive(time, bytes); });
  }
  [[nodiscard]] std::size_t unread() const override { return device().unread(); }
};

class ProgramCheck::OverheardServer final : public OverheardSender<HostedServer> {
 public:
  using OverheardSender::OverheardSender;

  [[nodiscard]] bool is_listening() const override { return device().is_listening(); }
  [[nodiscard]] std::optional<ConnectionId> connect(Instant time) override {
    const auto id = device().connect(time);
    if (id) pass({time, *id, Kind::kBegun, {}}, [] {});
    return id;
  }
  void receive(Instant time, ConnectionId id, Bytes segment) override {
    pass({time, id, Kind::kToServer, segment}, [&] { device().receive(time, id, segment); });
  }
  void half_close(Instant time, ConnectionId id) override {
    pass({time, id, Kind::kHalfClosed, {}}, [&] { device().half_close(time, id); });
  }
  void close(Instant time, ConnectionId id) override {
    pass({time, id, Kind::kClosed, {}}, [&] { device().close(time, id); });
  }
  void reset(Instant time, ConnectionId id) override {
    pass({time, id, Kind::kReset, {}}, [&] { device().reset(time, id); });
  }
  [[nodiscard]] std::size_t unread(ConnectionId id) const override { return device().unread(id); }

 private:
  template <class Do>
  void pass(const ConnectionEvent& event, Do do_it) {
    Overheard::pass(
        event.time, [&](ProgramChecker& checker) { checker.on_connection(event); }, do_it);
  }
};

class ProgramCheck::OverheardBus final : public Overheard<HostedBus> {
 public:
  using Overheard::Overheard;

  BusReply start(Instant time, std::uint8_t address, bool is_read) override {
    tell(time);
    const auto first = static_cast<std::byte>(unsigned{address} << 1U | (is_read ? 1U : 0U));
    return keep(device().start(time, address, is_read), first);
  }
  BusReply write(Instant time, std::byte byte) override {
    return keep(device().write(time, byte), byte);
  }
  BusReply read(Instant time) override {
    const auto reply = device().read(time);
    return keep(reply, reply.byte);
  }
  BusReply stop(Instant time) override {
    tell(time);
    return device().stop(time);
  }
  BusReply recover(Instant time) override {
    tell(time);
    return device().recover(time);
  }

 private:
  BusReply keep(const BusReply& reply, std::byte byte) {
    if (reply.outcome == BusReply::Outcome::kAck) message_.push_back(byte);
    return reply;
  }

  void tell(Instant time) {
    const auto message = std::exchange(message_, {});
    if (message.empty()) return;
    const bool is_read = (message[0] & std::byte{1}) != std::byte{};
    hear(time, [&](ProgramChecker& checker) {
      is_read ? checker.from_device(time, message) : checker.to_device(time, message);
    });
  }

  std::vector<std::byte> message_;
};

ProgramCheck::ProgramCheck(const ProgramCheckEntry& entry, const LinkNoise& noise,
                           std::function<void(const Offence&)> on_offence)
    : entry_{entry}, checker_{entry.make(noise)}, on_offence_{std::move(on_offence)} {}

std::unique_ptr<HostedStream> ProgramCheck::watch(std::unique_ptr<HostedStream> device) {
  return std::make_unique<OverheardStream>(*this, std::move(device));
}

std::unique_ptr<HostedServer> ProgramCheck::watch(std::unique_ptr<HostedServer> server) {
  return std::make_unique<OverheardServer>(*this, std::move(server));
}

std::unique_ptr<HostedBus> ProgramCheck::watch(std::unique_ptr<HostedBus> bus) {
  return std::make_unique<OverheardBus>(*this, std::move(bus));
}

void ProgramCheck::take_offences() {
  for (auto& offence : checker_->take_offences()) {
    auto& record = records_[offence.requirement];
    ++record.count;
    on_offence_(offence);
    if (record.first.size() < kRemembered) record.first.push_back(std::move(offence));
  }
}

std::size_t ProgramCheck::count(std::string_view requirement) const {
  const std::lock_guard lock{guard_};
  const auto record = records_.find(requirement);
  return record == records_.end() ? 0 : record->second.count;
}

Report ProgramCheck::finish() {
  const std::lock_guard lock{guard_};
  checker_->finish(now_);
  take_offences();
  Report report;
  report.title = fmt::format("Programs that talk to {}", entry_.device);
  report.facts = {{"armjig", std::string{kVersion}},
                  {"messages", std::to_string(checker_->messages())},
                  {"device time", fmt::format("{:.3f} s", seconds(now_))}};
  if (const auto overlooked = seconds(at(checker_->overlooked())); overlooked > 0) {
    report.facts.emplace_back(
        "overlooked",
        fmt::format("{:.3f} s ({:.1f} %): this emulator was late itself then", overlooked,
                    100 * overlooked / std::max(seconds(now_), overlooked)));
  }
  for (const auto& requirement : entry_.requirements()) {
    report.rows.push_back(row_of(requirement));
  }
  return report;
}

ReportRow ProgramCheck::row_of(const Requirement& requirement) const {
  auto row = row_about(requirement, entry_.document);
  row.name = requirement.id;
  row.summary = requirement.text;
  const auto found = records_.find(requirement.id);
  if (found != records_.end()) {
    const auto& record = found->second;
    row.verdict = Verdict::kFail;
    row.expected = requirement.text;
    row.actual = fmt::format("{} times, first at {:.3f} s: {}", record.count,
                             seconds(record.first.front().time), record.first.front().what);
    for (const auto& offence : record.first) {
      row.evidence += fmt::format("{:.3f} s {}\n", seconds(offence.time), offence.what);
    }
  } else if (checker_->is_in_doubt(requirement.id)) {
    row.verdict = Verdict::kInconclusive;
    row.actual = "it looked broken, but only while this emulator was late itself";
  } else if (!checker_->had_occasion(requirement)) {
    row.verdict = Verdict::kSkipped;
    row.actual = checker_->messages() == 0
                     ? "no program sent anything whole"
                     : fmt::format("no occasion without {}", requirement.occasion);
  }
  return row;
}

}  // namespace armjig
