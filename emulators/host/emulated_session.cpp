// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/emulated_session.hpp"

#include <utility>

#include "emulators/host/kinovazed_options.hpp"
#include "emulators/kinovazed/single_client.hpp"
#include "harness/link/memory_session.hpp"

namespace armjig {

Outcome<std::unique_ptr<SessionPort>> open_kinovazed_session(const Target& target) {
  auto server = kinovazed::make_server(target.options, target.text);
  if (!server) return tl::unexpected{server.error()};
  using Client = kinovazed::SingleClient<kinovazed::DefectiveServer>;
  Client client{*std::move(server)};
  const auto start = client.start();
  return std::make_unique<MemorySession<Client>>(std::move(client), start);
}

}  // namespace armjig
