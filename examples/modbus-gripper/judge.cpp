// SPDX-License-Identifier: Apache-2.0
#include "judge.hpp"

#include <algorithm>
#include <vector>

#include "rtu.hpp"

namespace gripper {

using namespace armjig;

namespace {

/// Whoever carries the bytes may put silence between any two of them. So every run of bytes that is
/// a good frame counts, wherever it begins and for whomever it is.
class GripperJudge final : public OneStopJudge {
 public:
  GripperJudge() { stop_by(stop_); }

  std::optional<Refusal> judge(Messages messages, const Permissions& permissions) override {
    auto written = written_;
    bool moves = may_be_moving_;
    for (const auto message : messages) {
      for (const auto byte : message) {
        written.push_back(byte);
        if (written.size() > kMostFrame) written.erase(written.begin());
        for (std::size_t i = 0; i < written.size(); ++i) {
          const auto frame = Bytes{written}.subspan(i);
          if (size_of(Direction::kToDevice, frame) != frame.size()) continue;
          if (!has_good_crc(frame)) continue;
          const auto hazard = hazard_of(frame);
          if (auto refusal = demand(hazard, permissions, "this write")) return refusal;
          moves = moves || hazard == Hazard::kGrip;
        }
      }
    }
    std::vector<Message> ignored;
    for (const auto message : messages) {
      dissector_->feed(Direction::kToDevice, {}, message, ignored);  // what is asked for
    }
    written_ = std::move(written);
    may_be_moving_ = moves;
    return std::nullopt;
  }

  /// The echo of a stop, or a status of jaws that stand.
  void observe(Bytes bytes) override {
    std::vector<Message> messages;
    dissector_->feed(Direction::kFromDevice, {}, bytes, messages);
    for (const auto& message : messages) {
      const bool is_stop = std::ranges::equal(message.raw, stop_);
      const auto* status = find_field(message.fields, "status");
      const bool stands = status != nullptr && field_value(*status, message.raw) != kMovingNow;
      if (is_stop || stands) may_be_moving_ = false;
    }
  }

  [[nodiscard]] bool may_be_moving() const override { return may_be_moving_; }

 private:
  static constexpr auto kMovingNow = static_cast<std::int64_t>(Status::kMoving);

  /// What a request asks for, with a good CRC.
  static Hazard hazard_of(Bytes frame) {
    const auto word = [&](std::size_t place) { return load_u16_be(slice<2>(frame, place)); };
    const auto function = static_cast<Function>(frame[1]);
    if (function == Function::kRead) return Hazard::kObserve;
    const std::size_t value = function == Function::kWrite ? 4 : 7;
    const bool is_control = word(2) == kControl;
    if (is_control && word(value) != 0) return Hazard::kGrip;
    return is_control && function == Function::kWrite ? Hazard::kObserve : Hazard::kState;
  }

  Frame written_;  ///< the newest bytes
  std::unique_ptr<Dissector> dissector_ = make_dissector();
  Frame stop_ = write_request(kUnit, kControl, 0);
  bool may_be_moving_ = false;
};

}  // namespace

std::unique_ptr<Judge> make_judge() { return std::make_unique<GripperJudge>(); }

}  // namespace gripper
