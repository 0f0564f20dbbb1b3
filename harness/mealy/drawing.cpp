// SPDX-License-Identifier: Apache-2.0
#include "harness/mealy/drawing.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "harness/mealy/steps.hpp"
#include "harness/report/wording.hpp"

namespace armjig::mealy {
namespace {

using wording::html;

std::string in_quotes(std::string_view text) {
  std::string quoted;
  for (const auto letter : wording::line(text)) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  return quoted;
}

std::string colour_of(bool is_marked) { return is_marked ? ", color=red, fontcolor=red" : ""; }

void add_dot(const Drawing& drawing, std::string& text) {
  const auto steps = told(drawing);
  text += fmt::format("digraph \"{}\" {{\n  rankdir=LR;\n  node [shape=box, style=rounded];\n",
                      in_quotes(drawing.title));
  text += "  begin [shape=point];\n  begin -> s0;\n";
  for (std::size_t i = 0; i < drawing.machine.states.size(); ++i) {
    auto label = in_quotes(drawing.machine.states[i].name);
    for (const auto& note : steps.notes[i]) label += "\\n" + in_quotes(note);
    text += fmt::format("  s{} [label=\"{}\"{}];\n", i, label, colour_of(steps.is_marked[i]));
  }
  for (const auto& arrow : steps.arrows) {
    std::string label;
    for (const auto& line : arrow.lines) label += (label.empty() ? "" : "\\n") + in_quotes(line);
    text += fmt::format("  s{} -> s{} [label=\"{}\"{}];\n", arrow.from, arrow.to, label,
                        colour_of(arrow.is_marked));
  }
  text += "}\n";
}

nlohmann::ordered_json json_of(const Drawing& drawing) {
  using Json = nlohmann::ordered_json;
  const auto& machine = drawing.machine;
  const auto word_of = [&](const Word& word) {
    auto letters = Json::array();
    for (const auto letter : word) letters.push_back(machine.letters[letter]);
    return letters;
  };
  Json json{{"title", drawing.title}, {"letters", machine.letters}, {"states", Json::array()}};
  for (std::size_t i = 0; i < machine.states.size(); ++i) {
    const auto& state = machine.states[i];
    Json steps = Json::object();
    for (std::size_t j = 0; j < machine.letters.size(); ++j) {
      const auto& step = state.steps[j];
      steps[machine.letters[j]] = {{"said", step.said}, {"to", machine.states[step.to].name}};
    }
    Json one{{"name", state.name}, {"access", word_of(state.access)}, {"steps", std::move(steps)}};
    const auto& documented = drawing.comparison.documented;
    if (!documented.empty()) one["documented"] = documented[i].has_value();
    json["states"].push_back(std::move(one));
  }
  json["deviations"] = Json::array();
  for (const auto& one : drawing.comparison.deviations) {
    json["deviations"].push_back({{"name", one.name},
                                  {"sentence", one.sentence},
                                  {"documented", one.documented},
                                  {"learned", one.learned},
                                  {"shown_by", word_of(one.shown_by)}});
  }
  return json;
}

void add_table(const Machine& machine, const Comparison& comparison, std::string& text) {
  text += "<table><tr><th>state</th>";
  for (const auto& letter : machine.letters) text += fmt::format("<th>{}</th>", html(letter));
  text += "</tr>\n";
  for (std::size_t i = 0; i < machine.states.size(); ++i) {
    text += fmt::format("<tr><th>{}</th>", html(machine.states[i].name));
    for (std::size_t j = 0; j < machine.letters.size(); ++j) {
      const auto& step = machine.states[i].steps[j];
      const bool is_marked = comparison.steps.contains({i, static_cast<Letter>(j)});
      text += fmt::format("<td{}>{}{}</td>", is_marked ? " class=\"off\"" : "",
                          html(said_in_words(step.said)),
                          step.to == i ? "" : "<br>" + html(machine.states[step.to].name));
    }
    text += "</tr>\n";
  }
  text += "</table>\n";
}

void add_page(const Drawing& drawing, std::string& text) {
  text += fmt::format("<h2>{}</h2>\n<p>{} states, {} letters.</p>\n", html(drawing.title),
                      drawing.machine.states.size(), drawing.machine.letters.size());
  if (!drawing.comparison.deviations.empty()) text += "<ul>\n";
  for (const auto& one : drawing.comparison.deviations) {
    text += fmt::format("<li>{}; documented: {}. Shown by: {}</li>\n", html(one.sentence),
                        html(one.documented), html(drawing.machine.words_of(one.shown_by)));
  }
  if (!drawing.comparison.deviations.empty()) text += "</ul>\n";
  text += to_svg(std::span{&drawing, 1});
  add_table(drawing.machine, drawing.comparison, text);
}

}  // namespace

std::string to_dot(std::span<const Drawing> drawings) {
  std::string text;
  for (const auto& drawing : drawings) add_dot(drawing, text);
  return text;
}

std::string to_json(std::span<const Drawing> drawings) {
  using Json = nlohmann::ordered_json;
  Json json{{"format", "armjig.machine/1"}, {"machines", Json::array()}};
  for (const auto& drawing : drawings) json["machines"].push_back(json_of(drawing));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_html(std::span<const Drawing> drawings) {
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>machines</title>\n"
      "<style>body{font-family:sans-serif;margin:2em}table{border-collapse:collapse;font-size:85%}"
      "td,th{border:1px solid #bbb;padding:.2em .5em;text-align:left;vertical-align:top}"
      ".off{background:#fdd}</style></head><body>\n";
  for (const auto& drawing : drawings) add_page(drawing, text);
  return text + "</body></html>\n";
}

const DrawingForm* drawing_form_of(std::string_view path) noexcept {
  static constexpr std::array kForms{DrawingForm{".dot", to_dot}, DrawingForm{".svg", to_svg},
                                     DrawingForm{".json", to_json}, DrawingForm{".html", to_html}};
  const auto form =
      std::ranges::find_if(kForms, [&](const DrawingForm& one) { return path.ends_with(one.end); });
  return form == kForms.end() ? nullptr : &*form;
}

}  // namespace armjig::mealy
