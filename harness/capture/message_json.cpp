// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/message_json.hpp"

#include <nlohmann/json.hpp>

namespace armjig {

std::string to_json(const Message& message) {
  return message_object<nlohmann::ordered_json>(message).dump();
}

}  // namespace armjig
