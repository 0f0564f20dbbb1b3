// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/chapters.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr Requirement documented(std::string_view id, std::string_view text,
                                 std::string_view source, std::string_view instead) {
  return {id, Level::kMust, text, source, Profiles::kDocumented, instead};
}

/// Where the document is silent and we had to choose.
constexpr Requirement chosen(std::string_view id, std::string_view text, std::string_view source,
                             std::string_view instead) {
  return {id, Level::kShould, text, source, Profiles::kDocumented, instead};
}

constexpr Requirement kRequirements[] = {
    chosen("morap.documented.other-kind",
           "A message of another kind than 0 and 1 makes the programming status 3.",
           "reference, contradiction 12", "morap.program.other-kind"),
    chosen("morap.documented.zero-rate",
           "A message with a rate of 0 makes the programming status 3.",
           "reference, contradiction 13", "morap.program.zero-rate"),
    documented("morap.documented.zero-pole", "A tuning message with a pole of 0 is refused.",
               "document: poles are negative; reference, contradiction 15", "morap.tune.zero-pole"),
    chosen("morap.documented.no-inertia", "A tuning message without inertia is refused.",
           "reference, contradiction 15", "morap.tune.no-inertia"),
    chosen("morap.documented.direct-voltage", "Identifier 4 does nothing.",
           "document: not listed; reference, contradiction 2", "morap.direct.no-current-limit"),
    chosen("morap.documented.torque", "Identifier 5 does nothing.",
           "document: not listed; reference, contradiction 2", "morap.status.enabled-by-torque"),
    chosen("morap.documented.position-set", "Identifier 138 chooses nothing.",
           "document: not listed; reference, contradiction 2", "morap.read.position-default"),
    chosen("morap.documented.speed-set", "Identifier 139 chooses nothing.",
           "document: not listed; reference, contradiction 2", "morap.read.speed-default"),
    documented("morap.documented.brake", "Identifier 15 shorts the leads of a disabled motor.",
               "document, brake; reference, contradiction 1", "morap.brake.no-effect"),
};

}  // namespace

std::span<const Requirement> documented_requirements() noexcept { return kRequirements; }

}  // namespace armjig::morap::conformance
