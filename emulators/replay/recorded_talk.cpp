// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/recorded_talk.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "emulators/memory/overheard.hpp"
#include "emulators/replay/trial_witness.hpp"

namespace armjig {
namespace {

/// Of long recordings no more copies of the device are kept than that.
constexpr std::size_t kMostCopies = 2000;

AnyHosted wrap(AnyHosted device, Gate& gate, Overhearer& overhearer) {
  return std::visit(
      [&](auto held) -> AnyHosted {
        return put_behind(gate, overhear(std::move(held), overhearer));
      },
      std::move(device));
}

bool is_copy(const AnyHosted& device) {
  return std::visit([](const auto& held) { return held != nullptr; }, device);
}

}  // namespace

class RecordedTalk::Impl {
  /// What a judge was told, to tell another one the same.
  class Transcript final : public TrialJudge {
   public:
    explicit Transcript(TrialJudge* judge) : judge_{judge} {}

    void to_device(Instant time, Bytes bytes) override {
      keep([time, held = held_of(bytes)](Overhearer& to) { to.to_device(time, held); });
    }
    void from_device(Instant time, Bytes bytes) override {
      keep([time, held = held_of(bytes)](Overhearer& to) { to.from_device(time, held); });
    }
    void on_connection(const ConnectionEvent& event) override {
      keep([event, held = held_of(event.bytes)](Overhearer& to) {
        auto told = event;
        told.bytes = held;
        to.on_connection(told);
      });
    }
    void on_bus(const BusPart& part) override {
      keep([part, held = held_of(part.bytes), acks = std::string{part.acks}](Overhearer& to) {
        auto told = part;
        told.bytes = held;
        told.acks = acks;
        to.on_bus(told);
      });
    }
    void on_input(Instant time, std::string_view name, std::int64_t value) override {
      keep([time, held = std::string{name}, value](Overhearer& to) {
        to.on_input(time, held, value);
      });
    }
    void wait_until(Instant time) override {
      keep([time](Overhearer& to) { to.wait_until(time); });
    }
    std::vector<Breakage> finish() override {
      return judge_ == nullptr ? std::vector<Breakage>{} : judge_->finish();
    }

    void tell(Overhearer& other, std::size_t count) const {
      for (std::size_t i = 0; i < count; ++i) told_[i](other);
    }
    [[nodiscard]] std::size_t size() const noexcept { return told_.size(); }

   private:
    using Tell = std::function<void(Overhearer&)>;

    static std::vector<std::byte> held_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }
    void keep(Tell tell) {
      if (judge_ != nullptr) tell(*judge_);
      told_.push_back(std::move(tell));
    }

    TrialJudge* judge_;
    std::vector<Tell> told_;
  };

 public:
  Impl(std::vector<KeptRecord> records, MakeDissector make_dissector, MakeTrialJudge make_judge)
      : records_{std::move(records)},
        make_dissector_{make_dissector},
        make_judge_{std::move(make_judge)} {}

  /// Has the whole talk once, and keeps copies on the way.
  Outcome<void> learn(RecordedHost host) {
    auto device = clone(host.device());
    if (!is_copy(device)) {
      return problem(ErrorCode::kUnsupported, "what-if", "this device cannot be copied");
    }
    const auto judge = make_judge_();
    transcript_ = std::make_unique<Transcript>(judge.get());
    TrialWitness witness{make_dissector_, transcript_.get()};
    Gate gate{make_dissector_};
    RecordedHost watched{host, wrap(std::move(device), gate, witness)};
    const auto stride = records_.size() / kMostCopies + 1;
    for (std::size_t i = 0; i < records_.size(); ++i) {
      if (i % stride == 0 && host.is_idle()) {
        places_.push_back({i, RecordedHost{host, clone(host.device())}, gate.counts(),
                           gate.passed().size(), transcript_->size(), witness.said()});
      }
      host.play(records_[i]);
      watched.play(records_[i]);
    }
    watched.advance_to(end());
    for (const auto& piece : gate.passed()) all_passed_.push_back(piece);
    undisturbed_ = {.passed = pieces_of_host(), .said = {}, .broken = witness.finish()};
    undisturbed_.said = witness.take_said();
    return {};
  }

  [[nodiscard]] TrialResult run(const std::vector<Perturbation>& wanted,
                                std::optional<Duration> longest_apart) const {
    if (wanted.empty() || places_.empty()) return undisturbed_;
    const auto& place = place_before(wanted);
    const auto judge = make_judge_();
    if (judge) transcript_->tell(*judge, place.told);
    TrialWitness witness{make_dissector_, judge.get()};
    Gate gate{make_dissector_, wanted, place.counts};
    RecordedHost host{place.host, wrap(clone(place.host.device()), gate, witness)};
    for (auto i = place.record; i < records_.size(); ++i) host.play(records_[i]);
    host.advance_to(end());
    TrialResult result{.passed = {}, .said = {}, .broken = witness.finish()};
    result.said = witness.take_said();
    if (longest_apart) add_apart(place, *longest_apart, result);
    return result;
  }

  [[nodiscard]] std::optional<Apart> apart_after(const std::vector<Perturbation>& wanted) const {
    if (wanted.empty() || places_.empty()) return std::nullopt;
    return apart(said_from(place_before(wanted)), run(wanted, {}).said, make_dissector_);
  }

  [[nodiscard]] const TrialResult& undisturbed() const noexcept { return undisturbed_; }
  [[nodiscard]] std::size_t copies() const noexcept { return places_.size(); }

 private:
  /// Where a talk can begin again.
  struct Place {
    std::size_t record;  ///< the next one
    RecordedHost host;
    Gate::Counts counts;
    std::size_t passed;  ///< so many pieces before
    std::size_t told;
    std::size_t said;
  };

  [[nodiscard]] Instant end() const {
    constexpr auto kTrailing = std::chrono::seconds{1};
    return records_.empty() ? Instant{} : records_.back().time + kTrailing;
  }
  /// The recorded host does not listen, so nothing comes of what the device says; on a bus it is
  /// the master that reads.
  [[nodiscard]] std::vector<PassedPiece> pieces_of_host() const {
    const bool is_bus = !places_.empty() && std::holds_alternative<std::unique_ptr<HostedBus>>(
                                                places_.front().host.device());
    std::vector<PassedPiece> pieces;
    std::ranges::copy_if(all_passed_, std::back_inserter(pieces), [&](const PassedPiece& one) {
      return is_bus || one.name.direction == Direction::kToDevice;
    });
    return pieces;
  }
  [[nodiscard]] const Place& place_before(const std::vector<Perturbation>& wanted) const {
    auto first = all_passed_.size();
    for (const auto& one : wanted) {
      const auto found = std::ranges::find(all_passed_, one.piece, &PassedPiece::name);
      first = std::min(first, static_cast<std::size_t>(found - all_passed_.begin()));
    }
    const auto after = std::ranges::upper_bound(places_, first, {}, &Place::passed);
    return after == places_.begin() ? *after : *std::prev(after);
  }
  [[nodiscard]] std::vector<SaidPiece> said_from(const Place& place) const {
    return {undisturbed_.said.begin() + static_cast<std::ptrdiff_t>(place.said),
            undisturbed_.said.end()};
  }
  void add_apart(const Place& place, Duration longest, TrialResult& result) const {
    const auto found = apart(said_from(place), result.said, nullptr);
    if (!found || found->to - found->from <= longest) return;
    const auto seconds = std::chrono::duration<double>{found->to - found->from}.count();
    result.broken.push_back({found->from, "apart",
                             fmt::format("the device says something else for {:.3f} s", seconds)});
  }

  std::vector<KeptRecord> records_;
  MakeDissector make_dissector_;
  MakeTrialJudge make_judge_;
  std::vector<Place> places_;
  std::vector<PassedPiece> all_passed_;
  TrialResult undisturbed_;
  std::unique_ptr<Transcript> transcript_;
};

RecordedTalk::RecordedTalk(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
RecordedTalk::RecordedTalk(RecordedTalk&&) noexcept = default;
RecordedTalk& RecordedTalk::operator=(RecordedTalk&&) noexcept = default;
RecordedTalk::~RecordedTalk() = default;

Outcome<RecordedTalk> RecordedTalk::begin(RecordedHost host, std::vector<KeptRecord> records,
                                          MakeDissector make_dissector, MakeTrialJudge make_judge) {
  auto impl = std::make_unique<Impl>(std::move(records), make_dissector, std::move(make_judge));
  if (auto learnt = impl->learn(std::move(host)); !learnt) return tl::unexpected{learnt.error()};
  return RecordedTalk{std::move(impl)};
}

TrialResult RecordedTalk::operator()(const std::vector<Perturbation>& wanted,
                                     std::optional<Duration> longest_apart) const {
  return impl_->run(wanted, longest_apart);
}
std::optional<Apart> RecordedTalk::apart_after(const std::vector<Perturbation>& wanted) const {
  return impl_->apart_after(wanted);
}
const TrialResult& RecordedTalk::undisturbed() const noexcept { return impl_->undisturbed(); }
std::size_t RecordedTalk::copies() const noexcept { return impl_->copies(); }

}  // namespace armjig
