// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"kinovazed.robust.flood", Level::kMust,
     "Two hundred commands in one go are answered one by one, none lost.", "server; reference 2.6"},
    {"kinovazed.robust.slow-reader", Level::kMust,
     "A client that reads late gets every answer, in order.", "server; reference 4.5"},
    {"kinovazed.robust.junk", Level::kMust,
     "Lines of junk of any bytes are passed over, however many, and the next command is "
     "served.",
     "server; reference 3", Profiles::kFirmware, "kinovazed.robust.junk-rejected"},
    {"kinovazed.robust.junk-rejected", Level::kShould,
     "Lines of junk are Rejected one by one, and the next command is served.",
     "document is silent; our reading", Profiles::kDocumented, "kinovazed.robust.junk"},
    {"kinovazed.robust.clients", Level::kMust,
     "Twenty clients one after the other are served like the first.", "server; reference 1.6"},
    {"kinovazed.robust.resets", Level::kMust,
     "Clients that reset their connections, one after the other, do no harm.",
     "server; reference 1.9"},
    {"kinovazed.robust.half-closes", Level::kMust,
     "Clients that half-close behind a command, one after the other, are all answered.",
     "server; reference 1.11"},
    {"kinovazed.robust.split-flood", Level::kMust,
     "A stream of commands cut anywhere is answered command by command.", "server; reference 2.5"},
    {"kinovazed.robust.queue", Level::kMust,
     "Clients that come and go while another one is served do not disturb it.",
     "server; reference 1.6"},
};

}  // namespace

std::span<const Requirement> robust_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
