// SPDX-License-Identifier: Apache-2.0
// What is between the two time stamps: poll, write and read, and nothing else. A filter of the
// kernel ends a process that does anything else there.
#include "harness/latency/path.hpp"

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <vector>

#include "harness/rig/demo_judge.hpp"
#include "harness/rig/guarded_ports.hpp"
#include "tests/unit/support/allocations.hpp"
#include "tests/unit/support/link_ends.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

constexpr int kRounds = 50;
constexpr int kAllocated = 3;  // exit codes of the child
constexpr int kFailed = 4;
constexpr int kNoFilter = 5;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;  // and makes system calls of its own
#elif defined(__has_feature)
constexpr bool kIsSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kIsSanitized = false;
#endif

/// Allows what `path_on` says it does, and to end. False: nothing is filtered.
bool allow_nothing_else() {
  if (kIsSanitized) return false;
  constexpr std::array<unsigned, 8> kAllowed{SYS_ppoll,         SYS_read,   SYS_write,
                                             SYS_recvmsg,       SYS_sendto, SYS_exit_group,
                                             SYS_clock_gettime, SYS_exit};
  std::vector<sock_filter> filter{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  for (const auto number : kAllowed) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 1));
    filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  }
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS));
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// In a process of its own: answers are there already, and rounds follow each other.
int run_rounds(test::LinkEnds ends) {
  const std::array<std::byte, kRounds> answers{};
  const auto far = ends.far.value();
  const DescriptorStream::Put put = write_all;
  const auto port = GuardedStream::guard(
      std::make_unique<DescriptorStream>(std::move(ends.near), put), demo::rig::make_judge(), {});
  if (!port) return kFailed;
  const auto line = direct_line(**port, {});
  if (!line) return kFailed;
  const auto path = path_on(**port, *line);
  const std::array<std::byte, 3> request{std::byte{0xA5}, std::byte{'q'}, std::byte{0x8E}};
  // So many bytes, for in there nobody may be asked.
  for (int round = 0; round < kRounds; ++round) {
    if (!path->announce(request)) return kFailed;
  }
  std::array<std::byte, 1> answer{};
  // What comes earlier the guard takes in.
  if (::write(far, answers.data(), answers.size()) != kRounds) return kFailed;
  if (!allow_nothing_else()) return kNoFilter;
  const auto before = test::allocations();
  for (int round = 0; round < kRounds; ++round) {
    const auto sent = path->send(request);
    const auto arrival = path->receive(answer, path->now() + 10s);
    if (!sent || !arrival || arrival->size != 1) ::_exit(kFailed);
  }
  ::_exit(test::allocations() == before ? 0 : kAllocated);  // closing files is not allowed
}

/// A path behind a guard on one end of a link.
struct PathOnEnd {
  explicit PathOnEnd(test::LinkEnds ends)
      : port{std::move(
            *GuardedStream::guard(std::make_unique<DescriptorStream>(
                                      std::move(ends.near), DescriptorStream::Put{write_all}),
                                  demo::rig::make_judge(), {}))},
        far{std::move(ends.far)} {}

  std::unique_ptr<GuardedStream> port;
  Descriptor far;
  DirectLine line = direct_line(*port, {}).value();
  std::unique_ptr<Path> path = path_on(*port, line);
};

constexpr std::array kDemoQuery{std::byte{0xA5}, std::byte{'q'}, std::byte{0x8E}};

TEST(PathOnAFile, SendsNothingThatTheGuardHasNotAdmitted) {
  const PathOnEnd end{test::make_socket_ends()};
  const std::array start{std::byte{0xA5}, std::byte{'s'}, std::byte{0x8C}};
  EXPECT_EQ(end.path->announce(start).error().code, ErrorCode::kForbidden) << "it moves";
  EXPECT_EQ(end.path->send(start).error().code, ErrorCode::kForbidden);
  std::array<std::byte, 16> came{};
  // Only the judge's opening bytes, two zeros.
  EXPECT_EQ(::read(end.far.value(), came.data(), came.size()), 2);
}

TEST(PathOnAFile, TellsWhenTheKernelHandedARequestToATcpLink) {
  const PathOnEnd end{test::make_tcp_ends()};
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(end.path->announce(kDemoQuery));
    const auto before = end.path->now();
    const auto left = end.path->time_send(kDemoQuery);
    ASSERT_TRUE(left);
    ASSERT_TRUE(*left) << "no stamp";
    EXPECT_GE(**left, Duration{});
    EXPECT_LE(**left, end.path->now() - before);
    // Nothing is left that would wake who waits for an answer.
    pollfd entry{.fd = end.line.descriptor, .events = POLLIN, .revents = 0};
    EXPECT_EQ(::poll(&entry, 1, 0), 0);
  }
}

TEST(PathOnAFile, DoesNotKnowWhenSomethingLeavesATerminal) {
  const PathOnEnd end{test::make_terminal_ends()};
  ASSERT_TRUE(end.path->announce(kDemoQuery));
  EXPECT_FALSE(end.path->time_send(kDemoQuery).value());
}

class MeasuredPath : public testing::TestWithParam<test::LinkEnds (*)()> {};

TEST_P(MeasuredPath, OnlyPollsWritesAndReadsAndTakesNothingFromTheHeap) {
  auto ends = GetParam()();
  const auto child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) ::_exit(run_rounds(std::move(ends)));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status)) << "another system call, signal " << WTERMSIG(status);
  if (WEXITSTATUS(status) == kNoFilter) GTEST_SKIP() << "no system calls are filtered here";
  EXPECT_EQ(WEXITSTATUS(status), 0) << "3: it allocated, 4: it failed";
}

INSTANTIATE_TEST_SUITE_P(OnASocketAndATerminal, MeasuredPath,
                         testing::Values(test::make_socket_ends, test::make_terminal_ends),
                         [](const auto& one) { return one.index == 0 ? "Socket" : "Terminal"; });

}  // namespace
}  // namespace armjig
