// SPDX-License-Identifier: Apache-2.0
#include "suite.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "conformance/stream_bench.hpp"
#include "gripper.hpp"
#include "harness/core/hex.hpp"

namespace gripper {

using namespace armjig;
using namespace std::chrono_literals;

namespace {

using enum Hazard;

enum Start : std::uint8_t { kAny, kStopped, kOpen };
constexpr std::array kStarts{StartState{"any", kObserve}, StartState{"stopped", kState},
                             StartState{"open", kGrip}};

constexpr std::uint8_t kNeighbour = kUnit + 1;
constexpr unsigned kFastest = 5000;
constexpr unsigned kWeak = 20;

/// Requests out, replies back. Silence means something here, so every pause is counted from the end
/// of what was sent.
class GripperBench final : public StreamBench {
 public:
  GripperBench(Rig<StreamPort> rig, unsigned baud, bool is_emulated)
      : StreamBench{std::move(rig), make_dissector()},
        silence_{Silence::at(baud)},
        tries_{is_emulated ? 1 : 5} {}

  bool is_alive() override {
    settle();
    return answers(read_request(kUnit, kModel, 1));
  }
  void bring_to(std::size_t start) override {
    settle();
    if (std::exchange(is_touched_, false)) {
      touch("object", 0);
      touch("jam", 0);
    }
    if (start == kStopped) stop();
    if (start == kOpen) move_to(kWidest, kFastest);
    if (start == kOpen) expect_end(Status::kArrived);
  }
  void measure_noise() override {
    ask(read_request(kUnit, kModel, 1));
    const auto begin = now();
    (void)receive(patience());
    hear_noise(now() - begin - soonest_reply());
  }

  /// Sends a request after silence. Ends with its last character.
  void ask(const Frame& frame) {
    pause(silence_.least_between + silence_.character);
    transmit(frame);
    asked_ = frame;
  }
  /// Whether anything comes of it.
  bool answers(const Frame& frame) {
    ask(frame);
    return receive(patience()).has_value();
  }
  /// The same with silence after the first `head` bytes.
  bool answers(const Frame& frame, std::ptrdiff_t head, Duration silence) {
    ask({frame.begin(), frame.begin() + head});
    pause(silence);
    transmit({frame.begin() + head, frame.end()});
    return receive(patience()).has_value();
  }
  /// A real line adds silence of its own, so there one of several tries may show what is right.
  void expect_answer(bool wanted, const Frame& frame, std::ptrdiff_t head, Duration gap) {
    bool is_right = false;
    for (int i = 0; i < tries_ && !is_right; ++i) is_right = answers(frame, head, gap) == wanted;
    if (!is_right) fail(wanted ? "a reply" : "no reply", wanted ? "none" : "one");
  }
  void expect_silence() {
    const auto reply = receive(patience());
    if (reply) fail("no reply", to_hex_dump(reply->raw));
  }
  /// The reply with these bytes between address and CRC.
  void expect(std::initializer_list<unsigned> bytes) { expect(request(kUnit, bytes)); }
  void expect_echo() { expect(asked_); }
  void expect(const Frame& wanted) {
    const auto reply = receive(patience() + 1s);
    if (!reply) return fail_by_silence(to_hex_dump(wanted), "silence");
    if (reply->raw != wanted) fail(to_hex_dump(wanted), to_hex_dump(reply->raw));
  }
  void expect_register(unsigned place, unsigned value) {
    ask(read_request(kUnit, place, 1));
    expect({3, 2, value >> 8, value & 0xFF});
  }
  unsigned read(unsigned place) {
    ask(read_request(kUnit, place, 1));
    const auto reply = receive(patience() + 1s);
    if (reply && reply->raw.size() == kReadOne) return load_u16_be(slice<2>(Bytes{reply->raw}, 3));
    fail("a register", reply ? to_hex_dump(reply->raw) : "silence");
    return 0;
  }

  /// All registers at once.
  void expect_block(std::initializer_list<unsigned> values) {
    ask(read_request(kUnit, kControl, kRegisters));
    Frame wanted{std::byte{kUnit}, std::byte{3}, std::byte{2 * kRegisters}};
    for (const auto value : values) append(wanted, value);
    append_crc(wanted);
    expect(wanted);
  }

  void put(std::string_view input, std::int64_t value) {
    touch(input, value);
    is_touched_ = !is_over();
  }
  void set(unsigned place, unsigned value) {
    ask(write_request(kUnit, place, value));
    expect_echo();
  }
  void stop() { set(kControl, 0); }
  void move_to(unsigned target, unsigned speed) {
    ask(write_many_request(kUnit, kControl, {1, target, speed, kWeak}));
    expect({16, 0, kControl, 0, 4});
  }
  /// Waits until the jaws move no more; how long that took.
  Duration expect_end(Status wanted) {
    const auto begin = now();
    auto status = read(kStatus);
    while (is_moving(status) && now() - begin < 6s && !is_over()) status = read(kStatus);
    expect_status(wanted, status);
    return now() - begin;
  }
  void expect_status(Status wanted) { expect_status(wanted, read(kStatus)); }

  /// Silences that spoil no frame, that spoil one, and that end one.
  [[nodiscard]] Duration least() const { return silence_.most_within * 2 / 3; }
  [[nodiscard]] Duration little() const {
    return (silence_.most_within + silence_.least_between) / 2;
  }
  [[nodiscard]] Duration enough() const { return silence_.least_between * 3 / 2; }
  [[nodiscard]] Duration time_of(std::size_t characters) const {
    return silence_.character * static_cast<int>(characters);
  }
  /// From the last character of a request to that of a reply with one register.
  [[nodiscard]] Duration soonest_reply() const {
    return silence_.least_between + time_of(kReadOne);
  }

 private:
  static constexpr std::size_t kReadOne = 7;  ///< a reply with one register
  static constexpr std::size_t kLongest = 20;

  static bool is_moving(unsigned status) { return status == unsigned(Status::kMoving); }
  void expect_status(Status wanted, unsigned status) {
    const auto& field = *find_field(block_fields(), "status");
    if (status == unsigned(wanted)) return;
    fail(field_text(field, static_cast<int>(wanted)), field_text(field, status));
  }
  /// Lets pass what a case that failed left under way.
  void settle() { drain(silence_.least_between + time_of(kLongest) + 20ms); }
  void transmit(const Frame& bytes) {
    send(bytes);
    pause(time_of(bytes.size()));
  }
  [[nodiscard]] Duration patience() const { return soonest_reply() + time_of(2) + noise() + 100ms; }

  Silence silence_;
  int tries_;
  Frame asked_;
  bool is_touched_ = false;
};

Frame operator+(Frame one, const Frame& other) {
  one.insert(one.end(), other.begin(), other.end());
  return one;
}
const auto kReadModel = read_request(kUnit, kModel, 1);
const auto kOtherModel = read_request(kNeighbour, kModel, 1);

// The documents: see rtu.hpp. What they leave to the device is "own".
constexpr Clause kFraming[] = {
    must("gripper.crc.order", "A reply ends with its CRC, the low byte first.", "[S] 2.5.1.2"),
    look([](GripperBench& bench) { bench.expect_register(kModel, kModelNumber); }),

    must("gripper.crc.checked", "A request with a wrong CRC is neither answered nor obeyed.",
         "[S] 2.6.2"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.set(kTarget, 600);
           auto request = write_request(kUnit, kTarget, 601);
           request.back() ^= std::byte{1};
           bench.ask(request);
           bench.expect_silence();
           bench.expect_register(kTarget, 600);
         }),

    must("gripper.silence.gap", "More than 1.5 characters of silence spoil a frame.",
         "[S] 2.5.1.1"),
    look([](GripperBench& bench) { bench.expect_answer(false, kReadModel, 4, bench.little()); }),

    must("gripper.silence.short-gap", "A frame may have shorter silences in it.", "[S] 2.5.1.1"),
    look([](GripperBench& bench) { bench.expect_answer(true, kReadModel, 4, bench.least()); }),

    must("gripper.silence.none", "Two requests without silence between them are none.",
         "[S] 2.5.1.1"),
    look([](GripperBench& bench) {
      bench.ask(kReadModel + kReadModel);
      bench.expect_silence();
    }),

    must("gripper.silence.little", "Less than 3.5 characters of silence end no frame.",
         "[S] 2.5.1.1"),
    look([](GripperBench& bench) {
      bench.expect_answer(false, kOtherModel + kReadModel, 8, bench.little());
    }),

    must("gripper.silence.enough", "A frame begins after 3.5 characters of silence.",
         "[S] 2.5.1.1"),
    look([](GripperBench& bench) {
      bench.expect_answer(true, kOtherModel + kReadModel, 8, bench.enough());
    }),

    must("gripper.silence.reply", "A reply comes after at least 3.5 characters of silence.",
         "[S] 2.5.1.1"),
    look([](GripperBench& bench) {
      bench.ask(kReadModel);
      const auto begin = bench.now();
      bench.expect({3, 2, 0x47, 0x52});
      if (bench.now() - begin < bench.soonest_reply())
        bench.fail("3.5 characters of silence", "less");
    }),

    must("gripper.frame.cut", "A request without its end is dropped, and the next one answered.",
         "[S] 2.5.1.1"),
    look([](GripperBench& bench) {
      bench.ask({kReadModel.begin(), kReadModel.end() - 1});
      bench.expect_silence();
      bench.expect_register(kModel, kModelNumber);
    }),
};

constexpr Clause kAddressing[] = {
    must("gripper.address.silent", "A request for another unit is not answered.", "[S] 2.1"),
    look([](GripperBench& bench) {
      bench.ask(kOtherModel);
      bench.expect_silence();
    }),

    must("gripper.address.unmoved", "A request for another unit is not obeyed.", "[S] 2.1"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.set(kTarget, 600);
           bench.ask(write_request(kNeighbour, kTarget, 601));
           bench.expect_silence();
           bench.expect_register(kTarget, 600);
         }),

    must("gripper.broadcast.silent", "A write to all units is not answered.", "[S] 2.1"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.set(kTarget, 600);
           bench.ask(write_request(kBroadcast, kTarget, 601));
           bench.expect_silence();
         }),

    must("gripper.broadcast.obeyed", "A write to all units is obeyed.", "[S] 2.1"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.set(kTarget, 600);
           (void)bench.answers(write_request(kBroadcast, kTarget, 601));
           bench.expect_register(kTarget, 601);
         }),
};

constexpr Clause kFunctions[] = {
    must("gripper.read.block", "Registers come in their order, the high byte first.", "[A] 6.3"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.ask(write_many_request(kUnit, kTarget, {0x0102, 0x0304, 0x0506}));
           bench.expect({16, 0, kTarget, 0, 3});
           bench.ask(read_request(kUnit, kTarget, 3));
           bench.expect({3, 6, 1, 2, 3, 4, 5, 6});
         }),

    must("gripper.read.all", "All registers of the gripper can be read at once.", "own"),
    from(kOpen, kGrip,
         [](GripperBench& bench) {
           bench.expect_block({1, 1000, kFastest, kWeak, 2, 1000, 0, kModelNumber});
           bench.ask(write_many_request(kUnit, kControl, {0, 900, 40, 2}));
           bench.expect({16, 0, kControl, 0, 4});
           bench.expect_block({0, 900, 40, 2, 0, 1000, 0, kModelNumber});
         }),

    must("gripper.write.stored",
         "The answer to a write is its echo, and what was written can be read.", "[A] 6.6"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.set(kSpeed, 1234);
           bench.expect_register(kSpeed, 1234);
         }),

    must("gripper.write.any-value", "A value too high for the gripper is no illegal value.",
         "[A] 7"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.set(kTarget, 0xFFFF);
           bench.expect_register(kTarget, 0xFFFF);
         }),

    must("gripper.write-many.reply", "A write of several is answered with place and count.",
         "[A] 6.12"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.ask(write_many_request(kUnit, kSpeed, {1, 2}));
           bench.expect({16, 0, kSpeed, 0, 2});
         }),

    must("gripper.reply.once", "A unit speaks when it is asked, and once.", "[S] 2.1"),
    look([](GripperBench& bench) {
      for (int i = 0; i < 12; ++i) bench.expect_register(kModel, kModelNumber);
      bench.expect_silence();
    }),
};

constexpr Clause kExceptions[] = {
    must("gripper.exception.function", "A function that is not there is exception 1.", "[A] 7"),
    look([](GripperBench& bench) {
      bench.ask(request(kUnit, {7}));
      bench.expect({0x87, 1});
    }),

    must("gripper.exception.read-address", "To read a register that is not there is exception 2.",
         "[A] 6.3"),
    look([](GripperBench& bench) {
      bench.ask(read_request(kUnit, kModel, 2));
      bench.expect({0x83, 2});
    }),

    must("gripper.exception.write-address", "To write a register that is only read is exception 2.",
         "[A] 6.6"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.ask(write_request(kUnit, kStatus, 0));
           bench.expect({0x86, 2});
         }),

    must("gripper.exception.read-count", "To read none, or more than 125, is exception 3.",
         "[A] 6.3"),
    look([](GripperBench& bench) {
      for (const unsigned count : {0U, kMostRead + 1U}) {
        bench.ask(read_request(kUnit, kControl, count));
        bench.expect({0x83, 3});
      }
    }),

    must("gripper.exception.write-count",
         "A byte count that is not twice the count, or no "
         "register, is exception 3.",
         "[A] 6.12"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.ask(write_many_request(kUnit, kTarget, {}));
           bench.expect({0x90, 3});
           bench.ask(request(kUnit, {16, 0, kTarget, 0, 2, 2, 0, 0}));
           bench.expect({0x90, 3});
         }),

    must("gripper.exception.length", "A request with a byte too many is exception 3.", "[A] 7"),
    look([](GripperBench& bench) {
      bench.ask(request(kUnit, {3, 0, kModel, 0, 1, 0}));
      bench.expect({0x83, 3});
    }),

    must("gripper.exception.order", "The count is judged before the address.", "[A] 6.3"),
    look([](GripperBench& bench) {
      bench.ask(read_request(kUnit, kRegisters + 1, 0));
      bench.expect({0x83, 3});
    }),

    must("gripper.exception.nothing-written", "A write that is refused changes nothing.", "own"),
    from(kAny, kState,
         [](GripperBench& bench) {
           bench.set(kForce, 30);
           bench.ask(write_many_request(kUnit, kForce, {31, 0}));
           bench.expect({0x90, 2});
           bench.expect_register(kForce, 30);
         }),

    must("gripper.exception.failure", "To move jaws that are jammed is exception 4.", "[A] 7"),
    from(kStopped, kGrip,
         [](GripperBench& bench) {
           bench.put("jam", 1);
           bench.ask(write_request(kUnit, kControl, 1));
           bench.expect({0x86, 4});
         }),
};

constexpr Clause kMotion[] = {
    must("gripper.move.arrives", "The jaws go where they are told.", "own"),
    from(kOpen, kGrip,
         [](GripperBench& bench) {
           bench.move_to(300, kFastest);
           bench.expect_end(Status::kArrived);
           bench.expect_register(kPosition, 300);
         }),

    must("gripper.move.speed", "They go as fast as they are told.", "own"),
    from(kOpen, kGrip,
         [](GripperBench& bench) {
           bench.move_to(0, kWidest / 2);
           const auto took = bench.expect_end(Status::kArrived);
           if (took < 1500ms || took > 3s) bench.fail("2 s", std::to_string(took / 1ms) + " ms");
         }),

    must("gripper.move.stop", "They stop where they are when told to.", "own"),
    from(kOpen, kGrip,
         [](GripperBench& bench) {
           bench.move_to(0, kWidest / 5);
           bench.expect_status(Status::kMoving);
           bench.stop();
           bench.expect_status(Status::kStopped);
           bench.expect_register(kPosition, bench.read(kPosition));
         }),

    must("gripper.move.holds", "They hold what they meet, with the force that they are told.",
         "own"),
    from(kOpen, kGrip,
         [](GripperBench& bench) {
           bench.put("object", 250);
           bench.move_to(0, kFastest);
           bench.expect_end(Status::kHolding);
           bench.expect_block({1, 0, kFastest, kWeak, 3, 250, kWeak, kModelNumber});
         }),
};

std::vector<NamedFault> all_faults() {
  std::vector<NamedFault> all;
  for (const auto& [name, chapter] : defects()) {
    all.push_back({std::string{name}, std::string{chapter}});
  }
  for (const auto& field : block_fields()) {
    for (const auto* kind : {"zero:", "stuck:", "off-by-one:"}) {
      all.push_back({std::string{kind}.append(field.name), "Replies"});
    }
  }
  for (const auto* kind : {"missing", "twice", "unasked", "cut-short"}) {
    all.push_back({kind, "Replies"});
  }
  return all;
}

constexpr std::array kEquivalents{EquivalentFault{"stuck:address", "it has only one value"},
                                  EquivalentFault{"stuck:model", "it has only one value"}};

}  // namespace

Suite suite() noexcept {
  static const std::array kChapters{chapter("Framing", kFraming),
                                    chapter("Addressing", kAddressing),
                                    chapter("Functions", kFunctions),
                                    chapter("Exceptions", kExceptions), chapter("Motion", kMotion)};
  return {"gripper", "1", kChapters, kStarts, {"suite.cpp"}};
}

std::unique_ptr<Bench> make_bench(Rig<StreamPort> rig, unsigned baud, bool is_emulated) {
  return std::make_unique<GripperBench>(std::move(rig), baud, is_emulated);
}

MutantsEntry mutants() noexcept { return {"gripper", all_faults, kEquivalents, {}}; }

}  // namespace gripper
