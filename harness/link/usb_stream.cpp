// SPDX-License-Identifier: Apache-2.0
#include "harness/link/usb_stream.hpp"

#include <fmt/core.h>
#include <libusb.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/link/acm_function.hpp"
#include "harness/link/byte_queue.hpp"
#include "harness/link/descriptor.hpp"
#include "harness/link/serial_stream.hpp"
#include "harness/link/usb_device.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr UsbHints kBoardHints{
    .absent = "is the board plugged in and switched on? 'lsusb' lists what is",
    .several = "there are several: write usb:VID:PID:SERIAL, or usb: and the place of one: ",
    .busy = "another program has claimed it: close that program; 'fuser' names it"};
constexpr auto kNoPort =
    "it has no serial port of class CDC-ACM; if the system makes a port of it by another driver, "
    "write serial:VID:PID";

// Requests to the interface (PSTN, table 13).
constexpr std::uint8_t kClassRequest = 0x21;
constexpr std::uint8_t kLineCodingRequest = 0x20;
constexpr std::uint8_t kLineStateRequest = 0x22;
constexpr std::uint16_t kHungUp = 0;
constexpr std::uint16_t kReadyToTalk = 3;  // DTR and RTS
constexpr unsigned kRequestPatienceMs = 1000;

constexpr std::size_t kReadsOnTheirWay = 16;
constexpr std::size_t kWritesOnTheirWay = 8;
constexpr std::size_t kLongestWrite = 4096;
constexpr std::size_t kMostUnreadFromUsb = std::size_t{64} << 10U;  // then the board has to wait
constexpr Duration kCancelPatience = 1s;

/// By the descriptors that the file of a device has. Errors: `kDisconnected`, `kUnsupported`.
Result<AcmFunction> acm_behind(int file) noexcept {
  std::array<std::byte, 2048> descriptors{};
  const auto size = ::pread(file, descriptors.data(), descriptors.size(), 0);
  if (size < 0) return fail(ErrorCode::kDisconnected, errno);
  const auto found = find_acm(Bytes{descriptors}.first(static_cast<std::size_t>(size)));
  if (!found) return fail(ErrorCode::kUnsupported);
  return *found;
}

/// By its file alone, past libusb. What came is thrown away afterwards, when there is an answer: a
/// read that is broken off upsets some hosts.
void send_last_bulk(int file, Bytes message) noexcept {
  constexpr unsigned kReadPatienceMs = 10;
  constexpr unsigned kWritePatienceMs = 50;
  const auto port = acm_behind(file);
  if (!port) return;
  usbdevfs_bulktransfer write{.ep = port->bulk_out,
                              .len = static_cast<unsigned>(message.size()),
                              .timeout = kWritePatienceMs,
                              .data = const_cast<std::byte*>(message.data())};
  ::ioctl(file, USBDEVFS_BULK, &write);
  std::array<std::byte, 512> ignored;
  usbdevfs_bulktransfer read{.ep = port->bulk_in,
                             .len = ignored.size(),
                             .timeout = kReadPatienceMs,
                             .data = ignored.data()};
  ::ioctl(file, USBDEVFS_BULK, &read);
}

std::array<std::uint8_t, 7> line_coding(const SerialLine& line) {
  const auto byte = [&line](unsigned n) { return static_cast<std::uint8_t>(line.baud >> 8U * n); };
  const auto stop = static_cast<std::uint8_t>(line.stop_bits == 2 ? 2 : 0);
  constexpr std::uint8_t kDataBits = 8;
  return {byte(0),  byte(1), byte(2), byte(3), stop, static_cast<std::uint8_t>(line.parity),
          kDataBits};
}

struct FreeTransfer {
  void operator()(libusb_transfer* transfer) const noexcept { libusb_free_transfer(transfer); }
};

/// Bulk transfers over one endpoint, several of which are on their way at once. What is told of
/// each goes to `on_end`, while libusb handles events.
class BulkQueue {
 public:
  struct One {
    BulkQueue* queue{};
    std::unique_ptr<libusb_transfer, FreeTransfer> transfer{};
    std::vector<std::byte> buffer{};
    bool is_on_its_way = false;
  };
  using OnEnd = std::function<void(One&)>;

  BulkQueue(std::size_t count, std::size_t size, OnEnd on_end)
      : all_(count), on_end_{std::move(on_end)} {
    for (auto& one : all_) {
      one.queue = this;
      one.transfer.reset(libusb_alloc_transfer(0));
      one.buffer.resize(size);
    }
  }

  BulkQueue(const BulkQueue&) = delete;
  BulkQueue& operator=(const BulkQueue&) = delete;
  /// What could not be taken back is libusb's for ever.
  ~BulkQueue() {
    for (auto& one : all_) {
      if (!one.is_on_its_way) continue;
      [[maybe_unused]] const auto* const given_up = one.transfer.release();
    }
  }

  /// The first `size` bytes of its buffer. Answers libusb's code.
  int submit(One& one, libusb_device_handle* device, std::uint8_t endpoint, std::size_t size) {
    libusb_fill_bulk_transfer(one.transfer.get(), device, endpoint,
                              reinterpret_cast<unsigned char*>(one.buffer.data()),
                              static_cast<int>(size), &BulkQueue::ended, &one, /*timeout=*/0);
    const int code = libusb_submit_transfer(one.transfer.get());
    one.is_on_its_way = code == 0;
    return code;
  }
  void cancel() noexcept {
    for (auto& one : all_) {
      if (one.is_on_its_way) libusb_cancel_transfer(one.transfer.get());
    }
  }
  [[nodiscard]] bool is_idle() const noexcept {
    return std::ranges::none_of(all_, &One::is_on_its_way);
  }
  /// Null: all are on their way.
  [[nodiscard]] One* idle() noexcept {
    const auto found = std::ranges::find(all_, false, &One::is_on_its_way);
    return found == all_.end() ? nullptr : &*found;
  }

 private:
  static void LIBUSB_CALL ended(libusb_transfer* transfer) {
    auto& one = *static_cast<One*>(transfer->user_data);
    one.is_on_its_way = false;
    one.queue->on_end_(one);
  }

  std::vector<One> all_;
  OnEnd on_end_;
};

/// What the end of a transfer says of the device; none if it may go on.
std::optional<Error> error_of_end(const libusb_transfer& transfer) noexcept {
  switch (transfer.status) {
    case LIBUSB_TRANSFER_COMPLETED:
    case LIBUSB_TRANSFER_CANCELLED:
      return std::nullopt;
    case LIBUSB_TRANSFER_NO_DEVICE:
    case LIBUSB_TRANSFER_ERROR:  // silence at the end of a cable, before the hub knows
      return Error{ErrorCode::kDisconnected, LIBUSB_ERROR_NO_DEVICE};
    case LIBUSB_TRANSFER_STALL:
      return Error{ErrorCode::kUnsupported, LIBUSB_ERROR_PIPE};
    default:
      return Error{ErrorCode::kSystem, LIBUSB_ERROR_OTHER};
  }
}

class UsbStream final : public StreamPort {
 public:
  /// `file` is that of the device.
  UsbStream(OpenUsb device, int file, const AcmFunction& port)
      : device_{std::move(device)},
        reads_{kReadsOnTheirWay, port.packet_size, [this](auto& one) { on_read(one); }},
        writes_{kWritesOnTheirWay, kLongestWrite, [this](auto& one) { on_written(one); }},
        file_{file},
        port_{port} {}
  UsbStream(const UsbStream&) = delete;
  UsbStream& operator=(const UsbStream&) = delete;
  ~UsbStream() override {
    drain();
    reads_.cancel();
    writes_.cancel();
    const auto deadline = now() + kCancelPatience;
    while ((!reads_.is_idle() || !writes_.is_idle()) && handle_events(deadline)) {
    }
    if (has_claimed_) give_back();
  }

  /// Both interfaces; a kernel driver goes, and comes back at the end. Answers libusb's code.
  int claim() {
    auto* const handle = device_.handle.get();
    if (libusb_kernel_driver_active(handle, port_.control) == 1) {
      libusb_set_auto_detach_kernel_driver(handle, 1);
    }
    if (const int code = libusb_claim_interface(handle, port_.control); code != 0) return code;
    if (const int code = libusb_claim_interface(handle, port_.data); code != 0) {
      libusb_release_interface(handle, port_.control);
      return code;
    }
    has_claimed_ = true;
    return 0;
  }

  /// As a program that opens the port: what is there from before is not its own. Answers libusb's
  /// code.
  int begin(const SerialLine& line) {
    if (const int code = tell_state(kHungUp); code < 0) return code;
    if (const int code = keep_reading(); code != 0) return code;
    if (const int code = tell_line(line); code < 0) return code;
    came_.clear();
    return tell_state(kReadyToTalk);
  }

  [[nodiscard]] std::optional<Lifeline> lifeline() const override {
    return Lifeline{file_, send_last_bulk, /*is_plain=*/false};
  }
  [[nodiscard]] Instant now() const override { return clock_.now(); }

  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    if (into.empty()) return 0;
    while (came_.empty()) {
      if (lost_) return tl::unexpected{*lost_};
      if (!handle_events(deadline)) return 0;
    }
    const auto size = came_.take(into);
    if (const int code = lost_ ? 0 : keep_reading(); code != 0) lose(error_from_libusb(code));
    return size;
  }

  Result<void> write(Bytes bytes) override {
    handle_events(now());
    while (!bytes.empty() && !lost_) {
      auto* const one = next_write();
      if (one == nullptr) return tl::unexpected{lost_.value_or(Error{ErrorCode::kTimedOut})};
      const auto size = std::min(bytes.size(), one->buffer.size());
      std::copy_n(bytes.begin(), size, one->buffer.begin());
      const int code = writes_.submit(*one, device_.handle.get(), port_.bulk_out, size);
      if (code != 0) lose(error_from_libusb(code));
      bytes = bytes.subspan(size);
    }
    if (lost_) return tl::unexpected{*lost_};
    return {};
  }

 private:
  /// Unless nobody takes what comes. Answers libusb's code.
  int keep_reading() {
    auto* one = reads_.idle();
    for (; one != nullptr && came_.size() < kMostUnreadFromUsb; one = reads_.idle()) {
      if (const int code = ask(*one); code != 0) return code;
    }
    return 0;
  }
  int ask(BulkQueue::One& one) {
    return reads_.submit(one, device_.handle.get(), port_.bulk_in, one.buffer.size());
  }

  void on_read(BulkQueue::One& one) {
    const auto size = static_cast<std::size_t>(std::max(one.transfer->actual_length, 0));
    came_.add(Bytes{one.buffer}.first(size));
    if (const auto error = error_of_end(*one.transfer)) lose(*error);
    const bool goes_on = one.transfer->status == LIBUSB_TRANSFER_COMPLETED && !lost_;
    if (!goes_on || came_.size() >= kMostUnreadFromUsb) return;
    if (const int code = ask(one); code != 0) lose(error_from_libusb(code));
  }

  void on_written(BulkQueue::One& one) {
    last_taken_ = now();
    if (const auto error = error_of_end(*one.transfer)) lose(*error);
  }

  /// The first reason stays.
  void lose(const Error& error) {
    if (!lost_) lost_ = error;
  }

  /// Null: the board takes nothing, or is lost.
  BulkQueue::One* next_write() {
    last_taken_ = now();
    while (!lost_) {
      if (auto* const one = writes_.idle()) return one;
      if (!handle_events(last_taken_ + kWritePatience)) break;
    }
    return nullptr;
  }

  /// What was written is to reach the board, as long as it takes something.
  void drain() {
    last_taken_ = now();
    while (!lost_ && !writes_.is_idle() && handle_events(last_taken_ + kWritePatience)) {
    }
  }

  /// Waits until something has ended, but not beyond `deadline`. False: nothing has.
  bool handle_events(Instant deadline) {
    // Not by libusb, whose milliseconds would round every deadline up.
    const auto left = [&] { return std::max(deadline - now(), Duration::zero()); };
    const auto is_ready = wait_for(file_, Readiness::kWritable, left);
    if (!is_ready) lose(is_ready.error());
    if (!is_ready || !*is_ready) return false;
    timeval at_once{};
    libusb_handle_events_timeout_completed(device_.context.get(), &at_once, nullptr);
    return true;
  }

  int tell_line(const SerialLine& line) {
    auto coding = line_coding(line);
    return port_.has_line ? tell(kLineCodingRequest, 0, coding) : 0;
  }
  int tell_state(std::uint16_t lines) {
    return port_.has_line ? tell(kLineStateRequest, lines) : 0;
  }
  int tell(std::uint8_t request, std::uint16_t value, std::span<std::uint8_t> data = {}) {
    return libusb_control_transfer(device_.handle.get(), kClassRequest, request, value,
                                   port_.control, data.data(),
                                   static_cast<std::uint16_t>(data.size()), kRequestPatienceMs);
  }

  /// The data first, for the driver takes them together with the other.
  void give_back() {
    if (!lost_) tell_state(kHungUp);
    libusb_release_interface(device_.handle.get(), port_.data);
    libusb_release_interface(device_.handle.get(), port_.control);
  }

  OpenUsb device_;  // goes last: libusb looks at it when a transfer is freed
  BulkQueue reads_;
  BulkQueue writes_;
  int file_;
  AcmFunction port_;
  bool has_claimed_ = false;
  ByteQueue came_;
  std::optional<Error> lost_;
  Instant last_taken_{};  ///< when the board took something
  Stopwatch clock_;
};

/// The terminal that a kernel driver has made of the port; empty if there is none.
std::string terminal_of(const OpenUsb& device, const AcmFunction& port) {
  std::error_code error;
  const auto folder = fmt::format("/sys/bus/usb/devices/{}:{}.{}/tty", place_of(device),
                                  port.configuration, port.control);
  const fs::directory_iterator entries{folder, error};
  if (error || entries == end(entries)) return {};
  return "/dev/" + entries->path().filename().string();
}

/// Claiming takes the terminal from whoever has it open. Others keep it locked.
Outcome<std::unique_ptr<UsbStream>> claim(OpenUsb device, int file, const AcmFunction& port,
                                          const std::string& where) {
  const auto path = terminal_of(device, port);
  const auto terminal = path.empty() ? Result<Descriptor>{} : open_terminal(path);
  if (!terminal && terminal.error().code == ErrorCode::kBusy) {
    return problem(
        ErrorCode::kBusy, where,
        fmt::format("another program has it as {}: close that program; 'fuser' names it", path));
  }
  auto stream = std::make_unique<UsbStream>(std::move(device), file, port);
  if (const int code = stream->claim(); code != 0) {
    return problem_from_libusb(code, where, kBoardHints);
  }
  return stream;
}

tl::unexpected<Problem> problem_of_line(int code, const std::string& where,
                                        const SerialLine& line) {
  if (code != LIBUSB_ERROR_PIPE) return problem_from_libusb(code, where, kBoardHints);
  return problem(ErrorCode::kUnsupported, where,
                 fmt::format("it does not take {} baud, {} parity and {} stop bits", line.baud,
                             to_string(line.parity), line.stop_bits));
}

}  // namespace

Outcome<std::unique_ptr<StreamPort>> open_usb_stream(const std::string& address, SerialLine usual) {
  const auto where = fmt::format("usb:{}", address);
  const auto place = parse_serial_address(address, usual);
  const auto choice = place ? parse_usb_choice(place->path) : fail(ErrorCode::kBadValue);
  if (!choice) {
    return problem(ErrorCode::kBadTarget, fmt::format("'{}'", where),
                   "write usb:VID:PID, usb:VID:PID:SERIAL or usb:BUS-PORT, for example "
                   "usb:0483:5740");
  }
  auto device = open_usb(*choice, where, kBoardHints);
  if (!device) return tl::unexpected{device.error()};
  const auto file = device->file();
  const auto port = file ? acm_behind(*file) : fail(ErrorCode::kDisconnected);
  if (!port) {
    const bool is_there = port.error().code == ErrorCode::kUnsupported;
    return problem(port.error().code, where, is_there ? kNoPort : "was it unplugged just now?");
  }
  auto stream = claim(*std::move(device), *file, *port, where);
  if (!stream) return tl::unexpected{stream.error()};
  if (const int code = (*stream)->begin(place->line); code < 0) {
    return problem_of_line(code, where, place->line);
  }
  return *std::move(stream);
}

}  // namespace armjig
