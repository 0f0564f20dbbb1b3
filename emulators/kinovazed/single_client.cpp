// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/single_client.hpp"

namespace armjig::kinovazed {

SingleClient::SingleClient(Server server) : server_{std::move(server)} {
  constexpr auto kPatience = at(std::chrono::seconds{1});
  while (server_.life() == Server::Life::kStarting) {
    const auto next = server_.next_event();
    if (!next || *next > kPatience) return;
    start_ = *next;
    server_.advance_to(start_);
  }
}

bool SingleClient::connect(Instant time) {
  sent_.clear();
  server_.clear_sent();
  const auto client = server_.connect(time);
  if (client) client_ = *client;
  return client.has_value();
}

void SingleClient::advance_to(Instant time) {
  server_.advance_to(time);
  for (const auto& event : server_.sent()) {
    if (event.connection == client_) sent_.push_back({event.time, event.kind, event.bytes});
  }
  server_.clear_sent();
}

}  // namespace armjig::kinovazed
