// SPDX-License-Identifier: Apache-2.0
#include "harness/link/rfc2217_stream.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <deque>

#include "harness/link/descriptor.hpp"
#include "harness/wire/telnet/com_port.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using test::ByteVector;
using test::hex;
using test::same_bytes;
using ::testing::HasSubstr;

/// A server's end in memory. It hands over a byte at a time, so that everything is split.
class SerialServer : public StreamPort {
 public:
  enum class Manner : std::uint8_t { kServes, kSilent, kRefuses, kTakesOnly9600 };
  explicit SerialServer(Manner manner = Manner::kServes) : manner_{manner} {
    if (manner == Manner::kServes || manner == Manner::kTakesOnly9600) queue(port.begin());
  }

  Result<void> write(Bytes bytes) override {
    if (manner_ == Manner::kSilent) return {};
    while (!bytes.empty()) {
      const auto step = decoder_.step(bytes);
      bytes = bytes.subspan(step.used);
      if (const auto* data = std::get_if<telnet::Data>(&step.found)) {
        received.insert(received.end(), data->bytes.begin(), data->bytes.end());
      } else if (const auto* wish = std::get_if<telnet::Negotiation>(&step.found)) {
        hear(*wish);
      } else if (const auto* request = std::get_if<telnet::Subnegotiation>(&step.found)) {
        hear(*request);
      }
    }
    return {};
  }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    if (to_client.empty()) {
      now_ = std::max(now_, deadline);
      return 0;
    }
    into[0] = to_client.front();
    to_client.pop_front();
    return 1;
  }
  [[nodiscard]] Instant now() const override { return now_; }
  [[nodiscard]] std::optional<Lifeline> lifeline() const override {
    return Lifeline{descriptor, send_last};
  }
  /// Data of the device.
  void send(std::string_view text) {
    telnet::escape(hex(text), [this](Bytes piece) { queue(piece); });
  }

  telnet::ComPortServer port;
  ByteVector received;
  std::deque<std::byte> to_client;
  int descriptor = -1;

 private:
  void queue(Bytes bytes) { to_client.insert(to_client.end(), bytes.begin(), bytes.end()); }
  void hear(telnet::Negotiation wish) {
    if (manner_ == Manner::kRefuses && wish.option == telnet::Option::kComPort) {
      if (wish.verb == telnet::Verb::kWill) queue(hex("FF FE 2C"));
    } else {
      queue(port.on(wish));
    }
  }
  void hear(const telnet::Subnegotiation& request) {
    const bool is_baud = !request.bytes.empty() && request.bytes[0] == std::byte{1};
    if (manner_ == Manner::kTakesOnly9600 && is_baud) {
      queue(hex("FF FA 2C 65 00 00 25 80 FF F0"));
    } else {
      queue(port.on(request));
    }
  }

  Manner manner_;
  telnet::Decoder decoder_;
  Instant now_{};
};

struct Opened {
  SerialServer* server;
  Outcome<std::unique_ptr<StreamPort>> port;
};

Opened open_at(SerialServer::Manner manner, const SerialLine& line = {}) {
  auto server = std::make_unique<SerialServer>(manner);
  auto* const place = server.get();
  return {place, speak_rfc2217(std::move(server), line, "rfc2217:box:4000")};
}

TEST(Rfc2217Stream, SetsThePortBeforeItIsUsed) {
  const auto opened = open_at(SerialServer::Manner::kServes,
                              {.baud = 19'200, .parity = Parity::kEven, .stop_bits = 2});
  ASSERT_TRUE(opened.port) << opened.port.error().hint;
  EXPECT_EQ(opened.server->port.settings(),
            (telnet::ComPortSettings{.baud_rate = 19'200, .parity = 3, .stop_size = 2}));
  EXPECT_TRUE(opened.server->received.empty());
}

TEST(Rfc2217Stream, PassesOnEveryByteBothWays) {
  const auto opened = open_at(SerialServer::Manner::kServes);
  ASSERT_TRUE(opened.port);
  auto& port = **opened.port;
  EXPECT_TRUE(port.write(hex("FF FF FF 02 FF F0 0D 00")));
  EXPECT_TRUE(same_bytes(opened.server->received, hex("FF FF FF 02 FF F0 0D 00")));

  opened.server->send("FF FF FF 38 FF");
  ByteVector came;
  std::array<std::byte, 3> buffer{};
  while (came.size() < 5) {
    const auto size = port.read(buffer, port.now() + 1s);
    ASSERT_TRUE(size);
    ASSERT_GT(*size, 0U);
    came.insert(came.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(*size));
  }
  EXPECT_TRUE(same_bytes(came, hex("FF FF FF 38 FF")));
  const auto end = port.now() + 5ms;
  EXPECT_EQ(port.read(buffer, end).value(), 0U);
  EXPECT_EQ(port.now(), end);
}

TEST(Rfc2217Stream, SaysWhatIsWrongWithTheServer) {
  const auto silent = open_at(SerialServer::Manner::kSilent);
  ASSERT_FALSE(silent.port);
  EXPECT_EQ(silent.port.error().code, ErrorCode::kTimedOut);
  EXPECT_THAT(silent.port.error().hint, HasSubstr("does not speak RFC 2217"));
  EXPECT_EQ(silent.port.error().where, "rfc2217:box:4000");

  const auto without = open_at(SerialServer::Manner::kRefuses);
  ASSERT_FALSE(without.port);
  EXPECT_EQ(without.port.error().code, ErrorCode::kBadTarget);

  const auto slow = open_at(SerialServer::Manner::kTakesOnly9600);
  ASSERT_FALSE(slow.port);
  EXPECT_EQ(slow.port.error().code, ErrorCode::kBadTarget);
  EXPECT_THAT(slow.port.error().hint, HasSubstr("3000000 baud but 9600"));
}

TEST(Rfc2217Stream, EscapesTheLastMessageOfAProgramThatHasGone) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()), 0);
  const Descriptor ours{ends[0]};
  const Descriptor theirs{ends[1]};
  const auto opened = open_at(SerialServer::Manner::kServes);
  ASSERT_TRUE(opened.port);
  opened.server->descriptor = ours.value();
  const auto lifeline = (*opened.port)->lifeline().value();
  EXPECT_FALSE(lifeline.is_plain);
  lifeline.send(lifeline.descriptor, hex("FF FF FF 02 01"));
  std::array<std::byte, 32> sent{};
  const auto size = ::recv(theirs.value(), sent.data(), sent.size(), 0);
  ASSERT_GT(size, 0);
  EXPECT_TRUE(same_bytes(Bytes{sent}.first(static_cast<std::size_t>(size)),
                         hex("FF FF FF FF FF FF 02 01")));
}

TEST(Rfc2217Stream, RefusesWhatIsNoAddress) {
  for (const auto* text : {"", "box", "box:", "box:0", "box:4000,", "box:4000,fast", ",9600"}) {
    const auto opened = open_rfc2217(text);
    ASSERT_FALSE(opened) << text;
    EXPECT_EQ(opened.error().code, ErrorCode::kBadTarget) << text;
    EXPECT_THAT(opened.error().hint, HasSubstr("rfc2217:HOST:PORT")) << text;
  }
}

}  // namespace
}  // namespace armjig
