// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "harness/capture/capture.hpp"

/// What `CaptureReader::open` and `make_capture_writer` choose from.
namespace armjig {

[[nodiscard]] Outcome<std::unique_ptr<CaptureReader>> open_lines(UserFile file,
                                                                 const std::string& path);
[[nodiscard]] Outcome<std::unique_ptr<CaptureReader>> open_packets(UserFile file,
                                                                   const std::string& path);
[[nodiscard]] std::unique_ptr<CaptureWriter> make_line_writer();
[[nodiscard]] std::unique_ptr<CaptureWriter> make_packet_writer();

/// A string of JSON; what is no UTF-8 in it is replaced.
[[nodiscard]] std::string json_string(std::string_view text);

}  // namespace armjig
