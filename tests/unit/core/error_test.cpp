// SPDX-License-Identifier: Apache-2.0
#include "harness/core/error.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <set>
#include <string_view>

namespace armjig {
namespace {

TEST(Error, HasASentenceOfItsOwnForEveryCode) {
  std::set<std::string_view> sentences;
  for (std::uint16_t code = 0; code < kErrorCodeCount; ++code) {
    const auto sentence = describe(static_cast<ErrorCode>(code));
    EXPECT_FALSE(sentence.empty()) << "code " << code;
    EXPECT_FALSE(sentence.ends_with('.')) << sentence;
    EXPECT_TRUE(sentences.insert(sentence).second) << "twice: " << sentence;
  }
}

TEST(Error, TakesEightBytes) { EXPECT_EQ(sizeof(Error), 8U); }

TEST(Error, KeepsTheNumberOfTheFailedSystemCall) {
  EXPECT_EQ(error_from_errno(ENOENT), (Error{ErrorCode::kNotFound, ENOENT}));
  EXPECT_EQ(error_from_errno(EACCES), (Error{ErrorCode::kNoPermission, EACCES}));
  EXPECT_EQ(error_from_errno(EBUSY), (Error{ErrorCode::kBusy, EBUSY}));
  EXPECT_EQ(error_from_errno(ECONNREFUSED), (Error{ErrorCode::kRefused, ECONNREFUSED}));
  EXPECT_EQ(error_from_errno(EIO), (Error{ErrorCode::kDisconnected, EIO}));
  EXPECT_EQ(error_from_errno(ETIMEDOUT), (Error{ErrorCode::kTimedOut, ETIMEDOUT}));
  EXPECT_EQ(error_from_errno(ENOMEM), (Error{ErrorCode::kSystem, ENOMEM}));
}

TEST(Error, TellsAUserWhatWhereAndWhatToDoInOneLine) {
  EXPECT_EQ(describe(Problem{ErrorCode::kBusy, "/dev/ttyACM0", "close the other program"}),
            "/dev/ttyACM0: in use by another program; close the other program");
  EXPECT_EQ(describe(Problem{ErrorCode::kTimedOut, "", ""}), "no answer in time");
  EXPECT_EQ(describe(Problem{ErrorCode::kBadValue, "--x is missing", "write --x 1"}),
            "--x is missing: write --x 1");
}

}  // namespace
}  // namespace armjig
