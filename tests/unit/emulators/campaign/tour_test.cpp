// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/tour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/unit/emulators/campaign/live_material.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

constexpr Duration kLongest = 60s;

std::string text_of(const KeptRecord& record) {
  std::string text;
  for (const auto byte : record.bytes) text.push_back(static_cast<char>(byte));
  return text;
}

/// Through the states of a server.
class TourOfAServer : public testing::Test {
 protected:
  std::vector<Script> parts() {
    std::vector<Script> all;
    for (auto part = tour_.next(kLongest); !part.empty(); part = tour_.next(kLongest)) {
      all.push_back(part);
    }
    return all;
  }

  /// The verbs that are sent while a sound server initialises its arm.
  std::set<std::string> verbs_in_the_middle(const std::vector<Script>& parts) const {
    std::set<std::string> verbs;
    for (const auto& part : parts) {
      auto all = part;
      std::ranges::copy(material_.rehearse(part), std::back_inserter(all));
      std::ranges::stable_sort(all, {}, &KeptRecord::time);
      std::string verb;
      bool is_initialising = false;
      for (const auto& record : all) {
        const auto text = text_of(record);
        if (is_sent(record)) {
          verb = text.substr(0, text.find_first_of(":\r"));
          if (is_initialising) verbs.insert(verb);
          is_initialising = is_initialising && verb != "EStop";
        }
        if (text.starts_with("Accepted") && verb == "Initialize") is_initialising = true;
        if (text.find("Initialized") != std::string::npos) is_initialising = false;
      }
    }
    return verbs;
  }

  Material material_ = live_material("kinovazed", "tcp:127.0.0.1:1");
  Repertoire repertoire_{material_, 1};
  Tour tour_{material_, repertoire_};
};

TEST_F(TourOfAServer, ComesToWhatTakesTimeToComeTo) {
  std::set<std::string> said;
  for (const auto& part : parts()) {
    EXPECT_LE(length_of(part), kLongest + 2s);
    for (const auto& record : material_.rehearse(part)) said.insert(text_of(record));
  }
  for (const auto* const event : {"Initialized", "JoystickModeSet", "ObjectiveDone", "Retracted",
                                  "Unfolded", "Freezed", "Unfreezed"}) {
    EXPECT_TRUE(said.contains(std::string{event} + "\r\n")) << event;
  }
}

TEST_F(TourOfAServer, IsInTheMiddleOfThingsOnlyWhereItGoesDeeper) {
  EXPECT_EQ(verbs_in_the_middle(parts()), std::set<std::string>{});
  tour_.go_deeper();
  const auto verbs = verbs_in_the_middle(parts());
  for (const auto* const verb : {"EStop", "Freeze", "RunObjective", "Retract", "MoveJoystick"}) {
    EXPECT_TRUE(verbs.contains(verb)) << verb;
  }
}

TEST_F(TourOfAServer, LeadsToWhereAMessageIsAnsweredOtherwise) {
  (void)parts();
  const auto seldom = tour_.where_seldom_answered();
  const auto moving = std::ranges::find_if(seldom, [](const Setting& setting) {
    return text_of(setting.exchange.front()).starts_with("MoveJoystick:");
  });
  ASSERT_NE(moving, seldom.end());
  auto script = joined(moving->before, moving->exchange, moving->rest);
  const auto sent_at = Instant{length_of(script)};
  add(script, border("disconnect", 0, "client-close"), 50ms);
  const auto said = material_.rehearse(script);
  EXPECT_TRUE(std::ranges::any_of(said, [&](const KeptRecord& record) {
    return record.time >= sent_at && text_of(record) == "Accepted\r\n";
  }));
}

TEST(Tour, IsOfServersAlone) {
  const auto material = live_material("parol6", "pty:/tmp/nowhere");
  const Repertoire repertoire{material, 1};
  EXPECT_TRUE((Tour{material, repertoire}.next(kLongest).empty()));
}

}  // namespace
}  // namespace armjig::campaign
