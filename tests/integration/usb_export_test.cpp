// SPDX-License-Identifier: Apache-2.0
// Emulated devices on USB over real sockets: what the wires' own tests do not have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <future>
#include <random>
#include <string>
#include <thread>

#include "emulators/demo/demo.hpp"
#include "emulators/host/host.hpp"
#include "emulators/i2c/thermometer.hpp"
#include "harness/link/descriptor.hpp"
#include "tests/unit/host/usbredir_guest.hpp"

namespace armjig {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;
namespace fs = std::filesystem;

// The demo device (harness/wire/demo): a request is A5 op ~op, its reply 5A state ~state.
constexpr auto kQueryInHex = "a5718e";
constexpr auto kReadyInHex = "5a00ff";

/// A device on a socket of its own, in a thread of its own.
class OnUsb {
 public:
  explicit OnUsb(AnyHosted device)
      : host_{open(std::move(device), socket_)}, thread_{[this] { host_.run(); }} {}
  OnUsb(const OnUsb&) = delete;
  OnUsb& operator=(const OnUsb&) = delete;
  ~OnUsb() { stop(); }

  void stop() {
    host_.stop();
    if (thread_.joinable()) thread_.join();
  }
  bool set_input(const std::string& name, std::int64_t value) {
    std::promise<bool> taken;
    host_.set_input(name, value, [&taken](bool is_taken) { taken.set_value(is_taken); });
    return taken.get_future().get();
  }
  [[nodiscard]] const std::string& socket() const noexcept { return socket_; }
  [[nodiscard]] Host& host() noexcept { return host_; }

 private:
  static Host open(AnyHosted device, const std::string& socket) {
    HostOptions options;
    options.usb.push_back({{.vendor = 0x1209, .product = 1}, UsbredirSocket{socket}});
    return std::move(Host::open(std::move(device), std::move(options)).value());
  }

  std::string socket_ =
      fs::temp_directory_path() / ("armjig-usb-" + std::to_string(::getpid()) + "-" +
                                   std::to_string(reinterpret_cast<std::uintptr_t>(this)));
  Host host_;
  std::thread thread_;
};

/// A virtual machine's end of the cable.
class Machine {
 public:
  explicit Machine(const std::string& path) : socket_{::socket(AF_UNIX, SOCK_STREAM, 0)} {
    sockaddr_un address{.sun_family = AF_UNIX};
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    is_connected_ = ::connect(socket_.value(), reinterpret_cast<const sockaddr*>(&address),
                              sizeof address) == 0;
  }

  [[nodiscard]] bool is_connected() const noexcept { return is_connected_; }

  /// Sends what the guest has to say, and listens until `is_enough`. False: the other side has
  /// gone.
  template <class Enough>
  bool talk(Enough is_enough) {
    while (true) {
      if (!send()) return false;
      if (is_enough()) return true;
      std::array<std::byte, 4096> buffer;
      const auto size = ::recv(socket_.value(), buffer.data(), buffer.size(), 0);
      if (size <= 0) return false;
      if (!guest.receive(Bytes{buffer}.first(static_cast<std::size_t>(size)))) return false;
    }
  }
  bool has_answer(std::uint64_t id) { return guest.answers.contains(id); }

  bool bring_up() {
    if (!talk([this] { return guest.connections > 0; })) return false;
    guest.configure(1, 1);
    guest.control(2, {0x21, 0x22, 3, 0, 0});
    return talk([this] { return has_answer(2); });
  }

  /// Sends some of what it has to say, as a connection that breaks would.
  void send_part(std::size_t size) {
    size = std::min(size, guest.outgoing.size());
    (void)::send(socket_.value(), guest.outgoing.data(), size, MSG_NOSIGNAL);
  }

  UsbredirGuest guest;

 private:
  bool send() {
    const auto bytes = std::exchange(guest.outgoing, {});
    return bytes.empty() || ::send(socket_.value(), bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
                                static_cast<ssize_t>(bytes.size());
  }

  Descriptor socket_;
  bool is_connected_ = false;
};

/// Asks the demo device, through the port that is open.
std::string ask_device(Machine& machine, std::uint64_t id) {
  machine.guest.bulk(id, 0x81, 64);
  machine.guest.bulk(id + 1, 0x01, 3, kQueryInHex);
  if (!machine.talk([&] { return machine.has_answer(id) && machine.has_answer(id + 1); })) {
    return "gone";
  }
  return machine.guest.answer(id).data;
}

TEST(UsbExport, AnswersAVirtualMachine) {
  OnUsb device{make_hosted(demo::emulation::StreamDevice{})};
  Machine machine{device.socket()};
  ASSERT_TRUE(machine.bring_up());
  EXPECT_EQ(ask_device(machine, 10), kReadyInHex);
  EXPECT_THAT(device.host().targets(), ElementsAre("usbredir:" + device.socket()));
}

TEST(UsbExport, ThePlaceIsForThisUserAndLeavesNothing) {
  std::string path;
  {
    const OnUsb device{make_hosted(demo::emulation::StreamDevice{})};
    path = device.socket();
    struct stat status{};
    ASSERT_EQ(::stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0600U);
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(UsbExport, ServesOneMachineAfterTheOther) {
  OnUsb device{make_hosted(demo::emulation::StreamDevice{})};
  {
    Machine first{device.socket()};
    ASSERT_TRUE(first.bring_up());
    Machine second{device.socket()};
    ASSERT_TRUE(second.is_connected());
    EXPECT_FALSE(second.talk([] { return false; })) << "it was not let go";
    EXPECT_EQ(ask_device(first, 10), kReadyInHex);
  }
  // When the host hears of the end of the first one is its own affair.
  bool is_up = false;
  for (int i = 0; i < 10'000 && !is_up; ++i) is_up = Machine{device.socket()}.bring_up();
  EXPECT_TRUE(is_up);
}

TEST(UsbExport, AHandPullsTheCableAndPlugsItInAgain) {
  OnUsb device{make_hosted(demo::emulation::StreamDevice{})};
  Machine machine{device.socket()};
  ASSERT_TRUE(machine.bring_up());
  EXPECT_TRUE(device.set_input("usb.plugged", 0));
  EXPECT_TRUE(machine.talk([&] { return machine.guest.disconnections == 1; }));
  EXPECT_FALSE(device.set_input("usb.plugged", 2));
  EXPECT_TRUE(device.set_input("usb.plugged", 1));
  EXPECT_TRUE(machine.talk([&] { return machine.guest.connections == 2; }));
  machine.guest.answers.clear();
  ASSERT_TRUE(machine.bring_up());
  EXPECT_EQ(ask_device(machine, 10), kReadyInHex);
}

TEST(UsbExport, SurvivesMachinesThatVanishAtAnyByte) {
  OnUsb device{make_hosted(demo::emulation::StreamDevice{})};
  std::mt19937 dice{7};
  for (int i = 0; i < 200; ++i) {
    Machine machine{device.socket()};
    machine.guest.configure(1, 1);
    machine.guest.control(2, {0x21, 0x22, 3, 0, 0});
    machine.guest.bulk(3, 0x81, 64);
    machine.guest.bulk(4, 0x01, 3, kQueryInHex);
    machine.send_part(dice() % 200);
  }
  bool is_up = false;
  for (int i = 0; i < 10'000 && !is_up; ++i) is_up = Machine{device.socket()}.bring_up();
  EXPECT_TRUE(is_up);
}

TEST(UsbExport, TakesOverASocketThatADeadProcessLeft) {
  const auto path = fs::temp_directory_path() / ("armjig-dead-" + std::to_string(::getpid()));
  {
    const Descriptor dead{::socket(AF_UNIX, SOCK_STREAM, 0)};
    sockaddr_un address{.sun_family = AF_UNIX};
    path.string().copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(dead.value(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  HostOptions options;
  options.usb.push_back({{}, UsbredirSocket{path}});
  auto alive = Host::open(make_hosted(demo::emulation::StreamDevice{}), options);
  EXPECT_TRUE(alive);
  const auto second = Host::open(make_hosted(demo::emulation::StreamDevice{}), options);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::kBusy);
}

TEST(UsbExport, ABusIsBehindAnAdapter) {
  i2c::Bus bus;
  bus.attach(i2c::Thermometer{0x48});
  OnUsb device{make_hosted(std::move(bus))};
  Machine machine{device.socket()};
  ASSERT_TRUE(machine.talk([&] { return machine.guest.connections > 0; }));
  EXPECT_EQ(machine.guest.device.product_id, 0xC631);
  machine.guest.configure(1, 1);
  machine.guest.control(2, {0x41, 7, 0, 0x48, 1}, "00");
  machine.guest.control(3, {0xC1, 3, 0, 0, 1});
  machine.guest.control(4, {0x41, 7, 0, 0x13, 1}, "00");
  machine.guest.control(5, {0xC1, 3, 0, 0, 1});
  ASSERT_TRUE(machine.talk([&] { return machine.has_answer(5); }));
  EXPECT_EQ(machine.guest.answer(3).data, "01");  // acknowledged
  EXPECT_EQ(machine.guest.answer(5).data, "02");  // nobody there
}

TEST(UsbExport, UsbipIsOnTheLoopback) {
  HostOptions options;
  options.usb.push_back({{}, UsbipPort{0}});
  auto host = Host::open(make_hosted(demo::emulation::StreamDevice{}), options);
  ASSERT_TRUE(host);
  EXPECT_THAT(host->targets(), ElementsAre(StartsWith("usbip:127.0.0.1:")));
}

}  // namespace
}  // namespace armjig
