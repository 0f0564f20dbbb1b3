// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/compare/recording_diff.hpp"
#include "harness/core/error.hpp"
#include "harness/core/option.hpp"
#include "harness/wire/dissector.hpp"

/// The options of an emulated device from a recording of a board like it: one figure after the
/// other, each from what depends on it alone.
namespace armjig {

/// What a recording has, beside what an emulated device says to the same host.
struct TalkReplay {
  RecordedMessages recorded;
  RecordedMessages emulated;
};

/// A recording, as those who estimate see it.
struct FitTalk {
  struct Said {
    std::uint32_t id{};  ///< of the connection or the address
    Message message;
  };

  std::vector<Said> said;  ///< in both directions, in order of time
  /// What a device with these options, and no others, says. Problems: it cannot be played.
  std::function<Outcome<TalkReplay>(const DeviceOptions& options)> play;
};

/// What is known of a number: `least <= value <= most`.
struct FigureEstimate {
  std::string part{};  ///< of a figure that has several: `j1`; empty: it is all
  double value{};
  double least{};
  double most{};
};

/// What a recording tells of a figure.
struct FigureAnswer {
  std::string value{};                    ///< as the option is written; empty: it cannot be told
  std::vector<FigureEstimate> estimates;  ///< what is known of it; none of what is a word
  std::string basis;                      ///< what it rests on, or why it is not told
};

/// A figure that a board has of its own.
struct FitFigure {
  std::string_view option;  ///< of the emulated device
  std::string_view unit{};
  /// `so_far` are the options that earlier figures gave. Problems: those of `FitTalk::play`.
  /// nullptr: no recording tells it.
  Outcome<FigureAnswer> (*estimate)(const FitTalk& talk, const DeviceOptions& so_far){};
  std::string_view untold{};  ///< why no recording does
};

struct FittedFigure {
  FitFigure figure;
  FigureAnswer answer;
};

/// What came of all figures, in their order.
struct Fit {
  DeviceOptions options;
  std::vector<FittedFigure> figures;
};

/// Estimates one figure after the other, each with the options that those before it gave.
[[nodiscard]] Outcome<Fit> fit(std::span<const FitFigure> figures, const FitTalk& talk);

// What estimates are made of.

/// One figure that is known up to `error`, and what tells it.
[[nodiscard]] FigureAnswer answer_within(double value, double error, std::string basis);

/// The number with the fewest decimals, six at most, between two; near their middle.
[[nodiscard]] std::string roundest(double least, double most);

/// `options` with one more, or another value of it.
[[nodiscard]] DeviceOptions with(DeviceOptions options, std::string_view name, std::string value);

/// A span of a number in which a replay is best: where its score is least.
struct Valley {
  double least{};
  double most{};
  double score{};
  double worst_score{};  ///< of all that were tried: the same as `score` if nothing depends on it
};

/// Looks at some two dozen values between `least` and `most`, then more closely where the score is
/// least, until they are `resolution` apart. Right if there is one valley, wider than the first
/// grid. `is_geometric`: by equal factors; `least > 0` then.
struct ValleySearch {
  double least{};
  double most{};
  double resolution = 1;
  bool is_geometric = false;

  [[nodiscard]] Outcome<Valley> find(
      const std::function<Outcome<double>(double value)>& score) const;
};

/// Which of two or more words fits best: the one with which the fewest messages differ by more than
/// `tolerance` in time. Not told if that is the same for all.
[[nodiscard]] Outcome<FigureAnswer> choose_word(const FitTalk& talk, const DeviceOptions& so_far,
                                                std::string_view option,
                                                std::span<const std::string_view> words,
                                                Duration tolerance);

/// Calls `use(recorded, emulated)` for the messages of the device in each lane, the first with the
/// first and so on, as long as they are of one kind; those named `passed_over` are not there. How
/// many recorded ones had no partner.
std::size_t for_each_pair(const TalkReplay& replay,
                          const std::function<void(const RecordedMessage& recorded,
                                                   const RecordedMessage& emulated)>& use,
                          std::string_view passed_over = {});

}  // namespace armjig
