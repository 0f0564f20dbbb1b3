// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/wire/dissector.hpp"

namespace armjig {

/// What any dissector finds, for people and as JSON.
class MessageView {
 public:
  explicit MessageView(std::unique_ptr<Dissector> dissector) : dissector_{std::move(dissector)} {}

  /// Forgets what came before but for the newest message.
  void feed(Direction direction, Instant now, Bytes bytes);

  /// Messages without a fault, of all `feed`s.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

  // Of the last `feed`, without line ends; faults too.
  [[nodiscard]] std::vector<std::string> lines() const;
  [[nodiscard]] std::vector<std::string> json_lines() const;

  // The newest one without a fault; empty before the first.
  [[nodiscard]] std::vector<std::string> newest_line() const;
  [[nodiscard]] std::string newest_panel() const;

 private:
  std::unique_ptr<Dissector> dissector_;
  std::vector<Message> messages_;
  Message newest_;
  std::uint64_t count_ = 0;
};

}  // namespace armjig
