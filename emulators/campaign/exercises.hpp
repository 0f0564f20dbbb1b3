// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

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
  /// With another last byte, which no checksum has; where there is none, on a stream only.
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

  // Of all fields at once.
  /// All that can be chosen, with other numbers each time: each byte has had each value then, each
  /// field each edge.
  [[nodiscard]] Script all_fields(const Setting& setting) const;
  /// Each of its fields that is a code or has bits at each value that means something, some times
  /// on end, with other numbers in the others.
  [[nodiscard]] Script held_codes(const Setting& setting) const;
  /// Each kind of message after it, when its fields were as large as can be, and when it was
  /// refused.
  [[nodiscard]] Script mixed_pairs(const Setting& setting) const;
  /// The forms that sessions have it in, also with odd numbers in all of its floats.
  [[nodiscard]] Script variants(const Setting& setting) const;
  /// Its floats at many small values, with time for a tick after each.
  [[nodiscard]] Script sweep(const Setting& setting) const;
  /// With each other number in place of that of the bytes which follow, and as many bytes.
  [[nodiscard]] Script false_lengths(const Setting& setting) const;
  /// On a bus: each byte that a message may begin with, alone, and a read after it.
  [[nodiscard]] Script all_codes(const Setting& setting) const;
  /// On a bus: each two messages that ask as one, and a read after it.
  [[nodiscard]] Script two_codes(const Setting& setting) const;
  /// The bytes that begin or end messages, at each place in it.
  [[nodiscard]] Script marked(const Setting& setting) const;
  /// On a bus: what was chosen once is read again and again, also as it changes.
  [[nodiscard]] Script reads_again(const Setting& setting) const;
  /// On a bus: cut short, again and again, and with each last byte.
  [[nodiscard]] Script cut_copies(const Setting& setting) const;

  // Of several messages, in the state where this one is looked at.
  /// All sequences of three kinds, or of three forms of some.
  [[nodiscard]] Script sequences(const Setting& setting) const;
  /// The same, some at a time in one piece.
  [[nodiscard]] Script bursts(const Setting& setting) const;

  /// Each sequence of three kinds, the most frequent first, and each of two in one piece, and then
  /// for a while what moves most: it tells what the device has become, which its answers may not.
  [[nodiscard]] std::vector<Script> told_sequences() const;

  // Of lines.
  /// Each kind of line with each byte up to its first number wrong, or missing.
  [[nodiscard]] Script misspelt(const Setting& setting) const;
  /// Several in one piece, of which two are odd: by their ends, their case, or as nothing.
  [[nodiscard]] Script in_one_segment(const Setting& setting) const;
  /// Each kind of line with each kind of blank at each place where a piece of it begins or ends.
  [[nodiscard]] Script blanks(const Setting& setting) const;
  /// Twice, in two segments of each size, and in many small ones.
  [[nodiscard]] Script cut_across(const Setting& setting) const;
  /// By a client that leaves in the middle of it, before it comes from another one.
  [[nodiscard]] Script half_lines(const Setting& setting) const;
  /// As long as lines of each length, by what means nothing.
  [[nodiscard]] Script padded(const Setting& setting) const;
  /// Two odd bytes at its end.
  [[nodiscard]] Script odd_ends(const Setting& setting) const;
  /// After many odd bytes that are alike, or many ends of lines.
  [[nodiscard]] Script after_runs(const Setting& setting) const;

  /// With odd numbers in the first piece that is one.
  [[nodiscard]] Script odd_numbers(const Setting& setting) const;

  /// Not a field that is always the same, or is made right again.
  [[nodiscard]] bool can_choose(const Setting& setting, const Field& field) const;

 private:
  [[nodiscard]] Script with(const Setting& setting, const Field& field, std::int64_t number) const;
  [[nodiscard]] Script with_bits(const Setting& setting, const Field& field,
                                 std::int64_t bits) const;
  [[nodiscard]] Script with_message(const Setting& setting, Bytes raw) const;
  /// Whether its last byte is a checksum.
  [[nodiscard]] bool has_sum(const Setting& setting) const;
  [[nodiscard]] bool can_be_watched(const Setting& setting) const;
  [[nodiscard]] bool strays(const Script& script) const;
  void add_watched(Script& body, const Script& odd) const;
  void look(Script& body, std::size_t which) const;
  /// Fields that can be chosen and leave the message of that kind and form.
  [[nodiscard]] std::vector<Field> free_fields(const Setting& setting) const;
  /// With a number for each field; smaller ones where the guard would refuse it. Empty: it would
  /// refuse these, too.
  using NumberOf = std::function<std::int64_t(const Field& field)>;
  [[nodiscard]] Script with_all(const Setting& setting, const std::vector<Field>& fields,
                                const NumberOf& number_of) const;
  [[nodiscard]] std::vector<Script> refused_forms(const Setting& setting) const;
  [[nodiscard]] std::vector<Script> symbols(const Setting& setting) const;
  void add_apart(Script& body, const Script& exchange) const;
  void add_told(Script& body, const Setting& setting, const Script& exchange) const;

  const Material& material_;
  const Repertoire& repertoire_;
};

/// The exchange oftener than a counter of ten bits counts.
[[nodiscard]] Script many_copies_of(const Script& exchange);

}  // namespace armjig::campaign
