// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/step_response.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

namespace armjig::morap::emulation {
namespace {

/// The node installs the controller at a tick.
constexpr Duration kForTicks = std::chrono::milliseconds{20};

/// Talks to a node without a bus between: the bytes come at once.
void send(Node& node, Instant time, const Command& command) {
  node.start(time, /*is_read=*/false);
  const auto bytes = encode(command);
  for (const auto byte : bytes.view()) std::ignore = node.write(time, byte);
}

Command command_for(const StepTest& test) {
  if (const auto* request = std::get_if<TuneRequest>(&test.controller)) {
    return {CommandId::kTune, *request};
  }
  return {CommandId::kProgram, std::get<ControllerSet>(test.controller)};
}

bool is_speed_test(const StepTest& test) {
  const auto* request = std::get_if<TuneRequest>(&test.controller);
  const auto kind =
      request != nullptr ? kind_of(request->kind) : std::get<ControllerSet>(test.controller).kind;
  return kind == ControllerKind::kSpeed;
}

void evaluate(StepResponse& response, double reference) {
  auto& samples = response.samples;
  const auto tail = std::max<std::size_t>(1, samples.size() / 10);
  for (std::size_t i = samples.size() - tail; i < samples.size(); ++i) {
    response.final_value += samples[i].value / static_cast<double>(tail);
  }
  for (const auto& sample : samples) {
    response.overshoot = std::max(response.overshoot, sample.value / reference - 1.0);
    response.peak_volts = std::max(response.peak_volts, std::fabs(sample.volts));
    if (std::fabs(sample.value / reference - 1.0) > kSettlingBand) response.settling = sample.time;
  }
}

}  // namespace

StepResponse run(const StepTest& test) {
  assert(test.node.plant && test.sampling > Duration{} && test.reference != 0.0F);
  Node node{test.node};
  StepResponse response;
  Instant time{};
  send(node, time, command_for(test));
  if (node.programming_status() != ProgrammingStatus::kSuccess) return response;
  response.is_accepted = true;
  send(node, time, {CommandId::kCalibrateZero});
  time += kForTicks;
  const bool is_speed = is_speed_test(test);
  send(node, time, {is_speed ? CommandId::kSpeed : CommandId::kPosition, test.reference});
  response.controller = is_speed ? node.speed_set() : node.position_set();
  const auto& plant = *node.plant();
  for (Duration passed{}; passed <= test.length; passed += test.sampling) {
    node.advance_to(time + passed);
    response.samples.push_back({passed, is_speed ? plant.speed() : plant.angle(),
                                static_cast<double>(volts_of(node.output().level)),
                                plant.current()});
  }
  evaluate(response, static_cast<double>(test.reference));
  return response;
}

}  // namespace armjig::morap::emulation
