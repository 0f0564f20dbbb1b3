// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <utility>

#include "emulators/i2c/bus.hpp"
#include "emulators/morap/defects/defects.hpp"

namespace armjig::morap {

/// A bus with one node that can be touched (`DefectiveNode::set_input`): an `EmulatedBus`.
class JointBus {
 public:
  explicit JointBus(DefectiveNode node) : node_{bus_.attach(std::move(node))} {}

  BusReply start(Instant time, std::uint8_t address, bool is_read) {
    return bus_.start(time, address, is_read);
  }
  BusReply write(Instant time, std::byte byte) { return bus_.write(time, byte); }
  BusReply read(Instant time) { return bus_.read(time); }
  BusReply stop(Instant time) { return bus_.stop(time); }
  BusReply recover(Instant time) { return bus_.recover(time); }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) {
    return bus_.device<DefectiveNode>(node_).set_input(time, name, value);
  }

 private:
  i2c::Bus bus_;
  std::size_t node_;
};
static_assert(EmulatedBus<JointBus>);

}  // namespace armjig::morap
