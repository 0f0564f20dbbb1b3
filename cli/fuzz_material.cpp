// SPDX-License-Identifier: Apache-2.0
#include "cli/fuzz_material.hpp"

#include <fmt/core.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <set>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "cli/record_judge.hpp"

namespace armjig::cli {
namespace {

using namespace std::chrono_literals;
using campaign::Material;
using campaign::Script;
using campaign::Spacing;

/// The connection that the harmless question has for itself.
constexpr std::uint32_t kOwnConnection = 99;

/// How long what is asked harmlessly may take.
constexpr Duration kPauseAfterQuestion = 20ms;

/// What is answered comes before the end: something has to be at the end.
constexpr Duration kBeforeEnd = 100ms;

/// In real time an epilogue takes as long as several other cases.
constexpr std::int64_t kEpilogueLive = 12;

/// On a link in real time, what is closer together may come in one piece or in two, and nobody
/// knows which. A client that leaves at once may or may not have its answer, and a server that
/// answers one who has gone may be another thing after it than one that answered in time.
Spacing spacing_live(const Device& device) {
  return {.least = 3ms, .around_ends = 100ms, .works_on = device.fuzz.works_on};
}

/// A transaction as the probe of a bus has it: a byte with address and direction, then what is
/// written or how much is read.
KeptRecord transaction(Bytes message, Instant time) {
  const auto head = std::to_integer<std::uint32_t>(message.front());
  KeptRecord record{.time = time, .kind = LinkKind::kBus, .id = head >> 1U};
  if ((head & 1U) == 0) {
    record.bytes.assign(message.begin() + 1, message.end());
    record.details = R"("ack":"")";
    return record;
  }
  record.direction = Direction::kFromDevice;
  record.details = fmt::format(R"("n":{},"ack":"")", std::to_integer<unsigned>(message.back()));
  return record;
}

/// A harmless question as a script, from what is asked to measure latencies. Of a server it is
/// asked on a connection of its own, after `stop`.
Script harmless_script(LinkKind kind, std::vector<Bytes> messages, Messages stop) {
  Script script;
  Instant time{};
  if (kind == LinkKind::kSession) {
    campaign::add(script, campaign::border("connect", kOwnConnection, "ok"));
    time += kPauseAfterQuestion;
    messages.insert(messages.begin(), stop.begin(), stop.end());
  }
  for (const auto& message : messages) {
    if (kind == LinkKind::kBus) {
      script.push_back(transaction(message, time));
    } else {
      script.push_back({.time = time,
                        .kind = kind,
                        .direction = Direction::kToDevice,
                        .id = kind == LinkKind::kSession ? kOwnConnection : 0,
                        .bytes = {message.begin(), message.end()}});
    }
    time += kPauseAfterQuestion;
  }
  if (kind == LinkKind::kSession) {
    const auto pause = time + kBeforeEnd - script.back().time;
    campaign::add(script, campaign::border("disconnect", kOwnConnection, "client-close"), pause);
  } else if (!script.empty()) {
    const auto again = script;
    for (auto record : again) {
      record.time += time.time_since_epoch();
      script.push_back(std::move(record));
    }
  }
  return script;
}

// Who is there: on a bus, who acknowledges.
std::vector<std::uint32_t> addresses_on(BusPort& port) {
  constexpr std::uint8_t kFirst = 8;  // those below and above are reserved
  constexpr std::uint8_t kLast = 119;
  std::vector<std::uint32_t> there;
  for (auto address = kFirst; address <= kLast; ++address) {
    const auto reply = port.start(BusAddress{address}, Access::kWrite);
    (void)port.stop();
    if (reply && *reply == Ack::kAck) there.push_back(address);
  }
  return there;
}
template <class Port>
std::vector<std::uint32_t> addresses_on(Port& /*port*/) {
  return {};
}

template <class Kind>
LinkKind link_of() {
  if (std::is_same_v<Kind, OnServer>) return LinkKind::kSession;
  return std::is_same_v<Kind, OnBus> ? LinkKind::kBus : LinkKind::kStream;
}

/// Leaves out what the guard would refuse, and what follows nothing then.
auto permit_of(RecordJudge::MakeJudge make_judge, const Permissions& granted) {
  return [make_judge, granted](Script& script) {
    RecordJudge judge{make_judge};
    std::erase_if(script, [&](const KeptRecord& record) {
      return judge.refusal_of(record, granted).has_value();
    });
  };
}

/// The same, given what a sound device says. What is left out changes that, so it is asked again.
auto permit_case_of(RecordJudge::MakeJudge make_judge, const Permissions& granted,
                    std::function<std::vector<KeptRecord>(const Script&)> rehearse) {
  return [make_judge, granted, rehearse = std::move(rehearse)](Script& script) {
    constexpr int kTimes = 6;
    for (int left = kTimes; left > 0; --left) {
      const auto size = script.size();
      RecordJudge{make_judge}.leave_out_refused(script, rehearse(script), granted);
      if (script.size() == size) return;
    }
  };
}

template <class Port>
Outcome<Rig<Port>> open_fresh(const Wiring<Port>& wiring, const RigOptions& how) {
  return Rig<Port>::open(wiring, how);
}

/// Who does not has said all that it has to say when it was last read.
template <class Kind>
constexpr bool kSpeaksUnasked = !std::is_same_v<typename Kind::Port, BusPort>;

/// A target without models.
template <class Kind>
auto setup_of(const Device& device, const Kind& kind, const RigOptions& how, const Hand& hand,
              Duration trailing) {
  campaign::StageSetup<typename Kind::Port> setup{
      .make_target = [&device, &kind, how] { return open_fresh(wiring_of(device, kind), how); },
      .make_model = {},
      .restart = {},
      .is_emulated = how.target.is_emulated(),
      .how = {.touches_of = device.replay.touches_of,
              .trailing = kSpeaksUnasked<Kind> ? trailing : Duration{}}};
  if (how.target.is_emulated()) return setup;
  if (hand.has("restart")) {
    setup.restart = [hand] { return hand.set("restart", 1); };
  }
  setup.how.by_hand = [hand](std::string_view input, std::int64_t value) {
    return hand.has(input) && hand.set(input, value);
  };
  return setup;
}

/// What the device on an emulated stage says to a script.
auto rehearsal_on(const std::shared_ptr<campaign::Stage>& stage) {
  return [stage](const Script& script) {
    const auto heard = stage->reset().and_then([&] { return stage->play(script); });
    return heard ? heard->target.said : std::vector<KeptRecord>{};
  };
}

/// `complete(kind, setup)` adds to what all stages have.
template <class Complete>
std::unique_ptr<campaign::Stage> stage_with(const Device& device, const RigOptions& how,
                                            const Hand& hand, Duration trailing,
                                            Complete complete) {
  return std::visit(
      [&](const auto& kind) -> std::unique_ptr<campaign::Stage> {
        using Port = typename std::remove_cvref_t<decltype(kind)>::Port;
        auto setup = setup_of(device, kind, how, hand, trailing);
        complete(kind, setup);
        return std::make_unique<campaign::StageOn<Port>>(std::move(setup));
      },
      device.port);
}

}  // namespace

Outcome<Material> material_of(const Device& device, const RigOptions& how, const RigOptions& model,
                              Duration longest) {
  return std::visit(
      [&](const auto& kind) -> Outcome<Material> {
        using Kind = std::remove_cvref_t<decltype(kind)>;
        auto rig = open_fresh(wiring_of(device, kind), model);
        if (!rig) return tl::unexpected{rig.error()};
        Material material{.kind = link_of<Kind>(),
                          .make_dissector = device.make_dissector,
                          .draw_session = device.draw_session,
                          .harmless = {},
                          .seal = device.fuzz.seal,
                          .addresses = addresses_on(rig->port()),
                          .strays = device.fuzz.strays,
                          .astray_fields = device.fuzz.astray_fields,
                          .has_hands = how.target.is_emulated(),
                          .has_operations = how.target.is_emulated(),
                          .longest = longest,
                          .spacing = how.target.is_emulated() ? Spacing{} : spacing_live(device),
                          .epilogue = device.fuzz.epilogue};
        auto probe = kind.make_probe(rig->port(), model.target.text);
        if (!probe) return tl::unexpected{probe.error()};
        const auto request = (*probe)->request();
        // An arm goes on without its client, so that of a real one is stopped after each case. The
        // model gets the same; what the guard did by itself it would not.
        const auto judge = kind.make_judge();
        material.harmless = harmless_script(material.kind, {request.begin(), request.end()},
                                            how.target.is_emulated() ? Messages{} : judge->stop());
        if (!how.target.is_emulated()) {
          material.permit = permit_of(kind.make_judge, how.permissions);
          material.epilogue.one_in = kEpilogueLive;
          material.rehearse = rehearsal_on(stage_alone(device, model, {}, 1));
          material.permit_case =
              permit_case_of(kind.make_judge, how.permissions, material.rehearse);
        }
        return material;
      },
      device.port);
}

std::unique_ptr<campaign::Stage> stage_of(const Device& device, const RigOptions& how,
                                          const Device& reference, const RigOptions& model,
                                          const Hand& hand, Duration trailing) {
  return stage_with(device, how, hand, trailing, [&](const auto& kind, auto& setup) {
    setup.make_model = [&reference, model] {
      using Kind = std::remove_cvref_t<decltype(kind)>;
      return open_rig<Kind>(reference, model);
    };
  });
}

Target sound_target(DeviceOptions options) {
  Target sound{"emulated:", "emulated", "", std::move(options)};
  sound.options.erase("fault");
  const char* mark = "?";
  for (const auto& [name, value] : sound.options) {
    sound.text += fmt::format("{}{}={}", std::exchange(mark, "&"), name, value);
  }
  return sound;
}

std::unique_ptr<campaign::Stage> stage_alone(const Device& device, const RigOptions& how,
                                             const Hand& hand, double speed) {
  return stage_with(device, how, hand, {}, [&](const auto& /*kind*/, auto& setup) {
    if (how.target.is_emulated()) return;
    setup.how.speed = speed;
    setup.how.after_late = AfterLate::kShifted;
  });
}

std::string port_name_of(const Device& device) {
  constexpr std::array kNames{"OnStream", "OnServer", "OnBus"};
  return kNames.at(device.port.index());
}

Outcome<void> copy_into(const std::string& path, const campaign::CampaignFacts& facts,
                        const campaign::CampaignState& state,
                        const std::vector<std::string>& from) {
  namespace fs = std::filesystem;
  const auto folder = campaign::Folder::open(path, facts);
  if (!folder) return tl::unexpected{folder.error()};
  for (const auto& one : from) {
    for (const auto* const part : {"findings", "worthy"}) {
      constexpr auto kHow = fs::copy_options::skip_existing | fs::copy_options::recursive;
      std::error_code error;
      fs::copy(fs::path{one} / part, fs::path{path} / part, kHow, error);
      if (error) return problem(ErrorCode::kCannotWrite, path, error.message());
    }
  }
  return folder->keep(state);
}

}  // namespace armjig::cli
