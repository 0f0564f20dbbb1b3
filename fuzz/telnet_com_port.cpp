// SPDX-License-Identifier: Apache-2.0
// Any bytes of a client of RFC 2217: cut byte by byte they are the same data and get the same
// answers as in one piece, and no answer looks like data to the client.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

class Client {
 public:
  Client() { append(heard_.answers, server_.begin()); }

  void say(Bytes bytes) {
    while (!bytes.empty()) {
      const auto step = decoder_.step(bytes);
      require(step.used > 0 && step.used <= bytes.size(), "each step takes what there is");
      bytes = bytes.subspan(step.used);
      if (const auto* data = std::get_if<telnet::Data>(&step.found)) {
        append(heard_.data, data->bytes);
      } else if (const auto* wish = std::get_if<telnet::Negotiation>(&step.found)) {
        append(heard_.answers, server_.on(*wish));
      } else if (const auto* request = std::get_if<telnet::Subnegotiation>(&step.found)) {
        append(heard_.answers, server_.on(*request));
      }
    }
  }
  [[nodiscard]] const Heard& heard() const noexcept { return heard_; }

 private:
  telnet::Decoder decoder_;
  telnet::ComPortServer server_;
  Heard heard_;
};

void com_port_client(Bytes input) {
  Client whole;
  whole.say(input);
  Client in_bytes;
  for (std::size_t i = 0; i < input.size(); ++i) in_bytes.say(input.subspan(i, 1));
  require(whole.heard() == in_bytes.heard(), "cutting the stream differently changes nothing");
  Client listener;
  listener.say(whole.heard().answers);
  require(listener.heard().data.empty(), "an answer is no data");
}

}  // namespace
}  // namespace armjig::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  armjig::fuzz::com_port_client(std::as_bytes(std::span{data, size}));
  return 0;
}
