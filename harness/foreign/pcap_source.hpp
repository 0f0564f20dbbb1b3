// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "harness/capture/pcapng.hpp"

namespace armjig {

/// Whether a file begins like a classic pcap file.
[[nodiscard]] bool is_pcap(UserFile& file);

/// A classic pcap file, read by libpcap. Problems: `kMalformed`.
[[nodiscard]] Outcome<std::unique_ptr<pcapng::Source>> open_pcap(UserFile file,
                                                                 const std::string& path);

/// As `open_interface`.
[[nodiscard]] Outcome<std::unique_ptr<pcapng::Source>> open_pcap_interface(
    const std::string& name, std::function<bool()> must_end);

}  // namespace armjig
