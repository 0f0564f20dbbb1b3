// SPDX-License-Identifier: Apache-2.0
#include "conformance/demo/suite.hpp"

#include <array>
#include <utility>

#include "conformance/stream_bench.hpp"
#include "harness/wire/demo/demo.hpp"

namespace armjig::demo::conformance {
namespace {

using namespace std::chrono_literals;

/// The vocabulary: operations out, states back.
class MachineBench final : public StreamBench {
 public:
  explicit MachineBench(Rig<StreamPort> rig) : StreamBench{std::move(rig), make_dissector()} {}

  bool is_alive() override {
    drain(10ms);
    send(encode(Operation::kQuery));
    return receive(100ms).has_value();
  }
  void bring_to(std::size_t /*start*/) override {
    send(encode(Operation::kHalt));
    (void)receive(100ms);  // what it answers is for the cases to judge
  }
  void measure_noise() override {}

  void expect_state(State state) {
    const auto& field = reply_fields()[1];
    const auto wanted = sentence_of(field, static_cast<std::int64_t>(state));
    const auto reply = receive(100ms);
    if (!reply) return fail_by_silence(wanted, "silence");
    if (!reply->fault.empty()) return fail(wanted, reply->fault);
    const auto value = field_value(field, reply->raw);
    if (value != static_cast<std::int64_t>(state)) fail(wanted, sentence_of(field, value));
  }
};

enum Start : std::uint8_t { kHalted };

constexpr Clause kSuiteClauses[] = {
    must("demo.query", "A query is answered with the state.", "made up here"),
    look("A halted device says so.",
         [](MachineBench& machine) {
           machine.send(encode(Operation::kQuery));
           machine.expect_state(State::kHalted);
         }),

    must("demo.start", "A device that is told to start runs.", "made up here"),
    from(kHalted, Hazard::kMove, "A halted device can be started.",
         [](MachineBench& machine) {
           machine.send(encode(Operation::kStart));
           machine.expect_state(State::kRunning);
         }),

    must("demo.halt.while-halted", "A device told to halt while halted stays halted.",
         "made up here"),
    look("Halting twice is the same as once.",
         [](MachineBench& machine) {
           machine.send(encode(Operation::kHalt));
           machine.expect_state(State::kHalted);
         }),
};

constexpr std::array kStarts{StartState{"halted", Hazard::kObserve}};

}  // namespace

Suite suite() noexcept {
  static const std::array kChapters{chapter("The machine", kSuiteClauses)};
  return {"demo", "1", kChapters, kStarts, shipped_document("docs/spec/demo.md")};
}

Outcome<std::unique_ptr<Bench>> make_bench(Rig<StreamPort> rig, const RigOptions& /*how*/) {
  return std::make_unique<MachineBench>(std::move(rig));
}

}  // namespace armjig::demo::conformance
