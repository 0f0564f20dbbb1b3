// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "emulators/campaign/repertoire.hpp"

namespace armjig::campaign {

/// A way through the states that a sound server tells of by itself: each message in each of them,
/// and time for what comes of it. What takes time to come to, as an arm that has to be initialised
/// first, is come to so.
class Tour {
 public:
  /// Of each kind of message, a few forms; and of clients that go and come. Both outlive this.
  Tour(const Material& material, const Repertoire& repertoire);

  /// Its next part, which begins with a device that is as new, and lasts no longer. Empty: there is
  /// nothing left that can be reached in that time, nobody knows what a sound device says, or it is
  /// not a server.
  [[nodiscard]] Script next(Duration longest);

  /// The kinds of messages to which another thing was said in one state than in most, there.
  [[nodiscard]] std::vector<Setting> where_seldom_answered() const;

  /// From now on also in the middle of what a deed began, and of what began there, and so on.
  void go_deeper();

 private:
  using State = std::uint64_t;
  struct Deed {
    const Setting* setting{};
    Script script;
    std::size_t first_form{};  ///< which deed that is
    Duration takes{};          ///< when it was done last
  };
  /// Where the device is, after all that was done.
  struct Stop {
    Script script;
    State state{};         ///< where it is now
    State settled{};       ///< where it comes to by itself; the same if it is there
    Instant settled_at{};  ///< when all is said
    std::size_t depth{};   ///< deeds that were begun and not ended
    std::string reply{};   ///< what was said at once
  };

  [[nodiscard]] Stop stop_after(Script script) const;
  /// None: it is not permitted there.
  [[nodiscard]] std::optional<Stop> stop_after(const Stop& stop, std::size_t deed) const;
  [[nodiscard]] Stop waited(Stop stop) const;
  void hear_a_beat(Stop& stop) const;
  [[nodiscard]] Stop beginning() const;
  /// By the fewest deeds; none: they do not lead there from the beginning.
  [[nodiscard]] std::optional<Stop> way_to(State state) const;
  [[nodiscard]] bool is_like_another(const Stop& from, std::size_t deed, const Stop& after);
  [[nodiscard]] std::optional<Stop> noted(const Stop& before, std::size_t deed, Stop after);

  [[nodiscard]] std::size_t waiting() const { return deeds_.size(); }
  using Deeds = std::vector<std::size_t>;
  /// The shortest known way to such a state; none: there is none.
  [[nodiscard]] std::optional<Deeds> deeds_to(State from,
                                              const std::function<bool(State)>& is_it) const;
  /// Of that way to a state where one was not tried, or that one; none: each was.
  [[nodiscard]] std::optional<std::size_t> next_deed(State from) const;
  [[nodiscard]] std::optional<std::size_t> untried_in(State state) const;

  const Material& material_;
  std::vector<Deed> deeds_;
  std::size_t depth_ = 0;
  /// Where a deed led from a state: not always to the same, for not all that matters is told.
  /// Nowhere: it is not permitted.
  struct Way {
    std::set<State> ends;
    int times{};  ///< that it was tried in this part
  };
  /// Of each state, the deeds that were tried there. After the last deed is waiting.
  std::map<State, std::map<std::size_t, Way>> known_;
  /// What began something in the middle of which nothing was done so far.
  std::set<std::pair<State, std::size_t>> passed_by_;
  /// Which form of a message led from a state to another in that time.
  std::map<std::tuple<State, std::size_t, State, Duration::rep>, std::size_t> seen_;
  /// How often that was said at once to a kind of message, and where first.
  struct Answered {
    int times{};
    State state{};
  };
  std::map<std::size_t, std::map<std::string, Answered>> answered_;
  /// States in the middle of something: of each kind of message, one form is enough there.
  std::set<State> passing_;
};

}  // namespace armjig::campaign
