# SPDX-License-Identifier: Apache-2.0
"""Defects of emulated devices (`fault=rare:NAME`) that their suites do not see, and the records of the shortest case
that is known to show each."""

SHORTEST = {
    "parol6": {"changes-after-1024": 1022, "loses-fifth-echo": 5, "loses-borrow": 2, "leaves-speed": 2,
               "drops-outputs": 8, "misses-last-goal": 1, "disabled-by-timeout": 1, "times-long-gap": 1,
               "keeps-echo-in-burst": 2, "turns-smallest-speed": 1},
    "morap": {"disabled-by-no-voltage": 3, "disabled-by-endless-torque": 4, "changes-after-1024": 1023,
              "misses-third-default": 5, "disabled-by-cut-tune": 3, "disabled-by-no-torque": 4,
              "forgets-twelfth-failure": 14, "refuses-sum-of-zero": 3, "disabled-by-same-speed": 8,
              "toggles-select": 3},
    "kinovazed": {"hangs-after-60-rejections": 60, "beats-wrong-after-rejections": 69, "loses-byte-64": 3,
                  "forgets-third-client": 3, "turns-128": 5, "swallows-unfreezing": 2,
                  "swallows-second-stop": 2, "drops-vertical-tabs": 2, "swallows-quitting": 2,
                  "slows-with-bytes": 30},
}
