// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "emulators/campaign/stage.hpp"

namespace armjig::campaign {

/// What campaigns are tried on: each does as another stage does, but for one thing.
class StageOnAnother : public Stage {
 public:
  explicit StageOnAnother(std::unique_ptr<Stage> stage) : stage_{std::move(stage)} {}
  Outcome<void> reset() override { return stage_->reset(); }
  [[nodiscard]] bool can_reset() const override { return stage_->can_reset(); }
  Outcome<void> renew_models() override { return stage_->renew_models(); }
  Outcome<BothHeard> play(const Script& script) override { return stage_->play(script); }

 private:
  std::unique_ptr<Stage> stage_;
};

/// Of a device that nobody can start again.
class OnceBegunStage : public StageOnAnother {
 public:
  using StageOnAnother::StageOnAnother;
  Outcome<void> reset() override {
    return std::exchange(was_begun_, true) ? Outcome<void>{} : StageOnAnother::reset();
  }
  [[nodiscard]] bool can_reset() const override { return false; }
  Outcome<void> renew_models() override { return {}; }

 private:
  bool was_begun_ = false;
};

/// Keeps what is played.
class KeepingStage final : public StageOnAnother {
 public:
  using StageOnAnother::StageOnAnother;
  Outcome<BothHeard> play(const Script& script) override {
    played.push_back(script);
    return StageOnAnother::play(script);
  }

  std::vector<Script> played;
};

/// Somewhere where nobody is.
class NobodyThere final : public Stage {
 public:
  Outcome<void> reset() override { return {}; }
  [[nodiscard]] bool can_reset() const override { return false; }
  Outcome<void> renew_models() override { return {}; }
  Outcome<BothHeard> play(const Script& script) override {
    BothHeard heard;
    auto& model = heard.models.emplace_back();
    for (const auto& record : script) {
      if (record.direction == Direction::kFromDevice) model.said.push_back(record);
    }
    return heard;
  }
};

/// The guard ends what is played now and then.
class RefusingStage final : public StageOnAnother {
 public:
  RefusingStage(std::unique_ptr<Stage> stage, bool can_reset)
      : StageOnAnother{std::move(stage)}, can_reset_{can_reset} {}
  [[nodiscard]] bool can_reset() const override { return can_reset_; }
  Outcome<BothHeard> play(const Script& script) override {
    constexpr int kOften = 3;
    if (++times_ % kOften == 1) return problem(ErrorCode::kForbidden, "it", "was refused");
    return StageOnAnother::play(script);
  }

 private:
  bool can_reset_;
  int times_ = 0;
};

/// With a device of its own in the place of the target.
class StandInStage final : public StageOnAnother {
 public:
  StandInStage(std::unique_ptr<Stage> stage, std::unique_ptr<Stage> stand_in)
      : StageOnAnother{std::move(stage)}, stand_in_{std::move(stand_in)} {}
  Outcome<BothHeard> play_to_stand_in(const Script& script, std::uint64_t /*seed*/) override {
    return stand_in_->reset().and_then([&] { return stand_in_->play(script); });
  }

 private:
  std::unique_ptr<Stage> stand_in_;
};

/// What shows something shows it every other time, if it has no more records than that.
class RacingStage final : public StageOnAnother {
 public:
  RacingStage(std::unique_ptr<Stage> stage, std::unique_ptr<Stage> sound, std::size_t most)
      : StageOnAnother{std::move(stage)}, sound_{std::move(sound)}, most_{most} {}
  Outcome<void> reset() override {
    return StageOnAnother::reset().and_then([this] { return sound_->reset(); });
  }
  Outcome<BothHeard> play(const Script& script) override {
    const bool is_lucky = script.size() <= most_ && ++plays_ % 2 == 0;
    return is_lucky ? sound_->play(script) : StageOnAnother::play(script);
  }

 private:
  std::unique_ptr<Stage> sound_;
  std::size_t most_;
  int plays_ = 0;
};

/// A sound device that becomes another one for good.
class ChangingStage final : public OnceBegunStage {
 public:
  ChangingStage(std::unique_ptr<Stage> before, std::unique_ptr<Stage> after)
      : OnceBegunStage{std::move(before)}, after_{std::move(after)} {}
  Outcome<void> reset() override {
    return OnceBegunStage::reset().and_then([this] { return after_.reset(); });
  }
  Outcome<BothHeard> play(const Script& script) override {
    constexpr int kSound = 4;
    return ++times_ > kSound ? after_.play(script) : OnceBegunStage::play(script);
  }

 private:
  OnceBegunStage after_;
  int times_ = 0;
};

/// Of a sound device it loses an answer, once. Notes how long the scripts are.
class OnceSilentStage final : public OnceBegunStage {
 public:
  using OnceBegunStage::OnceBegunStage;
  Outcome<BothHeard> play(const Script& script) override {
    auto heard = OnceBegunStage::play(script);
    lengths.push_back(length_of(script));
    if (heard && lengths.size() == kSilent) heard->target.said.clear();
    return heard;
  }

  static constexpr std::size_t kSilent = 40;
  std::vector<Duration> lengths;
};

/// Its target never answers.
class SilentStage final : public StageOnAnother {
 public:
  using StageOnAnother::StageOnAnother;
  Outcome<BothHeard> play(const Script& script) override {
    auto heard = StageOnAnother::play(script);
    if (heard) heard->target.said.clear();
    return heard;
  }
};

/// Notes of each script how long it is, and whether the device is as new.
class NotingStage final : public StageOnAnother {
 public:
  using StageOnAnother::StageOnAnother;
  Outcome<void> reset() override {
    is_new_ = true;
    return StageOnAnother::reset();
  }
  Outcome<BothHeard> play(const Script& script) override {
    played.emplace_back(length_of(script), std::exchange(is_new_, false));
    return StageOnAnother::play(script);
  }

  std::vector<std::pair<Duration, bool>> played;

 private:
  bool is_new_ = false;
};

}  // namespace armjig::campaign
