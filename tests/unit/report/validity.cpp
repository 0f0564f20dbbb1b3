// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/report/validity.hpp"

#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "tests/unit/support/source_dir.hpp"

namespace armjig::test {
namespace {

/// A file with that content, as long as this lives.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view content) {
    const int descriptor = ::mkstemp(path_.data());
    auto* file = descriptor < 0 ? nullptr : ::fdopen(descriptor, "w");
    if (file == nullptr || std::fwrite(content.data(), 1, content.size(), file) != content.size()) {
      ADD_FAILURE() << "cannot write " << path_;
    }
    if (file != nullptr) (void)std::fclose(file);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { (void)::unlink(path_.c_str()); }

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  std::string path_ = ::testing::TempDir() + "armjig-report-XXXXXX";
};

::testing::AssertionResult run(const std::string& command, std::string_view package) {
  auto* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return ::testing::AssertionFailure() << "cannot run " << command;
  std::string output;
  std::array<char, 4096> piece{};
  while (const auto size = std::fread(piece.data(), 1, piece.size(), pipe)) {
    output.append(piece.data(), size);
  }
  const int status = ::pclose(pipe);
  const bool is_good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (is_good) return ::testing::AssertionSuccess();
  const bool is_missing = (WIFEXITED(status) && WEXITSTATUS(status) == 127) ||
                          output.find("No module named") != std::string::npos;
  return ::testing::AssertionFailure()
         << (is_missing ? fmt::format("needs Debian's package {}: ", package) : "") << command
         << '\n'
         << output.substr(0, 4000);
}

}  // namespace

::testing::AssertionResult is_valid_junit(std::string_view xml) {
  const TemporaryFile file{xml};
  return run(fmt::format("xmllint --noout --nonet --schema '{}/tests/data/junit.xsd' '{}'",
                         source_dir(), file.path()),
             "libxml2-utils");
}

::testing::AssertionResult is_valid_json(std::string_view json, std::string_view schema) {
  const TemporaryFile file{json};
  // Debian's own Python, because another one has no python3-jsonschema.
  return run(fmt::format("/usr/bin/python3 -m jsonschema -i '{}' '{}/{}'", file.path(),
                         source_dir(), schema),
             "python3-jsonschema");
}

}  // namespace armjig::test
