// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/script.hpp"

#include <gtest/gtest.h>

namespace armjig::campaign {
namespace {

TEST(Script, OfAClientThatClosesHasOneThatStillHearsIfTheSystemTellsNoMore) {
  auto script = read_script(R"({"format":"golden-trace/1","device":"kinovazed","title":"t"}
{"t_ms":1,"dir":"to_device","conn":7,"text":"EStop\r\n"}
{"t_ms":2,"dir":"disconnect","conn":7,"text":"client-close"}
{"t_ms":3,"dir":"disconnect","conn":8,"text":"client-reset"}
)",
                            "a test")
                    .value();
  const auto before = script;
  for (auto& record : script) leave_half_open(record);
  EXPECT_EQ(script[0].bytes, before[0].bytes);
  EXPECT_EQ(words_of(script[1], nullptr), "disconnect client-half-close");
  EXPECT_EQ(script[1].time, before[1].time);
  EXPECT_EQ(script[2].details, before[2].details) << "a reset is heard of at once";
}

}  // namespace
}  // namespace armjig::campaign
