// SPDX-License-Identifier: Apache-2.0
#include "harness/files/user_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace armjig {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class UserFiles : public testing::Test {
 protected:
  UserFiles() {
    std::string folder = testing::TempDir() + "armjig-XXXXXX";
    folder_ = ::mkdtemp(folder.data());
  }
  ~UserFiles() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string write(const std::string& text) const {
    std::ofstream{path()} << text;
    return path();
  }
  [[nodiscard]] std::string path() const { return (folder_ / "file").string(); }
  [[nodiscard]] std::string folder() const { return folder_.string(); }

 private:
  std::filesystem::path folder_;
};

std::string refusal(const std::string& path) {
  const auto read = read_user_file(path, 100);
  if (read) return "it is read";
  EXPECT_EQ(read.error().code, ErrorCode::kCannotRead);
  EXPECT_EQ(read.error().where, path);
  return read.error().hint;
}

/// All lines, then the problem if there is one.
std::vector<std::string> lines_of(UserFile file) {
  std::vector<std::string> lines;
  while (true) {
    const auto line = file.next_line();
    if (!line) lines.push_back(describe(line.error()));
    if (!line || !*line) return lines;
    lines.emplace_back(**line);
  }
}

TEST_F(UserFiles, AreReadUpToTheLimit) {
  EXPECT_EQ(read_user_file(write(std::string(100, 'x')), 100), std::string(100, 'x'));
  EXPECT_THAT(refusal(write(std::string(101, 'x'))), HasSubstr("more than 100 bytes"));
  EXPECT_EQ(read_user_file(write("")), "");
}

TEST_F(UserFiles, AreNeitherAbsentNorFoldersNorDevices) {
  EXPECT_THAT(refusal(path()), HasSubstr("no such file"));
  EXPECT_THAT(refusal(""), HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder()), HasSubstr("folder"));
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("device"));
}

TEST_F(UserFiles, ThatNobodyMayReadSaySo) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  ::chmod(write("secret").c_str(), 0);
  EXPECT_THAT(refusal(path()), HasSubstr("permissions"));
}

TEST_F(UserFiles, MayBePipesThatSomebodyWritesTo) {
  ASSERT_EQ(::mkfifo(path().c_str(), 0600), 0);
  const int writer = ::open(path().c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::write(writer, "said", 4), 4);
  auto file = UserFile::open(path());
  ::close(writer);
  ASSERT_TRUE(file) << describe(file.error());
  EXPECT_EQ(file->rest(), "said");
}

TEST_F(UserFiles, AreNotPipesThatNobodyWritesTo) {
  ASSERT_EQ(::mkfifo(path().c_str(), 0600), 0);
  EXPECT_THAT(refusal(path()), HasSubstr("nobody writes"));
}

TEST_F(UserFiles, HaveLinesWithTheirNumbers) {
  EXPECT_THAT(lines_of(*UserFile::open(write("one\n\nthree\r\nlast"))),
              ElementsAre("one", "", "three", "last"));
  EXPECT_THAT(lines_of(*UserFile::open(write(""))), ElementsAre());
}

TEST_F(UserFiles, HaveNoEndlessLine) {
  const std::string longest(kMostLineBytes, 'x');
  EXPECT_THAT(lines_of(*UserFile::open(write(longest + "\nnext"))), ElementsAre(longest, "next"));
  const auto lines = lines_of(*UserFile::open(write("one\n" + longest + "x")));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_THAT(lines.back(), HasSubstr(path() + ":2: cannot be read; the line has more than 1 MiB"));
}

TEST_F(UserFiles, ShowTheirFirstByteInAdvance) {
  auto file = UserFile::open(write("{}"));
  EXPECT_EQ(file->peek(), '{');
  EXPECT_EQ(file->rest(), "{}");
  EXPECT_EQ(file->peek(), std::nullopt);
}

}  // namespace
}  // namespace armjig
