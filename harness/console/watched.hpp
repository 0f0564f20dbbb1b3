// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/rig/stream_link.hpp"

namespace armjig {

/// A device that somebody looks at: how to ask it without doing anything to it, and how to show
/// what it answers.
class Watched {
 public:
  Watched() = default;
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;
  virtual ~Watched() = default;

  [[nodiscard]] virtual Instant now() = 0;

  /// Asks for what it says of itself. False: it speaks without being asked. Errors are the port's.
  [[nodiscard]] virtual Result<bool> ask() = 0;

  /// Takes in what comes until `deadline`. True: something came before, and more may follow.
  [[nodiscard]] virtual Result<bool> listen(Instant deadline) = 0;

  /// Nothing more will come.
  virtual void finish() {}

  /// How many messages came.
  [[nodiscard]] virtual std::uint64_t answers() const = 0;

  /// What came with the last `listen`, a JSON object on a line each, without line ends.
  [[nodiscard]] virtual std::vector<std::string> json_lines() const = 0;

  // The newest: in lines without line ends, for a log, and as a page with them. Empty before the
  // first.
  [[nodiscard]] virtual std::vector<std::string> lines() const = 0;
  [[nodiscard]] virtual std::string panel() const = 0;

  /// The link so far, on several lines.
  [[nodiscard]] virtual std::string link() const = 0;

  /// As of the rig.
  [[nodiscard]] virtual std::optional<ImpairmentStatistics> impairments() const {
    return std::nullopt;
  }
};

/// How to look.
struct WatchHow {
  Duration period{};  ///< of questions
  WhenGone when_gone{};
};

/// One that is on a byte stream.
class WatchedStream : public Watched {
 public:
  explicit WatchedStream(StreamLink link) : link_{std::move(link)} {}

  [[nodiscard]] Instant now() override { return link_.port().now(); }
  [[nodiscard]] Result<bool> ask() override;
  [[nodiscard]] Result<bool> listen(Instant deadline) override;
  [[nodiscard]] std::optional<ImpairmentStatistics> impairments() const override {
    return link_.impairments();
  }

 private:
  /// The harmless message that is due at `now`; empty if the device speaks by itself.
  [[nodiscard]] virtual std::vector<std::byte> request(Instant /*now*/) { return {}; }
  virtual void receive(Instant now, Bytes bytes) = 0;

  StreamLink link_;
};

}  // namespace armjig
