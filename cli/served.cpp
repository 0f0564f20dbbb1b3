// SPDX-License-Identifier: Apache-2.0
#include "cli/served.hpp"

#include <csignal>

namespace armjig::cli {

std::unique_ptr<Served> serve_aside(Host host) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, &before);
  auto served = std::make_unique<Served>(std::move(host));
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return served;
}

}  // namespace armjig::cli
