// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "emulators/campaign/symptom.hpp"
#include "harness/core/error.hpp"

namespace armjig::campaign {

/// A symptom that is known already.
struct KnownDefect {
  std::string symptom;  ///< as `Symptom::key`; `*` stands for anything
  std::string why;
};

/// A file of known defects (docs/fuzzing.md).
struct Known {
  /// What the model does as the device does it: options as of `emulated:?`; empty: the file does
  /// not say.
  std::string model;
  std::vector<KnownDefect> defects;

  /// Problems: those of `TomlTable`.
  [[nodiscard]] static Outcome<Known> read(const std::string& path);
  [[nodiscard]] static Outcome<Known> parse(std::string_view text, const std::string& path);

  /// nullptr: it is news.
  [[nodiscard]] const KnownDefect* find(const Symptom& symptom) const;
};

}  // namespace armjig::campaign
