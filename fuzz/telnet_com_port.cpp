// SPDX-License-Identifier: Apache-2.0
// Any bytes of a client or server of RFC 2217: cut byte by byte they are the same data and get the
// same answers as in one piece, and no answer looks like data to the other end. Our client and our
// server come to terms.
//
// Input: what passes; its first four bytes are the settings that a client wants, too.
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "fuzz/input.hpp"
#include "fuzz/require.hpp"
#include "harness/wire/telnet/com_port.hpp"

namespace armjig::fuzz {
namespace {

struct Heard {
  std::vector<std::byte> data;
  std::vector<std::byte> answers;
  friend bool operator==(const Heard&, const Heard&) = default;
};

void append(std::vector<std::byte>& to, Bytes bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

/// One end of a connection: what it hears of the other one is data, or answered by `End`.
template <class End>
class Listener {
 public:
  template <class... Wanted>
  explicit Listener(const Wanted&... wanted) : end_{wanted...} {
    append(heard_.answers, end_.begin());
  }

  void hear(Bytes bytes) {
    while (!bytes.empty()) {
      const auto step = decoder_.step(bytes);
      require(step.used > 0 && step.used <= bytes.size(), "each step takes what there is");
      bytes = bytes.subspan(step.used);
      if (const auto* data = std::get_if<telnet::Data>(&step.found)) {
        append(heard_.data, data->bytes);
      } else if (const auto* wish = std::get_if<telnet::Negotiation>(&step.found)) {
        append(heard_.answers, end_.on(*wish));
      } else if (const auto* request = std::get_if<telnet::Subnegotiation>(&step.found)) {
        take(*request);
      }
    }
  }
  [[nodiscard]] const Heard& heard() const noexcept { return heard_; }
  [[nodiscard]] const End& end() const noexcept { return end_; }
  [[nodiscard]] std::vector<std::byte> take_answers() { return std::exchange(heard_.answers, {}); }

 private:
  void take(const telnet::Subnegotiation& request) {
    if constexpr (std::is_void_v<decltype(end_.on(request))>) {
      end_.on(request);
    } else {
      append(heard_.answers, end_.on(request));
    }
  }

  telnet::Decoder decoder_;
  End end_;
  Heard heard_;
};

using Server = Listener<telnet::ComPortServer>;
using Client = Listener<telnet::ComPortClient>;

/// What an end hears in one piece and byte by byte is the same, and it answers the same.
template <class End, class... Wanted>
std::vector<std::byte> answers(Bytes input, const Wanted&... wanted) {
  End whole{wanted...};
  whole.hear(input);
  End in_bytes{wanted...};
  for (std::size_t i = 0; i < input.size(); ++i) in_bytes.hear(input.subspan(i, 1));
  require(whole.heard() == in_bytes.heard(), "cutting the stream differently changes nothing");
  return whole.heard().answers;
}

telnet::ComPortSettings settings_from(Bytes input) {
  Input from{input};
  telnet::ComPortSettings settings;
  settings.baud_rate = 1U + from.u8() * 1000U;
  settings.data_size = static_cast<std::uint8_t>(5 + from.u8() % 4);
  settings.parity = static_cast<std::uint8_t>(1 + from.u8() % 5);
  settings.stop_size = static_cast<std::uint8_t>(1 + from.u8() % 3);
  return settings;
}

/// A client gets from our server what it wants, whatever that is.
void come_to_terms(const telnet::ComPortSettings& wanted) {
  Client client{wanted};
  Server server;
  for (int i = 0; i < 10; ++i) {
    server.hear(client.take_answers());
    client.hear(server.take_answers());
  }
  require(client.end().is_ready() && !client.end().is_no_port() && !client.end().refused(),
          "client and server come to terms");
  require(server.end().settings() == wanted, "the port is as the client wants it");
  require(!server.end().is_suspended(), "data may flow");
  require(client.heard().data.empty() && server.heard().data.empty(), "none of it is data");
}

void com_port(Bytes input) {
  Server listener;
  listener.hear(answers<Server>(input));
  require(listener.heard().data.empty(), "an answer is no data");
  const auto wanted = settings_from(input);
  listener.hear(answers<Client>(input, wanted));
  require(listener.heard().data.empty(), "a request is no data");
  come_to_terms(wanted);
}

}  // namespace
}  // namespace armjig::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::com_port(std::as_bytes(std::span{data, size}));
  return 0;
}
