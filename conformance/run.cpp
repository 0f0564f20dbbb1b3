// SPDX-License-Identifier: Apache-2.0
#include "conformance/run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "harness/core/version.hpp"

namespace armjig {
namespace {

/// FNV-1a, so that the random bytes of a case do not depend on which cases ran before.
std::uint64_t seed_of(std::string_view name, std::uint64_t seed) noexcept {
  auto hash = 0xCBF29CE484222325ULL ^ seed;
  for (const auto letter : name) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001B3ULL;
  }
  return hash;
}

/// So often a case is started on a machine that has no time for it.
constexpr int kMostStarts = 3;

/// So often a case that was late once has to be in time.
constexpr int kTriesInTime = 2;

/// So often an emulated device has to be in time where one was late twice.
constexpr int kReferences = 3;

/// Answers of an emulated device that come later than that make a link slow.
constexpr Duration kSlowLink = std::chrono::milliseconds{20};

constexpr auto kOnBusyMachine = ", on a machine that has too much to do";

std::string wording_of(const Judgement& judgement) {
  if (judgement.expected.empty()) return judgement.actual;
  return fmt::format("expected {}, got {}", judgement.expected, judgement.actual);
}

std::string in_us(Duration most) {
  return fmt::format("{} us at most", most / std::chrono::microseconds{1});
}

constexpr std::string_view kStopped = "the run was interrupted";
constexpr std::string_view kTimeIsUp = "the time of the run was up";

/// What one or several runs of a case came to.
struct Finding {
  Judgement judgement;
  std::string evidence;
  Duration duration{};
};

/// One run over a suite.
class Run {
 public:
  Run(const Suite& suite, Bench& bench, const RunOptions& options,
      const std::function<void(const ReportRow&)>& on_row)
      : suite_{suite}, bench_{bench}, options_{options}, on_row_{on_row} {}

  Report all() {
    const auto cases = select(suite_, options_.profile, options_.selection);
    is_alive_ = check_alive("before the first case");
    if (is_alive_) measure_noise();
    add_facts(cases.size());
    for (const auto* one : cases) add(judge(*one));
    if (is_alive_ && !options_.must_stop()) (void)check_alive("after the last case");
    for (const auto& waiver : options_.waivers) check_use(waiver);
    add_coverage();
    if (restarts_ > 0) add_missed();
    return std::move(report_);
  }

 private:
  void measure_noise() {
    bench_.measure_noise();
    if (!options_.reference) return bench_.know_link(Duration{});
    if (const auto reference = open_reference()) {
      reference->measure_noise();
      bench_.know_link(reference->heard_noise());
      link_ = reference->heard_noise();
    }
  }

  /// None if it cannot be had, or does not answer.
  [[nodiscard]] std::shared_ptr<Bench> open_reference() const {
    auto reference = options_.reference();
    if (reference == nullptr) return reference;
    reference->begin(options_.profile, options_.seed);
    return reference->is_alive() ? reference : nullptr;
  }

  void add_facts(std::size_t selected) {
    report_.title = fmt::format("Conformance of {}", suite_.device);
    report_.facts = {
        {"target", options_.target},
        {"profile", std::string{to_string(options_.profile)}},
        {"catalogue", std::string{suite_.version}},
        {"armjig", std::string{kVersion}},
        {"seed", std::to_string(options_.seed)},
        {"selected", fmt::format("{} cases", selected)},
        {"answers in", in_us(bench_.heard_noise())},
    };
    if (link_) report_.facts.emplace_back("an emulated device's answers in", in_us(*link_));
  }

  void add_missed() {
    const std::chrono::duration<double> stood = missed();
    report_.facts.emplace_back(
        "stopped", fmt::format("{:.3f} s in all did this process not run; cases were started again "
                               "{} times for that, or for a supervisor that heard nothing",
                               stood.count(), restarts_));
  }

  /// What `find` comes to, again if it is not good and this process did not run meanwhile, or the
  /// device was stopped for want of a sign of life: then that says nothing about the device.
  template <class Find, class IsGood>
  auto undisturbed(Find find, IsGood is_good) {
    for (int start = 1;; ++start) {
      const auto before = missed();
      if (std::exchange(missed_before_, before) != before || bench_.is_stopped()) bench_.resume();
      auto found = find();
      if (is_good(found)) {
        is_disturbed_ = false;
        return found;
      }
      is_disturbed_ = missed() != before;
      const bool counts = !is_disturbed_ && !bench_.is_stopped();
      if (counts || bench_.error() || start == kMostStarts) return found;
      ++restarts_;
    }
  }

  [[nodiscard]] Duration missed() const {
    return options_.missed ? options_.missed() : Duration::zero();
  }

  ReportRow judge(const Case& one) {
    if (auto reason = reason_not_to_run(one)) return row_of(one, {*std::move(reason)});
    auto finding = run_repeatedly(one);
    auto& judgement = finding.judgement;
    if (judgement.is_silence && !bench_.error() && !may_have_died_of(one) && !gives_sign()) {
      finding = look_into_death(one, std::move(finding));
    }
    if (bench_.error()) {
      judgement = {Verdict::kError, {}, std::string{describe(bench_.error()->code)}};
      is_alive_ = false;
    } else if (judgement.verdict == Verdict::kFail && deviates_as_known(one)) {
      judgement.verdict = Verdict::kDeviation;
    }
    if (options_.must_stop()) {  // nobody knows what it would have come to
      return row_of(one, {skipped(reason_of_stop())});
    }
    if (is_alive_) blame_start(one.start);
    excuse(one, judgement);
    if (judgement.verdict == Verdict::kFail || judgement.verdict == Verdict::kFlaky) {
      has_failed_ = true;
    }
    return row_of(one, std::move(finding));
  }

  /// A device that has fallen silent in a case: started again, it is asked again. One that nobody
  /// can bring back may have been switched off.
  Finding look_into_death(const Case& one, Finding finding) {
    if (!revive(one)) return bury(one, std::move(finding));
    const auto once = wording_of(finding.judgement);
    finding = run_once(one, options_.profile);
    auto& judgement = finding.judgement;
    if (judgement.is_silence && !gives_sign()) {
      if (!revive(one)) return bury(one, std::move(finding));
      judgement.verdict = Verdict::kFail;
      judgement.actual += ", twice, and no sign of life until it is started again";
    } else if (!bench_.error()) {
      judgement = {
          Verdict::kInconclusive,
          {},
          fmt::format("once {}, and no sign of life until it was started again; then not", once)};
    }
    return finding;
  }

  Finding bury(const Case& one, Finding finding) {
    is_alive_ = check_alive(fmt::format("after {}", name_of(one)));
    // One that says other things is no matter of the rig.
    const bool is_understood = bench_.judgement().verdict != Verdict::kFail;
    if (!is_alive_ && is_understood) finding.judgement.verdict = Verdict::kError;
    return finding;
  }

  /// What was out of reach may have been so because of that.
  bool revive(const Case& one) {
    out_of_reach_.erase(one.start);
    bench_.begin(options_.profile, options_.seed);
    return bench_.revive();
  }

  static Judgement skipped(std::string reason) {
    return {Verdict::kSkipped, {}, std::move(reason)};
  }
  static Judgement left_out(std::string reason) {
    auto judgement = skipped(std::move(reason));
    judgement.is_left_out = true;
    return judgement;
  }

  [[nodiscard]] std::string reason_of_stop() const {
    return std::string{options_.is_time_up() ? kTimeIsUp : kStopped};
  }

  [[nodiscard]] std::optional<Judgement> reason_not_to_run(const Case& one) const {
    for (const auto hazard : {one.hazard, suite_.starts[one.start].hazard}) {
      if (!options_.permissions.allow(hazard)) {
        return left_out(fmt::format("needs --allow {}", to_string(hazard)));
      }
    }
    if (options_.must_stop()) return skipped(reason_of_stop());
    if (!is_alive_) return skipped("the target does not answer");
    if (has_failed_ && options_.stops_at_first_failure) return skipped("a case failed before");
    if (one.hazard == Hazard::kCrash && !bench_.can_restart()) {
      return left_out("ends or hangs the device's program: --restart has to bring it back");
    }
    return std::nullopt;
  }

  /// Whether it, or one before it, ends the device's program on purpose. Those are the last ones.
  [[nodiscard]] bool may_have_died_of(const Case& one) const {
    return one.hazard == Hazard::kCrash || !killer_.empty();
  }

  [[nodiscard]] bool is_busy() const { return options_.is_busy && options_.is_busy(); }

  /// On a link that is slow itself whatever fails may have been late.
  [[nodiscard]] bool is_moment(const Judgement& judgement) const noexcept {
    return judgement.is_timing || link_ > kSlowLink;
  }

  /// And on a busy machine it may have come of that, as long as nothing has failed for good.
  [[nodiscard]] bool is_late(const Finding& finding) const {
    return finding.judgement.verdict == Verdict::kFail &&
           (is_moment(finding.judgement) || (is_busy() && !has_failed_));
  }

  /// A failure counts if an emulated device on a link of the same kind does not fail, and a moment
  /// that was missed, or anything on a busy machine, only if it fails again.
  Finding run_to_be_sure(const Case& one) {
    auto finding = run_once(one, options_.profile);
    if (!options_.reference || finding.judgement.verdict != Verdict::kFail) return finding;
    if (!is_late(finding)) return doubt(one, std::move(finding), 1);
    const bool was_moment = is_moment(finding.judgement);
    const auto once = wording_of(finding.judgement);
    for (int again = 0; again < kTriesInTime; ++again) {
      finding = run_once(one, options_.profile);
      if (bench_.error() || options_.must_stop()) return finding;
      if (is_late(finding)) return doubt_moment(one, std::move(finding));
      if (finding.judgement.verdict != Verdict::kPass) return finding;
    }
    finding.judgement.actual = fmt::format("once {}; {} times as it should be", once, kTriesInTime);
    if (was_moment) return finding;
    finding.judgement.verdict = Verdict::kInconclusive;
    finding.judgement.actual += kOnBusyMachine;
    return finding;
  }

  /// A moment that was missed twice. In a race, which chance may decide, and on a busy machine it
  /// has to be missed again beside each emulated device that is in time.
  Finding doubt_moment(const Case& one, Finding finding) {
    const bool is_race = finding.judgement.is_race;
    if (!is_race && !is_busy()) return doubt(one, std::move(finding), kReferences);
    for (int i = 0; i < kReferences; ++i) {
      finding = doubt(one, std::move(finding), 1);
      if (finding.judgement.verdict != Verdict::kFail) return finding;
      auto again = run_once(one, options_.profile);
      if (bench_.error() || options_.must_stop()) return again;
      if (again.judgement.verdict == Verdict::kFail) continue;
      if (again.judgement.verdict != Verdict::kPass) return again;
      finding.judgement = {
          Verdict::kInconclusive,
          {},
          fmt::format("{} times {}; then otherwise{}", 2 + i, wording_of(finding.judgement),
                      is_race ? ", in a race" : kOnBusyMachine)};
      return finding;
    }
    return finding;
  }

  Finding doubt(const Case& one, Finding finding, int tries) {
    say([&] { return fmt::format("{}: on an emulated device", name_of(one)); });
    for (int i = 0; i < tries && !options_.must_stop(); ++i) {
      const auto reference = open_reference();
      if (reference == nullptr) return finding;
      reference->measure_noise();
      reference->know_link(link_);
      reference->begin(options_.profile, options_.seed);
      reference->bring_to(one.start);
      reference->begin(options_.profile, seed_of(name_of(one), options_.seed));
      one.run(*reference);
      const auto& judgement = reference->judgement();
      if (judgement.verdict != Verdict::kFail) continue;
      finding.judgement = {Verdict::kInconclusive,
                           {},
                           fmt::format("an emulated device on such a link does not pass either: {}",
                                       wording_of(judgement))};
      return finding;
    }
    return finding;
  }

  Finding run_repeatedly(const Case& one) {
    auto finding = run_to_be_sure(one);
    std::map<Verdict, int> verdicts{{finding.judgement.verdict, 1}};
    for (int i = 1; i < options_.repeat && !bench_.error() && !options_.must_stop(); ++i) {
      auto again = run_to_be_sure(one);
      ++verdicts[again.judgement.verdict];
      again.duration += finding.duration;
      const bool shows_more = again.judgement.verdict != Verdict::kPass;
      if (shows_more) finding = std::move(again);
    }
    if (verdicts.size() > 1 && verdicts.contains(Verdict::kFail)) {
      finding.judgement.verdict = Verdict::kFlaky;
      finding.judgement.actual +=
          fmt::format(" (in {} of {} runs)", verdicts[Verdict::kFail], options_.repeat);
    }
    return finding;
  }

  Finding run_once(const Case& one, Profile profile) {
    auto finding =
        undisturbed([&] { return start_once(one, profile); },
                    [](const Finding& each) {
                      // What neither link nor hands can do does not depend on time.
                      return each.judgement.verdict == Verdict::kPass || each.judgement.is_left_out;
                    });
    if (is_disturbed_ && !bench_.error()) {
      finding.judgement = {Verdict::kInconclusive,
                           {},
                           "this process did not run all the time, whenever it was started"};
    }
    return finding;
  }

  Finding start_once(const Case& one, Profile profile) {
    Finding finding;
    if (auto obstacle = bring_to_start(one, profile)) {
      finding.judgement = *std::move(obstacle);
    } else {
      if (one.hazard == Hazard::kCrash) killer_ = name_of(one);
      say([&] { return name_of(one); });
      bench_.begin(profile, seed_of(name_of(one), options_.seed));
      const auto begin = bench_.now();
      one.run(bench_);
      finding.duration = bench_.now() - begin;
      finding.judgement = bench_.judgement();
    }
    if (finding.judgement.verdict != Verdict::kPass) finding.evidence = bench_.last_exchange();
    return finding;
  }

  /// Why the case cannot begin. A state that was out of reach once is not tried again, unless that
  /// may have been a matter of time, and then not for ever.
  std::optional<Judgement> bring_to_start(const Case& one, Profile profile) {
    auto known = out_of_reach_.find(one.start);
    if (known == out_of_reach_.end()) {
      const auto before = missed();
      say([&] {
        return fmt::format("{}: until it is at its start, {}", name_of(one),
                           suite_.starts[one.start].name);
      });
      bench_.begin(profile, options_.seed);
      bench_.bring_to(one.start);
      if (bench_.judgement().verdict == Verdict::kPass) return std::nullopt;
      if (missed() != before || bench_.is_stopped()) return bench_.judgement();
      const bool may_be_late = is_moment(bench_.judgement()) || is_busy();
      if (may_be_late && ++late_starts_[one.start] <= kTriesInTime) return bench_.judgement();
      if (!killer_.empty() && bench_.judgement().verdict != Verdict::kSkipped) {
        return skipped(fmt::format(
            "{} ended or hung the device's program, and it has not come back", killer_));
      }
      known = out_of_reach_.emplace(one.start, bench_.judgement()).first;
    }
    const auto& obstacle = known->second;
    if (obstacle.verdict == Verdict::kSkipped) return obstacle;
    return Judgement{Verdict::kInconclusive,
                     {},
                     fmt::format("cannot reach its start, {}: {}", suite_.starts[one.start].name,
                                 wording_of(obstacle)),
                     obstacle.is_silence};
  }

  /// What is wrong with a device that cannot be brought to a start belongs to no case, and must not
  /// be lost among those that then show nothing.
  void blame_start(std::uint8_t start) {
    const auto obstacle = out_of_reach_.find(start);
    if (obstacle == out_of_reach_.end()) return;
    const auto verdict = obstacle->second.verdict;
    if (verdict != Verdict::kFail && verdict != Verdict::kError) return;
    if (!blamed_.insert(start).second) return;
    auto row = row_of_device("start", verdict);
    row.summary =
        fmt::format("the device can be brought to the start {}", suite_.starts[start].name);
    row.expected = obstacle->second.expected;
    row.actual = obstacle->second.actual;
    add(std::move(row));
    has_failed_ = has_failed_ || verdict == Verdict::kFail;
  }

  /// Whether the device does what the shipped one is known to do instead.
  bool deviates_as_known(const Case& broken) {
    const auto& instead = requirement_of(suite_, broken).instead;
    if (options_.profile != Profile::kDocumented || instead.empty()) return false;
    int passed = 0;
    for (const auto& chapter : suite_.chapters) {
      for (const auto& one : chapter.cases) {
        if (one.requirement != instead || reason_not_to_run(one)) continue;
        if (run_once(one, Profile::kFirmware).judgement.verdict != Verdict::kPass) return false;
        ++passed;
      }
    }
    return passed > 0;
  }

  void excuse(const Case& one, Judgement& judgement) {
    if (judgement.verdict != Verdict::kFail && judgement.verdict != Verdict::kFlaky) return;
    const auto waiver = std::ranges::find(options_.waivers, one.requirement, &Waiver::requirement);
    if (waiver == options_.waivers.end()) return;
    judgement.verdict = Verdict::kDeviation;
    judgement.actual +=
        fmt::format(" (waived until {}: {})", armjig::to_string(waiver->expires), waiver->reason);
  }

  /// A waiver whose requirement is obeyed would hide the next failure.
  void check_use(const Waiver& waiver) {
    if (!options_.selection.is_everything()) return;
    const auto is_about = [&](const ReportRow& row) {
      return row.requirement == waiver.requirement;
    };
    const auto is_obeyed = std::ranges::any_of(report_.rows, is_about) &&
                           std::ranges::all_of(report_.rows, [&](const ReportRow& row) {
                             return !is_about(row) || row.verdict == Verdict::kPass;
                           });
    if (!is_obeyed) return;
    ReportRow row;
    row.verdict = Verdict::kError;
    row.name = fmt::format("{}.waived", waiver.requirement);
    row.summary = "a waiver excuses what needs no excuse; take it out of the file";
    row.expected = fmt::format("a failure of {}", waiver.requirement);
    row.actual = "all its cases passed";
    add(std::move(row));
  }

  /// What was judged of a requirement's cases. One that broke it is enough; that it is obeyed takes
  /// all that are within reach.
  struct Judged {
    bool is_within = false;
    bool is_broken = false;
    bool is_open = false;

    void take(const ReportRow& row) noexcept {
      const bool is_broken_here = row.verdict == Verdict::kFail || row.verdict == Verdict::kFlaky;
      is_within = is_within || !row.is_left_out;
      is_broken = is_broken || is_broken_here;
      is_open = is_open || (!row.is_left_out && !is_broken_here && row.verdict != Verdict::kPass &&
                            row.verdict != Verdict::kDeviation);
    }
    [[nodiscard]] bool is_judged() const noexcept { return is_broken || (is_within && !is_open); }
  };

  void add_coverage() {
    std::map<std::string_view, Judged> judged;
    for (const auto& row : report_.rows) {
      if (!row.requirement.empty()) judged[row.requirement].take(row);
    }
    auto& coverage = report_.coverage.emplace();
    for (const auto& chapter : suite_.chapters) {
      for (const auto& one : chapter.requirements) {
        const bool binds = one.level == Level::kMust && one.role == Role::kDevice &&
                           holds_in(one.profiles, options_.profile);
        if (binds) count(judged[one.id], is_waived(one.id), coverage);
      }
    }
    report_.facts.emplace_back("judged", to_text(coverage));
    require_enough(coverage);
  }

  static void count(const Judged& judged, bool is_waived, Coverage& coverage) noexcept {
    ++coverage.all;
    if (judged.is_judged()) ++coverage.judged;
    if (!judged.is_within || is_waived) return;
    ++coverage.within;
    if (judged.is_judged()) ++coverage.judged_within;
  }

  [[nodiscard]] bool is_waived(std::string_view requirement) const {
    return std::ranges::find(options_.waivers, requirement, &Waiver::requirement) !=
           options_.waivers.end();
  }

  /// Where something was found, or the rig stood in the way, that is what there is to say.
  void require_enough(const Coverage& coverage) {
    const bool is_interrupted = options_.must_stop() && !options_.is_time_up();
    if (coverage.share() >= options_.required_share || is_interrupted ||
        conclusion_of(report_) != Conclusion::kPassed) {
      return;
    }
    ReportRow row;
    row.verdict = Verdict::kFail;
    row.name = fmt::format("{}.judged", suite_.device);
    row.summary = "enough of what binds the device was judged";
    row.expected = fmt::format("at least {:.4g} % of the must requirements within reach",
                               options_.required_share * 100);
    row.actual = to_text(coverage);
    row.repeat = options_.command;
    add(std::move(row));
  }

  template <class What>
  void say(What what) const {
    if (options_.on_wait) options_.on_wait(what());
  }

  bool gives_sign() {
    const bool is_alive = undisturbed(
        [this] {
          bench_.begin(options_.profile, options_.seed);
          return bench_.is_alive();
        },
        std::identity{});
    return is_alive || options_.must_stop();
  }

  bool check_alive(std::string_view when) {
    if (gives_sign()) return true;
    const auto& judgement = bench_.judgement();
    const bool is_understood = bench_.error() || judgement.verdict != Verdict::kFail;
    auto row = row_of_device("alive", is_understood ? Verdict::kError : Verdict::kFail);
    row.summary = fmt::format("no sign of life {}", when);
    row.expected = "an answer to a good message";
    row.actual = bench_.error() ? std::string{describe(bench_.error()->code)} : "silence";
    if (!is_understood) {
      row.summary = fmt::format("an answer that can be understood, {}", when);
      row.expected = judgement.expected;
      row.actual = judgement.actual;
    }
    add(std::move(row));
    return false;
  }

  /// What is wrong with the device belongs to no case.
  [[nodiscard]] ReportRow row_of_device(std::string_view what, Verdict verdict) const {
    ReportRow row;
    row.verdict = verdict;
    row.name = fmt::format("{}.{}", suite_.device, what);
    row.evidence = bench_.last_exchange();
    row.repeat = options_.command;
    return row;
  }

  [[nodiscard]] ReportRow row_of(const Case& one, Finding finding) const {
    auto row = row_about(requirement_of(suite_, one), suite_.document);
    row.verdict = finding.judgement.verdict;
    row.name = name_of(one);
    row.summary = one.rule;
    row.expected = std::move(finding.judgement.expected);
    row.actual = std::move(finding.judgement.actual);
    row.evidence = std::move(finding.evidence);
    row.margin = std::move(finding.judgement.margin);
    row.is_left_out = finding.judgement.is_left_out;
    row.repeat = fmt::format("{} --filter {}", options_.command, row.name);
    row.duration = finding.duration;
    return row;
  }

  void add(ReportRow row) {
    row.document = suite_.document.path;
    on_row_(row);
    report_.rows.push_back(std::move(row));
  }

  const Suite& suite_;
  Bench& bench_;
  const RunOptions& options_;
  const std::function<void(const ReportRow&)>& on_row_;
  Report report_;
  std::map<std::uint8_t, Judgement> out_of_reach_;  ///< start states, and why
  std::map<std::uint8_t, int> late_starts_;  ///< so often they may have been reached too late
  std::set<std::uint8_t> blamed_;            ///< those with a row of their own
  std::string killer_;            ///< the last case that ends or hangs the device's program
  int restarts_ = 0;              ///< of cases, because this process did not run
  Duration missed_before_{};      ///< what was found last
  bool is_disturbed_ = false;     ///< what was found last says nothing
  std::optional<Duration> link_;  ///< how late answers of an emulated device come on such a link
  bool is_alive_ = false;
  bool has_failed_ = false;
};

}  // namespace

Report run_suite(const Suite& suite, Bench& bench, const RunOptions& options,
                 const std::function<void(const ReportRow&)>& on_row) {
  return Run{suite, bench, options, on_row}.all();
}

}  // namespace armjig
