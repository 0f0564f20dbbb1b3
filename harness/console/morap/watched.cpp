// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <chrono>
#include <utility>

#include "harness/console/morap/console.hpp"
#include "harness/console/morap/view.hpp"

namespace armjig::morap::console {

using namespace drive;

namespace {

class WatchedNodes final : public Watched {
 public:
  WatchedNodes(Rig<BusPort> rig, std::vector<BusAddress> nodes)
      : rig_{std::move(rig)}, master_{rig_.port()}, nodes_{std::move(nodes)} {}

  Instant now() override { return master_.now(); }

  /// A round to every node. What one does not answer is shown, and the others are asked all the
  /// same.
  Result<bool> ask() override {
    views_.clear();
    asked_at_ = now();
    for (const auto node : nodes_) {
      views_.push_back(look_at(master_, node));
      ++asked_;
      if (views_.back().code == BusCode::kOk) ++answers_;
      if (views_.back().code == BusCode::kGone) return fail(ErrorCode::kDisconnected);
    }
    has_news_ = true;
    return true;
  }
  Result<bool> listen(Instant deadline) override {
    is_heard_ = std::exchange(has_news_, false);
    if (!is_heard_ && deadline > now()) rig_.port().wait_until(deadline);
    return is_heard_;
  }

  std::uint64_t answers() const override { return answers_; }
  std::vector<std::string> json_lines() const override {
    std::vector<std::string> lines;
    if (!is_heard_) return lines;
    const auto seconds = std::chrono::duration<double>{asked_at_ - start_}.count();
    for (const auto& view : views_) lines.push_back(to_json(view, seconds));
    return lines;
  }
  std::vector<std::string> lines() const override {
    std::vector<std::string> lines;
    for (const auto& view : views_) lines.push_back(to_line(view));
    return lines;
  }
  std::string panel() const override { return table(views_); }
  std::string link() const override {
    return fmt::format("link       {} asked, {} answered\n", asked_, answers_);
  }

 private:
  Rig<BusPort> rig_;
  Master master_;
  std::vector<BusAddress> nodes_;
  Instant start_ = master_.now();
  Instant asked_at_{};
  std::vector<NodeView> views_;  ///< of the last round
  bool has_news_ = false;        ///< that `listen` has not told
  bool is_heard_ = false;        ///< it has, the last time
  std::uint64_t asked_ = 0;
  std::uint64_t answers_ = 0;
};

}  // namespace

Outcome<std::unique_ptr<Watched>> watch(Rig<BusPort> rig, const std::string& target,
                                        const WatchHow& /*how*/) {
  Master master{rig.port()};
  auto nodes = find_nodes(master);
  if (nodes.code != BusCode::kOk) {
    return problem(error_of(nodes.code), target, std::string{describe(nodes.code)});
  }
  if (nodes.addresses.empty()) {
    return problem(ErrorCode::kTimedOut, target,
                   "no node answers at the addresses 10 to 1F: is the bus powered?");
  }
  return std::make_unique<WatchedNodes>(std::move(rig), std::move(nodes.addresses));
}

}  // namespace armjig::morap::console
