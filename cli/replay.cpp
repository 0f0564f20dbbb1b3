// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cli/checks.hpp"
#include "cli/device.hpp"
#include "cli/diff.hpp"
#include "cli/foreign_options.hpp"
#include "cli/outputs.hpp"
#include "cli/target_options.hpp"
#include "emulators/replay/host_role.hpp"
#include "harness/report/wording.hpp"

namespace armjig::cli {
namespace {

constexpr auto kReplayHelp =
    "Plays the host's side of a recording against a device and compares what the device says.\n"
    "\n"
    "  armjig replay session.jsonl --target emulated:                  in virtual time\n"
    "  armjig replay session.pcapng --target pty:/tmp/arm --rules rules.toml --allow state,move\n"
    "  armjig replay session.jsonl --target tcp:robot:51717 --rules rules.toml --speed 0.5\n"
    "\n"
    "Each message leaves at its time. The answers are aligned with the recorded ones as by "
    "'armjig\n"
    "diff'; --rules FILE says what may differ, as there. Without it times are compared, too, "
    "which\n"
    "only an emulated device in virtual time can meet.\n"
    "\n"
    "What goes to a device that is not emulated passes the guard. What the recording needs is "
    "asked\n"
    "for before the first byte.\n"
    "\n"
    "Exit codes: 0 equal within the rules, 1 different, 2 usage or not to be played, 3 the "
    "target,\n"
    "or it needs --allow, 4 nothing to compare.";

struct ReplayOptions {
  std::string file;
  TargetOptions target;
  ComparisonOptions comparison;
  double speed = 1;
  ForeignOptions foreign;
};

/// What a host says and hears in a recording: one link, and what was beside it.
struct Session {
  CaptureLink link;
  CaptureLink events;
  std::vector<KeptRecord> records;
};

bool is_talk(LinkKind kind) {
  return kind == LinkKind::kStream || kind == LinkKind::kSession || kind == LinkKind::kBus;
}

Outcome<Session> read_session(const std::string& path, const ForeignHow& how) {
  const auto reader = open_recording(path, how);
  if (!reader) return tl::unexpected{reader.error()};
  std::optional<Session> session;
  std::vector<KeptRecord> before;
  const auto read = for_each_record(**reader, [&](const CaptureRecord& record) -> Outcome<void> {
    const auto& link = *record.link;
    if (is_talk(link.kind)) {
      if (!session) {
        session = Session{link, {link.device, link.device, LinkKind::kEvents}, {}};
        session->records.swap(before);
      } else if (link != session->link) {
        return problem(ErrorCode::kUnsupported, path,
                       fmt::format("it has two links, '{}' and '{}': cut one out with armjig trace "
                                   "cut --device",
                                   session->link.name, link.name));
      }
    }
    auto& records = session ? session->records : before;
    if (records.size() >= RecordedMessages::kMost) {
      return problem(ErrorCode::kUnsupported, path, "it is too long; cut it with armjig trace cut");
    }
    records.push_back(KeptRecord::from(record));
    return {};
  });
  if (!read) return tl::unexpected{read.error()};
  print_warning_of(**reader);
  if (session) return *std::move(session);
  return problem(ErrorCode::kMalformed, path, "nothing passed on a link in there");
}

/// What the judge of the device refuses of a recording, as far as it was asked for and does not
/// depend on where the device is.
class Need {
 public:
  template <class Kind>
  [[nodiscard]] static std::string of(const Kind& kind, const std::vector<KeptRecord>& records,
                                      Permissions granted) {
    std::string needed;
    for (std::size_t i = 0; i < kHazardCount; ++i) {
      const auto refusal = Need{kind.make_judge}.first(records, granted);
      if (!refusal || granted.allow(refusal->hazard)) break;
      granted.add(refusal->hazard);
      needed += fmt::format("{}{}", needed.empty() ? "" : ",", to_string(refusal->hazard));
    }
    return needed;
  }

 private:
  using MakeJudge = std::unique_ptr<Judge> (*)();
  explicit Need(MakeJudge make_judge) : make_judge_{make_judge} {}

  std::optional<Refusal> first(const std::vector<KeptRecord>& records, const Permissions& granted) {
    for (const auto& record : records) {
      if (!is_talk(record.kind)) continue;
      auto& judge = judges_[record.kind == LinkKind::kSession ? record.id : 0];
      if (!judge) judge = make_judge_();
      judge->set_time(record.time);
      auto message = record.bytes;
      const bool is_read =
          record.kind == LinkKind::kBus && record.direction == Direction::kFromDevice;
      if (record.kind == LinkKind::kBus) {
        const BusAddress address{static_cast<std::uint8_t>(record.id)};
        const auto head =
            is_read ? head_of(read_from(address, {})) : head_of(write_to(address, {}));
        message.insert(message.begin(), head);
      }
      if (record.direction == Direction::kToDevice || is_read) {
        const auto asked = is_read ? Bytes{message}.first(1) : Bytes{message};
        const auto refusal = judge->judge(asked, granted);
        if (refusal && refusal->cause == Refusal::Cause::kRequest) return refusal;
      }
      if (record.direction == Direction::kFromDevice || record.kind == LinkKind::kBus) {
        judge->observe(message);
      }
    }
    return std::nullopt;
  }

  MakeJudge make_judge_;
  std::map<std::uint32_t, std::unique_ptr<Judge>> judges_;  ///< of each connection
};

/// As `RigOptions` are given, on any kind of link; what the guard refused has its reason.
template <class Kind>
Outcome<Played> play(const Kind& kind, const Device& device, const Session& session,
                     const RigOptions& rig_options, const PlayHow& how) {
  if (!rig_options.target.is_emulated()) {
    const auto needed = Need::of(kind, session.records, rig_options.permissions);
    if (!needed.empty()) {
      return problem(ErrorCode::kForbidden, rig_options.target.text,
                     fmt::format("nothing was sent: this recording needs --allow {}", needed));
    }
  }
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

void print_left_out(const Played& played) {
  for (const auto& [what, count] : played.left_out) {
    if (what == "overlooked") continue;  // of whoever recorded it
    fmt::print(stderr, "armjig: {} times '{}' could neither be played nor seen there\n", count,
               wording::line(what));
  }
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

Exit replay(Devices devices, const ReplayOptions& options) {
  const auto rules = rules_of(options.comparison.rules);
  if (!rules) return report(rules.error());
  const auto how = foreign_how(devices, options.foreign, {});
  if (!how) return report(how.error());
  const auto session = read_session(options.file, *how);
  if (!session) return report(session.error());
  const auto* const device = find_recorded_device(devices, session->link.device);
  if (device == nullptr) {
    return report(
        {ErrorCode::kUnknownDevice, options.file,
         fmt::format("it is of '{}'; known are {}", session->link.device, names_of(devices))});
  }
  constexpr std::array kKinds{LinkKind::kStream, LinkKind::kSession, LinkKind::kBus};
  if (kKinds.at(device->port.index()) != session->link.kind) {
    return report({ErrorCode::kUnsupported, options.file, "it is of another kind of link"});
  }
  const auto rig_options = parse_target_options(options.target);
  if (!rig_options) return report(rig_options.error());
  const auto files = open_outputs({{"--html", options.comparison.html}});
  if (!files) return report(files.error());
  const auto claimed = claim_standard_output(options.comparison.wants_json ? "--json" : "");
  if (!claimed) return report(claimed.error());
  const PlayHow play_how{.speed = options.speed, .trailing = rules->time_tolerance};
  const auto played = std::visit(
      [&](const auto& kind) { return play(kind, *device, *session, *rig_options, play_how); },
      device->port);
  if (!played) return report(played.error());
  print_left_out(*played);
  RecordedMessages expected{dissectors_of(devices)};
  RecordedMessages actual{dissectors_of(devices)};
  for (const auto& [records, messages] :
       {std::pair{&played->expected, &expected}, std::pair{&played->actual, &actual}}) {
    if (const auto added = add_messages(*session, *records, *messages); !added) {
      return report(added.error());
    }
  }
  auto found = diff(expected, actual, *rules);
  forgive_ends(*session, *played, rules->time_tolerance, found);
  return tell(found, {options.file, options.target.target, expected.count() + actual.count()},
              options.comparison.wants_json, files->front());
}

}  // namespace

void add_replay(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("replay", kReplayHelp);
  const auto options = std::make_shared<ReplayOptions>();
  command->add_option("FILE", options->file, "a recording, '-' for standard input")->required();
  add_target_options(*command, options->target);
  add_comparison_options(*command, options->comparison);
  command
      ->add_option("--speed", options->speed,
                   "so many times as fast as it was recorded (default: 1)")
      ->type_name("FACTOR")
      ->check(number(0.001, 1000));
  add_foreign_options(*command, options->foreign);
  command->callback([options, devices, &action] {
    action = [options, devices] { return replay(devices, *options); };
  });
}

}  // namespace armjig::cli
