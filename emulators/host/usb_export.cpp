// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/usb_export.hpp"

#include <fmt/core.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <utility>  // before Asio, which forgets it

#include <array>
#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>

namespace armjig {
namespace {

using boost::asio::generic::stream_protocol;
using boost::asio::ip::tcp;
using boost::system::error_code;
using UnixStream = boost::asio::local::stream_protocol;
using Acceptor = boost::asio::basic_socket_acceptor<stream_protocol>;

using MakeWire = std::unique_ptr<UsbWire> (*)(usb::Device& device, Cable cable);

/// A client to which so much is still to be sent is not read.
constexpr std::size_t kMostUnsent = std::size_t{256} * 1024;
constexpr std::string_view kCableInput = "usb.plugged";
constexpr auto kAcceptRest = std::chrono::milliseconds{100};

/// Removes the file of a socket in the end.
class SocketFile {
 public:
  SocketFile() = default;
  explicit SocketFile(std::string path) noexcept : path_{std::move(path)} {}
  SocketFile(SocketFile&& other) noexcept : path_{std::exchange(other.path_, {})} {}
  SocketFile& operator=(SocketFile&& other) noexcept {
    std::swap(path_, other.path_);
    return *this;
  }
  SocketFile(const SocketFile&) = delete;
  SocketFile& operator=(const SocketFile&) = delete;
  ~SocketFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }

 private:
  std::string path_;
};

/// Where clients find the device.
struct Place {
  Acceptor acceptor;
  std::string target;
  SocketFile file{};
};

class ExportOnAsio final : public UsbExport {
 public:
  ExportOnAsio(boost::asio::io_context& context, Place place, usb::Function& function,
               MakeWire make_wire, Events events)
      : device_{function},
        make_wire_{make_wire},
        events_{std::move(events)},
        place_{std::move(place)},
        socket_{context},
        timer_{context},
        rest_{context} {
    accept();
  }

  void advance() override {
    device_.advance();
    tell();
  }

  void set_cable(Cable cable) override {
    if (std::exchange(cable_, cable) == cable) return;
    if (cable == Cable::kOut) device_.unplug(events_.catch_up());
    if (wire_ && !wire_->set_cable(cable)) return drop();
    write();
  }

  [[nodiscard]] std::string target() const override { return place_.target; }
  [[nodiscard]] LinkStatistics statistics() const override { return statistics_; }

 private:
  void accept() {
    place_.acceptor.async_accept([this](const error_code& error, stream_protocol::socket client) {
      if (error == boost::asio::error::operation_aborted) return;
      if (!error) admit(std::move(client));
      if (!error) return accept();
      if (!std::exchange(has_complained_, true)) {
        events_.on_log(fmt::format("cannot take USB clients: {}; trying again", error.message()));
      }
      rest_.expires_after(kAcceptRest);
      rest_.async_wait([this](const error_code& cancelled) {
        if (!cancelled) accept();
      });
    });
  }

  /// A device has one cable: who comes second has to wait for another time.
  void admit(stream_protocol::socket client) {
    if (wire_) {
      ++statistics_.refused;
      return;
    }
    error_code error;
    error = client.non_blocking(true, error);
    if (error) return;
    socket_ = std::move(client);
    if (socket_.local_endpoint(error).protocol().family() != AF_UNIX) {
      error = socket_.set_option(tcp::no_delay{true}, error);
    }
    ++statistics_.clients;
    wire_ = make_wire_(device_, cable_);
    write();
    read();
  }

  void read() {
    if (!wire_ || is_reading_ || wire_->outgoing().size() > kMostUnsent) return;
    is_reading_ = true;
    socket_.async_wait(stream_protocol::socket::wait_read, [this](const error_code& error) {
      is_reading_ = false;
      if (!error && wire_) read_turn();
      read();  // also after the wait for one that is gone: another may have come
    });
  }

  void read_turn() {
    std::array<std::byte, kReadTurn> buffer;
    error_code error;
    const auto size = socket_.read_some(boost::asio::buffer(buffer), error);
    if (error == boost::asio::error::would_block) return;
    if (error || size == 0) return drop();
    statistics_.bytes_in += size;
    if (!wire_->receive(events_.catch_up(), Bytes{buffer}.first(size))) {
      events_.on_log("a USB client did not keep to the protocol; it was disconnected");
      return drop();
    }
    tell();
    events_.on_turn();
  }

  /// Tells what has ended, and comes back for what has not.
  void tell() {
    if (!wire_) return;
    while (const auto completion = device_.next(events_.now())) wire_->tell(*completion);
    write();
    const auto due = device_.next_due();
    if (!due) return;
    timer_.expires_at(events_.wall_time(*due));
    timer_.async_wait([this](const error_code& cancelled) {
      if (!cancelled) tell();
    });
  }

  void write() {
    while (wire_ && !wire_->outgoing().empty()) {
      auto& bytes = wire_->outgoing();
      error_code error;
      const auto size = socket_.write_some(boost::asio::buffer(bytes), error);
      if (error == boost::asio::error::would_block) return write_when_ready();
      if (error) return;  // reading tells
      statistics_.bytes_out += size;
      bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
  }

  void write_when_ready() {
    if (std::exchange(is_writing_, true)) return;
    socket_.async_wait(stream_protocol::socket::wait_write, [this](const error_code& /*error*/) {
      is_writing_ = false;
      write();
      read();
    });
  }

  /// For the device it is as if the cable was pulled out: the machine at its other end is gone.
  void drop() {
    wire_.reset();
    timer_.cancel();
    error_code ignored;
    ignored = socket_.close(ignored);
    device_.unplug(events_.catch_up());
  }

  usb::Device device_;
  MakeWire make_wire_;
  Events events_;
  Place place_;
  stream_protocol::socket socket_;
  boost::asio::steady_timer timer_;
  boost::asio::steady_timer rest_;
  std::unique_ptr<UsbWire> wire_;  ///< while a client is there
  Cable cable_ = Cable::kIn;
  LinkStatistics statistics_;
  bool is_reading_ = false;
  bool is_writing_ = false;
  bool has_complained_ = false;
};

/// Who listens on a socket that is there already.
enum class Tenant : std::uint8_t { kNobody, kDead, kAlive, kOtherFile };

Tenant tenant_of(boost::asio::io_context& context, const std::string& path) {
  struct stat status{};
  if (::lstat(path.c_str(), &status) != 0) return Tenant::kNobody;
  if (!S_ISSOCK(status.st_mode)) return Tenant::kOtherFile;
  UnixStream::socket probe{context};
  error_code error;
  error = probe.connect(UnixStream::endpoint{path}, error);
  return error == boost::asio::error::connection_refused ? Tenant::kDead : Tenant::kAlive;
}

/// Throws what Asio throws.
Outcome<void> free_socket(boost::asio::io_context& context, const std::string& path,
                          const std::string& where) {
  switch (tenant_of(context, path)) {
    case Tenant::kAlive:
      return problem(ErrorCode::kBusy, where, "another program listens there; name another path");
    case Tenant::kOtherFile:
      return problem(ErrorCode::kBusy, where, "that file is no socket; name another path");
    case Tenant::kDead:
      ::unlink(path.c_str());
      break;
    case Tenant::kNobody:
      break;
  }
  return {};
}

/// Throws what Asio throws.
Place listen_on_socket(boost::asio::io_context& context, const std::string& path) {
  const stream_protocol::endpoint endpoint{UnixStream::endpoint{path}};
  Acceptor acceptor{context, endpoint.protocol()};
  acceptor.bind(endpoint);
  SocketFile file{path};
  ::chmod(path.c_str(), S_IRUSR | S_IWUSR);
  acceptor.listen();
  return {std::move(acceptor), "usbredir:" + path, std::move(file)};
}

Place listen_on_loopback(boost::asio::io_context& context, std::uint16_t port) {
  const stream_protocol::endpoint wanted{
      tcp::endpoint{boost::asio::ip::address_v4::loopback(), port}};
  Acceptor acceptor{context, wanted};
  const auto bound = acceptor.local_endpoint();
  tcp::endpoint endpoint;
  std::memcpy(endpoint.data(), bound.data(), std::min(bound.size(), endpoint.capacity()));
  return {std::move(acceptor), fmt::format("usbip:127.0.0.1:{}", endpoint.port())};
}

tl::unexpected<Problem> problem_of_place(const std::string& where, const error_code& error) {
  const bool is_too_long = error == boost::asio::error::name_too_long;
  const auto code = is_too_long ? ErrorCode::kBadValue : error_from_errno(error.value()).code;
  return problem(code, where,
                 code == ErrorCode::kNotFound ? "the folder must exist" : error.message());
}

}  // namespace

Outcome<std::unique_ptr<UsbExport>> export_usb(boost::asio::io_context& context,
                                               const UsbSocket& place, usb::Function& function,
                                               UsbExport::Events events) {
  const auto* const socket = std::get_if<UsbredirSocket>(&place);
  const auto where = socket != nullptr ? "usbredir:" + socket->path
                                       : fmt::format("usbip:{}", std::get<UsbipPort>(place).number);
  try {
    if (socket == nullptr) {
      return std::make_unique<ExportOnAsio>(
          context, listen_on_loopback(context, std::get<UsbipPort>(place).number), function,
          make_usbip_wire, std::move(events));
    }
    if (auto freed = free_socket(context, socket->path, where); !freed) {
      return tl::unexpected{freed.error()};
    }
    return std::make_unique<ExportOnAsio>(context, listen_on_socket(context, socket->path),
                                          function, make_usbredir_wire, std::move(events));
  } catch (const boost::system::system_error& failure) {
    return problem_of_place(where, failure.code());
  }
}

std::vector<DeviceInput> CableHand::inputs() const {
  if (cables_.empty()) return {};
  return {{kCableInput, "0 or 1: its USB cable"}};
}

bool CableHand::set_input(std::string_view name, std::int64_t value) const {
  if (cables_.empty() || name != kCableInput || value < 0 || value > 1) return false;
  for (const auto& set : cables_) set(value == 1 ? Cable::kIn : Cable::kOut);
  return true;
}

}  // namespace armjig
