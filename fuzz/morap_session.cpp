// SPDX-License-Identifier: Apache-2.0
// Whole sessions with emulated nodes and the pen on their bus.
//
// Input: what falls when a session is drawn (`Roll`).
#include <nlohmann/json.hpp>

#include "emulators/morap/node.hpp"
#include "fuzz/morap_possible.hpp"
#include "fuzz/session.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::fuzz {
namespace {

using morap::emulation::Node;

class BusPromises {
 public:
  using Device = i2c::Bus;
  static constexpr auto replay_watched = morap::replay::replay_watched;
  static constexpr std::size_t kMostHeap = 256 * 1024;

  explicit BusPromises(const Trace& session) {
    const auto header = nlohmann::json::parse(session.header);
    if (session.device == "morap-node") nodes_.push_back(0);
    const auto all = header.value("nodes", nlohmann::json::array());
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].value("kind", "node") != "pen") nodes_.push_back(i);
    }
  }

  void see(Device& bus, Instant /*time*/) const {
    for (const auto number : nodes_) require_possible(bus.device<Node>(number));
  }

  /// Each operation is one answer, and has its bytes already.
  static void hear(const std::vector<TraceEvent>& /*answers*/) {}
  static void take_what_it_said(Device& /*bus*/) {}

 private:
  std::vector<std::size_t> nodes_;  ///< their numbers on the bus
};

}  // namespace
}  // namespace armjig::fuzz

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace std::chrono_literals;
  using armjig::fuzz::BusPromises;
  armjig::fuzz::check_session<BusPromises>(armjig::test::kDrawnDevices[1], {data, size}, 1s);
  return 0;
}
