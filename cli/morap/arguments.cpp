// SPDX-License-Identifier: Apache-2.0
#include "cli/morap/arguments.hpp"

#include "cli/checks.hpp"
#include "cli/choice.hpp"

namespace armjig::cli {

using namespace morap;
using namespace morap::drive;
using namespace morap::emulation;

TuneRequest TuneArguments::request() const {
  return {tune_kind(type).value_or(TuneKind::kPiSpeed), static_cast<float>(inertia),
          static_cast<float>(pole)};
}

TuneOptions add_tune_options(CLI::App& app, TuneArguments& arguments) {
  auto* type =
      app.add_option("--type", arguments.type, "pd or pid: position control, pi: speed control")
          ->type_name("TYPE")
          ->check(one_of({"pd", "pid", "pi"}));
  auto* inertia = app.add_option("--inertia", arguments.inertia,
                                 "of what hangs on the output shaft, kg m^2, up to 10")
                      ->type_name("J")
                      ->check(number(1e-5, kLargestInertia));
  auto* pole =
      app.add_option("--pole", arguments.pole, "of the closed loop, 1/s, -200 to 0: as in -9")
          ->type_name("W")
          ->check(number(-1e3, 1e3));
  return {type, inertia, pole};
}

void add_motor_option(CLI::App& app, std::string& motor) {
  app.add_option("--motor", motor, "of the joint: dcx22l with gear 231:1 or dcx26l with 149:1")
      ->type_name("NAME")
      ->check(one_of({std::string{kDcx22l.name}, std::string{kDcx26l.name}}))
      ->capture_default_str();
}

Eeprom eeprom_of(const std::string& motor) {
  return morap::emulation::eeprom_of(motor == kDcx26l.name ? kDcx26l : kDcx22l, 0);
}

}  // namespace armjig::cli
