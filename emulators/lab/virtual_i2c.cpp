// SPDX-License-Identifier: Apache-2.0
#include "emulators/lab/virtual_i2c.hpp"

#include <fmt/core.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <sys/stat.h>
#include <umockdev.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <utility>

#include "emulators/lab/i2c_adapter.hpp"

namespace armjig {

struct GObjectUnref {
  void operator()(void* object) const noexcept { g_object_unref(object); }
};
template <class T>
using GObjectRef = std::unique_ptr<T, GObjectUnref>;

namespace {

/// A piece of the memory of the program whose call is answered.
class ClientMemory {
 public:
  /// Takes over the reference.
  explicit ClientMemory(UMockdevIoctlData* data) noexcept : data_{data} {}

  [[nodiscard]] explicit operator bool() const noexcept { return data_ != nullptr; }
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept {
    return {reinterpret_cast<const std::byte*>(data_->data),
            static_cast<std::size_t>(data_->data_len)};
  }
  /// Requires at least as many bytes.
  template <class T>
  [[nodiscard]] T as(std::size_t offset = 0) const noexcept {
    T value;
    std::memcpy(&value, bytes().data() + offset, sizeof value);
    return value;
  }
  void set(Bytes bytes) {
    std::vector<std::byte> copy{bytes.begin(), bytes.end()};
    umockdev_ioctl_data_update(data_.get(), 0, reinterpret_cast<guint8*>(copy.data()),
                               static_cast<gint>(copy.size()));
  }
  /// What the pointer at `offset` leads to; none if it leads nowhere.
  [[nodiscard]] ClientMemory behind(std::size_t offset, std::size_t size) const {
    GError* error = nullptr;
    auto* found = umockdev_ioctl_data_resolve(data_.get(), offset, size, &error);
    g_clear_error(&error);
    return ClientMemory{found};
  }

 private:
  GObjectRef<UMockdevIoctlData> data_;
};

/// A call of a program, from the beginning to its answer.
class Call {
 public:
  explicit Call(UMockdevIoctlClient* client)
      : client_{client},
        argument_{
            static_cast<UMockdevIoctlData*>(g_object_ref(umockdev_ioctl_client_get_arg(client)))} {}

  [[nodiscard]] unsigned long request() const { return umockdev_ioctl_client_get_request(client_); }
  [[nodiscard]] ClientMemory& argument() noexcept { return argument_; }
  [[nodiscard]] unsigned long number() const noexcept { return argument_.as<unsigned long>(); }

  // Each open file has its address.
  void choose(unsigned long address) {
    g_object_set_data(G_OBJECT(client_), kKey, GUINT_TO_POINTER(address));
  }
  [[nodiscard]] BusAddress address() const {
    return {
        static_cast<std::uint8_t>(GPOINTER_TO_UINT(g_object_get_data(G_OBJECT(client_), kKey)))};
  }

  /// The answer: `result` of the call, or the error number if that is not 0.
  void answer(long result, int error) {
    umockdev_ioctl_client_complete(client_, error == 0 ? result : -1, error);
  }

 private:
  static constexpr auto kKey = "armjig-i2c-address";

  UMockdevIoctlClient* client_;
  ClientMemory argument_;
};

constexpr std::size_t kLongestMessage = 8192;  // of the kernel
constexpr unsigned long kLastAddress = 0x7F;

/// A message of a transaction, its bytes copied from the program.
struct CopiedMessage {
  BusMessage message;
  std::vector<std::byte> bytes;
  ClientMemory memory{nullptr};
};

int copy_message(const ClientMemory& messages, std::size_t i, CopiedMessage& out) {
  const auto place = i * sizeof(i2c_msg);
  const auto raw = messages.as<i2c_msg>(place);
  const bool is_read = (raw.flags & I2C_M_RD) != 0;
  if ((raw.flags & ~I2C_M_RD) != 0 || raw.addr > kLastAddress) return EOPNOTSUPP;
  if (raw.len > kLongestMessage) return EINVAL;
  out.bytes.resize(raw.len);
  if (raw.len > 0) {
    out.memory = messages.behind(place + offsetof(i2c_msg, buf), raw.len);
    if (!out.memory) return EFAULT;
    std::ranges::copy(out.memory.bytes(), out.bytes.begin());
  }
  const BusAddress address{static_cast<std::uint8_t>(raw.addr)};
  out.message = is_read ? read_from(address, out.bytes) : write_to(address, out.bytes);
  return 0;
}

/// `I2C_RDWR`: the number of messages, or an error number.
std::pair<long, int> transfer(I2cAdapter& adapter, const ClientMemory& argument) {
  const auto request = argument.behind(0, sizeof(i2c_rdwr_ioctl_data));
  if (!request) return {0, EFAULT};
  const auto count = request.as<i2c_rdwr_ioctl_data>().nmsgs;
  if (count == 0 || count > I2C_RDWR_IOCTL_MAX_MSGS) return {0, EINVAL};
  const auto messages =
      request.behind(offsetof(i2c_rdwr_ioctl_data, msgs), count * sizeof(i2c_msg));
  if (!messages) return {0, EFAULT};
  std::vector<CopiedMessage> copies(count);
  std::vector<BusMessage> all;
  for (std::size_t i = 0; i < count; ++i) {
    if (const int error = copy_message(messages, i, copies[i]); error != 0) return {0, error};
    all.push_back(copies[i].message);
  }
  const int error = adapter.transfer(all);
  for (auto& copy : copies) {
    const bool was_read = copy.message.access == Access::kRead && !copy.bytes.empty();
    if (error == 0 && was_read) copy.memory.set(copy.bytes);
  }
  return {static_cast<long>(count), error};
}

/// As much of `i2c_smbus_data` as the kernel looks at.
std::size_t smbus_size(std::uint32_t size) {
  switch (size) {
    case I2C_SMBUS_BYTE:
    case I2C_SMBUS_BYTE_DATA:
      return sizeof(i2c_smbus_data::byte);
    case I2C_SMBUS_WORD_DATA:
    case I2C_SMBUS_PROC_CALL:
      return sizeof(i2c_smbus_data::word);
    default:
      return sizeof(i2c_smbus_data::block);
  }
}

int smbus(I2cAdapter& adapter, BusAddress address, const ClientMemory& argument) {
  const auto request = argument.behind(0, sizeof(i2c_smbus_ioctl_data));
  if (!request) return EFAULT;
  const auto raw = request.as<i2c_smbus_ioctl_data>();
  const auto access = raw.read_write == I2C_SMBUS_READ ? Access::kRead : Access::kWrite;
  i2c_smbus_data data{};
  const bool has_data =
      raw.size != I2C_SMBUS_QUICK && (raw.size != I2C_SMBUS_BYTE || access == Access::kRead);
  if (!has_data) return adapter.smbus(address, access, raw.command, raw.size, data);
  const auto size = smbus_size(raw.size);
  auto memory = request.behind(offsetof(i2c_smbus_ioctl_data, data), size);
  if (!memory) return EFAULT;
  std::memcpy(&data, memory.bytes().data(), size);
  const int error = adapter.smbus(address, access, raw.command, raw.size, data);
  if (error == 0) memory.set(std::as_bytes(std::span{&data, 1}).first(size));
  return error;
}

void answer_ioctl(I2cAdapter& adapter, Call& call) {
  switch (call.request()) {
    case I2C_FUNCS: {
      auto memory = call.argument().behind(0, sizeof(unsigned long));
      if (!memory) return call.answer(0, EFAULT);
      memory.set(std::as_bytes(std::span{&I2cAdapter::kFunctions, 1}));
      return call.answer(0, 0);
    }
    case I2C_SLAVE:
    case I2C_SLAVE_FORCE:
      if (call.number() > kLastAddress) return call.answer(0, EINVAL);
      call.choose(call.number());
      return call.answer(0, 0);
    case I2C_RETRIES:
    case I2C_TIMEOUT:
      return call.answer(0, 0);
    case I2C_TENBIT:
    case I2C_PEC:
      return call.answer(0, call.number() == 0 ? 0 : EINVAL);
    case I2C_RDWR: {
      const auto [count, error] = transfer(adapter, call.argument());
      return call.answer(count, error);
    }
    case I2C_SMBUS:
      return call.answer(0, smbus(adapter, call.address(), call.argument()));
    default:
      return call.answer(0, ENOTTY);
  }
}

gboolean on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer adapter) {
  Call call{client};
  answer_ioctl(*static_cast<I2cAdapter*>(adapter), call);
  return TRUE;
}

/// `read` and `write`: a transaction with the chosen address.
gboolean on_write(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer adapter) {
  Call call{client};
  const auto message = write_to(call.address(), call.argument().bytes());
  const int error = static_cast<I2cAdapter*>(adapter)->transfer({&message, 1});
  call.answer(static_cast<long>(message.write.size()), error);
  return TRUE;
}

gboolean on_read(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer adapter) {
  Call call{client};
  std::vector<std::byte> bytes(std::min(call.argument().bytes().size(), kLongestMessage));
  const auto message = read_from(call.address(), bytes);
  const int error = static_cast<I2cAdapter*>(adapter)->transfer({&message, 1});
  if (error == 0) call.argument().set(bytes);
  call.answer(static_cast<long>(bytes.size()), error);
  return TRUE;
}

std::string root_of(UMockdevTestbed* bed) {
  gchar* text = umockdev_testbed_get_root_dir(bed);
  std::string root = text;
  g_free(text);
  return root;
}

void add_to_sysfs(UMockdevTestbed* bed, const std::string& name, const std::string& path) {
  std::array<const char*, 3> attributes{"name", "armjig emulated bus", nullptr};
  std::array<const char*, 3> properties{"DEVNAME", path.c_str(), nullptr};
  g_free(umockdev_testbed_add_devicev(bed, "i2c-dev", name.c_str(), nullptr,
                                      const_cast<gchar**>(attributes.data()),
                                      const_cast<gchar**>(properties.data())));
}

/// A file that passes for a character device: umockdev takes the sticky bit as its sign.
bool make_node(const std::string& file) {
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::path{file}.parent_path(), error);
  if (!std::ofstream{file}) return false;
  return ::chmod(file.c_str(), S_ISVTX | 0666) == 0;
}

}  // namespace

class VirtualI2c::Bed {
 public:
  Bed(std::unique_ptr<I2cAdapter> adapter, int number)
      : adapter_{std::move(adapter)},
        path_{fmt::format("/dev/i2c-{}", number)},
        bed_{umockdev_testbed_new()},
        calls_{umockdev_ioctl_base_new()} {
    g_signal_connect(calls_.get(), "handle-ioctl", G_CALLBACK(on_ioctl), adapter_.get());
    g_signal_connect(calls_.get(), "handle-read", G_CALLBACK(on_read), adapter_.get());
    g_signal_connect(calls_.get(), "handle-write", G_CALLBACK(on_write), adapter_.get());
  }
  Bed(const Bed&) = delete;
  Bed& operator=(const Bed&) = delete;
  ~Bed() { umockdev_testbed_detach_ioctl(bed_.get(), path_.c_str(), nullptr); }

  Outcome<void> plug_in() {
    add_to_sysfs(bed_.get(), path_.substr(path_.rfind('/') + 1), path_);
    GError* error = nullptr;
    if (make_node(root() + path_) &&
        umockdev_testbed_attach_ioctl(bed_.get(), path_.c_str(), calls_.get(), &error) != 0) {
      return {};
    }
    const std::string why = error == nullptr ? "the test bed is not writable" : error->message;
    g_clear_error(&error);
    return problem(ErrorCode::kSystem, path_, why);
  }

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] std::string root() const { return root_of(bed_.get()); }
  [[nodiscard]] Host& host() noexcept { return adapter_->host(); }

 private:
  std::unique_ptr<I2cAdapter> adapter_;
  std::string path_;
  GObjectRef<UMockdevTestbed> bed_;
  GObjectRef<UMockdevIoctlBase> calls_;
};

Outcome<VirtualI2c> VirtualI2c::open(std::unique_ptr<HostedBus> bus, int number,
                                     HostOptions options) {
  auto adapter = I2cAdapter::open(std::move(bus), std::move(options));
  if (!adapter) return tl::unexpected{adapter.error()};
  auto bed = std::make_unique<Bed>(*std::move(adapter), number);
  if (const auto plugged = bed->plug_in(); !plugged) return tl::unexpected{plugged.error()};
  return VirtualI2c{std::move(bed)};
}

VirtualI2c::VirtualI2c(std::unique_ptr<Bed> bed) noexcept : bed_{std::move(bed)} {}
VirtualI2c::VirtualI2c(VirtualI2c&&) noexcept = default;
VirtualI2c& VirtualI2c::operator=(VirtualI2c&&) noexcept = default;
VirtualI2c::~VirtualI2c() = default;

const std::string& VirtualI2c::path() const noexcept { return bed_->path(); }
Host& VirtualI2c::host() noexcept { return bed_->host(); }

std::vector<std::string> VirtualI2c::environment() const {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody changes the environment meanwhile
  const char* others = std::getenv("LD_PRELOAD");
  std::string preload = "LD_PRELOAD=libumockdev-preload.so.0";
  if (others != nullptr && *others != '\0') preload += std::string{":"} + others;
  return {"UMOCKDEV_DIR=" + bed_->root(), std::move(preload)};
}

}  // namespace armjig
