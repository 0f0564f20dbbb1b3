// SPDX-License-Identifier: Apache-2.0
#include "cli/record_judge.hpp"

#include "cli/recorded_session.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig::cli {

std::optional<Refusal> RecordJudge::refusal_of(const KeptRecord& record,
                                               const Permissions& granted) {
  const bool is_bus = record.kind == LinkKind::kBus;
  if (!is_talk(record.kind)) return {};
  auto& judge = judges_[record.kind == LinkKind::kSession ? record.id : 0];
  if (!judge) judge = make_judge_();
  judge->set_time(record.time);
  const bool is_read = is_bus && record.direction == Direction::kFromDevice;
  auto message = record.bytes;
  if (is_bus) {
    const BusAddress address{static_cast<std::uint8_t>(record.id)};
    const auto head = is_read ? head_of(read_from(address, {})) : head_of(write_to(address, {}));
    message.insert(message.begin(), head);
  }
  if (record.direction == Direction::kToDevice || is_read) {
    const auto asked = is_read ? Bytes{message}.first(1) : Bytes{message};
    auto refusal = judge->judge(asked, granted);
    if (refusal && refusal->cause == Refusal::Cause::kRequest) return refusal;
  }
  if (record.direction == Direction::kFromDevice || is_bus) judge->observe(message);
  return {};
}

}  // namespace armjig::cli
