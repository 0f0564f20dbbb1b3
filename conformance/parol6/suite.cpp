// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/suite.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "harness/core/hex.hpp"
#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6 {
namespace {

using namespace std::chrono_literals;

constexpr std::array kRequirements{
    Requirement{"parol6.frame.one-answer", Level::kMust,
                "Every good frame is answered with exactly one telemetry frame.",
                "firmware: one answer for each accepted frame"},
    Requirement{"parol6.frame.no-chatter", Level::kMust,
                "The board sends nothing that was not asked for.",
                "firmware: it only ever answers"},
    Requirement{"parol6.frame.split-anywhere", Level::kMust,
                "A frame may arrive in pieces, cut at any byte.",
                "arithmetic: a byte stream has no borders; the GUI writes a frame in 26 pieces"},
    Requirement{"parol6.frame.burst", Level::kMust,
                "Frames that arrive together are all answered, in order.",
                "firmware: all waiting bytes are read in one pass"},
    Requirement{"parol6.frame.noise", Level::kMust,
                "Bytes without a start pattern in front of a frame do no harm.",
                "firmware: the receiver looks for FF FF FF"},
    Requirement{"parol6.frame.wrong-end", Level::kMust,
                "A frame that does not end with 01 02 is not answered, and the next good one is.",
                "document, end bytes; firmware"},
    Requirement{"parol6.frame.recovers", Level::kMust,
                "After any garbage the board answers again within six good frames.",
                "firmware: a length byte claims at most 255 bytes"},
    Requirement{"parol6.frame.check-ignored", Level::kMust,
                "The check byte of a frame is not looked at.",
                "firmware; the document says otherwise, profile documented"},
    Requirement{"parol6.telemetry.layout", Level::kMust,
                "Telemetry is 60 bytes: FF FF FF 38, payload, check D4, end bytes 01 02; the spare "
                "flag bits are ones.",
                "document, packet table; firmware"},
    Requirement{"parol6.telemetry.constants", Level::kMust,
                "What the firmware never computes is constant: timeout error 100, gripper id 0, "
                "gripper speed 1, object detection 1.",
                "firmware"},
    Requirement{"parol6.telemetry.echo", Level::kMust,
                "Telemetry repeats the command byte of the frame that it answers.", "firmware"},
    Requirement{"parol6.telemetry.timing", Level::kMust,
                "The timing field counts 703,125 Hz ticks since the frame before.",
                "document, timing; arithmetic: 90 MHz / 128"},
    Requirement{"parol6.telemetry.idle-speed", Level::kMust,
                "An idle frame sets the speeds that telemetry reports from the next frame on, "
                "signed, 24 bits, most significant byte first, at most 50,000, without motion.",
                "firmware: idle loads the set speed"},
    Requirement{"parol6.telemetry.outputs", Level::kMust,
                "The answer shows both outputs as its own frame set them.",
                "firmware: outputs are written before the answer is made"},
};

constexpr auto kAnswerTime = 250ms;
/// Long enough for a frame that should not come.
constexpr auto kSilence = 50ms;

CommandFrame idle() {
  CommandFrame frame;
  frame.command = Command::kIdle;
  frame.check = kCheckHost;
  return frame;
}

/// Codes that neither move anything nor change a state.
constexpr std::array kHarmlessCodes{0, 1, 42, 99, 104, 122, 124, 155, 157, 200, 254, 255};

/// The fields of the next answer.
std::optional<TelemetryFrame> telemetry(Bench& bench) {
  const auto message = bench.receive(kAnswerTime);
  if (!message || !message->fault.empty()) return std::nullopt;
  return decode_telemetry(body_of(Bytes{message->raw}.first<kTelemetryFrameSize>()));
}

/// Judges that telemetry comes now, and that the check of it finds nothing to say.
template <class Check>
Judgement expect_telemetry(Bench& bench, Check check) {
  const auto frame = telemetry(bench);
  return frame ? check(*frame) : fail("a telemetry frame", "none in 250 ms");
}

Judgement expect_answer(Bench& bench, std::string_view what) {
  return telemetry(bench) ? pass() : fail(fmt::format("an answer to {}", what), "none in 250 ms");
}

Judgement expect_silence(Bench& bench, std::string_view what) {
  const auto message = bench.receive(kSilence);
  if (!message) return pass();
  return fail(fmt::format("no answer to {}", what), to_hex_dump(message->raw));
}

Judgement expect_equal(std::string_view field_name, std::int64_t expected, std::int64_t actual) {
  if (expected == actual) return pass();
  const auto& field = *find_field(telemetry_fields(), field_name);
  return fail(fmt::format("{} = {}", field_name, field_text(field, expected)),
              fmt::format("{} = {}", field_name, field_text(field, actual)));
}

bool failed(const Judgement& judgement) { return judgement.verdict != Verdict::kPass; }

Judgement one_answer(Bench& bench) {
  for (int i = 0; i < 10; ++i) {
    bench.send(encode(idle()));
    if (auto judgement = expect_answer(bench, "a good frame"); failed(judgement)) return judgement;
  }
  return expect_silence(bench, "what has been answered already");
}

Judgement no_chatter(Bench& bench) {
  bench.pause(500ms);
  return expect_silence(bench, "nothing at all");
}

Judgement split_in_two(Bench& bench) {
  const auto frame = encode(idle());
  for (std::size_t split = 1; split < frame.size(); ++split) {
    bench.send(std::span{frame}.first(split));
    bench.pause(2ms);
    bench.send(std::span{frame}.subspan(split));
    const auto what = fmt::format("a frame cut behind byte {}", split);
    if (auto judgement = expect_answer(bench, what); failed(judgement)) return judgement;
  }
  return pass();
}

Judgement split_bytewise(Bench& bench) {
  for (const auto byte : encode(idle())) {
    bench.send(std::span{&byte, 1});
    bench.pause(1ms);
  }
  return expect_answer(bench, "a frame that came byte by byte");
}

Judgement burst(Bench& bench) {
  std::vector<std::byte> frames;
  constexpr std::array kCodes{1, 42, 255};
  for (const auto code : kCodes) {
    auto frame = idle();
    frame.command = Command{static_cast<std::uint8_t>(code)};
    const auto bytes = encode(frame);
    frames.insert(frames.end(), bytes.begin(), bytes.end());
  }
  bench.send(frames);
  for (const auto code : kCodes) {
    auto judgement = expect_telemetry(bench, [code](const TelemetryFrame& frame) {
      return expect_equal("echo", code, static_cast<std::int64_t>(frame.echo));
    });
    if (failed(judgement)) return judgement;
  }
  return expect_silence(bench, "what has been answered already");
}

Judgement noise(Bench& bench) {
  std::mt19937 random{1};  // NOLINT(bugprone-random-generator-seed): the same bytes every time
  for (std::size_t size = 1; size <= 64; size *= 2) {
    std::vector<std::byte> bytes(size);
    std::ranges::generate(bytes, [&] { return static_cast<std::byte>(random() % 0xFF); });
    const auto frame = encode(idle());
    bytes.insert(bytes.end(), frame.begin(), frame.end());
    bench.send(bytes);
    const auto what = fmt::format("a good frame behind {} bytes of noise", size);
    if (auto judgement = expect_answer(bench, what); failed(judgement)) return judgement;
  }
  return pass();
}

Judgement wrong_end(Bench& bench) {
  constexpr std::array<std::pair<int, int>, 4> kWrongEnds{{{1, 3}, {2, 2}, {0, 0}, {2, 1}}};
  for (const auto& [first, second] : kWrongEnds) {
    auto frame = encode(idle());
    frame[kCommandFrameSize - 2] = static_cast<std::byte>(first);
    frame[kCommandFrameSize - 1] = static_cast<std::byte>(second);
    bench.send(frame);
    const auto what = fmt::format("a frame that ends with {:02X} {:02X}", first, second);
    if (auto judgement = expect_silence(bench, what); failed(judgement)) return judgement;
    bench.send(encode(idle()));
    if (auto judgement = expect_answer(bench, "the good frame behind it"); failed(judgement)) {
      return judgement;
    }
  }
  return pass();
}

Judgement recovers(Bench& bench) {
  // Each kind of garbage that can make a receiver wait: a stray start byte, a length that claims
  // the most, a frame cut short. Length 0 is left out: the shipped board may stay deaf for long.
  const auto good = encode(idle());
  const std::array<std::vector<std::byte>, 4> garbage{
      std::vector(1, kStartByte), std::vector(4, kStartByte), std::vector(300, kStartByte),
      std::vector(good.begin(), good.begin() + 30)};
  for (const auto& bytes : garbage) {
    bench.send(bytes);
    bool has_answered = false;
    for (int i = 0; i < 6 && !has_answered; ++i) {
      bench.send(good);
      has_answered = bench.receive(kSilence).has_value();
    }
    if (!has_answered) {
      return fail(
          fmt::format("an answer within six good frames after {}{}",
                      to_hex_dump(std::span{bytes}.first(std::min<std::size_t>(bytes.size(), 8))),
                      bytes.size() > 8 ? " ..." : ""),
          "silence");
    }
    bench.drain(kSilence);
  }
  return pass();
}

Judgement check_ignored(Bench& bench) {
  for (const int check : {0x00, 0x01, 0xD4, 0xE4, 0xFF}) {
    auto frame = idle();
    frame.check = static_cast<std::uint8_t>(check);
    bench.send(encode(frame));
    const auto what = fmt::format("a frame with check byte {:02X}", check);
    if (auto judgement = expect_answer(bench, what); failed(judgement)) return judgement;
  }
  return pass();
}

Judgement layout(Bench& bench) {
  bench.send(encode(idle()));
  const auto message = bench.receive(kAnswerTime);
  if (!message) return fail("a telemetry frame", "none in 250 ms");
  if (!message->fault.empty()) return fail("60 bytes FF FF FF 38 ... 01 02", message->fault);
  const auto frame = decode_telemetry(body_of(Bytes{message->raw}.first<kTelemetryFrameSize>()));
  struct Spare {
    std::string_view field;
    std::uint8_t value;
    std::uint8_t mask;
  };
  for (const auto& [field, value, mask] :
       {Spare{"check", frame.check, 0xFF}, Spare{"homed", frame.homed, 0x03},
        Spare{"io", frame.io, 0x07}, Spare{"temperature_error", frame.temperature_error, 0x03},
        Spare{"position_error", frame.position_error, 0x03}}) {
    const auto wanted = field == "check" ? kCheckBoard : mask;
    auto judgement = expect_equal(field, (value & ~mask) | wanted, value);
    if (failed(judgement)) return judgement;
  }
  return pass();
}

Judgement constants(Bench& bench) {
  bench.send(encode(idle()));
  return expect_telemetry(bench, [](const TelemetryFrame& frame) {
    struct Constant {
      std::string_view field;
      int wanted;
      int value;
    };
    for (const auto& [field, wanted, value] :
         {Constant{"timeout_error", 100, frame.timeout_error},
          Constant{"gripper.id", 0, frame.gripper.id},
          Constant{"gripper.speed", 1, frame.gripper.speed},
          Constant{"gripper.object", 1, frame.gripper.object_detection}}) {
      if (auto judgement = expect_equal(field, wanted, value); failed(judgement)) return judgement;
    }
    return pass();
  });
}

Judgement echo(Bench& bench) {
  for (const auto code : kHarmlessCodes) {
    auto command = idle();
    command.command = Command{static_cast<std::uint8_t>(code)};
    bench.send(encode(command));
    auto judgement = expect_telemetry(bench, [code](const TelemetryFrame& frame) {
      return expect_equal("echo", code, static_cast<std::int64_t>(frame.echo));
    });
    if (failed(judgement)) return judgement;
  }
  return pass();
}

Judgement timing(Bench& bench) {
  constexpr double kTicksPerSecond = 703'125.0;
  constexpr double kClockError = 0.02;  // the board runs from an RC oscillator: 1 %, and a margin
  constexpr double kLinkTicks = 7031;   // 10 ms for links that deliver late
  const auto ticks_in = [](Duration time) {
    return std::chrono::duration<double>(time).count() * kTicksPerSecond;
  };
  bench.send(encode(idle()));
  (void)bench.receive(kAnswerTime);
  for (const auto gap : {5ms, 20ms, 60ms}) {
    const auto before = bench.now();
    bench.pause(gap);
    bench.send(encode(idle()));
    const auto frame = telemetry(bench);
    if (!frame) return fail("a telemetry frame", "none in 250 ms");
    // The board took the frame before somewhat earlier than its answer came.
    const auto least = ticks_in(gap) * (1 - kClockError) - 71;
    const auto most = ticks_in(bench.now() - before) * (1 + kClockError) + kLinkTicks;
    const auto above_least = static_cast<std::uint16_t>(frame->timing - static_cast<int>(least));
    if (above_least > most - least) {
      return fail(fmt::format("timing between {:.0f} and {:.0f} ticks, modulo 65536", least, most),
                  fmt::format("{} ticks", frame->timing));
    }
  }
  return pass();
}

Judgement idle_speed(Bench& bench) {
  constexpr std::array<int, 6> kSpeeds{1, -1, 255, -256, 40'000, -49'999};
  for (std::size_t turn = 0; turn < kJointCount; ++turn) {
    auto command = idle();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      command.speed[j] = StepsPerSecond{kSpeeds[(j + turn) % kSpeeds.size()]};
    }
    bench.send(encode(command));
    const auto before = telemetry(bench);
    bench.pause(2ms);
    bench.send(encode(command));
    const auto after = telemetry(bench);
    if (!before || !after) return fail("a telemetry frame", "none in 250 ms");
    for (std::size_t j = 0; j < kJointCount; ++j) {
      auto judgement = expect_equal(fmt::format("speed.j{}", j + 1), command.speed[j].value,
                                    after->speed[j].value);
      if (failed(judgement)) return judgement;
      judgement = expect_equal(fmt::format("position.j{}", j + 1), before->position[j].value,
                               after->position[j].value);
      if (failed(judgement)) return judgement;
    }
  }
  return pass();
}

Judgement outputs(Bench& bench) {
  constexpr auto kBoth = io_flag::kOut1 | io_flag::kOut2;
  for (const auto flags : {io_flag::kOut1, io_flag::kOut2, std::uint8_t{kBoth}, std::uint8_t{0}}) {
    auto command = idle();
    command.in_out = flags;
    bench.send(encode(command));
    auto judgement = expect_telemetry(bench, [flags](const TelemetryFrame& frame) {
      return expect_equal("io", (frame.io & ~kBoth) | flags, frame.io);
    });
    if (failed(judgement)) return judgement;
  }
  return pass();
}

constexpr std::array kCases{
    Case{"parol6.frame.one-answer", "parol6.frame.one-answer", "Ten frames get ten answers.",
         one_answer},
    Case{"parol6.frame.no-chatter", "parol6.frame.no-chatter", "Half a second of silence stays so.",
         no_chatter},
    Case{"parol6.frame.split-anywhere.two", "parol6.frame.split-anywhere",
         "A frame in two pieces, cut at each byte in turn, is answered.", split_in_two},
    Case{"parol6.frame.split-anywhere.bytes", "parol6.frame.split-anywhere",
         "A frame that comes byte by byte is answered.", split_bytewise},
    Case{"parol6.frame.burst", "parol6.frame.burst", "Three frames in one write get three answers.",
         burst},
    Case{"parol6.frame.noise", "parol6.frame.noise",
         "Noise in front of a good frame is passed over.", noise},
    Case{"parol6.frame.wrong-end", "parol6.frame.wrong-end",
         "Wrong end bytes cost one frame, not two.", wrong_end},
    Case{"parol6.frame.recovers", "parol6.frame.recovers",
         "Start bytes and cut frames do not deafen the board.", recovers},
    Case{"parol6.frame.check-ignored", "parol6.frame.check-ignored",
         "Five different check bytes are all answered.", check_ignored},
    Case{"parol6.telemetry.layout", "parol6.telemetry.layout", "Telemetry has its constant bytes.",
         layout},
    Case{"parol6.telemetry.constants", "parol6.telemetry.constants",
         "Fields that the firmware never computes keep their values.", constants},
    Case{"parol6.telemetry.echo", "parol6.telemetry.echo", "Codes without effect are echoed.",
         echo},
    Case{"parol6.telemetry.timing", "parol6.telemetry.timing", "The timing field measures the gap.",
         timing},
    Case{"parol6.telemetry.idle-speed", "parol6.telemetry.idle-speed",
         "Speeds of idle frames come back, joint by joint.", idle_speed},
    Case{"parol6.telemetry.outputs", "parol6.telemetry.outputs",
         "Outputs are shown by the frame that sets them.", outputs, Hazard::kState},
};

/// Asks until the board answers, for it may wait for the rest of what it took for a long frame.
bool prepare(Bench& bench) {
  constexpr int kMostTries = 12;
  bench.drain(10ms);
  for (int i = 0; i < kMostTries && !bench.error(); ++i) {
    bench.send(encode(idle()));
    if (!bench.receive(i == 0 ? kAnswerTime : kSilence)) continue;
    bench.drain(10ms);
    return true;
  }
  return false;
}

}  // namespace

Suite suite() noexcept { return {"parol6", kRequirements, kCases, prepare}; }

}  // namespace armjig::parol6
