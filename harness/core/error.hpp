// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace armjig {

/// Why we could not act. What a device did wrong is never one of these: that is data.
enum class ErrorCode : std::uint16_t {
  kBadHex,
  kOddHex,
  kBadTarget,
  kUnknownDevice,
  kUnknownOption,
  kBadValue,
  kNotFound,
  kNoPermission,
  kBusy,
  kRefused,
  kDisconnected,
  kTimedOut,
  kCannotRead,
  kCannotWrite,
  kMalformed,
  kUnsupported,
  kForbidden,
  kSystem,
};
inline constexpr std::uint16_t kErrorCodeCount = static_cast<std::uint16_t>(ErrorCode::kSystem) + 1;

/// An error below the rig: eight bytes, no heap. `detail` is an errno, an offset or a line number,
/// whichever the function that returns it documents; 0 if there is none.
struct Error {
  ErrorCode code{};
  std::int32_t detail{};

  friend bool operator==(const Error&, const Error&) = default;
};
static_assert(sizeof(Error) == 8);

template <class T>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::int32_t detail = 0) noexcept {
  return tl::unexpected<Error>{Error{code, detail}};
}

/// One sentence without a full stop, for every code its own.
[[nodiscard]] std::string_view describe(ErrorCode code) noexcept;

/// The code that says what a failed system call means to a user; `detail` keeps the errno.
[[nodiscard]] Error error_from_errno(int error_number) noexcept;

/// An error as a user sees it, from link upwards: what went wrong, where, and what to do about it.
struct Problem {
  ErrorCode code{};
  std::string where;
  std::string hint;
};

template <class T>
using Outcome = tl::expected<T, Problem>;

[[nodiscard]] inline tl::unexpected<Problem> problem(ErrorCode code, std::string where,
                                                     std::string hint) {
  return tl::unexpected<Problem>{Problem{code, std::move(where), std::move(hint)}};
}

/// What a user reads: `WHERE: SENTENCE; HINT`, of `kBadValue` and `kBadTarget` `WHERE: HINT`.
[[nodiscard]] std::string describe(const Problem& problem);

}  // namespace armjig
