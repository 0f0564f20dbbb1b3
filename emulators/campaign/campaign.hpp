// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "emulators/campaign/author.hpp"
#include "emulators/campaign/known.hpp"
#include "emulators/campaign/stage.hpp"
#include "emulators/campaign/symptom.hpp"
#include "emulators/campaign/talk.hpp"

namespace armjig::campaign {

/// A part of a campaign that several share.
struct Share {
  std::uint32_t index = 1;  ///< from 1
  std::uint32_t count = 1;
};

/// When cases come from a survey of all that is known, and not by chance.
enum class WhenSurvey : std::uint8_t {
  kNever,
  kInTurn,  ///< every other one: each finds soon what the other finds late
  kFirst,   ///< where time is dear
};

struct CampaignOptions {
  std::uint64_t seed = 1;
  Share share{};
  std::uint64_t first_case = 0;  ///< where one goes on that was ended
  std::uint64_t most_cases{};    ///< to be played now
  Judging judging{};
  Excuses excuses{};  ///< what is no news from the beginning
  Known known{};
  /// At least 1; where resetting makes the target new. Elsewhere so many of the last cases are
  /// played again with one that shows something.
  std::size_t cases_between_resets = 1;
  int confirmations = 1;  ///< so often a symptom has to come again, before and after shrinking
  /// So often, each time that a symptom has come again, a sound device in the place of a live
  /// target must not show it.
  int doubts = 0;
  std::size_t most_attempts = 20'000;  ///< at shrinking one finding
  Duration most_shrinking{};           ///< time for one finding, by the wall clock
  bool stops_at_first = false;         ///< finding that is news
  WhenSurvey when_survey{};
  std::function<bool()> must_stop = [] { return false; };
};

/// A defect, as short as it became.
struct Finding {
  Symptom symptom;
  std::string sentence;             ///< after X, Y is answered with Z
  Script script;                    ///< shows it on a fresh device
  std::vector<KeptRecord> answers;  ///< what is right: the model's; or, without one, what came
  std::string known{};              ///< why it is no news; empty: it is
  std::uint64_t case_number{};      ///< in which it was seen first
  std::uint64_t times = 1;          ///< how often it was seen, as far as it was not excused
  std::size_t found_size{};         ///< records of the case before shrinking
  std::size_t size{};               ///< and after it, without the question at the end
  Duration found_after{};           ///< by the wall clock, since the campaign began
  /// All that differs when `script` is played, as `Symptom::ways`, sorted; empty if it is not
  /// short.
  std::vector<std::string> shows{};
};

/// How far a campaign is.
struct CampaignState {
  std::uint64_t cases{};
  std::uint64_t unsettled{};     ///< symptoms that did not come again, or come of the link
  std::string last_unsettled{};  ///< one of them
  /// In what a device that nobody can start again was not like a new one when the campaign began,
  /// or has stayed different since a case; nothing is said of that.
  std::vector<std::string> passed_over{};
  std::uint64_t refused{};     ///< cases that the guard ended
  std::string last_refusal{};  ///< why it ended the last of them
  Duration passed{};           ///< by the wall clock
  Shown shown{};
  std::vector<Script> worthy{};  ///< scripts that showed something new
  std::vector<Finding> findings{};
  std::size_t causes{};  ///< of these findings
};

/// Told after each case, and of each finding, the last one then, and worthy script when it is
/// there; each may be empty.
struct CampaignListener {
  std::function<void(const CampaignState&)> on_case;
  std::function<void(const CampaignState&)> on_finding;
  std::function<void(const Script&, std::uint64_t case_number)> on_worthy;
};

/// Plays cases until there were enough or it must stop. Each is drawn from its seed, ends with a
/// harmless question, and is judged by what both sides said. `state` may have scripts and findings
/// of before. Problems: those of the stage.
[[nodiscard]] Outcome<void> run_campaign(Stage& stage, const Material& material,
                                         const CampaignOptions& options, CampaignState& state,
                                         const CampaignListener& listener);

}  // namespace armjig::campaign
