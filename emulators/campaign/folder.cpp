// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/folder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "harness/files/user_file.hpp"
#include "harness/report/output_file.hpp"

namespace armjig::campaign {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr auto kFormat = "armjig-campaign/1";

double seconds_of(Duration time) { return std::chrono::duration<double>{time}.count(); }
Duration duration_in(const Json& json, const char* key) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>{json.value(key, 0.0)});
}

Outcome<void> write(const fs::path& path, std::string_view text) {
  return OutputFile::open(path.string()).and_then([&](const auto& file) {
    return file->put(text);
  });
}

Json to_json(const Finding& finding) {
  return {{"name", name_of(finding)},
          {"asked", finding.symptom.asked},
          {"answer", finding.symptom.answer},
          {"parts", finding.symptom.parts},
          {"expected", finding.symptom.expected},
          {"actual", finding.symptom.actual},
          {"sentence", finding.sentence},
          {"known", finding.known},
          {"case", finding.case_number},
          {"records_before", finding.found_size},
          {"records", finding.size},
          {"found_after_s", seconds_of(finding.found_after)},
          {"shows", finding.shows}};
}

/// Its script is in a file of its own.
Finding finding_in(const Json& json) {
  Finding finding;
  finding.symptom = {.asked = json.value("asked", ""),
                     .answer = json.value("answer", ""),
                     .parts = json.value("parts", std::vector<std::string>{}),
                     .expected = json.value("expected", ""),
                     .actual = json.value("actual", "")};
  finding.sentence = json.value("sentence", "");
  finding.known = json.value("known", "");
  finding.case_number = json.value("case", std::uint64_t{});
  finding.found_size = json.value("records_before", std::size_t{});
  finding.size = json.value("records", std::size_t{});
  finding.found_after = duration_in(json, "found_after_s");
  finding.shows = json.value("shows", std::vector<std::string>{});
  std::ranges::sort(finding.shows);
  return finding;
}

Outcome<Script> read_script_file(const fs::path& path) {
  return read_user_file(path.string()).and_then([&](const std::string& text) {
    return read_script(text, path.string());
  });
}

/// `JogTelemetryPositionJ1`.
std::string camel_of(std::string_view name) {
  std::string camel;
  bool is_first = true;
  for (const auto letter : name) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) {
      is_first = true;
      continue;
    }
    camel +=
        is_first ? static_cast<char>(std::toupper(static_cast<unsigned char>(letter))) : letter;
    is_first = false;
  }
  return camel;
}

/// Discarded if it is none.
Outcome<Json> json_of(const fs::path& path) {
  return read_user_file(path.string()).map([](const std::string& text) {
    return Json::parse(text, nullptr, /*allow_exceptions=*/false);
  });
}

}  // namespace

std::string name_of(const Finding& finding) {
  constexpr std::size_t kLongest = 80;
  std::string name;
  for (const auto letter : finding.symptom.key().substr(std::string_view{"after "}.size())) {
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0) {
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  name.resize(std::min(name.size(), kLongest));
  while (name.ends_with('-')) name.pop_back();
  return name;
}

std::string test_of(const Finding& finding, const CampaignFacts& facts) {
  return fmt::format(R"text(// {}.
TEST(FuzzFinding, {}) {{
  const auto recording = armjig::parse_trace("finding", R"jsonl({})jsonl");
  ASSERT_TRUE(recording);
  const auto device = armjig::cli::find_device(armjig::cli::shipped_devices(), "{}");
  ASSERT_TRUE(device);
  auto hosted = armjig::cli::emulate(std::get<armjig::cli::{}>((*device)->port), {{}}, "a test");
  ASSERT_TRUE(hosted);
  const auto port = armjig::open_in_memory(*std::move(hosted));
  const auto replayed = armjig::replay_on(*port, *recording);
  ASSERT_TRUE(replayed);
  EXPECT_FALSE(armjig::first_difference(replayed->recorded, replayed->actual));
}}
)text",
                     finding.sentence, camel_of(name_of(finding)),
                     to_recording(facts.recording, finding.script, finding.answers),
                     facts.recording.device, facts.port);
}

Outcome<Folder> Folder::open(const std::string& path, CampaignFacts facts) {
  Folder folder{path, std::move(facts)};
  for (const auto* const part : {"findings", "worthy"}) {
    std::error_code error;
    fs::create_directories(folder.path_ / part, error);
    if (error) return problem(ErrorCode::kCannotWrite, path, error.message());
  }
  return folder;
}

Outcome<CampaignState> Folder::load() const {
  const auto path = path_ / "campaign.json";
  if (!fs::exists(path)) return CampaignState{};
  const auto json = json_of(path);
  if (!json) return tl::unexpected{json.error()};
  const bool is_ours =
      json->is_object() && json->value("seed", Json{}) == facts_.seed &&
      json->value("shard", Json{}) == fmt::format("{}/{}", facts_.share.index, facts_.share.count);
  if (!is_ours) {
    return problem(ErrorCode::kBadValue, path.string(),
                   "it is of a campaign with another --seed or --shard; name another folder");
  }
  return load_any();
}

Outcome<CampaignState> Folder::load_any() const {
  const auto path = path_ / "campaign.json";
  const auto read = json_of(path);
  if (!read) return tl::unexpected{read.error()};
  const auto& json = *read;
  if (!json.is_object() || json.value("format", Json{}) != kFormat) {
    return problem(ErrorCode::kMalformed, path.string(), "armjig fuzz did not write it");
  }
  if (json.value("device", Json{}) != facts_.recording.device) {
    return problem(ErrorCode::kBadValue, path.string(), "it is of another device");
  }
  CampaignState state;
  try {
    state.cases = json.value("cases", std::uint64_t{});
    state.unsettled = json.value("unsettled", std::uint64_t{});
    state.last_unsettled = json.value("last_unsettled", "");
    state.refused = json.value("refused", std::uint64_t{});
    state.last_refusal = json.value("last_refusal", "");
    state.passed = duration_in(json, "seconds");
    for (const auto& one : json.value("findings", Json::array())) {
      state.findings.push_back(finding_in(one));
    }
  } catch (const Json::exception&) {
    return problem(ErrorCode::kMalformed, path.string(), "a value in there is of a wrong type");
  }
  for (auto& finding : state.findings) {
    auto script = read_script_file(path_of(finding));
    if (!script) return tl::unexpected{script.error()};
    finding.script = *std::move(script);
  }
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator{path_ / "worthy"}) files.insert(entry.path());
  for (const auto& file : files) {
    auto script = read_script_file(file);
    if (!script) return tl::unexpected{script.error()};
    state.worthy.push_back(*std::move(script));
  }
  return state;
}

Outcome<void> Folder::keep(const CampaignState& state) const {
  Json json{{"format", kFormat},
            {"device", facts_.recording.device},
            {"seed", facts_.seed},
            {"shard", fmt::format("{}/{}", facts_.share.index, facts_.share.count)},
            {"cases", state.cases},
            {"seconds", seconds_of(state.passed)},
            {"states", state.shown.states()},
            {"transitions", state.shown.transitions()},
            {"answers", state.shown.answers()},
            {"refused", state.refused},
            {"last_refusal", state.last_refusal},
            {"unsettled", state.unsettled},
            {"last_unsettled", state.last_unsettled},
            {"findings", Json::array()}};
  for (const auto& finding : state.findings) json["findings"].push_back(to_json(finding));
  return write(path_ / "campaign.json",
               json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

std::string Folder::path_of(const Finding& finding) const {
  return (path_ / "findings" / (name_of(finding) + ".jsonl")).string();
}

Outcome<void> Folder::keep(const Finding& finding) const {
  auto path = fs::path{path_of(finding)};
  return write(path, to_recording(facts_.recording, finding.script, finding.answers))
      .and_then([&] { return write(path.replace_extension(".txt"), finding.sentence + ".\n"); })
      .and_then([&] { return write(path.replace_extension(".cpp"), test_of(finding, facts_)); });
}

Outcome<void> Folder::keep_worthy(const Script& script, std::uint64_t case_number) const {
  // What the device said is not needed; transactions and connections are written as what came.
  return write(path_ / "worthy" / fmt::format("{:08}.jsonl", case_number),
               to_recording(facts_.recording, {}, script));
}

CampaignState merged(std::vector<CampaignState> states) {
  CampaignState all;
  std::set<std::string> names;
  for (auto& state : states) {
    all.cases += state.cases;
    all.unsettled += state.unsettled;
    all.refused += state.refused;
    all.passed += state.passed;
    if (!state.last_unsettled.empty()) all.last_unsettled = std::move(state.last_unsettled);
    if (!state.last_refusal.empty()) all.last_refusal = std::move(state.last_refusal);
    std::ranges::move(state.worthy, std::back_inserter(all.worthy));
    for (auto& finding : state.findings) {
      if (names.insert(name_of(finding)).second) all.findings.push_back(std::move(finding));
    }
  }
  return all;
}

}  // namespace armjig::campaign
