// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/served.hpp"

#include <csignal>
#include <utility>

namespace armjig {

Served::Served(Host host, std::function<void()> when_over)
    : host_{std::move(host)}, when_over_{std::move(when_over)}, thread_{[this] {
        host_.run();
        when_over_();
      }} {}

void Served::end() {
  host_.stop();
  if (thread_.joinable()) thread_.join();
}

std::unique_ptr<Served> serve_aside(Host host, std::function<void()> when_over) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, &before);
  auto served = std::make_unique<Served>(std::move(host), std::move(when_over));
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return served;
}

}  // namespace armjig
