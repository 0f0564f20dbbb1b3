// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/suite.hpp"

#include <algorithm>
#include <utility>

#include "conformance/morap/node_bench.hpp"
#include "emulators/morap/options.hpp"
#include "harness/config/option_file.hpp"

namespace armjig::morap::conformance {
namespace {

/// What the bench is about: the first node of an emulated bus, or whatever answers on a real one.
Outcome<NodeBench::Subject> subject_of(const RigOptions& how) {
  const auto& target = how.target;
  if (!target.is_emulated()) return NodeBench::Subject{.is_real = true};
  const auto bus = emulation::read_bus(target.options, target.text, option_files());
  if (!bus) return tl::unexpected{bus.error()};
  if (bus->nodes.empty()) return problem(ErrorCode::kBadValue, target.text, "it needs a node");
  const auto& node = bus->nodes.front();
  const auto motor = std::ranges::find(motors(), node.known_motor().name,
                                       [](const Motor& one) { return one.known.name; });
  return NodeBench::Subject{
      .address = {node_address(node.id)}, .motor = &*motor, .is_exact = !how.impairment};
}

}  // namespace

Outcome<std::unique_ptr<Bench>> make_bench(Rig<BusPort> rig, const RigOptions& how) {
  const auto subject = subject_of(how);
  if (!subject) return tl::unexpected{subject.error()};
  return std::make_unique<NodeBench>(std::move(rig), *subject);
}

}  // namespace armjig::morap::conformance
