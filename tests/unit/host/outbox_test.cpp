// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/outbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace armjig {
namespace {

std::vector<std::byte> message(std::size_t size, unsigned char fill) {
  return std::vector<std::byte>(size, std::byte{fill});
}

std::vector<std::byte> copy(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

TEST(Outbox, HandsOverMessagesInOrder) {
  Outbox outbox;
  outbox.push(message(2, 1));
  outbox.push(message(1, 2));
  EXPECT_EQ(copy(outbox.waiting()), (std::vector{std::byte{1}, std::byte{1}, std::byte{2}}));
}

TEST(Outbox, KeepsTheRestOfAMessageThatHasBegunToLeave) {
  Outbox outbox;
  outbox.push(message(3, 1));
  outbox.pop(2);
  EXPECT_EQ(copy(outbox.waiting()), message(1, 1));
  outbox.pop(1);
  EXPECT_TRUE(outbox.is_empty());
  EXPECT_EQ(outbox.dropped(), 0U);
}

TEST(Outbox, DropsWholeMessagesBeyondItsCapacity) {
  Outbox outbox;
  outbox.push(message(Outbox::kCapacity - 1, 1));
  outbox.push(message(2, 2));
  EXPECT_EQ(outbox.waiting().size(), Outbox::kCapacity - 1);
  outbox.push(message(1, 3));
  EXPECT_EQ(outbox.waiting().size(), Outbox::kCapacity);
  EXPECT_EQ(outbox.dropped(), 1U);
}

TEST(Outbox, TakesMessagesAgainOnceSomeHaveLeft) {
  Outbox outbox;
  outbox.push(message(Outbox::kCapacity, 1));
  outbox.push(message(60, 2));
  outbox.pop(60);
  outbox.push(message(60, 3));
  EXPECT_EQ(outbox.waiting().size(), Outbox::kCapacity);
  EXPECT_EQ(copy(outbox.waiting().last(60)), message(60, 3));
}

TEST(Outbox, CountsWhatAGoneClientLeftUnread) {
  Outbox outbox;
  outbox.push(message(3, 1));
  outbox.push(message(3, 2));
  outbox.push(message(3, 3));
  outbox.pop(4);  // the second is torn, and counts
  outbox.clear();
  EXPECT_TRUE(outbox.is_empty());
  EXPECT_TRUE(outbox.waiting().empty());
  EXPECT_EQ(outbox.dropped(), 2U);
}

TEST(Outbox, NeverTearsMessagesOfASlowClient) {
  Outbox outbox;
  std::vector<std::byte> read;
  for (int i = 0; i < 40'000; ++i) {  // pushed faster than popped, with odd borders
    outbox.push(message(7, static_cast<unsigned char>(i)));
    const auto taken =
        copy(outbox.waiting().first(std::min<std::size_t>(5, outbox.waiting().size())));
    read.insert(read.end(), taken.begin(), taken.end());
    outbox.pop(taken.size());
  }
  ASSERT_GT(outbox.dropped(), 0U);
  for (std::size_t i = 0; i + 7 <= read.size(); i += 7) {
    const auto frame = Bytes{read}.subspan(i, 7);
    EXPECT_EQ(copy(frame), std::vector<std::byte>(7, frame[0])) << "at " << i;
  }
}

}  // namespace
}  // namespace armjig
