// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/telnet/agreements.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace armjig::telnet {

BoundedBytes<3> Agreements::ask(Option option, Direction direction) noexcept {
  const auto known = std::ranges::find(options_, option, &Of::option);
  assert(known != options_.end());
  known->of[static_cast<std::size_t>(direction)] = Agreement::kAsked;
  return encode({direction == Direction::kOurs ? Verb::kWill : Verb::kDo, option});
}

BoundedBytes<3> Agreements::on(Negotiation negotiation) noexcept {
  const auto verb = negotiation.verb;
  const bool is_theirs = verb == Verb::kWill || verb == Verb::kWont;
  const bool is_wish = verb == Verb::kWill || verb == Verb::kDo;
  const auto yes = is_theirs ? Verb::kDo : Verb::kWill;
  const auto no = is_theirs ? Verb::kDont : Verb::kWont;
  const auto known = std::ranges::find(options_, negotiation.option, &Of::option);
  if (known == options_.end()) {
    return is_wish ? encode({no, negotiation.option}) : BoundedBytes<3>{};
  }
  auto& agreement =
      known->of[static_cast<std::size_t>(is_theirs ? Direction::kTheirs : Direction::kOurs)];
  const auto before = std::exchange(agreement, is_wish ? Agreement::kYes : Agreement::kNo);
  if (!is_wish && before == Agreement::kAsked && negotiation.option == Option::kComPort) {
    is_com_port_refused_ = true;
  }
  if (is_wish && before == Agreement::kNo) return encode({yes, negotiation.option});
  if (!is_wish && before == Agreement::kYes) return encode({no, negotiation.option});
  return {};
}

bool Agreements::has_com_port() const noexcept {
  return std::ranges::find(options_.back().of, Agreement::kYes) != options_.back().of.end();
}

}  // namespace armjig::telnet
