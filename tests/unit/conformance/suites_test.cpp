// SPDX-License-Identifier: Apache-2.0
// All suites: what their catalogues promise, and that they hold against the emulated devices.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/reference.hpp"
#include "conformance/parol6/suite.hpp"
#include "conformance/run.hpp"
#include "conformance/selection.hpp"
#include "conformance/suite.hpp"
#include "harness/link/impairment.hpp"
#include "tests/unit/support/suites.hpp"
#include "tests/within_reach/within_reach.hpp"

namespace armjig {
namespace {

using test::demo_suite;
using test::parol6_suite;

Report run(const test::TestedSuite& device, const std::string& target, RunOptions options = {}) {
  const auto bench = device.bench(target);
  options.permissions = Permissions::all();
  return run_suite(device.suite, *bench, options, [](const ReportRow&) {});
}

std::vector<std::string> but_for(const Report& report, Verdict verdict) {
  std::vector<std::string> rows;
  for (const auto& row : report.rows) {
    if (row.verdict != verdict) rows.push_back(to_text(row));
  }
  return rows;
}

TEST(Suites, HaveUniqueNamesAndACaseForEachRequirementOrAReason) {
  for (const auto& [suite, mutants, open] : test::all_suites()) {
    std::set<std::string> ids;
    std::set<std::string> texts;
    std::set<std::string> cases;
    std::set<std::string> checked;
    for (const auto& chapter : suite.chapters) {
      for (const auto& one : chapter.cases) {
        EXPECT_TRUE(cases.insert(name_of(one)).second) << name_of(one);
        ASSERT_NE(find_requirement(suite, one.requirement), nullptr) << one.requirement;
        EXPECT_LT(one.start, suite.starts.size()) << name_of(one);
        checked.emplace(one.requirement);
      }
      for (const auto& requirement : chapter.requirements) {
        EXPECT_TRUE(ids.emplace(requirement.id).second) << requirement.id;
        EXPECT_TRUE(texts.emplace(requirement.text).second) << requirement.text;
      }
    }
    for (const auto& chapter : suite.chapters) {
      for (const auto& requirement : chapter.requirements) {
        if (requirement.role == Role::kHost) continue;
        EXPECT_EQ(checked.contains(std::string{requirement.id}), requirement.unobservable.empty())
            << requirement.id;
      }
    }
  }
}

/// The messages of all of that name, if there are any.
bool has_aspect(const Dissection& dissection, const Subject& subject) {
  constexpr std::string_view kOfAll[] = {"message", "time", "note", "bytes"};
  const bool is_of_all = std::ranges::count(kOfAll, subject.aspect) > 0;
  return std::ranges::any_of(dissection.messages, [&](const MessageKind& kind) {
    const bool is_it = subject.message.empty() || kind.name == subject.message;
    return is_it && (is_of_all || std::ranges::any_of(kind.fields, [&](const Field& field) {
                       return field.name == subject.aspect ||
                              field.name.starts_with(std::string{subject.aspect} + '.');
                     }));
  });
}

TEST(Suites, SpeakOfMessagesAndFieldsThatThereAre) {
  for (const auto& device : cli::shipped_devices()) {
    const auto suite = device.suite();
    if (device.name != "demo") {
      EXPECT_FALSE(suite.subjects.empty()) << device.name;
    }
    for (const auto& subject : suite.subjects) {
      EXPECT_NE(find_requirement(suite, subject.requirement), nullptr) << subject.requirement;
      EXPECT_TRUE(has_aspect(device.dissection(), subject))
          << device.name << ": " << subject.message << ' ' << subject.aspect;
    }
  }
}

TEST(Suites, KnowTheRequirementThatSpeaksOfAField) {
  const auto suite = parol6_suite().suite;
  const auto id_of = [&](std::string_view message, std::string_view aspect) {
    const auto* const found = find_requirement_about(suite, message, aspect);
    return found == nullptr ? std::string_view{} : found->id;
  };
  EXPECT_EQ(id_of("telemetry", "timing"), "parol6.telemetry.timing");
  EXPECT_EQ(id_of("telemetry", "position.j3"), "parol6.telemetry.position-own-joint");
  EXPECT_EQ(id_of("telemetry", "gripper.current"), "parol6.gripper.latest");
  EXPECT_EQ(id_of("telemetry", "gripper.id"), "parol6.telemetry.gripper-id");
  EXPECT_EQ(id_of("telemetry", "iodine"), "");
  EXPECT_EQ(id_of("command", "position.j3"), "");
}

TEST(Suites, SayForDifferencesWhatTheOtherProfileHasInstead) {
  for (const auto& [suite, mutants, open] : test::all_suites()) {
    for (const auto& chapter : suite.chapters) {
      for (const auto& requirement : chapter.requirements) {
        if (requirement.profiles == Profiles::kDocumented) {
          EXPECT_FALSE(requirement.instead.empty()) << requirement.id;
        }
        if (requirement.instead.empty()) continue;
        const auto* other = find_requirement(suite, requirement.instead);
        ASSERT_NE(other, nullptr) << requirement.id;
        EXPECT_NE(other->profiles, Profiles::kBoth) << requirement.id;
        EXPECT_NE(other->profiles, requirement.profiles) << requirement.id;
      }
    }
  }
}

std::size_t count(const Suite& suite, Role role) {
  std::size_t count = 0;
  for (const auto& chapter : suite.chapters) {
    count += static_cast<std::size_t>(
        std::ranges::count_if(chapter.requirements, [&](const Requirement& requirement) {
          return requirement.role == role && requirement.unobservable.empty();
        }));
  }
  return count;
}

TEST(Parol6Suite, HasAtLeast150RequirementsForTheDeviceAnd25ForTheHost) {
  EXPECT_GE(count(parol6::conformance::suite(), Role::kDevice), 150U);
  EXPECT_GE(count(parol6::conformance::suite(), Role::kHost), 25U);
}

TEST(Parol6Suite, PassesOnTheEmulatedFirmware) {
  EXPECT_THAT(but_for(run(parol6_suite(), "emulated:"), Verdict::kPass), testing::IsEmpty());
}

TEST(Parol6Suite, PassesOnTheFirmwareWithALongerLoop) {
  for (const auto* target : {"emulated:?pass-us=50", "emulated:?pass-us=250"}) {
    EXPECT_THAT(but_for(run(parol6_suite(), target), Verdict::kPass), testing::IsEmpty()) << target;
  }
}

TEST(Parol6Suite, PassesOnTheDocumentedBoard) {
  EXPECT_THAT(but_for(run(parol6_suite(), "emulated:?profile=documented",
                          {.profile = Profile::kDocumented}),
                      Verdict::kPass),
              testing::IsEmpty());
}

TEST(Parol6Suite, FindsExactlyTheMappedDeviationsOfTheFirmwareFromTheDocument) {
  const auto report = run(parol6_suite(), "emulated:", {.profile = Profile::kDocumented});
  for (const auto& row : report.rows) {
    const auto& requirement = *find_requirement(parol6::conformance::suite(), row.requirement);
    const auto wanted =
        requirement.profiles == Profiles::kDocumented ? Verdict::kDeviation : Verdict::kPass;
    EXPECT_EQ(row.verdict, wanted) << to_text(row);
  }
}

/// Runs every case of the suite once, in a random order, on one and the same device.
std::vector<std::string> findings_in_any_order(const test::TestedSuite& device,
                                               std::uint32_t seed) {
  auto cases = select(device.suite, Profile::kFirmware, {});
  std::ranges::shuffle(cases, std::mt19937{seed});
  const auto bench = device.bench("emulated:");
  std::vector<std::string> findings;
  for (const auto* one : cases) {
    bench->begin(Profile::kFirmware, seed);
    bench->bring_to(one->start);
    if (!bench->is_over()) one->run(*bench);
    const auto& judgement = bench->judgement();
    if (judgement.verdict == Verdict::kPass) continue;
    findings.push_back(name_of(*one) + ": " + judgement.expected + ", but " + judgement.actual);
  }
  return findings;
}

// Filters, shards and repetitions all change what ran before a case.
TEST(Parol6Suite, FindsTheSameInWhateverOrderItsCasesRun) {
  for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
    EXPECT_THAT(findings_in_any_order(parol6_suite(), seed), testing::IsEmpty());
  }
}

TEST(Parol6Suite, GivesTheSameReportForTheSameSeed) {
  const auto once = to_json(run(parol6_suite(), "emulated:", {.seed = 3}));
  EXPECT_EQ(once, to_json(run(parol6_suite(), "emulated:", {.seed = 3})));
}

bool is_accusation(Verdict verdict) {
  return verdict == Verdict::kFail || verdict == Verdict::kFlaky || verdict == Verdict::kError;
}

/// What a sound device is accused of on a link that is bad in that way.
std::vector<std::string> accusations(const cli::Device& device, const std::string& impairment) {
  RigOptions how;
  how.target = parse_target("emulated:").value();
  how.impairment = parse_impairment(impairment).value();
  RunOptions options;
  options.permissions = Permissions::all();
  options.required_share = 0;  // such a link may leave little to judge
  options.reference = cli::reference_of(device, how, "firmware");
  const auto bench = cli::open_bench(device, how).value();
  const auto report = run_suite(device.suite(), *bench, options, [](const ReportRow&) {});
  std::vector<std::string> rows;
  for (const auto& row : report.rows) {
    if (is_accusation(row.verdict)) {
      rows.push_back(impairment + ": " + to_text(row));
    }
  }
  return rows;
}

TEST(Suites, AccuseNoSoundDeviceOnALinkThatDelays) {
  for (const auto& device : cli::shipped_devices()) {
    for (const auto* law : {"delay=5ms", "delay=uniform(0ms,1ms)", "delay=uniform(0ms,20ms)",
                            "in.delay=exponential(3ms)", "out.delay=normal(10ms,5ms)"}) {
      EXPECT_THAT(accusations(device, law), testing::IsEmpty()) << device.name;
    }
  }
}

/// What a sound device is accused of that is reached as over a link, with somebody beside it.
std::vector<std::string> accusations_within_reach(const cli::Device& device,
                                                  const std::string& options) {
  const auto target = *parse_target("emulated:?profile=firmware" + options);
  const auto bench = test::bench_within_reach(device, target, [](auto) { return true; });
  RunOptions run;
  run.permissions = Permissions::all();
  run.required_share = 0;
  const auto report = run_suite(device.suite(), **bench, run, [](const ReportRow&) {});
  std::vector<std::string> rows;
  for (const auto& row : report.rows) {
    if (is_accusation(row.verdict)) {
      rows.push_back(fmt::format("{}{}: {}: {}, but {}", device.name, options, row.name,
                                 row.expected, row.actual));
    }
  }
  return rows;
}

TEST(Suites, AccuseNoSoundDeviceThatIsGuardedAndHasSomebodyBesideIt) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> sound{
      {"parol6", {"", "&pass-us=10", "&pass-us=250"}},
      {"kinovazed", {"", "&plant=bench", "&call-us=19000"}},
      {"morap", {"", "&pen=yes", "&nodes=1"}}};
  for (const auto& [device, variants] : sound) {
    for (const auto& options : variants) {
      EXPECT_THAT(accusations_within_reach(test::device(device), options), testing::IsEmpty());
    }
  }
}

TEST(DemoSuite, PassesOnTheEmulatedDevice) {
  EXPECT_THAT(but_for(run(demo_suite(), "emulated:"), Verdict::kPass), testing::IsEmpty());
}

}  // namespace
}  // namespace armjig
