// SPDX-License-Identifier: Apache-2.0
#include "harness/files/user_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace armjig {
namespace {

constexpr int kPatienceMs = 1000;

auto cannot_read(const std::string& name, std::string hint) {
  return problem(ErrorCode::kCannotRead, name, std::move(hint));
}

std::string hint_of(int error_number) {
  switch (error_number) {
    case ENOENT:
    case ENOTDIR:
      return "there is no such file; check the path";
    case EACCES:
    case EPERM:
      return "you may not read it; check its permissions";
    case EBADF:
      return "it is closed";
    case ENXIO:
      return "it is a socket or a device; name a file";
    default:
      return std::generic_category().message(error_number);
  }
}

/// Why a file of that type is not read; empty if it is.
std::string objection_to(mode_t type) {
  if (S_ISREG(type) || S_ISFIFO(type)) return {};
  if (S_ISDIR(type)) return "it is a folder; name a file";
  return "it is a device, which may have no end; name a file";
}

/// Whether somebody has opened the pipe for writing, or has written to it and gone. `descriptor`
/// does not block.
bool has_writer(int descriptor) noexcept {
  pollfd ready{.fd = descriptor, .events = POLLIN, .revents = 0};
  if (::poll(&ready, 1, kPatienceMs) != 0) return true;
  char none{};
  return ::read(descriptor, &none, 1) < 0;  // it would block: there is a writer, and no byte yet
}

std::string size_of(std::size_t bytes) {
  return bytes >> 20U > 0 ? fmt::format("{} MiB", bytes >> 20U) : fmt::format("{} bytes", bytes);
}

}  // namespace

void UserFile::Close::operator()(std::FILE* file) const noexcept {
  if (file != stdin) (void)std::fclose(file);
}

UserFile UserFile::of_text(std::string_view text, std::string name) {
  // One byte more than there is, for a buffer of none is refused.
  auto kept = std::make_unique<std::string>(text);
  kept->push_back('\n');
  UserFile file{::fmemopen(kept->data(), kept->size(), "rb"), std::move(name)};
  file.text_ = std::move(kept);
  return file;
}

Outcome<UserFile> UserFile::open(std::string path) {
  if (path.find('\0') != std::string::npos) return cannot_read(path, hint_of(ENOENT));
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (descriptor < 0) return cannot_read(path, hint_of(errno));
  UserFile file{::fdopen(descriptor, "rb"), std::move(path)};
  struct stat status{};
  if (::fstat(descriptor, &status) != 0) return file.refuse(hint_of(errno));
  if (auto objection = objection_to(status.st_mode); !objection.empty()) {
    return file.refuse(std::move(objection));
  }
  if (S_ISFIFO(status.st_mode) && !has_writer(descriptor)) {
    return file.refuse("it is a pipe, and nobody writes to it");
  }
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return file;
}

UserFile UserFile::standard_input() { return {stdin, "standard input"}; }

tl::unexpected<Problem> UserFile::refuse(std::string hint) const {
  return cannot_read(name_, std::move(hint));
}

Outcome<void> UserFile::check() const {
  if (std::ferror(file_.get()) == 0) return {};
  return refuse(hint_of(errno));
}

Outcome<std::string> UserFile::rest(std::size_t most) {
  std::string text;
  std::array<char, 65536> block;
  while (const auto size = std::fread(block.data(), 1, block.size(), file_.get())) {
    text.append(block.data(), size);
    if (text.size() > most) {
      return refuse(fmt::format("it has more than {}; is it the right file?", size_of(most)));
    }
  }
  return check().map([&] { return std::move(text); });
}

Outcome<std::optional<std::string_view>> UserFile::next_line() {
  line_.clear();
  ++line_number_;
  int letter = 0;
  while ((letter = ::getc_unlocked(file_.get())) != EOF && letter != '\n') {
    line_ += static_cast<char>(letter);
    if (line_.size() > kMostLineBytes) {
      return cannot_read(
          fmt::format("{}:{}", name_, line_number_),
          fmt::format("the line has more than {}; is it the right file?", size_of(kMostLineBytes)));
    }
  }
  if (auto checked = check(); !checked) return tl::unexpected{std::move(checked.error())};
  read_ += line_.size() + 1;
  if (read_ > kMostBytesInLines) {
    return refuse(
        fmt::format("it has more than {}; cut it into parts", size_of(kMostBytesInLines)));
  }
  if (letter == EOF && line_.empty()) return std::nullopt;
  if (line_.ends_with('\r')) line_.pop_back();
  return std::optional<std::string_view>{line_};
}

Outcome<std::size_t> UserFile::read(std::span<std::byte> into) {
  const auto size = std::fread(into.data(), 1, into.size(), file_.get());
  return check().map([size] { return size; });
}

bool UserFile::starts_with(std::string_view bytes) {
  std::string there;
  int letter = 0;
  while (there.size() < bytes.size() && (letter = std::getc(file_.get())) != EOF) {
    there += static_cast<char>(letter);
  }
  // The C library of Linux takes back as many as it gave.
  for (std::size_t i = there.size(); i-- > 0;) {
    std::ungetc(static_cast<unsigned char>(there[i]), file_.get());
  }
  return there == bytes;
}

std::optional<char> UserFile::peek() {
  const int letter = std::getc(file_.get());
  if (letter == EOF) return std::nullopt;
  std::ungetc(letter, file_.get());
  return static_cast<char>(letter);
}

Outcome<std::string> read_user_file(const std::string& path, std::size_t most) {
  return UserFile::open(path).and_then([most](UserFile file) { return file.rest(most); });
}

}  // namespace armjig
