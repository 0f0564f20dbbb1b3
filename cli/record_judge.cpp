// SPDX-License-Identifier: Apache-2.0
#include "cli/record_judge.hpp"

#include <algorithm>

#include "cli/recorded_session.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig::cli {
namespace {

bool is_read(const KeptRecord& record) {
  return record.kind == LinkKind::kBus && record.direction == Direction::kFromDevice;
}

/// As a judge has it: on a bus with the byte of the address.
std::vector<std::byte> message_of(const KeptRecord& record) {
  auto message = record.bytes;
  if (record.kind != LinkKind::kBus) return message;
  const BusAddress address{static_cast<std::uint8_t>(record.id)};
  const auto head =
      is_read(record) ? head_of(read_from(address, {})) : head_of(write_to(address, {}));
  message.insert(message.begin(), head);
  return message;
}

}  // namespace

Judge& RecordJudge::judge_of(const KeptRecord& record) {
  auto& judge = judges_[record.kind == LinkKind::kSession ? record.id : 0];
  if (!judge) judge = make_judge_();
  judge->set_time(record.time);
  return *judge;
}

std::optional<Refusal> RecordJudge::any_refusal_of(const KeptRecord& record,
                                                   const Permissions& granted) {
  const bool is_asked = record.direction == Direction::kToDevice || is_read(record);
  if (!is_talk(record.kind) || !is_asked) return {};
  const auto message = message_of(record);
  return judge_of(record).judge(is_read(record) ? Bytes{message}.first(1) : Bytes{message},
                                granted);
}

void RecordJudge::observe(const KeptRecord& record) {
  const bool is_heard = record.direction == Direction::kFromDevice || record.kind == LinkKind::kBus;
  if (is_talk(record.kind) && is_heard) judge_of(record).observe(message_of(record));
}

std::optional<Refusal> RecordJudge::refusal_of(const KeptRecord& record,
                                               const Permissions& granted) {
  auto refusal = any_refusal_of(record, granted);
  if (refusal && refusal->cause == Refusal::Cause::kRequest) return refusal;
  observe(record);
  return {};
}

bool RecordJudge::must_stop() {
  return std::ranges::any_of(judges_,
                             [](const auto& one) { return one.second->must_stop().has_value(); });
}

void RecordJudge::leave_out_refused(std::vector<KeptRecord>& script,
                                    const std::vector<KeptRecord>& said,
                                    const Permissions& granted) {
  auto next = said.begin();
  bool is_stopped = false;
  std::erase_if(script, [&](const KeptRecord& record) {
    for (; next != said.end() && next->time <= record.time; ++next) {
      if (next->direction != Direction::kFromDevice) continue;
      observe(*next);
      is_stopped = is_stopped || must_stop();
    }
    if (is_stopped || any_refusal_of(record, granted)) return true;
    observe(record);
    return false;
  });
}

}  // namespace armjig::cli
