// SPDX-License-Identifier: Apache-2.0
// Pipelined commands over loopback TCP against the documented server whose arm takes no time. The
// baselines are lines of the same length against bare loops that send each line back: one with a
// write for every line, one with a write for all that came at once, which is as fast as it gets.
#include <benchmark/benchmark.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "emulators/host/host.hpp"
#include "emulators/kinovazed/server.hpp"
#include "emulators/memory/hosted.hpp"
#include "harness/link/descriptor.hpp"
#include "harness/link/tcp_session.hpp"
#include "tests/unit/support/link_ends.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

constexpr int kWindow = 512;  ///< lines on their way
constexpr std::string_view kCommand = "EStop\r\n";
constexpr std::string_view kReply = "Accepted\r\n";

/// Sends the window and reads until as many bytes have come as `bytes_back` for each line.
void ping(benchmark::State& state, const std::string& address, std::string_view line,
          std::size_t bytes_back) {
  const auto session = *make_tcp_session(address);
  if (!session->connect(session->now() + 1s)) return state.SkipWithError("cannot connect");
  std::string window;
  for (int i = 0; i < kWindow; ++i) window += line;
  std::array<std::byte, 65536> buffer;
  for (auto _ : state) {
    if (!session->send(std::as_bytes(std::span{window}))) state.SkipWithError("cannot send");
    for (std::size_t heard = 0; heard < kWindow * bytes_back;) {
      const auto received = session->receive(buffer, session->now() + 5s);
      if (!received || received->arrival != SessionPort::Arrival::kData) {
        return state.SkipWithError("no answer");
      }
      heard += received->size;  // a beat now and then is an error of one in a million
    }
  }
  state.SetItemsProcessed(state.iterations() * kWindow);
}

void documented_server(benchmark::State& state) {
  kinovazed::emulation::ServerOptions options;
  options.behaviour = kinovazed::emulation::kDocumentedBehaviour;
  options.call_time = {};
  kinovazed::emulation::Server server{
      kinovazed::emulation::ArmPort{kinovazed::emulation::JacoArm{}}, options};
  auto host = Host::open(make_hosted(std::move(server)), {.tcp = TcpOptions{}});
  std::thread thread{[&host] { host->run(); }};
  ping(state, host->targets().front().substr(4), kCommand, kReply.size());
  host->stop();
  thread.join();
}
BENCHMARK(documented_server)->MeasureProcessCPUTime()->UseRealTime();

enum class Writes : std::uint8_t { kEachLine, kAllAtOnce };

bool send_all(int socket, std::string_view text) {
  while (!text.empty()) {
    const auto sent = ::send(socket, text.data(), text.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

/// Reads, cuts into lines, sends each back, until the client has gone.
void echo_lines(const test::ListeningSocket& listener, Writes writes) {
  // Without delay: what is measured is the echo, not Nagle's waiting.
  const auto client = listener.accept();
  std::array<char, 16384> buffer;
  std::string out;
  for (;;) {
    const auto size = ::recv(client.value(), buffer.data(), buffer.size(), 0);
    if (size <= 0) return;
    for (const char c : std::string_view{buffer.data(), static_cast<std::size_t>(size)}) {
      out.push_back(c);
      if (c != '\n' || writes == Writes::kAllAtOnce) continue;
      if (!send_all(client.value(), out)) return;
      out.clear();
    }
    if (writes == Writes::kEachLine) continue;
    if (!send_all(client.value(), out)) return;
    out.clear();
  }
}

template <Writes writes>
void line_echo(benchmark::State& state) {
  const test::ListeningSocket listener;
  std::thread thread{[&listener] { echo_lines(listener, writes); }};
  ping(state, "127.0.0.1:" + std::to_string(listener.port()), kReply, kReply.size());
  thread.join();
}
BENCHMARK(line_echo<Writes::kEachLine>)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(line_echo<Writes::kAllAtOnce>)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace armjig
