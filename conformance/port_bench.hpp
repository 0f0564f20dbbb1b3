// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <utility>

#include "conformance/bench.hpp"
#include "harness/rig/rig.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// Messages as evidence: a line for each with its time, and its first bytes. Below the newest one
/// that has a mark is its mark.
[[nodiscard]] std::string evidence_of(const std::deque<Message>& messages,
                                      const Judgement& judgement);

/// A line with the field of the device's message that a judgement is about: `> speed.j1 = 99
/// steps/s = 0x000063 (bytes 22 to 24: 00 00 63)`. Empty if it is about no field of this message.
[[nodiscard]] std::string mark_of(const Message& message, const Judgement& judgement);

/// A field's value as judgements say it: `speed.j1 = 99 steps/s = 0x000063`.
[[nodiscard]] std::string sentence_of(const Field& field, std::int64_t value);

/// What benches on all three kinds of ports do with their rig.
template <class Port>
class PortBench : public Bench {
 public:
  explicit PortBench(Rig<Port> rig) : rig_{std::move(rig)} {}

  /// Does at the device what its link cannot: a switch, an input, the power. Skips the case where
  /// nobody can.
  void touch(std::string_view input, std::int64_t value) {
    if (is_deaf() || reach(input, value)) return;
    miss_hand(input);
  }

  /// Only where nothing can be damaged: on an emulated device.
  void needs_emulation() {
    if (rig_.is_guarded()) skip("nothing that a real device should be brought to");
  }

  /// What is to be seen at the device; skips the case where nobody looks.
  [[nodiscard]] std::int64_t observe(std::string_view output) {
    if (is_deaf()) return 0;
    const auto seen = port().observe(output);
    if (!seen) skip(std::string{"needs somebody who looks at the device, for "}.append(output));
    return seen.value_or(0);
  }

  [[nodiscard]] bool is_stopped() override { return rig_.is_unsupervised(); }
  void resume() override {
    if (const auto resumed = rig_.resume(); !resumed) this->lose_link(resumed.error());
  }
  [[nodiscard]] Instant now() const override { return port().now(); }

 protected:
  /// Telling the time changes nothing.
  [[nodiscard]] Port& port() const noexcept { return rig_.port(); }
  [[nodiscard]] const Rig<Port>& rig() const noexcept { return rig_; }

  void miss_hand(std::string_view input) {
    skip(std::string{this->hand().has(input) ? "the hand at the device could not set "
                                             : "needs a hand at the device, to set "}
             .append(input));
  }

  /// The same; false where nobody can. Hands take their time, so there is a sign of life after each
  /// input. After a longer silence than a supervisor bears with the case is given up.
  [[nodiscard]] bool reach(std::string_view input, std::int64_t value) {
    if (port().touch(input, value)) return true;
    if (!this->hand().has(input)) return false;
    const bool is_set = this->hand().set(input, value);
    if (is_stopped()) judge_stop();
    return is_set;
  }

  /// Whether something was done at the port. What the guard does not allow skips the case; what it
  /// refuses because of where the device went is a finding.
  template <class Result>
  bool is_done(const Result& result) {
    if (result) return true;
    if (result.error().code != ErrorCode::kForbidden) {
      lose_link(result.error());
    } else if (rig_.last_refusal()) {
      judge_guard();
    } else {
      skip("the guard does not allow it");
    }
    return false;
  }

  /// What the guard did until now was before the case.
  void pass_over_stops() { refusals_ = rig_.refusals(); }

  /// What came of the case if the guard has stopped the device since this was asked last.
  void judge_stop() {
    if (std::exchange(refusals_, rig_.refusals()) != rig_.refusals()) judge_guard();
  }

 private:
  void judge_guard() {
    const auto refusal = rig_.last_refusal();
    refusals_ = rig_.refusals();
    switch (refusal->cause) {
      case Refusal::Cause::kRequest:
        return this->skip(refusal->reason);
      case Refusal::Cause::kUnsupervised:
        return this->give_up(refusal->reason);
      case Refusal::Cause::kDevice:
        break;
    }
    switch (refusal->matter) {
      case Refusal::Matter::kStopped:
        return this->blame_rig(refusal->reason + ", or reads inverted");
      case Refusal::Matter::kUnseen:
        return this->fail_by_silence(this->in_context("a device that can be seen"),
                                     refusal->reason);
      case Refusal::Matter::kAstray:
        return this->fail(this->in_context("a device that goes where it is led"),
                          "the guard stopped it: " + refusal->reason);
    }
  }

  std::size_t refusals_ = 0;
  mutable Rig<Port> rig_;
};

/// One whose evidence is what a dissector makes of the last few messages.
template <class Port>
class DissectedBench : public PortBench<Port> {
 public:
  DissectedBench(Rig<Port> rig, std::unique_ptr<Dissector> dissector, std::size_t remembered)
      : PortBench<Port>{std::move(rig)}, dissector_{std::move(dissector)}, most_{remembered} {}

  [[nodiscard]] std::string last_exchange() const override {
    return evidence_of(exchange_, this->judgement());
  }

 protected:
  void forget_exchange() override {
    exchange_.clear();
    this->pass_over_stops();
  }

  /// The messages that are complete with these bytes, which pass now.
  std::vector<Message> dissect(Direction direction, Bytes bytes) {
    std::vector<Message> messages;
    dissector_->feed(direction, this->now(), bytes, messages);
    for (const auto& message : messages) {
      exchange_.push_back(message);
      if (exchange_.size() > most_) exchange_.pop_front();
    }
    return messages;
  }

 private:
  std::unique_ptr<Dissector> dissector_;
  std::size_t most_;
  std::deque<Message> exchange_;
};

}  // namespace armjig
