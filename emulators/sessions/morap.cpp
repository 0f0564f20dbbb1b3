// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "emulators/morap/eeprom.hpp"
#include "emulators/sessions/odd_fields.hpp"
#include "emulators/sessions/sessions.hpp"
#include "emulators/sessions/theme.hpp"
#include "harness/core/hex.hpp"
#include "harness/wire/morap/fields.hpp"
#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::morap::sessions {
namespace {

using namespace armjig::sessions;

/// Ticks of rates that nodes begin with or are often told, in cycles.
constexpr std::array kTickCycles{80'008, 80'008, 40'001, 25'601, 32'001};
constexpr std::int64_t kCyclesPerUs = 16;

/// The motor and gear of a recording's header; what it carries is drawn.
struct Motor {
  emulation::Eeprom (*eeprom)(std::uint8_t node) noexcept;
  std::string_view plant;
};
constexpr std::array kMotors{
    Motor{emulation::dcx22l, R"("R":2.16,"L":0.000192,"K":0.0229,"n":231.20308,"eta":0.74,)"
                             R"("counts_per_rad":18840.121876516314)"},
    Motor{emulation::dcx26l, R"("R":1.07,"L":0.000129,"K":0.0214,"n":149.0,"eta":0.75,)"
                             R"("counts_per_rad":12141.612298594511)"}};

class Session : public Draft {
 public:
  explicit Session(const Start& start) : Draft{start} {
    has_plant_ = theme_ == "loop" || (theme_ == "bus" && dice_.one_in(2));
    has_pen_ = theme_ == "pen" || (is_bus_ && dice_.one_in(2));
    const auto count = theme_ == "bus" ? dice_.between(2, 4) : 1;
    for (std::int64_t i = 0; i < count; ++i) {
      const auto node = static_cast<std::uint8_t>(4 * i + dice_.between(0, i == 2 ? 0 : 3));
      if (!nodes_.empty()) nodes_ += "},{";
      nodes_ += describe(node);
      addresses_.push_back(node_address(node));
    }
    if (has_pen_) nodes_ += R"(},{"kind":"pen","address":25)";
  }

  [[nodiscard]] std::string finish() {
    return text(is_bus_ ? "morap-bus" : "morap-node",
                fmt::format(R"("family":"{}","seed":{},)"
                            R"("bus":{{"start_us":10,"byte_us":90,"stop_us":10}},{})",
                            has_plant_ ? "closed-loop" : "static", seed_,
                            is_bus_ ? R"("nodes":[{)" + nodes_ + "}]" : nodes_));
  }

  // Commands.
  void order() {
    const auto& info = dice_.one_of(commands());
    write(encode_order(info));
  }
  void refer() {
    constexpr std::array kModes{CommandId::kPosition, CommandId::kSpeed, CommandId::kVoltage,
                                CommandId::kDirectVoltage, CommandId::kTorque};
    const auto mode = dice_.one_of(kModes);
    write(encode({mode, some_float()}));
  }
  void calibrate() {
    const bool is_zero = dice_.one_in(2);
    if (is_zero) return write(encode({CommandId::kCalibrateZero, {}}));
    write(encode({CommandId::kCalibrateAngle, some_float()}));
  }
  void program() { write(encode({CommandId::kProgram, some_set()})); }
  void program_badly() {
    const auto set = some_set();
    const auto good = encode({CommandId::kProgram, set});
    // Field lists begin with the byte of the address.
    std::vector<std::byte> bytes{std::byte{}};
    bytes.insert(bytes.end(), good.view().begin(), good.view().end());
    switch (dice_.between(0, 3)) {
      case 0:
        bytes.back() ^= static_cast<std::byte>(dice_.between(1, 255));
        break;
      case 1:
        bytes.resize(dice_.number<std::size_t>(2, std::ssize(bytes) - 1));
        break;
      case 2: {
        const auto surplus = dice_.bytes(1, 12);
        bytes.insert(bytes.end(), surplus.begin(), surplus.end());
        break;
      }
      default:
        spoil_a_field(dice_, program_fields(set), bytes);
        bytes.back() = std::byte{checksum(Bytes{bytes}.subspan(2, bytes.size() - 3))};
    }
    write(Bytes{bytes}.subspan(1));
  }
  void defaults() { write(encode({CommandId::kDefaultControllers, {}})); }
  void tune() {
    const TuneRequest request{dice_.number<TuneKind>(0, dice_.one_in(6) ? 255 : 2),
                              dice_.number<float>(1, 2000) / 2000.0F,
                              dice_.number<float>(-300, dice_.one_in(6) ? 50 : -1)};
    write(encode({CommandId::kTune, request}));
  }
  void odd_write() {
    const auto bytes = dice_.bytes(0, dice_.one_in(10) ? 300 : 7);
    write(bytes);
  }
  void cut_write() {
    const auto bytes = encode_order(dice_.one_of(commands()));
    write(bytes.view().first(dice_.number<std::size_t>(0, std::ssize(bytes.view()))));
  }
  void long_write() {
    const auto bytes = encode_order(dice_.one_of(commands()));
    std::vector<std::byte> all(bytes.view().begin(), bytes.view().end());
    const auto surplus = dice_.bytes(1, 9);
    all.insert(all.end(), surplus.begin(), surplus.end());
    write(all);
  }

  // Reading.
  void ask() {
    const auto& info = dice_.one_of(readings());
    select(info.selector);
    const auto whole = info.kind == ReadKind::kByte    ? 1
                       : info.kind == ReadKind::kFloat ? 4
                                                       : std::int64_t{kLargestSetSize};
    read(dice_.one_in(8) ? dice_.between(1, whole + 3) : whole);
  }
  void ask_outcome() {
    constexpr std::array kStates{CommandId::kReadMotorStatus, CommandId::kReadProgrammingStatus};
    select(dice_.one_of(kStates));
    read(1);
  }
  void ask_again() { read(dice_.one_in(20) ? dice_.between(1, 300) : 4); }

  // Others on the bus.
  void stranger() {
    const auto address = dice_.number<std::uint8_t>(1, 0x77);
    const bool is_known = std::ranges::find(addresses_, address) != addresses_.end();
    if (is_known || address == pen::kAddress) return rest();
    if (dice_.one_in(2)) return transfer_read(address, dice_.between(1, 5), "");
    transfer_write(address, dice_.bytes(0, 5), "");
  }
  void move_pen() {
    if (!has_pen_) return;
    pen::Command command{dice_.one_in(2) ? pen::CommandId::kDeploy : pen::CommandId::kRetract};
    if (dice_.one_in(2)) {
      command = {pen::CommandId::kSetPosition, dice_.number<std::uint8_t>(0, 255)};
    }
    if (dice_.one_in(12)) command = {dice_.number<pen::CommandId>(0, 255), 0};
    transfer_write(pen::kAddress, pen::encode(command), "");
    look_at_pen();
  }
  void press_button() {
    if (!has_pen_) return;
    add({R"("op":"input","addr":25,"but1":{},"but2":{})", dice_.between(0, 1),
         dice_.between(0, 1)});
    wait(dice_.between(1, 130'000));
    look_at_pen();
  }

  // Beside the bus.
  void turn_shaft() {
    if (has_plant_) return;
    add({R"("op":"encoder","addr":{},"delta":{})", address(), dice_.between(-3000, 3000)});
  }
  void load_motor() {
    if (has_plant_) return;
    add({R"("op":"adc","addr":{},"value":{})", address(), dice_.between(0, 4095)});
  }
  void restart() { add({R"("op":"restart","addr":{})", address()}); }

  // Time.
  void rest() { wait(dice_.mostly_low(1, 60'000)); }
  void meet_tick() {
    const std::int64_t period = dice_.one_of(kTickCycles);
    const auto next = (now_ * kCyclesPerUs / period + dice_.between(1, 3)) * period;
    now_ = std::max(now_, next / kCyclesPerUs + dice_.between(-800, 20));
  }

 private:
  [[nodiscard]] std::string describe(std::uint8_t node) {
    const auto& motor = dice_.one_of(kMotors);
    auto eeprom = motor.eeprom(node);
    if (theme_ == "weird") {
      eeprom.position = some_set(ControllerKind::kPosition);
      eeprom.speed = some_set(ControllerKind::kSpeed);
      eeprom.motor.resistance *= dice_.number<float>(1, 30) / 10.0F;
      eeprom.motor.friction *= dice_.number<float>(0, 30) / 10.0F;
      eeprom.motor.rated_current *= dice_.number<float>(1, 30) / 10.0F;
      eeprom.motor.pulses_per_turn *= dice_.number<float>(1, 4);
    }
    auto plant = std::string{"null"};
    if (has_plant_) {
      plant =
          Words{R"({{"dt_us":{},{},"J":0.{:03},"b":0.{:03},"tau_c":0.{:03},"tau_load":{}0.{:03}}})",
                dice_.between(20, 200),
                motor.plant,
                dice_.between(20, 400),
                dice_.between(10, 100),
                dice_.one_in(2) ? 0 : dice_.between(0, 500),
                dice_.one_in(2) ? "" : "-",
                dice_.one_in(2) ? 0 : dice_.between(0, 500)}
              .text;
    }
    return fmt::format(R"("node_id":{},"address":{},"eeprom":{{"words_le_hex":"{}"}},"plant":{})",
                       node, node_address(node), to_hex(emulation::encode(eeprom)), plant);
  }

  [[nodiscard]] float some_float() {
    constexpr std::array kUsual{0.0F, -0.0F, 1.0F, -1.0F, 0.01F, 24.0F, -24.0F, 12.0F, 1e6F};
    switch (dice_.between(0, 9)) {
      case 0:
      case 1:
        return dice_.one_of(kUsual);
      case 2: {  // any finite one
        const auto bits = dice_.number<std::uint32_t>(0, UINT32_MAX);
        return std::bit_cast<float>((bits & 0x7F80'0000U) == 0x7F80'0000U ? bits & ~0x4000'0000U
                                                                          : bits);
      }
      default:
        return dice_.number<float>(-1500, 1500) / 100.0F;
    }
  }
  [[nodiscard]] ControllerSet some_set() {
    auto kind = dice_.number<ControllerKind>(0, 1);
    if (dice_.one_in(16)) kind = dice_.number<ControllerKind>(0, 255);
    return some_set(kind);
  }
  [[nodiscard]] ControllerSet some_set(ControllerKind kind) {
    const auto coefficients = [this] {
      Coefficients some{dice_.number<std::uint8_t>(1, kMostCoefficients), {}};
      for (std::size_t i = 0; i < some.count; ++i) {
        some.values[i] = dice_.number<float>(-2500, 2500) / 1000.0F;
      }
      return some;
    };
    ControllerSet set{
        .kind = kind,
        .rate_hz = dice_.one_in(4) ? std::uint16_t{200} : dice_.number<std::uint16_t>(30, 1500)};
    if (dice_.one_in(12)) set.rate_hz = dice_.number<std::uint16_t>(1, UINT16_MAX);
    set.d = coefficients();
    set.c = coefficients();
    set.f = coefficients();
    if (dice_.one_in(2)) set.integral = dice_.number<float>(-500, 500) / 1000.0F;
    return set;
  }
  [[nodiscard]] WriteBytes encode_order(const CommandInfo& info) {
    switch (info.payload) {
      case Payload::kFloat:
        return encode({info.id, some_float()});
      case Payload::kControllerSet:
        return encode({info.id, some_set()});
      case Payload::kTuneRequest:
        return encode({info.id, TuneRequest{TuneKind::kPdPosition, 0.05F, -20.0F}});
      case Payload::kNone:
        break;
    }
    return encode({info.id, {}});
  }

  [[nodiscard]] std::uint8_t address() { return dice_.one_of(addresses_); }
  /// A transaction without a stop leads on to the next one.
  [[nodiscard]] std::string_view end() { return dice_.one_in(8) ? R"(,"stop":false)" : ""; }

  void select(CommandId reading) { write(encode({reading, {}})); }
  void write(Bytes bytes) {
    const auto to = address();
    transfer_write(to, bytes, end());
  }
  void read(std::int64_t count) {
    const auto from = address();
    transfer_read(from, count, end());
  }

  void transfer_write(std::uint8_t to, Bytes bytes, std::string_view stop) {
    add({R"("op":"write","addr":{},"hex":"{}","ack":""{})", to, to_hex(bytes), stop});
    finish_transfer(std::ssize(bytes), stop);
  }
  void transfer_read(std::uint8_t from, std::int64_t count, std::string_view stop) {
    add({R"("op":"read","addr":{},"n":{},"hex":"","ack":""{})", from, count, stop});
    finish_transfer(count, stop);
  }
  void finish_transfer(std::int64_t count, std::string_view stop) {
    wait(100 + 90 * count);
    if (!stop.empty()) return;
    wait(10);
    if (dice_.one_in(3)) wait(dice_.mostly_low(0, theme_ == "race" ? 600 : 12'000));
  }
  void look_at_pen() {
    add({R"("op":"state","addr":25,"servo_deg":0,"led1":0,"led2":0,"serial":"")"});
  }

  bool is_bus_ = theme_ == "bus" || theme_ == "pen";
  std::string nodes_;  ///< of the header
  std::vector<std::uint8_t> addresses_;
  bool has_plant_ = false;
  bool has_pen_ = false;
};

constexpr auto kAll = std::to_array<Deed<Session>>({{10, &Session::order},
                                                    {14, &Session::refer},
                                                    {5, &Session::calibrate},
                                                    {8, &Session::program},
                                                    {5, &Session::program_badly},
                                                    {2, &Session::defaults},
                                                    {5, &Session::tune},
                                                    {3, &Session::odd_write},
                                                    {3, &Session::cut_write},
                                                    {3, &Session::long_write},
                                                    {16, &Session::ask},
                                                    {8, &Session::ask_outcome},
                                                    {2, &Session::ask_again},
                                                    {2, &Session::stranger},
                                                    {3, &Session::turn_shaft},
                                                    {2, &Session::load_motor},
                                                    {1, &Session::restart},
                                                    {6, &Session::rest},
                                                    {6, &Session::meet_tick}});
constexpr auto kLoop = std::to_array<Deed<Session>>({{14, &Session::refer},
                                                     {6, &Session::calibrate},
                                                     {3, &Session::program},
                                                     {1, &Session::program_badly},
                                                     {2, &Session::defaults},
                                                     {5, &Session::tune},
                                                     {20, &Session::ask},
                                                     {2, &Session::order},
                                                     {1, &Session::restart},
                                                     {12, &Session::rest},
                                                     {4, &Session::meet_tick}});
constexpr auto kRace = std::to_array<Deed<Session>>({{10, &Session::program},
                                                     {10, &Session::program_badly},
                                                     {4, &Session::defaults},
                                                     {8, &Session::tune},
                                                     {4, &Session::cut_write},
                                                     {6, &Session::refer},
                                                     {3, &Session::calibrate},
                                                     {12, &Session::ask},
                                                     {8, &Session::ask_outcome},
                                                     {14, &Session::meet_tick}});
constexpr auto kPen = std::to_array<Deed<Session>>({{10, &Session::move_pen},
                                                    {10, &Session::press_button},
                                                    {3, &Session::refer},
                                                    {3, &Session::ask},
                                                    {2, &Session::stranger},
                                                    {4, &Session::rest}});
constexpr auto kBus = std::to_array<Deed<Session>>({{10, &Session::order},
                                                    {10, &Session::refer},
                                                    {5, &Session::calibrate},
                                                    {4, &Session::program},
                                                    {2, &Session::tune},
                                                    {20, &Session::ask},
                                                    {2, &Session::cut_write},
                                                    {6, &Session::stranger},
                                                    {5, &Session::move_pen},
                                                    {3, &Session::press_button},
                                                    {1, &Session::restart},
                                                    {6, &Session::rest}});

constexpr auto kThemes = std::to_array<Theme<Session>>({{"static", 8, 5'000, 2'500'000, kAll},
                                                        {"weird", 5, 5'000, 2'000'000, kAll},
                                                        {"race", 8, 5'000, 1'500'000, kRace},
                                                        {"loop", 8, 50'000, 4'000'000, kLoop},
                                                        {"bus", 6, 50'000, 2'500'000, kBus},
                                                        {"pen", 3, 50'000, 3'000'000, kPen}});

}  // namespace

std::string draw(const Roll& roll) { return play<Session>(roll, kThemes); }

}  // namespace armjig::morap::sessions
