// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/target.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "conformance/morap/node_bench.hpp"
#include "emulators/morap/defects/joint_bus.hpp"
#include "harness/link/emulated_bus_port.hpp"

namespace armjig::morap {
namespace {

constexpr std::uint8_t kUsualNode = 2;
/// Longer than any device may hold the clock; one that does is a finding and not a failure.
constexpr Duration kClockPatience = std::chrono::milliseconds{100};
// Of the load on a free shaft: what the firmware's default controllers were designed for.
constexpr double kInertia = 0.05;
constexpr double kFriction = 0.1;

/// Reads one option after the other; remembers the first problem.
class OptionReader {
 public:
  explicit OptionReader(const Target& target) : target_{target} {
    for (const auto& [name, value] : target.options) {
      constexpr std::array<std::string_view, 4> kNames{"node", "motor", "profile", "fault"};
      if (std::ranges::find(kNames, name) != kNames.end()) continue;
      complain(ErrorCode::kUnknownOption, name, "morap has node, motor, profile and fault");
    }
  }

  [[nodiscard]] std::uint8_t node() {
    const auto* text = find("node");
    if (text == nullptr) return kUsualNode;
    std::uint8_t value{};
    const auto* const end = text->data() + text->size();
    const auto [stop, error] = std::from_chars(text->data(), end, value);
    if (error == std::errc{} && stop == end && value <= kLastNode) return value;
    complain(ErrorCode::kBadValue, "node=" + *text, "write a number from 0 to 16");
    return kUsualNode;
  }

  [[nodiscard]] const Motor* motor() {
    const auto* text = find("motor");
    if (text == nullptr) return nullptr;
    const auto motor = std::ranges::find(motors(), *text, &Motor::name);
    if (motor != motors().end()) return &*motor;
    complain(ErrorCode::kBadValue, "motor=" + *text, "there are: dcx22l dcx26l");
    return nullptr;
  }

  [[nodiscard]] Profile profile() {
    const auto* text = find("profile");
    if (text == nullptr || *text == "firmware") return kFirmware;
    if (*text != "documented") {
      complain(ErrorCode::kBadValue, "profile=" + *text, "there are: firmware documented");
    }
    return kDocumented;
  }

  void read_faults(NodeSetup& setup, Defects& defects) {
    const auto* text = find("fault");
    if (text == nullptr) return;
    for (std::string_view rest = *text; !rest.empty();) {
      const auto comma = std::min(rest.find(','), rest.size());
      const auto added = add_fault(rest.substr(0, comma), setup, defects);
      if (!added && !problem_) problem_ = added.error();
      rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
  }

  [[nodiscard]] const std::optional<Problem>& first_problem() const noexcept { return problem_; }

 private:
  [[nodiscard]] const std::string* find(std::string_view name) const {
    const auto option = target_.options.find(name);
    return option == target_.options.end() ? nullptr : &option->second;
  }
  void complain(ErrorCode code, const std::string& what, const std::string& hint) {
    if (!problem_) problem_ = Problem{code, target_.text + ": " + what, hint};
  }

  const Target& target_;
  std::optional<Problem> problem_;
};

Outcome<std::unique_ptr<BusPort>> open_joint(const Target& target) {
  OptionReader options{target};
  const auto* motor = options.motor();
  if (motor == nullptr) motor = &motors().front();
  NodeSetup setup{.eeprom = motor->eeprom(options.node()), .profile = options.profile()};
  setup.plant = plant_of(setup.eeprom.motor, kInertia, kFriction);
  Defects defects;
  options.read_faults(setup, defects);
  if (options.first_problem()) return tl::unexpected{*options.first_problem()};
  JointBus bus{DefectiveNode{setup, std::move(defects)}};
  return std::make_unique<EmulatedBusPort<JointBus>>(std::move(bus), kClockPatience);
}

}  // namespace

Outcome<std::unique_ptr<Bench>> open_node(const RigOptions& how) {
  OptionReader options{how.target};
  NodeBench::Subject subject{{node_address(options.node())}, options.motor()};
  if (how.target.is_emulated()) {
    if (subject.motor == nullptr) subject.motor = &motors().front();
  } else {
    subject.is_real = true;
  }
  if (options.first_problem()) return tl::unexpected{*options.first_problem()};
  auto rig = BusRig::open("morap", how, open_joint);
  if (!rig) return tl::unexpected{rig.error()};
  return std::make_unique<NodeBench>(*std::move(rig), subject);
}

}  // namespace armjig::morap
