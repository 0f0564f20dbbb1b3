// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/supervisor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "emulators/host/host.hpp"
#include "emulators/parol6/arm.hpp"
#include "harness/drive/parol6/drive_loop.hpp"
#include "harness/link/transaction_bus.hpp"
#include "harness/rig/morap_judge.hpp"
#include "harness/rig/parol6_judge.hpp"
#include "harness/rig/real_target.hpp"
#include "harness/rig/rig.hpp"

// An emulated arm behind a pseudo-terminal in this process, and a child process that moves it
// through a guarded rig and then dies. What the arm does is seen in the emulator, not on the wire.

namespace armjig::parol6 {
namespace {

using namespace emulation;
using namespace std::chrono_literals;
namespace fs = std::filesystem;
using Wall = std::chrono::steady_clock;

/// An arm that did not move for that long stands.
constexpr auto kStanding = 60ms;
/// An arm that stands has to go on standing for that long.
constexpr auto kAfterwards = 100ms;
/// So long after the death or the silence of its program an arm may still move. Half a second of it
/// is the silence that the supervisor waits for.
constexpr auto kBound = 1s;
/// For a slow machine with sanitizers; only a failure takes that long.
constexpr auto kPatience = 30s;

/// What an arm does, told by the thread on which it lives. Times are those of the wall.
struct Sight {
  std::atomic<Wall::duration> until{};        ///< so far the arm was looked at
  std::atomic<Wall::duration> last_motion{};  ///< a joint made its last step; 0: none did
  std::atomic<bool> is_enabled{true};
  std::atomic<int> frames{};  ///< telemetry that it sent

  [[nodiscard]] bool has_moved() const { return last_motion.load() != Wall::duration{}; }
  [[nodiscard]] bool stands_since(Wall::duration moment) const {
    return until.load() - std::max(last_motion.load(), moment) > kStanding;
  }
};

/// Looks at the arm every millisecond of its time, in whatever steps it is advanced.
class WatchedArm final : public HostedStream {
 public:
  /// The arm has lived until `age`.
  WatchedArm(Arm arm, Duration age, Sight& sight)
      : arm_{std::move(arm)}, age_{age}, sight_{sight}, before_{positions()} {}

  void receive(Instant time, Bytes bytes) override { arm_.receive(time + age_, bytes); }
  void advance_to(Instant time) override {
    const auto now = Wall::now().time_since_epoch();
    while (reached_ < time) {
      reached_ = std::min(time, reached_ + Duration{1ms});
      arm_.advance_to(reached_ + age_);
      const auto after = positions();
      if (after != before_) sight_.last_motion = now - (time - reached_);
      before_ = after;
    }
    sight_.is_enabled = arm_.board().is_enabled();
    sight_.until = now;
  }
  [[nodiscard]] std::optional<Instant> next_event() const override {
    const auto next = arm_.next_event();
    return next ? std::optional{*next - age_} : std::nullopt;
  }
  [[nodiscard]] std::span<const SentBytes> sent() const override { return arm_.sent(); }
  void clear_sent() override {
    sight_.frames += static_cast<int>(arm_.sent().size());
    arm_.clear_sent();
  }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
    return arm_.set_input(time + age_, name, value);
  }

 private:
  [[nodiscard]] JointSteps positions() const {
    JointSteps all;
    std::ranges::transform(arm_.board().joints(), all.begin(), &emulation::Joint::position);
    return all;
  }

  Arm arm_;
  Duration age_;
  Sight& sight_;
  JointSteps before_;
  Instant reached_{};
};

constexpr Duration kTimeToHome = 40s;

const Arm& homed_arm() {
  static const auto homed = [] {
    Arm arm;
    arm.receive(at({}), encode(CommandFrame{.command = Command::kHome}));
    arm.receive(at(10ms), encode(CommandFrame{.command = Command::kIdle}));
    arm.advance_to(at(kTimeToHome));
    arm.clear_sent();
    return arm;
  }();
  return homed;
}

/// A homed arm on a pseudo-terminal. It lives on a thread of its own from `start` on, so that
/// children can be forked before there is one.
class Bench {
 public:
  Bench() : host_{open(sight_)} {}
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
  ~Bench() {
    host_.stop();
    if (thread_.joinable()) thread_.join();
  }

  void start() {
    thread_ = std::thread{[this] { host_.run(); }};
  }
  [[nodiscard]] std::string target() const { return host_.targets().front(); }
  [[nodiscard]] const Sight& sight() const { return sight_; }

 private:
  static Host open(Sight& sight) {
    HostOptions options;
    options.pty.emplace();
    auto arm = std::make_unique<WatchedArm>(homed_arm(), kTimeToHome, sight);
    return std::move(Host::open(std::move(arm), options).value());
  }

  Sight sight_;
  Host host_;
  std::thread thread_;
};

template <class Condition>
[[nodiscard]] bool wait_until(Condition condition) {
  const auto deadline = Wall::now() + kPatience;
  while (!condition()) {
    if (Wall::now() > deadline) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

// The program that dies.

enum class Activity { kJog, kGoTo, kHome, kNothing };

constexpr int kCannotOpen = 10;
constexpr int kForbidden = 11;
constexpr int kPortFailed = 12;

Result<void> command(Activity activity, drive::Drive& drive, int cycle) {
  JointSpeeds slow;
  slow.fill(StepsPerSecond{cycle / 300 % 2 == 0 ? 400 : -400});
  auto goal = drive.telemetry() ? drive.telemetry()->position : JointSteps{};
  goal[0] = goal[0] - Steps{cycle / 300 % 2 == 0 ? 40 : -40};
  switch (activity) {
    case Activity::kJog:
      return drive.jog(slow);
    case Activity::kGoTo:
      return drive.telemetry() ? drive.go_to(goal, {}) : Result<void>{};
    case Activity::kHome:
      return cycle == 0 ? drive.home() : Result<void>{};
    case Activity::kNothing:
      break;
  }
  return {};
}

/// What a program does when its arm was stopped because nobody heard of it.
enum class WhenForbidden { kEnd, kResume };

/// Enables an arm until its board says that it has heard of it: one frame is lost if the program
/// was stopped in the middle of another.
Result<void> enable(drive::Drive& drive, drive::DriveLoop& loop) {
  using Kind = drive::DriveEvent::Kind;
  auto outcome = Kind::kNoEffect;
  (void)drive.take_events();
  while (outcome != Kind::kTookEffect) {
    if (outcome == Kind::kNoEffect && !drive.enable()) return fail(ErrorCode::kRefused);
    outcome = Kind::kLinkSilent;
    if (auto sent = loop.cycle(); !sent) return sent;
    for (const auto& event : drive.take_events()) {
      if (event.command == Command::kEnable) outcome = event.kind;
    }
  }
  return {};
}

/// Moves arms for ever, if it is let.
int move(const std::vector<std::string>& targets, Activity activity, WhenForbidden when_forbidden) {
  const Wiring<StreamPort> wiring{
      .device = "parol6", .make_judge = rig::make_judge, .open_real = open_target<StreamPort>};
  std::deque<Rig<StreamPort>> rigs;
  std::deque<drive::Drive> drives;
  std::deque<drive::DriveLoop> loops;
  for (const auto& target : targets) {
    RigOptions options;
    options.target = parse_target(target).value();
    options.permissions = Permissions::all();
    auto rig = Rig<StreamPort>::open(wiring, options);
    if (!rig) return kCannotOpen;
    rigs.push_back(*std::move(rig));
    loops.emplace_back(rigs.back().port(), drives.emplace_back());
  }
  for (int cycle = 0;; ++cycle) {
    for (std::size_t i = 0; i < rigs.size(); ++i) {
      (void)command(activity, drives[i], cycle);
      const auto done = loops[i].cycle();
      if (done) continue;
      if (done.error().code != ErrorCode::kForbidden) return kPortFailed;
      if (when_forbidden == WhenForbidden::kEnd) return kForbidden;
      if (!rigs[i].resume()) return kPortFailed;
      // On a busy machine nobody may hear of this program again meanwhile.
      const auto enabled = enable(drives[i], loops[i]);
      if (!enabled && enabled.error().code != ErrorCode::kForbidden) return kPortFailed;
    }
  }
}

/// A child process that moves arms.
class Mover {
 public:
  Mover(const std::vector<std::string>& targets, Activity activity,
        WhenForbidden when_forbidden = WhenForbidden::kEnd)
      : pid_{::fork()} {
    if (pid_ == 0) ::_exit(move(targets, activity, when_forbidden));
  }
  Mover(const Mover&) = delete;
  Mover& operator=(const Mover&) = delete;
  ~Mover() {
    if (pid_ > 0) signal(SIGKILL);
    if (pid_ > 0) (void)wait();
  }

  void signal(int number) const { ::kill(pid_, number); }
  [[nodiscard]] pid_t pid() const { return pid_; }
  /// The exit code, or minus the signal that ended it.
  int wait() {
    int status = 0;
    ::waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  }

 private:
  pid_t pid_;
};

/// The supervisors among the children of a process.
std::vector<pid_t> supervisors_of(pid_t parent) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator{"/proc"}) {
    std::ifstream stat{entry.path() / "stat"};
    pid_t pid{};
    pid_t its_parent{};
    std::string name;
    char state{};
    if (stat >> pid >> name >> state >> its_parent && its_parent == parent &&
        name == "(arm-supervisor)") {
      found.push_back(pid);
    }
  }
  return found;
}

// The tests.

using Dice = std::mt19937_64;

void sleep_up_to(Wall::duration most, Dice& dice) {
  const auto microseconds = std::chrono::duration_cast<std::chrono::microseconds>(most).count();
  std::this_thread::sleep_for(
      std::chrono::microseconds{dice() % static_cast<std::uint64_t>(microseconds)});
}

class SupervisorTest : public ::testing::Test {
 protected:
  /// Supervisors outlive their program; they are handed to us, and each of them has to end.
  SupervisorTest() { ::prctl(PR_SET_CHILD_SUBREAPER, 1); }
  ~SupervisorTest() override {
    EXPECT_TRUE(wait_until([] { return ::waitpid(-1, nullptr, WNOHANG) < 0; }))
        << "a supervisor does not end";
    std::cout << "moved on for at most "
              << std::chrono::duration_cast<std::chrono::microseconds>(worst_).count() << " us in "
              << count_ << " moments\n";
  }

  /// The arm has to come to rest because of what happened at `moment`, and to rest on.
  void expect_rest(const Sight& sight, Wall::time_point time) {
    const auto moment = time.time_since_epoch();
    ASSERT_TRUE(wait_until([&] { return sight.stands_since(moment); })) << "it does not stop";
    const auto last = sight.last_motion.load();
    std::this_thread::sleep_for(kAfterwards);
    EXPECT_EQ(sight.last_motion.load(), last) << "the arm moves again";
    const auto moved_on = last - moment;
    EXPECT_LT(moved_on, kBound);
    worst_ = std::max(worst_, moved_on);
    ++count_;
  }
  static void expect_motion(const Sight& sight) {
    ASSERT_TRUE(wait_until([&] { return sight.has_moved(); })) << "the arm never moved";
  }
  static void expect_disabled(const Sight& sight) {
    ASSERT_TRUE(wait_until([&] { return !sight.is_enabled; })) << "nobody sent the stop";
  }

  /// Kills the program of a moving arm.
  void kill_while_moving(Activity activity, Dice& dice) {
    Bench bench;
    Mover mover{{bench.target()}, activity};
    bench.start();
    expect_motion(bench.sight());
    sleep_up_to(300ms, dice);
    const auto moment = Wall::now();
    mover.signal(SIGKILL);
    expect_disabled(bench.sight());
    expect_rest(bench.sight(), moment);
  }

  /// Kills it while it opens the port, starts the supervisor, says its first words.
  void kill_while_beginning(Activity activity, Dice& dice) {
    Bench bench;
    Mover mover{{bench.target()}, activity};
    bench.start();
    sleep_up_to(40ms, dice);
    const auto moment = Wall::now();
    mover.signal(SIGKILL);
    expect_rest(bench.sight(), moment);
  }

  void kill_at_random_moments(Activity activity, int moments) {
    Dice dice{static_cast<std::uint64_t>(activity) + 1};
    for (int i = 0; i < moments; ++i) {
      SCOPED_TRACE(i);
      i % 3 == 0 ? kill_while_beginning(activity, dice) : kill_while_moving(activity, dice);
    }
  }

  /// A program that hangs; when it wakes up it must not go on.
  void hang(Activity activity, Dice& dice) {
    Bench bench;
    Mover mover{{bench.target()}, activity};
    bench.start();
    expect_motion(bench.sight());
    sleep_up_to(100ms, dice);
    const auto moment = Wall::now();
    mover.signal(SIGSTOP);
    expect_disabled(bench.sight());
    expect_rest(bench.sight(), moment);
    const auto last = bench.sight().last_motion.load();
    mover.signal(SIGCONT);
    // One that homes has only idle frames to send, which it may.
    if (activity != Activity::kHome) {
      EXPECT_EQ(mover.wait(), kForbidden);
    }
    std::this_thread::sleep_for(kAfterwards);
    EXPECT_EQ(bench.sight().last_motion.load(), last) << "it moves the arm when it wakes up";
  }

 private:
  Wall::duration worst_{};
  int count_ = 0;
};

TEST_F(SupervisorTest, AnArmThatJogsStopsWhenItsProgramIsKilled) {
  kill_at_random_moments(Activity::kJog, 15);
}

TEST_F(SupervisorTest, AnArmThatGoesToPlacesStopsWhenItsProgramIsKilled) {
  kill_at_random_moments(Activity::kGoTo, 9);
}

TEST_F(SupervisorTest, AnArmThatHomesStopsWhenItsProgramIsKilled) {
  kill_at_random_moments(Activity::kHome, 12);
}

TEST_F(SupervisorTest, AnArmStopsWhenItsProgramHangsAndDoesNotGoOn) {
  Dice dice{7};
  for (const auto activity : {Activity::kJog, Activity::kGoTo, Activity::kHome}) {
    SCOPED_TRACE(static_cast<int>(activity));
    hang(activity, dice);
  }
}

TEST_F(SupervisorTest, AProgramThatResumesMovesItsArmAgainAndIsWatchedAgain) {
  Bench bench;
  Mover mover{{bench.target()}, Activity::kJog, WhenForbidden::kResume};
  bench.start();
  for (int i = 0; i < 2; ++i) {
    expect_motion(bench.sight());
    const auto moment = Wall::now();
    mover.signal(SIGSTOP);
    expect_disabled(bench.sight());
    expect_rest(bench.sight(), moment);
    const auto last = bench.sight().last_motion.load();
    mover.signal(SIGCONT);
    ASSERT_TRUE(wait_until([&] { return bench.sight().last_motion.load() > last; }));
    ASSERT_THAT(supervisors_of(mover.pid()), ::testing::SizeIs(1));
  }
  const auto moment = Wall::now();
  mover.signal(SIGKILL);
  expect_disabled(bench.sight());
  expect_rest(bench.sight(), moment);
}

TEST_F(SupervisorTest, TwoArmsOfOneProgramBothStop) {
  Bench first;
  Bench second;
  Mover mover{{first.target(), second.target()}, Activity::kJog};
  first.start();
  second.start();
  expect_motion(first.sight());
  expect_motion(second.sight());
  const auto moment = Wall::now();
  mover.signal(SIGKILL);
  expect_disabled(first.sight());
  expect_disabled(second.sight());
  expect_rest(first.sight(), moment);
  expect_rest(second.sight(), moment);
}

TEST_F(SupervisorTest, AnArmStopsWhenItsSupervisorIsKilledAndItsProgramMayNotMoveItAnyMore) {
  Bench bench;
  Mover mover{{bench.target()}, Activity::kJog};
  bench.start();
  expect_motion(bench.sight());
  const auto supervisors = supervisors_of(mover.pid());
  ASSERT_THAT(supervisors, ::testing::SizeIs(1));
  const auto moment = Wall::now();
  ::kill(supervisors.front(), SIGKILL);
  expect_disabled(bench.sight());
  expect_rest(bench.sight(), moment);
  EXPECT_EQ(mover.wait(), kForbidden);
}

TEST_F(SupervisorTest, HasASessionOfItsOwnAndOnlyItsTwoFilesOpen) {
  Bench bench;
  Mover mover{{bench.target()}, Activity::kJog};
  bench.start();
  expect_motion(bench.sight());
  const auto supervisors = supervisors_of(mover.pid());
  ASSERT_THAT(supervisors, ::testing::SizeIs(1));
  EXPECT_EQ(::getsid(supervisors.front()), supervisors.front());
  const fs::path open_files{"/proc/" + std::to_string(supervisors.front()) + "/fd"};
  EXPECT_EQ(std::distance(fs::directory_iterator{open_files}, {}), 2);
}

TEST_F(SupervisorTest, OfAnArmThatStandsLeavesItAlone) {
  Bench bench;
  Mover mover{{bench.target()}, Activity::kNothing};
  bench.start();
  ASSERT_TRUE(wait_until([&] { return bench.sight().frames > 5; }));
  mover.signal(SIGKILL);
  EXPECT_EQ(mover.wait(), -SIGKILL);
  ASSERT_TRUE(wait_until([] { return ::waitpid(-1, nullptr, WNOHANG) < 0; }));
  EXPECT_TRUE(bench.sight().is_enabled);
}

// A bus: a socket to this process, on which each message is what its adapter would be told.

/// The end of a program that moves nodes.
class SocketBus final : public RealBus {
 public:
  explicit SocketBus(int socket) : socket_{socket} {}
  Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    for (const auto& message : messages) {
      std::vector<std::byte> bytes{head_of(message)};
      bytes.insert(bytes.end(), message.write.begin(), message.write.end());
      send(socket_, bytes);
    }
    return Transfer::kDone;
  }
  [[nodiscard]] std::optional<Lifeline> lifeline() const override {
    return Lifeline{socket_, send};
  }

 private:
  static void send(int socket, Bytes message) noexcept {
    (void)::send(socket, message.data(), message.size(), MSG_NOSIGNAL);
  }
  int socket_;
};

using BusLine = std::vector<std::byte>;

const BusLine kDisableNode2{std::byte{0x24}, std::byte{0}};
const BusLine kDisableNode3{std::byte{0x26}, std::byte{0}};

Result<void> command_node(BusPort& bus, std::uint8_t node) {
  constexpr std::array kHalfTurn{std::byte{2}, std::byte{0}, std::byte{0}, std::byte{0},
                                 std::byte{0x3F}};
  const auto message = write_to({static_cast<std::uint8_t>(0x10 + node)}, kHalfTurn);
  const auto sent = bus.transfer({&message, 1});
  return sent ? Result<void>{} : tl::unexpected{sent.error()};
}

/// Moves nodes 2 and 3 and disables 3; then looks at node 2 every 20 ms.
int move_nodes(int socket) {
  auto bus = GuardedBus::guard(std::make_unique<SocketBus>(socket), morap::rig::make_judge(),
                               Permissions::all());
  if (!bus) return kCannotOpen;
  auto& port = **bus;
  const auto disable = write_to({0x13}, std::span{kDisableNode3}.subspan(1));
  if (!command_node(port, 2) || !command_node(port, 3)) return kPortFailed;
  if (!port.transfer({&disable, 1})) return kPortFailed;
  constexpr std::array kStatus{std::byte{131}};
  const auto look = write_to({0x12}, kStatus);
  for (;;) {
    if (!port.transfer({&look, 1})) return kPortFailed;
    if (port.now() > at(2s) && !command_node(port, 2)) return kForbidden;
    port.wait_until(port.now() + 20ms);
  }
}

class BusSupervisorTest : public SupervisorTest {
 protected:
  BusSupervisorTest() {
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends_.data()), 0);
    mover_ = ::fork();
    if (mover_ == 0) ::_exit(move_nodes(ends_[0]));
    ::close(ends_[0]);
  }
  ~BusSupervisorTest() override {
    if (mover_ > 0) ::kill(mover_, SIGKILL);
    ::close(ends_[1]);
  }

  /// The next message; nothing once nobody holds the bus any more.
  [[nodiscard]] BusLine next() const {
    BusLine line(64);
    const auto size = ::recv(ends_[1], line.data(), line.size(), 0);
    line.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return line;
  }
  void wait_until_it_only_looks() const {
    const BusLine look{std::byte{0x24}, std::byte{131}};
    while (next() != look) {
    }
  }
  /// What comes after the last look, until nobody holds the bus.
  [[nodiscard]] std::vector<BusLine> last_messages() const {
    const BusLine look{std::byte{0x24}, std::byte{131}};
    std::vector<BusLine> all;
    for (auto line = next(); !line.empty(); line = next()) {
      if (line != look) all.push_back(line);
    }
    return all;
  }
  int wait_for_mover() {
    int status = 0;
    ::waitpid(std::exchange(mover_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  std::array<int, 2> ends_{};
  pid_t mover_ = -1;
};

TEST_F(BusSupervisorTest, StopsEachNodeThatMayBeMovingWhenItsProgramIsKilled) {
  wait_until_it_only_looks();
  const auto moment = Wall::now();
  ::kill(mover_, SIGKILL);
  EXPECT_EQ(wait_for_mover(), -SIGKILL);
  auto line = next();
  while (line != kDisableNode2 && !line.empty()) line = next();
  EXPECT_LT(Wall::now() - moment, kBound);
  const auto stops = last_messages();
  EXPECT_GT(stops.size(), 50U) << "for a second, should the first ones not come through";
  EXPECT_THAT(stops, ::testing::Each(kDisableNode2)) << "node 3 was known to stand";
}

TEST_F(BusSupervisorTest, StopsItWhenItsProgramHangsAndForbidsItToGoOn) {
  wait_until_it_only_looks();
  const auto moment = Wall::now();
  ::kill(mover_, SIGSTOP);
  while (next() != kDisableNode2) {
  }
  EXPECT_LT(Wall::now() - moment, kBound);
  std::this_thread::sleep_for(1500ms);  // until the supervisor has ended
  ::kill(mover_, SIGCONT);
  EXPECT_THAT(last_messages(), ::testing::Each(kDisableNode2));
  EXPECT_EQ(wait_for_mover(), kForbidden);
}

}  // namespace
}  // namespace armjig::parol6
