// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/morap_follower.hpp"

#include <numbers>
#include <utility>

#include "harness/drive/morap/joint.hpp"
#include "harness/latency/morap_probe.hpp"
#include "harness/wire/morap/figures.hpp"

namespace armjig::morap::latency {
namespace {

/// Of the motor that most joints have, at the shaft of the gear.
constexpr double kCountsPerRadian =
    4.0 * kDcx22l.constants.pulses_per_turn * kDcx22l.constants.gear_ratio / (2 * std::numbers::pi);

class FirstNode final : public Follower {
 public:
  FirstNode(Rig<BusPort> rig, BusAddress address)
      : rig_{std::move(rig)}, master_{rig_.port()}, joint_{master_, address} {}

  Result<void> begin() {
    if (auto done = outcome_of(joint_.load_default_controllers()); !done) return done;
    wait_until(now() + kProgrammingPause);
    return outcome_of(joint_.calibrate_zero());
  }

  std::string_view unit() const noexcept override { return "steps of the encoder"; }
  double reach() const noexcept override { return 0.2 * kCountsPerRadian; }
  Instant now() const override { return rig_.port().now(); }
  void wait_until(Instant time) override {
    if (time > now()) rig_.port().wait_until(time);
  }
  Result<double> lead(double position, double /*speed*/) override {
    const drive::Angle target{static_cast<float>(position / kCountsPerRadian)};
    if (auto sent = outcome_of(joint_.set_position(target)); !sent) {
      return tl::unexpected{sent.error()};
    }
    const auto [code, angle] = joint_.angle();
    if (auto read = outcome_of(code); !read) return tl::unexpected{read.error()};
    return static_cast<double>(angle.value) * kCountsPerRadian;
  }

 private:
  static Result<void> outcome_of(drive::BusCode code) {
    if (code == drive::BusCode::kOk) return {};
    return fail(drive::error_of(code));
  }

  Rig<BusPort> rig_;
  drive::Master master_;
  drive::Joint joint_;
};

}  // namespace

Outcome<std::unique_ptr<Follower>> make_follower(Rig<BusPort> rig) {
  const auto node = first_node(rig.port(), "the emulated bus");
  if (!node) return tl::unexpected{node.error()};
  auto joint = std::make_unique<FirstNode>(std::move(rig), *node);
  if (const auto begun = joint->begin(); !begun) {
    return problem(begun.error().code, "the emulated node", "it can not be made ready");
  }
  return joint;
}

}  // namespace armjig::morap::latency
