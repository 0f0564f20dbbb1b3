// SPDX-License-Identifier: Apache-2.0
#include "device.hpp"

#include <array>
#include <utility>

#include "gripper.hpp"
#include "harness/console/generic.hpp"
#include "harness/latency/generic_probe.hpp"
#include "judge.hpp"
#include "suite.hpp"

namespace gripper {

using namespace armjig;

namespace {

template <unsigned baud>
Outcome<std::unique_ptr<HostedStream>> emulate(const DeviceOptions& options,
                                               const std::string& where) {
  return make(options, where, baud).map([](Unit unit) { return make_hosted(std::move(unit)); });
}

template <unsigned baud>
Outcome<std::unique_ptr<Bench>> open_bench(Rig<StreamPort> rig, const RigOptions& how) {
  return make_bench(std::move(rig), baud, how.target.is_emulated());
}

Outcome<std::unique_ptr<DeviceConsole>> open_console(Rig<StreamPort> rig, const std::string& target,
                                                     Say say) {
  return generic::open(StreamLink{std::move(rig)}, make_dissector(), target, std::move(say));
}

Outcome<std::unique_ptr<Watched>> watch(Rig<StreamPort> rig, const std::string& /*target*/,
                                        const WatchHow& /*how*/) {
  return generic::watch(StreamLink{std::move(rig)}, make_dissector(),
                        {read_request(kUnit, kStatus, kRegisters - kStatus)});
}

Outcome<std::unique_ptr<Probe>> make_probe(StreamPort& /*port*/, const std::string& /*target*/) {
  // Address, function, count, registers and CRC ([A] 6.3).
  constexpr std::size_t kAnswer = 3 + 2 * (kRegisters - kStatus) + 2;
  return generic::make_probe("read of registers to their values",
                             read_request(kUnit, kStatus, kRegisters - kStatus), kAnswer);
}

/// The CRC made right again, so that campaigns get past it.
void seal(std::span<std::byte> message) {
  constexpr std::size_t kCrcSize = 2;
  if (message.size() <= kCrcSize) return;
  const auto end = message.last(kCrcSize);
  const auto crc = crc16(message.first(message.size() - kCrcSize));
  end[0] = static_cast<std::byte>(crc & 0xFFU);  // the low byte first ([S] 2.5.1.2)
  end[1] = static_cast<std::byte>(crc >> 8U);
}

template <unsigned baud>
cli::Device device(std::string_view name) {
  return {.name = name,
          .title = "gripper in Modbus RTU",
          .make_dissector = make_dissector,
          .port = cli::OnStream{{.make_judge = make_judge,
                                 .emulate = emulate<baud>,
                                 .make_bench = open_bench<baud>,
                                 .open_console = open_console,
                                 .watch = watch,
                                 .make_probe = make_probe},
                                SerialLine{baud, Parity::kEven, 1}},
          .options = options,
          .suite = suite,
          .mutants = mutants,
          .replay = {.run = replay},
          .fuzz = {.seal = seal},
          .watch_rate = 2};
}

}  // namespace

cli::Devices devices() {
  static const std::array all{device<kUsualBaud>("gripper"), device<1200>("gripper-1200")};
  return all;
}

}  // namespace gripper
