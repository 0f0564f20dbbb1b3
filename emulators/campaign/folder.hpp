// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emulators/campaign/campaign.hpp"

namespace armjig::campaign {

/// Whose campaign a folder has.
struct CampaignFacts {
  RecordingFacts recording;  ///< of each finding: device, model, who found it
  std::string port;          ///< the entry's kind of port, as C++ calls it: `OnStream`
  std::uint64_t seed = 1;
  Share share{};
};

/// What a campaign leaves: `campaign.json` with how far it is, `findings/` with a recording, a
/// sentence and a test for each, `worthy/` with the scripts that showed something new. It is whole
/// after each call, so that a campaign can go on after any end.
class Folder {
 public:
  /// Makes what is missing. Problems: `kCannotWrite`.
  [[nodiscard]] static Outcome<Folder> open(const std::string& path, CampaignFacts facts);

  /// What is there already; nothing in a new one. Problems: `kBadValue` if it is another device's,
  /// or of another seed or share; `kMalformed`, `kCannotRead`.
  [[nodiscard]] Outcome<CampaignState> load() const;
  /// The same of any campaign of the device.
  [[nodiscard]] Outcome<CampaignState> load_any() const;

  // Problems: `kCannotWrite`.
  [[nodiscard]] Outcome<void> keep(const CampaignState& state) const;
  [[nodiscard]] Outcome<void> keep(const Finding& finding) const;
  [[nodiscard]] Outcome<void> keep_worthy(const Script& script, std::uint64_t case_number) const;

  /// The recording of a finding.
  [[nodiscard]] std::string path_of(const Finding& finding) const;

 private:
  Folder(std::filesystem::path path, CampaignFacts facts)
      : path_{std::move(path)}, facts_{std::move(facts)} {}

  std::filesystem::path path_;
  CampaignFacts facts_;
};

/// A name for files and reports, from what its symptom is: letters, digits and hyphens.
[[nodiscard]] std::string name_of(const Finding& finding);

/// A test for GoogleTest that shows the finding on the emulated device, ready to paste.
[[nodiscard]] std::string test_of(const Finding& finding, const CampaignFacts& facts);

/// What several found together, each defect once, with the scripts of all.
[[nodiscard]] CampaignState merged(std::vector<CampaignState> states);

}  // namespace armjig::campaign
