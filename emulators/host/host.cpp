// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/host.hpp"

#include <utility>  // before Asio, which forgets it

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <future>
#include <mutex>
#include <thread>

#include "emulators/host/loop.hpp"
#include "emulators/host/paced_clock.hpp"
#include "harness/timing/lookout.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using boost::asio::posix::stream_descriptor;
using boost::system::error_code;
using Wall = PacedClock::Wall;

/// A device that nobody asks is brought up to date this often, so that the next question need not
/// wait for an hour of motion to be computed.
constexpr auto kKeepUp = 10ms;
/// If it takes that much longer, nobody looked after clients meanwhile.
constexpr auto kLate = 10ms;
/// Computing may take that long before clients have their turn again.
constexpr auto kBudget = 50ms;
/// Virtual time that is computed at once, between two looks at the budget.
constexpr Duration kStride = 1s;
/// How often whoever waits for the bus looks whether the loop still runs.
constexpr auto kGlance = 100ms;
/// Too short a wait to be worth a timer, whose waking alone takes as long.
constexpr auto kShortWait = 50us;

}  // namespace

class HostThread {
 public:
  [[nodiscard]] boost::asio::io_context& context() noexcept { return context_; }

 private:
  boost::asio::io_context context_{1};
};

std::shared_ptr<HostThread> make_host_thread() { return std::make_shared<HostThread>(); }

/// The device, its clock and what is in front of it on one io_context.
class Host::LoopOnAsio final : public Loop {
 public:
  LoopOnAsio(AnyHosted device, HostOptions options)
      : thread_{options.thread ? options.thread : make_host_thread()},
        options_{std::move(options)},
        hosted_{std::move(device)},
        device_{std::visit([](auto& kind) -> HostedDevice& { return *kind; }, hosted_)},
        front_{std::visit([this](auto& kind) { return make_front(*this, *kind); }, hosted_)},
        reached_{front_->begin()},
        clock_{options_.speed, Wall::now(), reached_},
        timer_{context_},
        waker_{context_} {
    if (const auto file = device_.wakes_by()) {
      waker_.assign(*file);
      wait_for_device();
    }
  }

  ~LoopOnAsio() override {
    context_.stop();                         // what is posted there may be for this one
    if (waker_.is_open()) waker_.release();  // the device closes it
  }

  [[nodiscard]] Outcome<void> listen() {
    auto listening = front_->listen(options_);
    if (listening) pump();
    return listening;
  }

  void run() {
    (void)lookout_.look(Wall::now());  // before that nobody was promised anything
    context_.run();
  }
  void stop() { context_.stop(); }

  void set_input(std::string name, std::int64_t value, std::function<void(bool is_taken)> tell) {
    boost::asio::post(context_, [this, name = std::move(name), value, tell = std::move(tell)] {
      const auto time = catch_up();
      tell(front_->set_input(name, value) || device_.set_input(time, name, value));
      pump();
    });
  }

  void with_bus(const std::function<void(BusPort& bus)>& use) {
    const auto turn = std::make_shared<BusTurn>();
    boost::asio::post(context_, [this, &use, turn] {
      const std::lock_guard lock{turn->guard};
      if (turn->is_given_up) return;
      auto& bus = *front_->bus();
      bus.wait_until(catch_up());
      use(bus);
      reach(bus.now());
      pump();
      turn->end.set_value(clock_.wall_time(bus.now(), Wall::now()));
    });
    auto end = turn->end.get_future();
    while (end.wait_for(kGlance) != std::future_status::ready) {
      const std::lock_guard lock{turn->guard};
      turn->is_given_up = context_.stopped();
      if (turn->is_given_up && end.wait_for(0s) != std::future_status::ready) return;
    }
    std::this_thread::sleep_until(end.get());
  }

  [[nodiscard]] std::vector<std::string> targets() const { return front_->targets(); }
  [[nodiscard]] std::vector<DeviceInput> inputs() const {
    auto all = front_->inputs();
    const auto of_device = device_.inputs();
    all.insert(all.end(), of_device.begin(), of_device.end());
    return all;
  }
  [[nodiscard]] HostStatistics statistics() const {
    return {.links = front_->statistics(), .lost = clock_.lost()};
  }

  // What the front sees.

  [[nodiscard]] boost::asio::io_context& context() noexcept override { return context_; }

  Instant catch_up() override {
    const auto start = Wall::now();
    const auto present = clock_.virtual_time(start);
    if (const auto gap = lookout_.look(start)) {
      device_.overlook(clock_.virtual_time(gap->from), present);
    }
    while (reached_ < present) {
      reached_ = std::min(present, reached_ + kStride);
      device_.advance_to(reached_);
      if (reached_ < present && Wall::now() - start > kBudget) {
        clock_.lose(present - reached_);
        break;
      }
    }
    return reached_;
  }

  [[nodiscard]] Instant present() const override { return clock_.virtual_time(Wall::now()); }

  [[nodiscard]] Wall::time_point wall_time(Instant time) const override {
    return clock_.wall_time(time, Wall::now());
  }

  void reach(Instant time) override { reached_ = std::max(reached_, time); }

  void pump() override {
    device_.advance_to(catch_up());
    front_->forward();
    for (const auto& line : device_.take_log()) log(line);
    if (device_.is_gone()) stop();
    const auto now = Wall::now();
    const auto next = device_.next_event();
    const auto due = next ? std::min(clock_.wall_time(*next, now), now + kKeepUp) : now + kKeepUp;
    due - now < kShortWait ? pump_soon() : pump_at(due);
  }

  void log(std::string_view line) const override { options_.log(line); }

 private:
  /// One use of the bus, by another thread.
  struct BusTurn {
    std::mutex guard;
    std::promise<Wall::time_point> end;
    bool is_given_up = false;
  };

  void wait_for_device() {
    waker_.async_wait(stream_descriptor::wait_read, [this](const error_code& error) {
      if (error) return;
      device_.wake(catch_up());
      pump();
      wait_for_device();
    });
  }

  void pump_soon() {
    if (std::exchange(is_pump_posted_, true)) return;
    boost::asio::post(context_, [this] {
      is_pump_posted_ = false;
      pump();
    });
  }

  /// A timer that is set and earlier will do, since a pump too many costs less than setting it anew
  /// with each message.
  void pump_at(Wall::time_point due) {
    if (is_timer_set_ && timer_.expiry() <= due) return;
    is_timer_set_ = true;
    timer_.expires_at(due);
    timer_.async_wait([this](const error_code& error) {
      if (error) return;
      is_timer_set_ = false;
      pump();
    });
  }

  std::shared_ptr<HostThread> thread_;
  boost::asio::io_context& context_ = thread_->context();
  HostOptions options_;
  AnyHosted hosted_;
  HostedDevice& device_;  ///< the one in `hosted_`
  std::unique_ptr<Front> front_;
  Instant reached_;
  PacedClock clock_;
  Lookout lookout_{kKeepUp + kLate, Wall::now()};
  boost::asio::steady_timer timer_;
  stream_descriptor waker_;  ///< of a device that is not emulated
  bool is_pump_posted_ = false;
  bool is_timer_set_ = false;
};

Host::Host(std::unique_ptr<LoopOnAsio> loop) noexcept : loop_{std::move(loop)} {}
Host::Host(Host&& other) noexcept = default;
Host& Host::operator=(Host&& other) noexcept = default;
Host::~Host() = default;

Outcome<Host> Host::open(AnyHosted device, HostOptions options) {
  if (!PacedClock::is_speed(options.speed)) {
    return problem(ErrorCode::kBadValue, "speed",
                   "it is a factor from 0.001 to 10000; 1 is real time");
  }
  try {
    auto loop = std::make_unique<LoopOnAsio>(std::move(device), std::move(options));
    if (auto outcome = loop->listen(); !outcome) return tl::unexpected{outcome.error()};
    return Host{std::move(loop)};
  } catch (const boost::system::system_error& error) {  // Asio out of descriptors
    return problem(ErrorCode::kSystem, "host", error.what());
  }
}

std::vector<std::string> Host::targets() const { return loop_->targets(); }
std::vector<DeviceInput> Host::inputs() const { return loop_->inputs(); }
void Host::run() { loop_->run(); }
void Host::stop() { loop_->stop(); }
void Host::set_input(std::string name, std::int64_t value,
                     std::function<void(bool is_taken)> tell) {
  loop_->set_input(std::move(name), value, std::move(tell));
}
void Host::with_bus(const std::function<void(BusPort& bus)>& use) { loop_->with_bus(use); }
HostStatistics Host::statistics() const { return loop_->statistics(); }

}  // namespace armjig
