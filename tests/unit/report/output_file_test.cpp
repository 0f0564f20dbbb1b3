// SPDX-License-Identifier: Apache-2.0
#include "harness/report/output_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/unit/support/limited_file_size.hpp"

namespace armjig {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using FileKind = OutputFile::Kind;

class OutputFileTest : public ::testing::Test {
 protected:
  OutputFileTest() { fs::create_directories(folder_); }
  ~OutputFileTest() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const char* name) const { return folder_ / name; }
  std::string with(const char* name, std::string_view content) const {
    std::ofstream{path(name)} << content;
    return path(name);
  }
  static std::string content(const std::string& path) {
    std::ifstream in{path};
    return {std::istreambuf_iterator<char>{in}, {}};
  }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator{folder_}, fs::directory_iterator{});
  }
  static auto open(const std::string& path, FileKind kind = FileKind::kWhole) {
    return OutputFile::open(path, kind);
  }

  fs::path folder_ =
      fs::path{::testing::TempDir()} /
      ("armjig-" + std::string{::testing::UnitTest::GetInstance()->current_test_info()->name()});
};

TEST_F(OutputFileTest, ChangesNothingBeforeItIsWritten) {
  const auto old = with("old", "good");
  const auto whole = open(old).value();
  const auto growing = open(old, FileKind::kGrowing).value();
  const auto next = open(path("new")).value();
  const auto growing_next = open(path("newer"), FileKind::kGrowing).value();
  EXPECT_EQ(content(old), "good");
  EXPECT_EQ(files(), 1);
}

TEST_F(OutputFileTest, ReplacesTheOldFileAndKeepsItsMode) {
  const auto old = with("old", "a longer old one");
  ASSERT_EQ(::chmod(old.c_str(), 0640), 0);
  ASSERT_TRUE(open(old).value()->put("new"));
  EXPECT_EQ(content(old), "new");
  struct stat there{};
  ASSERT_EQ(::stat(old.c_str(), &there), 0);
  EXPECT_EQ(there.st_mode & 0777U, 0640U);
  EXPECT_EQ(files(), 1);
}

TEST_F(OutputFileTest, LeavesTheOldFileOnAFullDisk) {
  const auto old = with("old", "good");
  const auto file = open(old).value();
  {
    const test::LimitedFileSize limit{100};
    ASSERT_FALSE(file->put(std::string(1'000, 'x')));
  }
  EXPECT_EQ(content(old), "good");
  EXPECT_EQ(files(), 1) << "the new one is taken away";
  EXPECT_EQ(file->failure()->code, ErrorCode::kCannotWrite);
  EXPECT_EQ(file->failure()->where, old);
  EXPECT_THAT(file->failure()->hint, HasSubstr("large"));
}

TEST_F(OutputFileTest, GrowsInPlaceAndEndsWithItsLastWholePiece) {
  const auto old = with("old", "what was there before");
  const auto file = open(old, FileKind::kGrowing).value();
  ASSERT_TRUE(file->put("one,"));
  EXPECT_EQ(content(old), "one,") << "others see it at once";
  {
    const test::LimitedFileSize limit{10};
    EXPECT_FALSE(file->put("a long piece"));
  }
  EXPECT_FALSE(file->put("two")) << "nothing comes after a gap";
  EXPECT_EQ(content(old), "one,");
}

TEST_F(OutputFileTest, RefusesWhatCannotBeWritten) {
  for (const auto kind : {FileKind::kWhole, FileKind::kGrowing}) {
    for (const std::string& wrong :
         {path("no/such/folder"), folder_.string(), path("folder/"), std::string{"/proc/new"},
          with("file", "") + "/below", std::string{"/dev/fd/977"}}) {
      const auto file = open(wrong, kind);
      ASSERT_FALSE(file) << wrong;
      EXPECT_EQ(file.error().code, ErrorCode::kCannotWrite);
      EXPECT_EQ(file.error().where, wrong);
    }
  }
}

TEST_F(OutputFileTest, KeepsASymbolicLink) {
  fs::create_directory(folder_ / "other");
  const auto target = with("other/file", "old");
  fs::create_symlink("other/file", folder_ / "link");
  fs::create_symlink("link", folder_ / "link to link");
  ASSERT_TRUE(open(path("link to link")).value()->put("new"));
  EXPECT_EQ(content(target), "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link to link"));
}

TEST_F(OutputFileTest, WritesWhereADanglingLinkLeads) {
  fs::create_symlink("later", folder_ / "link");
  ASSERT_TRUE(open(path("link")).value()->put("new"));
  EXPECT_EQ(content(path("later")), "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
}

TEST_F(OutputFileTest, RefusesALinkThatLeadsToItself) {
  fs::create_symlink("link", folder_ / "link");
  EXPECT_FALSE(open(path("link")));
}

TEST_F(OutputFileTest, WritesDevicesInPlace) {
  ASSERT_TRUE(open("/dev/null").value()->put("content"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const auto full = open("/dev/full").value()->put("content");
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().where, "/dev/full");
  EXPECT_THAT(full.error().hint, HasSubstr("space"));
}

TEST_F(OutputFileTest, WritesAFifoInPlace) {
  const auto fifo = path("fifo");
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  const int reader = ::open(fifo.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  ASSERT_TRUE(open(fifo).value()->put("new"));
  std::array<char, 8> buffer{};
  EXPECT_EQ(::read(reader, buffer.data(), buffer.size()), 3);
  EXPECT_TRUE(fs::is_fifo(fifo));
  ::close(reader);
}

TEST_F(OutputFileTest, WritesADescriptorOfThisProcessWhereItStands) {
  const int descriptor = ::open(with("file", "").c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(::write(descriptor, "before ", 7), 7);
  for (const auto* const folder : {"/dev/fd/", "/proc/self/fd/"}) {
    ASSERT_TRUE(open(folder + std::to_string(descriptor)).value()->put("new "));
  }
  ::close(descriptor);
  EXPECT_EQ(content(path("file")), "before new new ");
}

TEST_F(OutputFileTest, KnowsStandardOutputByEveryName) {
  for (const auto* const name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
    EXPECT_TRUE(open(name).value()->is_standard_output()) << name;
    EXPECT_TRUE(open(name).value()->is_same_place(*open("-").value())) << name;
  }
  EXPECT_FALSE(open(path("file")).value()->is_standard_output());
  EXPECT_FALSE(open(path("file")).value()->is_same_place(*open("-").value()));
}

TEST_F(OutputFileTest, KnowsOnePlaceByTwoSpellings) {
  with("old", "");
  fs::create_symlink("old", folder_ / "link");
  fs::create_symlink("new", folder_ / "dangling");
  fs::create_hard_link(folder_ / "old", folder_ / "hard");
  fs::create_directory(folder_ / "sub");
  const auto is_same = [this](const char* one, const char* other) {
    return open(path(one)).value()->is_same_place(*open(path(other)).value());
  };
  EXPECT_TRUE(is_same("old", "sub/../old"));
  EXPECT_TRUE(is_same("old", "link"));
  EXPECT_TRUE(is_same("old", "hard"));
  EXPECT_TRUE(is_same("new", "./new"));
  EXPECT_TRUE(is_same("new", "dangling"));
  EXPECT_FALSE(is_same("new", "sub/new"));
  EXPECT_FALSE(is_same("new", "newer"));
  EXPECT_FALSE(is_same("old", "new"));
  EXPECT_FALSE(open("/dev/null").value()->is_same_place(*open("/dev/null").value()));
}

TEST_F(OutputFileTest, RotatesAndKeepsAsManyAsAreWanted) {
  const auto file = open(path("log.txt"), FileKind::kGrowing).value();
  ASSERT_TRUE(file->can_rotate());
  for (const char* const piece : {"one", "two", "three", "four"}) {
    ASSERT_TRUE(file->put(piece));
    ASSERT_TRUE(file->rotate(3));
  }
  ASSERT_TRUE(file->put("five"));
  EXPECT_EQ(content(path("log.txt")), "five");
  EXPECT_EQ(content(path("log.1.txt")), "four");
  EXPECT_EQ(content(path("log.2.txt")), "three");
  EXPECT_EQ(files(), 3);
}

TEST_F(OutputFileTest, RotatesOnlyFilesThatGrow) {
  EXPECT_FALSE(open(path("whole"))->get()->can_rotate());
  EXPECT_FALSE(open("/dev/null", FileKind::kGrowing)->get()->can_rotate());
  EXPECT_FALSE(open("-", FileKind::kGrowing)->get()->can_rotate());
}

TEST_F(OutputFileTest, SaysThatItCannotRotate) {
  const auto file = open(path("log"), FileKind::kGrowing).value();
  ASSERT_TRUE(file->put("one"));
  fs::create_directory(path("log.1"));
  EXPECT_FALSE(file->rotate(2));
  EXPECT_TRUE(file->failure());
  EXPECT_FALSE(file->put("two"));
  EXPECT_EQ(content(path("log")), "one");
}

}  // namespace
}  // namespace armjig
