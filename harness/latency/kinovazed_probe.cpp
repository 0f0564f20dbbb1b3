// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/kinovazed_probe.hpp"

#include <fmt/core.h>

#include <array>
#include <chrono>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "harness/drive/kinovazed/drive.hpp"
#include "harness/latency/trip_book.hpp"
#include "harness/timing/latency_histogram.hpp"
#include "harness/wire/kinovazed/line.hpp"
#include "harness/wire/kinovazed/line_splitter.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::kinovazed::latency {
namespace {

constexpr double kSecond = 1e9;

/// Commands until they are done. The event that says so may come before Accepted.
class Commands {
 public:
  void request(Instant now, Verb verb) {
    if (asked_ - replied_ == waiting_.size()) ++replied_;  // the oldest is forgotten
    at(asked_++) = {verb, now};
  }

  void forget() noexcept { replied_ = asked_; }

  void reply(Event reply) {
    if (replied_ == asked_) return;
    const auto first = at(replied_++);
    if (reply == Event::kAccepted && !first.is_done) begun_[index(first.verb)] = first.sent;
  }

  void complete(Instant now, Event event) {
    const auto ends = [event](Verb verb) { return drive::completion_of(verb) == event; };
    for (std::size_t i = 0; i < kAnsweredVerbs; ++i) {
      if (!ends(static_cast<Verb>(i)) || !begun_[i]) continue;
      times_[i].record(now - *begun_[i]);
      begun_[i].reset();
      return;
    }
    for (auto i = replied_; i != asked_; ++i) {
      auto& one = at(i);
      if (one.is_done || !ends(one.verb)) continue;
      one.is_done = true;
      times_[index(one.verb)].record(now - one.sent);
      return;
    }
  }

  void tell(std::vector<Figure>& figures) const {
    for (std::size_t i = 0; i < kAnsweredVerbs; ++i) {
      const auto& histogram = times_[i];
      if (histogram.count() == 0) continue;
      const auto verb = static_cast<Verb>(i);
      const auto name = fmt::format("{} to {}", to_string(verb),
                                    to_string(drive::completion_of(verb).value_or(Event{})));
      const auto basis = fmt::format("{} of them, from command to event", histogram.count());
      const auto add = [&](const char* which, Duration time) {
        figures.push_back({fmt::format("{}, {}", name, which),
                           static_cast<double>(time.count()) / 1e6, "ms", basis});
      };
      add("median", histogram.percentile(50));
      add("most", histogram.max());
    }
  }

 private:
  struct Waiting {
    Verb verb{};
    Instant sent{};
    bool is_done = false;
  };
  static constexpr std::size_t index(Verb verb) noexcept { return static_cast<std::size_t>(verb); }
  Waiting& at(std::size_t number) noexcept { return waiting_[number % waiting_.size()]; }

  std::array<Waiting, TripBook::kMostPending> waiting_{};  ///< for their reply; a ring
  std::size_t asked_ = 0;
  std::size_t replied_ = 0;
  std::array<std::optional<Instant>, kAnsweredVerbs> begun_;
  std::array<LatencyHistogram, kAnsweredVerbs> times_;
};

class ReplyProbe final : public Probe {
 public:
  explicit ReplyProbe(std::string_view exchange) : exchange_{exchange} { ask({Verb::kUnfreeze}); }

  std::string_view exchange() const noexcept override { return exchange_; }
  Hazard hazard() const noexcept override { return Hazard::kState; }
  Messages request() override { return {&messages_[asking_ % verbs_.size()], 1}; }

  void leaves(Instant now) override { asked_.request(now, verbs_[asking_++ % verbs_.size()]); }
  void lost() override { asked_.forget(); }

  Outcome<void> choose(std::string_view name) override {
    if (name != "freeze") {
      return problem(ErrorCode::kBadValue, fmt::format("--exchange {}", name),
                     "besides Unfreeze there is: freeze, which is Freeze and Unfreeze in turn");
    }
    exchange_ = "Freeze and Unfreeze, in turn, to Accepted or Rejected";
    ask({Verb::kFreeze, Verb::kUnfreeze});
    return {};
  }

  std::size_t requested(Instant now, Bytes bytes) override {
    std::size_t requests = 0;
    for_each_step(commands_, bytes, [&](const LineSplitter::Step& step) {
      if (step.found != LineSplitter::Found::kLine) return;
      const auto command = decode_command(step.line, Profile::kFirmware);
      if (!command || !is_answered(command->verb)) return;
      asked_.request(now, command->verb);
      ++requests;
    });
    return requests;
  }

  std::size_t receive(Instant now, Bytes bytes) override {
    std::size_t replies = 0;
    for_each_step(splitter_, bytes, [&](const LineSplitter::Step& step) {
      if (step.found != LineSplitter::Found::kLine) return;
      const auto message = decode_message(step.line);
      if (!message) return;
      if (std::holds_alternative<Heartbeat>(*message)) take_beat(now);
      const auto* const event = std::get_if<Event>(&*message);
      if (event == nullptr) return;
      if (*event != Event::kAccepted && *event != Event::kRejected) {
        asked_.complete(now, *event);
        return;
      }
      asked_.reply(*event);
      ++replies;
    });
    return replies;
  }

  std::vector<Figure> figures(const RunFacts& /*facts*/) const override {
    std::vector<Figure> figures;
    asked_.tell(figures);
    if (periods_.count() == 0) return figures;
    const auto ns = [](Duration duration) { return static_cast<double>(duration.count()); };
    constexpr auto kBasis = "times at which heartbeats were read";
    const auto mean =
        ns(last_beat_.value_or(Instant{}) - first_beat_) / static_cast<double>(periods_.count());
    figures.push_back({"heartbeat period, mean", mean / 1e6, "ms", kBasis});
    figures.push_back({"heartbeat period, least", ns(periods_.min()) / 1e6, "ms", kBasis});
    figures.push_back({"heartbeat period, most", ns(periods_.max()) / 1e6, "ms", kBasis});
    figures.push_back(
        {"heartbeat drift against one second", 1e6 * (mean / kSecond - 1), "ppm", kBasis});
    return figures;
  }

 private:
  void take_beat(Instant now) {
    if (last_beat_) {
      periods_.record(now - *last_beat_);
    } else {
      first_beat_ = now;
    }
    last_beat_ = now;
  }

  void ask(std::vector<Verb> verbs) {
    verbs_ = std::move(verbs);
    lines_.clear();
    for (const auto verb : verbs_) lines_.push_back(encode(Command{.verb = verb}));
    messages_.clear();
    for (const auto& line : lines_) messages_.push_back(line.bytes());
  }

  std::string_view exchange_;
  std::vector<Verb> verbs_;  ///< in turn
  std::vector<EncodedLine> lines_;
  std::vector<Bytes> messages_;
  std::size_t asking_ = 0;
  LineSplitter splitter_;
  LineSplitter commands_;
  Commands asked_;
  Instant first_beat_{};
  std::optional<Instant> last_beat_;
  LatencyHistogram periods_;
};

}  // namespace

Outcome<std::unique_ptr<Probe>> make_probe(SessionSource& /*port*/, const std::string& /*target*/) {
  return std::make_unique<ReplyProbe>("Unfreeze to Accepted or Rejected");
}

std::unique_ptr<Probe> make_listener() {
  return std::make_unique<ReplyProbe>("any command to Accepted or Rejected");
}

}  // namespace armjig::kinovazed::latency
