// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace armjig::cli {

/// Lines that a person types on a terminal, with editing, history and completion, while the program
/// goes on with something else. One at a time; for one thread.
class LineEditor {
 public:
  /// What becomes of the line that is being typed.
  enum class Wish : std::uint8_t {
    kGoOn,
    kDropLine,  ///< it is thrown away
    kEnd,       ///< reading ends
  };
  /// Called again and again while somebody may type; keys wait meanwhile, so it should be short.
  using Meanwhile = std::function<Wish()>;

  /// What may stand where the last word of `line` begins, blanks behind included.
  using Complete = std::function<std::vector<std::string>(std::string_view line)>;

  /// The history is read from that file and written to it at the end. Nothing happens if that
  /// cannot be done; an empty path: no history is kept.
  LineEditor(Complete complete, std::string history_file);
  LineEditor(const LineEditor&) = delete;
  LineEditor& operator=(const LineEditor&) = delete;
  ~LineEditor();

  /// The next line without its end; empty if it was dropped. None: Ctrl-D, or `kEnd`.
  [[nodiscard]] std::optional<std::string> read_line(const Meanwhile& meanwhile);

  /// What stands in front of the line; shown at once.
  void set_prompt(const std::string& prompt);

  /// Prints a line or more above the one that is being typed.
  void print(std::string_view text);

 private:
  class Editor;
  std::unique_ptr<Editor> editor_;
};

/// Where a program keeps its history: $XDG_STATE_HOME/armjig/history, or below ~/.local/state.
/// Empty without a home.
[[nodiscard]] std::string history_file();

}  // namespace armjig::cli
