// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/host.hpp"

#include <utility>  // before Asio, which forgets it

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>

#include "emulators/host/paced_clock.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using boost::system::error_code;
using Wall = PacedClock::Wall;

/// A device that nobody asks is brought up to date this often, so that the next question need not
/// wait for an hour of motion to be computed.
constexpr auto kKeepUp = 10ms;
/// Computing may take that long before clients have their turn again.
constexpr auto kBudget = 50ms;
/// Virtual time that is computed at once, between two looks at the budget.
constexpr Duration kStride = 1s;
/// Too short a wait to be worth a timer, whose waking alone takes as long.
constexpr auto kShortWait = 50us;

}  // namespace

/// The device, its clock and its links on one io_context.
class Host::Loop {
 public:
  Loop(std::unique_ptr<HostedStream> device, const HostOptions& options)
      : device_{std::move(device)},
        clock_{options.speed, Wall::now()},
        timer_{context_},
        signals_{context_} {
    if (options.on_signal == HostOptions::OnSignal::kStop) {
      signals_.add(SIGINT);
      signals_.add(SIGTERM);
      signals_.async_wait([this](const error_code& error, int) {
        if (!error) stop();
      });
    }
    pump();
  }

  [[nodiscard]] Outcome<void> listen(const HostOptions& options) {
    if (options.pty) {
      auto added = add(open_pty_link(context_, *options.pty, events(options)));
      if (!added) return added;
    }
    if (options.tcp) return add(open_tcp_link(context_, *options.tcp, events(options)));
    return {};
  }

  void run() { context_.run(); }
  void stop() { context_.stop(); }

  void set_input(std::string name, std::int64_t value, std::function<void(bool is_taken)> tell) {
    boost::asio::post(context_, [this, name = std::move(name), value, tell = std::move(tell)] {
      catch_up();
      tell(device_->set_input(reached_, name, value));
      pump();
    });
  }

  [[nodiscard]] std::vector<std::string> targets() const {
    std::vector<std::string> all;
    for (const auto& link : links_) {
      for (auto& target : link->targets()) all.push_back(std::move(target));
    }
    return all;
  }

  [[nodiscard]] HostStatistics statistics() const {
    HostStatistics sum{.links = {}, .lost = clock_.lost()};
    for (const auto& link : links_) {
      const auto part = link->statistics();
      sum.links.clients += part.clients;
      sum.links.refused += part.refused;
      sum.links.bytes_in += part.bytes_in;
      sum.links.bytes_out += part.bytes_out;
      sum.links.frames_dropped += part.frames_dropped;
    }
    return sum;
  }

 private:
  [[nodiscard]] Outcome<void> add(Outcome<std::unique_ptr<ClientLink>> link) {
    if (!link) return tl::unexpected{link.error()};
    links_.push_back(std::move(*link));
    return {};
  }

  [[nodiscard]] LinkEvents events(const HostOptions& options) {
    return {.on_bytes = [this](ClientLink& from, Bytes bytes) { receive(from, bytes); },
            .on_log = options.log};
  }

  void receive(ClientLink& from, Bytes bytes) {
    catch_up();
    listener_ = &from;
    device_->receive(reached_, bytes);
    pump();
  }

  /// Lets the device do what is due, forwards what it sends, and sees to it that this happens
  /// again.
  void pump() {
    catch_up();
    forward();
    const auto now = Wall::now();
    const auto next = device_->next_event();
    const auto due = next ? std::min(clock_.wall_time(*next, now), now + kKeepUp) : now + kKeepUp;
    due - now < kShortWait ? pump_soon() : pump_at(due);
  }

  /// Brings the device to the present, unless that takes too long: then time is lost.
  void catch_up() {
    const auto start = Wall::now();
    const auto present = clock_.virtual_time(start);
    while (reached_ < present) {
      reached_ = std::min(present, reached_ + kStride);
      device_->advance_to(reached_);
      if (reached_ < present && Wall::now() - start > kBudget) {
        clock_.lose(present - reached_);
        return;
      }
    }
  }

  void forward() {
    for (const auto& message : device_->sent()) {
      if (listener_ != nullptr) listener_->send(message.bytes);
    }
    device_->clear_sent();
  }

  void pump_soon() {
    if (std::exchange(is_pump_posted_, true)) return;
    boost::asio::post(context_, [this] {
      is_pump_posted_ = false;
      pump();
    });
  }

  void pump_at(Wall::time_point due) {
    timer_.expires_at(due);
    timer_.async_wait([this](const error_code& error) {
      if (!error) pump();
    });
  }

  boost::asio::io_context context_{1};
  std::unique_ptr<HostedStream> device_;
  PacedClock clock_;
  Instant reached_{};
  boost::asio::steady_timer timer_;
  boost::asio::signal_set signals_;
  std::vector<std::unique_ptr<ClientLink>> links_;
  ClientLink* listener_ = nullptr;  ///< who gets answers: one of `links_`
  bool is_pump_posted_ = false;
};

Host::Host(std::unique_ptr<Loop> loop) noexcept : loop_{std::move(loop)} {}
Host::Host(Host&& other) noexcept = default;
Host& Host::operator=(Host&& other) noexcept = default;
Host::~Host() = default;

Outcome<Host> Host::open(std::unique_ptr<HostedStream> device, const HostOptions& options) {
  if (!PacedClock::is_speed(options.speed)) {
    return problem(ErrorCode::kBadValue, "speed",
                   "it is a factor from 0.001 to 10000; 1 is real time");
  }
  if (!options.pty && !options.tcp) {
    return problem(ErrorCode::kBadValue, "host", "a pseudo-terminal or a TCP port is needed");
  }
  try {
    auto loop = std::make_unique<Loop>(std::move(device), options);
    if (auto outcome = loop->listen(options); !outcome) return tl::unexpected{outcome.error()};
    return Host{std::move(loop)};
  } catch (const boost::system::system_error& error) {  // Asio out of descriptors
    return problem(ErrorCode::kSystem, "host", error.what());
  }
}

std::vector<std::string> Host::targets() const { return loop_->targets(); }
void Host::run() { loop_->run(); }
void Host::stop() { loop_->stop(); }
void Host::set_input(std::string name, std::int64_t value,
                     std::function<void(bool is_taken)> tell) {
  loop_->set_input(std::move(name), value, std::move(tell));
}
HostStatistics Host::statistics() const { return loop_->statistics(); }

}  // namespace armjig
