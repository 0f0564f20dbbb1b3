// SPDX-License-Identifier: Apache-2.0
#include "harness/core/error.hpp"

#include <array>
#include <cerrno>

namespace armjig {
namespace {

constexpr std::array<std::string_view, kErrorCodeCount> kSentences{
    "not a hexadecimal digit",
    "a hexadecimal digit is missing its partner",
    "not a target",
    "no such device is known here",
    "no such option",
    "cannot be used",
    "there is nothing at that place",
    "permission denied",
    "in use by another program",
    "the connection was refused",
    "the other side has gone",
    "no answer in time",
    "cannot be read",
    "cannot be written",
    "the content is malformed",
    "not supported here",
    "not allowed by the guard",
    "the operating system refused",
};

}  // namespace

std::string_view describe(ErrorCode code) noexcept {
  return kSentences[static_cast<std::uint16_t>(code)];
}

Error error_from_errno(int error_number) noexcept {
  const auto code = [error_number] {
    switch (error_number) {
      case ENOENT:
      case ENXIO:
      case ENODEV:
      case ENOTDIR:
        return ErrorCode::kNotFound;
      case EACCES:
      case EPERM:
        return ErrorCode::kNoPermission;
      case EBUSY:
      case EADDRINUSE:
      case EEXIST:
        return ErrorCode::kBusy;
      case ECONNREFUSED:
        return ErrorCode::kRefused;
      case EPIPE:
      case EIO:
      case ECONNRESET:
        return ErrorCode::kDisconnected;
      case ETIMEDOUT:
        return ErrorCode::kTimedOut;
      default:
        return ErrorCode::kSystem;
    }
  }();
  return {code, error_number};
}

std::string describe(const Problem& problem) {
  std::string line = problem.where;
  if (!line.empty()) line += ": ";
  const bool says_what =
      problem.code == ErrorCode::kBadValue || problem.code == ErrorCode::kBadTarget;
  if (says_what && !problem.hint.empty()) return line + problem.hint;
  line += describe(problem.code);
  if (!problem.hint.empty()) {
    line += "; ";
    line += problem.hint;
  }
  return line;
}

}  // namespace armjig
