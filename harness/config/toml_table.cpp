// SPDX-License-Identifier: Apache-2.0
#include "harness/config/toml_table.hpp"

#define TOML_HEADER_ONLY 0  // Debian has it as a library
#include <fmt/core.h>
#include <toml++/toml.h>

#include <algorithm>
#include <set>
#include <utility>

#include "harness/core/nesting.hpp"
#include "harness/files/user_file.hpp"

namespace armjig {

struct TomlTable::Part {
  const toml::table* table{};
  std::set<std::string, std::less<>> asked;

  const toml::node* ask(std::string_view key) {
    asked.emplace(key);
    return table->get(key);
  }
};

struct TomlTable::File {
  std::string path;
  toml::table root;
  std::vector<std::shared_ptr<Part>> parts;
  std::optional<Problem> first;

  void note(const toml::source_region& where, std::string hint) {
    if (first) return;
    first = {ErrorCode::kMalformed, fmt::format("{}:{}", path, where.begin.line), std::move(hint)};
  }
};

namespace {

/// As users write it behind `NAME=`; empty for what no option has.
std::string option_value(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto number = node.value_exact<std::int64_t>()) return fmt::format("{}", *number);
  if (const auto number = node.value_exact<double>()) return fmt::format("{}", *number);
  if (const auto is_so = node.value_exact<bool>()) return *is_so ? "yes" : "no";
  return {};
}

/// Whether a key has so many dots that the tables below it would be too deep for whoever frees
/// them. Nothing is lost: keys of ours have none.
bool has_endless_key(std::string_view text) {
  while (!text.empty()) {
    const auto line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const auto key = line.substr(0, line.find_first_of("=#"));
    if (std::ranges::count(key, '.') > static_cast<std::ptrdiff_t>(kDeepestNesting)) return true;
  }
  return false;
}

}  // namespace

TomlTable::TomlTable(std::shared_ptr<File> file, std::shared_ptr<Part> part)
    : file_{std::move(file)}, part_{std::move(part)} {
  file_->parts.push_back(part_);
}

Outcome<TomlTable> TomlTable::read(const std::string& path) {
  return read_user_file(path).and_then([&](const std::string& text) { return parse(text, path); });
}

Outcome<TomlTable> TomlTable::parse(std::string_view text, std::string path) {
  if (has_endless_key(text)) {
    return problem(ErrorCode::kMalformed, std::move(path), std::string{kTooDeep});
  }
  auto file = std::make_shared<File>();
  file->path = std::move(path);
  try {
    file->root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    return problem(ErrorCode::kMalformed,
                   fmt::format("{}:{}", file->path, error.source().begin.line),
                   std::string{error.description()});
  }
  auto part = std::make_shared<Part>(Part{&file->root, {}});
  return TomlTable{std::move(file), std::move(part)};
}

template <class Value, class Read>
std::optional<Value> TomlTable::take(std::string_view key, std::string_view what, Read read) {
  const auto* node = part_->ask(key);
  if (node == nullptr) return std::nullopt;
  std::optional<Value> value = read(*node);
  if (!value) complain(key, fmt::format("{} has to be {}", key, what));
  return value;
}

std::optional<double> TomlTable::number(std::string_view key) {
  return take<double>(key, "a number", [](const toml::node& node) {
    return node.is_number() ? node.value<double>() : std::nullopt;
  });
}

std::optional<std::int64_t> TomlTable::integer(std::string_view key, std::int64_t least,
                                               std::int64_t most) {
  const auto what = fmt::format("an integer from {} to {}", least, most);
  return take<std::int64_t>(key, what, [&](const toml::node& node) {
    const auto value = node.value_exact<std::int64_t>();
    return value && *value >= least && *value <= most ? value : std::nullopt;
  });
}

std::optional<bool> TomlTable::boolean(std::string_view key) {
  return take<bool>(key, "true or false",
                    [](const toml::node& node) { return node.value_exact<bool>(); });
}

std::optional<std::string> TomlTable::text(std::string_view key) {
  return take<std::string>(key, "a text in quotes",
                           [](const toml::node& node) { return node.value_exact<std::string>(); });
}

std::optional<std::vector<double>> TomlTable::numbers(std::string_view key) {
  using Numbers = std::vector<double>;
  return take<Numbers>(key, "a list of numbers", [](const toml::node& node) {
    const auto* array = node.as_array();
    if (array == nullptr) return std::optional<Numbers>{};
    Numbers values;
    for (const auto& element : *array) {
      if (!element.is_number()) return std::optional<Numbers>{};
      values.push_back(*element.value<double>());
    }
    return std::optional{std::move(values)};
  });
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  const auto* node = part_->ask(key);
  std::vector<TomlTable> found;
  if (node == nullptr) return found;
  const auto* array = node->as_array();
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const auto* table = (*array)[i].as_table();
    if (table == nullptr) break;
    found.push_back(TomlTable{file_, std::make_shared<Part>(Part{table, {}})});
  }
  if (array == nullptr || found.size() != array->size()) {
    complain(key, fmt::format("write [[{}]], and the keys of each below it", key));
  }
  return found;
}

Outcome<std::vector<OptionGroup>> TomlTable::groups() {
  std::vector<OptionGroup> groups;
  const auto where = [this](const toml::node& node) {
    return fmt::format("{}:{}", file_->path, node.source().begin.line);
  };
  for (const auto& [kind, array] : *part_->table) {
    for (const auto& part : tables(kind.str())) {
      const auto& table = *part.part_->table;
      auto& group = groups.emplace_back(OptionGroup{std::string{kind.str()}, where(table), {}});
      for (const auto& [key, node] : table) {
        part.part_->asked.emplace(key.str());
        std::string name{key.str()};
        std::ranges::replace(name, '_', '-');
        group.keys.push_back({std::move(name), option_value(node), where(node)});
      }
    }
  }
  return finish().map([&] { return std::move(groups); });
}

bool TomlTable::has(std::string_view key) const { return part_->table->contains(key); }

std::string TomlTable::where() const {
  return fmt::format("{}:{}", file_->path, part_->table->source().begin.line);
}

void TomlTable::complain(std::string_view key, std::string hint) {
  const auto* node = part_->table->get(key);
  file_->note(node == nullptr ? part_->table->source() : node->source(), std::move(hint));
}

Outcome<void> TomlTable::finish() {
  for (const auto& part : file_->parts) {
    for (const auto& [key, node] : *part->table) {
      if (part->asked.contains(key.str())) continue;
      file_->note(key.source(), fmt::format("nothing is known of the key '{}'", key.str()));
    }
  }
  if (file_->first) return tl::unexpected{*file_->first};
  return {};
}

}  // namespace armjig
