// SPDX-License-Identifier: Apache-2.0
#include "cli/line_editor.hpp"

#include <histedit.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "cli/environment.hpp"

namespace armjig::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kHistorySize = 1000;
/// Pasted text must not keep the caller from its own work.
constexpr int kMostKeysAtOnce = 32;
constexpr auto kClearLine = "\r\033[J";

bool is_key_waiting() {
  pollfd ready{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  return ::poll(&ready, 1, 0) == 1;
}

/// The last word of the line, which may be empty.
std::string_view last_word(std::string_view line) {
  const auto blank = line.find_last_of(" \t");
  return blank == std::string_view::npos ? line : line.substr(blank + 1);
}

std::string common_start(const std::vector<std::string>& words) {
  std::string start = words.front();
  for (const auto& word : words) {
    const auto [end, _] = std::ranges::mismatch(start, word);
    start.erase(end, start.end());
  }
  return start;
}

}  // namespace

/// libedit asks for keys through `read_key`, and that is where everything else happens meanwhile.
class LineEditor::Editor {
 public:
  Editor(Complete complete, std::string history_path)
      : complete_{std::move(complete)},
        history_path_{std::move(history_path)},
        line_{::el_init_fd("armjig", stdin, stdout, stderr, STDIN_FILENO, STDOUT_FILENO,
                           STDERR_FILENO)},
        history_{::history_init()} {
    ::el_set(line_, EL_CLIENTDATA, this);
    ::el_set(line_, EL_PROMPT, &Editor::prompt_of);
    ::el_set(line_, EL_EDITOR, "emacs");
    ::el_set(line_, EL_HIST, ::history, history_);
    ::el_set(line_, EL_GETCFN, &Editor::read_key);
    // Of narrow names libedit keeps copies that it never gives back.
    ::el_wset(line_, EL_ADDFN, L"armjig-complete", L"completes a word", &Editor::complete_word);
    ::el_set(line_, EL_BIND, "^I", "armjig-complete", nullptr);
    HistEvent event{};
    ::history(history_, &event, H_SETSIZE, kHistorySize);
    ::history(history_, &event, H_SETUNIQUE, 1);
    if (!history_path_.empty()) ::history(history_, &event, H_LOAD, history_path_.c_str());
  }
  Editor(const Editor&) = delete;
  Editor& operator=(const Editor&) = delete;
  ~Editor() {
    save_history();
    ::history_end(history_);
    ::el_end(line_);
  }

  std::optional<std::string> read_line(const Meanwhile& meanwhile) {
    meanwhile_ = &meanwhile;
    is_dropped_ = false;
    int size = 0;
    // libedit shows the prompt first, and what is typed until then would still be the terminal's:
    // a Ctrl-D that follows the prompt at once would be lost.
    ::el_set(line_, EL_PREP_TERM, 1);
    const char* const text = ::el_gets(line_, &size);
    meanwhile_ = nullptr;
    if (text == nullptr || size <= 0) {
      std::fputs("\n", stdout);
      return std::nullopt;
    }
    if (is_dropped_) return std::string{};
    std::string line{text, static_cast<std::size_t>(size)};
    while (!line.empty() && (line.back() == '\n' || line.back() == ' ')) line.pop_back();
    if (!line.empty()) remember(line);
    return line;
  }

  void set_prompt(const std::string& prompt) {
    if (prompt == prompt_) return;
    prompt_ = prompt;
    if (meanwhile_ == nullptr) return;
    std::fputs(kClearLine, stdout);
    ::el_set(line_, EL_REFRESH);
  }

  void print(std::string_view text) {
    if (meanwhile_ != nullptr) std::fputs(kClearLine, stdout);
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
    if (meanwhile_ != nullptr) ::el_set(line_, EL_REFRESH);
  }

 private:
  static Editor& self(EditLine* line) {
    void* data = nullptr;
    ::el_get(line, EL_CLIENTDATA, &data);
    return *static_cast<Editor*>(data);
  }

  // libedit takes it for a string that may be changed, but does not.
  static char* prompt_of(EditLine* line) { return self(line).prompt_.data(); }

  static int read_key(EditLine* line, wchar_t* key) { return self(line).wait_for_key(*key); }

  static unsigned char complete_word(EditLine* line, int /*key*/) {
    return self(line).complete_here();
  }

  /// 1: a key; 0: the end of the input; -1: reading ends.
  int wait_for_key(wchar_t& key) {
    for (;;) {
      if (keys_in_a_row_ < kMostKeysAtOnce && is_key_waiting()) {
        ++keys_in_a_row_;
        unsigned char byte{};
        if (::read(STDIN_FILENO, &byte, 1) != 1) return 0;
        key = byte;
        return 1;
      }
      keys_in_a_row_ = 0;
      follow_size();
      switch ((*meanwhile_)()) {
        case Wish::kGoOn:
          break;
        case Wish::kDropLine:
          is_dropped_ = true;
          key = L'\n';
          return 1;
        case Wish::kEnd:
          return -1;
      }
    }
  }

  void follow_size() {
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == columns_) return;
    if (columns_ != 0) ::el_resize(line_);
    columns_ = size.ws_col;
  }

  unsigned char complete_here() {
    const auto* const info = ::el_line(line_);
    const std::string_view typed{info->buffer,
                                 static_cast<std::size_t>(info->cursor - info->buffer)};
    const auto word = last_word(typed);
    auto candidates = complete_(typed);
    std::erase_if(candidates, [word](const auto& one) { return !one.starts_with(word); });
    if (candidates.empty()) return CC_REFRESH_BEEP;
    const auto more = common_start(candidates).substr(word.size());
    if (!more.empty()) {
      ::el_insertstr(line_, more.c_str());
      return CC_REFRESH;
    }
    std::string list;
    for (const auto& candidate : candidates) list += candidate + ' ';
    print(list + '\n');
    return CC_REFRESH;
  }

  void remember(const std::string& line) {
    HistEvent event{};
    ::history(history_, &event, H_ENTER, line.c_str());
    has_new_history_ = true;
  }

  void save_history() {
    if (history_path_.empty() || !has_new_history_) return;
    std::error_code ignored;
    fs::create_directories(fs::path{history_path_}.parent_path(), ignored);
    HistEvent event{};
    ::history(history_, &event, H_SAVE, history_path_.c_str());
  }

  Complete complete_;
  std::string history_path_;
  EditLine* line_;
  History* history_;
  std::string prompt_;
  const Meanwhile* meanwhile_ = nullptr;  ///< while a line is being read
  bool is_dropped_ = false;
  bool has_new_history_ = false;
  int keys_in_a_row_ = 0;
  unsigned short columns_ = 0;
};

LineEditor::LineEditor(Complete complete, std::string history_file)
    : editor_{std::make_unique<Editor>(std::move(complete), std::move(history_file))} {}
LineEditor::~LineEditor() = default;

std::optional<std::string> LineEditor::read_line(const Meanwhile& meanwhile) {
  return editor_->read_line(meanwhile);
}
void LineEditor::set_prompt(const std::string& prompt) { editor_->set_prompt(prompt); }
void LineEditor::print(std::string_view text) { editor_->print(text); }

std::string history_file() {
  const std::string state{environment("XDG_STATE_HOME")};
  if (!state.empty()) return state + "/armjig/history";
  const std::string home{environment("HOME")};
  return home.empty() ? "" : home + "/.local/state/armjig/history";
}

}  // namespace armjig::cli
