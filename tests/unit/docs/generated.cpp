// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/docs/generated.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <sstream>
#include <utility>

#include "emulators/i2c/bus.hpp"
#include "emulators/kinovazed/defects/defective_server.hpp"
#include "emulators/parol6/arm.hpp"
#include "harness/link/impairment.hpp"
#include "harness/wire/demo/demo.hpp"
#include "harness/wire/kinovazed/fields.hpp"
#include "harness/wire/morap/fields.hpp"
#include "harness/wire/parol6/fields.hpp"
#include "tests/unit/support/devices.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig::docs {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kColumns = 100;

const cli::Device* find(std::string_view name) {
  const auto found = cli::find_device(cli::shipped_devices(), name);
  return found ? *found : nullptr;
}

/// Whether Markdown would take a line that begins with this word for something else than text.
bool would_begin_something(std::string_view word) {
  const auto mark = word.find_first_not_of("0123456789");
  if (mark == std::string_view::npos) return false;
  const bool is_number = mark > 0 && (word.substr(mark) == "." || word.substr(mark) == ")");
  return is_number || word == "-" || word == "+" || word == "*" || word.starts_with('#') ||
         word.starts_with('>');
}

/// Lines of at most `kColumns`, the first one as it is and the others begun with two blanks.
std::string wrapped(const std::string& text) {
  std::istringstream words{text};
  std::string out;
  std::size_t column = 0;
  for (std::string word; words >> word;) {
    const bool fits = column + 1 + word.size() <= kColumns || would_begin_something(word);
    const std::string_view gap = column == 0 ? "" : fits ? " " : "\n  ";
    column = (gap == "\n  " ? 2 : column + gap.size()) + word.size();
    out.append(gap).append(word);
  }
  return out + '\n';
}

/// Who has to obey, and in which profile.
std::string holder_of(const Requirement& one) {
  if (one.role == Role::kHost) return std::string{to_string(one.role)};
  const std::string profiles{to_string(one.profiles)};
  return one.profiles == Profiles::kBoth ? profiles : '`' + profiles + '`';
}

std::string item(const Requirement& one) {
  auto text = fmt::format("- **`{}`** {} ({}; {}; {})", one.id, one.text, to_string(one.level),
                          one.source, holder_of(one));
  if (!one.instead.empty()) text += fmt::format(" Otherwise: `{}`.", one.instead);
  if (!one.unobservable.empty()) text += fmt::format(" *No case: {}.*", one.unobservable);
  return wrapped(text);
}

std::string requirements(const cli::Device& device, std::string_view title) {
  const auto suite = device.suite();
  const auto chapter = std::ranges::find(suite.chapters, title, &Chapter::title);
  if (chapter == suite.chapters.end()) return {};
  std::string text;
  for (const auto& one : chapter->requirements) text += item(one);
  return text;
}

/// Makes `|` harmless in a cell.
std::string cell(std::string_view text) {
  std::string out;
  for (const char letter : text) out += letter == '|' ? "\\|" : std::string{letter};
  return out;
}

std::string row(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const auto& one : cells) text += one.empty() ? " |" : fmt::format(" {} |", cell(one));
  return text + '\n';
}

std::string heading(const std::vector<std::string>& cells) {
  auto text = row(cells) + '|';
  for (std::size_t i = 0; i < cells.size(); ++i) text += "---|";
  return text + '\n';
}

std::string encoding_of(const Field& field) {
  switch (field.encoding) {
    case Encoding::kUnsigned:
    case Encoding::kUnsignedLittle:
      return "unsigned";
    case Encoding::kSigned:
      return "signed";
    case Encoding::kBits:
      return "flags";
    case Encoding::kFloatLittle:
      return "float";
    case Encoding::kCode: {
      std::vector<std::string> names;
      for (const auto& [value, name] : field.values) {
        names.push_back(fmt::format("{} {}", value, name));
      }
      return fmt::format("{}", fmt::join(names, ", "));
    }
    case Encoding::kLiteral:
      break;
  }
  const auto digits = fmt::format("{:0{}X}", field.literal, 2 * field.width);
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) bytes += ' ' + digits.substr(i, 2);
  return '`' + bytes.substr(1) + '`';
}

std::string fields(std::span<const Field> list) {
  auto text = heading({"offset", "size", "field", "encoding", "unit", "meaning"});
  std::string_view meaning;
  for (const auto& field : list) {
    const bool is_same = field.meaning == std::exchange(meaning, field.meaning);
    text += row({std::to_string(field.offset), std::to_string(field.width),
                 fmt::format("`{}`", field.name), encoding_of(field), std::string{field.unit},
                 is_same ? "the same" : std::string{field.meaning}});
  }
  return text;
}

struct MessageFields {
  std::string_view message;
  std::span<const Field> fields;
};

std::vector<MessageFields> messages_of(std::string_view device) {
  if (device == "parol6") {
    return {{"command", parol6::command_fields()}, {"telemetry", parol6::telemetry_fields()}};
  }
  if (device == "demo") {
    return {{"request", demo::request_fields()}, {"reply", demo::reply_fields()}};
  }
  if (device == "kinovazed") return {{"heartbeat", kinovazed::heartbeat_fields()}};
  return {};
}

std::string fields(std::string_view device, std::string_view message) {
  const auto all = messages_of(device);
  const auto found = std::ranges::find(all, message, &MessageFields::message);
  return found == all.end() ? "" : fields(found->fields);
}

std::string flags(std::string_view device) {
  auto text = heading({"byte", "`80`", "`40`", "`20`", "`10`", "`08`", "`04`", "`02`", "`01`"});
  for (const auto& [message, list] : messages_of(device)) {
    for (const auto& field : list) {
      if (field.encoding != Encoding::kBits) continue;
      std::vector<std::string> cells{fmt::format("`{}`", field.name)};
      cells.insert(cells.end(), field.bits.begin(), field.bits.end());
      text += row(cells);
    }
  }
  return text;
}

std::string document_note(bool is_documented) { return is_documented ? "" : "no"; }

/// What follows the identifier of a write.
std::string payload_of(const morap::CommandInfo& command) {
  if (command.payload == morap::Payload::kControllerSet) return "[parameters](#parameters)";
  std::vector<std::string> parts;
  for (const auto& field : morap::write_fields(command).subspan(2)) {
    const auto bytes = fmt::format("{} byte{}", field.width, field.width == 1 ? "" : "s");
    parts.push_back(fmt::format("{}: {}", field.name, field.unit.empty() ? bytes : field.unit));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string morap_commands() {
  auto text = heading({"identifier", "name", "payload", "meaning", "in the document"});
  for (const auto& command : morap::commands()) {
    text += row({std::to_string(static_cast<int>(command.id)), fmt::format("`{}`", command.name),
                 payload_of(command), std::string{command.meaning},
                 document_note(command.is_documented)});
  }
  return text;
}

std::string morap_readings() {
  auto text = heading({"identifier", "name", "bytes", "unit", "meaning", "in the document"});
  constexpr std::array kBytes{"4", "1", "11 to 59"};
  for (const auto& reading : morap::readings()) {
    text +=
        row({std::to_string(static_cast<int>(reading.selector)), fmt::format("`{}`", reading.name),
             kBytes.at(static_cast<std::size_t>(reading.kind)), std::string{reading.unit},
             std::string{reading.meaning}, document_note(reading.is_documented)});
  }
  return text;
}

std::string kinovazed_commands() {
  auto text = heading({"command", "argument", "meaning"});
  for (std::size_t verb = 0; verb < kinovazed::kVerbNames.size(); ++verb) {
    const auto list = kinovazed::command_fields(kinovazed::Verb(verb)).subspan(1);
    std::string name = fmt::format("`{}`", kinovazed::kVerbNames.at(verb));
    if (list.empty()) text += row({name, "", ""});
    for (const auto& field : list) {
      std::vector<std::string_view> words;
      for (const auto& value : field.values) words.push_back(value.name);
      const auto argument =
          words.empty() ? std::string{field.name} : fmt::format("`{}`", fmt::join(words, "`, `"));
      text += row({std::exchange(name, ""), argument, std::string{field.meaning}});
    }
  }
  return text;
}

std::string inputs(std::span<const DeviceInput> all) {
  auto text = heading({"name", "number"});
  for (const auto& [name, values] : all) {
    text += row({fmt::format("`{}`", name), std::string{values}});
  }
  return text;
}

std::ptrdiff_t recordings(std::string_view device) {
  const fs::recursive_directory_iterator files{fs::path{source_dir()} / "captures" / device};
  return std::ranges::count_if(
      files, [](const auto& file) { return file.path().extension() == ".jsonl"; });
}

std::ptrdiff_t requirements(const cli::Device& device, Role role) {
  std::ptrdiff_t number = 0;
  const auto suite = device.suite();
  for (const auto& chapter : suite.chapters) {
    number += std::ranges::count(chapter.requirements, role, &Requirement::role);
  }
  return number;
}

std::string counts() {
  std::vector<std::vector<std::string>> rows{{""},
                                             {"requirements of the device"},
                                             {"requirements of programs that talk to it"},
                                             {"recordings of the real device"}};
  for (const auto* name : {"parol6", "morap", "kinovazed"}) {
    const auto& device = test::device(name);
    rows[0].emplace_back(device.title);
    rows[1].push_back(std::to_string(requirements(device, Role::kDevice)));
    rows[2].push_back(std::to_string(requirements(device, Role::kHost)));
    rows[3].push_back(std::to_string(recordings(name)));
  }
  auto text = heading(rows[0]);
  for (std::size_t i = 1; i < rows.size(); ++i) text += row(rows[i]);
  return text;
}

/// What stands behind the first blank.
std::string_view rest_of(std::string_view text) {
  return text.substr(std::min(text.find(' '), text.size() - 1) + 1);
}

std::string uses(std::string_view folder) {
  const auto prefix = std::string{folder} + '/';
  auto text = heading({"room", "may use"});
  for (const auto& room : rooms()) {
    if (!room.folder.starts_with(folder)) continue;
    std::vector<std::string_view> names;
    for (auto rest = room.uses; !rest.empty(); rest = rest_of(rest)) {
      auto name = rest.substr(0, rest.find(' '));
      if (name.starts_with(prefix)) name.remove_prefix(prefix.size());
      names.push_back(name);
    }
    text += row({fmt::format("`{}`", room.folder), fmt::format("{}", fmt::join(names, ", "))});
  }
  return text;
}

/// Nothing if there is no such part.
std::string part(std::string_view what) {
  if (what == "counts") return counts();
  if (what == "impairments") return "```\n" + impairment_forms() + "```\n";
  const auto rest = rest_of(what);
  if (what.starts_with("uses ")) return uses(rest);
  const auto name = rest.substr(0, rest.find_first_of(" ,"));
  const auto* const device = find(name);
  if (device == nullptr) return {};
  if (what.starts_with("requirements ")) return requirements(*device, rest_of(rest));
  if (what.starts_with("fields ")) return fields(name, rest_of(rest));
  if (what.starts_with("options ")) return to_markdown(device->options());
  if (what == "flags parol6" || what == "flags kinovazed") return flags(name);
  if (what == "inputs parol6") return inputs(parol6::emulation::arm_inputs());
  if (what == "inputs kinovazed") return inputs(kinovazed::emulation::server_inputs());
  if (what == "inputs morap") return inputs(i2c::Bus::inputs());
  if (what == "commands morap") return morap_commands();
  if (what == "commands kinovazed") return kinovazed_commands();
  if (what == "readings morap") return morap_readings();
  return {};
}

constexpr std::string_view kBegin = "\n<!-- generated: ";
constexpr std::string_view kBeginEnd = " -->\n";
constexpr std::string_view kEnd = "\n<!-- end -->";

}  // namespace

std::vector<std::string> pages() {
  std::vector<std::string> found{"README.md", "harness/README.md", "emulators/README.md",
                                 "conformance/README.md"};
  for (const auto& file : fs::recursive_directory_iterator{fs::path{source_dir()} / "docs"}) {
    if (file.path().extension() != ".md") continue;
    found.push_back(fs::relative(file.path(), source_dir()).string());
  }
  return found;
}

std::string read_page(const std::string& path) {
  std::ifstream in{source_dir() + '/' + path, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

std::string renewed(std::string_view page) {
  std::string out;
  for (auto begin = page.find(kBegin); begin != std::string_view::npos; begin = page.find(kBegin)) {
    const auto name = begin + kBegin.size();
    const auto what = page.substr(name, page.find(kBeginEnd, name) - name);
    const auto content = std::min(name + what.size() + kBeginEnd.size(), page.size());
    const auto end = page.find(kEnd, content - 1);
    if (end == std::string_view::npos) return out + fmt::format("??? '{}' has no end\n", what);
    const auto made = part(what);
    out += page.substr(0, content);
    out += made.empty() ? fmt::format("??? nothing is called '{}'\n", what) : made;
    page.remove_prefix(end + 1);
  }
  return out.append(page);
}

}  // namespace armjig::docs
