// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/telnet/telnet.hpp"

#include <algorithm>

namespace armjig::telnet {

Decoder::Step Decoder::step(Bytes in) noexcept {
  if (state_ == State::kData) {
    const auto end = std::ranges::find(in, kIac);
    const auto size = static_cast<std::size_t>(end - in.begin());
    if (size > 0) return {size, Data{in.first(size)}};
  }
  std::size_t used = 0;
  while (used < in.size()) {
    // A doubled IAC is one byte of data, which is there to be looked at.
    if (state_ == State::kCommand && in[used] == kIac) {
      state_ = State::kData;
      return {used + 1, Data{in.subspan(used, 1)}};
    }
    auto found = take(in[used++]);
    if (found.found.index() != 0) return {used, found.found};
    if (state_ == State::kData) break;
  }
  return {used, {}};
}

Decoder::Step Decoder::take(std::byte byte) noexcept {
  switch (state_) {
    case State::kData:
      state_ = State::kCommand;
      return {};  // only IAC comes here
    case State::kCommand:
      return take_command(byte);
    case State::kVerb:
      state_ = State::kData;
      return {1, Negotiation{verb_, static_cast<Option>(byte)}};
    case State::kInside:
      byte == kIac ? static_cast<void>(state_ = State::kInsideCommand) : keep(byte);
      return {};
    case State::kInsideCommand:
      if (byte == kSubnegotiationEnd) return end_subnegotiation();
      if (byte != kIac) return take_command(byte);
      state_ = State::kInside;
      keep(byte);
      return {};
  }
  return {};
}

Decoder::Step Decoder::take_command(std::byte code) noexcept {
  if (code == kSubnegotiationBegin) {
    state_ = State::kInside;
    inside_ = {};
    is_cut_ = false;
    return {};
  }
  if (code >= static_cast<std::byte>(Verb::kWill) && code <= static_cast<std::byte>(Verb::kDont)) {
    state_ = State::kVerb;
    verb_ = static_cast<Verb>(code);
    return {};
  }
  state_ = State::kData;
  return {1, Command{code}};
}

Decoder::Step Decoder::end_subnegotiation() noexcept {
  state_ = State::kData;
  const auto bytes = inside_.view();
  if (bytes.empty()) return {};
  return {1, Subnegotiation{static_cast<Option>(bytes[0]), bytes.subspan(1), is_cut_}};
}

void Decoder::keep(std::byte byte) noexcept {
  inside_.size() < inside_.capacity() ? inside_.push_back(byte) : static_cast<void>(is_cut_ = true);
}

BoundedBytes<3> encode(Negotiation negotiation) noexcept {
  BoundedBytes<3> out;
  out.push_back(kIac);
  out.push_back(static_cast<std::byte>(negotiation.verb));
  out.push_back(static_cast<std::byte>(negotiation.option));
  return out;
}

}  // namespace armjig::telnet
