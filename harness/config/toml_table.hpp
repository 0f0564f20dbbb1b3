// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/core/option.hpp"

namespace armjig {

/// A table of a TOML file. Whoever reads it asks for all keys that may be there and then calls
/// `finish`, which knows the first mistake: a value of the wrong type or out of range, a key that
/// is missing, a key that nobody asked for. Until then wrong values read as if they were not there.
class TomlTable {
 public:
  /// Problems: `kCannotRead`, `kMalformed`; they name path and line.
  [[nodiscard]] static Outcome<TomlTable> read(const std::string& path);
  /// The same from text in memory; `path` is for messages.
  [[nodiscard]] static Outcome<TomlTable> parse(std::string_view text, std::string path);

  /// Integers are numbers, too; those that are not finite are, if TOML says so (`nan`, `inf`).
  [[nodiscard]] std::optional<double> number(std::string_view key);
  [[nodiscard]] std::optional<std::int64_t> integer(std::string_view key, std::int64_t least,
                                                    std::int64_t most);
  [[nodiscard]] std::optional<bool> boolean(std::string_view key);
  [[nodiscard]] std::optional<std::string> text(std::string_view key);
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key);
  /// The tables of `[[key]]`, in order; none if there are none.
  [[nodiscard]] std::vector<TomlTable> tables(std::string_view key);

  /// All `[[kind]]` tables, by kind, as options: texts, numbers, and booleans as yes and no; `_` in
  /// a key stands for `-`. Nothing else may be in the file. Problems: `kMalformed`.
  [[nodiscard]] Outcome<std::vector<OptionGroup>> groups();

  /// Whether the key is there. Whoever asks for a value need not ask this.
  [[nodiscard]] bool has(std::string_view key) const;
  /// `FILE:LINE` at which this table begins.
  [[nodiscard]] std::string where() const;

  /// Notes that the value of `key` will not do, or that it is missing.
  void complain(std::string_view key, std::string hint);

  /// Of this table and of all that came out of it. Problems: `kMalformed`.
  [[nodiscard]] Outcome<void> finish();

 private:
  struct File;
  struct Part;
  explicit TomlTable(std::shared_ptr<File> file, std::shared_ptr<Part> part);
  /// What `read` makes of the value of `key`. If that is nothing, complains that it has to be
  /// `what`.
  template <class Value, class Read>
  [[nodiscard]] std::optional<Value> take(std::string_view key, std::string_view what, Read read);

  std::shared_ptr<File> file_;
  std::shared_ptr<Part> part_;
};

}  // namespace armjig
