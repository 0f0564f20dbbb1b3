// SPDX-License-Identifier: Apache-2.0
#include "harness/link/impaired_stream.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/demo/demo.hpp"
#include "harness/link/memory_stream.hpp"
#include "tests/unit/link/any_impairment.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using test::ByteVector;
using test::hex;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Impairment stream_impairment(std::string_view text) {
  const auto impairment = parse_impairment(text);
  if (!impairment) ADD_FAILURE() << describe(impairment.error());
  return impairment ? *impairment : Impairment{};
}

/// Bytes at a time, either way.
struct Stamped {
  Instant time{};
  ByteVector bytes;
};

MATCHER_P2(is, time, bytes, "") {
  return arg.time == at(time) && std::ranges::equal(arg.bytes, hex(bytes));
}

/// A device that notes what it receives and sends what it was told to.
struct StreamRecorder {
  std::vector<Stamped> received;
  std::deque<SentBytes> to_send;
  std::vector<SentBytes> ready;

  void receive(Instant time, Bytes bytes) { received.push_back({time, test::as_vector(bytes)}); }
  void advance_to(Instant time) {
    while (!to_send.empty() && to_send.front().time <= time) {
      ready.push_back(to_send.front());
      to_send.pop_front();
    }
  }
  [[nodiscard]] std::optional<Instant> next_event() const {
    return to_send.empty() ? std::nullopt : std::optional{to_send.front().time};
  }
  [[nodiscard]] std::span<const SentBytes> sent() const { return ready; }
  void clear_sent() { ready.clear(); }
};

/// A bad link to a recorder.
struct Link {
  explicit Link(const Impairment& impairment, std::deque<SentBytes> to_send = {}) {
    auto inner = std::make_unique<MemoryStream<StreamRecorder>>(StreamRecorder{});
    device = &inner->device();
    device->to_send = std::move(to_send);
    port = std::make_unique<ImpairedStream>(std::move(inner), impairment);
  }
  explicit Link(std::string_view text, std::deque<SentBytes> to_send = {})
      : Link{stream_impairment(text), std::move(to_send)} {}

  StreamRecorder* device{};
  std::unique_ptr<ImpairedStream> port;
};

/// One read; what it gave and when.
Result<Stamped> read(StreamPort& port, Instant deadline, std::size_t most = 64) {
  ByteVector bytes(most);
  const auto size = port.read(bytes, deadline);
  if (!size) return tl::unexpected{size.error()};
  bytes.resize(*size);
  return Stamped{port.now(), bytes};
}

/// All that comes until the deadline.
std::vector<Stamped> read_all(StreamPort& port, Instant deadline, std::size_t most = 64) {
  std::vector<Stamped> all;
  for (auto one = read(port, deadline, most); one && !one->bytes.empty();
       one = read(port, deadline, most)) {
    all.push_back(*one);
  }
  return all;
}

ByteVector bytes_of(const std::vector<Stamped>& parts) {
  ByteVector bytes;
  for (const auto& part : parts) bytes.insert(bytes.end(), part.bytes.begin(), part.bytes.end());
  return bytes;
}

void write(StreamPort& port, std::string_view bytes) {
  EXPECT_TRUE(port.write(hex(bytes)).has_value()) << bytes;
}

/// An inner port that gives chunks at times, then says an error. Its clock moves as it waits.
class ScriptedStream final : public StreamPort {
 public:
  ScriptedStream(std::deque<Stamped> script, Error last)
      : script_{std::move(script)}, last_{last} {}

  Result<void> write(Bytes bytes) override {
    if (write_error) return tl::unexpected{*write_error};
    written.push_back({now_, test::as_vector(bytes)});
    return {};
  }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    ++reads;
    if (script_.empty()) return tl::unexpected{last_};
    if (script_.front().time > deadline) {
      now_ = std::max(now_, deadline);
      return 0;
    }
    now_ = std::max(now_, script_.front().time);
    const auto bytes = std::move(script_.front().bytes);
    script_.pop_front();
    std::ranges::copy(bytes, into.begin());
    return bytes.size();
  }
  [[nodiscard]] Instant now() const override { return now_; }
  [[nodiscard]] std::optional<Lifeline> lifeline() const override { return Lifeline{7, {}}; }

  std::vector<Stamped> written;
  std::optional<Error> write_error;
  int reads = 0;

 private:
  std::deque<Stamped> script_;
  Error last_;
  Instant now_{};
};

TEST(ImpairedStream, WithoutDefectsIsThePortItself) {
  ImpairedStream port{std::make_unique<MemoryStream<demo::emulation::StreamDevice>>(
                          demo::emulation::StreamDevice{}),
                      stream_impairment("seed=1")};
  write(port, "A5 73 8C");  // demo: start
  const auto reply = read(port, at(10ms));
  ASSERT_TRUE(reply);
  EXPECT_THAT(*reply, is(1ms, "5A 01 FE"));  // running, one reply delay later
  EXPECT_EQ(port.now(), at(1ms));
}

TEST(ImpairedStream, DelaysBothWaysOnVirtualTime) {
  ImpairedStream port{std::make_unique<MemoryStream<demo::emulation::StreamDevice>>(
                          demo::emulation::StreamDevice{}),
                      stream_impairment("out.delay=2ms,in.delay=3ms")};
  write(port, "A5 73 8C");
  const auto reply = read(port, at(10ms));
  ASSERT_TRUE(reply);
  EXPECT_THAT(*reply, is(6ms, "5A 01 FE"));  // 2 ms there, 1 ms in the device, 3 ms back
}

TEST(ImpairedStream, AdvancesTimeNoFurtherThanNeeded) {
  Link link{"delay=5ms", {{at(1ms), hex("01")}, {at(20ms), hex("02")}}};
  const auto first = read(*link.port, at(1h));
  ASSERT_TRUE(first);
  EXPECT_THAT(*first, is(6ms, "01"));
  const auto nothing = read(*link.port, at(24ms));
  ASSERT_TRUE(nothing);
  EXPECT_THAT(*nothing, is(24ms, ""));
  const auto second = read(*link.port, at(1h));
  ASSERT_TRUE(second);
  EXPECT_THAT(*second, is(25ms, "02"));
}

TEST(ImpairedStream, SendsDelayedWritesWhileAReadWaits) {
  Link link{"out.delay=5ms"};
  write(*link.port, "01");
  std::ignore = read(*link.port, at(2ms));
  write(*link.port, "02");
  EXPECT_THAT(link.device->received, IsEmpty());
  std::ignore = read(*link.port, at(100ms));
  EXPECT_THAT(link.device->received, ElementsAre(is(5ms, "01"), is(7ms, "02")));
}

TEST(ImpairedStream, SendsWhatIsDueBeforeTheNextWrite) {
  auto inner = std::make_unique<ScriptedStream>(std::deque<Stamped>{{at(1s), hex("AA")}}, Error{});
  auto* const scripted = inner.get();
  ImpairedStream port{std::move(inner), stream_impairment("out.chunk=1,out.bandwidth=1000")};
  write(port, "01 02");
  std::array<std::byte, 1> nothing{};
  std::ignore = scripted->read(nothing, at(1500us));  // time passes elsewhere
  write(port, "03");
  EXPECT_THAT(scripted->written, ElementsAre(is(1500us, "01")));
}

TEST(ImpairedStream, SendsWhatIsOnItsWayWhenItIsDestroyed) {
  auto inner = std::make_unique<MemoryStream<StreamRecorder>>(StreamRecorder{});
  struct Witness final : StreamPort {
    Witness(std::unique_ptr<StreamPort> port, ByteVector& bytes)
        : inner{std::move(port)}, written{bytes} {}
    Result<void> write(Bytes bytes) override {
      written.insert(written.end(), bytes.begin(), bytes.end());
      return {};
    }
    Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
      return inner->read(into, deadline);
    }
    [[nodiscard]] Instant now() const override { return inner->now(); }
    std::unique_ptr<StreamPort> inner;
    ByteVector& written;
  };
  ByteVector written;
  {
    ImpairedStream port{std::make_unique<Witness>(std::move(inner), written),
                        stream_impairment("delay=1s")};
    write(port, "01 02");
    EXPECT_THAT(written, IsEmpty());
  }
  EXPECT_EQ(written, hex("01 02"));
}

TEST(ImpairedStream, HandsOverEachPieceAsAWriteOfItsOwn) {
  Link link{"out.split=2"};
  write(*link.port, "01 02 03 04 05");
  EXPECT_THAT(link.device->received, ElementsAre(is(0s, "01 02"), is(0s, "03 04"), is(0s, "05")));
}

TEST(ImpairedStream, GivesEachPieceInAReadOfItsOwn) {
  Link link{"in.split=2", {{at(1ms), hex("01 02 03")}}};
  EXPECT_THAT(read_all(*link.port, at(5ms)), ElementsAre(is(1ms, "01 02"), is(1ms, "03")));
}

TEST(ImpairedStream, GivesTheRestOfAPieceThatDoesNotFit) {
  Link link{"in.delay=1ms", {{at(1ms), hex("01 02 03")}}};
  EXPECT_THAT(read_all(*link.port, at(5ms), 2), ElementsAre(is(2ms, "01 02"), is(2ms, "03")));
}

TEST(ImpairedStream, ReadsNothingIntoNothing) {
  Link link{"in.delay=1ms", {{at(1ms), hex("01")}}};
  EXPECT_EQ(link.port->read({}, at(1s)), 0U);
}

TEST(ImpairedStream, LooksOnceEvenIfTheDeadlineIsOver) {
  Link link{"seed=1", {{at(0ms), hex("01")}}};
  const auto polled = read(*link.port, at(0ms));
  ASSERT_TRUE(polled);
  EXPECT_THAT(*polled, is(0ms, "01"));
}

TEST(ImpairedStream, EndsAReadAtItsDeadlineThoughADelayedFloodComesIn) {
  std::deque<Stamped> flood;
  for (int i = 0; i < 1000; ++i) flood.push_back({at(i * 1ms), hex("01")});
  auto inner = std::make_unique<ScriptedStream>(flood, Error{});
  ImpairedStream port{std::move(inner), stream_impairment("in.delay=10s")};
  const auto nothing = read(port, at(50ms));
  ASSERT_TRUE(nothing);
  EXPECT_THAT(*nothing, is(50ms, ""));
}

TEST(ImpairedStream, CountsEveryFrameThatItLoses) {
  ImpairedStream port{std::make_unique<MemoryStream<demo::emulation::StreamDevice>>(
                          demo::emulation::StreamDevice{}),
                      stream_impairment("loss=10%,seed=5")};
  int answered = 0;
  for (int i = 0; i < 1000; ++i) {
    write(port, "A5 71 8E");  // demo: query
    const auto reply = read(port, at((i + 1) * 10ms));
    ASSERT_TRUE(reply);
    answered += reply->bytes.empty() ? 0 : 1;
  }
  const auto statistics = port.statistics();
  EXPECT_EQ(statistics.out.chunks_in, 1000U);
  EXPECT_NEAR(static_cast<double>(statistics.out.chunks_lost), 100, 48);
  EXPECT_EQ(1000 - answered,
            static_cast<int>(statistics.out.chunks_lost + statistics.in.chunks_lost));
}

TEST(ImpairedStream, FailsAfterADisconnectThatCutsAWrite) {
  Link link{"out.disconnect-after=3"};
  write(*link.port, "01 02");
  const auto cut = link.port->write(hex("03 04"));
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, ErrorCode::kDisconnected);
  EXPECT_EQ(bytes_of(link.device->received), hex("01 02 03"));
  const auto later = read(*link.port, at(1s));
  ASSERT_FALSE(later);
  EXPECT_EQ(later.error().code, ErrorCode::kDisconnected);
  EXPECT_FALSE(link.port->write(hex("05")));
  EXPECT_EQ(link.device->received.size(), 2U);
  EXPECT_EQ(link.port->statistics().out.disconnects, 1U);
}

TEST(ImpairedStream, FailsAfterADisconnectThatCutsARead) {
  Link link{"in.disconnect-after=3", {{at(1ms), hex("01 02 03 04")}}};
  const auto last = read(*link.port, at(1s));
  ASSERT_TRUE(last);
  EXPECT_THAT(*last, is(1ms, "01 02 03"));
  const auto cut = read(*link.port, at(1s));
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, ErrorCode::kDisconnected);
  EXPECT_FALSE(link.port->write(hex("05")));
  EXPECT_THAT(link.device->received, IsEmpty());
}

TEST(ImpairedStream, BreaksOnlyBehindWhatIsDelayed) {
  Link link{"out.disconnect-after=2,out.delay=5ms", {{at(3ms), hex("AA")}}};
  write(*link.port, "01 02");
  const auto before = read(*link.port, at(1s));
  ASSERT_TRUE(before);
  EXPECT_THAT(*before, is(3ms, "AA"));
  const auto cut = read(*link.port, at(1s));
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, ErrorCode::kDisconnected);
  EXPECT_EQ(link.port->now(), at(5ms));
  EXPECT_THAT(link.device->received, ElementsAre(is(5ms, "01 02")));
}

TEST(ImpairedStream, LosesWithTheLinkWhatIsOnItsWayTheOtherWay) {
  Link link{"out.disconnect-after=1,in.delay=9ms", {{at(1ms), hex("AA BB")}}};
  std::ignore = read(*link.port, at(2ms));
  EXPECT_FALSE(link.port->write(hex("01")));
  EXPECT_FALSE(read(*link.port, at(1s)));
  EXPECT_EQ(link.port->statistics().in.bytes_cut_off, 2U);
}

TEST(ImpairedStream, GivesWhatWasOnItsWayBeforeItTellsThatTheDeviceHasGone) {
  auto inner = std::make_unique<ScriptedStream>(std::deque<Stamped>{{at(1ms), hex("01 02")}},
                                                Error{ErrorCode::kDisconnected, 5});
  ImpairedStream port{std::move(inner), stream_impairment("in.delay=1s")};
  const auto last = read(port, at(10s));
  ASSERT_TRUE(last);
  EXPECT_THAT(*last, is(1ms, "01 02"));
  const auto gone = read(port, at(10s));
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error(), (Error{ErrorCode::kDisconnected, 5}));
  EXPECT_EQ(port.write(hex("03")).error(), (Error{ErrorCode::kDisconnected, 5}));
}

TEST(ImpairedStream, TellsOfADelayedWriteThatFailsInTheReadThatSendsIt) {
  auto inner = std::make_unique<ScriptedStream>(std::deque<Stamped>{{at(1s), hex("01")}}, Error{});
  auto* const scripted = inner.get();
  ImpairedStream port{std::move(inner), stream_impairment("out.delay=1ms")};
  write(port, "01");
  scripted->write_error = Error{ErrorCode::kTimedOut};
  const auto late = read(port, at(10ms));
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::kTimedOut);
  scripted->write_error.reset();
  write(port, "02");  // not for good
  std::ignore = read(port, at(20ms));
  EXPECT_THAT(scripted->written, ElementsAre(is(2ms, "02")));
}

TEST(ImpairedStream, PassesOtherErrorsOfTheInnerPortOnAndLives) {
  auto inner =
      std::make_unique<ScriptedStream>(std::deque<Stamped>{}, Error{ErrorCode::kSystem, 4});
  ImpairedStream port{std::move(inner), stream_impairment("in.delay=1s")};
  EXPECT_EQ(read(port, at(1s)).error(), (Error{ErrorCode::kSystem, 4}));
  EXPECT_TRUE(port.write(hex("01")));
}

TEST(ImpairedStream, HasTheDescriptorOfTheInnerPort) {
  const ImpairedStream port{std::make_unique<ScriptedStream>(std::deque<Stamped>{}, Error{}),
                            stream_impairment("seed=1")};
  EXPECT_EQ(port.lifeline()->descriptor, 7);
}

TEST(ImpairedStream, DoesNotSpin) {
  auto inner = std::make_unique<ScriptedStream>(std::deque<Stamped>{{at(1h), hex("01")}}, Error{});
  auto* const scripted = inner.get();
  ImpairedStream port{std::move(inner), stream_impairment("delay=1ms")};
  write(port, "01");
  std::ignore = read(port, at(1s));
  EXPECT_EQ(scripted->reads, 2);  // until the write is due, then until the deadline
}

TEST(ImpairedStreamLaw, HarmlessDefectsNeverChangeTheBytesEitherWay) {
  test::for_all(
      [] {
        std::deque<SentBytes> to_send;
        ByteVector sent;
        Instant time{};
        for (int count = *rc::gen::inRange(0, 10); count > 0; --count) {
          time += test::any_duration(5'000);
          const ByteVector bytes(*rc::gen::inRange<std::size_t>(1, 30),
                                 static_cast<std::byte>(count));
          sent.insert(sent.end(), bytes.begin(), bytes.end());
          to_send.push_back({time, bytes});
        }
        Link link{{test::any_harmless_path(), test::any_harmless_path(), 1}, to_send};
        ByteVector written;
        ByteVector got;
        for (int i = 0; i < 20; ++i) {
          const ByteVector bytes(*rc::gen::inRange<std::size_t>(0, 30), static_cast<std::byte>(i));
          written.insert(written.end(), bytes.begin(), bytes.end());
          RC_ASSERT(link.port->write(bytes).has_value());
          const auto part = read(*link.port, link.port->now() + 1ms);
          RC_ASSERT(part.has_value());
          got.insert(got.end(), part->bytes.begin(), part->bytes.end());
        }
        const auto rest = bytes_of(read_all(*link.port, at(1000h)));
        got.insert(got.end(), rest.begin(), rest.end());
        RC_ASSERT(got == sent);
        RC_ASSERT(bytes_of(link.device->received) == written);
      },
      300);
}

TEST(ImpairedStreamLaw, TheDeviceNeverSeesTimeGoBack) {
  test::for_all(
      [] {
        Link link{{test::any_path(), test::any_path(), 1}};
        for (int i = 0; i < 20; ++i) {
          std::ignore = link.port->write(ByteVector(10));
          std::ignore = read(*link.port, link.port->now() + test::any_duration(3'000));
        }
        RC_ASSERT(std::ranges::is_sorted(link.device->received, {}, &Stamped::time));
      },
      300);
}

}  // namespace
}  // namespace armjig
