// SPDX-License-Identifier: Apache-2.0
#include "harness/foreign/pcap_source.hpp"

#include <fmt/core.h>
#include <pcap/pcap.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <string_view>
#include <utility>

namespace armjig {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
/// Microseconds, nanoseconds, and those of an old libpcap with longer headers, in both orders.
constexpr std::array<std::string_view, 6> kMagics{"\x34\xCD\xB2\xA1", "\xA1\xB2\xCD\x34",
                                                  "\xD4\xC3\xB2\xA1", "\xA1\xB2\xC3\xD4",
                                                  "\x4D\x3C\xB2\xA1", "\xA1\xB2\x3C\x4D"};

struct ClosePcap {
  void operator()(pcap_t* pcap) const noexcept { ::pcap_close(pcap); }
};
using Pcap = std::unique_ptr<pcap_t, ClosePcap>;
using ErrorText = std::array<char, PCAP_ERRBUF_SIZE>;

/// What libpcap reads a file through; it closes it.
struct Reading {
  UserFile file;
};

ssize_t read_through(void* cookie, char* into, std::size_t size) {
  const auto read =
      static_cast<Reading*>(cookie)->file.read(std::as_writable_bytes(std::span{into, size}));
  if (read) return static_cast<ssize_t>(*read);
  errno = EIO;
  return -1;
}

int close_through(void* cookie) {
  const std::unique_ptr<Reading> reading{static_cast<Reading*>(cookie)};
  return 0;
}

class PcapSource final : public pcapng::Source {
 public:
  PcapSource(Pcap pcap, std::string name, std::function<bool()> must_end)
      : pcap_{std::move(pcap)}, name_{std::move(name)}, must_end_{std::move(must_end)} {
    pcapng::Interface interface;
    interface.link_type = static_cast<std::uint16_t>(::pcap_datalink(pcap_.get()));
    // libpcap turns the headers of usbmon into the order of this machine.
    interface.is_little_endian = std::endian::native == std::endian::little;
    interfaces_.push_back(std::move(interface));
  }

  [[nodiscard]] std::string_view format() const noexcept override {
    return must_end_ ? "live interface" : "pcap";
  }

  Outcome<bool> next(pcapng::Packet& packet) override {
    while (!must_end_ || !must_end_()) {
      pcap_pkthdr* header = nullptr;
      const u_char* data = nullptr;
      const int got = ::pcap_next_ex(pcap_.get(), &header, &data);
      if (got == 0) {
        wait();
        continue;
      }
      if (got == PCAP_ERROR_BREAK) return false;
      if (got < 0) return end_of(::pcap_geterr(pcap_.get()));
      packet = {};
      packet.original_size = header->len;
      packet.data = std::as_bytes(std::span{data, header->caplen});
      const std::int64_t seconds = header->ts.tv_sec;
      const std::int64_t ns = header->ts.tv_usec;
      packet.time_ns = std::clamp<std::int64_t>(ns, 0, kNsPerSecond - 1);
      if (seconds > 0) packet.time_ns += seconds * kNsPerSecond;
      return true;
    }
    return false;
  }

  [[nodiscard]] const std::vector<pcapng::Interface>& interfaces() const noexcept override {
    return interfaces_;
  }
  [[nodiscard]] const std::string& comment() const noexcept override { return comment_; }
  [[nodiscard]] const std::string& warning() const noexcept override { return warning_; }

 private:
  /// For a packet, but not so long that nobody could end it.
  void wait() {
    constexpr int kPatienceMs = 100;
    pollfd waiting{.fd = ::pcap_get_selectable_fd(pcap_.get()), .events = POLLIN, .revents = 0};
    (void)::poll(&waiting, 1, kPatienceMs);
  }

  Outcome<bool> end_of(std::string_view error) {
    if (must_end_) return problem(ErrorCode::kCannotRead, name_, std::string{error});
    if (!error.starts_with("truncated")) {
      return problem(ErrorCode::kMalformed, name_, std::string{error});
    }
    warning_ = fmt::format("{}: the file ends within a packet; all before it was read", name_);
    return false;
  }

  Pcap pcap_;
  std::string name_;
  std::function<bool()> must_end_;  ///< none: a file
  std::vector<pcapng::Interface> interfaces_;
  std::string comment_;
  std::string warning_;
};

std::string names_of_interfaces() {
  ErrorText error{};
  pcap_if_t* all = nullptr;
  if (::pcap_findalldevs(&all, error.data()) != 0) return error.data();
  std::string names;
  for (const auto* one = all; one != nullptr; one = one->next) {
    names += names.empty() ? one->name : fmt::format(", {}", one->name);
  }
  ::pcap_freealldevs(all);
  return names.empty() ? "there are none that may be read" : "there are " + names;
}

tl::unexpected<Problem> refuse(const std::string& name, int status, const char* error) {
  if (status == PCAP_ERROR_PERM_DENIED || status == PCAP_ERROR_PROMISC_PERM_DENIED) {
    return problem(ErrorCode::kNoPermission, name,
                   "only root may capture; or capture with dumpcap and read its file");
  }
  if (status == PCAP_ERROR_NO_SUCH_DEVICE) {
    return problem(ErrorCode::kNotFound, name, names_of_interfaces());
  }
  return problem(ErrorCode::kCannotRead, name,
                 status == PCAP_ERROR_IFACE_NOT_UP ? "the interface is down" : error);
}

}  // namespace

bool is_pcap(UserFile& file) {
  return std::ranges::any_of(kMagics,
                             [&file](std::string_view magic) { return file.starts_with(magic); });
}

Outcome<std::unique_ptr<pcapng::Source>> open_pcap(UserFile file, const std::string& path) {
  auto reading = std::make_unique<Reading>(Reading{std::move(file)});
  auto* const stream = ::fopencookie(
      reading.get(), "rb",
      {.read = read_through, .write = nullptr, .seek = nullptr, .close = close_through});
  if (stream == nullptr) return problem(ErrorCode::kCannotRead, path, "there is no memory");
  (void)reading.release();  // the stream's NOLINT(bugprone-unused-return-value)
  ErrorText error{};
  Pcap pcap{
      ::pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, error.data())};
  if (!pcap) {
    (void)std::fclose(stream);
    return problem(ErrorCode::kMalformed, path, error.data());
  }
  return std::make_unique<PcapSource>(std::move(pcap), path, nullptr);
}

Outcome<std::unique_ptr<pcapng::Source>> open_pcap_interface(const std::string& name,
                                                             std::function<bool()> must_end) {
  constexpr int kMostPacketBytes = 262'144;
  constexpr int kPatienceMs = 100;
  ErrorText error{};
  Pcap pcap{::pcap_create(name.c_str(), error.data())};
  if (!pcap) return problem(ErrorCode::kCannotRead, name, error.data());
  (void)::pcap_set_snaplen(pcap.get(), kMostPacketBytes);
  (void)::pcap_set_timeout(pcap.get(), kPatienceMs);
  (void)::pcap_set_immediate_mode(pcap.get(), 1);
  (void)::pcap_set_tstamp_precision(pcap.get(), PCAP_TSTAMP_PRECISION_NANO);
  if (const int status = ::pcap_activate(pcap.get()); status < 0) {
    return refuse(name, status, ::pcap_geterr(pcap.get()));
  }
  if (::pcap_setnonblock(pcap.get(), 1, error.data()) != 0) {
    return problem(ErrorCode::kCannotRead, name, error.data());
  }
  return std::make_unique<PcapSource>(std::move(pcap), name, std::move(must_end));
}

}  // namespace armjig
