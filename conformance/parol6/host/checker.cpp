// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/host/check.hpp"

#include "conformance/parol6/host/conduct.hpp"
#include "conformance/parol6/host/fields.hpp"
#include "conformance/parol6/host/framing.hpp"
#include "conformance/parol6/host/pace.hpp"
#include "harness/wire/parol6/splitter.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::parol6::programs {
namespace {

class HostChecker final : public ProgramChecker {
 public:
  explicit HostChecker(const LinkNoise& noise)
      : framing_{complain_, noise.most}, pace_{noise.most}, conduct_{noise.most} {}

  void to_device(Instant time, Bytes bytes) override {
    wait_until(time);
    framing_.feed(time, bytes, [this](const CommandFrame& frame) { judge(frame); });
  }

  void wait_until(Instant time) override {
    now_ = time;
    conduct_.wait_until(time, complain_);
  }

  void from_device(Instant time, Bytes bytes) override {
    now_ = time;
    for_each_step(telemetry_, bytes, [&](const Splitter::Step& step) {
      if (const auto frame = telemetry_of(step)) conduct_.telemetry(time, *frame);
    });
  }

  void finish(Instant time) override {
    now_ = time;
    conduct_.finish(time, complain_);
  }

  [[nodiscard]] std::size_t messages() const noexcept override { return frames_; }

 private:
  void judge(const CommandFrame& frame) {
    judge_fields(frame, frames_ == 0, complain_);
    const auto& telemetry = conduct_.last_telemetry();
    gripper_.judge(frame, telemetry ? std::optional{telemetry->gripper} : std::nullopt, complain_);
    pace_.judge(now_, complain_);
    conduct_.command(now_, frame, complain_);
    ++frames_;
  }

  std::size_t frames_ = 0;
  Framing framing_;
  GripperConduct gripper_;
  Pace pace_;
  Conduct conduct_;
  Splitter telemetry_{kTelemetryPayloadSize};
};

}  // namespace

ProgramCheckEntry program_check() noexcept {
  return {"parol6", host_requirements, make_checker<HostChecker>,
          shipped_document("docs/spec/parol6.md")};
}

}  // namespace armjig::parol6::programs
