// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iostream>
#include <map>
#include <memory>
#include <vector>

#include "fuzz/require.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig::fuzz {

/// What a device says has to be whole messages on each connection, at times that never decrease. On
/// a bus any bytes are an answer.
class Answers {
 public:
  explicit Answers(MakeDissector make_dissector) noexcept : make_dissector_{make_dissector} {}

  void hear(Instant time, std::uint32_t connection, Bytes bytes) {
    require(time >= last_, "times never decrease");
    last_ = time;
    auto& dissector = dissectors_[connection];
    if (!dissector) dissector = make_dissector_();
    std::vector<Message> messages;
    dissector->feed(Direction::kFromDevice, time, bytes, messages);
    for (const auto& message : messages) {
      if (!message.fault.empty()) std::cerr << to_text(message) << '\n';
      require(message.fault.empty(), "every answer is a message");
    }
  }

 private:
  MakeDissector make_dissector_;
  std::map<std::uint32_t, std::unique_ptr<Dissector>> dissectors_;  ///< of each connection
  Instant last_{};
};

}  // namespace armjig::fuzz
