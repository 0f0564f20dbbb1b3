// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/stage.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/device.hpp"
#include "cli/devices/devices.hpp"
#include "cli/diff.hpp"
#include "cli/fuzz_material.hpp"
#include "emulators/campaign/author.hpp"
#include "emulators/campaign/survey.hpp"
#include "emulators/campaign/talk.hpp"
#include "harness/link/port_around.hpp"
#include "harness/rig/judge.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

RigOptions rig_at(const std::string& target) {
  RigOptions rig;
  rig.target = parse_target(target).value();
  rig.permissions = parse_permissions("all").value();
  return rig;
}

/// What a campaign on a live device is made of. The device itself is not there.
class Live {
 public:
  Live(const std::string& name, const std::string& target)
      : device_{**cli::find_device(cli::shipped_devices(), name)},
        rules_{cli::rules_beside(device_, rig_at(target).target, "").value()},
        material_{cli::material_of(device_, rig_at(target), model_, 8s).value()},
        stage_{cli::stage_of(device_, rig_at(target), device_, model_, Hand{}, 220ms)} {
    material_.rules = rules_;
    excuses_.add({}, "connection", "time");
  }

  [[nodiscard]] const Material& material() const { return material_; }
  [[nodiscard]] const ComparisonRules& rules() const { return rules_; }
  [[nodiscard]] Script whole(const Script& script) const {
    return joined(spaced(with_ends(script), material_.spacing), material_.harmless, 20ms);
  }
  [[nodiscard]] BothHeard heard(const Script& script, std::uint64_t seed) const {
    return stage_->play_to_stand_in(whole(script), seed).value();
  }
  [[nodiscard]] std::optional<Symptom> symptom(const Script& script, std::uint64_t seed,
                                               const ComparisonRules& rules) const {
    const Judging judging{device_.make_dissector, rules, 20ms + rules.time_tolerance};
    return symptom_of(whole(script), heard(script, seed), judging, excuses_);
  }

 private:
  const cli::Device& device_;
  RigOptions model_ = rig_at("emulated:?profile=firmware");
  ComparisonRules rules_;
  Material material_;
  std::unique_ptr<Stage> stage_;
  Excuses excuses_;
};

std::vector<Live> all_live() {
  std::vector<Live> all;
  all.emplace_back("parol6", "pty:/tmp/nowhere");
  all.emplace_back("kinovazed", "tcp:127.0.0.1:1");
  all.emplace_back("morap", "i2c:/dev/nowhere");
  return all;
}

/// A moment that no model met may show once; a campaign takes what it sees only if it comes again.
TEST(Stage, HearsOfAStandInWhatSomeModelSays) {
  constexpr std::size_t kEvery = 41;
  constexpr std::array<std::size_t, 3> kAgain{1000, 2000, 3000};
  for (const auto& live : all_live()) {
    const Survey survey{live.material(), 1};
    std::size_t shown = 0;
    for (std::size_t i = 0; i < survey.size(); i += kEvery) {
      const auto script = survey.at(i);
      const auto symptom = live.symptom(script, i, live.rules());
      if (!symptom) continue;
      ++shown;
      EXPECT_FALSE(
          std::ranges::all_of(kAgain,
                              [&](std::size_t again) {
                                return live.symptom(script, i + again, live.rules()).has_value();
                              }))
          << i << ": " << symptom->key() << ", " << symptom->actual;
    }
    EXPECT_LE(shown, 1U);
  }
}

TEST(Stage, GivesAStandInAllAsUnevenlyAsALinkDoes) {
  for (const auto& live : all_live()) {
    const auto script = Author{live.material()}.draw(4, {});
    EXPECT_TRUE(live.symptom(script, 1, {}));
    EXPECT_EQ(live.heard(script, 1).target.said, live.heard(script, 1).target.said);
    EXPECT_NE(live.heard(script, 1).target.said, live.heard(script, 2).target.said);
  }
}

/// Nobody can tell then which part of a transaction was refused.
TEST(Stage, ReachesAStandInByWholeTransactions) {
  const auto to_nobody = [](Duration time, Direction direction, std::string details) {
    return KeptRecord{.time = at(time),
                      .kind = LinkKind::kBus,
                      .direction = direction,
                      .id = 0x50,
                      .details = std::move(details)};
  };
  const Live nodes{"morap", "i2c:/dev/nowhere"};
  const Script both{to_nobody(10ms, Direction::kToDevice, R"("stop":false)"),
                    to_nobody(13ms, Direction::kFromDevice, R"("n":1)")};
  const auto heard = nodes.heard(both, 1);
  const auto count = [](const std::vector<KeptRecord>& said) {
    return std::ranges::count(said, 0x50U, &KeptRecord::id);
  };
  EXPECT_EQ(count(heard.target.said), 1);
  EXPECT_EQ(count(heard.models.front().said), 2);
}

/// Frames that come 6 ms apart come 5 or 7 ms apart to some, while a joint moves by 3 steps a
/// millisecond.
TEST(Stage, HasModelsThatDifferWhereItMattersHowFarApartMessagesCame) {
  const Live board{"parol6", "pty:/tmp/nowhere"};
  parol6::CommandFrame jog{.command = parol6::Command::kJog};
  jog.speed.front() = StepsPerSecond{3000};
  const auto bytes = encode(jog);
  Script script;
  for (int i = 0; i < 8; ++i) {
    script.push_back({.time = Instant{6ms * i},
                      .kind = LinkKind::kStream,
                      .direction = Direction::kToDevice,
                      .bytes = {bytes.begin(), bytes.end()}});
  }
  std::set<std::int64_t> places;
  for (const auto& model : board.heard(script, 1).models) {
    const auto said = messages_of(model.said, parol6::make_dissector);
    const auto& fourth = said.lanes().begin()->second.at(4).message;
    places.insert(field_value(*find_field(fourth.fields, "position.j1"), fourth.raw));
  }
  EXPECT_GT(*places.rbegin() - *places.begin(), 2);
}

/// An emulated board in memory with a supervisor of its own.
class SupervisedBoard final : public StreamAround {
 public:
  using StreamAround::StreamAround;
  Result<void> write(Bytes bytes) override { return inner().write(bytes); }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    return inner().read(into, deadline);
  }
  [[nodiscard]] std::optional<Lifeline> lifeline() const override {
    return Lifeline{STDERR_FILENO, [](int /*descriptor*/, Bytes /*message*/) noexcept {}};
  }
};

/// Who was read, in order, but for repetitions: the target, or a model by its number.
constexpr int kTarget = -1;
std::vector<int> who_was_read;  // NOLINT(*-global-*): whoever opens ports has no captures

/// An emulated board that notes when it is read.
class NotingBoard final : public StreamAround {
 public:
  NotingBoard(std::unique_ptr<StreamPort> board, int who)
      : StreamAround{std::move(board)}, who_{who} {}
  Result<void> write(Bytes bytes) override { return inner().write(bytes); }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    if (who_was_read.empty() || who_was_read.back() != who_) who_was_read.push_back(who_);
    return inner().read(into, deadline);
  }

 private:
  int who_;
};

Outcome<std::unique_ptr<StreamPort>> noting_board(int who) {
  auto board = test::wiring<cli::OnStream>("parol6").open_emulated(*parse_target("emulated:"));
  return std::make_unique<NotingBoard>(*std::move(board), who);
}

/// Many models of a long case take longer than a supervisor waits, and the guard looks at bounds
/// only when it is called.
TEST(Stage, LetsTheGuardLookAtTheTargetBetweenTheModels) {
  StageSetup<StreamPort> setup;
  setup.make_target = [] {
    auto wiring = test::wiring<cli::OnStream>("parol6");
    wiring.open_real = [](const Target& /*place*/, const SerialLine& /*line*/) {
      return noting_board(kTarget);
    };
    return Rig<StreamPort>::open(wiring, rig_at("pty:/dev/null"));
  };
  int models = 0;
  setup.make_model = [&models] {
    return Outcome<Rig<StreamPort>>{Rig<StreamPort>{*noting_board(models++)}};
  };
  StageOn<StreamPort> stage{std::move(setup)};
  ASSERT_TRUE(stage.reset());
  who_was_read.clear();
  const KeptRecord sent{.kind = LinkKind::kStream, .bytes = {std::byte{}}};
  ASSERT_TRUE(stage.play({sent}));
  EXPECT_GE(std::ranges::count(who_was_read, kTarget), models);
  EXPECT_GT(models, 1);
}

/// A client of a server that takes none before a moment.
class EarlyClient final : public SessionAround {
 public:
  EarlyClient(std::unique_ptr<SessionPort> inner, Instant opens)
      : SessionAround{std::move(inner)}, opens_{opens} {}
  Result<void> connect(Instant deadline) override {
    if (now() < opens_) return fail(ErrorCode::kRefused);
    return inner().connect(deadline);
  }
  Result<void> send(Bytes segment) override { return inner().send(segment); }
  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    return inner().receive(into, deadline);
  }
  void half_close() override { inner().half_close(); }
  void close() override { inner().close(); }
  void reset() override { inner().reset(); }

 private:
  Instant opens_;
};

/// An emulated server that listens so much later than it could.
StageSetup<SessionSource> server_late_by(Duration late) {
  StageSetup<SessionSource> setup;
  setup.make_target = [late] {
    auto server =
        *test::wiring<cli::OnServer>("kinovazed").open_emulated(*parse_target("emulated:"));
    const auto opens = server->now() + late;
    return Outcome<Rig<SessionSource>>{Rig<SessionSource>{std::make_unique<SourceAround>(
        std::move(server), [opens](std::unique_ptr<SessionPort> port) {
          return std::make_unique<EarlyClient>(std::move(port), opens);
        })}};
  };
  return setup;
}

/// When a server listens decides who hosts it.
TEST(Stage, WaitsAWhileForAServerThatTakesNoClientYet) {
  EXPECT_TRUE(StageOn<SessionSource>{server_late_by(50ms)}.reset());
  const auto never = StageOn<SessionSource>{server_late_by(1s)}.reset();
  ASSERT_FALSE(never);
  EXPECT_EQ(never.error().code, ErrorCode::kRefused);
}

Rig<StreamPort> supervised_board() {
  auto wiring = test::wiring<cli::OnStream>("parol6");
  wiring.open_real = [](const Target& /*place*/,
                        const SerialLine& /*line*/) -> Outcome<std::unique_ptr<StreamPort>> {
    auto board = test::wiring<cli::OnStream>("parol6").open_emulated(*parse_target("emulated:"));
    return std::make_unique<SupervisedBoard>(*std::move(board));
  };
  return *Rig<StreamPort>::open(wiring, rig_at("pty:/dev/null"));
}

/// As they end when they have stopped an arm of which nothing is heard.
void end_supervisors() {
  for (const auto& entry : std::filesystem::directory_iterator{"/proc"}) {
    std::ifstream stat{entry.path() / "stat"};
    pid_t pid{};
    pid_t parent{};
    std::string name;
    char state{};
    if (stat >> pid >> name >> state >> parent && parent == ::getpid() &&
        name == "(arm-supervisor)") {
      ::kill(pid, SIGKILL);
      ::waitpid(pid, nullptr, 0);
    }
  }
}

/// The target stands then where the models go on.
TEST(Stage, RefusesWhatComesAfterAStopOfItsSupervisor) {
  StageSetup<StreamPort> setup;
  setup.make_target = [] { return Outcome<Rig<StreamPort>>{supervised_board()}; };
  StageOn<StreamPort> stage{std::move(setup)};
  ASSERT_TRUE(stage.reset());
  ASSERT_TRUE(stage.play({}));
  end_supervisors();
  const auto played = stage.play({});
  ASSERT_FALSE(played);
  EXPECT_EQ(played.error().code, ErrorCode::kForbidden);
  EXPECT_TRUE(stage.play({}));
}

}  // namespace
}  // namespace armjig::campaign
