// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/telnet/com_port.hpp"

#include "tests/unit/support/bytes.hpp"

/// Numbers and names are those of RFC 2217; IAC is FF, SB FA, SE F0, WILL FB, WONT FC, DO FD, DONT
/// FE, COM-PORT-OPTION 2C; answers of a server have the number of the request plus 100 (0x64).
namespace armjig::telnet {
namespace {

using test::ByteVector;
using test::hex;
using test::same_bytes;

class ComPortServerTest : public testing::Test {
 protected:
  /// What it says to the bytes of a client.
  ByteVector say(std::string_view text) {
    ByteVector all;
    const auto bytes = hex(text);
    for (Bytes in{bytes}; !in.empty();) {
      const auto step = decoder_.step(in);
      in = in.subspan(step.used);
      ComPortServer::Answer answer;
      if (const auto* wish = std::get_if<Negotiation>(&step.found)) answer = server_.on(*wish);
      if (const auto* inside = std::get_if<Subnegotiation>(&step.found)) {
        answer = server_.on(*inside);
      }
      all.insert(all.end(), answer.view().begin(), answer.view().end());
    }
    return all;
  }
  /// A request within COM-PORT-OPTION.
  ByteVector ask(const std::string& text) { return say("FF FA 2C " + text + " FF F0"); }
  void agree() {
    (void)server_.begin();
    (void)say("FF FB 2C");
  }
  static ByteVector answer(const std::string& text) { return hex("FF FA 2C " + text + " FF F0"); }

  Decoder decoder_;
  ComPortServer server_;
};

TEST_F(ComPortServerTest, BeginsWithBinarySuppressGoAheadAndComPort) {
  EXPECT_TRUE(same_bytes(server_.begin(), hex("FF FD 00 FF FB 00 FF FD 03 FF FB 03 FF FD 2C")));
}

TEST_F(ComPortServerTest, SaysNothingToAnAgreementThatItAskedFor) {
  (void)server_.begin();
  EXPECT_TRUE(same_bytes(say("FF FB 00 FF FD 00 FF FB 03 FF FD 03"), {}));
  EXPECT_TRUE(same_bytes(say("FF FB 00 FF FD 00"), {})) << "said twice, it would loop";
}

TEST_F(ComPortServerTest, TellsTheModemStateOnceComPortIsAgreedOn) {
  (void)server_.begin();
  // Carrier 80, DSR 20, CTS 10; nothing has changed.
  EXPECT_TRUE(same_bytes(say("FF FB 2C"), answer("6B B0")));
  EXPECT_TRUE(same_bytes(say("FF FB 2C"), {}));
}

TEST_F(ComPortServerTest, AgreesToComPortInTheOtherDirectionToo) {
  (void)server_.begin();
  EXPECT_TRUE(same_bytes(say("FF FD 2C"), test::joined(hex("FF FB 2C"), answer("6B B0"))));
}

TEST_F(ComPortServerTest, RefusesOtherOptionsAndTakesRefusals) {
  (void)server_.begin();
  EXPECT_TRUE(same_bytes(say("FF FD 01"), hex("FF FC 01"))) << "DO ECHO: WONT";
  EXPECT_TRUE(same_bytes(say("FF FB 18"), hex("FF FE 18"))) << "WILL TERMINAL-TYPE: DONT";
  EXPECT_TRUE(same_bytes(say("FF FE 01 FF FC 18 FF FE 00 FF FC 03"), {}));
  EXPECT_TRUE(same_bytes(say("FF FB 2C FF FC 2C"), test::joined(answer("6B B0"), hex("FF FE 2C"))));
}

TEST_F(ComPortServerTest, AnswersNothingBeforeComPortIsAgreedOn) {
  (void)server_.begin();
  EXPECT_TRUE(same_bytes(ask("01 00 00 25 80"), {}));
  EXPECT_EQ(server_.settings(), ComPortSettings{});
}

TEST_F(ComPortServerTest, TakesABaudRate) {
  agree();
  // 3 000 000 = 0x002DC6C0
  EXPECT_TRUE(same_bytes(ask("01 00 2D C6 C0"), answer("65 00 2D C6 C0")));
  EXPECT_TRUE(same_bytes(ask("01 00 00 00 00"), answer("65 00 2D C6 C0"))) << "0 asks";
  EXPECT_TRUE(same_bytes(ask("01 00 00 FF FF FF FF"), answer("65 00 00 FF FF FF FF")))
      << "0xFFFF, escaped both ways";
}

TEST_F(ComPortServerTest, TakesTheFormOfACharacter) {
  agree();
  EXPECT_TRUE(same_bytes(ask("02 07"), answer("66 07")));
  EXPECT_TRUE(same_bytes(ask("03 03"), answer("67 03")));
  EXPECT_TRUE(same_bytes(ask("04 02"), answer("68 02")));
  EXPECT_EQ(server_.settings().data_size, 7);
  EXPECT_EQ(server_.settings().parity, 3);
  EXPECT_EQ(server_.settings().stop_size, 2);
}

TEST_F(ComPortServerTest, AnswersWhatHoldsToAValueThatDoesNotExist) {
  agree();
  EXPECT_TRUE(same_bytes(ask("02 09"), answer("66 08")));
  EXPECT_TRUE(same_bytes(ask("03 06"), answer("67 01")));
  EXPECT_TRUE(same_bytes(ask("04 00"), answer("68 01")));
  EXPECT_TRUE(same_bytes(ask("05 14"), {})) << "no control has the number 20";
  EXPECT_TRUE(same_bytes(ask("0C 04"), {}));
  EXPECT_TRUE(same_bytes(ask("63"), {}));
  EXPECT_TRUE(same_bytes(ask(""), {}));
}

TEST_F(ComPortServerTest, AcknowledgesEveryControl) {
  agree();
  for (int value = 1; value <= 19; ++value) {
    if (value == 4 || value == 7 || value == 10 || value == 13) continue;  // these ask
    const auto text = to_hex(Bytes{std::array{static_cast<std::byte>(value)}});
    EXPECT_TRUE(same_bytes(ask("05 " + text), answer("69 " + text)));
  }
}

TEST_F(ComPortServerTest, SaysHowControlsAre) {
  agree();
  for (const auto* const asked : {"05 00", "05 04", "05 07", "05 0A", "05 0D"}) (void)ask(asked);
  EXPECT_EQ(server_.settings(), ComPortSettings{}) << "to ask changes nothing";
  EXPECT_TRUE(same_bytes(ask("05 07"), answer("69 08")));
  (void)ask("05 09");
  EXPECT_TRUE(same_bytes(ask("05 07"), answer("69 09"))) << "DTR is off";
  EXPECT_TRUE(same_bytes(ask("05 0A"), answer("69 0B"))) << "RTS is on";
  EXPECT_TRUE(same_bytes(ask("05 04"), answer("69 06"))) << "no break";
  (void)ask("05 03");
  EXPECT_TRUE(same_bytes(ask("05 00"), answer("69 03"))) << "flow control by hardware";
}

TEST_F(ComPortServerTest, NotifiesAsTheMasksSay) {
  agree();
  EXPECT_TRUE(same_bytes(ask("0B 10"), test::joined(answer("6F 10"), answer("6B 10"))));
  EXPECT_TRUE(same_bytes(ask("0B 00"), answer("6F 00")));
  EXPECT_TRUE(same_bytes(ask("0A 20"), test::joined(answer("6E 20"), answer("6A 20"))));
  EXPECT_TRUE(same_bytes(ask("0A 01"), answer("6E 01")));
  EXPECT_TRUE(same_bytes(ask("07"), answer("6B B0"))) << "asked for, whatever the mask";
  EXPECT_TRUE(same_bytes(ask("06"), answer("6A 60")));
}

TEST_F(ComPortServerTest, ConfirmsThatItPurged) {
  agree();
  EXPECT_TRUE(same_bytes(ask("0C 03"), answer("70 03")));
}

TEST_F(ComPortServerTest, IsSuspendedUntilItMayGoOn) {
  agree();
  EXPECT_TRUE(same_bytes(ask("08"), {}));
  EXPECT_TRUE(server_.is_suspended());
  EXPECT_TRUE(same_bytes(ask("09"), {}));
  EXPECT_FALSE(server_.is_suspended());
}

TEST_F(ComPortServerTest, SaysItsNameToWhoAsks) {
  agree();
  EXPECT_TRUE(same_bytes(ask("00"), answer("64 61 72 6D 6A 69 67"))) << "armjig";
  EXPECT_TRUE(same_bytes(ask("00 78"), {})) << "the client's own name";
}

}  // namespace
}  // namespace armjig::telnet
