// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/requirement.hpp"
#include "conformance/wording.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/overhearer.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// A program broke a requirement of role host.
struct Offence {
  Instant time{};
  std::string_view requirement;
  std::string what;  ///< one sentence: what it did, with the numbers
};

/// What an offence rests on beside bytes: when they were seen, since when that counts, and by how
/// much a time was too long. Where nobody looked in between for that long it proves nothing.
struct Timing {
  Instant since{};
  Duration beyond{};  ///< zero: any look that was missed spoils it, as of an order or a short time
};

/// Takes what is found out about a program.
class Complain {
 public:
  /// Whether it is taken for an offence, and not in doubt.
  using Take = std::function<bool(std::string_view requirement, std::string what,
                                  const std::optional<Timing>& timing)>;
  using Occasion = std::function<void(std::string_view what)>;

  Complain(Take take, Occasion occasion) : take_{std::move(take)}, occasion_{std::move(occasion)} {}

  /// An offence: the requirement's id, and what the program did, in one sentence.
  void operator()(std::string_view requirement, std::string what) const {
    take_(requirement, std::move(what), timing_);
  }
  /// Whether it was taken for one, and not in doubt.
  bool operator()(std::string_view requirement, std::string what, const Timing& timing) const {
    return take_(requirement, std::move(what), timing);
  }
  /// The same, for what rests on times where nothing else is said.
  [[nodiscard]] Complain resting_on(const Timing& timing) const {
    auto other = *this;
    other.timing_ = timing;
    return other;
  }
  /// The program did what requirements are about: `Requirement::occasion`, or the id of one.
  void occasion(std::string_view what) const { occasion_(what); }

 private:
  Take take_;
  Occasion occasion_;
  std::optional<Timing> timing_;
};

/// Judges the program at the other end of a device's link by what passes both ways, without any
/// I/O. Times never decrease. One for each session of a device, from its power-up.
class ProgramChecker {
 public:
  ProgramChecker() = default;
  ProgramChecker(const ProgramChecker&) = delete;
  ProgramChecker& operator=(const ProgramChecker&) = delete;
  virtual ~ProgramChecker() = default;

  virtual void to_device(Instant time, Bytes bytes) = 0;
  virtual void from_device(Instant time, Bytes bytes) = 0;
  /// Of a server, instead of the two above. Who does not tell connections apart hears the bytes of
  /// all of them.
  virtual void on_connection(const ConnectionEvent& event) {
    using Kind = ConnectionEvent::Kind;
    if (event.kind == Kind::kToServer) to_device(event.time, event.bytes);
    if (event.kind == Kind::kFromServer) from_device(event.time, event.bytes);
  }
  /// Nothing has passed until now.
  virtual void wait_until(Instant /*time*/) {}
  /// Nothing more will come.
  virtual void finish(Instant time) = 0;

  /// Whoever shows it all this did not look between these times: what came then is shown
  /// afterwards, and what was sent then came late. Times never decrease.
  void overlook(Instant from, Instant to);
  [[nodiscard]] Duration overlooked() const noexcept { return overlooked_; }

  /// Whole messages that the program has sent.
  [[nodiscard]] virtual std::size_t messages() const noexcept = 0;
  /// Whether the program did anything by which it could break that.
  [[nodiscard]] bool had_occasion(const Requirement& requirement) const;

  /// What was found since the last call, oldest first.
  [[nodiscard]] std::vector<Offence> take_offences() { return std::exchange(offences_, {}); }
  /// Whether something looked like an offence of that, but could as well come of looks that were
  /// missed.
  [[nodiscard]] bool is_in_doubt(std::string_view requirement) const {
    return doubts_.contains(requirement);
  }

 protected:
  Instant now_{};  ///< of what it is shown
  /// An offence now.
  const Complain complain_{
      [this](std::string_view requirement, std::string what, const std::optional<Timing>& timing) {
        return take(requirement, std::move(what), timing);
      },
      [this](std::string_view what) { occasions_.insert(what); }};

 private:
  struct Span {
    Instant from{};
    Instant to{};
  };

  bool take(std::string_view requirement, std::string what, const std::optional<Timing>& timing);
  [[nodiscard]] Duration overlooked_since(Instant since) const noexcept;

  std::vector<Offence> offences_;
  std::set<std::string_view> doubts_;     ///< ids
  std::set<std::string_view> occasions_;  ///< as `Complain` is told of them
  std::deque<Span> spans_;                ///< that were overlooked, or too soon after that
  Duration overlooked_{};
};

/// What a link adds to the times at which a program's bytes are seen; zero in virtual time.
struct LinkNoise {
  Duration most{};
};

/// What is demanded of programs that talk to a device, and who judges it.
struct ProgramCheckEntry {
  std::string_view device;
  std::span<const Requirement> (*requirements)() noexcept;
  std::unique_ptr<ProgramChecker> (*make)(const LinkNoise& noise);
  Document document{};  ///< none: reports name no place
};

template <class Checker>
[[nodiscard]] std::unique_ptr<ProgramChecker> make_checker(const LinkNoise& noise) {
  return std::make_unique<Checker>(noise);
}

/// A demand on programs. `occasion`: without which it says nothing about one; any message if empty.
consteval Requirement of_host(std::string_view id, Level level, std::string_view text,
                              std::string_view source, std::string_view occasion = {}) {
  return {.id = id,
          .level = level,
          .text = text,
          .source = source,
          .role = Role::kHost,
          .occasion = occasion};
}

}  // namespace armjig
