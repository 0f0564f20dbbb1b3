// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/kinovazed/line_receiver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "harness/wire/kinovazed/line_splitter.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig::kinovazed {
namespace {

Bytes line_bytes(std::string_view text) { return std::as_bytes(std::span{text}); }

/// What a server finds in segments that come one after the other: lines, "<too long>".
class Server {
 public:
  explicit Server(Profile profile) : receiver_{profile} {}

  std::vector<std::string> hear(const std::vector<std::string>& segments) {
    std::vector<std::string> found;
    for (const auto& segment : segments) {
      auto rest = line_bytes(segment);
      for (;;) {
        const auto size = std::min(receiver_.room(), rest.size());
        receiver_.fill(rest.first(size));
        rest = rest.subspan(size);
        const bool is_full = receiver_.room() == 0;
        const auto step = receiver_.step();
        if (step == LineReceiver::Found::kTooLong) return found.push_back("<too long>"), found;
        if (step == LineReceiver::Found::kLine) found.emplace_back(receiver_.line());
        if (step == LineReceiver::Found::kNothing && rest.empty() && !is_full) break;
      }
    }
    return found;
  }

  LineReceiver receiver_;
};

std::vector<std::string> firmware(const std::vector<std::string>& segments) {
  return Server{Profile::kFirmware}.hear(segments);
}
std::vector<std::string> documented(const std::vector<std::string>& segments) {
  return Server{Profile::kDocumented}.hear(segments);
}
using Lines = std::vector<std::string>;

TEST(KinovaReceiver, LosesTheByteBehindAnLfThatComesFirst) {
  EXPECT_EQ(firmware({"\nEStop\r\n"}), (Lines{"", "Stop\r"}));
  EXPECT_EQ(firmware({"\nXEStop\r\n"}), (Lines{"", "EStop\r"}));
  EXPECT_EQ(firmware({"\n", "EStop\r\n"}), (Lines{"", "EStop\r"}));
  EXPECT_EQ(firmware({"\n\nEStop\r\n"}), (Lines{"", "EStop\r"}));
  EXPECT_EQ(firmware({"\n\n\nEStop\r\n"}), (Lines{"", "", "Stop\r"}));
  EXPECT_EQ(documented({"\nEStop\r\n"}), (Lines{"", "EStop\r"}));
}

TEST(KinovaReceiver, LosesAByteBehindALineOfJust128Bytes) {
  for (const std::size_t length : {127U, 128U, 129U, 256U}) {
    const auto line = std::string(length, ' ');
    const bool loses = length % 128 == 0;
    EXPECT_EQ(firmware({line + "\nEStop\r\n"}), (Lines{line, loses ? "Stop\r" : "EStop\r"}))
        << length;
  }
}

TEST(KinovaReceiver, TakesLinesOf1152Bytes) {
  EXPECT_EQ(firmware({std::string(1151, 'B') + "\n"}).front().size(), 1151U);
  EXPECT_TRUE(firmware({std::string(1151, 'B')}).empty());
  EXPECT_EQ(firmware({std::string(1152, 'B')}), (Lines{"<too long>"}));
  EXPECT_EQ(documented({std::string(1024, 'B') + "\n"}).front().size(), 1024U);
  EXPECT_EQ(documented({std::string(1025, 'B')}), (Lines{"<too long>"}));
}

TEST(KinovaReceiver, KeepsWholePiecesOfAClientThatLeft) {
  Server server{Profile::kFirmware};
  EXPECT_TRUE(server.hear({std::string(128, 'A')}).empty());
  server.receiver_.end_of_stream();
  EXPECT_EQ(server.hear({"EStop\r\nEStop\r\n"}),
            (Lines{std::string(128, 'A') + "EStop\r", "EStop\r"}));
  EXPECT_TRUE(server.hear({std::string(127, 'A')}).empty());
  server.receiver_.end_of_stream();
  EXPECT_EQ(server.hear({"EStop\r\n"}), (Lines{"EStop\r"}));
}

TEST(KinovaReceiver, LetsStaleBytesShortenTheNextLine) {
  Server server{Profile::kFirmware};
  EXPECT_TRUE(server.hear({std::string(1024, 'A')}).empty());
  server.receiver_.end_of_stream();
  EXPECT_EQ(server.hear({std::string(128, 'B')}), (Lines{"<too long>"}));
}

TEST(KinovaReceiver, CopiesAsAValue) {
  Server server{Profile::kFirmware};
  EXPECT_TRUE(server.hear({std::string(130, ' ') + "ESt"}).empty());
  auto copy = server;
  EXPECT_EQ(copy.hear({"op\n"}), server.hear({"op\n"}));
}

/// A stream of short lines, long ones and many line ends.
rc::Gen<std::string> streams() {
  return rc::gen::container<std::string>(rc::gen::weightedOneOf<char>(
      {{3, rc::gen::just('\n')}, {1, rc::gen::just('\r')}, {20, rc::gen::just('x')}}));
}

std::vector<std::string> in_pieces(const std::string& stream, std::size_t piece) {
  std::vector<std::string> pieces;
  for (std::size_t i = 0; i < stream.size(); i += piece) pieces.push_back(stream.substr(i, piece));
  return pieces;
}

TEST(KinovaReceiver, OfTheDocumentDoesNotCareHowTheStreamIsCut) {
  test::for_all([] {
    const auto stream = *streams();
    const auto piece = static_cast<std::size_t>(*rc::gen::inRange(1, 9));
    RC_ASSERT(documented({stream}) == documented(in_pieces(stream, piece)));
  });
}

std::vector<std::string> split(const std::vector<std::string>& segments) {
  LineSplitter splitter;
  std::vector<std::string> found;
  for (const auto& segment : segments) {
    for (auto rest = line_bytes(segment); !rest.empty();) {
      const auto step = splitter.step(rest);
      rest = rest.subspan(step.used);
      if (step.found != LineSplitter::Found::kNothing) found.emplace_back(step.line);
    }
  }
  found.push_back("rest: " + std::string{splitter.held()});
  return found;
}

TEST(KinovaSplitter, DoesNotCareHowTheStreamIsCut) {
  test::for_all([] {
    const auto stream =
        *streams() +
        std::string(*rc::gen::elementOf(std::vector<std::size_t>{0, 1151, 1152, 1153, 2400}), 'y') +
        *streams();
    const auto piece = static_cast<std::size_t>(*rc::gen::inRange(1, 9));
    RC_ASSERT(split({stream}) == split(in_pieces(stream, piece)));
  });
}

TEST(KinovaSplitter, HandsOutLongLinesInPieces) {
  const std::string line(1152, 'y');
  EXPECT_EQ(split({line + "\n"}), (Lines{line, "rest: "}));
  EXPECT_EQ(split({line + "z\n"}), (Lines{line, "z", "rest: "}));
}

}  // namespace
}  // namespace armjig::kinovazed
