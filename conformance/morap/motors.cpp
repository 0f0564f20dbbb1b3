// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/motors.hpp"

#include <array>

namespace armjig::morap::conformance {
namespace {

using enum TuneKind;

constexpr auto kDcx22lTuned = std::to_array<Tuned>({
    {{kPdPosition, 0.05F, -6.0F},
     "00 71 02 02 62 8E 54 BF 48 58 91 3F 02 B4 8E 54 BF 71 58 91 3F 01 05 2E 7B BF 00 00 00 00 "
     "B0"},
    {{kPdPosition, 0.05F, -9.0F},
     "00 71 02 02 3D 02 EE BF A1 BF 22 40 02 BB 01 EE BF 60 BF 22 40 01 B4 CD 78 BF 00 00 00 00 "
     "2D"},
    {{kPdPosition, 0.05F, -12.0F},
     "00 71 02 02 DF 92 52 C0 3F FD 8F 40 02 30 93 52 C0 68 FD 8F 40 01 0E 73 76 BF 00 00 00 00 "
     "30"},
    {{kPdPosition, 0.2F, -6.0F},
     "00 90 01 02 EB 1E 6B C0 8E BD 84 40 02 5E 1E 6B C0 48 BD 84 40 01 0F 82 78 BF 00 00 00 00 "
     "E4"},
    {{kPdPosition, 0.2F, -9.0F},
     "00 90 01 02 36 4B 03 C1 51 3F 14 41 02 2C 4B 03 C1 47 3F 14 41 01 FE D7 74 BF 00 00 00 00 "
     "1A"},
    {{kPdPosition, 0.2F, -12.0F},
     "00 90 01 02 53 BA 67 C1 37 D3 82 41 02 52 BA 67 C1 36 D3 82 41 01 71 3B 71 BF 00 00 00 00 "
     "81"},
    {{kPdPosition, 0.5F, -9.0F},
     "00 90 01 02 89 79 AA C1 96 F3 B2 41 02 82 79 AA C1 8F F3 B2 41 01 FE D7 74 BF 00 00 00 00 "
     "90"},
    {{kPdPosition, 1.0F, -9.0F},
     "00 90 01 02 02 98 2C C2 09 D5 30 42 02 05 98 2C C2 0C D5 30 42 01 FE D7 74 BF 00 00 00 00 "
     "A2"},
    {{kPdPosition, 1.5F, -9.0F},
     "00 90 01 02 1A 22 07 C2 24 56 09 42 02 19 22 07 C2 23 56 09 42 01 7A EE 77 BF 00 00 00 00 "
     "33"},
    {{kPidPosition, 0.05F, -9.0F},
     "00 71 02 02 46 E4 8C C2 B2 CC C0 42 02 45 38 CB BF C0 BC 0E 40 01 DE C9 35 BF C9 8B 22 3F "
     "61"},
    {{kPidPosition, 0.2F, -6.0F},
     "00 90 01 02 DA B9 6B C2 0D 45 85 42 02 F0 0A 5B C0 66 53 7D 40 01 02 0F 5C BF 47 01 C6 3E "
     "83"},
    {{kPidPosition, 0.2F, -9.0F},
     "00 90 01 02 ED 9B B4 C2 AD 80 CC 42 02 13 95 F3 C0 24 18 0E 41 01 67 CB 58 BF 52 CF 4A 3F "
     "4B"},
    {{kPidPosition, 0.5F, -9.0F},
     "00 90 01 02 87 E6 DA C2 FD CC E6 42 02 8A 8A A4 C1 F8 C8 B0 41 01 E4 3B 69 BF A4 8F 10 3F "
     "6D"},
    {{kPidPosition, 1.0F, -6.0F},
     "00 90 01 02 3B 30 A0 C2 00 A5 A4 42 02 8D AE 97 C1 07 7F 9D 41 01 A3 8C 72 BF 32 A2 5D 3E "
     "40"},
    {{kPiSpeed, 0.05F, -40.0F},
     "01 71 02 02 73 D9 C9 3C 73 D9 C9 3C 02 35 87 42 BF FE 7B 8C 3F 01 E3 3E 2F BF 99 57 91 3E "
     "09"},
    {{kPiSpeed, 0.05F, -60.0F},
     "01 71 02 02 DF 6C 4E 3D DF 6C 4E 3D 02 5C 2C 8E BF 0F B5 D1 3F 01 E3 82 29 BF 0D DA C8 3E "
     "EB"},
    {{kPiSpeed, 0.1F, -50.0F},
     "01 40 01 02 5E B0 EC 3D 5E B0 EC 3D 02 69 9F E4 BF 57 9B 2C 40 01 BF 58 20 BF 73 38 0D 3F "
     "49"},
    {{kPiSpeed, 0.2F, -20.0F},
     "01 40 01 02 11 8C 34 3D 11 8C 34 3D 02 0C 00 E6 BF B6 F8 0B 40 01 81 7C 4E BF FF 70 72 3E "
     "BF"},
    {{kPiSpeed, 0.2F, -40.0F},
     "01 40 01 02 D4 EA 07 3E D4 EA 07 3E 02 AA AD 5C C0 F9 A1 89 40 01 2B CA 41 BF E5 A9 BB 3E "
     "53"},
    {{kPiSpeed, 0.5F, -40.0F},
     "01 40 01 02 38 9E 9C 3D 38 9E 9C 3D 02 49 0F 9A C0 1E BE A8 40 01 4E B9 62 BF D6 1D 26 3E "
     "5B"},
    {{kPiSpeed, 1.0F, -20.0F},
     "01 40 01 02 41 3A 21 3D 41 3A 21 3D 02 68 5F A2 C0 23 EE A9 40 01 5D EE 70 BF D6 1D A6 3D "
     "89"},
});

constexpr auto kDcx26lTuned = std::to_array<Tuned>({
    {{kPdPosition, 0.05F, -6.0F},
     "00 71 02 02 46 C3 34 BF EE A8 63 3F 02 88 C3 34 BF 30 A9 63 3F 01 05 2E 7B BF 00 00 00 00 "
     "24"},
    {{kPdPosition, 0.05F, -9.0F},
     "00 71 02 02 10 67 CA BF 24 EA FE 3F 02 0F 68 CA BF 24 EB FE 3F 01 B4 CD 78 BF 00 00 00 00 "
     "2D"},
    {{kPdPosition, 0.05F, -12.0F},
     "00 71 02 02 AC 13 33 C0 5B 89 61 40 02 EE 13 33 C0 9C 89 61 40 01 0E 73 76 BF 00 00 00 00 "
     "D7"},
    {{kPdPosition, 0.2F, -6.0F},
     "00 90 01 02 61 06 42 C0 62 3F 54 40 02 77 06 42 C0 78 3F 54 40 01 0F 82 78 BF 00 00 00 00 "
     "32"},
    {{kPdPosition, 0.2F, -9.0F},
     "00 90 01 02 63 B1 D8 C0 65 0B ED 40 02 6A B1 D8 C0 6C 0B ED 40 01 FE D7 74 BF 00 00 00 00 "
     "B5"},
    {{kPdPosition, 0.2F, -12.0F},
     "00 90 01 02 18 3A 3F C1 D2 2F 51 41 02 21 3A 3F C1 DC 2F 51 41 01 71 3B 71 BF 00 00 00 00 "
     "A8"},
    {{kPdPosition, 0.5F, -9.0F},
     "00 90 01 02 C2 3F 8B C1 42 56 90 41 02 C2 3F 8B C1 43 56 90 41 01 FE D7 74 BF 00 00 00 00 "
     "E9"},
    {{kPdPosition, 1.0F, -9.0F},
     "00 90 01 02 F5 7C B3 C1 CF BC B6 41 02 F6 7C B3 C1 D0 BC B6 41 01 8A 10 77 BF 00 00 00 00 "
     "BC"},
    {{kPdPosition, 1.5F, -9.0F},
     "00 90 01 02 B7 71 71 C1 76 59 74 41 02 B7 71 71 C1 76 59 74 41 01 1B 02 7A BF 00 00 00 00 "
     "4E"},
    {{kPidPosition, 0.05F, -9.0F},
     "00 71 02 02 2E 09 39 C2 AE 39 69 42 02 A9 37 B3 BF 53 99 E7 3F 01 67 77 45 BF 79 83 BD 3E "
     "7B"},
    {{kPidPosition, 0.2F, -6.0F},
     "00 90 01 02 13 02 15 C2 6F 49 23 42 02 7F A4 37 C0 43 6F 4D 40 01 76 27 63 BF 8B 4B 5E 3E "
     "CD"},
    {{kPidPosition, 0.2F, -9.0F},
     "00 90 01 02 6D 67 66 C2 D6 E3 7C 42 02 AF 59 CC C0 DF 50 E6 40 01 D9 CA 5F BF AE 6B DE 3E "
     "09"},
    {{kPidPosition, 0.5F, -9.0F},
     "00 90 01 02 0F E8 8D C2 E7 CB 93 42 02 6C 76 87 C1 73 3B 8F 41 01 8F 34 6C BF 0A 81 94 3E "
     "9D"},
    {{kPidPosition, 1.0F, -6.0F},
     "00 90 01 02 B7 B4 51 C2 68 36 56 42 02 CC 07 78 C1 83 5C 7F 41 01 6D 16 74 BF 72 DC DE 3D "
     "DF"},
    {{kPiSpeed, 0.05F, -40.0F},
     "01 90 01 02 63 28 E9 3C 63 28 E9 3C 02 33 9E 11 BF 5E 0D 63 3F 01 7B 75 20 BF 1F 92 80 3E "
     "13"},
    {{kPiSpeed, 0.05F, -60.0F},
     "01 90 01 02 4C D0 67 3D 4C D0 67 3D 02 00 4C 52 BF A8 C8 A8 3F 01 B6 28 18 BF B3 E7 AD 3E "
     "EE"},
    {{kPiSpeed, 0.1F, -50.0F},
     "01 40 01 02 70 3D B1 3D 70 3D B1 3D 02 C1 86 CA BF 5B 51 0B 40 01 A6 28 2E BF 9F 65 97 3E "
     "1D"},
    {{kPiSpeed, 0.2F, -20.0F},
     "01 40 01 02 80 48 07 3D 80 48 07 3D 02 76 A5 C2 BF F9 B9 E2 3F 01 50 E2 56 BF 50 F4 03 3E "
     "5A"},
    {{kPiSpeed, 0.2F, -40.0F},
     "01 40 01 02 EB C2 A5 3D EB C2 A5 3D 02 EA 3D 29 C0 76 52 48 40 01 64 60 4C BF 4D 59 38 3E "
     "44"},
    {{kPiSpeed, 0.5F, -40.0F},
     "01 40 01 02 EE 25 0D 3D EE 25 0D 3D 02 69 10 3E C0 F7 4B 4B 40 01 5E 05 6A BF A4 7A 93 3D "
     "37"},
    {{kPiSpeed, 1.0F, -20.0F},
     "01 40 01 02 84 3E 90 3C 84 3E 90 3C 02 23 9D 45 C0 11 60 4C 40 01 FA C4 74 BF A4 7A 13 3D "
     "71"},
});

constexpr std::array kMotors{
    Motor{.known = kDcx22l,
          .position_set = "00 71 02 02 CE 19 C9 BF 86 C9 10 40 02 CE 19 C9 BF 86 C9 10 40 01 C7 BA "
                          "78 BF 00 00 00 00 A8",
          .speed_set = "01 F4 01 02 FE 65 77 3D FE 65 77 3D 02 A5 4E 80 BF 3C 4E D1 3F 01 D0 44 18 "
                       "BF B5 15 FB 3E 10",
          .one_radian = "93 FF 7F 3F",
          .minus_half = "B8 1B 05 BF",
          .one_count = "4D A0 5E 38",
          .thousand_counts = "8B 68 59 3D",
          .standstill_levels = 69,
          .tuned = kDcx22lTuned},
    Motor{.known = kDcx26l,
          .position_set = "00 71 02 02 5D FE CB BF 65 AA 00 40 02 5D FE CB BF 65 AA 00 40 01 C7 BA "
                          "78 BF 00 00 00 00 5C",
          .speed_set = "01 90 01 02 1E A7 E8 3C 1E A7 E8 3C 02 80 B7 10 BF 45 47 62 3F 01 8E 06 20 "
                       "BF 93 3A 81 3E 5A",
          .one_radian = "B3 FC 7F 3F",
          .minus_half = "46 1B 05 BF",
          .one_count = "6F B9 AC 38",
          .thousand_counts = "16 AD A8 3D",
          .standstill_levels = 34,
          .tuned = kDcx26lTuned},
};

}  // namespace

std::span<const Motor> motors() noexcept { return kMotors; }

}  // namespace armjig::morap::conformance
