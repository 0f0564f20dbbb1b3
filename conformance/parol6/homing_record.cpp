// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/homing_record.hpp"

#include <algorithm>
#include <iterator>

namespace armjig::parol6::conformance {

std::vector<Answer> HomingRecord::with_bits(std::uint8_t homed) const {
  std::vector<Answer> answers;
  std::copy_if(log_.begin() + 1, log_.end(), std::back_inserter(answers),
               [&](const Answer& answer) { return answer.homed == homed; });
  return answers;
}

std::vector<Answer> HomingRecord::with_speed(std::uint8_t homed, std::size_t joint,
                                             int speed) const {
  const auto answers = with_bits(homed);
  const auto has_speed = [&](const Answer& answer) { return answer.speed[joint].value == speed; };
  const auto begin = std::ranges::find_if(answers, has_speed);
  return {begin, std::find_if_not(begin, answers.end(), has_speed)};
}

std::vector<std::uint8_t> HomingRecord::bits() const {
  std::vector<std::uint8_t> bits;
  std::transform(log_.begin() + 1, log_.end(), std::back_inserter(bits),
                 [](const Answer& answer) { return answer.homed; });
  bits.erase(std::unique(bits.begin(), bits.end()), bits.end());
  return bits;
}

}  // namespace armjig::parol6::conformance
