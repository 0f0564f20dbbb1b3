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

/// Of one thing that is done; what follows waits as much longer then. A device that does something
/// by itself after half a second is still asked before.
constexpr Duration kMostLateness = 150ms;

/// A reply that comes later is missing.
constexpr Duration kLongestLate = 300ms;

/// What comes with a reply belongs to the same letter.
constexpr Duration kTogether = 2ms;

/// Which letter each message answers: the one in whose time it came. Numbers from 1, for some came
/// before the first.
std::vector<std::size_t> letters_by_time(const std::vector<Message>& messages,
                                         const std::vector<Instant>& begins) {
  std::vector<std::size_t> letters;
  letters.reserve(messages.size());
  for (const auto& message : messages) {
    const auto next = std::ranges::upper_bound(begins, message.time);
    letters.push_back(static_cast<std::size_t>(next - begins.begin()));
  }
  return letters;
}

/// For each thing sent the letter that sends it, numbers as above.
std::vector<std::size_t> letters_that_send(const Script& script,
                                           const std::vector<Instant>& begins) {
  std::vector<std::size_t> letters;
  for (const auto& record : script) {
    if (!is_sent(record) || record.time < begins.front()) continue;
    const auto next = std::ranges::upper_bound(begins, record.time);
    letters.push_back(static_cast<std::size_t>(next - begins.begin()));
  }
  return letters;
}

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
  if (!stage_.can_reset() && machine_.reset == nullptr) {
    return problem(ErrorCode::kUnsupported, "--learn",
                   "each word begins on a device that was started again: --restart says how");
  }
  // What was said to a letter that came late may have been another time's, or came after the end.
  // Nobody knows then, so the word is asked again; and so if the guard ended it, who does when this
  // program had no time. What never comes is missing.
  constexpr int kTimes = 8;
  for (int left = kTimes;; --left) {
    const auto asked = script_of(word);
    const auto heard = play(asked.script);
    if (!heard && heard.error().code == ErrorCode::kForbidden && left > 1) continue;
    if (!heard) return tl::unexpected{heard.error()};
    auto answers = answers_in(heard->target, asked);
    const bool is_in_time = heard->lateness <= kMostLateness;
    if (left == 1 || (is_in_time && answers.is_whole)) return std::move(answers.said);
  }
}

Outcome<BothHeard> Questions::play(const Script& script) {
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
  // What replies to the last letter may be late, too, and is given back to it.
  script.push_back(end_at(acts.now() + (machine_.is_reply != nullptr ? kLongestLate : Duration{})));
  return {std::move(script), std::move(begins)};
}

Questions::Answers Questions::answers_in(const Heard& heard, const Asked& asked) const {
  const auto said = messages_of(heard.said, make_dissector_);
  const auto messages = messages_heard(said);
  const auto end = end_of(heard.said);
  auto letters = letters_by_time(messages, asked.begins);
  const bool is_whole = machine_.is_reply == nullptr || give_back_replies(messages, asked, letters);
  mealy::Said answers;
  for (std::size_t i = 0; i + 1 < asked.begins.size(); ++i) {
    std::vector<Message> own;
    for (std::size_t j = 0; j < messages.size(); ++j) {
      if (letters[j] == i + 1) own.push_back(messages[j]);
    }
    answers.push_back(machine_.said(own));
    if (end >= asked.begins[i] && end < asked.begins[i + 1]) {
      answers.back() += answers.back().empty() ? "the link ends" : ", the link ends";
    }
  }
  return {std::move(answers), is_whole};
}

/// Gives each reply to the letter that sent what it replies to, and with a late one what came
/// together with it. False, and nothing is done, if one is missing.
bool Questions::give_back_replies(const std::vector<Message>& messages, const Asked& asked,
                                  std::vector<std::size_t>& letters) const {
  const auto senders = letters_that_send(asked.script, asked.begins);
  std::vector<std::size_t> replies;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (letters[i] > 0 && machine_.is_reply(messages[i])) replies.push_back(i);
  }
  if (replies.size() != senders.size()) return false;
  const auto by_time = letters;
  for (std::size_t i = 0; i < replies.size(); ++i) {
    const auto own = by_time[replies[i]];
    if (senders[i] >= own) continue;
    const auto time = messages[replies[i]].time;
    for (std::size_t j = 0; j < messages.size(); ++j) {
      const bool is_with_it = by_time[j] == own && !machine_.is_reply(messages[j]) &&
                              messages[j].time >= time - kTogether &&
                              messages[j].time <= time + kTogether;
      if (j == replies[i] || is_with_it) letters[j] = senders[i];
    }
  }
  return true;
}

std::vector<std::string> letters_of(const Learnable& machine) {
  std::vector<std::string> letters;
  for (const auto& letter : machine.letters) letters.emplace_back(letter.name);
  return letters;
}

}  // namespace armjig::campaign
