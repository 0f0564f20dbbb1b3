// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "harness/mealy/deviation.hpp"
#include "harness/mealy/machine.hpp"

namespace armjig::mealy {

/// What is drawn.
struct Drawing {
  std::string title;
  Machine machine;          ///< with the names that are to be read
  Comparison comparison{};  ///< with a documented one; without any nothing is marked
};

/// For `dot` of Graphviz: a digraph for each. What deviates is red. Steps that lead from all states
/// to one and are answered alike are said in that state, those that stay in theirs.
[[nodiscard]] std::string to_dot(std::span<const Drawing> drawings);

/// One below the other, in layers by how many letters lead to a state.
[[nodiscard]] std::string to_svg(std::span<const Drawing> drawings);

/// `armjig.machine/1`: letters, states with the word that leads to them, steps, deviations.
[[nodiscard]] std::string to_json(std::span<const Drawing> drawings);

/// A page that needs no network: what deviates, the drawing, and all steps as a table.
[[nodiscard]] std::string to_html(std::span<const Drawing> drawings);

/// A form of it, by the end of a file's name.
struct DrawingForm {
  std::string_view end;
  std::string (*text_of)(std::span<const Drawing> drawings);
};

/// nullptr: no form has that end.
[[nodiscard]] const DrawingForm* drawing_form_of(std::string_view path) noexcept;

}  // namespace armjig::mealy
