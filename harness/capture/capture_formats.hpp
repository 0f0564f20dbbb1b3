// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "harness/capture/capture.hpp"
#include "harness/capture/pcapng.hpp"

/// What `CaptureReader::open` and `make_capture_writer` choose from.
namespace armjig {

inline constexpr std::uint32_t kLastCanId = 0x1FFF'FFFF;

[[nodiscard]] Outcome<std::unique_ptr<CaptureReader>> open_lines(UserFile file,
                                                                 const std::string& path);
[[nodiscard]] Outcome<std::unique_ptr<CaptureReader>> open_packets(UserFile file,
                                                                   const std::string& path);

/// Finds records in packets of link types that armjig does not write.
class PacketDecoder {
 public:
  PacketDecoder() = default;
  PacketDecoder(const PacketDecoder&) = delete;
  PacketDecoder& operator=(const PacketDecoder&) = delete;
  virtual ~PacketDecoder() = default;

  [[nodiscard]] virtual bool knows(std::uint16_t link_type) const noexcept = 0;
  virtual void take(const pcapng::Packet& packet, const pcapng::Interface& interface) = 0;
  /// No packet comes any more.
  virtual void finish() = 0;
  /// The next record that is complete, with its time since 1970; false: none yet. It is valid until
  /// the next call.
  [[nodiscard]] virtual bool next(CaptureRecord& record) = 0;
  /// Whose an I2C bus is that nobody describes; empty: nobody knows.
  [[nodiscard]] virtual std::string bus_device() const = 0;
  /// What was left out, in words; `name` is the file's.
  [[nodiscard]] virtual std::string warning(const std::string& name) const = 0;
};

/// The same of packets that come from anywhere; `decoder` may be none.
[[nodiscard]] Outcome<std::unique_ptr<CaptureReader>> open_packets(
    std::unique_ptr<pcapng::Source> source, std::unique_ptr<PacketDecoder> decoder,
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
