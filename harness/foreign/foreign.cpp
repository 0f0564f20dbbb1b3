// SPDX-License-Identifier: Apache-2.0
#include "harness/foreign/foreign.hpp"

#include <utility>

#include "harness/foreign/foreign_decoder.hpp"
#include "harness/foreign/pcap_source.hpp"

namespace armjig {
namespace {

Outcome<std::unique_ptr<CaptureReader>> read_from(Outcome<std::unique_ptr<pcapng::Source>> source,
                                                  const std::string& name, const ForeignHow& how) {
  if (!source) return tl::unexpected{std::move(source.error())};
  return open_packets(*std::move(source), make_foreign_decoder(how), name);
}

}  // namespace

bool is_capture(UserFile& file) {
  return file.peek() == '{' || file.starts_with(pcapng::kMagic) || is_pcap(file);
}

Outcome<std::unique_ptr<CaptureReader>> open_foreign(UserFile file, const std::string& path,
                                                     const ForeignHow& how) {
  if (is_pcap(file)) return read_from(open_pcap(std::move(file), path), path, how);
  if (!file.starts_with(pcapng::kMagic)) return CaptureReader::open(std::move(file), path);
  return read_from(std::make_unique<pcapng::Reader>(std::move(file), path), path, how);
}

Outcome<std::unique_ptr<CaptureReader>> open_interface(const std::string& name,
                                                       const ForeignHow& how,
                                                       std::function<bool()> must_end) {
  return read_from(open_pcap_interface(name, std::move(must_end)), name, how);
}

}  // namespace armjig
