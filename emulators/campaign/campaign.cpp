// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/campaign.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "emulators/campaign/cause.hpp"
#include "emulators/campaign/shrink.hpp"
#include "emulators/campaign/siblings.hpp"
#include "emulators/campaign/survey.hpp"
#include "harness/compare/recording_diff.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;
using WallClock = std::chrono::steady_clock;

/// Before the question whether the device is well.
constexpr Duration kPause = 20ms;
/// So many findings about one part of an answer are enough; more are the same seen elsewhere.
constexpr int kMostOfOnePart = 3;

/// A seed of its own for each case of each share (splitmix64).
std::uint64_t seed_of(const CampaignOptions& options, std::uint64_t number) {
  auto mixed = options.seed +
               (number * options.share.count + options.share.index) * 0x9E37'79B9'7F4A'7C15ULL;
  mixed = (mixed ^ mixed >> 30U) * 0xBF58'476D'1CE4'E5B9ULL;
  mixed = (mixed ^ mixed >> 27U) * 0x94D0'49BB'1331'11EBULL;
  return mixed ^ mixed >> 31U;
}

/// What became of a whole message.
bool is_of(const Symptom& symptom, Change change) {
  return std::ranges::find(symptom.parts, to_string(change)) != symptom.parts.end();
}

/// Of answers that differ in much, one is told as missing or as one too many here, as changed
/// there.
bool is_vague(const Symptom& symptom) {
  return is_of(symptom, Change::kMissing) || is_of(symptom, Change::kExtra);
}

/// Two that are vague are taken for the same: which message is one too many, and of which kind one
/// is missing, depends on which others they come beside.
bool is_same(const Symptom& one, const Symptom& other) {
  if (is_vague(one) && is_vague(other)) return true;
  return one.answer == other.answer &&
         (is_vague(one) || is_vague(other) ||
          std::ranges::find_first_of(one.parts, other.parts) != one.parts.end());
}

std::string sentence_of(const Symptom& symptom, const Script& script, const Script& harmless,
                        MakeDissector make_dissector) {
  constexpr std::size_t kMostWords = 4;
  std::vector<std::string> words;
  const auto own = script.size() - std::min(script.size(), harmless.size());
  for (std::size_t i = 0; i < own && script[i].time <= symptom.time; ++i) {
    auto one = words_of(script[i], make_dissector);
    if (words.empty() || words.back() != one) words.push_back(std::move(one));
  }
  if (words.size() > kMostWords) {
    words.erase(words.begin() + 1, words.end() - (kMostWords - 1));
    words.insert(words.begin() + 1, "...");
  }
  const auto before =
      words.empty() ? std::string{} : fmt::format("after {}, ", fmt::join(words, ", "));
  return fmt::format("{}{} is answered with {}: {}{}", before, symptom.asked, symptom.answer,
                     symptom.actual,
                     symptom.expected.empty() ? "" : " instead of " + symptom.expected);
}

class Campaign {
 public:
  Campaign(Stage& stage, const Material& material, const CampaignOptions& options,
           CampaignState& state, const CampaignListener& listener)
      : stage_{stage},
        material_{material},
        options_{options},
        state_{state},
        listener_{listener},
        author_{material},
        excuses_{options.excuses},
        judging_astray_{judging_astray(material, options.judging)} {
    if (options.when_survey != WhenSurvey::kNever) survey_.emplace(material, options.seed);
    if (survey_ && can_go_astray()) {
      survey_->put_last([this](const Script& script) { return goes_astray(script); });
    }
    for (const auto& finding : state.findings) excuse(finding);
    state_.causes = causes_of(state_.findings).size();
  }

  [[nodiscard]] Outcome<void> run() {
    if (auto begun = begin(); !begun) return begun;
    const auto end = options_.first_case + options_.most_cases;
    for (auto number = options_.first_case; number < end && !options_.must_stop(); ++number) {
      const auto script = script_of(number);
      if (stage_.can_reset() && begins_anew(script)) {
        if (auto begun = start_again(); !begun) return begun;
      }
      if (auto done = play_case(script, number); !done) return done;
      state_.passed = passed_before_ + since_begin();
      if (listener_.on_case) listener_.on_case(state_);
      if (options_.stops_at_first && has_news()) return {};
    }
    return {};
  }

 private:
  struct Seen {
    BothHeard heard;
    std::optional<Symptom> symptom;
  };

  /// What takes so long goes through states, from where a new device is.
  [[nodiscard]] bool begins_anew(const Script& script) const {
    const auto before = history_.size();
    return before >= options_.cases_between_resets ||
           (before > 0 && length_of(script) > 2 * material_.longest);
  }

  [[nodiscard]] bool has_news() const {
    return std::ranges::any_of(state_.findings,
                               [](const Finding& finding) { return finding.known.empty(); });
  }

  /// What scripts of before have shown is no news.
  [[nodiscard]] Outcome<void> begin() {
    if (auto begun = start_again(); !begun) return begun;
    for (const auto& script : state_.worthy) {
      if (options_.must_stop()) break;
      const auto seen = see(script);
      if (seen) (void)state_.shown.add(messages_in(*seen));
      if (auto begun = stage_.reset(); !begun) return begun;
    }
    return {};
  }

  [[nodiscard]] Outcome<void> start_again() { return start_again({}); }
  [[nodiscard]] Outcome<void> start_again(const Script& questions) {
    history_.clear();
    if (auto begun = stage_.reset(); !begun) return begun;
    return stage_.can_reset() ? Outcome<void>{} : meet(questions);
  }

  /// A device that nobody can start again is where it is. Of what it shows then, asked that and the
  /// harmless question, and a new one does not, nothing can be said.
  [[nodiscard]] Outcome<void> meet(const Script& questions) {
    constexpr int kMostParts = 50;
    constexpr int kMostUnanswered = 3;
    int unanswered = 0;
    bool are_renewed = false;
    for (int left = kMostParts; left > 0; --left) {
      const auto seen = see(questions);
      if (!seen && is_refusal(seen.error()) && left > 1) continue;
      if (!seen) return tl::unexpected{seen.error()};
      if (seen->heard.target.end) return tl::unexpected{*seen->heard.target.end};
      if (!seen->symptom) return {};
      if (!std::exchange(are_renewed, true)) {  // perhaps only the models have gone astray
        if (auto renewed = stage_.renew_models(); !renewed) return renewed;
        continue;
      }
      const auto& symptom = *seen->symptom;
      if (is_answered(symptom)) {
        pass_over(symptom, "");
      } else if (++unanswered == kMostUnanswered) {
        return problem(ErrorCode::kTimedOut, "--target",
                       fmt::format("the model has {}; is it there, and the model, --model, at "
                                   "the same address?",
                                   symptom.expected));
      }
    }
    return {};
  }
  static bool is_answered(const Symptom& symptom) { return !is_of(symptom, Change::kMissing); }
  /// From now on nothing is said of it.
  void pass_over(const Symptom& symptom, const std::string& since) {
    for (const auto& part : symptom.parts) {
      excuses_.add({}, symptom.answer, part);
      excuses_at_first_.add({}, symptom.answer, part);
      excuses_anyway_.add({}, symptom.answer, part);
    }
    state_.passed_over.push_back(fmt::format("{}: {} instead of {}{}", symptom.answer,
                                             symptom.actual, symptom.expected, since));
  }

  [[nodiscard]] Script with_question(const Script& script) const {
    auto whole = joined(spaced(with_ends(script), material_.spacing), material_.harmless, kPause);
    if (!material_.are_ends_told) std::ranges::for_each(whole, leave_half_open);
    return whole;
  }

  [[nodiscard]] Outcome<Seen> see(const Script& script) {
    const auto whole = with_question(script);
    is_astray_ = is_astray_ || goes_astray(whole);
    auto heard = stage_.play(whole);
    if (!heard) return tl::unexpected{heard.error()};
    auto symptom = symptom_of(whole, *heard, judging(), excuses_);
    return Seen{*std::move(heard), std::move(symptom)};
  }

  [[nodiscard]] bool can_go_astray() const {
    return !stage_.can_reset() && !material_.astray_fields.empty();
  }
  /// Whether it leads a target that nobody can start again where no model can follow.
  [[nodiscard]] bool goes_astray(const Script& script) const {
    if (!can_go_astray()) return false;
    const auto messages = messages_of(script, material_.make_dissector);
    return std::ranges::any_of(messages.lanes(), [this](const auto& lane) {
      return std::ranges::any_of(
          lane.second, [this](const auto& one) { return material_.strays(one.message.raw); });
    });
  }
  /// What tells where the target is says nothing once it is astray.
  [[nodiscard]] const Judging& judging() const noexcept {
    return is_astray_ ? judging_astray_ : options_.judging;
  }
  [[nodiscard]] static Judging judging_astray(const Material& material, Judging judging) {
    for (const auto field : material.astray_fields) {
      judging.rules.fields.push_back(
          {.message = {}, .name = std::string{field}, .is_ignored = true});
    }
    return judging;
  }

  [[nodiscard]] RecordedMessages messages_in(const Seen& seen) const {
    return messages_of(seen.heard.target.said, material_.make_dissector);
  }

  /// Those of the survey are shared among all shares, too. None: the case comes by chance.
  [[nodiscard]] std::optional<std::size_t> place_in_survey(std::uint64_t number) const {
    const bool is_in_turn = options_.when_survey == WhenSurvey::kInTurn;
    if (!survey_ || (is_in_turn && number % 2 == 0)) return std::nullopt;
    const auto turn = is_in_turn ? number / 2 : number;
    const auto place = turn * options_.share.count + options_.share.index - 1;
    if (place >= survey_->size()) return std::nullopt;
    return place;
  }

  [[nodiscard]] Script script_of(std::uint64_t number) const {
    const auto place = place_in_survey(number);
    auto script =
        place ? survey_->at(*place) : author_.draw(seed_of(options_, number), state_.worthy);
    if (material_.permit_case) material_.permit_case(script);
    return script;
  }

  [[nodiscard]] Outcome<void> play_case(const Script& script, std::uint64_t number) {
    auto seen = see(script);
    ++state_.cases;
    if (!seen) {
      return give_up(seen.error());
    }
    if (seen->symptom) return look_into(script, *seen->symptom, number);
    note_history(script);
    if (state_.shown.add(messages_in(*seen))) {
      state_.worthy.push_back(script);
      if (listener_.on_worthy) listener_.on_worthy(script, number);
    }
    return {};
  }

  /// No more cases than there are between resets: on a device that nobody can start again it would
  /// take as long to play all of them again as the campaign has taken.
  void note_history(const Script& script) {
    history_.push_back(script);
    if (history_.size() > options_.cases_between_resets) history_.pop_front();
  }
  [[nodiscard]] Script after_history(const Script& script) const {
    Script whole;
    for (const auto& one : history_) whole = joined(std::move(whole), one, kPause);
    return joined(std::move(whole), script, kPause);
  }

  [[nodiscard]] static bool is_refusal(const Problem& problem) {
    return problem.code == ErrorCode::kForbidden;
  }

  /// A case that the guard ended tells nothing, and models do not know where it left the target.
  [[nodiscard]] Outcome<void> give_up(const Problem& problem) {
    if (!is_refusal(problem)) return tl::unexpected{problem};
    ++state_.refused;
    state_.last_refusal = problem.hint;
    return start_again(survey_ ? survey_->questions() : Script{});
  }

  using IsIt = std::function<bool(const Symptom& seen)>;

  /// On devices that are as new; again if the guard ended it, as it does when this program had no
  /// time.
  [[nodiscard]] Outcome<Seen> see_afresh(const Script& script) {
    constexpr int kTimes = 3;
    for (int left = kTimes;; --left) {
      if (auto begun = stage_.reset(); !begun) return tl::unexpected{begun.error()};
      auto seen = see(script);
      if (seen || !is_refusal(seen.error()) || left == 1) return seen;
    }
  }

  /// Whether it comes again on devices that are as new, and not of the link.
  [[nodiscard]] Outcome<bool> shows(const Script& script, const IsIt& is_it) {
    auto seen = see_afresh(script);
    if (!seen) return tl::unexpected{seen.error()};
    if (!seen->symptom || !is_it(*seen->symptom)) return false;
    auto is_of_link = comes_of_link(script, is_it);
    if (!is_of_link) return tl::unexpected{is_of_link.error()};
    if (!*is_of_link) last_seen_ = *std::move(seen);
    return !*is_of_link;
  }
  /// Whether a sound device in the target's place shows it, too.
  [[nodiscard]] Outcome<bool> comes_of_link(const Script& script, const IsIt& is_it) {
    const auto whole = with_question(script);
    for (int left = options_.doubts; left > 0; --left) {
      const auto heard = stage_.play_to_stand_in(whole, ++doubts_);
      if (!heard) return tl::unexpected{heard.error()};
      const auto symptom = symptom_of(whole, *heard, judging(), excuses_);
      if (symptom && is_it(*symptom)) return true;
    }
    return false;
  }
  [[nodiscard]] Outcome<bool> shows(const Script& script, const Symptom& symptom) {
    return shows(script, [&](const Symptom& seen) { return is_same(seen, symptom); });
  }

  /// The same, as often as it takes to be sure.
  [[nodiscard]] Outcome<bool> shows_surely(const Script& script, const Symptom& symptom) {
    for (int left = options_.confirmations; left > 1; --left) {
      auto is_there = shows(script, symptom);
      if (!is_there || !*is_there) return is_there;
    }
    return shows(script, symptom);
  }

  [[nodiscard]] Outcome<void> look_into(Script script, const Symptom& symptom,
                                        std::uint64_t number) {
    const auto found_after = passed_before_ + since_begin();
    auto is_there = shows_surely(script, symptom);
    if (is_there && !*is_there && !history_.empty()) {
      script = after_history(script);
      is_there = shows_surely(script, symptom);
    }
    if (!is_there) return give_up(is_there.error());
    if (!*is_there) {
      ++state_.unsettled;
      state_.last_unsettled =
          sentence_of(symptom, with_question(script), material_.harmless, material_.make_dissector);
      return start_again();
    }
    Finding finding{.symptom = symptom,
                    .sentence = {},
                    .script = {},
                    .answers = {},
                    .case_number = number,
                    .found_size = script.size(),
                    .found_after = found_after};
    auto seen_first = last_seen_;
    // One that nobody can start again may be left changed for good. It may be so because of a
    // moment that no model met, and what was once so cannot be tried again. Only what is silent for
    // good is not so by chance.
    const auto always = stage_.can_reset() ? Outcome<bool>{false} : shows({}, symptom);
    if (!always) return give_up(always.error());
    if (*always && is_answered(symptom)) {
      pass_over(symptom, fmt::format(", since case {}", number));
      return start_again();
    }
    auto is_short =
        *always ? Outcome<std::optional<Script>>{std::nullopt} : made_surely_short(script, symptom);
    if (!is_short) return give_up(is_short.error());
    auto& short_one = *is_short;
    if (!short_one) last_seen_ = std::move(seen_first);
    complete(finding, short_one ? *short_one : script);
    excuse(finding);
    excuse(symptom, symptom.asked);
    if (short_one) {
      if (auto noted = note_what_shows(finding, *short_one); !noted) return noted;
    }
    state_.findings.push_back(std::move(finding));
    state_.causes = causes_of(state_.findings).size();
    if (listener_.on_finding) listener_.on_finding(state_);
    return start_again();
  }

  /// The shortest of those that it was made into, one after the other, that shows it as often as it
  /// takes to be sure: where a moment has a part in it, a shorter one may show it now and then.
  /// None: rather long than wrong.
  [[nodiscard]] Outcome<std::optional<Script>> made_surely_short(const Script& script,
                                                                 const Symptom& symptom) {
    shown_.clear();
    note_shown(script);
    if (auto short_one = made_short(script, symptom); !short_one) {
      return tl::unexpected{short_one.error()};
    }
    for (std::size_t back = 1; back <= shown_.size(); back *= 2) {
      const auto& [shorter, seen] = shown_[shown_.size() - back];
      auto is_sure = shows_surely(shorter, seen);
      if (!is_sure) return tl::unexpected{is_sure.error()};
      if (*is_sure) return shorter;
      if (options_.must_stop()) break;
    }
    return std::nullopt;
  }

  /// With that symptom; or, if it stays long so, with one of another answer that is wrong in the
  /// same respect, as when all answers are late.
  [[nodiscard]] Outcome<Script> made_short(Script script, const Symptom& symptom) {
    constexpr std::size_t kLong = 20;
    auto strictly =
        made_short(std::move(script), [&](const Symptom& seen) { return is_same(seen, symptom); });
    if (!strictly || strictly->size() <= kLong) return strictly;
    return made_short(*std::move(strictly), [&](const Symptom& seen) {
      return is_same(seen, symptom) ||
             std::ranges::find_first_of(seen.parts, symptom.parts) != seen.parts.end();
    });
  }
  [[nodiscard]] Outcome<Script> made_short(Script script, const IsIt& is_it) {
    std::optional<Problem> failure;
    std::size_t attempts = 0;
    const auto begun = WallClock::now();
    const auto may_go_on = [&] {
      return !failure && attempts < options_.most_attempts && !options_.must_stop() &&
             WallClock::now() - begun < options_.most_shrinking;
    };
    const Shows shows_it = [&](const Script& other) {
      ++attempts;
      auto is_there = shows(other, is_it);
      if (!is_there && !is_refusal(is_there.error())) failure = is_there.error();
      if (!is_there || !*is_there) return false;
      note_shown(other);
      return true;
    };
    auto short_one = shrink(std::move(script), material_.harmless, material_.make_dissector,
                            shows_it, may_go_on);
    if (failure) return tl::unexpected{*failure};
    return short_one;
  }

  /// What `last_seen_` is of.
  void note_shown(const Script& script) {
    constexpr std::size_t kMostKept = 64;
    shown_.emplace_back(script, *last_seen_.symptom);
    if (shown_.size() > kMostKept) shown_.pop_front();
  }

  /// `last_seen_` is of the shortest script that showed it.
  void complete(Finding& finding, const Script& script) {
    finding.script = with_question(script);
    finding.symptom = *last_seen_.symptom;
    finding.size = script.size();
    if (!last_seen_.heard.models.empty()) finding.answers = last_seen_.heard.models.front().said;
    finding.sentence =
        sentence_of(finding.symptom, finding.script, material_.harmless, material_.make_dissector);
    if (const auto* known = options_.known.find(finding.symptom)) finding.known = known->why;
  }

  /// All that the finding shows; what it shows when its answers are read as a whole; and what it
  /// shows of other joints, if these are wrong in the same manner.
  [[nodiscard]] Outcome<void> note_what_shows(Finding& finding, const Script& script) {
    std::set<std::string> all;
    const auto add = [&all](std::vector<std::string> ways) {
      all.insert(std::make_move_iterator(ways.begin()), std::make_move_iterator(ways.end()));
    };
    const auto judge = [&](const Script& whole, const BothHeard& heard) {
      add(all_ways(whole, heard, judging(), excuses_at_first_, excuses_));
    };
    const auto judge_sibling = [&](const Script& whole, const BothHeard& heard) {
      const auto symptom = symptom_of(whole, heard, judging(), excuses_anyway_);
      if (symptom && symptom->answer == finding.symptom.answer &&
          are_alike(*symptom, finding.symptom)) {
        add(symptom->ways());
      }
    };
    judge(finding.script, last_seen_.heard);
    if (const auto read = with_whole_reads(script); read != script) {
      if (auto done = play_fresh(read, judge); !done) return done;
    }
    for (const auto& other : for_siblings(script, finding.symptom.parts.front(),
                                          material_.make_dissector, material_.seal)) {
      if (auto done = play_fresh(other, judge_sibling); !done) return done;
    }
    finding.shows.assign(all.begin(), all.end());
    return {};
  }

  /// On a device that is as new; what the guard refuses is left out.
  template <class JudgeHeard>
  [[nodiscard]] Outcome<void> play_fresh(const Script& script, JudgeHeard judge_heard) {
    if (options_.must_stop()) return {};
    if (auto begun = stage_.reset(); !begun) return begun;
    const auto whole = with_question(script);
    const auto heard = stage_.play(whole);
    if (heard) {
      judge_heard(whole, *heard);
    } else if (!is_refusal(heard.error())) {
      return tl::unexpected{heard.error()};
    }
    return {};
  }

  /// What was found is not found again: after any question, if one message was enough for it.
  void excuse(const Finding& finding) {
    const auto sent = std::ranges::count_if(finding.script, is_sent);
    const auto harmless = std::ranges::count_if(material_.harmless, is_sent);
    excuse(finding.symptom, sent <= harmless + 1 ? std::string{} : finding.symptom.asked);
    if (finding.size > 0) return;
    for (const auto& part : finding.symptom.parts) {
      excuses_anyway_.add({}, finding.symptom.answer, part);
    }
  }
  void excuse(const Symptom& symptom, const std::string& asked) {
    for (const auto& part : symptom.parts) {
      const bool is_enough = ++of_part_[symptom.answer + '\n' + part] >= 2 * kMostOfOnePart;
      excuses_.add(is_enough ? std::string{} : asked, symptom.answer, part);
    }
  }

  [[nodiscard]] Duration since_begin() const { return WallClock::now() - begun_; }

  Stage& stage_;
  const Material& material_;
  const CampaignOptions& options_;
  CampaignState& state_;
  const CampaignListener& listener_;
  Author author_;
  std::optional<Survey> survey_;
  Excuses excuses_;
  Judging judging_astray_;
  bool is_astray_ = false;                       ///< since a message that strays
  Excuses excuses_at_first_ = options_.excuses;  ///< without what was found
  Excuses excuses_anyway_ = options_.excuses;    ///< with what shows whatever is done
  std::map<std::string, int> of_part_;
  std::deque<Script> history_;  ///< the last cases since the last reset
  std::uint64_t doubts_ = 0;    ///< that there were
  Seen last_seen_;
  std::deque<std::pair<Script, Symptom>> shown_;  ///< while one is made short, the last ones
  WallClock::time_point begun_ = WallClock::now();
  Duration passed_before_ = state_.passed;
};

}  // namespace

Outcome<void> run_campaign(Stage& stage, const Material& material, const CampaignOptions& options,
                           CampaignState& state, const CampaignListener& listener) {
  return Campaign{stage, material, options, state, listener}.run();
}

}  // namespace armjig::campaign
