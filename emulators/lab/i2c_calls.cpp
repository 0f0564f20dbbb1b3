// SPDX-License-Identifier: Apache-2.0
#include "emulators/lab/i2c_calls.hpp"

#include <linux/i2c-dev.h>
#include <linux/i2c.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace armjig::lab {
namespace {

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

}  // namespace

GObjectRef<UMockdevIoctlBase> answer_i2c_calls(I2cAdapter& adapter) {
  GObjectRef<UMockdevIoctlBase> calls{umockdev_ioctl_base_new()};
  g_signal_connect(calls.get(), "handle-ioctl", G_CALLBACK(on_ioctl), &adapter);
  g_signal_connect(calls.get(), "handle-read", G_CALLBACK(on_read), &adapter);
  g_signal_connect(calls.get(), "handle-write", G_CALLBACK(on_write), &adapter);
  return calls;
}

}  // namespace armjig::lab
