// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/host.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "emulators/demo/demo.hpp"
#include "emulators/host/outbox.hpp"
#include "emulators/memory/serial_line.hpp"
#include "emulators/parol6/arm.hpp"
#include "harness/core/hex.hpp"
#include "harness/link/real_streams.hpp"
#include "harness/link/rfc2217_stream.hpp"
#include "harness/link/tcp_connection.hpp"
#include "harness/link/tcp_session.hpp"
#include "tests/integration/support/program.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using ::testing::StartsWith;
namespace fs = std::filesystem;

// The demo device (harness/wire/demo): a request is A5 op ~op, its reply 5A state ~state.
constexpr std::array kEnabledQuery{std::byte{0xA5}, std::byte{'q'}, std::byte{0xFF ^ 'q'}};
constexpr auto kReady = "5a00ff";

// The shortest frame that a PAROL6 board answers: length 2, both of them end bytes (dossier 2.2).
constexpr std::array kPoll{std::byte{0xFF}, std::byte{0xFF}, std::byte{0xFF},
                           std::byte{0x02}, std::byte{0x01}, std::byte{0x02}};
constexpr std::size_t kTelemetrySize = 60;

/// Whatever frame a board's receiver thinks it is in, this ends it and begins none: at worst a
/// length of 0 takes 256 bytes and the last of them, 55, as a length, hence 85 bytes more.
std::vector<std::byte> end_of_any_frame() { return std::vector<std::byte>(1024, std::byte{0x55}); }

/// A host in a thread of its own, on a pseudo-terminal, on TCP and as a serial port over Telnet.
class Running {
 public:
  explicit Running(std::unique_ptr<HostedStream> device, double speed = 1)
      : host_{open(std::move(device), speed)}, thread_{[this] { host_.run(); }} {}
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() { (void)stop(); }

  HostStatistics stop() {
    host_.stop();
    if (thread_.joinable()) thread_.join();
    return host_.statistics();
  }

  [[nodiscard]] std::string pty() const { return host_.targets()[0].substr(4); }
  [[nodiscard]] std::string tcp() const { return host_.targets()[1].substr(4); }
  [[nodiscard]] std::string rfc2217() const { return host_.targets()[2].substr(8); }

 private:
  static Host open(std::unique_ptr<HostedStream> device, double speed) {
    HostOptions options;
    options.pty.emplace();
    options.tcp.emplace();
    options.rfc2217 = TcpOptions{.protocol = TcpOptions::Protocol::kRfc2217};
    options.speed = speed;
    return std::move(Host::open(std::move(device), options).value());
  }

  Host host_;
  std::thread thread_;
};

std::unique_ptr<HostedStream> demo_device() { return make_hosted(demo::emulation::StreamDevice{}); }
std::unique_ptr<HostedStream> parol6() { return make_hosted(parol6::emulation::Arm{}); }

/// What comes next: `size` bytes, or fewer if they do not come.
std::vector<std::byte> read(StreamPort& port, std::size_t size) {
  std::vector<std::byte> read(size);
  std::size_t got = 0;
  const auto deadline = port.now() + testing::kPatience;
  while (got < size) {
    const auto part = port.read(std::span{read}.subspan(got), deadline);
    if (!part || *part == 0) break;
    got += *part;
  }
  read.resize(got);
  return read;
}

std::string ask(StreamPort& port) {
  EXPECT_TRUE(port.write(kEnabledQuery));
  return to_hex(read(port, kEnabledQuery.size()));
}

std::unique_ptr<StreamPort> open_or_die(Outcome<std::unique_ptr<StreamPort>> port) {
  EXPECT_TRUE(port.has_value()) << describe(port.error());
  return std::move(port.value());
}

// Both links.

TEST(Host, AnswersOnThePseudoTerminal) {
  const Running host{demo_device()};
  EXPECT_EQ(ask(*open_or_die(open_pty(host.pty()))), kReady);
}

TEST(Host, AnswersOnTcp) {
  const Running host{demo_device()};
  EXPECT_EQ(ask(*open_or_die(open_tcp_stream(host.tcp()))), kReady);
}

TEST(Host, AnswersTheLinkThatAskedLast) {
  const Running host{demo_device()};
  const auto pty = open_or_die(open_pty(host.pty()));
  const auto tcp = open_or_die(open_tcp_stream(host.tcp()));
  EXPECT_EQ(ask(*pty), kReady);
  EXPECT_EQ(ask(*tcp), kReady);
  EXPECT_EQ(ask(*pty), kReady);
}

TEST(Host, SharesAThreadWithOthers) {
  const auto shared = make_host_thread();
  std::vector<Host> hosts;
  for (int i = 0; i < 3; ++i) {
    hosts.push_back(Host::open(demo_device(), {.pty = PtyOptions{}, .thread = shared}).value());
  }
  std::thread thread{[&hosts] { hosts.front().run(); }};
  for (const auto& host : hosts) {
    EXPECT_EQ(ask(*open_or_die(open_pty(host.targets().front().substr(4)))), kReady);
  }
  hosts.back().stop();  // ends all of them, or this would not come to its end
  thread.join();
}

TEST(Host, LeavesNothingToBeDoneForOneThatIsGone) {
  const auto shared = make_host_thread();
  auto stays = Host::open(demo_device(), {.pty = PtyOptions{}, .thread = shared}).value();
  {
    const auto gone = Host::open(demo_device(), {.pty = PtyOptions{}, .thread = shared}).value();
  }
  stays.run();  // at once over
}

TEST(Host, AnswersWhenVirtualTimeHasComeNotBefore) {
  // The demo device takes 1 ms of its own time: 100 ms of ours at a hundredth of the speed.
  const Running host{demo_device(), 0.01};
  const auto port = open_or_die(open_pty(host.pty()));
  const auto asked = port->now();
  EXPECT_EQ(ask(*port), kReady);
  EXPECT_GE(port->now() - asked, 100ms);
}

TEST(Host, LetsBytesTakeTheirTimeOnALine) {
  // At 1200 baud, six characters of 11 bits take 55 ms; the demo device thinks for 1 ms.
  HostOptions options;
  options.pty.emplace();
  auto host = std::move(
      Host::open(put_on_line(demo_device(), {.baud = 1200, .bits = 11}), options).value());
  std::thread thread{[&host] { host.run(); }};
  {
    const auto port = open_or_die(open_pty(host.targets()[0].substr(4)));
    const auto asked = port->now();
    EXPECT_EQ(ask(*port), kReady);
    EXPECT_GE(port->now() - asked, 56ms);
  }
  host.stop();
  thread.join();
}

TEST(Host, LeavesToClientsWhatALineCannotTakeYet) {
  HostOptions options;
  options.pty.emplace();
  auto host = std::move(Host::open(put_on_line(demo_device(), {.baud = 1200}), options).value());
  std::thread thread{[&host] { host.run(); }};
  {
    const auto port = open_or_die(open_pty(host.targets()[0].substr(4)));
    const auto written = port->write(std::vector<std::byte>(256 * 1024));  // 36 minutes
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::kTimedOut);
  }
  host.stop();
  thread.join();
  EXPECT_LT(host.statistics().links.bytes_in, 64U * 1024);
}

TEST(Host, CountsWhatPassed) {
  Running host{demo_device()};
  EXPECT_EQ(ask(*open_or_die(open_pty(host.pty()))), kReady);
  EXPECT_EQ(ask(*open_or_die(open_tcp_stream(host.tcp()))), kReady);
  const auto statistics = host.stop();
  EXPECT_EQ(statistics.links,
            (LinkStatistics{
                .clients = 2, .refused = 0, .bytes_in = 6, .bytes_out = 6, .frames_dropped = 0}));
}

TEST(Host, NeedsALink) {
  const auto host = Host::open(demo_device(), {});
  ASSERT_FALSE(host);
  EXPECT_EQ(host.error().code, ErrorCode::kBadValue);
}

TEST(Host, RefusesLinksThatAKindOfDeviceCannotHave) {
  EXPECT_FALSE(Host::open(make_hosted(demo::emulation::SessionDevice{}), {.pty = PtyOptions{}}));
  EXPECT_FALSE(Host::open(make_hosted(demo::emulation::SessionDevice{}), {}));
  EXPECT_FALSE(Host::open(make_hosted(demo::emulation::BusDevice{}), {.tcp = TcpOptions{}}));
}

TEST(Host, LetsOthersTalkToABusInItsOwnTime) {
  auto host = std::move(Host::open(make_hosted(demo::emulation::BusDevice{}), {}).value());
  std::thread thread{[&host] { host.run(); }};
  const Stopwatch clock;
  Instant end{};
  for (int i = 0; i < 10; ++i) {
    host.with_bus([&end](BusPort& bus) {
      EXPECT_GE(bus.now(), end);
      const auto byte = std::byte{'q'};
      const auto query = write_to(BusAddress{demo::emulation::BusDevice::kAddress}, {&byte, 1});
      EXPECT_EQ(bus.transfer({&query, 1}), Transfer::kDone);
      end = bus.now();
    });
  }
  EXPECT_GE(clock.now(), at(2ms)) << "each transaction is 200 us long";
  host.stop();
  thread.join();
}

// Clients of the pseudo-terminal.

TEST(HostOnPty, ServesClientsOneAfterTheOther) {
  const Running host{demo_device()};
  for (int i = 0; i < 20; ++i) EXPECT_EQ(ask(*open_or_die(open_pty(host.pty()))), kReady);
}

TEST(HostOnPty, TakesWhatAClientSentBeforeItWent) {
  const Running host{demo_device()};
  constexpr std::array kStart{std::byte{0xA5}, std::byte{'s'}, std::byte{0xFF ^ 's'}};
  ASSERT_TRUE(open_or_die(open_pty(host.pty()))->write(kStart));
  const auto port = open_or_die(open_pty(host.pty()));
  auto state = ask(*port);
  while (state == kReady) state = ask(*port);  // the bytes may still be on their way
  EXPECT_EQ(state, "5a01fe") << "running";
}

/// A client without any care: it sets no mode and throws nothing away.
class PlainClient {
 public:
  explicit PlainClient(const std::string& path)
      : terminal_{::open(path.c_str(), O_RDWR | O_NOCTTY)} {}

  [[nodiscard]] bool is_raw() const {
    termios mode{};
    return ::tcgetattr(terminal_.value(), &mode) == 0 && (mode.c_lflag & ICANON) == 0;
  }
  /// Leaves the terminal as a shell has it, with its output stopped.
  void spoil() const {
    termios mode{};
    ASSERT_EQ(::tcgetattr(terminal_.value(), &mode), 0);
    mode.c_lflag |= ICANON | ECHO | ISIG;
    mode.c_iflag |= ICRNL | ISTRIP | IXON;
    mode.c_oflag |= OPOST | ONLCR;
    ASSERT_EQ(::tcsetattr(terminal_.value(), TCSANOW, &mode), 0);
    ASSERT_EQ(::tcflow(terminal_.value(), TCOOFF), 0);
  }
  void poll() const { ASSERT_EQ(::write(terminal_.value(), kPoll.data(), kPoll.size()), 6); }
  [[nodiscard]] std::string read_some() const {
    std::array<std::byte, 4 * kTelemetrySize> bytes;
    const auto size = ::read(terminal_.value(), bytes.data(), bytes.size());
    return size < 0 ? "" : to_hex(Bytes{bytes}.first(static_cast<std::size_t>(size)));
  }

  /// The first client after one that spoiled the terminal and whose end the host has noticed.
  static PlainClient after_spoiler(const std::string& path) {
    const Stopwatch clock;
    while (true) {
      PlainClient client{path};
      if (client.is_raw() || clock.now() > at(testing::kPatience)) return client;
      client.terminal_.close();
      std::this_thread::yield();
    }
  }

 private:
  Descriptor terminal_;
};

TEST(HostOnPty, GivesTheNextClientNothingOfTheLast) {
  const Running host{parol6()};
  {
    const PlainClient last{host.pty()};
    for (int i = 0; i < 20; ++i) last.poll();
    ASSERT_THAT(last.read_some(), StartsWith("ffffff38")) << "the others are on their way";
    last.spoil();
  }
  const auto next = PlainClient::after_spoiler(host.pty());
  next.poll();
  const auto answer = next.read_some();
  EXPECT_THAT(answer, StartsWith("ffffff38"));
  EXPECT_EQ(answer.size(), 2 * kTelemetrySize) << "one answer to one frame";
}

TEST(HostOnPty, IsRawForAClientThatSetsNoMode) {
  const Running host{parol6()};
  EXPECT_TRUE(PlainClient{host.pty()}.is_raw());
  PlainClient{host.pty()}.spoil();
  const auto next = PlainClient::after_spoiler(host.pty());
  EXPECT_TRUE(next.is_raw());
  next.poll();
  EXPECT_THAT(next.read_some(), StartsWith("ffffff38")) << "output flows again";
}

TEST(HostOnPty, SurvivesAClientThatStopsReading) {
  Running host{parol6()};
  {
    const PlainClient deaf{host.pty()};
    for (int i = 0; i < 20'000; ++i) deaf.poll();  // 1.2 MB of answers
    deaf.spoil();
  }
  {
    const auto next = PlainClient::after_spoiler(host.pty());
    next.poll();
    const auto answer = next.read_some();
    EXPECT_THAT(answer, StartsWith("ffffff38"));
    EXPECT_EQ(answer.size(), 2 * kTelemetrySize);
  }
  EXPECT_GT(host.stop().links.frames_dropped, 0U);
}

TEST(HostOnPty, GivesASlowReaderWholeFramesOnly) {
  const Running host{parol6()};
  const auto slow = open_or_die(open_pty(host.pty()));
  for (int i = 0; i < 20'000; ++i) ASSERT_TRUE(slow->write(kPoll));
  constexpr std::size_t kAtLeast = Outbox::kCapacity / kTelemetrySize;
  for (std::size_t i = 0; i < kAtLeast; ++i) {
    const auto frame = read(*slow, kTelemetrySize);
    ASSERT_EQ(frame.size(), kTelemetrySize);
    ASSERT_THAT(to_hex(frame), StartsWith("ffffff38")) << "frame " << i;
    ASSERT_EQ(frame.back(), std::byte{0x02}) << "frame " << i;
  }
}

TEST(HostOnPty, AnswersAGoodFrameAfterGarbageAtFullRate) {
  const Running host{parol6()};
  const auto port = open_or_die(open_pty(host.pty()));
  std::mt19937 random{1};
  std::vector<std::byte> garbage(std::size_t{1} << 20);
  for (auto& byte : garbage) byte = static_cast<std::byte>(random());
  ASSERT_TRUE(port->write(garbage));
  ASSERT_TRUE(port->write(end_of_any_frame()));
  ASSERT_TRUE(port->write(kPoll));
  EXPECT_EQ(read(*port, kTelemetrySize).size(), kTelemetrySize);
}

TEST(HostOnPty, LeavesTimeForOthersDuringGarbageAtFullRate) {
  const Running host{parol6()};
  std::atomic is_over = false;
  std::thread noise{[&] {
    const auto port = open_or_die(open_pty(host.pty()));
    const std::vector<std::byte> garbage(4096, std::byte{0x55});
    while (!is_over && port->write(garbage)) {
    }
  }};
  const auto first = open_or_die(open_tcp_stream(host.tcp()));
  const auto second = open_or_die(open_tcp_stream(host.tcp()));
  std::array<std::byte, 8> buffer;
  EXPECT_FALSE(second->read(buffer, second->now() + testing::kPatience)) << "it was closed";
  is_over = true;
  noise.join();
}

// Clients on TCP.

TEST(HostOnTcp, ServesClientsOneAfterTheOther) {
  Running host{demo_device()};
  for (int i = 0; i < 20; ++i) EXPECT_EQ(ask(*open_or_die(open_tcp_stream(host.tcp()))), kReady);
  EXPECT_EQ(host.stop().links.refused, 0U);
}

TEST(HostOnTcp, ClosesASecondClientAtOnce) {
  Running host{demo_device()};
  const auto first = open_or_die(open_tcp_stream(host.tcp()));
  ASSERT_EQ(ask(*first), kReady);
  const auto second = open_or_die(open_tcp_stream(host.tcp()));
  std::array<std::byte, 8> buffer;
  const auto size = second->read(buffer, second->now() + testing::kPatience);
  ASSERT_FALSE(size);
  EXPECT_EQ(size.error().code, ErrorCode::kDisconnected);
  EXPECT_EQ(ask(*first), kReady) << "the first is not disturbed";
  EXPECT_EQ(host.stop().links.refused, 1U);
}

TEST(HostOnTcp, SurvivesAReset) {
  const Running host{demo_device()};
  const auto session = std::move(make_tcp_session(host.tcp()).value());
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(session->connect(session->now() + testing::kPatience));
    ASSERT_TRUE(session->send(kEnabledQuery));
    session->reset();
  }
  EXPECT_EQ(ask(*open_or_die(open_tcp_stream(host.tcp()))), kReady);
}

TEST(HostOnTcp, AnswersAClientThatHasEndedItsSending) {
  const Running host{demo_device()};
  const auto session = std::move(make_tcp_session(host.tcp()).value());
  ASSERT_TRUE(session->connect(session->now() + testing::kPatience));
  ASSERT_TRUE(session->send(kEnabledQuery));
  session->half_close();
  std::array<std::byte, 8> buffer;
  auto received = session->receive(buffer, session->now() + testing::kPatience);
  ASSERT_TRUE(received);
  EXPECT_EQ(received->size, 3U);
  received = session->receive(buffer, session->now() + testing::kPatience);
  ASSERT_TRUE(received);
  EXPECT_EQ(received->arrival, SessionPort::Arrival::kEnd) << "but not for ever";
}

TEST(HostOnTcp, PrefersANewClientToOneThatHasEndedItsSending) {
  const Running host{demo_device()};
  const auto session = std::move(make_tcp_session(host.tcp()).value());
  ASSERT_TRUE(session->connect(session->now() + testing::kPatience));
  session->half_close();
  EXPECT_EQ(ask(*open_or_die(open_tcp_stream(host.tcp()))), kReady);
}

TEST(HostOnTcp, SurvivesAClientThatStopsReading) {
  Running host{parol6()};
  {
    const auto deaf = open_or_die(open_tcp_stream(host.tcp()));
    std::vector<std::byte> polls;
    for (int i = 0; i < 2'000; ++i) polls.insert(polls.end(), kPoll.begin(), kPoll.end());
    for (int i = 0; i < 300; ++i) ASSERT_TRUE(deaf->write(polls));  // 36 MB of answers
  }
  const auto next = open_or_die(open_tcp_stream(host.tcp()));
  ASSERT_TRUE(next->write(end_of_any_frame()));  // the last client's reset may have torn one
  ASSERT_TRUE(next->write(kPoll));
  EXPECT_EQ(read(*next, kTelemetrySize).size(), kTelemetrySize);
  EXPECT_GT(host.stop().links.frames_dropped, 0U);
}

// As RFC 2217 has it: IAC is FF, and FF as a byte of data FF FF, as at the end of `kReady`.

constexpr auto kGreeting = "fffd00fffb00fffd03fffb03fffd2c";
constexpr auto kReadyEscaped = "5a00ffff";

/// Says what is written there, and tells what comes back.
std::string say(StreamPort& port, std::string_view text, std::size_t answer) {
  EXPECT_TRUE(port.write(from_hex(text).value()));
  return to_hex(read(port, answer));
}

TEST(HostOnRfc2217, AnswersEachClientAndEscapes) {
  Running host{demo_device()};
  for (int i = 0; i < 3; ++i) {
    const auto client = open_or_die(open_tcp_stream(host.rfc2217()));
    EXPECT_EQ(to_hex(read(*client, 15)), kGreeting);
    EXPECT_EQ(say(*client, "a5718e", 4), kReadyEscaped);
  }
  EXPECT_EQ(host.stop().links.frames_dropped, 0U);
}

TEST(HostOnRfc2217, AcknowledgesInTheMidstOfData) {
  const Running host{demo_device()};
  const auto client = open_or_die(open_tcp_stream(host.rfc2217()));
  EXPECT_EQ(to_hex(read(*client, 15)), kGreeting);
  // WILL COM-PORT: NOTIFY-MODEMSTATE B0. DTR on, within a request of the device.
  EXPECT_EQ(say(*client, "fffb2c", 7), "fffa2c6bb0fff0");
  EXPECT_EQ(say(*client, "a571fffa2c0508fff08e", 11), "fffa2c6908fff05a00ffff");
}

TEST(HostOnRfc2217, HoldsBackWhatAClientHasSuspended) {
  const Running host{demo_device()};
  const auto client = open_or_die(open_tcp_stream(host.rfc2217()));
  (void)read(*client, 15);
  EXPECT_EQ(say(*client, "fffb2c", 7), "fffa2c6bb0fff0");
  // Suspend, a request of the device, purge: its confirmation comes alone.
  EXPECT_EQ(say(*client, "fffa2c08fff0a5718efffa2c0c01fff0", 7), "fffa2c7001fff0");
  EXPECT_EQ(say(*client, "fffa2c09fff0", 4), kReadyEscaped);
}

TEST(HostOnRfc2217, IsATargetOfOurs) {
  Running host{demo_device()};
  for (int i = 0; i < 3; ++i) {
    const auto client = open_or_die(open_rfc2217(host.rfc2217()));
    EXPECT_EQ(say(*client, "a5718e", 3), kReady);
  }
  EXPECT_EQ(host.stop().links.frames_dropped, 0U);
}

TEST(HostOnTcp, SaysThatThePortIsInUse) {
  const Running host{demo_device()};
  const auto port = parse_tcp_address(host.tcp())->port;
  HostOptions options;
  options.tcp =
      TcpOptions{.address = "127.0.0.1", .port = static_cast<std::uint16_t>(std::stoi(port))};
  const auto second = Host::open(demo_device(), options);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::kBusy);
}

// The stable link.

/// A folder of its own for each test.
class HostLink : public ::testing::Test {
 protected:
  HostLink() {
    auto pattern = (fs::temp_directory_path() / "armjig-XXXXXX").string();
    folder = ::mkdtemp(pattern.data());
    path = folder / "parol6";
  }
  ~HostLink() override { fs::remove_all(folder); }

  [[nodiscard]] Outcome<Host> open() const {
    HostOptions options;
    options.pty = PtyOptions{.link = path.string()};
    return Host::open(demo_device(), options);
  }
  void expect_refusal(ErrorCode code) const {
    const auto host = open();
    ASSERT_FALSE(host);
    EXPECT_EQ(host.error().code, code) << describe(host.error());
    EXPECT_EQ(host.error().where, path.string());
  }

  fs::path folder;
  fs::path path;
};

TEST_F(HostLink, LeadsToThePseudoTerminalUntilTheEnd) {
  {
    const auto host = open();
    ASSERT_TRUE(host);
    EXPECT_EQ("pty:" + fs::read_symlink(path).string(), host->targets()[0]);
    EXPECT_EQ("pty:" + path.string(), host->targets()[1]);
  }
  EXPECT_FALSE(fs::exists(fs::symlink_status(path)));
}

TEST_F(HostLink, ReplacesOneThatAKilledEmulatorLeft) {
  fs::create_symlink("/dev/pts/99999", path);
  const auto host = open();
  ASSERT_TRUE(host) << describe(host.error());
  EXPECT_EQ("pty:" + fs::read_symlink(path).string(), host->targets()[0]);
  EXPECT_EQ(std::distance(fs::directory_iterator{folder}, {}), 1) << "nothing is left beside it";
}

TEST_F(HostLink, KeepsAwayFromTheLinkOfALivingEmulator) {
  const auto first = open();
  ASSERT_TRUE(first);
  const auto target = fs::read_symlink(path);
  expect_refusal(ErrorCode::kBusy);
  EXPECT_EQ(fs::read_symlink(path), target);
}

TEST_F(HostLink, ReplacesNothingThatIsNotALink) {
  std::ofstream{path} << "precious";
  expect_refusal(ErrorCode::kBadValue);
  EXPECT_EQ(fs::file_size(path), 8U);
}

TEST_F(HostLink, ReplacesNoLinkToElsewhere) {
  fs::create_symlink("somewhere", path);
  expect_refusal(ErrorCode::kBadValue);
  EXPECT_EQ(fs::read_symlink(path), "somewhere");
}

TEST_F(HostLink, NeedsItsFolder) {
  path = folder / "none" / "parol6";
  expect_refusal(ErrorCode::kNotFound);
}

TEST_F(HostLink, LeavesALinkAloneThatLeadsElsewhereByNow) {
  {
    const auto host = open();
    ASSERT_TRUE(host);
    fs::remove(path);
    fs::create_symlink("elsewhere", path);
  }
  EXPECT_EQ(fs::read_symlink(path), "elsewhere");
}

}  // namespace
}  // namespace armjig
