// SPDX-License-Identifier: Apache-2.0
#include "conformance/program_check.hpp"

#include <fmt/core.h>

#include <array>
#include <utility>

#include "conformance/kinovazed/host/checker.hpp"
#include "conformance/morap/host/checker.hpp"
#include "conformance/parol6/host/checker.hpp"
#include "harness/core/version.hpp"

namespace armjig {
namespace {

constexpr std::size_t kRemembered = 3;

constexpr std::array kChecks{
    ProgramCheckEntry{"kinovazed", kinovazed::host_requirements, kinovazed::make_host_checker},
    ProgramCheckEntry{"morap", morap::host_requirements, morap::make_host_checker},
    ProgramCheckEntry{"parol6", parol6::host_requirements, parol6::make_host_checker},
};

double seconds(Instant time) {
  return std::chrono::duration<double>{time.time_since_epoch()}.count();
}

}  // namespace

std::span<const ProgramCheckEntry> program_checks() noexcept { return kChecks; }

/// Shows the checker what passes, in the order of time.
class ProgramCheck::Overheard final : public HostedStream {
 public:
  Overheard(ProgramCheck& check, std::unique_ptr<HostedStream> device)
      : check_{check}, device_{std::move(device)} {}

  void receive(Instant time, Bytes bytes) override {
    check_.now_ = time;
    check_.checker_->to_device(time, bytes);
    device_->receive(time, bytes);
    overhear_sent();
  }
  void advance_to(Instant time) override {
    check_.now_ = time;
    device_->advance_to(time);
    overhear_sent();
  }
  [[nodiscard]] std::optional<Instant> next_event() const override { return device_->next_event(); }
  [[nodiscard]] std::span<const SentBytes> sent() const override { return device_->sent(); }
  void clear_sent() override {
    device_->clear_sent();
    heard_ = 0;
  }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
    const bool is_taken = device_->set_input(time, name, value);
    overhear_sent();
    return is_taken;
  }

 private:
  void overhear_sent() {
    for (const auto& message : device_->sent().subspan(heard_)) {
      check_.checker_->from_device(message.time, message.bytes);
    }
    heard_ = device_->sent().size();
    check_.take_offences();
  }

  ProgramCheck& check_;
  std::unique_ptr<HostedStream> device_;
  std::size_t heard_ = 0;  ///< of what was sent and not cleared
};

/// The same with connections.
class ProgramCheck::OverheardServer final : public HostedServer {
 public:
  OverheardServer(ProgramCheck& check, std::unique_ptr<HostedServer> server)
      : check_{check}, server_{std::move(server)} {}

  [[nodiscard]] bool is_listening() const override { return server_->is_listening(); }
  [[nodiscard]] std::optional<ConnectionId> connect(Instant time) override {
    const auto id = server_->connect(time);
    if (id) tell({time, *id, Kind::kBegun, {}});
    overhear_sent();
    return id;
  }
  void receive(Instant time, ConnectionId id, Bytes segment) override {
    tell({time, id, Kind::kToServer, segment});
    server_->receive(time, id, segment);
    overhear_sent();
  }
  void half_close(Instant time, ConnectionId id) override {
    tell({time, id, Kind::kHalfClosed, {}});
    server_->half_close(time, id);
    overhear_sent();
  }
  void close(Instant time, ConnectionId id) override {
    tell({time, id, Kind::kClosed, {}});
    server_->close(time, id);
    overhear_sent();
  }
  void reset(Instant time, ConnectionId id) override {
    tell({time, id, Kind::kReset, {}});
    server_->reset(time, id);
    overhear_sent();
  }
  [[nodiscard]] std::size_t unread(ConnectionId id) const override { return server_->unread(id); }

  void advance_to(Instant time) override {
    check_.now_ = time;
    server_->advance_to(time);
    overhear_sent();
  }
  [[nodiscard]] std::optional<Instant> next_event() const override { return server_->next_event(); }
  [[nodiscard]] std::span<const Event> sent() const override { return server_->sent(); }
  void clear_sent() override {
    server_->clear_sent();
    heard_ = 0;
  }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
    const bool is_taken = server_->set_input(time, name, value);
    overhear_sent();
    return is_taken;
  }
  [[nodiscard]] std::vector<std::string> take_log() override { return server_->take_log(); }

 private:
  using Kind = ConnectionEvent::Kind;

  void tell(const ConnectionEvent& event) {
    check_.now_ = event.time;
    check_.checker_->on_connection(event);
  }
  void overhear_sent() {
    for (const auto& event : server_->sent().subspan(heard_)) {
      const bool is_data = event.kind == SessionEvent::Kind::kData;
      check_.checker_->on_connection({event.time, event.connection,
                                      is_data ? Kind::kFromServer : Kind::kDropped, event.bytes});
    }
    heard_ = server_->sent().size();
    check_.take_offences();
  }

  ProgramCheck& check_;
  std::unique_ptr<HostedServer> server_;
  std::size_t heard_ = 0;  ///< of what was sent and not cleared
};

ProgramCheck::ProgramCheck(const ProgramCheckEntry& entry, const LinkNoise& noise,
                           std::function<void(const Offence&)> on_offence)
    : entry_{entry}, checker_{entry.make(noise)}, on_offence_{std::move(on_offence)} {}

std::unique_ptr<HostedStream> ProgramCheck::watch(std::unique_ptr<HostedStream> device) {
  return std::make_unique<Overheard>(*this, std::move(device));
}

std::unique_ptr<HostedServer> ProgramCheck::watch(std::unique_ptr<HostedServer> server) {
  return std::make_unique<OverheardServer>(*this, std::move(server));
}

void ProgramCheck::to_device(Instant time, Bytes bytes) {
  now_ = time;
  checker_->to_device(time, bytes);
  take_offences();
}

void ProgramCheck::from_device(Instant time, Bytes bytes) {
  now_ = time;
  checker_->from_device(time, bytes);
  take_offences();
}

void ProgramCheck::take_offences() {
  for (auto& offence : checker_->take_offences()) {
    auto& record = records_[offence.requirement];
    ++record.count;
    on_offence_(offence);
    if (record.first.size() < kRemembered) record.first.push_back(std::move(offence));
  }
}

std::size_t ProgramCheck::count(std::string_view requirement) const noexcept {
  const auto record = records_.find(requirement);
  return record == records_.end() ? 0 : record->second.count;
}

Report ProgramCheck::finish() {
  checker_->finish(now_);
  take_offences();
  Report report;
  report.title = fmt::format("Programs that talk to {}", entry_.device);
  report.facts = {{"armjig", std::string{kVersion}},
                  {"messages", std::to_string(checker_->messages())},
                  {"device time", fmt::format("{:.3f} s", seconds(now_))}};
  for (const auto& requirement : entry_.requirements()) {
    report.rows.push_back(row_of(requirement));
  }
  return report;
}

ReportRow ProgramCheck::row_of(const Requirement& requirement) const {
  ReportRow row;
  row.name = requirement.id;
  row.summary = requirement.text;
  row.requirement = requirement.id;
  row.level = requirement.level;
  row.demand = requirement.text;
  row.source = requirement.source;
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
  } else if (checker_->messages() == 0) {
    row.verdict = Verdict::kSkipped;
    row.actual = "no program sent anything whole";
  }
  return row;
}

}  // namespace armjig
