// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "emulators/campaign/script.hpp"
#include "emulators/replay/host_role.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::campaign {

/// What one side said to a script.
struct Heard {
  std::vector<KeptRecord> said;  ///< in order of time
  std::optional<Problem> end{};  ///< why its link ended in the middle; none: it did not
};

struct BothHeard {
  Heard target;
  std::vector<Heard> models;  ///< each of them is right
  /// By how much what was sent to the target left later than the script has it, at most.
  Duration lateness{};
};

/// Where cases are played: a target, and beside it models of it that get the same at the same
/// times. Of a live target nobody knows to the microsecond when something came, in what pieces, and
/// where in its tick the target was, so there are several models then, each of which gets it as it
/// may have been.
class Stage {
 public:
  Stage() = default;
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  virtual ~Stage() = default;

  /// Begins, and begins again: a target that is emulated or can be started again is as new, and so
  /// are the models. Others stay where they are. Problems: those of opening them.
  [[nodiscard]] virtual Outcome<void> reset() = 0;
  /// Whether `reset` makes the target new.
  [[nodiscard]] virtual bool can_reset() const = 0;
  /// The models alone are as new. Problems: those of opening them.
  [[nodiscard]] virtual Outcome<void> renew_models() = 0;

  /// Plays it to both, where they are now, and listens a little longer. What ends a link is no
  /// problem but heard; a problem is that the guard refused something (`kForbidden`), or stopped
  /// the target because this program had been silent for too long: it does not stand where the
  /// models do then. The next one is played under a new supervisor.
  [[nodiscard]] virtual Outcome<BothHeard> play(const Script& script) = 0;

  /// The same with a model in the place of a live target, both as new. All comes to it as unevenly
  /// as over a link, which `seed` decides: what is heard then that no model says, tells nothing of
  /// the target. Target and models of `play` stay where they are. Without models, and here by
  /// default, nothing is heard. Problems: those of opening models.
  [[nodiscard]] virtual Outcome<BothHeard> play_to_stand_in(const Script& /*script*/,
                                                            std::uint64_t /*seed*/) {
    return BothHeard{};
  }
};

/// How a target and its model are had.
template <class Port>
struct StageSetup {
  std::function<Outcome<Rig<Port>>()> make_target;
  std::function<Outcome<Rig<Port>>()> make_model;  ///< empty: there is none beside the target
  /// Starts the program of a target that is not emulated again; false: that did not work. Empty:
  /// nobody can.
  std::function<bool()> restart;
  bool is_emulated = false;
  PlayHow how;
  Duration patience = std::chrono::seconds{10};  ///< for one that was started again
};

/// On any kind of port.
template <class Port>
class StageOn final : public Stage {
 public:
  explicit StageOn(StageSetup<Port> setup) : setup_{std::move(setup)} {}

  Outcome<void> reset() override {
    if (target_ && !can_reset()) return {};
    return make_target().and_then([this] { return renew_models(); });
  }
  [[nodiscard]] bool can_reset() const override { return setup_.is_emulated || setup_.restart; }
  Outcome<void> renew_models() override;
  Outcome<BothHeard> play(const Script& script) override;
  Outcome<BothHeard> play_to_stand_in(const Script& script, std::uint64_t seed) override;

 private:
  using Models = std::vector<Rig<Port>>;

  [[nodiscard]] Outcome<void> make_target();
  /// Whether the target was not left alone for too long.
  [[nodiscard]] Outcome<void> watch_over();
  [[nodiscard]] Outcome<Rig<Port>> make_model() const;
  [[nodiscard]] Outcome<Models> make_models() const;
  /// What a target said, and beside it what models say that get it as that one may have.
  [[nodiscard]] BothHeard beside(Models& models, const Script& script, Outcome<Played> played);

  StageSetup<Port> setup_;
  std::optional<Rig<Port>> target_;
  Models models_;
  Instant last_end_{};
  bool was_open_ = false;
};

extern template class StageOn<StreamPort>;
extern template class StageOn<SessionSource>;
extern template class StageOn<BusPort>;

}  // namespace armjig::campaign
