// SPDX-License-Identifier: Apache-2.0
#include "cli/replaying.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "cli/device.hpp"
#include "cli/diff.hpp"
#include "cli/record_judge.hpp"
#include "cli/recorded_session.hpp"
#include "cli/serving.hpp"
#include "emulators/replay/device_role.hpp"
#include "emulators/replay/host_role.hpp"

namespace armjig::cli {
namespace {

/// The permissions that a recording needs besides those that are granted, as `--allow` has them;
/// empty: none.
std::string needed_for(RecordJudge::MakeJudge make_judge, const std::vector<KeptRecord>& records,
                       Permissions granted) {
  const auto first_refusal = [&]() -> std::optional<Refusal> {
    RecordJudge judge{make_judge};
    for (const auto& record : records) {
      if (auto refusal = judge.refusal_of(record, granted)) return refusal;
    }
    return std::nullopt;
  };
  std::string needed;
  for (std::size_t i = 0; i < kHazardCount; ++i) {
    const auto refusal = first_refusal();
    if (!refusal || granted.allow(refusal->hazard)) break;
    granted.add(refusal->hazard);
    needed += fmt::format("{}{}", needed.empty() ? "" : ",", to_string(refusal->hazard));
  }
  return needed;
}

/// As `RigOptions` are given, on any kind of link; what the guard refused has its reason.
template <class Kind>
Outcome<Played> play(const Kind& kind, const Device& device, const Session& session,
                     RigOptions rig_options, const PlayHow& how) {
  if (!rig_options.target.is_emulated()) {
    const auto needed = needed_for(kind.make_judge, session.records, rig_options.permissions);
    if (!needed.empty()) {
      return problem(ErrorCode::kForbidden, rig_options.target.text,
                     fmt::format("nothing was sent: this recording needs --allow {}", needed));
    }
  }
  rig_options.when_left = WhenLeft::kSayNothing;  // as who was recorded
  auto rig = Rig<typename Kind::Port>::open(wiring_of(device, kind), rig_options);
  if (!rig) return tl::unexpected{rig.error()};
  auto played = play_host(rig->port(), session.records, how);
  if (played) return played;
  const auto refusal = rig->last_refusal();
  const auto code = played.error().code;
  return problem(code, rig_options.target.text,
                 code == ErrorCode::kForbidden && refusal ? refusal->reason : played.error().hint);
}

/// One side of what was played, as messages.
Outcome<void> add_messages(const Session& session, const std::vector<KeptRecord>& records,
                           RecordedMessages& messages) {
  for (const auto& record : records) {
    const auto& link = record.kind == LinkKind::kEvents ? session.events : session.link;
    if (auto added = messages.add(record.on(link)); !added) return added;
  }
  messages.finish();
  return {};
}

/// What comes after the end is in no recording; and what may be late may be so late that the host
/// has ended the connection.
void forgive_ends(const Session& session, const Played& played, Duration tolerance,
                  std::vector<RecordingDifference>& found) {
  const auto end = session.records.back().time;
  std::erase_if(found, [&](const RecordingDifference& one) {
    if (one.change == Change::kExtra) return one.time() + tolerance > end;
    return one.change == Change::kMissing &&
           std::ranges::any_of(played.ends, [&](const auto& ended) {
             const auto& [id, time] = ended;
             const bool is_of_it = one.lane.find(fmt::format(" session {} ", id)) != one.lane.npos;
             return is_of_it && one.time() <= time && time <= one.time() + tolerance;
           });
  });
}

/// An emulated target about which nothing is said is like the recorded device, if that is known.
template <class Kind>
RigOptions like_recorded(const Kind& kind, const std::string& path, RigOptions rig) {
  if (rig.target.is_emulated() && rig.target.options.empty() && path != "-" &&
      emulate_like(kind, path)) {
    rig.target.options.emplace(kLike, path);
  }
  return rig;
}

/// Both sides as messages.
Outcome<ReplayedRecording> as_messages(Devices devices, const Session& session,
                                       const std::vector<KeptRecord>& expected,
                                       const std::vector<KeptRecord>& actual) {
  ReplayedRecording replayed{
      RecordedMessages{dissectors_of(devices)}, RecordedMessages{dissectors_of(devices)}, {}, {}};
  for (const auto& [records, messages] :
       {std::pair{&expected, &replayed.expected}, std::pair{&actual, &replayed.actual}}) {
    if (const auto added = add_messages(session, *records, *messages); !added) {
      return tl::unexpected{added.error()};
    }
  }
  return replayed;
}

void warn_of_patience(const HostSaid& said) {
  if (said.not_awaited == 0) return;
  fmt::print(stderr,
             "armjig: {} things that the program was to do were not waited for any longer\n",
             said.not_awaited);
}

}  // namespace

Outcome<ReplayedRecording> replay_recording(Devices devices, const std::string& path,
                                            const ReplayHow& how) {
  return read_known_session(devices, path, how.foreign).and_then([&](const KnownSession& known) {
    return replay_session(devices, known, path, how, Compare::kYes);
  });
}

Outcome<ReplayedRecording> replay_session(Devices devices, const KnownSession& known,
                                          const std::string& path, const ReplayHow& how,
                                          Compare compare) {
  const auto& [session, device] = known;
  const auto rules =
      how.rules ? Outcome<ComparisonRules>{*how.rules} : rules_beside(*device, how.rig.target, {});
  if (!rules) return tl::unexpected{rules.error()};
  PlayHow play_how{.speed = how.speed,
                   .touches_of = device->replay.touches_of,
                   .trailing = rules->time_tolerance};
  auto played = std::visit(
      [&](const auto& kind) {
        if (kind.set_up != nullptr && !session.is_of_capture) play_how.lead = Duration{1};
        return play(kind, *device, session, like_recorded(kind, path, how.rig), play_how);
      },
      device->port);
  if (!played) return tl::unexpected{played.error()};
  auto replayed = as_messages(devices, session, played->expected, played->actual);
  if (!replayed) return replayed;
  replayed->left_out = std::move(played->left_out);
  if (compare == Compare::kNo) return replayed;
  replayed->found = diff(replayed->expected, replayed->actual, *rules);
  forgive_ends(session, *played, rules->time_tolerance, replayed->found);
  return replayed;
}

Outcome<ReplayedRecording> play_recorded_device(Devices devices, const std::string& path,
                                                const ListenHow& how) {
  const auto known = read_known_session(devices, path, how.foreign);
  if (!known) return tl::unexpected{known.error()};
  const auto& [session, device] = *known;
  auto serving = parse_listen(how.place, *device);
  if (!serving) return tl::unexpected{serving.error()};
  auto [hosted, said] = play_device(session.link.kind, session.records,
                                    {.speed = how.speed,
                                     .trailing = how.rules.time_tolerance,
                                     .make_dissector = device->make_dissector});
  std::vector<ToServe> devices_to_serve;
  devices_to_serve.push_back({std::move(hosted), *std::move(serving)});
  if (auto served =
          serve(std::move(devices_to_serve), {.wants_json = how.wants_json, .is_quiet = true});
      !served) {
    return tl::unexpected{served.error()};
  }
  warn_of_patience(*said);
  auto replayed = as_messages(devices, session, said->expected, said->actual);
  if (!replayed) return replayed;
  replayed->left_out = said->left_out;
  replayed->found = diff(replayed->expected, replayed->actual, how.rules);
  return replayed;
}

}  // namespace armjig::cli
