// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "cli/command.hpp"
#include "conformance/bench.hpp"
#include "conformance/mutation.hpp"
#include "conformance/program_check.hpp"
#include "conformance/suite.hpp"
#include "emulators/campaign/alphabet.hpp"
#include "emulators/campaign/intervals.hpp"
#include "emulators/campaign/material.hpp"
#include "emulators/memory/clocked.hpp"
#include "emulators/memory/hosted.hpp"
#include "emulators/memory/in_memory.hpp"
#include "emulators/memory/serial_line.hpp"
#include "emulators/replay/on_port.hpp"
#include "emulators/replay/replay.hpp"
#include "emulators/sessions/sessions.hpp"
#include "emulators/shadow/fit.hpp"
#include "harness/capture/trace.hpp"
#include "harness/config/option_file.hpp"
#include "harness/console/device_console.hpp"
#include "harness/console/watched.hpp"
#include "harness/core/error.hpp"
#include "harness/core/option.hpp"
#include "harness/latency/follower.hpp"
#include "harness/latency/probe.hpp"
#include "harness/rig/attached.hpp"
#include "harness/rig/real_target.hpp"
#include "harness/rig/rig.hpp"
#include "harness/rig/stream_link.hpp"
#include "harness/rig/target.hpp"
#include "harness/rig/wiring.hpp"
#include "harness/wire/dissection.hpp"

namespace armjig::cli {

/// What of a device depends on its kind of port. `where` is what messages call the options.
template <class PortType, class HostedType>
struct OnPort {
  using Port = PortType;
  using Hosted = HostedType;

  std::unique_ptr<Judge> (*make_judge)(){};  ///< for the guard of a real one
  /// The emulated device. Problems: `kUnknownOption`, `kBadValue`, those of files it names.
  Outcome<std::unique_ptr<Hosted>> (*emulate)(const DeviceOptions& options,
                                              const std::string& where){};
  /// One like that of a recording, as its header describes it; nullptr: no header does. Problems:
  /// `kMalformed`.
  Outcome<std::unique_ptr<Hosted>> (*set_up)(const Trace& recording){};
  Outcome<std::unique_ptr<Bench>> (*make_bench)(Rig<Port> rig, const RigOptions& how){};
  Outcome<std::unique_ptr<DeviceConsole>> (*open_console)(Rig<Port> rig, const std::string& target,
                                                          Say say){};
  Outcome<std::unique_ptr<Watched>> (*watch)(Rig<Port> rig, const std::string& target,
                                             const WatchHow& how){};
  /// How long it takes to answer is measured with that. `port` is only lent. Problems: it does not
  /// answer, or the port.
  Outcome<std::unique_ptr<Probe>> (*make_probe)(Port& port, const std::string& target){};
  /// An emulated one is led along a way with that, to tell what jitter costs; none: nobody can
  /// tell.
  Outcome<std::unique_ptr<Follower>> (*make_follower)(Rig<Port> rig){};
};

struct OnStream : OnPort<StreamPort, HostedStream> {
  /// How its serial port is set, and how long characters take; none: USB, where both mean nothing.
  std::optional<SerialLine> line{};
  std::optional<UsbId> usb{};  ///< of a board that can be told by it
};

struct OnServer : OnPort<SessionSource, HostedServer> {
  std::uint16_t tcp_port{};  ///< where clients look for it
};

struct OnBus : OnPort<BusPort, HostedBus> {};

/// What a campaign (`armjig fuzz`) knows of a device besides; a device that says nothing of it has
/// campaigns, too.
struct FuzzEntry {
  /// Makes lengths and checksums of a message right again, where sessions drawn at random do not.
  void (*seal)(std::span<std::byte> message){};
  /// How long after a message began the device may still be busy with it, where what comes
  /// meanwhile changes what it makes of it: live nobody knows whether it does; nullptr: never.
  Duration (*works_on)(Bytes message){};
  /// Whether what comes of a message depends on more than answers tell, such as how far a joint is
  /// from its switch or where a node is in its tick: live it is not watched. nullptr: of none.
  bool (*strays)(Bytes message){};
  /// The fields of answers that tell what comes of it: of a target that nobody can start again they
  /// are not judged from there on.
  std::span<const std::string_view> astray_fields{};
  /// Where the device tells how far apart messages came; none: nowhere.
  std::optional<campaign::ToldInterval> told_interval{};
  /// With which cases end now and then, where the device does not show at once where it was led.
  campaign::Epilogue epilogue{};
  /// The machines that `--learn` learns; empty: none.
  std::span<const campaign::Learnable> machines{};
};

/// Adds a subcommand that only this device has.
using AddOwnCommand = void (*)(CLI::App& app, const Device& device, Action& action);

/// A device, as all rooms and subcommands know it: one value, written in one place. A stranger's
/// program has its own (docs/adding-a-device.md).
struct Device {
  std::string_view name;
  std::string_view title;  ///< what it is, in a few words
  std::unique_ptr<Dissector> (*make_dissector)(){};
  std::variant<OnStream, OnServer, OnBus> port;
  std::span<const OptionRow> (*options)() noexcept {};  ///< of the emulated one
  Suite (*suite)(){};
  MutantsEntry (*mutants)() noexcept {};
  /// Finds requests and answers in recordings; none: `latency --from` can not.
  std::unique_ptr<Probe> (*make_listener)(){};
  std::optional<ProgramCheckEntry> program_check{};  ///< none: nothing is demanded of programs
  Replay replay{};                                   ///< how recordings drive it
  DrawSession draw_session{};                        ///< none: nothing is drawn at random
  /// In what a live device may differ from the emulated one: rules as of `armjig replay --rules`.
  /// Empty: in times by 100 ms, and in the order.
  std::string_view live_rules{};
  FuzzEntry fuzz{};
  Dissection (*dissection)(){};  ///< none: Wireshark is told nothing
  /// What of the emulated device can be told from a recording of a board; none: nothing.
  std::span<const FitFigure> (*figures)() noexcept {};
  double watch_rate = 10;  ///< questions, or looks, a second unless the user wants another one
  std::vector<AddOwnCommand> commands{};
};

/// The option that every emulated device has: `like=FILE`, in place of all others.
inline constexpr std::string_view kLike = "like";

/// One more that every emulated device has, beside all others.
inline constexpr OptionRow kClock{"clock", "-10..10",
                                  "by how many percent its clock is fast; 0 if not given"};

/// Takes that away from the options. Its seconds in a second, 1 if nobody says anything. Problems:
/// `kBadValue`.
[[nodiscard]] Outcome<double> take_clock_rate(DeviceOptions& options, const std::string& where);

/// What is emulated, on a clock that is that much too fast.
template <class Hosted>
[[nodiscard]] Outcome<std::unique_ptr<Hosted>> with_clock(Outcome<std::unique_ptr<Hosted>> hosted,
                                                          double rate) {
  if (hosted && rate != 1) return put_on_clock(*std::move(hosted), {.rate = rate});
  return hosted;
}

/// An emulated device like that of a recording: with the options that its header has, if it is of
/// `--capture`, or as the header describes it. Problems: `kBadValue`: it cannot be read;
/// `kUnsupported`: it does not say; those of `OnPort::set_up`.
template <class Kind>
[[nodiscard]] Outcome<std::unique_ptr<typename Kind::Hosted>> emulate_like(
    const Kind& kind, const std::string& path) {
  const auto recording = read_trace(path);
  if (!recording) {
    return problem(ErrorCode::kBadValue, "like=" + path, describe(recording.error()));
  }
  if (kind.set_up != nullptr && !is_of_capture(recording->header)) return kind.set_up(*recording);
  return emulated_target_of(*recording).and_then(parse_target).and_then([&](const Target& target) {
    auto options = target.options;
    return take_clock_rate(options, target.text).and_then([&](double rate) {
      return with_clock(kind.emulate(options, target.text), rate);
    });
  });
}

/// The emulated device with all that its entry says of its link. Problems as for `OnPort::emulate`
/// and `emulate_like`.
template <class Kind>
[[nodiscard]] Outcome<std::unique_ptr<typename Kind::Hosted>> emulate(const Kind& kind,
                                                                      DeviceOptions options,
                                                                      const std::string& where) {
  const auto rate = take_clock_rate(options, where);
  if (!rate) return tl::unexpected{rate.error()};
  const auto like = options.find(kLike);
  if (like != options.end() && options.size() > 1) {
    return problem(ErrorCode::kBadValue, where,
                   "like=FILE takes the place of all other options but clock");
  }
  auto hosted = with_clock(
      like == options.end() ? kind.emulate(options, where) : emulate_like(kind, like->second),
      *rate);
  if constexpr (std::is_same_v<Kind, OnStream>) {
    if (hosted && kind.line) return put_on_line(*std::move(hosted), rate_of(*kind.line));
  }
  return hosted;
}

/// What an entry says of its emulated device (`OnPort::emulate`), if there is a function that makes
/// it of options and `where`: `make(options, where)`, or, where options name files, `make(options,
/// where, files)`.
template <auto make>
[[nodiscard]] auto hosted(const DeviceOptions& options, const std::string& where) {
  const auto host = [](auto device) { return make_hosted(std::move(device)); };
  if constexpr (std::is_invocable_v<decltype(make), decltype(options), decltype(where)>) {
    return make(options, where).map(host);
  } else {
    return make(options, where, option_files()).map(host);
  }
}

/// The same of `OnPort::set_up`, if there is a function that makes it of a recording.
template <auto set_up>
[[nodiscard]] auto hosted_like(const Trace& recording) {
  return set_up(recording).map([](auto device) { return make_hosted(std::move(device)); });
}

/// The parts that an entry must have and lacks, by their names; nothing if it is complete.
[[nodiscard]] std::vector<std::string_view> missing_parts(const Device& device);

/// All names, with `, ` between.
[[nodiscard]] std::string names_of(Devices devices);

/// Problems: `kUnknownDevice`, with the names that there are.
[[nodiscard]] Outcome<const Device*> find_device(Devices devices, std::string_view name);

/// The device of that name in a recording or, as of `morap-node` and `morap-bus`, of that family;
/// nullptr if there is none.
[[nodiscard]] const Device* find_recorded_device(Devices devices, std::string_view name);

/// Those of them that can be told by the USB numbers of their port.
[[nodiscard]] std::vector<KnownBoard> known_boards(Devices devices);

/// As the entry says; of other kinds of port it means nothing.
template <class Kind>
[[nodiscard]] SerialLine line_of(const Kind& kind) {
  if constexpr (std::is_same_v<Kind, OnStream>) return kind.line.value_or(SerialLine{});
  return {};
}

/// Longer than any device may hold the clock of a bus: one that does is a finding and not a
/// failure.
inline constexpr Duration kClockPatience = std::chrono::milliseconds{100};

/// What the jig must know to open a target of the device.
template <class Kind>
[[nodiscard]] Wiring<typename Kind::Port> wiring_of(const Device& device, const Kind& kind) {
  return {.device = device.name,
          .make_dissector = device.make_dissector,
          .make_judge = kind.make_judge,
          .open_emulated =
              [&kind](const Target& target) {
                return emulate(kind, target.options, target.text).map([](auto hosted) {
                  if constexpr (std::is_same_v<Kind, OnBus>) {
                    return open_in_memory(std::move(hosted), kClockPatience);
                  } else {
                    return open_in_memory(std::move(hosted));
                  }
                });
              },
          .open_real = open_target<typename Kind::Port>,
          .line = line_of(kind)};
}

/// Opens a target of the device and does `work(kind, rig)` with it, whatever its kind of port.
/// Answers what `work` does, an `Outcome`.
template <class Work>
[[nodiscard]] auto with_rig(const Device& device, const RigOptions& how, Work work) {
  return std::visit(
      [&](const auto& kind) {
        using Port = typename std::remove_cvref_t<decltype(kind)>::Port;
        using Answer = decltype(work(kind, std::declval<Rig<Port>>()));
        auto rig = Rig<Port>::open(wiring_of(device, kind), how);
        return rig ? work(kind, *std::move(rig)) : Answer{tl::unexpected{rig.error()}};
      },
      device.port);
}

/// The rig of a device whose kind of port is known: `OnStream`, `OnServer` or `OnBus`.
template <class Kind>
[[nodiscard]] Outcome<Rig<typename Kind::Port>> open_rig(const Device& device,
                                                         const RigOptions& how) {
  return Rig<typename Kind::Port>::open(wiring_of(device, std::get<Kind>(device.port)), how);
}

/// The device's console and what `watch` shows of it, on a target. Problems as for `with_rig`.
[[nodiscard]] Outcome<std::unique_ptr<DeviceConsole>> open_console(const Device& device,
                                                                   const RigOptions& how,
                                                                   const std::string& target,
                                                                   Say say);
[[nodiscard]] Outcome<std::unique_ptr<Watched>> open_watched(const Device& device,
                                                             const RigOptions& how,
                                                             Duration period);

/// A target whose answers can be timed. The probe may know what `link` leads to, so it goes first.
struct ProbedLink {
  StreamLink link;
  std::unique_ptr<Probe> probe;
};
[[nodiscard]] Outcome<ProbedLink> open_probe(const Device& device, const RigOptions& how);

/// A joint of it that can be led along a way. Problems: as for `with_rig`, and `kUnsupported`.
[[nodiscard]] Outcome<std::unique_ptr<Follower>> open_follower(const Device& device,
                                                               const RigOptions& how);

/// The conversation of the device's suite with a target. Where that is emulated, sessions are
/// played to it beside an emulated device of its own.
[[nodiscard]] Outcome<std::unique_ptr<Bench>> open_bench(const Device& device,
                                                         const RigOptions& how);

}  // namespace armjig::cli
