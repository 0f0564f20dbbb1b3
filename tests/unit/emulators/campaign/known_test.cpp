// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/known.hpp"

#include <gtest/gtest.h>

namespace armjig::campaign {
namespace {

const Symptom kSymptom{.asked = "command jog", .answer = "telemetry", .parts = {"timing", "io"}};

Known known_with(const std::string& symptom) {
  return Known::parse("[[known]]\nsymptom = \"" + symptom + "\"\nwhy = \"because\"\n", "test")
      .value();
}

TEST(Known, FindsASymptomInItsOwnWords) {
  EXPECT_EQ(kSymptom.key(), "after command jog: telemetry: timing, io");
  EXPECT_NE(known_with("after command jog: telemetry: timing, io").find(kSymptom), nullptr);
  EXPECT_EQ(known_with("after command jog: telemetry: timing").find(kSymptom), nullptr);
}

TEST(Known, TakesAStarForAnything) {
  EXPECT_NE(known_with("*telemetry: timing*").find(kSymptom), nullptr);
  EXPECT_NE(known_with("*").find(kSymptom), nullptr);
  EXPECT_EQ(known_with("*homed*").find(kSymptom), nullptr);
}

TEST(Known, SaysWhatTheModelIs) {
  EXPECT_EQ(Known::parse("model = \"profile=firmware\"\n", "test")->model, "profile=firmware");
}

TEST(Known, RefusesADefectWithoutAReason) {
  EXPECT_FALSE(Known::parse("[[known]]\nsymptom = \"x\"\n", "test"));
  EXPECT_FALSE(Known::parse("modell = \"\"\n", "test"));
}

}  // namespace
}  // namespace armjig::campaign
