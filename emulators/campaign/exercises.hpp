// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "emulators/campaign/repertoire.hpp"

namespace armjig::campaign {

/// What can be tried with a message, each as a script that begins where the message is worth
/// looking at. An empty script: there is nothing of the kind on this link.
class Exercises {
 public:
  /// Both outlive this.
  Exercises(const Material& material, const Repertoire& repertoire)
      : material_{material}, repertoire_{repertoire} {}

  /// Each kind of message after it, apart and in one piece.
  [[nodiscard]] Script pairs(const Setting& setting) const;
  /// It, again and again; on a bus with something that was chosen before read after each.
  [[nodiscard]] Script some_copies(const Setting& setting) const;
  [[nodiscard]] Script many_copies(const Setting& setting) const;
  /// With another last byte, which no checksum has.
  [[nodiscard]] Script spoiled_copies(const Setting& setting) const;
  /// With each value of a checksum of one byte.
  [[nodiscard]] Script sums(const Setting& setting) const;
  [[nodiscard]] Script lengths(const Setting& setting) const;
  [[nodiscard]] Script odd_bytes(const Setting& setting) const;
  /// Its bytes in pieces of each size.
  [[nodiscard]] Script sizes(const Setting& setting) const;
  [[nodiscard]] Script long_gap(const Setting& setting) const;
  [[nodiscard]] Script values(const Setting& setting, const Field& field) const;
  // What comes of it is watched for longer than live rules let answers be early or late.
  [[nodiscard]] Script watched_lengths(const Setting& setting) const;
  [[nodiscard]] Script watched_pairs(const Setting& setting) const;
  [[nodiscard]] Script watched_values(const Setting& setting, const Field& field) const;

  /// Not a field that is always the same, or is made right again.
  [[nodiscard]] bool can_choose(const Setting& setting, const Field& field) const;

 private:
  [[nodiscard]] Script with(const Setting& setting, const Field& field, std::int64_t number) const;
  [[nodiscard]] Script with_bits(const Setting& setting, const Field& field,
                                 std::int64_t bits) const;
  [[nodiscard]] bool can_be_watched(const Setting& setting) const;
  [[nodiscard]] bool strays(const Script& script) const;
  void add_watched(Script& body, const Script& odd) const;
  void look(Script& body, std::size_t which) const;

  const Material& material_;
  const Repertoire& repertoire_;
};

/// The exchange oftener than a counter of ten bits counts.
[[nodiscard]] Script many_copies_of(const Script& exchange);

}  // namespace armjig::campaign
