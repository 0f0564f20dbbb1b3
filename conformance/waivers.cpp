// SPDX-License-Identifier: Apache-2.0
#include "conformance/waivers.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "harness/core/nesting.hpp"
#include "harness/files/user_file.hpp"

namespace armjig {
namespace {

using Json = nlohmann::json;
using Date = std::chrono::year_month_day;

constexpr auto kSchema = "armjig.waivers/1";

/// `2027-01-31`, nothing else.
std::optional<Date> parse_date(const std::string& text) {
  int year{};
  unsigned month{};
  unsigned day{};
  int used{};
  if (std::sscanf(text.c_str(), "%4d-%2u-%2u%n", &year, &month, &day, &used) != 3) {
    return std::nullopt;
  }
  const Date date{std::chrono::year{year}, std::chrono::month{month}, std::chrono::day{day}};
  const bool is_whole = static_cast<std::size_t>(used) == text.size() && to_string(date) == text;
  return is_whole && date.ok() ? std::optional{date} : std::nullopt;
}

std::string text_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

class Reader {
 public:
  Reader(const Suite& suite, Date today, const std::string& where)
      : suite_{suite}, today_{today}, where_{where} {}

  Outcome<std::vector<Waiver>> read(std::string_view text) {
    if (is_too_deep(text)) return bad("", std::string{kTooDeep});
    const auto json = Json::parse(text, nullptr, false);
    if (!json.is_object() || text_at(json, "schema") != kSchema) {
      return bad("", fmt::format("write {{\"schema\": \"{}\", \"waivers\": [...]}}", kSchema));
    }
    const auto list = json.find("waivers");
    if (list == json.end() || !list->is_array()) return bad("", "it needs a list \"waivers\"");
    std::vector<Waiver> waivers;
    for (const auto& entry : *list) {
      auto waiver = read_entry(entry, waivers);
      if (!waiver) return tl::unexpected{waiver.error()};
      waivers.push_back(*std::move(waiver));
    }
    return waivers;
  }

 private:
  [[nodiscard]] tl::unexpected<Problem> bad(const std::string& name, std::string hint) const {
    return problem(ErrorCode::kMalformed, name.empty() ? where_ : where_ + ", " + name,
                   std::move(hint));
  }

  [[nodiscard]] Outcome<Waiver> read_entry(const Json& entry,
                                           const std::vector<Waiver>& before) const {
    if (!entry.is_object()) return bad("", "every waiver is an object");
    Waiver waiver{text_at(entry, "requirement"), text_at(entry, "reason"), {}};
    const auto& name = waiver.requirement;
    if (find_requirement(suite_, name) == nullptr) {
      return bad(fmt::format("requirement '{}'", name), "--list shows those of this device");
    }
    if (std::ranges::find(before, name, &Waiver::requirement) != before.end()) {
      return bad(name, "it is excused twice");
    }
    if (waiver.reason.empty()) return bad(name, "it needs a \"reason\"");
    const auto date = parse_date(text_at(entry, "expires"));
    if (!date) return bad(name, R"(it needs a date, as in "expires": "2027-01-31")");
    if (*date < today_) {
      return bad(name,
                 fmt::format("expired on {}; mend the device or argue anew", to_string(*date)));
    }
    waiver.expires = *date;
    return waiver;
  }

  const Suite& suite_;
  Date today_;
  const std::string& where_;
};

}  // namespace

Outcome<std::vector<Waiver>> parse_waivers(std::string_view text, const Suite& suite, Date today,
                                           const std::string& where) {
  return Reader{suite, today, where}.read(text);
}

Outcome<std::vector<Waiver>> read_waivers(const std::string& path, const Suite& suite, Date today) {
  return read_user_file(path).and_then(
      [&](const std::string& text) { return parse_waivers(text, suite, today, path); });
}

std::string to_string(Date day) {
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()),
                     static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()));
}

}  // namespace armjig
