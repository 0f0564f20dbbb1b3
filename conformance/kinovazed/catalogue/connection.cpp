// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"kinovazed.connection.silent-start", Level::kMust,
     "Nothing is sent because somebody connects: the first message is a heartbeat.",
     "server, recording connection-reconnect-idle"},
    {"kinovazed.connection.beat-goes-on", Level::kMust,
     "Connecting does not move the heartbeats: a new client hears the next one when it would have "
     "come anyway.",
     "server, recording heartbeat-first"},
    {"kinovazed.connection.one", Level::kMust,
     "While a client is served another one that connects hears nothing, not even heartbeats.",
     "server, recording connection-second-waits"},
    {"kinovazed.connection.next", Level::kMust,
     "When the client that was served leaves, the one that waits hears the heartbeats.",
     "server, recording connection-second-waits"},
    {"kinovazed.connection.order", Level::kMust,
     "Clients that wait are served in the order in which they connected.",
     "server, recording connection-three"},
    {"kinovazed.connection.waiting-bytes", Level::kMust,
     "What a waiting client has sent is carried out and answered when its turn comes.",
     "server, recording connection-second-waits"},
    {"kinovazed.connection.waiting-closed", Level::kMust,
     "What a waiting client has sent is carried out also if it has closed meanwhile.",
     "server; reference 1.7"},
    {"kinovazed.connection.again", Level::kMust,
     "When a client has closed its connection a new one is served.",
     "server, recording connection-reconnect-idle"},
    {"kinovazed.connection.reset", Level::kMust,
     "When a client has reset its connection a new one is served.",
     "server, recording connection-rst"},
    {"kinovazed.connection.half-close", Level::kMust,
     "Complete lines before a half-close are served and answered; then the server closes.",
     "server, recording connection-half-close"},
    {"kinovazed.connection.half-close-unfinished", Level::kMust,
     "A line without LF before a half-close is not served; the server closes without an answer.",
     "server, transcript S3"},
    {"kinovazed.connection.unfinished", Level::kMust,
     "A line of less than 128 bytes that a client left unfinished leaves no trace.",
     "server, recording framing-partial-dropped"},
    {"kinovazed.connection.keeps-state", Level::kMust,
     "Losing a client changes no state: the next one finds the joystick mode and may steer.",
     "server, transcript S4"},
    {"kinovazed.connection.no-watchdog", Level::kMust,
     "Losing a client does not stop an objective; its ObjectiveDone goes to the next client.",
     "server, recording connection-reconnect-mid-objective"},
    {"kinovazed.connection.dropped", Level::kMust,
     "Messages that arise while nobody is connected are lost; only the heartbeat shows the state.",
     "server, transcript S5"},
    {"kinovazed.connection.stays-open", Level::kMust, "A client that says nothing stays connected.",
     "server; reference 1.13"},
};

}  // namespace

std::span<const Requirement> connection_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
