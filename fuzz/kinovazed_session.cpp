// SPDX-License-Identifier: Apache-2.0
// Whole sessions with the emulated server: clients that come, go and half-close, its arm and its
// deaths.
//
// Input: what falls when a session is drawn (`Roll`).
#include <algorithm>
#include <map>

#include "fuzz/kinovazed_possible.hpp"
#include "fuzz/session.hpp"

namespace armjig::fuzz {
namespace {

class ServerPromises {
 public:
  using Device = kinovazed::emulation::Server;
  static constexpr auto replay_watched = kinovazed::replay::replay_watched;
  static constexpr std::size_t kMostHeap = 256 * 1024;

  explicit ServerPromises(const Trace& session) {
    for (const auto& event : session.events) {
      if (event.dir == "to_device") {
        lines_[event.id] += std::ranges::count(event.bytes, std::byte{'\n'});
      }
    }
  }

  static void see(const Device& server, Instant /*time*/) { require_possible(server); }

  /// A line is answered once at most; some have no answer, and the dead give none.
  void hear(const std::vector<TraceEvent>& answers) const {
    std::map<std::uint32_t, std::string> said;
    for (const auto& event : answers) {
      if (event.dir == "from_device") said[event.id] += as_text(event.bytes);
    }
    for (const auto& [connection, text] : said) {
      const auto lines = lines_.find(connection);
      require(replies_in(text) <= (lines == lines_.end() ? 0 : lines->second),
              "no line is answered twice");
    }
  }

  static void take_what_it_said(Device& server) {
    server.clear_sent();
    server.clear_log();
  }

 private:
  static std::ptrdiff_t replies_in(std::string_view text) {
    std::ptrdiff_t count = 0;
    for (const std::string_view reply : {"Accepted\r\n", "Rejected\r\n"}) {
      for (auto at = text.find(reply); at != text.npos; at = text.find(reply, at + 1)) ++count;
    }
    return count;
  }

  std::map<std::uint32_t, std::ptrdiff_t> lines_;  ///< of each connection
};

}  // namespace
}  // namespace armjig::fuzz

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace std::chrono_literals;
  using armjig::fuzz::ServerPromises;
  armjig::fuzz::check_session<ServerPromises>(armjig::test::kDrawnDevices[2], {data, size}, 20s);
  return 0;
}
