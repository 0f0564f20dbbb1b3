// SPDX-License-Identifier: Apache-2.0
#include "cli/morap_watch.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/morap_view.hpp"
#include "cli/pace.hpp"
#include "cli/screen.hpp"
#include "cli/signals.hpp"
#include "harness/timing/schedule.hpp"

namespace armjig::cli {
namespace {

using namespace morap;

class Watch {
 public:
  Watch(BusRig& rig, const MorapWatch& options, std::vector<BusAddress> nodes, Pace::By by)
      : rig_{rig},
        options_{options},
        master_{rig.port()},
        nodes_{std::move(nodes)},
        start_{master_.now()},
        schedule_{start_,
                  std::chrono::round<Duration>(std::chrono::duration<double>{1.0 / options.rate})},
        pace_{by, start_} {
    if (options_.form == MorapWatch::Form::kScreen) screen_.emplace();
  }

  Exit run() {
    for (std::uint64_t round = 0; !is_over(round); ++round) {
      if (const auto wait = pace_.until(schedule_.next()); wait > Duration{}) {
        std::this_thread::sleep_for(wait);
      }
      if (schedule_.next() > master_.now()) master_.wait(schedule_.next() - master_.now());
      (void)schedule_.begin(master_.now());
      for (auto node : nodes_) {
        const auto view = look_at(master_, node);
        if (view.code == BusCode::kOk) ++answers_;
        newest_ = view.code;
        last_ = node;
        views_.push_back(view);
      }
      show();
      views_.clear();
    }
    screen_.reset();
    if (answers_ > 0) return Exit::kPassed;
    return report(newest_, last_, rig_);
  }

 private:
  bool is_over(std::uint64_t round) {
    if (signals_.must_end() || signals_.take_interrupt()) return true;
    if (screen_ && screen_->wants_to_quit()) return true;
    return options_.count && round >= *options_.count;
  }

  void show() {
    const double passed = std::chrono::duration<double>{master_.now() - start_}.count();
    if (screen_) {
      return screen_->draw(fmt::format("morap at {}, {:.1f} s\n\n{}\nCtrl-C or q ends\n",
                                       options_.target.target, passed, table(views_)));
    }
    for (const auto& view : views_) {
      if (options_.form == MorapWatch::Form::kJson) {
        fmt::print("{}\n", to_json(view, passed));
      } else {
        fmt::print("{:.2f} s  {}\n", passed, to_line(view));
      }
    }
    std::fflush(stdout);
  }

  BusRig& rig_;
  const MorapWatch& options_;
  Master master_;
  std::vector<BusAddress> nodes_;
  Instant start_;
  PeriodicSchedule schedule_;
  Pace pace_;
  Signals signals_;
  std::optional<Screen> screen_;
  std::vector<NodeView> views_;
  std::uint64_t answers_ = 0;
  BusCode newest_ = BusCode::kOk;
  BusAddress last_{};
};

}  // namespace

Exit watch_morap(const MorapWatch& options) {
  auto rig = open_bus_rig("morap", options.target);
  if (!rig) return report(rig.error());
  Master master{rig->port()};
  const auto nodes = find_nodes(master);
  if (nodes.code != BusCode::kOk) return report(nodes.code, {}, *rig);
  if (nodes.addresses.empty()) {
    return report({ErrorCode::kTimedOut, options.target.target,
                   "no node answers at the addresses 10 to 1F: is the bus powered?"});
  }
  const bool is_virtual = options.target.target.starts_with("emulated:");
  const bool needs_pace = is_virtual && options.form == MorapWatch::Form::kScreen;
  return Watch{*rig, options, nodes.addresses, needs_pace ? Pace::By::kWallClock : Pace::By::kPort}
      .run();
}

}  // namespace armjig::cli
