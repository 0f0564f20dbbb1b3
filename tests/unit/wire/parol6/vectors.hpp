// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/unit/support/bytes.hpp"

/// Frames from the reference, byte for byte; the names are its ids.
namespace armjig::parol6::vectors {

using test::hex;
using test::joined;
using test::zeros;

/// Section 1.6, sent by a host: jog at 1500, -3000, 3600, 0, 0, -18000 steps/s, OUT1 on, gripper to
/// 120 at 30 with 500 mA.
inline const auto kJogCommand = hex(
    "FF FF FF 34 00 28 00 FF 83 00 00 E2 31 00 00 00 00 00 00 00 7D 00 00 05 DC FF F4 48 00 0E 10 "
    "00 00 00 00 00 00 FF B9 B0 7B FF 20 00 00 78 00 1E 01 F4 D0 00 00 E4 01 02");

/// Section 1.6, sent by a board: homed and at rest, IN1 high, gripper at 119 with -200 mA.
inline const auto kRestTelemetry = hex(
    "FF FF FF 38 00 28 02 FF 82 FE 00 E2 33 00 00 00 00 00 00 00 7C FE 00 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 FF 8F 03 03 1B 78 64 FF 00 00 77 00 01 FF 38 E1 01 D4 01 02");

/// F3: the first frame of the vendor's program.
inline const auto kFirstCommand = hex(
    "FF FF FF 34 00 00 01 00 00 0B 00 00 6F 00 04 57 00 2B 67 00 00 0A 00 00 02 00 00 15 00 00 16 "
    "00 00 17 00 00 18 00 00 19 00 FF 00 00 00 01 00 01 00 01 01 00 00 E4 01 02");

/// F4: the Python API at rest.
inline const auto kIdleCommand =
    joined(hex("FF FF FF 34"), zeros(36), hex("FF 00 00 00 00 00 00 00 00 00 00 00 00 E4 01 02"));

/// F5: the Python API holding standby.
inline const auto kStandbyCommand =
    joined(hex("FF FF FF 34 00 28 00 FF 83 00 00 E2 31 00 00 00 00 00 00 00 7D 00"), zeros(18),
           hex("9C 00 00 00 00 00 00 00 00 00 00 00 00 E4 01 02"));

/// F6: one sample of a planned move of the vendor's program.
inline const auto kPlannedCommand =
    joined(hex("FF FF FF 34 00 23 D5 FF 83 01 00 E2 30 00 00 00 00 00 00 00 7D 00 FF F5 65"),
           zeros(15), hex("9C FF 00 00 00 01 00 01 00 01 D0 00 00 E4 01 02"));

/// F7: gripper values beyond one byte.
inline const auto kGripperCommand =
    joined(hex("FF FF FF 34"), zeros(36), hex("FF FF 00 00 01 2C 01 00 FF FE D0 00 05 E4 01 02"));

/// F8: the example of the vendor's document.
inline const auto kDocumentTelemetry = hex(
    "FF FF FF 38 00 00 FF 00 00 FE 00 00 FD 00 00 FC 00 00 FB 00 00 FA 00 00 F5 00 00 F4 00 00 F3 "
    "00 00 F2 00 00 F1 00 00 F0 FF 00 FF 00 00 FF F4 FF C8 01 2C 01 2C 01 2C C8 01 D4 01 02");

}  // namespace armjig::parol6::vectors
