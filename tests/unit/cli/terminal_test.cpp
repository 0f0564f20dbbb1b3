// SPDX-License-Identifier: Apache-2.0
#include "cli/terminal.hpp"

#include <gtest/gtest.h>

namespace armjig::cli {
namespace {

TEST(Wrapped, LeavesShortLinesAlone) {
  EXPECT_EQ(wrapped("one\n\n  two   three\n", 20), "one\n\n  two   three\n");
}

TEST(Wrapped, BreaksProseAtBlanks) {
  EXPECT_EQ(wrapped("these are some words in a line\n", 12), "these are\nsome words\nin a line\n");
}

TEST(Wrapped, GoesOnBelowTheLastColumn) {
  EXPECT_EQ(wrapped("  --name  says what this one is\n", 20),
            "  --name  says what\n          this one\n          is\n");
}

TEST(Wrapped, GivesAColumnThatBeginsFarToTheRightALineOfItsOwn) {
  EXPECT_EQ(wrapped("  a long example   and what it does\n", 20),
            "  a long example\n      and what it\n      does\n");
}

TEST(Wrapped, KeepsWordsThatAreTooLong) {
  EXPECT_EQ(wrapped("  --x  loss=0.1%,delay=normal(2ms,1ms)\n", 20),
            "  --x  loss=0.1%,delay=normal(2ms,1ms)\n");
}

TEST(Wrapped, JoinsProseThatWasBrokenByHand) {
  EXPECT_EQ(wrapped("Prose that somebody broke by hand behind about here,\nin the middle.\n", 40),
            "Prose that somebody broke by hand behind\nabout here, in the middle.\n");
  EXPECT_EQ(wrapped("A sentence that ends where its line also ends here.\nAnother.\n", 80),
            "A sentence that ends where its line also ends here.\nAnother.\n");
}

TEST(Colours, AreAsTold) {
  EXPECT_EQ(style_of("always", stdout), Style::kColour);
  EXPECT_EQ(style_of("never", stdout), Style::kPlain);
}

}  // namespace
}  // namespace armjig::cli
