// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/stable_link.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace armjig {
namespace {

namespace fs = std::filesystem;

/// What stands at a path.
struct Occupant {
  enum class Kind { kNothing, kLink, kOther };
  Kind kind{};
  std::string target;  ///< of a link
};

Occupant occupant_of(const std::string& path) {
  std::error_code error;
  const auto status = fs::symlink_status(path, error);
  if (!fs::exists(status)) return {Occupant::Kind::kNothing, {}};
  if (!fs::is_symlink(status)) return {Occupant::Kind::kOther, {}};
  return {Occupant::Kind::kLink, fs::read_symlink(path, error).string()};
}

tl::unexpected<Problem> problem_of(const std::string& path, int error_number) {
  const auto code = error_from_errno(error_number).code;
  if (code == ErrorCode::kNotFound) return problem(code, path, "the folder must exist");
  if (code == ErrorCode::kNoPermission) return problem(code, path, "choose a folder of your own");
  return problem(ErrorCode::kSystem, path, std::generic_category().message(error_number));
}

Outcome<void> check_replaceable(const std::string& path, const Occupant& occupant,
                                const std::string& terminal) {
  if (occupant.kind == Occupant::Kind::kOther) {
    return problem(ErrorCode::kBadValue, path,
                   "something that is not a link is there, and it is not replaced");
  }
  if (!occupant.target.starts_with("/dev/pts/")) {
    return problem(ErrorCode::kBadValue, path,
                   fmt::format("a link to {} is there, and it is not replaced", occupant.target));
  }
  if (occupant.target != terminal && fs::exists(path)) {
    return problem(ErrorCode::kBusy, path,
                   fmt::format("it leads to {}, perhaps of another emulator; choose another path, "
                               "or 'rm' it if you know better",
                               occupant.target));
  }
  return {};
}

/// Puts the new link in the place of the old one in one step.
Outcome<void> replace(const std::string& path, const std::string& terminal) {
  const auto beside = fmt::format("{}.{}", path, ::getpid());
  if (::symlink(terminal.c_str(), beside.c_str()) != 0) return problem_of(path, errno);
  if (std::rename(beside.c_str(), path.c_str()) == 0) return {};
  const auto error_number = errno;
  ::unlink(beside.c_str());
  return problem_of(path, error_number);
}

}  // namespace

StableLink::StableLink(std::string path, std::string terminal)
    : path_{std::move(path)}, terminal_{std::move(terminal)} {}

StableLink::StableLink(StableLink&& other) noexcept
    : path_{std::exchange(other.path_, {})}, terminal_{std::exchange(other.terminal_, {})} {}

StableLink& StableLink::operator=(StableLink&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(terminal_, other.terminal_);
  return *this;
}

StableLink::~StableLink() {
  if (!path_.empty() && occupant_of(path_).target == terminal_) ::unlink(path_.c_str());
}

Outcome<StableLink> StableLink::create(const std::string& path, const std::string& terminal) {
  std::error_code error;
  const auto where = fs::absolute(path, error).string();
  if (error) return problem(ErrorCode::kBadValue, path, error.message());
  // Fails if anything is there, so that nothing is overwritten by an accident of timing.
  if (::symlink(terminal.c_str(), where.c_str()) == 0) return StableLink{where, terminal};
  if (errno != EEXIST) return problem_of(where, errno);
  auto outcome = check_replaceable(where, occupant_of(where), terminal);
  if (outcome) outcome = replace(where, terminal);
  if (!outcome) return tl::unexpected{outcome.error()};
  return StableLink{where, terminal};
}

}  // namespace armjig
