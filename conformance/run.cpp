// SPDX-License-Identifier: Apache-2.0
#include "conformance/run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "conformance/coverage.hpp"
#include "conformance/doubt.hpp"
#include "harness/core/version.hpp"

namespace armjig {
namespace {

/// So often a case is started on a machine that has no time for it.
constexpr int kMostStarts = 3;

/// So often in a row a start state that may have been reached too late is tried again.
constexpr int kLateStarts = 2;
constexpr int kLateStartsOnBusyMachine = 20;

std::string in_us(Duration most) {
  return fmt::format("{} us at most", most / std::chrono::microseconds{1});
}

constexpr std::string_view kStopped = "the run was interrupted";
constexpr std::string_view kTimeIsUp = "the time of the run was up";

constexpr std::string_view kDidNotRun = "this process did not run all the time";
constexpr std::string_view kWasStopped =
    "the device was stopped for want of a sign of life from here";

/// One run over a suite.
class Run {
 public:
  Run(const Suite& suite, Bench& bench, const RunOptions& options,
      const std::function<void(const ReportRow&)>& on_row)
      : suite_{suite}, bench_{bench}, options_{options}, on_row_{on_row} {}

  Report all() {
    const auto cases = select(suite_, options_.profile, options_.selection);
    is_alive_ = check_alive("before the first case");
    if (is_alive_) doubt_.measure_link();
    add_facts(cases.size());
    for (const auto* one : cases) add(judge(*one));
    if (is_alive_ && !options_.must_stop()) (void)check_alive("after the last case");
    for (const auto& waiver : options_.waivers) check_use(waiver);
    add_coverage();
    if (restarts_ > 0) add_missed();
    return std::move(report_);
  }

 private:
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
    if (const auto link = doubt_.link()) {
      report_.facts.emplace_back("an emulated device's answers in", in_us(*link));
    }
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
      disturbance_ = is_good(found) ? "" : disturbance_since(before);
      if (disturbance_.empty() || bench_.error() || start == kMostStarts) return found;
      ++restarts_;
    }
  }

  [[nodiscard]] std::string_view disturbance_since(Duration missed_before) const {
    if (missed() != missed_before) return kDidNotRun;
    return bench_.is_stopped() ? kWasStopped : "";
  }

  [[nodiscard]] Duration missed() const {
    return options_.missed ? options_.missed() : Duration::zero();
  }

  ReportRow judge(const Case& one) {
    if (auto reason = reason_not_to_run(one)) return row_of(one, {*std::move(reason)});
    auto result = run_repeatedly(one);
    auto& judgement = result.judgement;
    if (judgement.is_silence && !bench_.error() && !may_have_died_of(one) && !gives_sign()) {
      result = look_into_death(one, std::move(result));
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
    return row_of(one, std::move(result));
  }

  /// A device that has fallen silent in a case: started again, it is asked again. One that nobody
  /// can bring back may have been switched off.
  CaseResult look_into_death(const Case& one, CaseResult result) {
    if (!revive(one)) return bury(one, std::move(result));
    const auto once = wording_of(result.judgement);
    result = run_once(one, options_.profile);
    auto& judgement = result.judgement;
    if (judgement.is_silence && !gives_sign()) {
      if (!revive(one)) return bury(one, std::move(result));
      judgement.verdict = Verdict::kFail;
      judgement.actual += ", twice, and no sign of life until it is started again";
    } else if (!bench_.error()) {
      judgement = {
          Verdict::kInconclusive,
          {},
          fmt::format("once {}, and no sign of life until it was started again; then not", once)};
    }
    return result;
  }

  CaseResult bury(const Case& one, CaseResult result) {
    is_alive_ = check_alive(fmt::format("after {}", name_of(one)));
    // One that says other things is no matter of the rig.
    const bool is_understood = bench_.judgement().verdict != Verdict::kFail;
    if (!is_alive_ && is_understood) result.judgement.verdict = Verdict::kError;
    return result;
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

  CaseResult run_repeatedly(const Case& one) {
    auto result = doubt_.settle(one, has_failed_);
    std::map<Verdict, int> verdicts{{result.judgement.verdict, 1}};
    for (int i = 1; i < options_.repeat && !bench_.error() && !options_.must_stop(); ++i) {
      auto again = doubt_.settle(one, has_failed_);
      ++verdicts[again.judgement.verdict];
      again.duration += result.duration;
      const bool shows_more = again.judgement.verdict != Verdict::kPass;
      if (shows_more) result = std::move(again);
    }
    if (verdicts.size() > 1 && verdicts.contains(Verdict::kFail)) {
      result.judgement.verdict = Verdict::kFlaky;
      result.judgement.actual +=
          fmt::format(" (in {} of {} runs)", verdicts[Verdict::kFail], options_.repeat);
    }
    return result;
  }

  CaseResult run_once(const Case& one, Profile profile) {
    auto result =
        undisturbed([&] { return start_once(one, profile); },
                    [](const CaseResult& each) {
                      // What neither link nor hands can do does not depend on time.
                      return each.judgement.verdict == Verdict::kPass || each.judgement.is_left_out;
                    });
    const bool says_why =
        disturbance_ == kWasStopped && result.judgement.verdict == Verdict::kSkipped;
    if (!disturbance_.empty() && !bench_.error() && !says_why) {
      result.judgement = {
          Verdict::kInconclusive, {}, fmt::format("{}, whenever it was started", disturbance_)};
    }
    return result;
  }

  CaseResult start_once(const Case& one, Profile profile) {
    CaseResult result;
    if (auto obstacle = bring_to_start(one, profile)) {
      result.judgement = *std::move(obstacle);
    } else {
      if (one.hazard == Hazard::kCrash) killer_ = name_of(one);
      say([&] { return name_of(one); });
      bench_.begin(profile, seed_of(one, options_.seed));
      const auto begin = bench_.now();
      one.run(bench_);
      result.duration = bench_.now() - begin;
      result.judgement = bench_.judgement();
    }
    if (result.judgement.verdict != Verdict::kPass) result.evidence = bench_.last_exchange();
    return result;
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
      if (bench_.judgement().verdict == Verdict::kPass) {
        late_starts_.erase(one.start);
        return std::nullopt;
      }
      if (missed() != before || bench_.is_stopped()) return bench_.judgement();
      if (doubt_.may_be_late(bench_.judgement()) && may_start_again(one.start)) {
        return bench_.judgement();
      }
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

  [[nodiscard]] bool may_start_again(std::uint8_t start) {
    const auto most = doubt_.is_busy() ? kLateStartsOnBusyMachine : kLateStarts;
    return ++late_starts_[start] <= most;
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

  void add_coverage() {
    report_.coverage = coverage_of(suite_, options_.profile, report_.rows, options_.waivers);
    report_.facts.emplace_back("judged", to_text(*report_.coverage));
    require_enough(*report_.coverage);
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

  [[nodiscard]] ReportRow row_of(const Case& one, CaseResult result) const {
    auto row = row_about(requirement_of(suite_, one), suite_.document);
    row.verdict = result.judgement.verdict;
    row.name = name_of(one);
    row.summary = one.rule;
    row.expected = std::move(result.judgement.expected);
    row.actual = std::move(result.judgement.actual);
    row.evidence = std::move(result.evidence);
    row.margin = std::move(result.judgement.margin);
    row.is_left_out = result.judgement.is_left_out;
    row.repeat = fmt::format("{} --filter {}", options_.command, row.name);
    row.duration = result.duration;
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
  Doubt doubt_{bench_, options_,
               [this](const Case& one) { return run_once(one, options_.profile); }};
  Report report_;
  std::map<std::uint8_t, Judgement> out_of_reach_;  ///< start states, and why
  std::map<std::uint8_t, int> late_starts_;  ///< so often in a row they may have been too late
  std::set<std::uint8_t> blamed_;            ///< those with a row of their own
  std::string killer_;            ///< the last case that ends or hangs the device's program
  int restarts_ = 0;              ///< of cases, because this process did not run
  Duration missed_before_{};      ///< what was found last
  std::string_view disturbance_;  ///< why what was found last says nothing; empty: it does
  bool is_alive_ = false;
  bool has_failed_ = false;
};

}  // namespace

Report run_suite(const Suite& suite, Bench& bench, const RunOptions& options,
                 const std::function<void(const ReportRow&)>& on_row) {
  return Run{suite, bench, options, on_row}.all();
}

}  // namespace armjig
