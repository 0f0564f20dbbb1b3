// SPDX-License-Identifier: Apache-2.0
#include "harness/mealy/drawing.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/mealy/machines.hpp"

namespace armjig::mealy {
namespace {

/// A turnstile that keeps the second coin.
Drawing wrong_turnstile() {
  auto wrong = turnstile();
  wrong.states[1].steps[0].said = "<gulp>";
  auto comparison = compare(wrong, turnstile());
  return {"a \"turnstile\"", std::move(wrong), std::move(comparison)};
}

bool has(const std::string& text, std::string_view part) { return text.find(part) != text.npos; }

TEST(Drawing, IsADigraphForDot) {
  const auto drawing = wrong_turnstile();
  const auto text = to_dot(std::span{&drawing, 1});
  EXPECT_TRUE(has(text, R"(digraph "a \"turnstile\"" {)")) << text;
  EXPECT_TRUE(has(text, R"(s0 -> s1 [label="coin / clicks"];)")) << text;
  EXPECT_TRUE(has(text, R"(s0 [label="shut\npush / nothing"];)")) << text;
  EXPECT_TRUE(has(text, R"(s1 -> s1 [label="coin / <gulp>", color=red, fontcolor=red];)")) << text;
}

TEST(Drawing, IsAPictureWithHarmlessWords) {
  const auto drawing = wrong_turnstile();
  for (const auto& text : {to_svg(std::span{&drawing, 1}), to_html(std::span{&drawing, 1})}) {
    EXPECT_TRUE(has(text, "<svg xmlns=")) << text;
    EXPECT_TRUE(has(text, "coin / &lt;gulp&gt;")) << text;
    EXPECT_FALSE(has(text, "<gulp>")) << text;
  }
}

TEST(Drawing, IsJson) {
  const auto drawing = wrong_turnstile();
  const auto json = nlohmann::json::parse(to_json(std::span{&drawing, 1}));
  const auto& machine = json["machines"][0];
  EXPECT_EQ(machine["states"][0]["steps"]["coin"]["to"], "open");
  EXPECT_EQ(machine["deviations"][0]["shown_by"], (std::vector<std::string>{"coin", "coin"}));
}

TEST(Drawing, FormIsToldByTheEndOfAName) {
  EXPECT_NE(drawing_form_of("machine.svg"), nullptr);
  EXPECT_EQ(drawing_form_of("machine.png"), nullptr);
  EXPECT_EQ(drawing_form_of(""), nullptr);
}

}  // namespace
}  // namespace armjig::mealy
