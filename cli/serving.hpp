// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/device.hpp"
#include "cli/report_files.hpp"
#include "conformance/program_check.hpp"
#include "emulators/host/host.hpp"
#include "emulators/host/served.hpp"
#include "emulators/lab/device_nodes.hpp"
#include "emulators/memory/hosted.hpp"
#include "harness/core/error.hpp"

/// What the subcommands share at which programs find a device.
namespace armjig::cli {

/// Places where programs find a device, as users write them.
struct Places {
  std::optional<PtyOptions> pty;
  std::optional<std::uint16_t> tcp;
  std::optional<std::uint16_t> rfc2217;
  std::string bind;  ///< address for both; empty: this machine only
  std::string usb_socket;
  std::optional<std::uint16_t> usbip;
  std::string usb_serial;    ///< number of the board, also at `board`; empty: NAME-emulated
  std::optional<int> board;  ///< the N of /dev/ttyACM-N
  std::optional<int> bus;    ///< the N of /dev/i2c-N

  /// On USB for other machines.
  [[nodiscard]] bool is_on_usb() const noexcept { return !usb_socket.empty() || usbip; }
  /// Where only a byte stream can be.
  [[nodiscard]] bool is_of_stream() const noexcept { return pty || rfc2217 || board; }
};

/// Whether a string of a USB device may be that, and what it has to be.
[[nodiscard]] bool is_usb_text(std::string_view text) noexcept;
inline constexpr std::string_view kUsbText = "at most 126 visible ASCII characters";

/// Where and how a device is served.
struct Serving {
  std::string name;    ///< what it is called here
  std::string device;  ///< what it is
  HostOptions how;
  std::optional<int> board;  ///< as of `Places`; its terminal is the first place of `how`
  std::optional<int> bus;
  usb::Identity identity{};  ///< at `board`
};

/// A log on standard error; its lines begin with the name unless that is empty.
[[nodiscard]] std::function<void(std::string_view line)> log_as(std::string_view name);

/// A stream has a pseudo-terminal where a board is. `name` is what it is called. Requires that the
/// device can be in these places and is in one.
[[nodiscard]] Serving serving_at(const Device& device, std::string name, const Places& places,
                                 double speed = 1);

/// Where `--listen` says: `pty:[PATH]`, `tcp:[HOST:]PORT`, `rfc2217:[HOST:]PORT`, `i2c:N`.
/// Problems: `kBadValue`, also for a place that is not for such a device.
[[nodiscard]] Outcome<Serving> parse_listen(const std::string& listen, const Device& device);

/// A device that is to be served.
struct ToServe {
  AnyHosted hosted;
  Serving serving;
};

/// Devices that programs find, each in a thread of its own, until this is gone.
class ServedDevices {
 public:
  /// Listens for all of them. `when_over` is called, in some thread, when one has gone by itself.
  /// Problems: those of `Host::open` and `DeviceNodes`; with several devices each begins with the
  /// name.
  [[nodiscard]] static Outcome<std::unique_ptr<ServedDevices>> open(
      std::vector<ToServe> devices, const std::function<void()>& when_over = [] {});

  struct One {
    Serving serving;
    std::unique_ptr<Served> served;
    std::vector<std::string> targets;  ///< as `--target` takes them
  };
  [[nodiscard]] const std::vector<One>& all() const noexcept { return all_; }
  /// What programs need to find device nodes; empty if there are none.
  [[nodiscard]] std::vector<std::string> environment() const { return nodes_.environment(); }

 private:
  std::vector<One> all_;
  DeviceNodes nodes_;  ///< goes first: it uses the others
};

/// How a server talks.
struct ServerManner {
  enum class Announcement : std::uint8_t {
    kOne,  ///< of the only device
    kLab,  ///< of any number, with their names
  };

  Announcement announcement{};
  bool wants_json = false;
  bool is_quiet = false;  ///< no statistics at the end
};

/// Says where they listen, and serves them until a signal comes or all have gone. Lines on standard
/// input do what can be done beside them; those of a lab begin with `NAME.`. Problems: those of
/// `ServedDevices::open`.
[[nodiscard]] Outcome<void> serve(std::vector<ToServe> devices, const ServerManner& manner);

/// What scheduling adds to the times of a program. `speed` is device time over wall time.
[[nodiscard]] LinkNoise link_noise_of(const Device& device, double speed);

/// Who judges the programs; nullptr if nobody asked. `speed` is device time over wall time, `name`
/// as of `make_program_check`. Problems: those of it.
[[nodiscard]] Outcome<std::unique_ptr<ProgramCheck>> check_if(bool is_wanted, const Device& device,
                                                              double speed,
                                                              std::string_view name = {});

/// Adds `--check` with the files and colours of its report.
void add_program_check(CLI::App& command, bool& is_wanted, ReportFiles& files, std::string& colour);

/// The verdict: printed, and in the files that were asked for.
[[nodiscard]] Exit conclude(ProgramCheck& check, bool wants_json, const std::string& colour,
                            const ReportOutputs& files);

}  // namespace armjig::cli
