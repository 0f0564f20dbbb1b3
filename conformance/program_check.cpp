// SPDX-License-Identifier: Apache-2.0
#include "conformance/program_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "harness/core/version.hpp"

namespace armjig {
namespace {

constexpr std::size_t kRemembered = 3;

}  // namespace

/// The one way by which the checker is shown anything.
template <class Show>
void ProgramCheck::hear(Show show) {
  const std::lock_guard lock{guard_};
  show(*checker_);
  take_offences();
}

template <class Show>
void ProgramCheck::hear_program(Instant time, Show show) {
  hear([&](ProgramChecker& checker) {
    now_ = time;
    show(checker);
  });
}

void ProgramCheck::to_device(Instant time, Bytes bytes) {
  hear_program(time, [&](ProgramChecker& checker) { checker.to_device(time, bytes); });
}

void ProgramCheck::from_device(Instant time, Bytes bytes) {
  hear([&](ProgramChecker& checker) { checker.from_device(time, bytes); });
}

void ProgramCheck::on_connection(const ConnectionEvent& event) {
  using Kind = ConnectionEvent::Kind;
  const auto show = [&](ProgramChecker& checker) { checker.on_connection(event); };
  const bool is_devices = event.kind == Kind::kFromServer || event.kind == Kind::kDropped;
  is_devices ? hear(show) : hear_program(event.time, show);
}

void ProgramCheck::on_bus(const BusPart& part) {
  const auto message = acknowledged(part);
  if (message.empty()) return;
  hear_program(part.end, [&](ProgramChecker& checker) {
    part.is_read ? checker.from_device(part.end, message) : checker.to_device(part.end, message);
  });
}

void ProgramCheck::wait_until(Instant time) {
  hear_program(time, [&](ProgramChecker& checker) { checker.wait_until(time); });
}

void ProgramCheck::overlook(Instant from, Instant to) {
  hear([&](ProgramChecker& checker) { checker.overlook(from, to); });
}

ProgramCheck::ProgramCheck(const ProgramCheckEntry& entry, const LinkNoise& noise,
                           std::function<void(const Offence&)> on_offence)
    : entry_{entry}, checker_{entry.make(noise)}, on_offence_{std::move(on_offence)} {}

void ProgramCheck::take_offences() {
  for (auto& offence : checker_->take_offences()) {
    auto& record = records_[offence.requirement];
    ++record.count;
    on_offence_(offence);
    if (record.first.size() < kRemembered) record.first.push_back(std::move(offence));
  }
}

std::size_t ProgramCheck::count(std::string_view requirement) const {
  const std::lock_guard lock{guard_};
  const auto record = records_.find(requirement);
  return record == records_.end() ? 0 : record->second.count;
}

Report ProgramCheck::finish() {
  const std::lock_guard lock{guard_};
  checker_->finish(now_);
  take_offences();
  Report report;
  report.title = fmt::format("Programs that talk to {}", entry_.device);
  report.facts = {{"armjig", std::string{kVersion}},
                  {"messages", std::to_string(checker_->messages())},
                  {"device time", fmt::format("{:.3f} s", seconds(now_))}};
  if (const auto overlooked = seconds(at(checker_->overlooked())); overlooked > 0) {
    report.facts.emplace_back(
        "overlooked", fmt::format("{:.3f} s ({:.1f} %): armjig was late itself then", overlooked,
                                  100 * overlooked / std::max(seconds(now_), overlooked)));
  }
  for (const auto& requirement : entry_.requirements()) {
    report.rows.push_back(row_of(requirement));
  }
  return report;
}

ReportRow ProgramCheck::row_of(const Requirement& requirement) const {
  auto row = row_about(requirement, entry_.document);
  row.name = requirement.id;
  row.summary = requirement.text;
  const auto found = records_.find(requirement.id);
  if (found != records_.end()) {
    const auto& record = found->second;
    row.verdict = Verdict::kFail;
    row.expected = requirement.text;
    row.actual = fmt::format("{} times, first at {:.3f} s: {}", record.count,
                             seconds(record.first.front().time), record.first.front().what);
    for (const auto& offence : record.first) {
      row.evidence += fmt::format("{:.3f} s {}\n", seconds(offence.time), offence.what);
    }
  } else if (checker_->is_in_doubt(requirement.id)) {
    row.verdict = Verdict::kInconclusive;
    row.actual = "it looked broken, but only while armjig was late itself";
  } else if (!checker_->had_occasion(requirement)) {
    row.verdict = Verdict::kSkipped;
    row.actual = checker_->messages() == 0
                     ? "no program sent anything whole"
                     : fmt::format("no occasion without {}", requirement.occasion);
  }
  return row;
}

}  // namespace armjig
