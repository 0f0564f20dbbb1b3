// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/questions.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "emulators/campaign/talk.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

/// A letter begins so much before anything is done, so that an answer cannot come at the moment at
/// which two letters meet.
constexpr Duration kLead = 1ms;

/// Of what is done, beside what letters leave for an answer.
constexpr Duration kMostLateness = 15ms;

/// What came from the device, and ends of connections, in order of time.
std::vector<Message> messages_heard(const RecordedMessages& said) {
  std::vector<Message> messages;
  for (const auto& [lane, recorded] : said.lanes()) {
    for (const auto& one : recorded) {
      if (one.message.direction == Direction::kFromDevice) messages.push_back(one.message);
    }
  }
  std::ranges::stable_sort(messages, {}, &Message::time);
  return messages;
}

/// When the device ended the connection; the end of time if it did not.
Instant end_of(const std::vector<KeptRecord>& said) {
  const auto end = std::ranges::find_if(said, [](const KeptRecord& record) {
    return record.kind == LinkKind::kEvents && text_in(record, "text").starts_with("device-");
  });
  return end == said.end() ? Instant::max() : end->time;
}

/// Until then answers are listened for.
KeptRecord end_at(Instant time) {
  return {.time = time, .kind = LinkKind::kEvents, .details = R"("dir":"advance")"};
}

}  // namespace

Questions::Questions(Stage& stage, const Learnable& machine, MakeDissector make_dissector,
                     Duration quiet)
    : stage_{stage},
      machine_{machine},
      make_dissector_{make_dissector},
      quiet_{quiet > Duration{} ? quiet : machine.quiet} {}

Outcome<mealy::Said> Questions::ask(const mealy::Word& word) {
  // Letters that came late came close together, and what was said to one may have been said in the
  // time of the next. Nobody knows then, so the word is asked again.
  constexpr int kTimes = 5;
  for (int left = kTimes;; --left) {
    const auto asked = script_of(word);
    const auto heard = play(asked.script);
    if (!heard) return tl::unexpected{heard.error()};
    if (heard->lateness <= kMostLateness || left == 1) return answers_in(heard->target, asked);
  }
}

Outcome<BothHeard> Questions::play(const Script& script) {
  if (!stage_.can_reset() && machine_.reset == nullptr) {
    return problem(ErrorCode::kUnsupported, "--learn",
                   "each word begins on a device that was started again: --restart says how");
  }
  if (stage_.can_reset() || !std::exchange(was_begun_, true)) {
    if (auto begun = stage_.reset(); !begun) return tl::unexpected{begun.error()};
  }
  auto heard = stage_.play(script);
  if (heard && heard->target.end) return tl::unexpected{*heard->target.end};
  return heard;
}

Questions::Asked Questions::script_of(const mealy::Word& word) const {
  Acts acts{quiet_};
  if (!stage_.can_reset()) machine_.reset(acts);
  if (machine_.begin != nullptr) machine_.begin(acts);
  std::vector<Instant> begins;
  for (const auto letter : word) {
    begins.push_back(acts.now());
    acts.wait(kLead);
    machine_.letters[letter].act(acts);
  }
  begins.push_back(acts.now());
  auto script = acts.script();
  script.push_back(end_at(acts.now()));
  return {std::move(script), std::move(begins)};
}

mealy::Said Questions::answers_in(const Heard& heard, const Asked& asked) const {
  const auto said = messages_of(heard.said, make_dissector_);
  const auto messages = messages_heard(said);
  const auto end = end_of(heard.said);
  mealy::Said answers;
  for (std::size_t i = 0; i + 1 < asked.begins.size(); ++i) {
    const auto first = std::ranges::lower_bound(messages, asked.begins[i], {}, &Message::time);
    const auto last = std::ranges::lower_bound(messages, asked.begins[i + 1], {}, &Message::time);
    answers.push_back(machine_.said(std::span{first, last}));
    if (end >= asked.begins[i] && end < asked.begins[i + 1]) {
      answers.back() += answers.back().empty() ? "the link ends" : ", the link ends";
    }
  }
  return answers;
}

std::vector<std::string> letters_of(const Learnable& machine) {
  std::vector<std::string> letters;
  for (const auto& letter : machine.letters) letters.emplace_back(letter.name);
  return letters;
}

}  // namespace armjig::campaign
