// SPDX-License-Identifier: Apache-2.0
#include "harness/report/output_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <system_error>
#include <utility>

namespace armjig {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kNewFile = 0666;  // less the umask
constexpr mode_t kPermissions = 0777;
constexpr int kMostLinks = 40;  // as Linux has it

/// The descriptor of this process that a path means, such as 1 for /dev/stdout.
std::optional<int> own_descriptor(const std::string& path) {
  if (path == "-" || path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!path.starts_with(folder)) continue;
    int number = -1;
    const auto* const end = path.data() + path.size();
    const auto read = std::from_chars(path.data() + folder.size(), end, number);
    if (read.ec == std::errc{} && read.ptr == end) return number;
  }
  return std::nullopt;
}

/// A new file in the folder of `target`, which no other one is called like. Answers its descriptor,
/// or -1.
int create_beside(const fs::path& target, std::string& name) {
  static std::atomic<unsigned> count{0};
  for (int attempt = 0; attempt < 100; ++attempt) {
    name = target.parent_path() / fmt::format(".armjig-{}-{}", ::getpid(), count++);
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kNewFile);
    if (file >= 0 || errno != EEXIST) return file;
  }
  return -1;
}

/// 0 or the errno of a system call.
int error_of(int result) noexcept { return result < 0 ? errno : 0; }

}  // namespace

int write_all(int descriptor, std::string_view& content) noexcept {
  while (!content.empty()) {
    const auto taken = ::write(descriptor, content.data(), content.size());
    if (taken >= 0) {
      content.remove_prefix(static_cast<std::size_t>(taken));
    } else if (errno == EAGAIN) {
      pollfd ready{.fd = descriptor, .events = POLLOUT, .revents = 0};
      ::poll(&ready, 1, -1);
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

Problem problem_of_writing(std::string where, int error_number) {
  constexpr std::array kOfThePath{ENOENT, ENOTDIR, EACCES, EPERM, EROFS};
  if (error_number == EPIPE) return {ErrorCode::kDisconnected, std::move(where), "nobody reads it"};
  const bool is_of_the_path = std::ranges::find(kOfThePath, error_number) != kOfThePath.end();
  return {ErrorCode::kCannotWrite, std::move(where),
          is_of_the_path ? "check that the folder exists and is writable"
                         : std::generic_category().message(error_number)};
}

Outcome<std::shared_ptr<OutputFile>> OutputFile::open(const std::string& path, Kind kind) {
  std::shared_ptr<OutputFile> file{new OutputFile{path, kind}};
  int error = file->resolve();
  if (error == 0 && file->descriptor_ < 0) error = file->probe();
  if (error == 0) return file;
  return tl::unexpected{problem_of_writing(path, error)};
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

/// Follows the links, as far as to a descriptor that is open.
int OutputFile::resolve() {
  target_ = path_;
  std::error_code no_link;
  for (int links = 0; !no_link; ++links) {
    if (const auto own = own_descriptor(target_)) {
      own_ = *own;
      is_regular_ = false;  // whoever opened it knows where in the file it begins
      const int mode = ::fcntl(own_, F_GETFL);
      if (mode >= 0 && (mode & O_ACCMODE) == O_RDONLY) return EBADF;
      descriptor_ = ::fcntl(own_, F_DUPFD_CLOEXEC, 0);
      return descriptor_ < 0 ? errno : error_of(::fstat(descriptor_, &there_));
    }
    if (links == kMostLinks) return ELOOP;
    const auto next = fs::read_symlink(target_, no_link);
    if (!no_link) target_ = fs::path{target_}.parent_path() / next;
  }
  return 0;
}

/// Whether it could be written, without doing it to a file. Opens what is none.
int OutputFile::probe() {
  const fs::path target{target_};
  if (::stat(target_.c_str(), &there_) == 0) {
    is_regular_ = S_ISREG(there_.st_mode);
    const int file = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (file < 0) return errno;
    if (is_regular_) {
      ::close(file);
    } else {
      descriptor_ = file;
    }
  } else {
    if (errno != ENOENT || !target.has_filename()) return errno;
    is_new_ = true;
    name_ = target.filename();
    const auto folder = target.has_parent_path() ? target.parent_path() : fs::path{"."};
    if (::stat(folder.c_str(), &there_) != 0) return errno;
  }
  if (!is_new_ && (!is_regular_ || kind_ == Kind::kGrowing)) return 0;
  std::string name;
  const int file = create_beside(target, name);
  if (file < 0) return errno;
  ::close(file);
  return error_of(::unlink(name.c_str()));
}

bool OutputFile::is_standard_output() const noexcept { return own_ == STDOUT_FILENO; }

bool OutputFile::is_same_place(const OutputFile& other) const noexcept {
  if (own_ >= 0 && own_ == other.own_) return true;
  return !S_ISCHR(there_.st_mode) && there_.st_dev == other.there_.st_dev &&
         there_.st_ino == other.there_.st_ino && name_ == other.name_;
}

template <class Work>
Outcome<void> OutputFile::unless_failed(Work work) {
  if (!failure_) {
    if (const int error = work(); error != 0) failure_ = problem_of_writing(path_, error);
  }
  if (failure_) return tl::unexpected{*failure_};
  return {};
}

Outcome<void> OutputFile::put(std::string_view content) {
  const bool is_in_place = kind_ == Kind::kGrowing || !is_regular_;
  return unless_failed([&] { return is_in_place ? append(content) : write_whole(content); });
}

Outcome<void> OutputFile::rotate(int files) {
  return unless_failed([&] { return move_aside(files); });
}

int OutputFile::move_aside(int files) {
  const fs::path path{target_};
  const auto numbered = [&path](int number) {
    const auto name = number == 0 ? path.filename().string()
                                  : fmt::format("{}.{}{}", path.stem().string(), number,
                                                path.extension().string());
    return path.parent_path() / name;
  };
  for (int number = files - 1; number > 0; --number) {
    const int error = error_of(::rename(numbered(number - 1).c_str(), numbered(number).c_str()));
    if (error != 0 && error != ENOENT) return error;
  }
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  return 0;
}

int OutputFile::write_whole(std::string_view content) {
  std::string name;
  const int file = create_beside(target_, name);
  if (file < 0) return errno;
  int error = write_all(file, content);
  if (!is_new_) {  // as far as we may
    (void)!::fchown(file, there_.st_uid, there_.st_gid);
    (void)!::fchmod(file, there_.st_mode & kPermissions);
  }
  const int closed = error_of(::close(file));  // a full disk of a server may be told only now
  if (error == 0) error = closed;
  if (error == 0) error = error_of(::rename(name.c_str(), target_.c_str()));
  if (error != 0) ::unlink(name.c_str());
  return error;
}

int OutputFile::append(std::string_view content) {
  if (descriptor_ < 0) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kNewFile);
    if (descriptor_ < 0) return errno;
  }
  auto left = content;
  const int error = write_all(descriptor_, left);
  if (error != 0 && is_regular_) {
    const auto in_part = static_cast<off_t>(content.size() - left.size());
    (void)!::ftruncate(descriptor_, ::lseek(descriptor_, 0, SEEK_CUR) - in_part);
  }
  return error;
}

}  // namespace armjig
