// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/device.hpp"
#include "conformance/bench.hpp"
#include "emulators/campaign/folder.hpp"
#include "emulators/campaign/material.hpp"
#include "emulators/campaign/stage.hpp"

namespace armjig::cli {

/// What cases for that target are made of: of the entry, and of the model, who is asked which
/// devices are on its bus. No case of it is longer. Problems: those of the model.
[[nodiscard]] Outcome<campaign::Material> material_of(const Device& device, const RigOptions& how,
                                                      const RigOptions& model, Duration longest);

/// The target and a model of it, which is an emulated `reference`: the device itself, or the same
/// with an emulator of its own. What comes later than a case by `trailing` is not heard any more.
[[nodiscard]] std::unique_ptr<campaign::Stage> stage_of(const Device& device, const RigOptions& how,
                                                        const Device& reference,
                                                        const RigOptions& model, const Hand& hand,
                                                        Duration trailing);

/// The target without a model, led in its own time; one that is not emulated `speed` times as fast
/// as its scripts say.
[[nodiscard]] std::unique_ptr<campaign::Stage> stage_alone(const Device& device,
                                                           const RigOptions& how, const Hand& hand,
                                                           double speed);

/// The emulated target with those options, but without a fault.
[[nodiscard]] Target sound_target(DeviceOptions options);

/// Virtual time is for nothing: so long a case may be that is played to an emulated target.
inline constexpr Duration kLongestEmulated = std::chrono::seconds{60};

/// What is said after the last record of a case is waited for so long.
inline constexpr Duration kHorizon = std::chrono::milliseconds{20};

/// `OnStream`, `OnServer` or `OnBus`.
[[nodiscard]] std::string port_name_of(const Device& device);

/// A folder with all of that, the recordings of findings out of the first folder that has them.
[[nodiscard]] Outcome<void> copy_into(const std::string& path, const campaign::CampaignFacts& facts,
                                      const campaign::CampaignState& state,
                                      const std::vector<std::string>& from);

}  // namespace armjig::cli
