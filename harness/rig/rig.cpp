// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/rig.hpp"

#include <algorithm>
#include <utility>

#include "harness/link/reopening_stream.hpp"
#include "harness/rig/wire_log.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {
namespace {

auto problem_of_guard(const Target& target, const Error& error) {
  const auto* const hint = error.code == ErrorCode::kSystem
                               ? "the process that watches over the arm cannot be started"
                               : "it does not take what it is sent";
  return problem(error.code, target.text, hint);
}

Outcome<std::unique_ptr<StreamPort>> open_port(const RigOptions& options,
                                               OpenEmulated open_emulated) {
  const bool reopens = options.when_gone == WhenGone::kReopen && !options.target.is_emulated();
  if (reopens && options.permissions.allow_motion()) {
    return problem(ErrorCode::kBadValue, "--reconnect with --allow",
                   "an arm that was gone and may move has to be looked at by a person first");
  }
  auto port = open_stream(options.target, open_emulated);
  if (!port || !reopens) return port;
  return std::make_unique<ReopeningStream>(*std::move(port), [options, open_emulated] {
    return open_stream(options.target, open_emulated);
  });
}

}  // namespace

Outcome<Rig> Rig::open(std::string_view device, const RigOptions& options,
                       OpenEmulated open_emulated) {
  auto port = open_port(options, open_emulated);
  if (!port) return tl::unexpected{port.error()};
  Rig rig{*std::move(port)};
  if (!options.wire_log.empty()) {
    const auto entry = std::ranges::find(dissectors(), device, &DissectorEntry::device);
    auto logged = LoggedStream::log(std::move(rig.port_), options.wire_log, *entry);
    if (!logged) return tl::unexpected{logged.error()};
    rig.port_ = *std::move(logged);
  }
  if (!options.target.is_emulated()) {
    const auto judge = std::ranges::find(judges(), device, &JudgeEntry::device);
    auto guarded = GuardedStream::guard(std::move(rig.port_), judge->make(), options.permissions);
    if (!guarded) return problem_of_guard(options.target, guarded.error());
    rig.guard_ = guarded->get();
    rig.port_ = *std::move(guarded);
  }
  if (options.impairment) {
    auto impaired = std::make_unique<ImpairedStream>(std::move(rig.port_), *options.impairment);
    rig.impaired_ = impaired.get();
    rig.port_ = std::move(impaired);
  }
  return rig;
}

std::optional<Refusal> Rig::last_refusal() const {
  return guard_ == nullptr ? std::nullopt : guard_->last_refusal();
}

bool Rig::is_unsupervised() const { return guard_ != nullptr && guard_->is_unsupervised(); }

std::optional<ImpairmentStatistics> Rig::impairments() const {
  if (impaired_ == nullptr) return std::nullopt;
  return impaired_->statistics();
}

}  // namespace armjig
