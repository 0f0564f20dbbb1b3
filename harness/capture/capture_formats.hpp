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

/// The reader of one format at the beginning of a file. Problems: those of its header.
template <class Reader>
[[nodiscard]] Outcome<std::unique_ptr<CaptureReader>> begin_reading(UserFile file,
                                                                    const std::string& path) {
  auto reader = std::make_unique<Reader>(std::move(file), path);
  auto begun = reader->read_header();
  if (!begun) return tl::unexpected{std::move(begun.error())};
  return reader;
}

/// A string of JSON; what is no UTF-8 in it is replaced.
[[nodiscard]] std::string json_string(std::string_view text);

}  // namespace armjig
