// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/requirement.hpp"
#include "conformance/wording.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// A program broke a requirement of role host.
struct Offence {
  Instant time{};
  std::string_view requirement;
  std::string what;  ///< one sentence: what it did, with the numbers
};

/// Takes an offence: the requirement's id, and what the program did, in one sentence.
using Complain = std::function<void(std::string_view requirement, std::string what)>;

/// Something on one of the connections of a server.
struct ConnectionEvent {
  enum class Kind : std::uint8_t {
    kBegun,
    kToServer,    ///< `bytes`, as they came
    kFromServer,  ///< `bytes`
    kHalfClosed,  ///< the client sends no more
    kClosed,      ///< by the client
    kReset,       ///< by the client
    kDropped,     ///< ended in any way by the server
  };
  Instant time{};
  std::uint32_t connection{};  ///< numbered in the order in which they come
  Kind kind{};
  Bytes bytes;
};

/// Judges the program at the other end of a device's link by what passes both ways, without any
/// I/O. Times never decrease. One for each session of a device, from its power-up.
class ProgramChecker {
 public:
  ProgramChecker() = default;
  ProgramChecker(const ProgramChecker&) = delete;
  ProgramChecker& operator=(const ProgramChecker&) = delete;
  virtual ~ProgramChecker() = default;

  virtual void to_device(Instant time, Bytes bytes) = 0;
  virtual void from_device(Instant time, Bytes bytes) = 0;
  /// Of a server, instead of the two above. Who does not tell connections apart hears the bytes of
  /// all of them.
  virtual void on_connection(const ConnectionEvent& event) {
    using Kind = ConnectionEvent::Kind;
    if (event.kind == Kind::kToServer) to_device(event.time, event.bytes);
    if (event.kind == Kind::kFromServer) from_device(event.time, event.bytes);
  }
  /// Nothing more will come.
  virtual void finish(Instant time) = 0;

  /// Whole messages that the program has sent.
  [[nodiscard]] virtual std::size_t messages() const noexcept = 0;

  /// What was found since the last call, oldest first.
  [[nodiscard]] std::vector<Offence> take_offences() { return std::exchange(offences_, {}); }

 protected:
  void add(Instant time, std::string_view requirement, std::string what) {
    offences_.push_back({time, requirement, std::move(what)});
  }

  Instant now_{};  ///< of what it is shown
  /// An offence now.
  const Complain complain_ = [this](std::string_view requirement, std::string what) {
    add(now_, requirement, std::move(what));
  };

 private:
  std::vector<Offence> offences_;
};

/// What a link adds to the times at which a program's bytes are seen; zero in virtual time.
struct LinkNoise {
  Duration most{};
};

/// What is demanded of programs that talk to a device, and who judges it.
struct ProgramCheckEntry {
  std::string_view device;
  std::span<const Requirement> (*requirements)() noexcept;
  std::unique_ptr<ProgramChecker> (*make)(const LinkNoise& noise);
  Document document{};  ///< none: reports name no place
};

template <class Checker>
[[nodiscard]] std::unique_ptr<ProgramChecker> make_checker(const LinkNoise& noise) {
  return std::make_unique<Checker>(noise);
}

/// A demand on programs.
consteval Requirement of_host(std::string_view id, Level level, std::string_view text,
                              std::string_view source) {
  return {.id = id, .level = level, .text = text, .source = source, .role = Role::kHost};
}

}  // namespace armjig
