// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/host/check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "harness/core/hex.hpp"

namespace armjig::morap::programs {
namespace {

using namespace std::chrono_literals;

/// Transactions 50 ms apart, or as many ms as stand in front of an `@`; odd first bytes are reads.
std::set<std::string> offences_of(const std::vector<std::string>& transactions) {
  const auto checker = program_check().make({});
  Instant time{};
  for (const auto& line : transactions) {
    const auto mark = line.find('@');
    const bool has_time = mark != std::string::npos;
    time += has_time ? std::chrono::milliseconds{std::stoi(line)} : 50ms;
    const auto bytes = *from_hex(has_time ? line.substr(mark + 1) : line);
    const bool is_read = (bytes[0] & std::byte{1}) != std::byte{0};
    is_read ? checker->from_device(time, bytes) : checker->to_device(time, bytes);
  }
  checker->finish(time);
  std::set<std::string> names;
  for (const auto& offence : checker->take_offences()) {
    EXPECT_TRUE(checker->had_occasion(
        *std::ranges::find(host_requirements(), offence.requirement, &Requirement::id)))
        << offence.requirement;
    names.insert(std::string{offence.requirement}.substr(std::string{"morap.host."}.size()));
  }
  return names;
}

/// Node 1: calibrated, driven, disabled.
std::vector<std::string> session(const std::string& inside) {
  return {"22 00", "22 10", inside, "22 1F"};
}

const std::string kGood = "20 00 C8 00 01 00 00 20 41 01 00 00 20 41 01 00 00 00 00 00 00 00 00 71";

TEST(MorapHostChecker, FindsNothingInSoundSessions) {
  EXPECT_THAT(offences_of({"22 00", "22 10", "22 01 F9 0F C9 3F", "22 80", "23 00 00 00 00",
                           "22 1F", "32 02", "32 01", "32 07 80"}),
              testing::IsEmpty());
  EXPECT_THAT(offences_of({"22 21", "22 " + kGood, "22 84", "23 02", "22 8A",
                           "23 00 C8 00 01 00 00 20 41", "22 10", "22 01 00 00 00 00", "22 00"}),
              testing::IsEmpty());
  EXPECT_THAT(offences_of({"D0 6B 80", "D1 00 00", "22"}), testing::IsEmpty());
}

TEST(MorapHostChecker, KnowsWhatAMasterDidNotTry) {
  const auto checker = program_check().make({});
  checker->to_device(at(0ms), *from_hex("22 00"));
  for (const auto& requirement : host_requirements()) {
    const bool is_of_nodes = requirement.occasion == "a message to a node";
    EXPECT_EQ(checker->had_occasion(requirement), is_of_nodes) << requirement.id;
  }
}

struct Row {
  const char* name;
  std::vector<std::string> transactions;
};

TEST(MorapHostChecker, FindsEachOffenceByItself) {
  const std::vector<Row> rows{
      {"addresses", {"30 83"}},
      {"known-ids", {"22 06"}},
      {"whole-command", {"22 01 00 00"}},
      {"overlong-number", session("22 01 00 00 00 00 00")},
      {"surplus", {"22 00 00"}},
      {"no-brake", {"22 0E"}},
      {"no-direct-voltage", session("22 04 00 00 00 00")},
      {"finite", session("22 01 00 00 C0 7F")},
      {"voltage", session("22 03 00 00 C0 41")},
      {"calibrates-first", {"22 01 00 00 00 00", "22 00"}},
      {"calibrates-disabled", {"22 10", "22 01 00 00 00 00", "22 10", "22 00"}},
      {"ends-disabled", {"22 10", "22 01 00 00 00 00"}},
      {"checksum", {"22 " + kGood.substr(0, kGood.size() - 1) + "2"}},
      {"counts", {"22 20 00 C8 00 00 00 00 00 00 00 00 37"}},
      {"kind", {"22 20 02" + kGood.substr(5, kGood.size() - 7) + "6F"}},
      {"rate", {"22 20 00 00 00 01 00 00 20 41 01 00 00 20 41 01 00 00 00 00 00 00 00 00 3A"}},
      {"coefficients",
       {"22 20 00 C8 00 01 00 00 C0 7F 01 00 00 20 41 01 00 00 00 00 00 00 00 00 92"}},
      {"program-pause", {"22 21", "5@22 " + kGood, "22 84", "23 02"}},
      {"program-status", {"22 10", "22 " + kGood, "22 01 00 00 00 00", "22 00"}},
      {"tune-kind", {"22 22 03 CD CC 4C 3E 00 00 10 C1"}},
      {"tune-inertia", {"22 22 00 00 00 30 41 00 00 10 C1"}},
      {"tune-pole", {"22 22 00 CD CC 4C 3E 00 00 80 3F"}},
      {"read-size", {"22 83", "23 03 03"}},
      {"pen-commands", {"32 09"}},
      {"pen-surplus", {"32 01 00"}},
      {"pen-pause", {"32 01", "10@32 02"}},
      {"pen-read", {"33 00"}},
  };
  std::set<std::string> tried;
  for (const auto& [name, transactions] : rows) {
    EXPECT_THAT(offences_of(transactions), testing::ElementsAre(name)) << name;
    tried.insert(std::string{"morap.host."} + name);
  }
  for (const auto& requirement : host_requirements()) {
    EXPECT_TRUE(tried.contains(std::string{requirement.id})) << requirement.id;
  }
}

}  // namespace
}  // namespace armjig::morap::programs
